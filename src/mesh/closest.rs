//! The nearest point of a polyline or of a triangle mesh.
//!
//! The pieces (segments or triangles) lie in an R-tree of the crate rstar. It is searched here rather than by rstar, whose
//! queries allocate once a mesh has some hundred triangles, panic where a distance is not a number, and leave open which of
//! equally near pieces is found. Here it is the first in the order that they were given in.

use glam::DVec3;
use rstar::{AABB, ParentNode, RTree, RTreeNode, RTreeObject};

use crate::error::{Error, Result, Status};

/// The segments of a polyline or the triangles of a mesh, ready to be asked for the nearest point.
#[derive(Clone, Debug)]
pub struct ClosestPoints {
    tree: RTree<Piece>,
}

/// A segment (its last two corners are one) or a triangle.
#[derive(Clone, Debug)]
struct Piece {
    corners: [DVec3; 3],
    is_segment: bool,
    /// Its place in the order given.
    index: usize,
}

/// The nearest point so far.
struct Best {
    point: DVec3,
    squared_distance: f64,
    index: usize,
}

impl RTreeObject for Piece {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.corners;
        AABB::from_corners(a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
    }
}

impl ClosestPoints {
    /// The polyline through `points` in their order; if `is_closed`, from the last back to the first. Segments may have no
    /// length.
    ///
    /// # Errors
    /// Fewer than 2 points, or a coordinate that is not finite. The place is `points` or `points[i]`.
    pub fn of_polyline(points: &[DVec3], is_closed: bool) -> Result<Self> {
        check_points(points)?;
        if points.len() < 2 {
            let reason = format!("expected at least 2, found {}", points.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        let open = points.windows(2).map(|ends| [ends[0], ends[1]]);
        let closing = is_closed.then(|| [points[points.len() - 1], points[0]]);
        let piece = |(index, [a, b]): (usize, [DVec3; 2])| Piece { corners: [a, b, b], is_segment: true, index };
        Ok(Self { tree: RTree::bulk_load(open.chain(closing).enumerate().map(piece).collect()) })
    }

    /// The triangles of a mesh, each as three indices into `points`. They may be degenerate.
    ///
    /// # Errors
    /// No triangle, a coordinate that is not finite, or an index out of range. The place is `points[i]`, `triangles` or
    /// `triangles[i][j]`.
    pub fn of_triangles(points: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self> {
        check_points(points)?;
        if triangles.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found 0").at("triangles"));
        }
        let mut pieces = Vec::with_capacity(triangles.len());
        for (index, triangle) in triangles.iter().enumerate() {
            let mut corners = [DVec3::ZERO; 3];
            for (j, (corner, &at)) in corners.iter_mut().zip(triangle).enumerate() {
                let reason = || format!("{at} is out of range for {} points", points.len());
                let place = || format!("triangles[{index}][{j}]");
                let point = points.get(at as usize);
                *corner = *point.ok_or_else(|| Error::new(Status::IndexOutOfRange, reason()).at(place()))?;
            }
            pieces.push(Piece { corners, is_segment: false, index });
        }
        Ok(Self { tree: RTree::bulk_load(pieces) })
    }

    /// The point of all pieces that is nearest to `point`; of several, the one of the first piece. Finite for any finite
    /// `point`, even where squared distances overflow (beyond about 1e154): it then is a point of some piece.
    pub fn nearest(&self, point: DVec3) -> DVec3 {
        self.search(point).point
    }

    /// [`ClosestPoints::nearest`] and the index of its piece, in the order given; segment `i` runs from point `i` of the
    /// polyline to the next.
    pub fn nearest_on_piece(&self, point: DVec3) -> (DVec3, usize) {
        let best = self.search(point);
        // Only for a point that is not finite was no piece found.
        (best.point, if best.index == usize::MAX { 0 } else { best.index })
    }

    /// The pieces nearer to `point` than `distance`, as their indices, ascending, and their distances.
    pub fn within(&self, point: DVec3, distance: f64) -> Vec<(usize, f64)> {
        let mut found = Vec::new();
        let mut nodes = vec![self.tree.root()];
        while let Some(node) = nodes.pop() {
            for child in node.children() {
                match child {
                    RTreeNode::Leaf(piece) => {
                        let apart = piece.nearest(point).distance(point);
                        found.extend((apart < distance).then_some((piece.index, apart)));
                    }
                    RTreeNode::Parent(parent) => {
                        // Squares of tiny distances vanish: then look rather than miss.
                        let squared = squared_distance(&parent.envelope(), point);
                        nodes.extend((squared <= distance * distance).then_some(parent));
                    }
                }
            }
        }
        found.sort_unstable_by_key(|&(index, _)| index);
        found
    }

    fn search(&self, point: DVec3) -> Best {
        let mut best = Best { point, squared_distance: f64::INFINITY, index: usize::MAX };
        search(self.tree.root(), point, &mut best);
        best
    }
}

/// The squared distance from a point to a box.
fn squared_distance(envelope: &AABB<[f64; 3]>, point: DVec3) -> f64 {
    let [low, high] = [envelope.lower(), envelope.upper()].map(DVec3::from_array);
    point.distance_squared(point.clamp(low, high))
}

fn check_points(points: &[DVec3]) -> Result<()> {
    match points.iter().position(|point| !point.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let reason = format!("expected finite coordinates, found {}", points[i]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("points[{i}]")))
        }
    }
}

