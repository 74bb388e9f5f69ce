//! Surfaces with names, as functions of two parameters with derivatives: references and truths.
//!
//! Angles are in radians, lengths in model units. Each is to be used over a rectangle of parameters
//! ([`ParametricSurface`](super::reference::ParametricSurface)) or to lay out a mesh
//! ([`parametric_surface`](super::patterns::parametric_surface)).

use glam::DVec3;

use super::reference::SurfaceJet;

/// The surface `z = height(x, y)`; `height` gives the value, the derivatives by `x` and `y`, and those twice by `x`, by both, twice
/// by `y`.
pub fn graph(height: impl Fn(f64, f64) -> [f64; 6] + Sync) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    move |x, y| {
        let [z, by_x, by_y, xx, xy, yy] = height(x, y);
        SurfaceJet {
            point: DVec3::new(x, y, z),
            first: [DVec3::new(1.0, 0.0, by_x), DVec3::new(0.0, 1.0, by_y)],
            second: [xx * DVec3::Z, xy * DVec3::Z, yy * DVec3::Z],
        }
    }
}

/// The hyperbolic paraboloid `z = x y`: its parameter lines are straight, and its asymptotic curves.
pub fn saddle() -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    graph(|x, y| [x * y, y, x, 0.0, 1.0, 0.0])
}

/// The saddle with a part of the monkey saddle, `z = x y + part · (x³ − 3 x y²)`: of negative curvature near the origin, with
/// asymptotic curves that are not straight.
pub fn bent_saddle(part: f64) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    graph(move |x, y| {
        [
            x * y + part * (x.powi(3) - 3.0 * x * y * y),
            y + 3.0 * part * (x * x - y * y),
            x - 6.0 * part * x * y,
            6.0 * part * x,
            1.0 - 6.0 * part * y,
            -6.0 * part * x,
        ]
    })
}

/// The surface of revolution about the z axis whose point at height `v` has the radius `radius(v)`, which comes with its first and
/// second derivative; `u` is the angle.
pub fn revolution(radius: impl Fn(f64) -> [f64; 3] + Sync) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    move |u, v| {
        let [r, first, second] = radius(v);
        let (sin, cos) = u.sin_cos();
        let (out, around) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        SurfaceJet {
            point: r * out + v * DVec3::Z,
            first: [r * around, first * out + DVec3::Z],
            second: [-r * out, first * around, second * out],
        }
    }
}

/// The cylinder about the z axis; `u` is the angle, `v` the height.
pub fn cylinder(radius: f64) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    revolution(move |_| [radius, 0.0, 0.0])
}

/// The hyperboloid of one sheet `x² + y² − z² = 1`; `u` is the angle, `v` the height. Both families of asymptotic curves are straight.
pub fn hyperboloid() -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    revolution(|v| {
        let r = (1.0 + v * v).sqrt();
        [r, v / r, 1.0 / (r * r * r)]
    })
}

/// The catenoid of radius `cosh v` at height `v`; `u` is the angle. A minimal surface, of curvature `−cosh⁻⁴ v`, with asymptotic
/// curves `u ± v` constant.
pub fn catenoid() -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    revolution(|v| [v.cosh(), v.sinh(), v.cosh()])
}

/// The helicoid `(u cos v, u sin v, pitch · v)`: its straight lines (along `u`) and its helices are its asymptotic curves.
pub fn helicoid(pitch: f64) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    move |u, v| {
        let (sin, cos) = v.sin_cos();
        let (out, around) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        SurfaceJet {
            point: u * out + pitch * v * DVec3::Z,
            first: [out, u * around + pitch * DVec3::Z],
            second: [DVec3::ZERO, around, -u * out],
        }
    }
}

/// Enneper's minimal surface `(u − u³/3 + u v², v − v³/3 + v u², u² − v²)`, of curvature `−4 (1 + u² + v²)⁻⁴`; its asymptotic
/// curves are `u ± v` constant.
pub fn enneper() -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    |u, v| SurfaceJet {
        point: DVec3::new(u - u * u * u / 3.0 + u * v * v, v - v * v * v / 3.0 + v * u * u, u * u - v * v),
        first: [
            DVec3::new(1.0 - u * u + v * v, 2.0 * u * v, 2.0 * u),
            DVec3::new(2.0 * u * v, 1.0 - v * v + u * u, -2.0 * v),
        ],
        second: [
            DVec3::new(-2.0 * u, 2.0 * v, 2.0),
            DVec3::new(2.0 * v, 2.0 * u, 0.0),
            DVec3::new(2.0 * u, -2.0 * v, -2.0),
        ],
    }
}

