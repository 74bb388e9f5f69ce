//! One strip between two curves that were drawn: for any surface, as no field leads its rulings.

use std::time::Instant;

use anyhow::{Result, anyhow, bail};
use glam::DVec3;
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::optimise::{Task, optimise};
use shapeop::geometry::ruled::single::axis;
use shapeop::geometry::ruled::start::{Rulings, start};
use shapeop::geometry::ruled::terms::points_beside;
use shapeop::geometry::ruled::{Joints, Strip};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::reference::ReferenceMesh;

use super::made::Made;
use super::report::{BoundariesInReport, ConditionsInReport, OptimisationInReport, Seconds, StartInReport};
use super::strips::{Job, MOST_COVERED, axis_of, end_rulings, optimisation_warnings, shown};

pub fn make(job: &Job<'_>) -> Result<Made> {
    let (args, asked) = (job.args, job.asked);
    let [first, second] = job.curves else {
        bail!("--curves: expected two curves for a single strip, found {}", job.curves.len());
    };
    let mut seconds = Seconds::default();
    let mesh = TriangleMesh::new(job.mesh).map_err(|error| job.places.of(error))?;
    let reference = ReferenceMesh::new(&mesh);
    let clock = Instant::now();
    let boundaries = [first, second].map(|curve| curve.distinct().to_vec());
    let is_closed = [first.is_closed, second.is_closed];
    let in_curves = |error: shapeop::error::Error| match error.place().strip_prefix("boundaries[") {
        Some(rest) => {
            let k = usize::from(rest.starts_with('1'));
            anyhow!("--curves: {}: {}", job.curves[k].name, error.status().text())
        }
        None => job.places.of(error),
    };
    let started = start(&boundaries, &is_closed, Rulings::Proportional, job.start_options()).map_err(in_curves)?;
    seconds.strips = clock.elapsed().as_secs_f64();
    let strip = &started.strips[0];
    let cover = points_beside(&started.strips, &mesh, MOST_COVERED);
    let (conditions, counts) = conditions(strip, job)?;
    let clock = Instant::now();
    let progress = job.phase("optimisation", asked.optimise.max_iterations);
    let joints = Joints::default();
    let task = Task {
        strips: &started.strips,
        joints: &joints,
        reference: &reference,
        cover: &cover,
        conditions: &conditions,
    };
    let found = optimise(task, &asked.optimise, &mut |now| shown(now, &progress));
    progress.finish();
    let found = found.map_err(|error| job.in_conditions(error, &conditions))?;
    seconds.optimisation = clock.elapsed().as_secs_f64();
    let mut warnings = optimisation_warnings(&found, asked);
    if cover.is_empty() {
        warnings.push("no point of the mesh is beside the strip between the curves".into());
    }
    let in_report = StartInReport {
        control_points: args.strips.control_points,
        shared: false,
        missed_rulings: started.missed.clone(),
        moved_rulings: started.moved.clone(),
    };
    let lines = job.curves.iter().map(|curve| curve.points.clone()).collect();
    Ok(Made {
        field: None,
        curves: Default::default(),
        boundary_lines: [lines, Vec::new()],
        boundaries: BoundariesInReport {
            kind: "drawn".to_owned(),
            count: 2,
            closed: is_closed.into_iter().filter(|is_closed| *is_closed).count(),
            levels: vec![0.0, 1.0],
            ..BoundariesInReport::default()
        },
        start: in_report,
        optimisation: OptimisationInReport::of(&found, &asked.optimise, counts),
        strips: found.strips,
        joints: Vec::new(),
        mesh: mesh.clone(),
        warnings,
        seconds,
    })
}

fn conditions(strip: &Strip, job: &Job<'_>) -> Result<(Vec<Condition>, ConditionsInReport)> {
    let (asked, mut counts) = (job.asked, ConditionsInReport::default());
    let strips = std::slice::from_ref(strip);
    let mut conditions = Vec::new();
    if asked.is_conoidal {
        let axis = axis(strip).map_err(|error| error.with_place("--conoidal"))?;
        let off = |(a, b): (&DVec3, &DVec3)| (*b - *a).normalize_or_zero().dot(axis).abs().min(1.0).asin();
        let control = strip.control(0).iter().zip(strip.control(1));
        counts.conoidal_start_deg = Some(control.map(off).fold(0.0, f64::max).to_degrees());
        counts.conoidal_strips = 1;
        conditions.push(Condition::Conoidal { strip: 0, axis });
    }
    if asked.has_fixed_ends {
        // End rulings are not orthogonal to the axis: those of the second boundary give way.
        let is_kept =
            |condition: &Condition| !(asked.is_conoidal && matches!(condition, Condition::FixedEnd { side: 1, .. }));
        let fixed: Vec<Condition> = Condition::fixed_ends(strips).into_iter().filter(is_kept).collect();
        counts.fixed_ends = fixed.len();
        conditions.extend(fixed);
    }
    if job.args.strips.fixed_end_rulings {
        let fixed = end_rulings(0, strip, axis_of(&conditions, 0));
        counts.fixed_end_rulings = fixed.len();
        conditions.extend(fixed);
    }
    Ok((conditions, counts))
}
