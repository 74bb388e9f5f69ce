// RegularPolygon: onto the nearest regular polygon. See constraints/regular_polygon.rs.
// Numbers: the unit normal at rest, or 0.

fn project(i: u32) {
    let rest_normal = vec3f(number(i, 0u), number(i, 1u), number(i, 2u));
    put_polygon(i, nearest_polygon(i, rest_normal), 1.0 / f32(batch.points));
}
