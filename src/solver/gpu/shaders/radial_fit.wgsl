// What circles and spheres have in common: how points move radially from the mean onto the shape that `fit_of` found, along the
// principal axes and in units of the size, less the mean of all moves.
//
// After this text: `struct Fit`, `fn fit_of(i: u32, found: Principal) -> Fit` and `fn move_of(y: vec3f, fit: Fit) -> vec3f`.

// Point `j` along the axes of least, middle and greatest scatter, over the size.
fn own_place(i: u32, j: u32, found: Principal) -> vec3f {
    return ((at(i, j) - found.mean) * found.axes) / found.size;
}

fn project(i: u32) {
    let found = principal(i);
    if found.size == 0.0 {
        for (var j = 0u; j < batch.points; j++) {
            put_centred(i, j, vec3f(0.0), vec3f(0.0));
        }
        return;
    }
    let fit = fit_of(i, found);
    var sum = vec3f(0.0);
    for (var j = 0u; j < batch.points; j++) {
        sum += move_of(own_place(i, j, found), fit);
    }
    let scaled = found.axes * found.size;
    let mean_move = scaled * (sum / f32(batch.points));
    for (var j = 0u; j < batch.points; j++) {
        put_centred(i, j, scaled * move_of(own_place(i, j, found), fit), mean_move);
    }
}
