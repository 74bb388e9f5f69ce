//! The last iterates of a fixed-point iteration `x ← G(x)` as flat vectors, and the inner products between them.
//!
//! With `f_k = G(x_k) − x_k` the plain step at iterate `x_k`, the history holds the moves `s_i = x_{i+1} − x_i` and the
//! changes of the plain step `d_i = f_{i+1} − f_i`. Inner products are those of a metric `N`, `⟨u, v⟩ = uᵀ N v`, of which
//! only the image `N f_k` of each plain step is asked for. Accelerators see the products alone and answer with the
//! coefficients of a [`Combination`], so their own work does not depend on the length of the vectors.
//!
//! All that belongs to the same few points lies together in one *chunk*: three vectors of the last iterate, then the
//! pairs, then the chunk's share of each product. An iterate is added in one pass over the chunks. Chunks depend on the
//! length of the vectors alone and their shares are added up in order, so any number of threads gives the same bits.

use glam::DVec3;

use super::parallel::for_parts;

/// Points of a chunk at most. Its pairs fit a core's second cache, and its vectors are many times as long as the sums.
const CHUNK_POINTS: usize = 512;

/// Points of a chunk are a multiple of this, so that [`dot`] takes vectors whole.
const STEP_POINTS: usize = 8;

/// Numbers of one vector in a chunk at most; those beyond the last point are 0.
const MOST_WIDTH: usize = 3 * CHUNK_POINTS;

/// Vectors at the beginning of a chunk: `x`, `f` and `N f` of the last iterate.
const LAST: usize = 3;

/// Products of each pair with the newest iterate: `⟨s, f⟩`, `⟨d, f⟩`, `⟨s, d'⟩` and `⟨d, d'⟩`, `d'` being the newest change.
const PRODUCTS: usize = 4;

/// The inner products of the last pairs, the oldest replaced by the newest: what accelerators see of a history. Where the vectors
/// are is the history's business.
#[derive(Debug, Default)]
pub(super) struct Products {
    /// Pairs at most.
    capacity: usize,
    /// Pairs held.
    length: usize,
    /// The place of the newest pair.
    newest: usize,
    /// True once there is an iterate for the next to differ from.
    is_started: bool,
    /// `⟨s_i, d_j⟩` at the places `i * capacity + j`, for `i` at least as old as `j`.
    move_change: Vec<f64>,
    /// `⟨d_i, d_j⟩` likewise, for all `i` and `j`.
    change_change: Vec<f64>,
    /// `⟨s_i, f⟩` and `⟨d_i, f⟩` by place, `f` being the plain step at the last iterate.
    move_plain: Vec<f64>,
    change_plain: Vec<f64>,
    plain_plain: f64,
}

/// The last iterates.
#[derive(Debug, Default)]
pub(super) struct History {
    products: Products,
    /// True if `N` is the identity and moves are taken with the coefficient of the change alone: `s_i + d_i` lies in the
    /// place of `s_i` then, which is the change of `G(x)`, and there are no products with it.
    is_euclidean: bool,
    /// Numbers of one vector in a chunk.
    width: usize,
    /// Every chunk's numbers, one chunk after the other, and the pairs and points they are laid out for.
    data: Vec<f64>,
    layout: (usize, usize),
    /// Where the chunks begin in `data`, and its length.
    data_bounds: Vec<usize>,
    /// Where the chunks begin among the points, and their number.
    point_bounds: Vec<usize>,
    /// One entry per chunk, of no meaning.
    results: Vec<f64>,
}

/// The direction `plain · f + Σ moves_i s_i + Σ changes_i d_i` from the last iterate. Index 0 is the newest pair.
#[derive(Debug, Default)]
pub(super) struct Combination {
    pub(super) plain: f64,
    pub(super) moves: Vec<f64>,
    pub(super) changes: Vec<f64>,
}

impl Combination {
    /// `f` alone, with room for the coefficients of `length` pairs.
    pub(super) fn reset(&mut self, length: usize) {
        self.plain = 1.0;
        for coefficients in [&mut self.moves, &mut self.changes] {
            coefficients.clear();
            coefficients.resize(length, 0.0);
        }
    }
}

