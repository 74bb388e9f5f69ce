// Two steps of Chebyshev's iteration from 0: y = keep D b + factor D A D b, D being the inverse of A's diagonal. It is in the
// fourth numbers of b, which is what `x` is here.

@group(0) @binding(6) var<storage, read_write> y: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    if is_row {
        let b = x[row];
        y[row] = vec4f(b.w * (page.keep * b.xyz + page.factor * image), 0.0);
    }
}
