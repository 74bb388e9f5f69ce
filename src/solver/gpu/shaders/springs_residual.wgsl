// y = b - A x; the fourth numbers are those of b.

@group(0) @binding(6) var<storage, read> b: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> y: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    if is_row {
        y[row] = b[row] - vec4f(image, 0.0);
    }
}
