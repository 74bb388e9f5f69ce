// Similarity: onto the nearest template of any size. See constraints/similarity.rs; numbers: see shape_fit.wgsl.

fn project(i: u32) {
    fit(i, true);
}
