// EqualLengths: the rows are edges, whose lengths become their mean. See constraints/equal_lengths.rs. No numbers.

// Shorter edges have no direction: their squares leave single precision. They are round-off of the coordinates, which go to 1.
const SHORTEST_EDGE: f32 = 1e-18;

// Lengths are summed in runs of so many, and the runs then: a sum of thousands keeps its digits.
const EQUAL_LENGTHS_RUN: u32 = 32u;

// Edge `r`, accurate where it is short against its distance from point 0 too.
fn edge_at(i: u32, r: u32) -> vec3f {
    let start = indices[2u * r * batch.count + i];
    let end = indices[(2u * r + 1u) * batch.count + i];
    return (base[end].xyz - base[start].xyz) + (shift[end].xyz - shift[start].xyz);
}

fn project(i: u32) {
    let edges = batch.points / 2u;
    var sum = 0.0;
    for (var first = 0u; first < edges; first += EQUAL_LENGTHS_RUN) {
        var part = 0.0;
        for (var r = first; r < min(first + EQUAL_LENGTHS_RUN, edges); r++) {
            part += length(edge_at(i, r));
        }
        sum += part;
    }
    let mean = sum / f32(edges);
    for (var r = 0u; r < edges; r++) {
        let edge = edge_at(i, r);
        let current = length(edge);
        var residual = vec3f(mean, 0.0, 0.0);
        if current > SHORTEST_EDGE {
            residual = (mean - current) * normalize(edge);
        }
        put_pair(i, r, residual);
    }
}
