// What the next level's solution e adds to y, and the first step of Chebyshev's iteration from there, with `change` being
// b - A y before: y += P e, change = factor D (change - A P e), y += change. D is the inverse of A's diagonal, in the fourth
// numbers of `change`.

@group(0) @binding(5) var<storage, read_write> change: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> y: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, images: mat2x3f) {
    if !is_row {
        return;
    }
    let residual = change[row];
    let own = page.factor * residual.w * (residual.xyz - images[1]);
    change[row] = vec4f(own, 0.0);
    y[row] = vec4f(y[row].xyz + (images[0] + own), 0.0);
}