impl History {
    /// Forgets everything, and has room for `capacity` pairs (at least 1) of `point_count` points from now on.
    pub(super) fn reset(&mut self, capacity: usize, point_count: usize) {
        self.products.reset(capacity);
        // Chunks of about the same length: a short one would take as much memory as the others.
        let even = point_count.div_ceil(point_count.div_ceil(CHUNK_POINTS).max(1));
        let chunk_points = even.next_multiple_of(STEP_POINTS).max(STEP_POINTS);
        self.width = 3 * chunk_points;
        self.point_bounds.clear();
        self.point_bounds.extend((0..point_count).step_by(chunk_points));
        let chunk_count = self.point_bounds.len();
        self.point_bounds.push(point_count);
        let size = (LAST + 2 * capacity) * self.width + PRODUCTS * capacity + 1;
        self.data_bounds.clear();
        self.data_bounds.extend((0..=chunk_count).map(|chunk| chunk * size));
        // With the same layout, what lies beyond the last point is 0 already; all else is written before it is read.
        if self.layout != (capacity, point_count) {
            self.data = vec![0.0; chunk_count * size];
            self.layout = (capacity, point_count);
        }
        self.results.resize(chunk_count, 0.0);
    }

    /// What accelerators see.
    pub(super) fn products(&self) -> &Products {
        &self.products
    }

    /// The same, for accelerators to forget pairs.
    pub(super) fn products_mut(&mut self) -> &mut Products {
        &mut self.products
    }

    /// Adds the iterate `points`, the plain step's result `plain = G(points)`, and `image = N (plain − points)`; `None`
    /// for all iterates where `N` is the identity and only [`super::anderson`] combines them.
    pub(super) fn push(&mut self, points: &[DVec3], plain: &[DVec3], image: Option<&[DVec3]>, is_parallel: bool) {
        let is_euclidean = image.is_none();
        self.is_euclidean = is_euclidean;
        let is_pair = self.products.start_iterate();
        let Products { capacity, newest, length, .. } = self.products;
        let (bounds, width) = (&self.point_bounds, self.width);
        let work = |chunk: usize, data: &mut [f64], _: &mut f64| {
            let range = bounds[chunk]..bounds[chunk + 1];
            let (points, plain) = (&points[range.clone()], &plain[range.clone()]);
            let (last, rest) = data.split_at_mut(LAST * width);
            let (pairs, products) = rest.split_at_mut(2 * capacity * width);
            let (last_point, last_steps) = last.split_at_mut(width);
            let (last_plain, last_image) = last_steps.split_at_mut(width);
            let mut new_image_change = [0.0; MOST_WIDTH];
            let new_image_change = &mut new_image_change[..width];
            let (new_move, new_change) = pairs[2 * newest * width..][..2 * width].split_at_mut(width);
            for (i, (x, g)) in points.iter().zip(plain).enumerate() {
                let (f, x) = ((*g - *x).to_array(), if is_euclidean { *g } else { *x }.to_array());
                for axis in 0..3 {
                    let k = 3 * i + axis;
                    if is_pair {
                        new_move[k] = x[axis] - last_point[k];
                        new_change[k] = f[axis] - last_plain[k];
                    }
                    (last_point[k], last_plain[k]) = (x[axis], f[axis]);
                }
            }
            let (step, step_change) = match image {
                None => (&*last_plain, &pairs[(2 * newest + 1) * width..][..width]),
                Some(image) => {
                    let image = image[range].iter().flat_map(|image| image.to_array());
                    for ((image, last), change) in image.zip(&mut *last_image).zip(&mut *new_image_change) {
                        (*change, *last) = (image - *last, image);
                    }
                    (&*last_image, &*new_image_change)
                }
            };
            for place in (0..length).map(|age| place(capacity, newest, age)) {
                let (s, d) = pairs[2 * place * width..][..2 * width].split_at(width);
                let products = &mut products[PRODUCTS * place..][..PRODUCTS];
                (products[1], products[3]) = (dot(d, step), dot(d, step_change));
                if !is_euclidean {
                    (products[0], products[2]) = (dot(s, step), dot(s, step_change));
                }
            }
            products[PRODUCTS * capacity] = dot(last_plain, step);
        };
        for_parts(&self.data_bounds, &mut self.data, &mut self.results, is_parallel, &work);
        let first = (LAST + 2 * capacity) * width;
        let (data, starts) = (&self.data, &self.data_bounds[..self.results.len()]);
        let total = |product: usize| starts.iter().map(|start| data[start + first + product]).sum::<f64>();
        let of_place = |place: usize| std::array::from_fn(|n| total(PRODUCTS * place + n));
        self.products.set(total(PRODUCTS * capacity), of_place);
    }

