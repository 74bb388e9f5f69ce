//! What was asked for, once contradictions are refused.

use clap::CommandFactory;
use clap::error::ErrorKind;
use shapeop::geometry::ruled::Bounds;
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::optimise::Options;
use shapeop::geometry::ruled::terms::Weights;

use crate::args::Cli;
use crate::args::ruled::{BoundaryKind, RuledArgs, WeightName};

/// Boundaries where nothing says how many.
pub const LEVELS: usize = 12;

/// What was asked for, decided.
pub struct Asked {
    pub kind: BoundaryKind,
    /// Of the level function; none where boundaries are no level curves.
    pub level_weights: Option<LevelWeights>,
    pub is_planar: bool,
    pub is_conoidal: bool,
    pub has_fixed_ends: bool,
    pub optimise: Options,
}

impl Asked {
    /// Ends the program, as for any wrong options, if they contradict each other.
    pub fn of(args: &RuledArgs) -> Self {
        Self::checked(args).unwrap_or_else(|reason| {
            Cli::command().error(ErrorKind::ArgumentConflict, reason).exit();
        })
    }

    fn checked(args: &RuledArgs) -> Result<Self, String> {
        let (kind, given) = (kind(args)?, &args.boundaries);
        let is_by_hand = !given.axes.is_empty();
        let is_level = !matches!(kind, BoundaryKind::Planar | BoundaryKind::Drawn) && !is_by_hand;
        let mut level_weights = match kind {
            BoundaryKind::Equidistant => LevelWeights::EQUIDISTANT,
            BoundaryKind::Geodesic => LevelWeights::GEODESIC,
            BoundaryKind::Conoidal => LevelWeights::CONOIDAL,
            _ => LevelWeights::ORTHOGONAL,
        };
        let mut weights = Weights::default();
        for weight in &given.weights {
            if weight.name.is_of_boundaries() && !is_level {
                return Err(
                    "the weights of boundaries in --weights are for level curves: these boundaries are given".into()
                );
            }
            let place = match weight.name {
                WeightName::Orthogonal => &mut level_weights.orthogonal,
                WeightName::Direction => &mut level_weights.direction,
                WeightName::Equidistant => &mut level_weights.equidistant,
                WeightName::Geodesic => &mut level_weights.geodesic,
                WeightName::Conoidal => &mut level_weights.conoidal,
                WeightName::Laplace => &mut level_weights.laplace,
                WeightName::Proximity => &mut weights.proximity,
                WeightName::Beyond => &mut weights.beyond,
                WeightName::Gap => &mut weights.gap,
                WeightName::Coverage => &mut weights.coverage,
                WeightName::ThinPlate => &mut weights.thin_plate,
                WeightName::Proximal => &mut weights.proximal,
            };
            *place = weight.value;
        }
        let strips = &args.strips;
        if strips.planar && kind != BoundaryKind::Planar {
            return Err(
                "--planar keeps boundaries in the planes that they start in: it needs --planes or --normal".into()
            );
        }
        if given.single && strips.shared {
            return Err("--shared is for strips with neighbours: there is only one with --single".into());
        }
        let optimise = Options {
            weights,
            bounds: Bounds {
                largest_deviation: args.optimise.largest_deviation,
                least_width: args.optimise.least_width,
            },
            samples: args.optimise.samples.as_deref().map_or(Options::default().samples, |found| [found[0], found[1]]),
            max_iterations: args.optimise.iterations,
            tolerance: args.optimise.tolerance,
        };
        let wants_conoids = kind == BoundaryKind::Conoidal || args.output.planks.is_some();
        Ok(Self {
            kind,
            level_weights: is_level.then_some(level_weights),
            is_planar: kind == BoundaryKind::Planar && !strips.no_planar,
            is_conoidal: strips.conoidal || (wants_conoids && !strips.no_conoidal),
            has_fixed_ends: strips.fixed_ends || (given.single && !strips.free_ends),
            optimise,
        })
    }
}

/// The kind of boundaries that was named, or that other options mean.
fn kind(args: &RuledArgs) -> Result<BoundaryKind, String> {
    let given = &args.boundaries;
    let meant = [
        ("--planes", BoundaryKind::Planar, !given.planes.is_empty()),
        ("--normal", BoundaryKind::Planar, given.normal.is_some()),
        ("--axes", BoundaryKind::Conoidal, !given.axes.is_empty()),
        ("--curves", BoundaryKind::Drawn, !given.curves.is_empty()),
    ];
    let meant = meant.into_iter().find(|(.., is_given)| *is_given);
    match (given.boundaries, meant) {
        (Some(kind), Some((option, other, _))) if kind != other => {
            let [kind, other] = [kind, other].map(|kind| format!("{kind:?}").to_lowercase());
            Err(format!("{option} is for --boundaries {other}, and --boundaries is {kind}"))
        }
        (Some(BoundaryKind::Planar), None) => {
            Err("--boundaries planar needs --planes A,B,C,D or --normal X,Y,Z".into())
        }
        (Some(BoundaryKind::Drawn), None) => Err("--boundaries drawn needs --curves FILE ...".into()),
        (Some(kind), _) => Ok(kind),
        (None, found) => Ok(found.map_or(BoundaryKind::Orthogonal, |(_, kind, _)| kind)),
    }
}
