// The sum of the `LANES` threads that share a row, for the first of them.

var<workgroup> parts: array<Sum, 64>;

fn joined(local: u32, part: Sum) -> Sum {
    parts[local] = part;
    workgroupBarrier();
    var sum = part;
    if local < 64u / LANES {
        for (var at = local + 64u / LANES; at < 64u; at += 64u / LANES) {
            sum += parts[at];
        }
    }
    return sum;
}
