// How far to go, by coordinates: from the sums of r·z and z·Az over all rows, and what the last step left. One workgroup.
//
// The direction is p = z + keep p', p' being the last, whose step was `step'`. Directions are conjugate, so that
// pAp = zAz - keep rz / step'.

struct State {
    // In w: how many steps were made.
    step: vec4f,
    keep: vec4f,
    // r·z of the last step; 0 where there was none.
    product: vec4f,
}

// A product below this part of the first stands for a millionth of the first error: beyond, single precision has nothing to
// gain.
const SOLVED = 1e-12;

// A curvature below this part of zAz is a difference of which half the digits are gone: the direction begins anew from z.
const CANCELLED = 1e-3;

// What is not below this is not finite, or soon will not be.
const GREATEST = 1e37;

@group(0) @binding(2) var<storage, read_write> state: State;
@group(0) @binding(3) var<storage, read_write> progress: array<vec4f, 2>;

fn is_positive(value: f32) -> bool {
    return value > 0.0 && value < GREATEST;
}

@compute @workgroup_size(WIDTH)
fn main(@builtin(local_invocation_index) local: u32) {
    let sum = pair_sum(local, sum_of(local, WIDTH));
    if local != 0u {
        return;
    }
    // The first step of a solve finds no progress.
    let is_first = progress[0].w == 0.0;
    if is_first {
        progress[0] = vec4f(sum.first, 1.0);
        state.step.w = 0.0;
    }
    progress[1] = vec4f(sum.first, state.step.w);
    state.step.w += 1.0;
    for (var k = 0u; k < 3u; k++) {
        let product = sum.first[k];
        var keep = 0.0;
        var bend = sum.second[k];
        if !is_first && is_positive(state.product[k]) {
            let kept = product / state.product[k];
            let rest = bend - kept * product / state.step[k];
            if rest > CANCELLED * bend {
                keep = kept;
                bend = rest;
            }
        }
        let step = product / bend;
        if is_positive(product) && product > SOLVED * progress[0][k] && is_positive(bend) && is_positive(step) {
            state.step[k] = step;
            state.keep[k] = keep;
            state.product[k] = product;
        } else {
            state.step[k] = 0.0;
            state.keep[k] = 0.0;
            state.product[k] = 0.0;
        }
    }
}
