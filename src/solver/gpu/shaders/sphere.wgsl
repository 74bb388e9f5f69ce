// Sphere: radially onto the algebraic sphere. See constraints/sphere.rs; for how far a point moves see circle.wgsl.

// Points whose least scatter is a lesser part of the greatest are within 2e-6 of their size from a plane. They are put
// on it: their places beside it have hardly a digit in single precision.
const FLAT = 4e-12;

struct Fit {
    // About the mean, in units of `size`, along the axes of least, middle and greatest scatter.
    center: vec3f,
    // `tr S / k`.
    spread: f32,
    is_flat: bool,
}

// The center solves `S c = ½ Σ ‖y‖² y`. Along the axes the entries off the diagonal of `S` are small beside the roots
// of those on it, so that elimination, from the greatest axis on, loses no digits however flat the points are.
fn fit_of(i: u32, found: Principal) -> Fit {
    var squares = vec3f(0.0);
    var off = vec3f(0.0);
    // Σ (‖y‖² − tr S / k) y: the second part adds nothing but takes off what cancels.
    var moment = vec3f(0.0);
    let spread = found.spread.x + found.spread.y + found.spread.z;
    for (var j = 0u; j < batch.points; j++) {
        let y = own_place(i, j, found);
        squares += y * y;
        off += y.yxx * y.zzy;
        moment += y * (dot(y, y) - spread);
    }
    let middle_of_greatest = off.x / squares.z;
    let least_of_greatest = off.y / squares.z;
    let middle = squares.y - middle_of_greatest * off.x;
    let beside = off.z - least_of_greatest * off.x;
    if !(middle > FLAT * squares.z) {
        return Fit(vec3f(0.0), spread, true);
    }
    let least_of_middle = beside / middle;
    let least = squares.x - least_of_greatest * off.y - least_of_middle * beside;
    if !(least > FLAT * squares.z) {
        return Fit(vec3f(0.0), spread, true);
    }
    let right = 0.5 * moment;
    let right_middle = right.y - middle_of_greatest * right.z;
    let right_least = right.x - least_of_greatest * right.z - least_of_middle * right_middle;
    let x = right_least / least;
    let y = (right_middle - beside * x) / middle;
    let z = (right.z - off.x * y - off.y * x) / squares.z;
    return Fit(vec3f(x, y, z), spread, false);
}

fn move_of(y: vec3f, fit: Fit) -> vec3f {
    if fit.is_flat {
        return vec3f(-y.x, 0.0, 0.0);
    }
    let from_center = y - fit.center;
    let distance = length(from_center);
    let radius = sqrt(dot(fit.center, fit.center) + fit.spread);
    if !(distance > 0.0) {
        // Every direction is as near from the center itself.
        return vec3f(0.0, 0.0, radius);
    }
    let w = fit.spread - dot(y, y) + 2.0 * dot(y, fit.center);
    return from_center * (w / (distance * (distance + radius)));
}
