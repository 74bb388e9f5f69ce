// TriangleStrain: the rows are the two columns of the deformation gradient; its singular values are clamped to a range.
// See constraints/triangle_strain.rs. Numbers: range_min, range_max.

fn project(i: u32) {
    let rows = rows_2(i);
    let gradient = gradient_2(i, rows);
    let svd = singular_2(gradient[0], gradient[1]);
    let wanted = clamp(svd.s, vec2f(number(i, 0u)), vec2f(number(i, 1u)));
    put_gradient_2(i, rows, strain_change_2(svd, wanted - svd.s));
}
