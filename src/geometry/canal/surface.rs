//! Super-canal surfaces: a cyclidic net and the chain of transformations that was applied to it.
//!
//! The net at the start of the chain is the *base*, such as a canal surface or a surface of revolution; the *net* is the base's
//! image. The family's name lists the transformations before the base's name, the last one first: MC-canal is a canal surface after
//! a Combescure and then a Möbius transformation (section 3.1). A net is refined at the base, where its lines of curvature are
//! known, and the refined base is sent through the chain (section 5.3): refinement commutes with Combescure transformations, but not
//! with inversions, under which equal angles of an arc do not stay equal.

use super::chain::{self, Kind, Transform};
use super::net::Net;
use crate::error::Result;

/// What the base of a super-canal surface is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaseKind {
    /// A canal surface: its sections are circles.
    Canal,
    /// A surface of revolution: a canal surface whose parallels share an axis.
    Revolution,
    /// A moulding surface: one family of lines of curvature is congruent and planar. It is a C-revolution surface.
    Moulding,
    /// Any circular net.
    Circular,
}

/// A cyclidic net and the chain of transformations that makes it of its base.
#[derive(Clone, Debug, PartialEq)]
pub struct SuperCanal {
    base: Net,
    kind: BaseKind,
    chain: Vec<Transform>,
    net: Net,
}

impl SuperCanal {
    /// A surface without transformations.
    pub fn new(base: Net, kind: BaseKind) -> Self {
        Self { net: base.clone(), base, kind, chain: Vec::new() }
    }

    /// The net at the start of the chain.
    pub fn base(&self) -> &Net {
        &self.base
    }

    /// What the base is.
    pub fn kind(&self) -> BaseKind {
        self.kind
    }

    /// The transformations, in the order in which they were applied.
    pub fn chain(&self) -> &[Transform] {
        &self.chain
    }

    /// The image of the base.
    pub fn net(&self) -> &Net {
        &self.net
    }

    /// Applies one more transformation to the net.
    ///
    /// # Errors
    /// As [`Transform::apply`]; nothing changes then.
    pub fn push(&mut self, transform: Transform) -> Result<()> {
        self.net = transform.apply(&self.net, [1, 1])?;
        self.chain.push(transform);
        Ok(())
    }

    /// Takes the last transformation off; `None` where there is none.
    ///
    /// # Errors
    /// None that the chain did not have when it was made.
    pub fn pop(&mut self) -> Result<Option<Transform>> {
        let Some((last, rest)) = self.chain.split_last() else { return Ok(None) };
        let last = last.clone();
        self.net = chain::apply(rest, &self.base, [1, 1])?;
        self.chain.pop();
        Ok(Some(last))
    }

    /// The base again, from the net alone through the inverse chain: what differs from [`SuperCanal::base`] is round-off.
    ///
    /// # Errors
    /// As [`chain::apply`].
    pub fn restored(&self) -> Result<Net> {
        chain::apply(&chain::inverse(&self.chain), &self.net, [1, 1])
    }

    /// The image of the base refined `one` by `two`, as [`Net::refined`]. Points of the net stay where they are.
    ///
    /// # Errors
    /// As [`Net::refined`] and [`chain::apply`].
    pub fn refined(&self, one: usize, two: usize) -> Result<Net> {
        chain::apply(&self.chain, &self.base.refined(one, two)?, [one, two])
    }

