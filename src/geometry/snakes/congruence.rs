//! How far two positions of a snake are from being the same up to a rigid motion.

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, Status};
use crate::linalg::small::nearest_rotation;
use crate::mesh::grid::check_finite;

/// How congruent two sets of points are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Congruence {
    /// The root of the mean squared distance of points after the rigid motion for which it is least (Procrustes; Kabsch 1976). A
    /// reflection is no rigid motion.
    pub rms: f64,
    /// By how much the distance of any two points differs at most. Mirror images have the same.
    pub distances: f64,
}

/// Compares points with as many others, in the same order, in model units. The time goes with the square of their number.
///
/// # Errors
/// Not as many, none, or a coordinate that is not finite (`a`, `b`, `a[i]`, `b[i]`).
pub fn congruence(a: &[DVec3], b: &[DVec3]) -> Result<Congruence> {
    check_finite("a", a)?;
    check_finite("b", b)?;
    if a.is_empty() || a.len() != b.len() {
        let reason = format!("expected as many points as a has, {}, and at least 1; found {}", a.len(), b.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("b"));
    }
    let count = a.len() as f64;
    let [from, to] = [a, b].map(|points| points.iter().sum::<DVec3>() / count);
    let product = |(a, b): (&DVec3, &DVec3)| {
        let (a, b) = (*a - from, *b - to);
        DMat3::from_cols(b * a.x, b * a.y, b * a.z)
    };
    let (rotation, _) = nearest_rotation(a.iter().zip(b).map(product).fold(DMat3::ZERO, |sum, product| sum + product));
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (rotation * (*a - from) - (*b - to)).length_squared()).sum();
    let mut distances: f64 = 0.0;
    for i in 0..a.len() {
        for j in 0..i {
            distances = distances.max((a[i].distance(a[j]) - b[i].distance(b[j])).abs());
        }
    }
    Ok(Congruence { rms: (squares / count).sqrt(), distances })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn rigid_motions_change_nothing_and_reflections_do() {
        let mut random = Random(8);
        let points: Vec<DVec3> = (0..9).map(|_| random.vector()).collect();
        let turn = DMat3::from_axis_angle(random.vector().normalize(), 2.1);
        let moved: Vec<DVec3> = points.iter().map(|p| turn * *p + DVec3::new(10.0, -3.0, 2.0)).collect();
        let found = congruence(&points, &moved).unwrap();
        assert!(found.rms < 1e-14 && found.distances < 1e-14, "{found:?}");
        let mirrored: Vec<DVec3> = moved.iter().map(|p| DVec3::new(-p.x, p.y, p.z)).collect();
        let found = congruence(&points, &mirrored).unwrap();
        assert!(found.rms > 0.1 && found.distances < 1e-14, "{found:?}");
    }

    #[test]
    fn a_longer_segment_is_off_by_half_of_it_at_both_ends() {
        let found = congruence(&[DVec3::ZERO, DVec3::X], &[DVec3::ONE, DVec3::ONE + 1.2 * DVec3::Z]).unwrap();
        assert!((found.rms - 0.1).abs() < 1e-15 && (found.distances - 0.2).abs() < 1e-15);
        // No rotation makes a congruence better than the one found.
        let mut random = Random(2);
        let [a, b]: [Vec<DVec3>; 2] = std::array::from_fn(|_| (0..6).map(|_| random.vector()).collect());
        let found = congruence(&a, &b).unwrap().rms;
        let [from, to] = [&a, &b].map(|points| points.iter().sum::<DVec3>() / 6.0);
        for _ in 0..2000 {
            let turn = DMat3::from_axis_angle(random.vector().normalize(), random.between(0.0, 3.2));
            let sum: f64 = a.iter().zip(&b).map(|(a, b)| (turn * (*a - from) - (*b - to)).length_squared()).sum();
            assert!(found <= (sum / 6.0).sqrt() + 1e-12);
        }
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let place = |a: &[DVec3], b: &[DVec3]| congruence(a, b).unwrap_err().place().to_owned();
        assert_eq!(place(&[], &[]), "b");
        assert_eq!(place(&[DVec3::X], &[DVec3::X; 2]), "b");
        assert_eq!(place(&[DVec3::NAN], &[DVec3::X]), "a[0]");
    }
}
