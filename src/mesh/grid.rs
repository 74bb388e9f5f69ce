//! Grids of points: rows and columns, open or closed in either direction.

use glam::DVec3;

use super::{Mesh, Topology};
use crate::error::{Error, Result, Status};

/// Points in rows and columns; four neighbours make a face.
///
/// Point `(i, j)`, row `i` and column `j`, is `points[i * columns + j]`. Face `(i, j)` has the corners `(i, j)`, `(i + 1, j)`,
/// `(i + 1, j + 1)`, `(i, j + 1)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    points: Vec<DVec3>,
    rows: usize,
    columns: usize,
    wraps: [bool; 2],
}

impl Grid {
    /// A grid of `rows * columns` points, row by row. `wraps[0]`: row 0 follows the last row; `wraps[1]`: column 0 follows the
    /// last column.
    ///
    /// # Errors
    /// Fewer than 2 rows or columns (3 where they wrap), another number of points, or a coordinate that is not finite. The
    /// place is `rows`, `columns`, `points` or `points[i]`.
    pub fn new(points: Vec<DVec3>, rows: usize, columns: usize, wraps: [bool; 2]) -> Result<Self> {
        for (name, count, wraps) in [("rows", rows, wraps[0]), ("columns", columns, wraps[1])] {
            let least = if wraps { 3 } else { 2 };
            if count < least {
                let reason = format!("expected at least {least}, found {count}");
                return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
            }
        }
        if rows.checked_mul(columns) != Some(points.len()) {
            let reason = format!("expected {rows} rows of {columns}, found {} points", points.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        if u32::try_from(points.len()).is_err() {
            let reason = format!("{} points do not fit 32-bit indices", points.len());
            return Err(Error::new(Status::TooLarge, reason).at("points"));
        }
        check_finite("points", &points)?;
        Ok(Self { points, rows, columns, wraps })
    }

    /// The same rows and columns with other points.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn with_points(&self, points: Vec<DVec3>) -> Result<Self> {
        Self::new(points, self.rows, self.columns, self.wraps)
    }

    /// All points, row by row.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Whether row 0 follows the last row, and column 0 the last column.
    pub fn wraps(&self) -> [bool; 2] {
        self.wraps
    }

    /// The number of edges along a column (one more than rows of faces would need points, less one where it is open), and
    /// along a row; face `(i, j)` exists for `i` and `j` below them.
    pub fn spans(&self) -> [usize; 2] {
        [self.rows - usize::from(!self.wraps[0]), self.columns - usize::from(!self.wraps[1])]
    }

    /// The index of point `(i, j)`; one row or column beyond the last is the first.
    pub fn index(&self, i: usize, j: usize) -> usize {
        let around = |at: usize, count: usize| if at == count { 0 } else { at };
        around(i, self.rows) * self.columns + around(j, self.columns)
    }

    /// Point `(i, j)`; one row or column beyond the last is the first.
    pub fn at(&self, i: usize, j: usize) -> DVec3 {
        self.points[self.index(i, j)]
    }

    /// The points of row `i`.
    pub fn row(&self, i: usize) -> &[DVec3] {
        &self.points[i * self.columns..(i + 1) * self.columns]
    }

    /// The points of column `j`.
    pub fn column(&self, j: usize) -> Vec<DVec3> {
        (0..self.rows).map(|i| self.at(i, j)).collect()
    }

    /// The indices of the corners of every face, face `(i, j)` at `i * spans()[1] + j`.
    pub fn quads(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let [rows, columns] = self.spans();
        let quad = |i, j| [self.index(i, j), self.index(i + 1, j), self.index(i + 1, j + 1), self.index(i, j + 1)];
        (0..rows).flat_map(move |i| (0..columns).map(move |j| quad(i, j)))
    }

    /// The corners of face `(i, j)`.
    pub fn corners(&self, i: usize, j: usize) -> [DVec3; 4] {
        [self.at(i, j), self.at(i + 1, j), self.at(i + 1, j + 1), self.at(i, j + 1)]
    }

    /// The mesh of all faces; point and face indices are those of the grid.
    pub fn mesh(&self) -> Mesh {
        let faces = self.quads().map(|quad| quad.map(|corner| corner as u32).to_vec()).collect();
        Mesh { points: self.points.clone(), faces }
    }

    /// The diagonal of the box that holds all points, along the axes.
    pub fn diagonal(&self) -> f64 {
        diagonal(&self.points)
    }

    /// The grids that a mesh of quads consists of, one for each component, in the order of their first faces. The first edge
    /// of that face runs along column 0. Each comes with the index in the mesh of each of its points.
    ///
    /// # Errors
    /// Status `NotGrid`: a face has not four corners, an edge has more than two faces, an inner point has not four faces, or
    /// the component's faces form no rectangle, tube or torus. The place is `faces[i]` or `points[i]`.
    pub fn of_mesh(mesh: &Mesh) -> Result<Vec<(Self, Vec<u32>)>> {
        mesh.check_polygons()?;
        let walk = Walk::new(mesh)?;
        let mut is_used = vec![false; mesh.faces.len()];
        let mut grids = Vec::new();
        for face in 0..mesh.faces.len() {
            if is_used[face] {
                continue;
            }
            let (indices, rows, columns, wraps) = walk.grid(face, &mut is_used)?;
            let points = indices.iter().map(|&point| mesh.points[point as usize]).collect();
            let not_grid = |error: Error| Error::new(Status::NotGrid, error.to_string()).at(format!("faces[{face}]"));
            grids.push((Self::new(points, rows, columns, wraps).map_err(not_grid)?, indices));
        }
        Ok(grids)
    }
}

/// Refuses coordinates that are not finite; the place is `name[i]`.
pub(crate) fn check_finite(name: &str, points: &[DVec3]) -> Result<()> {
    match points.iter().position(|point| !point.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let reason = format!("expected finite coordinates, found {}", points[i]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("{name}[{i}]")))
        }
    }
}

