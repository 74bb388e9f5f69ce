// What every product with a sparse matrix in slices starts from. A workgroup has one slice of `64 / LANES` rows, and `LANES`
// threads share each row: entry `k * LANES + lane` of row `r` is at `(start + k) * 64 + lane * ROWS + r`, so that neighbouring
// threads read neighbouring numbers. Short rows are padded with zeros.
//
// Before this text: `const LANES`, the aliases `Value` of an entry and `Sum` of a row, and `fn joined`. After it: what a term
// is (`plain.wgsl`, `springs.wgsl` or `two.wgsl`), and `fn finish`.

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
@group(0) @binding(3) var<storage, read> values: array<Value>;
@group(0) @binding(4) var<storage, read> x: array<vec4f>;

fn work(_thread: u32, slice: u32, local: u32) {
    if page.first + slice * ROWS >= page.end {
        return;
    }
    let row = page.first + slice * ROWS + local % ROWS;
    let own = own_of(min(row, page.end - 1u));
    var sum = Sum();
    let end = starts[slice + 1u] * 64u;
    var at = starts[slice] * 64u + local;
    // Four entries at a time, so that a thread waits for memory once and not four times; the sum is the same.
    for (; at + 192u < end; at += 256u) {
        let places = vec4u(columns[at], columns[at + 64u], columns[at + 128u], columns[at + 192u]);
        let factors = array(values[at], values[at + 64u], values[at + 128u], values[at + 192u]);
        let others = array(x[places.x], x[places.y], x[places.z], x[places.w]);
        sum += term(factors[0], others[0], own);
        sum += term(factors[1], others[1], own);
        sum += term(factors[2], others[2], own);
        sum += term(factors[3], others[3], own);
    }
    for (; at < end; at += 64u) {
        sum += term(values[at], x[columns[at]], own);
    }
    let is_row = local < ROWS && row < page.end;
    // The slice's number in the whole matrix, the row, whether it is this thread's, and the row of `A x`.
    finish(page.first / ROWS + slice, local, row, is_row, whole(joined(local, sum), row, own));
}
