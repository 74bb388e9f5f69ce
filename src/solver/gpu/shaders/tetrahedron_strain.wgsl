// TetrahedronStrain: the rows are the three columns of the deformation gradient; its singular values are clamped to a range,
// and one that is inside out is turned back. See constraints/tetrahedron_strain.rs. Numbers: range_min, range_max.

fn project(i: u32) {
    let rows = rows_3(i);
    let svd = singular_3(gradient_3(i, rows));
    // The least value is negative where the tetrahedron is inside out; what is wanted never is.
    let wanted = clamp(abs(svd.s), vec3f(number(i, 0u)), vec3f(number(i, 1u)));
    put_gradient_3(i, rows, strain_change_3(svd, wanted - svd.s));
}
