//! Combescure transformations of grids: the parallel grid of which two lines of edges have given lengths.
//!
//! Grids are parallel when all their edges are. A planar quad `A B C D` and two edges of a parallel one, `A'B'` and `A'D'`,
//! determine its fourth corner: the line through `B'` along `BC` meets the line through `D'` along `DC`. So the lengths along
//! one row and one column determine the grid, face by face (section 2.5).
//!
//! With `u = C − B`, `w = C − D`, `g = D' − B'` and `m = u × w`, the lines `B' + l u` and `D' + l' w` meet for
//! `l = ((g × w)·m) / m²`, off each other by `|g·m| / |m|`. Written in vectors, neither angles nor their signs are needed; the
//! printed equation (4) is right only with the exterior angle at `A` and another sign. With all four interior angles it reads
//! `(l₀ − l₃ cos α; l₃ sin α) = [[cos β, −cos(α+δ)], [sin β, sin(α+δ)]] (l₁; l₂)`; a test compares the two.
//!
//! Directions are always those of the source, never of what was just computed: edges are parallel to rounding however far a
//! grid goes on. Lengths are signed; an edge of negative length is reversed.

use glam::DVec3;

use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::PARALLEL;
use crate::linalg::dense::{ROUND_OFF, Svd};
use crate::mesh::Grid;

/// Sine of the angle at the fourth corner below which opposite edges do not meet in a point that is worth its digits.
const SINGULAR: f64 = 1e-10;

/// How far the two lines that meet in the fourth corner may pass each other, over the quad's size.
const NOT_PLANAR: f64 = 1e-8;

/// How far a ring may be open, over the grid's diagonal.
const NOT_CLOSED: f64 = 1e-9;

/// The signed lengths, in model units, of the edges along column 0 (from row to row) and along row 0 of a transformed grid:
/// as many as [`Grid::spans`] says. An edge below 0 points the other way than in the source.
#[derive(Clone, Debug, PartialEq)]
pub struct Lengths {
    /// Along column 0.
    pub column: Vec<f64>,
    /// Along row 0.
    pub row: Vec<f64>,
}

impl Lengths {
    /// The lengths of a grid's own edges: the transformation with them gives the grid itself.
    pub fn of(grid: &Grid) -> Self {
        let [rows, columns] = grid.spans();
        Self {
            column: (0..rows).map(|i| grid.at(i, 0).distance(grid.at(i + 1, 0))).collect(),
            row: (0..columns).map(|j| grid.at(0, j).distance(grid.at(0, j + 1))).collect(),
        }
    }

    /// The lengths along polylines that replace column 0 and row 0; their edges must be parallel to those of the grid, the
    /// other way round where a length comes out below 0.
    ///
    /// # Errors
    /// Another number of points than the grid has there, or an edge that is not parallel (the sine of the angle above 1e-9).
    pub fn of_polylines(grid: &Grid, column: &[DVec3], row: &[DVec3]) -> Result<Self> {
        let along = |name: &str, polyline: &[DVec3], count: usize, source: &dyn Fn(usize) -> DVec3| {
            if polyline.len() != count + 1 {
                let reason = format!("expected {} points, found {}", count + 1, polyline.len());
                return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
            }
            (0..count)
                .map(|k| {
                    let (edge, direction) = (polyline[k + 1] - polyline[k], source(k).normalize_or_zero());
                    if edge.cross(direction).length() <= 1e-9 * edge.length() {
                        return Ok(edge.dot(direction));
                    }
                    let sine = edge.cross(direction).length() / edge.length();
                    let reason =
                        format!("expected an edge parallel to the grid's, found one at an angle of sine {sine:e}");
                    Err(Error::new(Status::InvalidValue, reason).at(format!("{name}[{k}]")))
                })
                .collect::<Result<Vec<f64>>>()
        };
        let [rows, columns] = grid.spans();
        Ok(Self {
            column: along("column", column, rows, &|i| grid.at(i + 1, 0) - grid.at(i, 0))?,
            row: along("row", row, columns, &|j| grid.at(0, j + 1) - grid.at(0, j))?,
        })
    }

