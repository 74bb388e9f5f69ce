//! Projections by type, the plain way and four at once. An iteration projects 1000 constraints: its time in µs is the time
//! of one projection in ns.
//!
//! divan and not criterion: it takes the types as they are, prints one table, and brings few dependencies.

use divan::{Bencher, black_box};
use glam::DVec3;
use shapeop::constraints::{self, Constraint, Four, Rows, Stencil};
use shapeop::linalg::lanes::{F4, V4};
use shapeop::linalg::simd::{Isa, LaneKernel, dispatch_lanes};

/// Constraints that one iteration projects; a multiple of four.
const COUNT: usize = 1000;

fn main() {
    divan::main();
}

/// Where the points of a constraint are about: a quad of a mesh, or a tetrahedron of a solid, and a fifth point for stencils.
const QUAD: [DVec3; 5] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::NEG_X];
const TETRAHEDRON: [DVec3; 5] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];

/// Constraints of one type, each on `k` points of its own, which are a tenth of their size away from where they rest.
struct Sample<T> {
    k: usize,
    row_count: usize,
    constraints: Vec<T>,
    scalars: Vec<Vec<f64>>,
    points: Vec<DVec3>,
    indices: Vec<u32>,
}

impl<T: Constraint> Sample<T> {
    fn new() -> Self {
        let info = T::INFO;
        // Quads, and the least that types of any number take beyond that.
        let k = info.greatest_indices.unwrap_or(4).min(4).max(info.least_indices);
        let mut state = 1_u64;
        let mut vector = || {
            DVec3::from_array(std::array::from_fn(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            }))
        };
        let is_solid = matches!(info.name, "TetrahedronStrain" | "Volume");
        let about = if is_solid { TETRAHEDRON } else { QUAD };
        let rest: Vec<DVec3> = (0..COUNT * k).map(|i| about[i % k] + 0.2 * vector()).collect();
        let points = rest.iter().map(|point| *point + 0.1 * vector()).collect();
        let indices: Vec<u32> = (0..(COUNT * k) as u32).collect();
        let mut sample = Self { k, row_count: k, constraints: Vec::new(), scalars: Vec::new(), points, indices };
        for own in sample.indices.chunks_exact(k) {
            let mut scalars = Vec::new();
            let mut constraint = T::at_rest(stencil::<T>(&rest, own), &mut scalars);
            if info.name == "Similarity" {
                // A square, as regular meshes ask for.
                scalars = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
                constraint.scalars_changed(&scalars);
            }
            sample.constraints.push(constraint);
            sample.scalars.push(scalars);
        }
        sample.row_count = info.rows.count(k);
        sample
    }
}

fn stencil<'a, T: Constraint>(points: &'a [DVec3], indices: &'a [u32]) -> Stencil<'a> {
    match T::INFO.rows {
        Rows::Centred => Stencil::centred(points, indices),
        Rows::Linear(_) | Rows::Pairs => Stencil::absolute(points, indices),
    }
}

#[divan::bench(types = [
    constraints::angle::Angle,
    constraints::area::Area,
    constraints::bending::Bending,
    constraints::bounded_angle::BoundedAngle,
    constraints::circle::Circle,
    constraints::closeness::Closeness,
    constraints::diagonal_distance::DiagonalDistance,
    constraints::edge_length::EdgeLength,
    constraints::edge_strain::EdgeStrain,
    constraints::equal_lengths::EqualLengths,
    constraints::laplacian::Laplacian,
    constraints::laplacian_displacement::LaplacianDisplacement,
    constraints::line::Line,
    constraints::on_line::OnLine,
    constraints::on_plane::OnPlane,
    constraints::orientation::Orientation,
    constraints::parallelogram::Parallelogram,
    constraints::plane::Plane,
    constraints::rectangle::Rectangle,
    constraints::regular_polygon::RegularPolygon,
    constraints::rigid::Rigid,
    constraints::similarity::Similarity,
    constraints::sphere::Sphere,
    constraints::tetrahedron_strain::TetrahedronStrain,
    constraints::triangle_strain::TriangleStrain,
    constraints::volume::Volume,
])]
fn plain<T: Constraint>(bencher: Bencher<'_, '_>) {
    let sample = Sample::<T>::new();
    let mut targets = vec![DVec3::ZERO; sample.row_count];
    bencher.bench_local(|| {
        for (i, own) in sample.indices.chunks_exact(sample.k).enumerate() {
            let x = stencil::<T>(black_box(&sample.points), own);
            sample.constraints[i].project(&sample.scalars[i], x, &mut targets);
            black_box(&targets);
        }
    });
}

/// All constraints of a sample, four at a time, and what is left over the plain way, as in the solver.
struct ByFours<'a, T> {
    sample: &'a Sample<T>,
    plain_targets: &'a mut [DVec3],
}

impl<T: Constraint> LaneKernel for ByFours<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Isa>(self, simd: S) {
        let Sample { k, constraints, scalars, points, indices, .. } = self.sample;
        let (mut x, mut targets) = ([V4::zero(simd); 8], [V4::zero(simd); 8]);
        for slot in (0..COUNT).step_by(4) {
            let own = |i: usize| &indices[(slot + i) * k..(slot + i + 1) * k];
            for (j, x) in x[..*k].iter_mut().enumerate() {
                *x = V4::gather(simd, std::array::from_fn(|i| &points[own(i)[j] as usize]));
            }
            if T::INFO.rows == Rows::Centred {
                let first = x[0];
                let sum = x[1..*k].iter().fold(V4::zero(simd), |sum, &x| sum + (x - first));
                let mean = first + sum * F4::splat(simd, 1.0 / *k as f64);
                x[..*k].iter_mut().for_each(|x| *x = *x - mean);
            }
            let four = Four::new(
                simd,
                std::array::from_fn(|i| &constraints[slot + i]),
                std::array::from_fn(|i| scalars[slot + i].as_slice()),
            );
            let is_done = T::project_four(four, &x[..*k], &mut targets[..self.sample.row_count]);
            for i in (0..4).filter(|&i| !is_done.has(i)) {
                let x = stencil::<T>(points, own(i));
                constraints[slot + i].project(&scalars[slot + i], x, self.plain_targets);
            }
            black_box(&targets);
        }
    }
}

#[divan::bench(types = [
    constraints::angle::Angle,
    constraints::area::Area,
    constraints::bending::Bending,
    constraints::bounded_angle::BoundedAngle,
    constraints::circle::Circle,
    constraints::diagonal_distance::DiagonalDistance,
    constraints::edge_length::EdgeLength,
    constraints::edge_strain::EdgeStrain,
    constraints::equal_lengths::EqualLengths,
    constraints::orientation::Orientation,
    constraints::parallelogram::Parallelogram,
    constraints::plane::Plane,
    constraints::rectangle::Rectangle,
    constraints::regular_polygon::RegularPolygon,
    constraints::rigid::Rigid,
    constraints::similarity::Similarity,
    constraints::tetrahedron_strain::TetrahedronStrain,
    constraints::triangle_strain::TriangleStrain,
    constraints::volume::Volume,
])]
fn by_fours<T: Constraint>(bencher: Bencher<'_, '_>) {
    let sample = Sample::<T>::new();
    assert!(T::takes_four(sample.k), "{} does not project four at once", T::INFO.name);
    let mut plain_targets = vec![DVec3::ZERO; sample.row_count];
    bencher.bench_local(|| {
        let sample = black_box(&sample);
        dispatch_lanes(ByFours { sample, plain_targets: &mut plain_targets });
    });
}
