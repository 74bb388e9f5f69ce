// What the steps of hard constraints have in common. One thread works on one constraint. Its rows are held to `held`, the `s` of
// the splitting method; flat arrays are by structure, as in constraint.wgsl.

struct Hard {
    // Constraints, points of each, rows of each.
    count: u32,
    points: u32,
    rows: u32,
    // 1: `numbers` has the coefficients of the rows, and then those of their pseudo-inverse; 0: the rows are centred.
    is_dense: u32,
    // Where the batch begins among the rows, and among the pulls.
    first_row: u32,
    first_pull: u32,
    // 1: the targets are the same whatever the points.
    is_fixed: u32,
    relaxation: f32,
}

@group(0) @binding(0) var<uniform> batch: Hard;

fn row_place(i: u32, r: u32) -> u32 {
    return batch.first_row + r * batch.count + i;
}