    /// Each length times its factor.
    ///
    /// # Errors
    /// Another number of factors than of lengths.
    pub fn scaled(&self, column_factors: &[f64], row_factors: &[f64]) -> Result<Self> {
        check_count("column_factors", column_factors, self.column.len())?;
        check_count("row_factors", row_factors, self.row.len())?;
        let product = |lengths: &[f64], factors: &[f64]| lengths.iter().zip(factors).map(|(l, f)| l * f).collect();
        Ok(Self { column: product(&self.column, column_factors), row: product(&self.row, row_factors) })
    }
}

pub(super) fn check_count(name: &str, values: &[f64], count: usize) -> Result<()> {
    if values.len() != count {
        let reason = format!("expected {count}, found {}", values.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
    }
    values.iter().enumerate().try_for_each(|(i, &value)| finite(&format!("{name}[{i}]"), value).map(|_| ()))
}

/// A transformed grid, and how many of its edges point the other way than in the source.
#[derive(Clone, Debug, PartialEq)]
pub struct Transformed {
    /// The parallel grid.
    pub grid: Grid,
    /// The number of reversed edges. Where there are some, quads may cross themselves.
    pub reversed_count: usize,
}

/// The grid parallel to `grid` whose point `(0, 0)` is `origin` and whose column 0 and row 0 have the given lengths.
///
/// # Errors
/// A count that does not fit, or a number that is not finite. Status `Singular`: the edges that would meet in the fourth corner
/// of a quad are parallel; `Degenerate`: a side of a quad has no length; `NotPlanar`: they pass each other; the place is
/// `faces[i]`. `NotClosed`: a direction wraps and the lengths do not close it (see [`close`]); the reason has the gap.
pub fn combescure(grid: &Grid, lengths: &Lengths, origin: DVec3) -> Result<Transformed> {
    let [rows, columns] = grid.spans();
    check_count("column lengths", &lengths.column, rows)?;
    check_count("row lengths", &lengths.row, columns)?;
    crate::mesh::grid::check_finite("origin", &[origin]).map_err(|error| error.with_place("origin"))?;
    let open = Open { grid, rows: rows + 1, columns: columns + 1 };
    let (points, reversed_count) = open.propagate(lengths, origin)?;
    // A closed direction ends with a copy of its first line.
    let kept = (0..grid.rows()).flat_map(|i| (0..grid.columns()).map(move |j| (i, j)));
    let image =
        Grid::new(kept.map(|(i, j)| points[open.index(i, j)]).collect(), grid.rows(), grid.columns(), grid.wraps())?;
    let gap = open.gaps(&points).chunks_exact(3).map(|gap| DVec3::from_slice(gap).length()).fold(0.0, f64::max);
    let diagonal = image.diagonal();
    if gap > NOT_CLOSED * diagonal {
        let reason = format!("the lengths leave a gap of {gap:e}; the diagonal is {diagonal}");
        return Err(Error::new(Status::NotClosed, reason).at("lengths"));
    }
    Ok(Transformed { grid: image, reversed_count })
}

/// The lengths nearest to the given ones, by least squares, that close a grid which wraps; those given where it does not.
///
/// Points depend on the lengths linearly, and so does the gap: it is `S λ`, whose columns are the gaps that unit lengths leave.
/// The correction of least norm that annuls it is `−S⁺ (S λ)`.
///
/// # Errors
/// As [`combescure`], but for the gap.
pub fn close(grid: &Grid, lengths: &Lengths) -> Result<Lengths> {
    let [rows, columns] = grid.spans();
    check_count("column lengths", &lengths.column, rows)?;
    check_count("row lengths", &lengths.row, columns)?;
    if grid.wraps() == [false; 2] {
        return Ok(lengths.clone());
    }
    let open = Open { grid, rows: rows + 1, columns: columns + 1 };
    let gaps = |lengths: &Lengths| Ok(open.gaps(&open.propagate(lengths, DVec3::ZERO)?.0));
    let mut unit = Lengths { column: vec![0.0; rows], row: vec![0.0; columns] };
    let mut matrix: Vec<Vec<f64>> = Vec::with_capacity(rows + columns);
    for k in 0..rows + columns {
        let place = |unit: &mut Lengths, value: f64| match k.checked_sub(rows) {
            None => unit.column[k] = value,
            Some(k) => unit.row[k] = value,
        };
        place(&mut unit, 1.0);
        matrix.push(gaps(&unit)?);
        place(&mut unit, 0.0);
    }
    let gap = gaps(lengths)?;
    let svd = Svd::new(gap.len(), &matrix)
        .ok_or_else(|| Error::new(Status::Degenerate, "the gaps that lengths leave are not finite").at("grid"))?;
    let correction = svd.least_norm(&gap, ROUND_OFF);
    let corrected = |lengths: &[f64], correction: &[f64]| lengths.iter().zip(correction).map(|(l, c)| l - c).collect();
    Ok(Lengths {
        column: corrected(&lengths.column, &correction[..rows]),
        row: corrected(&lengths.row, &correction[rows..]),
    })
}

/// The corner of a parallel quad opposite to the known one, from its neighbours `b` and `d` along the source's edges `u` and `w`
/// to that corner; `None` where these are parallel. The same as within [`combescure`], for one quad.
pub(super) fn fourth_corner(b: DVec3, d: DVec3, u: DVec3, w: DVec3) -> Option<DVec3> {
    let m = u.cross(w);
    let squared = m.length_squared();
    let is_singular = !(squared > SINGULAR * SINGULAR * u.length_squared() * w.length_squared());
    (!is_singular).then(|| b + ((d - b).cross(w).dot(m) / squared) * u)
}

/// A grid with closed directions cut open: the first line again at the end.
struct Open<'a> {
    grid: &'a Grid,
    rows: usize,
    columns: usize,
}