    /// The name of its family, such as `MC-canal`: similarities have no letter, and repeated ones have one.
    pub fn family(&self) -> String {
        let mut letters = String::new();
        for transform in &self.chain {
            let letter = match transform.kind() {
                Kind::Similarity => continue,
                Kind::Moebius => 'M',
                Kind::Combescure => 'C',
            };
            if !letters.starts_with(letter) {
                letters.insert(0, letter);
            }
        }
        // Some names say the same: an inversion of a canal surface is one, and moulding surfaces are C-revolution surfaces, which
        // another Combescure transformation does not leave.
        let (base, own_letter) = match self.kind {
            BaseKind::Canal => ("canal", Some('M')),
            BaseKind::Revolution if letters.ends_with('C') => ("moulding", Some('C')),
            BaseKind::Revolution => ("revolution", None),
            BaseKind::Moulding => ("moulding", Some('C')),
            BaseKind::Circular => ("circular net", None),
        };
        if own_letter.is_some_and(|letter| letters.ends_with(letter)) {
            letters.pop();
        }
        if letters.is_empty() { base.to_owned() } else { format!("{letters}-{base}") }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::inversion::Inversion;
    use crate::geometry::canal::quality::{Quality, largest};
    use crate::geometry::random::Random;
    use crate::mesh::Grid;

    fn surface() -> SuperCanal {
        SuperCanal::new(Cyclide::new().net([0.2, 1.9], [-0.7, 1.3], 5, 4), BaseKind::Canal)
    }

    fn inversion() -> Transform {
        Transform::Inversion(Inversion::new(DVec3::new(0.1, 0.4, 0.9), -1.3).unwrap())
    }

    fn combescure(seed: u64) -> Transform {
        let mut random = Random(seed);
        let mut factors = |count: usize| (0..count).map(|_| random.between(0.8, 1.25)).collect();
        Transform::Combescure { column: factors(4), row: factors(3) }
    }

    fn distance(a: &Grid, b: &Grid) -> f64 {
        a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    fn worst(grid: &Grid) -> f64 {
        let Quality { planarity, concyclicity, .. } = Quality::of(grid);
        largest(&planarity).max(largest(&concyclicity))
    }

    #[test]
    fn the_order_of_moebius_and_combescure_transformations_matters() {
        let images = [[inversion(), combescure(5)], [combescure(5), inversion()]].map(|chain| {
            let mut surface = surface();
            chain.into_iter().for_each(|transform| surface.push(transform).unwrap());
            surface
        });
        let diagonal = images[0].net().grid().diagonal();
        assert!(distance(images[0].net().grid(), images[1].net().grid()) > 1e-2 * diagonal);
        assert_eq!(images.each_ref().map(SuperCanal::family), ["C-canal", "MC-canal"]);
        assert!(images.iter().all(|surface| worst(surface.net().grid()) < 1e-11));
    }

    #[test]
    fn a_chain_is_undone_by_its_inverse_and_frames_go_along() {
        let mut surface = surface();
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8);
        let links = [inversion(), combescure(1), Transform::Rotation(turn), Transform::Scaling(-0.4)];
        for transform in links.into_iter().chain([Transform::Translation(DVec3::ONE), inversion(), combescure(2)]) {
            surface.push(transform).unwrap();
            // The frames of the image are those that its own first frame is handed on to.
            let net = Net::new(surface.net().grid().clone(), surface.net().frames()[0]).unwrap();
            for (a, b) in net.frames().iter().zip(surface.net().frames()) {
                assert!(a.distance(b) < 1e-11);
            }
        }
        let restored = surface.restored().unwrap();
        assert!(distance(restored.grid(), surface.base().grid()) < 1e-9 * surface.base().grid().diagonal());
        for (a, b) in restored.frames().iter().zip(surface.base().frames()) {
            assert!(a.distance(b) < 1e-11);
        }
        let whole = surface.clone();
        let last = surface.pop().unwrap().unwrap();
        surface.push(last).unwrap();
        assert_eq!(surface, whole);
    }

    #[test]
    fn refinement_keeps_old_points_and_circles_through_a_chain() {
        let mut surface = surface();
        for transform in [combescure(3), inversion(), combescure(4)] {
            surface.push(transform).unwrap();
        }
        let coarse = surface.net().grid();
        for pieces in [2, 4] {
            let fine = surface.refined(pieces, pieces).unwrap();
            for i in 0..coarse.rows() {
                for j in 0..coarse.columns() {
                    let error = fine.grid().at(pieces * i, pieces * j).distance(coarse.at(i, j));
                    assert!(error < 1e-9 * coarse.diagonal(), "{error}");
                }
            }
            assert!(worst(fine.grid()) < 1e-9, "{}", worst(fine.grid()));
            let back = chain::apply(&chain::inverse(surface.chain()), &fine, [pieces; 2]).unwrap();
            let base = surface.base().refined(pieces, pieces).unwrap();
            assert!(distance(back.grid(), base.grid()) < 1e-9 * base.grid().diagonal());
        }
    }

    #[test]
    fn refining_and_a_combescure_transformation_commute() {
        // The independent way: transform the coarse net, then refine it with the frames it had.
        let mut surface = surface();
        surface.push(combescure(8)).unwrap();
        let through_chain = surface.refined(3, 2).unwrap();
        let of_patches = surface.net().refined(3, 2).unwrap();
        let error = distance(through_chain.grid(), of_patches.grid());
        assert!(error < 1e-12 * of_patches.grid().diagonal(), "{error}");
        // With an inversion in between they do not.
        surface.push(inversion()).unwrap();
        let error = distance(surface.refined(3, 2).unwrap().grid(), surface.net().refined(3, 2).unwrap().grid());
        assert!(error > 1e-4 * of_patches.grid().diagonal(), "{error}");
    }

    #[test]
    fn a_link_that_cannot_be_undone_or_applied_changes_nothing() {
        let mut surface = surface();
        surface.push(inversion()).unwrap();
        let before = surface.clone();
        let point = surface.net().grid().at(1, 2);
        let ones = |count: usize| vec![1.0; count];
        for (transform, place) in [
            (Transform::Inversion(Inversion::new(point, 1.0).unwrap()), "points[6]"),
            (Transform::Scaling(0.0), "scale"),
            (Transform::Translation(DVec3::INFINITY), "translation[0]"),
            (Transform::Rotation(DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0)), "rotation"),
            (Transform::Combescure { column: ones(3), row: ones(3) }, "column"),
            (Transform::Combescure { column: ones(4), row: vec![1.0, 0.0, 1.0] }, "row[1]"),
        ] {
            assert_eq!(surface.push(transform).unwrap_err().place(), place);
            assert_eq!(surface, before);
        }
    }

    #[test]
    fn families_are_named_as_in_the_paper() {
        let net = surface().base().clone();
        let (m, c) = (inversion(), combescure(1));
        let name = |kind: BaseKind, chain: &[&Transform]| {
            let mut surface = SuperCanal::new(net.clone(), kind);
            chain.iter().for_each(|&transform| surface.push(transform.clone()).unwrap());
            surface.family()
        };
        for (kind, chain, expected) in [
            (BaseKind::Canal, vec![], "canal"),
            (BaseKind::Canal, vec![&m], "canal"),
            (BaseKind::Canal, vec![&c], "C-canal"),
            (BaseKind::Canal, vec![&m, &c, &m], "MC-canal"),
            (BaseKind::Revolution, vec![], "revolution"),
            (BaseKind::Revolution, vec![&m], "M-revolution"),
            (BaseKind::Revolution, vec![&c], "moulding"),
            (BaseKind::Revolution, vec![&m, &c], "CM-revolution"),
            (BaseKind::Revolution, vec![&m, &c, &m], "MCM-revolution"),
            (BaseKind::Moulding, vec![&c, &m], "M-moulding"),
            (BaseKind::Circular, vec![&m], "M-circular net"),
        ] {
            assert_eq!(name(kind, &chain), expected);
        }
    }
}
