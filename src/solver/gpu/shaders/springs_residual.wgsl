// y = b - A x

@group(0) @binding(6) var<storage, read> b: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> y: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    if is_row {
        y[row] = vec4f(b[row].xyz - image, 0.0);
    }
}