impl Open<'_> {
    fn index(&self, i: usize, j: usize) -> usize {
        i * self.columns + j
    }

    /// All points row by row, and the number of reversed edges.
    fn propagate(&self, lengths: &Lengths, origin: DVec3) -> Result<(Vec<DVec3>, usize)> {
        let grid = self.grid;
        let mut reversed = lengths.column.iter().chain(&lengths.row).filter(|&&length| length < 0.0).count();
        let mut points = Vec::with_capacity(self.rows * self.columns);
        let step = |from: DVec3, to: DVec3, length: f64| length * (to - from).normalize_or_zero();
        let mut corner = origin;
        points.push(corner);
        for (j, &length) in lengths.row.iter().enumerate() {
            corner += step(grid.at(0, j), grid.at(0, j + 1), length);
            points.push(corner);
        }
        let mut source_above: Vec<DVec3> = (0..self.columns).map(|j| grid.at(0, j)).collect();
        for (i, &length) in lengths.column.iter().enumerate() {
            let source: Vec<DVec3> = (0..self.columns).map(|j| grid.at(i + 1, j)).collect();
            let mut left = points[self.index(i, 0)] + step(source_above[0], source[0], length);
            points.push(left);
            for j in 0..self.columns - 1 {
                let above = points[self.index(i, j + 1)];
                // C = (i + 1, j + 1) is met from B = (i + 1, j) and from D = (i, j + 1).
                let (u, w) = (source[j + 1] - source[j], source[j + 1] - source_above[j + 1]);
                let g = above - left;
                let m = u.cross(w);
                let squared = m.length_squared();
                if !(squared > SINGULAR * SINGULAR * u.length_squared() * w.length_squared()) {
                    return Err(self.singular(i, j, u, w));
                }
                let across = 1.0 / squared;
                let l1 = g.cross(w).dot(m) * across;
                let l2 = g.cross(u).dot(m) * across;
                let passed = g.dot(m);
                if !(passed * passed <= NOT_PLANAR * NOT_PLANAR * squared * size_squared(g, l1 * u)) {
                    let reason = format!(
                        "its edges pass each other by {:e} where they should meet",
                        passed.abs() / squared.sqrt()
                    );
                    return Err(Error::new(Status::NotPlanar, reason).at(self.face(i, j)));
                }
                reversed += usize::from(l1 < 0.0) + usize::from(l2 < 0.0);
                left += l1 * u;
                points.push(left);
            }
            source_above = source;
        }
        crate::mesh::grid::check_finite("points", &points)?;
        Ok((points, reversed))
    }

    fn face(&self, i: usize, j: usize) -> String {
        format!("faces[{}]", i * (self.columns - 1) + j)
    }

    fn singular(&self, i: usize, j: usize, u: DVec3, w: DVec3) -> Error {
        let is_point = |edge: DVec3| edge.length() <= PARALLEL * self.grid.diagonal();
        if is_point(u) || is_point(w) {
            return Error::new(Status::Degenerate, "one of its edges has no length").at(self.face(i, j));
        }
        let reason = "the edges that meet in its last corner are parallel, so their lengths are not determined";
        Error::new(Status::Singular, reason).at(self.face(i, j))
    }

    /// From first lines to their copies: three coordinates for each point of them, of the directions that wrap.
    fn gaps(&self, points: &[DVec3]) -> Vec<f64> {
        let [wraps_rows, wraps_columns] = self.grid.wraps();
        let gap = |from: usize, to: usize| (points[to] - points[from]).to_array();
        let rows = (0..self.columns).map(|j| gap(self.index(0, j), self.index(self.rows - 1, j)));
        let columns = (0..self.rows).map(|i| gap(self.index(i, 0), self.index(i, self.columns - 1)));
        let kept = rows.filter(|_| wraps_rows).chain(columns.filter(|_| wraps_columns));
        kept.flatten().collect()
    }
}

