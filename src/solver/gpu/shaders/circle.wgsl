// Circle: onto the best-fit plane, then radially onto the algebraic circle. See constraints/circle.rs.
//
// Of flat arcs the center is far away, and distances from it have few digits of the points' extent. With
// `w = tr S / k − ‖q‖² + 2 q·c`, which is `r² − d²` without what cancels, a point at the distance `d` from the center
// moves by `(q − c) w / (d (d + r))`.

// Points with a lesser ratio of `det S` to `(tr S)²` are within 2e-6 of their size from a line. They are put on it:
// their places beside it have hardly a digit in single precision.
const STRAIGHT = 4e-12;

struct Circle {
    // In units of `size`, along the axes of greatest and middle scatter.
    center: vec2f,
    // `tr S / k`.
    spread: f32,
    is_straight: bool,
}

// Point `j` along the axes of least, middle and greatest scatter, over the size.
fn own_place(i: u32, j: u32, found: Principal) -> vec3f {
    return ((at(i, j) - found.mean) * found.axes) / found.size;
}

fn circle_of(i: u32, found: Principal) -> Circle {
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
        return Circle(vec2f(0.0), spread, true);
    }
    let center = 0.5 * (squares.yx * moment - squares.z * moment.yx) / determinant;
    return Circle(center, spread, false);
}

// How a point at `y` moves, along the axes and in units of the size.
fn move_of(y: vec3f, circle: Circle) -> vec3f {
    if circle.is_straight {
        return vec3f(-y.x, -y.y, 0.0);
    }
    let q = y.zy;
    let from_center = q - circle.center;
    let distance = length(from_center);
    let radius = sqrt(dot(circle.center, circle.center) + circle.spread);
    // Every direction is as near from the center itself.
    var step = vec2f(radius, 0.0);
    if distance > 0.0 {
        let w = circle.spread - dot(q, q) + 2.0 * dot(q, circle.center);
        step = from_center * (w / (distance * (distance + radius)));
    }
    return vec3f(-y.x, step.y, step.x);
}

fn project(i: u32) {
    let found = principal(i);
    if found.size == 0.0 {
        for (var j = 0u; j < batch.points; j++) {
            put_centred(i, j, vec3f(0.0), vec3f(0.0));
        }
        return;
    }
    let circle = circle_of(i, found);
    var sum = vec3f(0.0);
    for (var j = 0u; j < batch.points; j++) {
        sum += move_of(own_place(i, j, found), circle);
    }
    let scaled = found.axes * found.size;
    let mean_move = scaled * (sum / f32(batch.points));
    for (var j = 0u; j < batch.points; j++) {
        put_centred(i, j, scaled * move_of(own_place(i, j, found), circle), mean_move);
    }
}
