// Rigid: onto the nearest template as large as it is. See constraints/rigid.rs; numbers: see shape_fit.wgsl.

fn project(i: u32) {
    fit(i, false);
}
