//! Products against those in double precision.

use super::*;
use crate::solver::gpu::frame::Four;
use crate::solver::gpu::tests::{Random, card};

/// A matrix whose rows have up to `most` entries; some have none.
fn matrix(random: &mut Random, rows: usize, columns: usize, most: u64) -> SparseRows {
    let mut row = || {
        let count = random.bits() % (most + 1);
        let mut found: Vec<u32> = (0..count).map(|_| (random.bits() % columns as u64) as u32).collect();
        found.sort_unstable();
        found.dedup();
        found.into_iter().map(|column| (column, random.number())).collect::<Vec<_>>()
    };
    let rows: Vec<_> = (0..rows).map(|_| row()).collect();
    SparseRows::from_rows(columns, rows.into_iter())
}

/// What `combine(i, lane, (A x)ᵢ)` is with `A x` in double precision, against what the card found.
fn check(matrix: &SparseRows, x: &[Four], found: &[Four], combine: impl Fn(usize, usize, f64) -> f64, what: &str) {
    assert_eq!(found.len(), matrix.row_count());
    for (i, found) in found.iter().enumerate() {
        for (lane, found) in found[..3].iter().enumerate() {
            let (mut sum, mut size) = (0.0, 1.0);
            for (j, value) in matrix.row(i) {
                sum += value * f64::from(x[j][lane]);
                size += value.abs();
            }
            let expected = combine(i, lane, sum);
            // Each of up to some hundred terms, of numbers below 1, rounds twice, and so do a few operations beside.
            let error = (f64::from(*found) - expected).abs();
            assert!(error < 1e-6 * size, "{what}: row {i} lane {lane}: {found} instead of {expected}");
        }
    }
}

fn room(card: &Card, rows: usize) -> Buffer {
    card.buffer("a vector", &vec![[f32::NAN; 4]; rows]).unwrap()
}

/// Row counts about a slice, and some of many slices; rows of up to so many entries.
fn sizes() -> impl Iterator<Item = (usize, u64)> {
    [1, 63, 64, 65, 1000, 10_001].into_iter().flat_map(|rows| [0, 3, 20, 70, 200].map(|most| (rows, most)))
}

#[test]
fn products_are_those_in_double_precision_at_any_size_and_length_of_rows() {
    let Some(card) = card(0) else { return };
    let mut lanes_met = Vec::new();
    for (rows, most) in sizes() {
        let mut random = Random(rows as u64 + most);
        let matrix = matrix(&mut random, rows, rows, most);
        let sliced = Sliced::new(&card, "a matrix", &matrix).unwrap();
        lanes_met.push(sliced.lanes);
        let [x, b] = std::array::from_fn(|_| random.vector(rows));
        let [on_x, on_b, image] = [&x, &b, &b].map(|values| card.buffer("a vector", values).unwrap());
        let residual = room(&card, rows);
        let all = [sliced.residual(&card, &on_b, &on_x, &residual), sliced.image(&card, &on_x, &image)];
        all.into_iter().for_each(|runs| card.submit(&runs.unwrap()));
        let found: Vec<Vec<Four>> = card.read(&[(&residual, rows), (&image, rows)]).unwrap();
        let of_b = |i: usize, lane: usize| f64::from(b[i][lane]);
        let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
        check(&matrix, &x, &found[0], |i, lane, sum| of_b(i, lane) - sum, &what("b − A x"));
        check(&matrix, &x, &found[1], |_, _, sum| sum, &what("A x"));
        assert!(found[0].iter().all(|y| y[3] == 0.0));
        assert!(found[1].iter().zip(&b).all(|(y, b)| y[3] == b[3]));
    }
    lanes_met.sort_unstable();
    lanes_met.dedup();
    assert_eq!(lanes_met, [1, 2, 4, 8, 16]);
}

