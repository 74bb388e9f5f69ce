// RegularPolygon: onto the nearest regular polygon. See constraints/regular_polygon.rs.
// Numbers: the unit normal at rest, or 0.

fn project(i: u32) {
    let mean = centre(i);
    let rest_normal = vec3f(number(i, 0u), number(i, 1u), number(i, 2u));
    let polygon = nearest_polygon(i, mean, rest_normal);
    put_polygon(i, mean, polygon, 1.0 / f32(batch.points));
}
