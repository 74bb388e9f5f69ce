// Circle: onto the best-fit plane, then radially onto the algebraic circle. See constraints/circle.rs.
//
// Of flat arcs the center is far away, and distances from it have few digits of the points' extent. With
// `w = tr S / k − ‖q‖² + 2 q·c`, which is `r² − d²` without what cancels, a point at the distance `d` from the center
// moves by `(q − c) w / (d (d + r))`.

// Points with a lesser ratio of `det S` to `(tr S)²` are within 2e-6 of their size from a line. They are put on it:
// their places beside it have hardly a digit in single precision.
const STRAIGHT = 4e-12;

struct Fit {
    // In units of `size`, along the axes of greatest and middle scatter.
    center: vec2f,
    // `tr S / k`.
    spread: f32,
    is_straight: bool,
}

fn fit_of(i: u32, found: Principal) -> Fit {
    // Σ u², Σ v², Σ u v.
    var squares = vec3f(0.0);
    // Σ (‖q‖² − tr S / k) q: the second part adds nothing but takes off what cancels.
    var moment = vec2f(0.0);
    let spread = found.spread.y + found.spread.z;
    for (var j = 0u; j < batch.points; j++) {
        let q = own_place(i, j, found).zy;
        squares += q.xyx * q.xyy;
        moment += q * (dot(q, q) - spread);
    }
    let sum = squares.x + squares.y;
    let determinant = squares.x * squares.y - squares.z * squares.z;
    if !(determinant > STRAIGHT * sum * sum) {
        return Fit(vec2f(0.0), spread, true);
    }
    let center = 0.5 * (squares.yx * moment - squares.z * moment.yx) / determinant;
    return Fit(center, spread, false);
}

// How a point at `y` moves, along the axes and in units of the size.
fn move_of(y: vec3f, fit: Fit) -> vec3f {
    if fit.is_straight {
        return vec3f(-y.x, -y.y, 0.0);
    }
    let q = y.zy;
    let from_center = q - fit.center;
    let distance = length(from_center);
    let radius = sqrt(dot(fit.center, fit.center) + fit.spread);
    // Every direction is as near from the center itself.
    var step = vec2f(radius, 0.0);
    if distance > 0.0 {
        let w = fit.spread - dot(q, q) + 2.0 * dot(q, fit.center);
        step = from_center * (w / (distance * (distance + radius)));
    }
    return vec3f(-y.x, step.y, step.x);
}