/// The torus about the z axis with a tube of radius `tube` at `radius` from it; `u` is the angle around the axis, `v` around the tube,
/// 0 outside.
pub fn torus(radius: f64, tube: f64) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    move |u, v| {
        let ((sin, cos), (rise, run)) = (u.sin_cos(), v.sin_cos());
        let (out, around) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        let at = radius + tube * run;
        SurfaceJet {
            point: at * out + tube * rise * DVec3::Z,
            first: [at * around, tube * (run * DVec3::Z - rise * out)],
            second: [-at * out, -tube * rise * around, -tube * (run * out + rise * DVec3::Z)],
        }
    }
}

/// The sphere about the origin; `u` is the longitude, `v` the latitude.
pub fn sphere(radius: f64) -> impl Fn(f64, f64) -> SurfaceJet + Sync {
    torus(0.0, radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of points and first derivatives, at some parameters off all symmetries.
    fn check(surface: impl Fn(f64, f64) -> SurfaceJet) {
        let h = 1e-6;
        for (u, v) in [(0.3, 0.7), (-0.8, 0.2), (1.1, -0.6)] {
            let jet = surface(u, v);
            let by_u = |f: &dyn Fn(SurfaceJet) -> DVec3| (f(surface(u + h, v)) - f(surface(u - h, v))) / (2.0 * h);
            let by_v = |f: &dyn Fn(SurfaceJet) -> DVec3| (f(surface(u, v + h)) - f(surface(u, v - h))) / (2.0 * h);
            let pairs = [
                (by_u(&|jet| jet.point), jet.first[0]),
                (by_v(&|jet| jet.point), jet.first[1]),
                (by_u(&|jet| jet.first[0]), jet.second[0]),
                (by_u(&|jet| jet.first[1]), jet.second[1]),
                (by_v(&|jet| jet.first[0]), jet.second[1]),
                (by_v(&|jet| jet.first[1]), jet.second[2]),
            ];
            assert!(pairs.iter().all(|(found, expected)| found.distance(*expected) < 1e-8), "{pairs:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_points() {
        check(saddle());
        check(bent_saddle(0.1));
        check(cylinder(1.3));
        check(hyperboloid());
        check(catenoid());
        check(helicoid(0.8));
        check(enneper());
        check(torus(2.0, 0.6));
        check(sphere(1.7));
    }

    /// Gauss's curvature by the two fundamental forms.
    fn gaussian(jet: SurfaceJet) -> f64 {
        let ([u, v], n) = (jet.first, jet.normal());
        let [l, m, k] = jet.second.map(|second| second.dot(n));
        (l * k - m * m) / (u.dot(u) * v.dot(v) - u.dot(v).powi(2))
    }

    #[test]
    fn curvatures_are_the_known_ones() {
        for (u, v) in [(0.3, 0.7), (-0.8, 0.2), (1.1, -0.6)] {
            let cases = [
                (gaussian(saddle()(u, v)), -1.0 / (1.0 + u * u + v * v).powi(2)),
                (gaussian(cylinder(2.0)(u, v)), 0.0),
                (gaussian(hyperboloid()(u, v)), -1.0 / (1.0 + 2.0 * v * v).powi(2)),
                (gaussian(catenoid()(u, v)), -1.0 / v.cosh().powi(4)),
                (gaussian(helicoid(0.8)(u, v)), -0.64 / (u * u + 0.64).powi(2)),
                (gaussian(enneper()(u, v)), -4.0 / (1.0 + u * u + v * v).powi(4)),
                (gaussian(torus(2.0, 0.6)(u, v)), v.cos() / (0.6 * (2.0 + 0.6 * v.cos()))),
                (gaussian(sphere(2.0)(u, v)), 0.25),
            ];
            assert!(cases.iter().all(|(found, known)| (found - known).abs() < 1e-12), "{cases:?}");
        }
        // x² + y² − z² = 1.
        let point = hyperboloid()(0.7, 1.3).point;
        assert!((point.x * point.x + point.y * point.y - point.z * point.z - 1.0).abs() < 1e-14);
    }
}