/// As [`check_finite`], of one point.
pub(crate) fn check_finite_point(name: &str, point: DVec3) -> Result<()> {
    check_finite(name, &[point]).map_err(|error| error.with_place(name))
}

/// The diagonal of the box that holds `points`, along the axes; 0 without points.
pub fn diagonal(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    if points.is_empty() { 0.0 } else { low.distance(high) }
}

/// From face to face across edges.
struct Walk<'a> {
    mesh: &'a Mesh,
    /// For each face and each of its four edges (corner to next corner), the face across, if any, and its edge there.
    across: Vec<[Option<(usize, usize)>; 4]>,
}

impl<'a> Walk<'a> {
    fn new(mesh: &'a Mesh) -> Result<Self> {
        let not_grid = |reason: String| Error::new(Status::NotGrid, reason);
        if let Some(face) = mesh.faces.iter().position(|face| face.len() != 4) {
            let reason = format!("expected a quad, found {} corners", mesh.faces[face].len());
            return Err(not_grid(reason).at(format!("faces[{face}]")));
        }
        let topology = Topology::new(mesh)?;
        let is_on_boundary = topology.boundary_points();
        let mut face_count = vec![0; mesh.points.len()];
        mesh.faces.iter().flatten().for_each(|&point| face_count[point as usize] += 1);
        let wrong = |&point: &usize| {
            let count = face_count[point];
            count > 0 && (if is_on_boundary[point] { count > 2 } else { count != 4 })
        };
        if let Some(point) = (0..mesh.points.len()).find(wrong) {
            let expected = if is_on_boundary[point] { "one or two faces at a boundary point" } else { "four faces" };
            let reason = format!("expected {expected}, found {}", face_count[point]);
            return Err(not_grid(reason).at(format!("points[{point}]")));
        }
        let edges = |face: usize| (0..4).map(move |k| (mesh.faces[face][k], mesh.faces[face][(k + 1) % 4], k));
        let mut at_edge = std::collections::BTreeMap::<_, Vec<(usize, usize)>>::new();
        for face in 0..mesh.faces.len() {
            edges(face).for_each(|(a, b, k)| at_edge.entry((a.min(b), a.max(b))).or_default().push((face, k)));
        }
        let mut across = vec![[None; 4]; mesh.faces.len()];
        for faces in at_edge.values() {
            match faces[..] {
                [_] => {}
                [a, b] => {
                    across[a.0][a.1] = Some(b);
                    across[b.0][b.1] = Some(a);
                }
                _ => {
                    let reason = format!("expected at most two faces at an edge, found {}", faces.len());
                    return Err(not_grid(reason).at(format!("faces[{}]", faces[2].0)));
                }
            }
        }
        Ok(Self { mesh, across })
    }

