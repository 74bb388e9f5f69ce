// Volume: the rows are the three columns of the deformation gradient; the product of its singular values goes to a range, and
// one that is inside out is turned back. See constraints/volume.rs. Numbers: range_min, range_max.

fn project(i: u32) {
    let rows = rows_3(i);
    let svd = singular_3(gradient_3(i, rows));
    // The least value is negative where the tetrahedron is inside out; what is wanted never is.
    let wanted = move_product_3(abs(svd.s), number(i, 0u), number(i, 1u));
    put_gradient_3(i, rows, strain_change_3(svd, wanted - svd.s));
}
