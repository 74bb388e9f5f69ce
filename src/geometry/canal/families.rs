//! The named families of super-canal surfaces (section 3.1, Fig. 4): a base and the kinds of transformations after it.
//!
//! Letters stand before the base's name, the last transformation first: MC-canal is a canal surface after a Combescure (C) and then
//! a Möbius (M) transformation. Similarities may stand anywhere in a chain; they change nothing in the family.

use super::chain::{Kind, Transform};
use super::net::Net;
use super::surface::{BaseKind, SuperCanal};
use crate::error::{Error, Result, Status};

/// A family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Envelopes of spheres; their images under Möbius transformations are canal surfaces too.
    Canal,
    /// Surfaces of revolution.
    Revolution,
    /// Their images under Möbius transformations.
    MRevolution,
    /// Moulding surfaces, the Combescure transforms of surfaces of revolution.
    Moulding,
    /// Combescure transforms of canal surfaces.
    CCanal,
    /// Combescure transforms of M-revolution surfaces.
    CMRevolution,
    /// Möbius images of C-canal surfaces.
    MCCanal,
    /// Möbius images of moulding surfaces.
    MMoulding,
    /// Möbius images of CM-revolution surfaces.
    MCMRevolution,
}

impl Family {
    /// Every family.
    pub const ALL: [Self; 9] = [
        Self::Canal,
        Self::Revolution,
        Self::MRevolution,
        Self::Moulding,
        Self::CCanal,
        Self::CMRevolution,
        Self::MCCanal,
        Self::MMoulding,
        Self::MCMRevolution,
    ];

    /// Its name, as [`SuperCanal::family`] gives it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Canal => "canal",
            Self::Revolution => "revolution",
            Self::MRevolution => "M-revolution",
            Self::Moulding => "moulding",
            Self::CCanal => "C-canal",
            Self::CMRevolution => "CM-revolution",
            Self::MCCanal => "MC-canal",
            Self::MMoulding => "M-moulding",
            Self::MCMRevolution => "MCM-revolution",
        }
    }

    /// The family of that name, in letters of either case; `C-revolution` is `moulding`.
    pub fn named(name: &str) -> Option<Self> {
        let name = if name.eq_ignore_ascii_case("c-revolution") { "moulding" } else { name };
        Self::ALL.into_iter().find(|family| family.name().eq_ignore_ascii_case(name))
    }

    /// What it starts from.
    pub fn base(self) -> BaseKind {
        match self {
            Self::Canal | Self::CCanal | Self::MCCanal => BaseKind::Canal,
            Self::Revolution | Self::MRevolution | Self::CMRevolution | Self::MCMRevolution => BaseKind::Revolution,
            Self::Moulding | Self::MMoulding => BaseKind::Moulding,
        }
    }

    /// The kinds of transformations after it, in the order in which they are applied.
    pub fn kinds(self) -> &'static [Kind] {
        match self {
            Self::Canal | Self::Revolution | Self::Moulding => &[],
            Self::MRevolution | Self::MMoulding => &[Kind::Moebius],
            Self::CCanal => &[Kind::Combescure],
            Self::CMRevolution => &[Kind::Moebius, Kind::Combescure],
            Self::MCCanal => &[Kind::Combescure, Kind::Moebius],
            Self::MCMRevolution => &[Kind::Moebius, Kind::Combescure, Kind::Moebius],
        }
    }

    /// The surface of this family with the given base and transformations.
    ///
    /// # Errors
    /// The transformations are of other kinds; otherwise as [`SuperCanal::push`]. The place is `chain` or `chain[k]`.
    pub fn build(self, base: Net, chain: Vec<Transform>) -> Result<SuperCanal> {
        let kinds = chain.iter().map(Transform::kind).filter(|kind| *kind != Kind::Similarity);
        if !kinds.clone().eq(self.kinds().iter().copied()) {
            let list = |kinds: Vec<Kind>| if kinds.is_empty() { "none".to_owned() } else { format!("{kinds:?}") };
            let (expected, found) = (list(self.kinds().to_vec()), list(kinds.collect()));
            let reason = format!("expected, for {}, the transformations {expected}, found {found}", self.name());
            return Err(Error::new(Status::InvalidValue, reason).at("chain"));
        }
        let mut surface = SuperCanal::new(base, self.base());
        for (k, transform) in chain.into_iter().enumerate() {
            surface.push(transform).map_err(|error| error.at(format!("chain[{k}]")))?;
        }
        Ok(surface)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::inversion::Inversion;

    #[test]
    fn a_surface_has_the_name_of_the_family_it_was_built_for_and_its_chain_is_undone() {
        let net = Cyclide::new().net([0.2, 1.9], [-0.7, 1.3], 4, 3);
        for family in Family::ALL {
            let transform = |(k, kind): (usize, &Kind)| match kind {
                Kind::Combescure => Transform::Combescure { column: vec![1.1, 0.9, 1.2], row: vec![0.8, 1.2] },
                _ => Transform::Inversion(Inversion::new(DVec3::new(0.1, 0.4, 0.9 + k as f64), 1.3).unwrap()),
            };
            let mut chain: Vec<Transform> = family.kinds().iter().enumerate().map(transform).collect();
            chain.push(Transform::Scaling(2.0));
            let surface = family.build(net.clone(), chain).unwrap();
            assert_eq!(surface.family(), family.name());
            assert_eq!(Family::named(&family.name().to_uppercase()), Some(family));
            let (restored, diagonal) = (surface.restored().unwrap(), net.grid().diagonal());
            let errors = restored.grid().points().iter().zip(net.grid().points()).map(|(a, b)| a.distance(*b));
            assert!(errors.fold(0.0, f64::max) < 1e-9 * diagonal);
        }
        assert_eq!(Family::named("C-revolution"), Some(Family::Moulding));
        assert_eq!(Family::named("D-canal"), None);
    }

    #[test]
    fn other_transformations_are_refused() {
        let net = Cyclide::new().net([0.2, 1.9], [-0.7, 1.3], 4, 3);
        let inversion = Transform::Inversion(Inversion::new(DVec3::ONE, 1.0).unwrap());
        let error = Family::CCanal.build(net.clone(), vec![inversion]).unwrap_err();
        assert_eq!(error.place(), "chain");
        assert!(error.to_string().contains("expected, for C-canal, the transformations [Combescure]"), "{error}");
        let short = Transform::Combescure { column: vec![1.0], row: vec![1.0; 2] };
        assert_eq!(Family::CCanal.build(net, vec![short]).unwrap_err().place(), "chain[0].column");
    }
}