/// Searches `node`, nearer children first. The tree is about as deep as the logarithm of the number of pieces.
fn search(node: &ParentNode<Piece>, point: DVec3, best: &mut Best) {
    // rstar gives a node at most 6 children; more would be searched in any order, as the later ones here.
    let mut order = [(f64::INFINITY, usize::MAX); 8];
    let children = node.children();
    for (i, child) in children.iter().enumerate() {
        match child {
            RTreeNode::Leaf(piece) => best.take(piece, point),
            RTreeNode::Parent(parent) => match order.get_mut(i) {
                Some(place) => *place = (squared_distance(&parent.envelope(), point), i),
                None => search(parent, point, best),
            },
        }
    }
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (squared_distance, i) in order {
        // Equally near ones too: they may hold an earlier piece.
        if let Some(RTreeNode::Parent(parent)) = children.get(i)
            && squared_distance <= best.squared_distance
        {
            search(parent, point, best);
        }
    }
}

impl Best {
    /// Takes the nearest point of `piece` if it is nearer, or as near and of an earlier piece.
    fn take(&mut self, piece: &Piece, point: DVec3) {
        let nearest = piece.nearest(point);
        let squared_distance = nearest.distance_squared(point);
        let is_nearer = squared_distance < self.squared_distance
            || (squared_distance == self.squared_distance && piece.index < self.index);
        if is_nearer {
            *self = Self { point: nearest, squared_distance, index: piece.index };
        }
    }
}

impl Piece {
    fn nearest(&self, point: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        if self.is_segment {
            return nearest_of_segment(a, b, point);
        }
        if let Some(inner) = nearest_inside(self.corners, point) {
            return inner;
        }
        let mut best = nearest_of_segment(a, b, point);
        for other in [nearest_of_segment(b, c, point), nearest_of_segment(c, a, point)] {
            if other.distance_squared(point) < best.distance_squared(point) {
                best = other;
            }
        }
        best
    }
}

/// The nearest point of the segment from `a` to `b`. One of no length is its end `a`.
fn nearest_of_segment(a: DVec3, b: DVec3, point: DVec3) -> DVec3 {
    let along = b - a;
    let t = (point - a).dot(along) / along.length_squared();
    // In this order NaN (no length, or numbers that overflow) is the end `a`.
    if t >= 1.0 {
        b
    } else if t > 0.0 {
        // Unlike `a + t along` this cannot overflow.
        (1.0 - t) * a + t * b
    } else {
        a
    }
}