#[test]
fn products_of_springs_are_those_in_double_precision() {
    let Some(card) = card(0) else { return };
    for (rows, most) in sizes() {
        let mut random = Random(rows as u64 + most);
        let matrix = matrix(&mut random, rows, rows, most);
        let sliced = Sliced::springs(&card, "a matrix", &matrix).unwrap();
        let [x, b, change] = std::array::from_fn(|_| random.vector(rows));
        let [on_x, on_b, on_change] = [&x, &b, &change].map(|values| card.buffer("a vector", values).unwrap());
        let [residual, zero, first, next, unused] = std::array::from_fn(|_| room(&card, rows));
        let all = [
            sliced.springs_residual(&card, &on_b, &on_x, &residual),
            sliced.smoothed_from_zero(&card, [0.5, -0.25], &on_b, &zero),
            // What nothing is kept of may be anything.
            sliced.chebyshev(&card, [0.0, 0.75], [&on_b, &on_x, &first, &next]),
            sliced.chebyshev(&card, [0.5, 0.75], [&on_b, &on_x, &on_change, &unused]),
        ];
        all.into_iter().for_each(|runs| card.submit(&runs.unwrap()));
        let buffers = [&residual, &zero, &first, &next, &on_change];
        let found: Vec<Vec<Four>> = card.read(&buffers.map(|buffer| (buffer, rows))).unwrap();
        let of = |values: &[Four], i: usize, k: usize| f64::from(values[i][k]);
        let pull = |i, k, sum| of(&b, i, 3) * (of(&b, i, k) - sum);
        let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
        check(&matrix, &x, &found[0], |i, k, sum| of(&b, i, k) - sum, &what("b − A x"));
        let scaled: Vec<Four> = b.iter().map(|b| b.map(|number| number * b[3])).collect();
        let from_zero = |i, k, sum: f64| 0.5 * of(&scaled, i, k) - 0.25 * of(&b, i, 3) * sum;
        check(&matrix, &scaled, &found[1], from_zero, &what("from zero"));
        check(&matrix, &x, &found[2], |i, k, sum| 0.75 * pull(i, k, sum), &what("the first change"));
        check(&matrix, &x, &found[3], |i, k, sum| of(&x, i, k) + 0.75 * pull(i, k, sum), &what("the next x"));
        let later = |i, k, sum| 0.5 * of(&change, i, k) + 0.75 * pull(i, k, sum);
        check(&matrix, &x, &found[4], later, &what("a later change"));
        assert!(found[0].iter().zip(&b).all(|(y, b)| y[3] == b[3]));
        assert!(found[1..].iter().flatten().all(|y| y[3] == 0.0));
    }
}

#[test]
fn two_products_are_those_in_double_precision() {
    let Some(card) = card(0) else { return };
    for (rows, most) in sizes() {
        let mut random = Random(rows as u64 + most);
        let columns = rows.div_ceil(3);
        let image = matrix(&mut random, rows, columns, most);
        // Some entries of the image, with other values.
        let kept = |i: usize| image.row(i).filter(move |(j, _)| (i + j).is_multiple_of(3));
        let row = |i: usize| kept(i).map(|(j, value)| (j as u32, 0.5 - value)).collect();
        let prolongation = SparseRows::from_rows(columns, (0..rows).map(row));
        let sliced = Sliced::prolongation(&card, "two matrices", &prolongation, &image).unwrap();
        let e = random.vector(columns);
        let [residual, y] = std::array::from_fn(|_| random.vector(rows));
        let [on_e, change, on_y] = [&e, &residual, &y].map(|values| card.buffer("a vector", values).unwrap());
        card.submit(&sliced.corrected(&card, 0.75, [&on_e, &change, &on_y]).unwrap());
        let found: Vec<Vec<Four>> = card.read(&[(&change, rows), (&on_y, rows)]).unwrap();
        let of = |values: &[Four], i: usize, k: usize| f64::from(values[i][k]);
        let expected = |i, k, sum| 0.75 * of(&residual, i, 3) * (of(&residual, i, k) - sum);
        let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
        check(&image, &e, &found[0], expected, &what("the change"));
        let moved = |i, k, sum| of(&y, i, k) + sum + of(&found[0], i, k);
        check(&prolongation, &e, &found[1], moved, &what("the next y"));
    }
}