    /// Writes the direction that `combination` describes, one entry per point.
    pub(super) fn combine(&mut self, combination: &Combination, direction: &mut [DVec3], is_parallel: bool) {
        let Products { capacity, newest, length, .. } = self.products;
        let (data, bounds, width) = (&self.data, &self.data_bounds, self.width);
        let is_euclidean = self.is_euclidean;
        let work = |chunk: usize, direction: &mut [DVec3], _: &mut f64| {
            let data = &data[bounds[chunk]..bounds[chunk + 1]];
            let mut sum = [0.0; MOST_WIDTH];
            let sum = &mut sum[..width];
            sum.iter_mut().zip(&data[width..]).for_each(|(sum, f)| *sum = combination.plain * f);
            for age in 0..length {
                let place = place(capacity, newest, age);
                let (s, d) = data[(LAST + 2 * place) * width..][..2 * width].split_at(width);
                let (a, b) = (combination.moves[age], combination.changes[age]);
                if is_euclidean {
                    sum.iter_mut().zip(s).for_each(|(sum, both)| *sum += a * both);
                } else {
                    sum.iter_mut().zip(s).zip(d).for_each(|((sum, s), d)| *sum += a * s + b * d);
                }
            }
            for (direction, sum) in direction.iter_mut().zip(sum.chunks_exact(3)) {
                *direction = DVec3::from_slice(sum);
            }
        };
        for_parts(&self.point_bounds, direction, &mut self.results, is_parallel, &work);
    }
}

/// Where the pair of this age (0: the newest) lies.
fn place(capacity: usize, newest: usize, age: usize) -> usize {
    (newest + capacity - age) % capacity
}

impl Products {
    /// Forgets everything, and has room for `capacity` pairs (at least 1) from now on.
    pub(super) fn reset(&mut self, capacity: usize) {
        (self.capacity, self.length, self.newest, self.is_started) = (capacity, 0, 0, false);
        for products in [&mut self.move_change, &mut self.change_change] {
            products.resize(capacity * capacity, 0.0);
        }
        for products in [&mut self.move_plain, &mut self.change_plain] {
            products.resize(capacity, 0.0);
        }
    }

    /// Makes room for the next iterate. True if it makes a pair with the last one, which then is the newest.
    pub(super) fn start_iterate(&mut self) -> bool {
        let is_pair = self.is_started;
        if is_pair {
            self.newest = (self.newest + 1) % self.capacity;
            self.length = (self.length + 1).min(self.capacity);
        }
        self.is_started = true;
        is_pair
    }

    /// Where the newest pair lies, or will.
    #[cfg(feature = "gpu")]
    pub(super) fn newest_place(&self) -> usize {
        self.newest
    }