    /// Goes on through the opposite edge until a boundary or the first face again: the (face, entering edge) met.
    fn line(&self, start: (usize, usize)) -> (Vec<(usize, usize)>, bool) {
        let mut line = vec![start];
        loop {
            let (face, edge) = line[line.len() - 1];
            match self.across[face][(edge + 2) % 4] {
                None => return (line, false),
                Some(next) if next == start => return (line, true),
                // A line that meets itself otherwise is no grid; it is recognised by its length.
                Some(_) if line.len() > self.mesh.faces.len() => return (line, false),
                Some(next) => line.push(next),
            }
        }
    }

    /// The grid of the component of `face`.
    fn grid(&self, face: usize, is_used: &mut [bool]) -> Result<(Vec<u32>, usize, usize, [bool; 2])> {
        // Edge 3 of a face runs from corner 3 to corner 0, edge 0 from 0 to 1. Column 0 runs along edge 0: stepping through
        // edge 1 goes to the next row, through edge 2 to the next column. Start where no face is before.
        let back = |start: (usize, usize)| {
            let (line, is_closed) = self.line((start.0, (start.1 + 2) % 4));
            let (last, entered) = line[line.len() - 1];
            if is_closed { (start, true) } else { ((last, (entered + 2) % 4), false) }
        };
        // Along rows (entered through edge 3, left through edge 1), then along columns. Entering edges of one face: the side
        // edge of a face entered at `e` for its row direction is `e + 1`.
        let ((first, entered), wraps_rows) = back((face, 3));
        let ((first, side), wraps_columns) = back((first, (entered + 1) % 4));
        let start = (first, (side + 3) % 4);
        let (down, _) = self.line(start);
        let corner = |(face, entered): (usize, usize), k: usize| self.mesh.faces[face][(entered + k) % 4];
        let mut lines = Vec::new();
        for &(face, entered) in &down {
            // Entered at edge e = (corner 3, corner 0) in the face's own order; the column direction enters at e + 1.
            let (line, is_closed) = self.line((face, (entered + 1) % 4));
            if is_closed != wraps_columns || line.len() != lines.first().map_or(line.len(), |l: &Vec<_>| l.len()) {
                let reason = "its rows have different lengths";
                return Err(Error::new(Status::NotGrid, reason).at(format!("faces[{face}]")));
            }
            lines.push(line);
        }
        for &(face, _) in lines.iter().flatten() {
            if std::mem::replace(&mut is_used[face], true) {
                let reason = "its rows and columns cross themselves";
                return Err(Error::new(Status::NotGrid, reason).at(format!("faces[{face}]")));
            }
        }
        // A face that is entered at edge e along its row of faces: corners e (previous row, this column) ... in the face's
        // order: e, e+1 at this column, e+2, e+3 at the next.
        let (rows, columns) = (lines.len() + usize::from(!wraps_rows), lines[0].len() + usize::from(!wraps_columns));
        let mut indices = vec![0; rows * columns];
        for (i, line) in lines.iter().enumerate() {
            for (j, &place) in line.iter().enumerate() {
                let around = |at: usize, count: usize| if at == count { 0 } else { at };
                let mut put =
                    |i: usize, j: usize, point: u32| indices[around(i, rows) * columns + around(j, columns)] = point;
                put(i, j, corner(place, 0));
                put(i + 1, j, corner(place, 1));
                put(i + 1, j + 1, corner(place, 2));
                put(i, j + 1, corner(place, 3));
            }
        }
        Ok((indices, rows, columns, [wraps_rows, wraps_columns]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::{height_field, rhombille};

    fn torus(rows: usize, columns: usize, wraps: [bool; 2]) -> Grid {
        let point = |k: usize| {
            let (i, j) = (k / columns, k % columns);
            let (u, v) = (i as f64 / rows as f64 * std::f64::consts::TAU, j as f64 / columns as f64 * 6.0);
            DVec3::new((2.0 + v.cos()) * u.cos(), (2.0 + v.cos()) * u.sin(), v.sin())
        };
        Grid::new((0..rows * columns).map(point).collect(), rows, columns, wraps).unwrap()
    }

    #[test]
    fn a_grid_is_found_again_in_its_mesh() {
        for (rows, columns) in [(2, 2), (3, 5), (5, 3), (4, 4)] {
            for wraps in [[false; 2], [true, false], [false, true], [true; 2]] {
                if (wraps[0] && rows < 4) || (wraps[1] && columns < 4) {
                    continue;
                }
                let grid = torus(rows, columns, wraps);
                let found = Grid::of_mesh(&grid.mesh()).unwrap();
                assert_eq!(found.len(), 1);
                assert_eq!(found[0].0, grid, "{rows} {columns} {wraps:?}");
                assert_eq!(found[0].1, (0..grid.points().len() as u32).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn faces_in_any_order_and_turned_make_a_grid_with_the_same_faces() {
        let grid = torus(5, 4, [false; 2]);
        let mut mesh = grid.mesh();
        mesh.faces.rotate_left(7);
        for (k, face) in mesh.faces.iter_mut().enumerate() {
            face.rotate_left(k % 4);
        }
        let (found, indices) = Grid::of_mesh(&mesh).unwrap().remove(0);
        assert_eq!(found.points().len(), 20);
        let sorted = |faces: &mut dyn Iterator<Item = Vec<u32>>| {
            let mut faces: Vec<Vec<u32>> = faces.collect();
            faces.iter_mut().for_each(|face| face.sort_unstable());
            faces.sort();
            faces
        };
        let own = found.quads().map(|quad| quad.map(|corner| indices[corner]).to_vec());
        assert_eq!(sorted(&mut own.collect::<Vec<_>>().into_iter()), sorted(&mut mesh.faces.into_iter()));
    }

    #[test]
    fn components_are_taken_alone_and_other_meshes_refused() {
        let mut two = height_field(3, 4, [0.0, 1.0], [0.0, 1.0], |x, y| x * y).unwrap();
        let count = two.points.len() as u32;
        let other = torus(4, 5, [true, false]).mesh();
        two.points.extend(&other.points);
        two.faces.extend(other.faces.iter().map(|face| face.iter().map(|corner| corner + count).collect::<Vec<_>>()));
        let found = Grid::of_mesh(&two).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(found[1].0.wraps(), [true, false]);
        let refusal = |mesh: &Mesh| Grid::of_mesh(mesh).unwrap_err();
        let stars = refusal(&rhombille(4, 4, 1.0, 0.0).unwrap());
        assert_eq!(stars.status(), Status::NotGrid);
        assert!(stars.place().starts_with("points["), "{stars}");
        two.faces[2].pop();
        assert_eq!(refusal(&two).to_string(), "faces[2]: expected a quad, found 3 corners");
    }

    #[test]
    fn counts_must_fit() {
        let points = vec![DVec3::ZERO; 6];
        let refusal = |points: &[DVec3], rows, columns, wraps| {
            Grid::new(points.to_vec(), rows, columns, wraps).unwrap_err().to_string()
        };
        assert_eq!(refusal(&points, 1, 6, [false; 2]), "rows: expected at least 2, found 1");
        assert_eq!(refusal(&points, 3, 2, [false, true]), "columns: expected at least 3, found 2");
        assert_eq!(refusal(&points, 3, 3, [false; 2]), "points: expected 3 rows of 3, found 6 points");
        let mut bad = points.clone();
        bad[4].y = f64::NAN;
        assert!(refusal(&bad, 2, 3, [false; 2]).starts_with("points[4]: expected finite coordinates"));
    }
}