/// The square of a length at which a quad can be measured: its diagonal or an edge, whichever is longer.
fn size_squared(diagonal: DVec3, edge: DVec3) -> f64 {
    diagonal.length_squared().max(edge.length_squared())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::parallel::check_parallel;
    use crate::geometry::canal::quality::{Quality, largest};
    use crate::geometry::random::Random;

    fn distance(a: &Grid, b: &Grid) -> f64 {
        a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn random_lengths_keep_directions_planes_and_circles_and_are_undone() {
        let mut random = Random(17);
        let grid = Cyclide::new().grid([0.2, 2.2], [-0.9, 1.4], 41, 26);
        let own = Lengths::of(&grid);
        let mut factors = |count: usize| (0..count).map(|_| random.between(0.5, 2.0)).collect::<Vec<f64>>();
        let lengths = own.scaled(&factors(40), &factors(25)).unwrap();
        let image = combescure(&grid, &lengths, DVec3::new(5.0, -1.0, 0.3)).unwrap().grid;
        let parallel = check_parallel(&grid, &image).unwrap();
        let quality = Quality::of(&image);
        assert!(parallel.largest_sine < 1e-12, "{}", parallel.largest_sine);
        assert!(largest(&quality.planarity) < 1e-11 && largest(&quality.concyclicity) < 1e-11);
        let back = combescure(&image, &own, grid.at(0, 0)).unwrap().grid;
        assert!(distance(&back, &grid) < 1e-10 * grid.diagonal(), "{}", distance(&back, &grid));
    }

    #[test]
    fn equal_factors_give_a_similar_grid() {
        let grid = Cyclide::new().grid([0.2, 1.2], [-0.4, 1.0], 6, 5);
        for factor in [1.0, 3.5, -0.5] {
            let lengths = Lengths::of(&grid).scaled(&[factor; 5], &[factor; 4]).unwrap();
            let image = combescure(&grid, &lengths, factor * grid.at(0, 0)).unwrap();
            let scaled = grid.points().iter().zip(image.grid.points()).map(|(a, b)| (factor * *a).distance(*b));
            assert!(scaled.fold(0.0, f64::max) < 1e-14 * grid.diagonal() * factor.abs().max(1.0));
            let edge_count = 5 * 5 + 4 * 6;
            assert_eq!(image.reversed_count, if factor < 0.0 { edge_count } else { 0 });
        }
    }

    #[test]
    fn the_interior_form_of_equation_four_gives_the_same_lengths() {
        let mut random = Random(23);
        for _ in 0..1000 {
            let mut angles: [f64; 4] = std::array::from_fn(|k| (k as f64 + random.between(0.1, 0.9)) * TAU / 4.0);
            angles.sort_by(f64::total_cmp);
            let [a, b, c, d] = angles.map(|angle| DVec3::new(angle.cos(), angle.sin(), 0.0));
            let (l0, l3) = (random.between(0.2, 2.0), random.between(0.2, 2.0));
            // Rows run a d / b c: A = (0, 0), B = (1, 0), C = (1, 1), D = (0, 1).
            let grid = Grid::new(vec![a, d, b, c], 2, 2, [false; 2]).unwrap();
            let lengths = Lengths { column: vec![l0], row: vec![l3] };
            let image = combescure(&grid, &lengths, DVec3::ZERO).unwrap().grid;
            let l1 = (image.at(1, 1) - image.at(1, 0)).dot((c - b).normalize());
            let l2 = (image.at(1, 1) - image.at(0, 1)).dot((c - d).normalize());
            let angle = |at: DVec3, from: DVec3, to: DVec3| (from - at).angle_between(to - at);
            let (alpha, beta, delta) = (angle(a, b, d), angle(b, a, c), angle(d, a, c));
            let left = [l0 - l3 * alpha.cos(), l3 * alpha.sin()];
            let right = [beta.cos() * l1 - (alpha + delta).cos() * l2, beta.sin() * l1 + (alpha + delta).sin() * l2];
            for k in 0..2 {
                assert!((left[k] - right[k]).abs() < 1e-12, "{left:?} {right:?}");
            }
        }
    }

    #[test]
    fn lengths_that_do_not_close_a_tube_are_refused_and_mended() {
        let mut random = Random(4);
        let cyclide = Cyclide::new();
        for (u, v) in [([0.0, TAU], [-0.4, 1.0]), ([0.2, 1.8], [0.0, TAU]), ([0.0, TAU], [0.0, TAU])] {
            let grid = cyclide.grid(u, v, 9, 8);
            let own = Lengths::of(&grid);
            assert!(distance(&combescure(&grid, &own, grid.at(0, 0)).unwrap().grid, &grid) < 1e-12);
            let mut factors = |count: usize| (0..count).map(|_| random.between(0.9, 1.1)).collect::<Vec<f64>>();
            let [rows, columns] = grid.spans();
            let lengths = own.scaled(&factors(rows), &factors(columns)).unwrap();
            assert_eq!(combescure(&grid, &lengths, DVec3::ZERO).unwrap_err().status(), Status::NotClosed);
            let closed = close(&grid, &lengths).unwrap();
            let image = combescure(&grid, &closed, DVec3::ZERO).unwrap().grid;
            assert!(check_parallel(&grid, &image).unwrap().largest_sine < 1e-9);
            assert!(distance(&image, &grid) > 1e-3);
            // Lengths that close already stay.
            let again = close(&grid, &closed).unwrap();
            assert!(again.row.iter().zip(&closed.row).all(|(a, b)| (a - b).abs() < 1e-9));
        }
    }

    #[test]
    fn quads_without_a_fourth_corner_are_named() {
        let refusal = |points: [[f64; 3]; 4]| {
            let grid = Grid::new(points.map(DVec3::from).to_vec(), 2, 2, [false; 2]).unwrap();
            let lengths = Lengths { column: vec![1.0], row: vec![2.0] };
            let error = combescure(&grid, &lengths, DVec3::ZERO).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let (a, b, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let place = "faces[0]".to_owned();
        // C on the line B D; C at B; C lifted; C at D.
        assert_eq!(refusal([a, d, b, [0.5, 0.5, 0.0]]), (Status::Singular, place.clone()));
        assert_eq!(refusal([a, d, b, b]), (Status::Degenerate, place.clone()));
        assert_eq!(refusal([a, d, b, d]), (Status::Degenerate, place.clone()));
        assert_eq!(refusal([a, d, b, [1.0, 1.0, 0.1]]), (Status::NotPlanar, place));
    }

    #[test]
    fn lengths_come_from_parallel_polylines_only() {
        let grid = Cyclide::new().grid([0.2, 1.2], [-0.4, 1.0], 4, 3);
        let lengths = Lengths::of(&grid).scaled(&[2.0, -1.0, 0.5], &[1.0, 3.0]).unwrap();
        let image = combescure(&grid, &lengths, DVec3::ZERO).unwrap().grid;
        let (column, row) = (image.column(0), image.row(0).to_vec());
        let read = Lengths::of_polylines(&grid, &column, &row).unwrap();
        assert!(read.column.iter().zip(&lengths.column).all(|(a, b)| (a - b).abs() < 1e-14));
        let mut bent = row.clone();
        bent[2] += 0.01 * DVec3::Z;
        assert_eq!(Lengths::of_polylines(&grid, &column, &bent).unwrap_err().place(), "row[1]");
        assert_eq!(Lengths::of_polylines(&grid, &column[1..], &row).unwrap_err().place(), "column");
        let refusal = |column: Vec<f64>| {
            combescure(&grid, &Lengths { column, row: vec![1.0; 2] }, DVec3::ZERO).unwrap_err().to_string()
        };
        assert_eq!(refusal(vec![1.0; 2]), "column lengths: expected 3, found 2");
        assert!(refusal(vec![1.0, f64::NAN, 1.0]).starts_with("column lengths[1]: expected a finite number"));
    }
}