    /// Where the pairs lie, the newest first.
    pub(super) fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let (capacity, newest) = (self.capacity, self.newest);
        (0..self.length).map(move |age| place(capacity, newest, age))
    }

    /// Takes the products with the newest iterate: `⟨f, f⟩`, and of the pair at each place `⟨s, f⟩`, `⟨d, f⟩`, `⟨s, d'⟩` and
    /// `⟨d, d'⟩`, `d'` being the newest change.
    pub(super) fn set(&mut self, plain_plain: f64, of_place: impl Fn(usize) -> [f64; PRODUCTS]) {
        self.plain_plain = plain_plain;
        let (capacity, newest) = (self.capacity, self.newest);
        for place in self.places() {
            let [move_plain, change_plain, move_change, both] = of_place(place);
            (self.move_plain[place], self.change_plain[place]) = (move_plain, change_plain);
            self.move_change[place * capacity + newest] = move_change;
            self.change_change[place * capacity + newest] = both;
            self.change_change[newest * capacity + place] = both;
        }
    }

    /// Forgets all pairs; the last iterate stays, for the next to differ from.
    pub(super) fn forget_pairs(&mut self) {
        self.length = 0;
    }

    /// Forgets the newest pair, if there is one.
    pub(super) fn forget_newest(&mut self) {
        if self.length > 0 {
            self.length -= 1;
            self.newest = (self.newest + self.capacity - 1) % self.capacity;
        }
    }

    /// The number of pairs.
    pub(super) fn len(&self) -> usize {
        self.length
    }

    /// `‖f‖²`.
    pub(super) fn plain_squared(&self) -> f64 {
        self.plain_plain
    }

    /// `⟨f, p⟩`, `p` being the direction that `combination` describes.
    pub(super) fn plain_along(&self, combination: &Combination) -> f64 {
        let pairs = (0..self.length).map(|age| {
            combination.moves[age] * self.move_plain(age) + combination.changes[age] * self.change_plain(age)
        });
        combination.plain * self.plain_plain + pairs.sum::<f64>()
    }

    /// `⟨s_i, d_j⟩`, for `i` at least as old as `j` (0 is the newest).
    pub(super) fn move_change(&self, i: usize, j: usize) -> f64 {
        self.move_change[self.place(i) * self.capacity + self.place(j)]
    }

    /// `⟨d_i, d_j⟩`.
    pub(super) fn change_change(&self, i: usize, j: usize) -> f64 {
        self.change_change[self.place(i) * self.capacity + self.place(j)]
    }

    /// `⟨s_i, f⟩`.
    pub(super) fn move_plain(&self, i: usize) -> f64 {
        self.move_plain[self.place(i)]
    }

    /// `⟨d_i, f⟩`.
    pub(super) fn change_plain(&self, i: usize) -> f64 {
        self.change_plain[self.place(i)]
    }

    fn place(&self, age: usize) -> usize {
        place(self.capacity, self.newest, age)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for i in 0..8 {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Iterates of no meaning: `x`, `G(x)` and the image of their difference under `N = diag(1, 2, 3, …)`.
    fn iterate(point_count: usize, k: usize) -> [Vec<DVec3>; 3] {
        let number = |i: usize| ((i * 7919 + k * 104_729) % 1009) as f64 / 1009.0 - 0.5;
        let vector = |i: usize| DVec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
        let points: Vec<DVec3> = (0..point_count).map(vector).collect();
        let plain: Vec<DVec3> = (0..point_count).map(|i| vector(i + 17 * k + 5)).collect();
        let image = |(i, (x, g)): (usize, (&DVec3, &DVec3))| (*g - *x) * (i + 1) as f64;
        let image = points.iter().zip(&plain).enumerate().map(image).collect();
        [points, plain, image]
    }

    #[test]
    fn products_and_combinations_are_those_of_the_last_pairs() {
        // Three chunks, the last of them short; two pairs of five fall out of the window.
        let (n, capacity) = (2 * CHUNK_POINTS + 3, 3);
        let iterates: Vec<_> = (0..6).map(|k| iterate(n, k)).collect();
        let mut history = History::default();
        history.reset(capacity, n);
        for [points, plain, image] in &iterates {
            history.push(points, plain, Some(image), false);
        }
        assert_eq!(history.products().len(), capacity);
        let step = |k: usize, i: usize| iterates[k][1][i] - iterates[k][0][i];
        let moved = |age: usize, i: usize| iterates[5 - age][0][i] - iterates[4 - age][0][i];
        let changed = |age: usize, i: usize| step(5 - age, i) - step(4 - age, i);
        let product = |a: &dyn Fn(usize) -> DVec3, b: &dyn Fn(usize) -> DVec3| {
            (0..n).map(|i| (i + 1) as f64 * a(i).dot(b(i))).sum::<f64>()
        };
        let assert_near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-9 * (n * n) as f64, "{found} is not {expected}");
        };
        let f = |i: usize| step(5, i);
        let mut combination = Combination::default();
        combination.reset(capacity);
        combination.plain = 0.75;
        for a in 0..capacity {
            (combination.moves[a], combination.changes[a]) = (0.5 - a as f64, 1.5 + a as f64);
            assert_near(history.products().move_plain(a), product(&|i| moved(a, i), &f));
            assert_near(history.products().change_plain(a), product(&|i| changed(a, i), &f));
            for b in 0..capacity {
                assert_near(history.products().change_change(a, b), product(&|i| changed(a, i), &|i| changed(b, i)));
                if b <= a {
                    assert_near(history.products().move_change(a, b), product(&|i| moved(a, i), &|i| changed(b, i)));
                }
            }
        }
        let mut direction = vec![DVec3::ZERO; n];
        history.combine(&combination, &mut direction, false);
        let expected = |i: usize| {
            let pairs = |a: usize| combination.moves[a] * moved(a, i) + combination.changes[a] * changed(a, i);
            0.75 * f(i) + (0..capacity).map(pairs).sum::<DVec3>()
        };
        assert!((0..n).all(|i| (direction[i] - expected(i)).length() < 1e-13));
        assert_near(history.products().plain_along(&combination), product(&f, &|i| direction[i]));
    }

    #[test]
    fn a_euclidean_history_is_one_whose_metric_is_the_identity() {
        // Two chunks; two pairs of five fall out of the window.
        let (n, capacity) = (CHUNK_POINTS + 3, 3);
        let (mut euclidean, mut any) = (History::default(), History::default());
        euclidean.reset(capacity, n);
        any.reset(capacity, n);
        for k in 0..6 {
            let [points, plain, _] = iterate(n, k);
            let image: Vec<DVec3> = plain.iter().zip(&points).map(|(g, x)| *g - *x).collect();
            euclidean.push(&points, &plain, None, false);
            any.push(&points, &plain, Some(&image), false);
        }
        let mut combination = Combination::default();
        combination.reset(capacity);
        for a in 0..capacity {
            (combination.moves[a], combination.changes[a]) = (0.5 - a as f64, 0.5 - a as f64);
            assert_eq!(euclidean.products().change_plain(a), any.products().change_plain(a));
            assert!(
                (0..capacity).all(|b| euclidean.products().change_change(a, b) == any.products().change_change(a, b))
            );
        }
        assert_eq!(
            euclidean.products().plain_squared(),
            any.products().plain_along(&Combination { plain: 1.0, ..zeros(capacity) })
        );
        let direction = |history: &mut History| {
            let mut direction = vec![DVec3::ZERO; n];
            history.combine(&combination, &mut direction, false);
            direction
        };
        let pairs = direction(&mut euclidean).into_iter().zip(direction(&mut any));
        pairs.for_each(|(found, expected)| assert!(found.distance(expected) < 1e-13, "{found} is not {expected}"));
    }

    fn zeros(length: usize) -> Combination {
        Combination { plain: 0.0, moves: vec![0.0; length], changes: vec![0.0; length] }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let n = 9 * CHUNK_POINTS + 100;
        let run = |is_parallel: bool| {
            let (mut history, mut combination) = (History::default(), Combination::default());
            history.reset(4, n);
            for k in 0..6 {
                let [points, plain, image] = iterate(n, k);
                history.push(&points, &plain, Some(&image), is_parallel);
            }
            combination.reset(4);
            combination.moves.fill(0.3);
            combination.changes.fill(-0.7);
            let mut direction = vec![DVec3::ZERO; n];
            history.combine(&combination, &mut direction, is_parallel);
            let products = [
                history.products().plain_along(&combination),
                history.products().change_change(1, 2),
                history.products().move_change(3, 0),
            ];
            (direction, products.map(f64::to_bits))
        };
        let serial = run(false);
        for thread_count in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
            assert!(pool.install(|| run(true)) == serial, "{thread_count} threads");
        }
    }
}
