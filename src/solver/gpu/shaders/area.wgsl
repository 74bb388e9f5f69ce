// Area: the rows are the two columns of the deformation gradient; the product of its singular values goes to a range.
// See constraints/area.rs. Numbers: range_min, range_max.

fn project(i: u32) {
    let rows = rows_2(i);
    let gradient = gradient_2(i, rows);
    let svd = singular_2(gradient[0], gradient[1]);
    let wanted = move_product_2(svd.s, number(i, 0u), number(i, 1u));
    put_gradient_2(i, rows, strain_change_2(svd, wanted - svd.s));
}