#[test]
fn springs_take_equal_numbers_to_what_the_row_sums_say() {
    let Some(card) = card(0) else { return };
    // Six neighbours of a sixth each, on a ring; rounded sixths add up to more than 1.
    let n = 500_u32;
    let row = |i: u32| {
        let sixth = |step: u32| ((i + n + step - 3) % n, if step == 3 { 1.0 + 1e-9 } else { -1.0 / 6.0 });
        (0..7).map(sixth).collect()
    };
    let matrix = SparseRows::from_rows(n as usize, (0..n).map(row));
    let sliced = Sliced::springs(&card, "a matrix", &matrix).unwrap();
    let (b, x) = (vec![[0.0_f32; 4]; n as usize], vec![[7.0, -0.3, 1e6, 0.0]; n as usize]);
    let [b, x] = [&b, &x].map(|values| card.buffer("a vector", values).unwrap());
    let y = room(&card, n as usize);
    card.submit(&sliced.springs_residual(&card, &b, &x, &y).unwrap());
    let found: Vec<Vec<Four>> = card.read(&[(&y, n as usize)]).unwrap();
    for y in &found[0] {
        for (y, x) in y.iter().zip([7.0, -0.3, 1e6]) {
            assert!((f64::from(*y) + 1e-9 * x).abs() < 1e-15 * f64::abs(x), "{y} of {x}");
        }
    }
}

#[test]
fn products_of_the_other_kind_are_refused() {
    let Some(card) = card(0) else { return };
    let matrix = SparseRows::from_rows(1, [vec![(0, 1.0)]].into_iter());
    let x = room(&card, 1);
    let plain = Sliced::new(&card, "a matrix", &matrix).unwrap();
    assert!(plain.springs_residual(&card, &x, &x, &x).is_err());
    let springs = Sliced::springs(&card, "a matrix", &matrix).unwrap();
    assert!(springs.image(&card, &x, &x).is_err());
    assert!(plain.corrected(&card, 1.0, [&x, &x, &x]).is_err());
    let two = Sliced::prolongation(&card, "two matrices", &matrix, &matrix).unwrap();
    assert!(two.image(&card, &x, &x).is_err());
}

#[test]
fn matrices_need_not_be_square() {
    let Some(card) = card(0) else { return };
    for (rows, columns, most) in [(70, 900, 60), (900, 70, 5), (3, 5000, 2000)] {
        let mut random = Random(5);
        let matrix = matrix(&mut random, rows, columns, most);
        let sliced = Sliced::new(&card, "a matrix", &matrix).unwrap();
        let x = random.vector(columns);
        let (on_x, y) = (card.buffer("a vector", &x).unwrap(), room(&card, rows));
        card.submit(&sliced.image(&card, &on_x, &y).unwrap());
        check(&matrix, &x, &card.read(&[(&y, rows)]).unwrap()[0], |_, _, sum| sum, "A x");
    }
}

#[test]
fn pages_change_no_bit() {
    let found = |binding_bytes: u64, most: u64| {
        let card = card(binding_bytes)?;
        let mut random = Random(7);
        let matrix = matrix(&mut random, 3001, 3001, most);
        let plain = Sliced::new(&card, "a matrix", &matrix).unwrap();
        let springs = Sliced::springs(&card, "a matrix", &matrix).unwrap();
        let [x, y, z] = std::array::from_fn(|_| card.buffer("a vector", &random.vector(3001)).unwrap());
        card.submit(&plain.image(&card, &x, &y).unwrap());
        card.submit(&springs.springs_residual(&card, &x, &y, &z).unwrap());
        let bits = |y: &Four| y.map(f32::to_bits);
        let found: Vec<Vec<Four>> = card.read(&[(&y, 3001), (&z, 3001)]).unwrap();
        Some((found.iter().flatten().map(bits).collect::<Vec<_>>(), plain.pages.len(), springs.pages.len()))
    };
    for most in [20, 200] {
        let Some((whole, plain, springs)) = found(0, most) else { return };
        assert_eq!([plain, springs], [1, 1]);
        // Room for the vectors.
        let Some((cut, plain, springs)) = found(50_000, most) else { return };
        assert!(plain > 3 && springs > 3, "{plain} and {springs} pages");
        assert!(cut == whole, "{plain} pages change bits, with up to {most} entries in a row");
    }
}

#[test]
fn what_is_too_large_for_a_binding_is_refused() {
    let Some(card) = card(4096) else { return };
    // One slice, of 4 rows that 16 threads share each, takes 32 kB.
    let matrix = SparseRows::from_rows(2000, (0..4).map(|_| (0..2000).map(|j| (j, 1.0)).collect()));
    let error = Sliced::new(&card, "the matrix", &matrix).err().unwrap();
    assert_eq!(error.status(), crate::error::Status::BackendUnavailable);
    assert!(error.to_string().contains("the matrix takes"), "{error}");
}
