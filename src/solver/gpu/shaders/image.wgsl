// y = A x; the fourth numbers of y stay.

@group(0) @binding(5) var<storage, read_write> y: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    if is_row {
        y[row] = vec4f(image, y[row].w);
    }
}
