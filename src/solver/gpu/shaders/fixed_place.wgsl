// Of types of one point that have an axis and a place in the model.
// Numbers: the unit axis, then the place as the sum of two, as points are.

fn axis(i: u32) -> vec3f {
    return vec3f(number(i, 0u), number(i, 1u), number(i, 2u));
}

// The point, from that place.
fn from_place(i: u32) -> vec3f {
    let place_base = vec3f(number(i, 3u), number(i, 4u), number(i, 5u));
    let place_shift = vec3f(number(i, 6u), number(i, 7u), number(i, 8u));
    let index = indices[i];
    return (base[index].xyz - place_base) + (shift[index].xyz - place_shift);
}
