// What every product with a sparse matrix in slices starts from. A workgroup has one slice of `64 / LANES` rows, and `LANES`
// threads share each row: entry `k * LANES + lane` of row `r` is at `(start + k) * 64 + lane * ROWS + r`, so that neighbouring
// threads read neighbouring numbers. Short rows are padded with zeros.
//
// Before this text: `const LANES` and `fn joined`. After it: what a term is (`plain.wgsl` or `springs.wgsl`), and `fn finish`.

const ROWS = 64u / LANES;

struct Page {
    // The first row of the page's slices, and the row after its last.
    first: u32,
    end: u32,
    // What `finish` multiplies by.
    keep: f32,
    factor: f32,
}

@group(0) @binding(0) var<uniform> page: Page;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> columns: array<u32>;
@group(0) @binding(3) var<storage, read> values: array<f32>;
@group(0) @binding(4) var<storage, read> x: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let slice = group.y * groups.x + group.x;
    if page.first + slice * ROWS >= page.end {
        return;
    }
    let row = page.first + slice * ROWS + local % ROWS;
    let own = own_of(min(row, page.end - 1u));
    var sum = vec3f(0.0);
    let end = starts[slice + 1u] * 64u;
    for (var at = starts[slice] * 64u; at < end; at += 64u) {
        sum += values[at + local] * term(x[columns[at + local]], own);
    }
    let is_row = local < ROWS && row < page.end;
    // The slice's number in the whole matrix, the row, whether it is this thread's, and the row of `A x`.
    finish(page.first / ROWS + slice, local, row, is_row, whole(joined(local, sum), row, own));
}