/// The foot of the perpendicular from `point` on the plane of the triangle, if it lies inside. `None` for one of no area:
/// what is nearest then lies on an edge.
///
/// With `n = (b − a) × (c − a)` the weights of the corners are the areas of the triangles that the foot makes with the
/// opposite edges over that of the whole, `n · ((c − b) × (p − b)) / n · n` and so on: the height of `p` drops out.
fn nearest_inside([a, b, c]: [DVec3; 3], point: DVec3) -> Option<DVec3> {
    let normal = (b - a).cross(c - a);
    let weight = |from: DVec3, to: DVec3| normal.dot((to - from).cross(point - from));
    let [u, v, w] = [weight(b, c), weight(c, a), weight(a, b)];
    // Their own sum, rather than n · n, makes them add up to 1. False for NaN too.
    let sum = u + v + w;
    (u >= 0.0 && v >= 0.0 && w >= 0.0 && sum > 0.0 && sum.is_finite())
        .then(|| (u / sum) * a + (v / sum) * b + (w / sum) * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fixed stream of numbers in `[0, 1)`.
    struct Stream(u64);

    impl Stream {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn vector(&mut self) -> DVec3 {
            2.0 * DVec3::new(self.next(), self.next(), self.next()) - 1.0
        }
    }

    /// The distance to a segment by the angle at its ends: beyond an end where that is obtuse, else twice the area over the
    /// base.
    fn distance_to_segment(a: DVec3, b: DVec3, p: DVec3) -> f64 {
        let base = a.distance(b);
        if base == 0.0 || (p - a).dot(b - a) <= 0.0 {
            return p.distance(a);
        }
        if (p - b).dot(a - b) <= 0.0 {
            return p.distance(b);
        }
        (p - a).cross(b - a).length() / base
    }

    /// The least distance to the segments parallel to `bc`, by the golden section: the distance to a convex set is a convex
    /// function of where the segment lies.
    fn distance_to_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
        let at = |s: f64| distance_to_segment(a.lerp(b, s), a.lerp(c, s), p);
        let (ratio, mut low, mut high) = (0.5 * (5.0_f64.sqrt() - 1.0), 0.0, 1.0);
        let (mut left, mut right) = (high - ratio * (high - low), low + ratio * (high - low));
        let (mut at_left, mut at_right) = (at(left), at(right));
        for _ in 0..80 {
            if at_left < at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - ratio * (high - low);
                at_left = at(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + ratio * (high - low);
                at_right = at(right);
            }
        }
        [at_left, at_right, at(0.0), at(1.0)].into_iter().fold(f64::INFINITY, f64::min)
    }

    fn least(distances: impl Iterator<Item = f64>) -> f64 {
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Round-off of a distance of size 1. The excess can be below 0 too: the oracle rounds as well.
    const EXCESS: f64 = 1e-9;

    #[test]
    fn no_segment_is_nearer() {
        let mut stream = Stream(1);
        let mut worst = 0.0_f64;
        for case in 0..250 {
            let count = 2 + (stream.next() * 60.0) as usize;
            let mut points: Vec<DVec3> = (0..count).map(|_| stream.vector()).collect();
            if case % 3 == 0 {
                points[1] = points[0];
            }
            let is_closed = case % 2 == 0;
            let curve = ClosestPoints::of_polyline(&points, is_closed).unwrap();
            let p = (0.1 + 3.0 * stream.next()) * stream.vector();
            let found = curve.nearest(p);
            let ends = |i: usize| (points[i], points[(i + 1) % count]);
            let segments = || (0..if is_closed { count } else { count - 1 }).map(ends);
            let expected = least(segments().map(|(a, b)| distance_to_segment(a, b, p)));
            let excess = (found.distance(p) - expected).abs() / (1.0 + expected);
            assert!(excess < EXCESS, "case {case}: at {} instead of {expected}", found.distance(p));
            let reach = expected * (1.0 + 3.0 * stream.next());
            let near = curve.within(p, reach).into_iter();
            let all = segments().map(|(a, b)| distance_to_segment(a, b, p)).enumerate();
            let differ = |(a, b): ((usize, f64), (usize, f64))| a.0 != b.0 || (a.1 - b.1).abs() > 1e-12 * (1.0 + b.1);
            // No distance is at the reach itself but by chance.
            assert!(!near.clone().zip(all.clone().filter(|&(_, apart)| apart < reach)).any(differ), "case {case}");
            assert_eq!(near.len(), all.filter(|&(_, apart)| apart < reach).count(), "case {case}");
            // It is a point of the polyline.
            assert!(least(segments().map(|(a, b)| distance_to_segment(a, b, found))) < 1e-12, "case {case}");
            worst = worst.max(excess);
        }
        println!("projection OnCurve: 250 cases, worst relative excess {worst:.1e}");
    }

    #[test]
    fn no_triangle_is_nearer() {
        let mut stream = Stream(2);
        let mut worst = 0.0_f64;
        for case in 0..250 {
            let count = 4 + (stream.next() * 40.0) as usize;
            let mut points: Vec<DVec3> = (0..count).map(|_| stream.vector()).collect();
            // Coincident and nearly collinear corners.
            points[1] = points[0];
            points[3] = points[2].lerp(points[0], 0.5) + 1e-7 * stream.vector();
            let index = |stream: &mut Stream| (stream.next() * count as f64) as u32;
            let mut triangles: Vec<[u32; 3]> =
                (0..1 + case % 90).map(|_| [index(&mut stream), index(&mut stream), index(&mut stream)]).collect();
            triangles.extend([[0, 1, 2], [0, 0, 0], [0, 2, 3]]);
            let mesh = ClosestPoints::of_triangles(&points, &triangles).unwrap();
            let p = (0.1 + 3.0 * stream.next()) * stream.vector();
            let found = mesh.nearest(p);
            let all = || triangles.iter().map(|triangle| triangle.map(|i| points[i as usize]));
            let expected = least(all().map(|corners| distance_to_triangle(corners, p)));
            let excess = (found.distance(p) - expected).abs() / (1.0 + expected);
            assert!(excess < EXCESS, "case {case}: at {} instead of {expected}", found.distance(p));
            assert!(least(all().map(|corners| distance_to_triangle(corners, found))) < 1e-7, "case {case}");
            worst = worst.max(excess);
        }
        println!("projection OnMesh: 250 cases, worst relative excess {worst:.1e}");
    }

    #[test]
    fn above_a_face_beside_an_edge_and_beyond_a_corner() {
        // The triangle (0,0,0), (4,0,0), (0,4,0).
        let points = [DVec3::ZERO, 4.0 * DVec3::X, 4.0 * DVec3::Y];
        let mesh = ClosestPoints::of_triangles(&points, &[[0, 1, 2]]).unwrap();
        for (p, expected) in [
            (DVec3::new(1.0, 2.0, 5.0), DVec3::new(1.0, 2.0, 0.0)),
            (DVec3::new(1.0, 2.0, -5.0), DVec3::new(1.0, 2.0, 0.0)),
            (DVec3::new(3.0, -2.0, 1.0), DVec3::new(3.0, 0.0, 0.0)),
            (DVec3::new(5.0, 5.0, 1.0), DVec3::new(2.0, 2.0, 0.0)),
            (DVec3::new(-1.0, -1.0, 3.0), DVec3::ZERO),
            (DVec3::new(9.0, -1.0, 0.0), points[1]),
        ] {
            assert!(mesh.nearest(p).distance(expected) < 1e-15, "{p}: {}", mesh.nearest(p));
        }
    }

    #[test]
    fn of_equally_near_pieces_the_first_is_taken() {
        // The middle of a square is as near to all of its sides, which are gone around 25 times.
        let corners = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        for first in 0..4 {
            let square: Vec<DVec3> = (0..100).map(|i| corners[(first + i) % 4]).collect();
            let nearest = ClosestPoints::of_polyline(&square, false).unwrap().nearest(DVec3::ZERO);
            let expected = 0.5 * (square[0] + square[1]);
            assert!(nearest.distance(expected) < 1e-15, "{nearest} is not {expected}");
            // Off the middle of one side, its piece in the first time around.
            for side in 0..4 {
                let beside = 0.6 * (square[side] + square[side + 1]);
                let curve = ClosestPoints::of_polyline(&square, false).unwrap();
                assert_eq!(curve.nearest_on_piece(beside), (curve.nearest(beside), side));
            }
        }
    }

    #[test]
    fn whatever_is_finite_stays_finite() {
        let shapes = [
            [DVec3::ZERO; 3],
            [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X],
            [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-160, 0.0)],
            [DVec3::splat(-1e308), DVec3::splat(1e308), DVec3::X],
            [1e9 * DVec3::X, 1e9 * DVec3::Y, 1e-9 * DVec3::Z],
        ];
        for points in shapes {
            for p in [0.0, 1e-9, 1e9, -1e160, f64::MAX].map(|s| s * DVec3::new(1.0, -0.5, 0.3)) {
                let curve = ClosestPoints::of_polyline(&points, true).unwrap().nearest(p);
                let mesh = ClosestPoints::of_triangles(&points, &[[0, 1, 2], [2, 2, 0]]).unwrap().nearest(p);
                assert!(curve.is_finite() && mesh.is_finite(), "{points:?}, {p}: {curve}, {mesh}");
            }
        }
        // From far away the nearest point is still the right one, within round-off of the distance.
        let p = 1e9 * DVec3::new(1.0, 2.0, 0.5);
        let curve = ClosestPoints::of_polyline(&[DVec3::ZERO, DVec3::X, DVec3::ONE], false).unwrap();
        assert!(curve.nearest(p) == DVec3::ONE, "{}", curve.nearest(p));
    }

    #[test]
    fn what_is_no_shape_is_refused_at_its_place() {
        let (a, nan) = ([DVec3::ZERO, DVec3::X], [DVec3::ZERO, DVec3::NAN]);
        let place = |result: Result<ClosestPoints>| result.unwrap_err().to_string();
        assert_eq!(place(ClosestPoints::of_polyline(&a[..1], true)), "points: expected at least 2, found 1");
        assert!(place(ClosestPoints::of_polyline(&nan, false)).starts_with("points[1]: expected finite coordinates"));
        assert_eq!(place(ClosestPoints::of_triangles(&a, &[])), "triangles: expected at least 1, found 0");
        let beyond = place(ClosestPoints::of_triangles(&a, &[[0, 1, 0], [0, 1, 2]]));
        assert_eq!(beyond, "triangles[1][2]: 2 is out of range for 2 points");
    }
}
