// image = A x, and of every slice the products r·x and x·A x by coordinates.

@group(0) @binding(6) var<storage, read> r: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> image_of_x: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> sums: array<vec4f>;

fn finish(slice: u32, local: u32, row: u32, is_row: bool, image: vec3f) {
    var own = Pair(vec3f(0.0), vec3f(0.0));
    if is_row {
        image_of_x[row] = vec4f(image, 0.0);
        own = Pair(r[row].xyz * x[row].xyz, x[row].xyz * image);
    }
    let sum = pair_sum(local, own);
    if local == 0u {
        sums[2u * slice] = vec4f(sum.first, 0.0);
        sums[2u * slice + 1u] = vec4f(sum.second, 0.0);
    }
}
