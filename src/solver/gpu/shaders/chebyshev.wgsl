// One step of Chebyshev's iteration: change = keep change + factor D (b - A x), next = x + change. D is the inverse of A's
// diagonal, in the fourth numbers of b.

@group(0) @binding(6) var<storage, read> b: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> change: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> next: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    if !is_row {
        return;
    }
    let right = b[row];
    var own = page.factor * right.w * (right.xyz - image);
    // What the change was does not matter where none of it is kept.
    if page.keep != 0.0 {
        own += page.keep * change[row].xyz;
    }
    change[row] = vec4f(own, 0.0);
    next[row] = vec4f(x[row].xyz + own, 0.0);
}
