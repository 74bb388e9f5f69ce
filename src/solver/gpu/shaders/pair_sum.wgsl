// Sums over the `WIDTH` threads of a workgroup, of two vectors at once; the same order every time.
//
// Before this text: `const WIDTH`, a power of two.

struct Pair {
    first: vec3f,
    second: vec3f,
}

var<workgroup> firsts: array<vec3f, WIDTH>;
var<workgroup> seconds: array<vec3f, WIDTH>;

// The sum, for thread 0.
fn pair_sum(local: u32, own: Pair) -> Pair {
    firsts[local] = own.first;
    seconds[local] = own.second;
    for (var half = WIDTH / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if local < half {
            firsts[local] += firsts[local + half];
            seconds[local] += seconds[local + half];
        }
    }
    return Pair(firsts[0], seconds[0]);
}
