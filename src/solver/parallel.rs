//! Work on parts of a slice, on one thread or many, with the same bits either way: the parts depend on the problem alone.

/// Calls `work(i, part, result)` for every part `data[bounds[i]..bounds[i + 1]]` and `results[i]`. `bounds` begins at 0 and
/// ends at the length of `data`. Parts that have no result may have `()`. They run in parallel on the current rayon pool if
/// `is_parallel`. Allocates nothing.
pub(super) fn for_parts<T: Send, R: Send>(
    bounds: &[usize],
    data: &mut [T],
    results: &mut [R],
    is_parallel: bool,
    work: &(impl Fn(usize, &mut [T], &mut R) + Sync),
) {
    if is_parallel {
        split(0, bounds, data, results, work);
        return;
    }
    let mut rest = data;
    for (i, result) in results.iter_mut().enumerate() {
        let (part, later) = rest.split_at_mut(bounds[i + 1] - bounds[i]);
        work(i, part, result);
        rest = later;
    }
}

/// Both results; the work for them on two threads of the current rayon pool if `is_parallel`.
pub(super) fn both<A: Send, B: Send>(
    is_parallel: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_parallel { rayon::join(first, second) } else { (first(), second()) }
}

fn split<T: Send, R: Send>(
    first: usize,
    bounds: &[usize],
    data: &mut [T],
    results: &mut [R],
    work: &(impl Fn(usize, &mut [T], &mut R) + Sync),
) {
    match results {
        [] => {}
        [result] => work(first, data, result),
        _ => {
            let middle = results.len() / 2;
            let (left, right) = data.split_at_mut(bounds[middle] - bounds[0]);
            let (left_results, right_results) = results.split_at_mut(middle);
            rayon::join(
                || split(first, &bounds[..=middle], left, left_results, work),
                || split(first + middle, &bounds[middle..], right, right_results, work),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_worked_on_once_with_its_own_result() {
        let bounds = [0, 3, 3, 10, 11];
        for is_parallel in [false, true] {
            let (mut data, mut results) = (vec![0_usize; 11], vec![0.0; 4]);
            for_parts(&bounds, &mut data, &mut results, is_parallel, &|i, part, result| {
                part.iter_mut().for_each(|value| *value += 10 + i);
                *result += part.len() as f64;
            });
            assert_eq!(data, [10, 10, 10, 12, 12, 12, 12, 12, 12, 12, 13]);
            assert_eq!(results, [3.0, 0.0, 7.0, 1.0]);
        }
    }
}
