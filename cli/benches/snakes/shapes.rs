//! The surfaces and snakes that are measured and drawn.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::evolution::{Direction, Evolution, Options, Task, evolve};
use shapeop::geometry::snakes::{ArcShape, Pose, Snake};
use shapeop::mesh::reference::{ParametricSurface, SurfaceFoot, SurfaceJet};
use shapeop::mesh::{ReferenceSurface, surfaces};

/// A surface as a function of two parameters.
pub type Jets = Box<dyn Fn(f64, f64) -> SurfaceJet + Sync>;

/// A surface over a rectangle of parameters.
pub fn surface(
    ranges: [[f64; 2]; 2],
    function: impl Fn(f64, f64) -> SurfaceJet + Sync + 'static,
) -> Result<ParametricSurface<Jets>> {
    Ok(ParametricSurface::new(ranges, [65, 65], Box::new(function) as Jets)?)
}

pub fn plane() -> Result<ParametricSurface<Jets>> {
    surface([[-50.0, 50.0]; 2], surfaces::graph(|_, _| [0.0; 6]))
}

pub fn torus(radius: f64, tube: f64) -> Result<ParametricSurface<Jets>> {
    surface([[-PI, PI]; 2], surfaces::torus(radius, tube))
}

pub fn cylinder() -> Result<ParametricSurface<Jets>> {
    surface([[-PI, PI], [-20.0, 20.0]], surfaces::cylinder(1.0))
}

/// The unit sphere about the origin, poles and all.
pub struct Ball;

impl ReferenceSurface for Ball {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let normal = point.normalize();
        SurfaceFoot { point: normal, normal, overhang: 0.0 }
    }

    fn diagonal(&self) -> f64 {
        12.0_f64.sqrt()
    }
}

/// Numbers that look random (a linear congruential generator).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A vector in the cube from −1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }
}

/// Arcs, torsions and a pose that follow no rule.
pub fn random_arcs(count: usize, seed: u64) -> (Vec<ArcShape>, Vec<f64>, Pose) {
    let mut random = Random::new(seed);
    let arc = |random: &mut Random| {
        let radius = random.between(0.8, 1.5);
        ArcShape { radius, length: radius * random.between(0.4, 1.2) }
    };
    let arcs: Vec<ArcShape> = (0..count).map(|_| arc(&mut random)).collect();
    let torsions: Vec<f64> = (1..count).map(|_| random.between(-1.5, 1.5)).collect();
    let pose = Pose { point: random.vector(), tangent: random.vector(), normal: random.vector() };
    (arcs, torsions, pose)
}

/// An open snake of arcs that follow no rule.
pub fn open_snake(count: usize, seed: u64) -> Result<Snake> {
    let (arcs, torsions, pose) = random_arcs(count, seed);
    Ok(Snake::from_arcs(&arcs, &torsions, &pose)?)
}

/// The unit circle about the origin in the plane `z = 0`, as a closed snake of equal arcs.
pub fn regular(count: usize) -> Result<Snake> {
    let half = PI / count as f64;
    let at = |i: usize| {
        let (sine, cosine) = (2.0 * half * i as f64).sin_cos();
        DVec3::new(cosine, sine, 0.0) / half.cos()
    };
    Ok(Snake::new((0..count).map(at).collect(), true, count.is_multiple_of(2).then_some(half.tan()))?)
}

/// A part of the unit circle of the plane `z = 0`: `count` arcs that turn by `angle` each, from `(1, 0)` on.
pub fn circular(count: usize, angle: f64) -> Result<Snake> {
    let pose = Pose { point: DVec3::X, tangent: DVec3::Y, normal: DVec3::NEG_X };
    Ok(Snake::from_arcs(&vec![ArcShape { radius: 1.0, length: angle }; count], &vec![0.0; count - 1], &pose)?)
}

/// Part of the small circle of the unit sphere at a height, of arcs of 0.25 radians.
pub fn small_circle(count: usize, height: f64) -> Result<Snake> {
    let radius = (1.0 - height * height).sqrt();
    let flat = circular(count, 0.25)?;
    Ok(Snake::new(flat.control().iter().map(|p| radius * p + height * DVec3::Z).collect(), false, None)?)
}

/// Contact points on a helix of radius 1, equally spaced by the angle 0.3: the control points are on a helix outside, and arcs are
/// congruent.
pub fn screw(count: usize, slope: f64) -> Result<Snake> {
    let outside = 1.0 / 0.15_f64.cos();
    let at = |i: f64| DVec3::new(outside * (0.3 * i).cos(), outside * (0.3 * i).sin(), 0.3 * slope * i);
    let mut control: Vec<DVec3> = (0..count + 2).map(|i| at(i as f64)).collect();
    control[0] = 0.5 * (at(0.0) + at(1.0));
    control[count + 1] = 0.5 * (at(count as f64) + at(count as f64 + 1.0));
    Ok(Snake::new(control, false, None)?)
}

/// Arcs of radius 1 that turn by π/3, with torsions that follow no rule.
pub fn unit_arcs(count: usize, seed: u64) -> Result<Snake> {
    let mut random = Random::new(seed);
    let torsions: Vec<f64> = (1..count).map(|_| random.between(-1.5, 1.5)).collect();
    linked(std::f64::consts::FRAC_PI_3, &torsions)
}

/// Linked arcs of radius 1 that turn by one angle, as the paper's linkage.
pub fn linked(angle: f64, torsions: &[f64]) -> Result<Snake> {
    let arcs = vec![ArcShape { radius: 1.0, length: angle }; torsions.len() + 1];
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    Ok(Snake::from_arcs(&arcs, torsions, &pose)?)
}

/// The torsions of a linkage that comes back to its start.
pub const TORSIONS: [f64; 5] = [1.0, -0.7, 0.9, -0.8, 0.6];

/// An evolution to its end.
pub fn run(task: &Task<'_>, options: &Options) -> Result<Evolution> {
    Ok(evolve(task, options, &mut |_| ControlFlow::Continue(()))?)
}

/// A snake that goes sideways on a surface.
pub fn on<'a>(snake: &'a Snake, surface: &'a dyn ReferenceSurface) -> Task<'a> {
    Task { surface: Some(surface), direction: Direction::Sideways, ..Task::new(snake) }
}
