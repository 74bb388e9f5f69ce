use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::geometry::snakes::drive::dot;
use crate::geometry::snakes::linkage::tests::{six_arcs, snake};

fn on(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn around(linkage: &Linkage, step_rad: f64) -> Motion {
    cycle(linkage, &Options { step_rad, ..Options::default() }, &mut on).unwrap()
}

#[test]
fn a_linkage_of_six_arcs_comes_back() {
    let linkage = six_arcs();
    // Steps and ranges as computed independently for it.
    for (step, steps) in [(0.04, 193), (0.02, 380), (0.01, 755)] {
        let motion = around(&linkage, step);
        assert_eq!((motion.end, motion.turns), (End::Closed, [0, 0]));
        assert!(motion.closing.unwrap() < 1e-8, "{:?}", motion.closing);
        assert!(motion.frames.len().abs_diff(steps) <= steps / 15, "{} for {steps}", motion.frames.len());
        let [first, last] = motion.ranges_rad().unwrap();
        assert!((first - 1.1605).abs() < 0.002 && (last - 1.8245).abs() < 0.002, "{first} {last}");
        // They do not depend on the steps.
        assert!((first - 1.161146364).abs() < 1e-8 && (last - 1.824702997).abs() < 1e-8, "{first} {last}");
        assert!((5..=15).contains(&motion.switch_count), "{}", motion.switch_count);
        let start = linkage.snake().control();
        for (i, frame) in motion.frames.iter().enumerate() {
            let moved = motion.snake(i).unwrap();
            assert!(moved.residual() < 1e-13, "{i}: {}", moved.residual());
            assert!([0, 1, 6, 7].iter().all(|&k| frame[k] == start[k]));
            assert!(moved.torsions().iter().all(|torsion| torsion.is_finite()));
        }
        // The driving arc turns by the step, or by less where the way turns sharply.
        for pair in motion.angles_rad.windows(2) {
            let most = (0..2).map(|k| (pair[1][k] - pair[0][k]).abs()).fold(0.0, f64::max);
            assert!(most < 1.5 * step && most > 0.0, "{most}");
        }
    }
}

#[test]
fn it_comes_back_the_other_way_too() {
    let linkage = six_arcs();
    let options = Options { is_reversed: true, ..Options::default() };
    let [there, back] = [around(&linkage, 0.02), cycle(&linkage, &options, &mut on).unwrap()];
    assert_eq!(back.end, End::Closed);
    assert!(there.angles_rad[1][0] > 0.0 && back.angles_rad[1][0] < 0.0);
    let [there, back] = [there, back].map(|motion| motion.ranges_rad().unwrap());
    assert!((0..2).all(|k| (there[k] - back[k]).abs() < 1e-8), "{there:?} {back:?}");
    // Another one that is known to come back.
    let other = Linkage::new(snake(1.2, &[2.0, -1.0, 1.5, -1.0, 2.0])).unwrap();
    assert_eq!(around(&other, 0.02).end, End::Closed);
}

#[test]
fn positions_do_not_depend_on_the_steps() {
    // Each position of the coarse motion is on the curve of the fine one: between two of its frames, as near as their chords, which
    // are 4e-3 long where the curve turns with a radius of some hundredths.
    let linkage = six_arcs();
    let (coarse, fine) = (around(&linkage, 0.05), around(&linkage, 0.002));
    for frame in &coarse.frames {
        let nearest = (0..fine.frames.len()).map(|i| {
            let (a, b) = (&fine.frames[i], &fine.frames[(i + 1) % fine.frames.len()]);
            let side: Vec<DVec3> = b.iter().zip(a).map(|(b, a)| *b - *a).collect();
            let from: Vec<DVec3> = frame.iter().zip(a).map(|(x, a)| *x - *a).collect();
            let t = (dot(&from, &side) / dot(&side, &side)).clamp(0.0, 1.0);
            let foot: Vec<DVec3> = a.iter().zip(&side).map(|(a, side)| *a + t * *side).collect();
            apart(frame, &foot)
        });
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest < 5e-4, "{nearest}");
    }
}

#[test]
fn copies_are_positions_of_the_motion() {
    let motion = around(&six_arcs(), 0.02);
    let offset = DVec3::new(0.0, 0.5, 2.0);
    let copies = motion.copies(8, 0.3, 0.125, offset).unwrap();
    for (k, copy) in copies.iter().enumerate() {
        let moved: Vec<DVec3> = copy.iter().map(|p| *p - k as f64 * offset).collect();
        assert!(motion.linkage.snake().moved(moved.clone()).unwrap().residual() < 1e-13);
        assert!([0, 1, 6, 7].iter().all(|&i| moved[i].distance(motion.frames[0][i]) < 1e-14));
        let nearest = motion.frames.iter().map(|frame| apart(frame, &moved)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.1, "{nearest}");
    }
    // Once around is the start again, and phases are even: neighbours are a hundredth of the way apart, or a little less where the
    // way turns sharply.
    let phases: Vec<f64> = (0..=100).map(|i| f64::from(i) / 100.0).collect();
    let all = motion.at_phases(&phases).unwrap();
    assert!(apart(&all[0], &motion.frames[0]) < 1e-14 && apart(&all[100], &all[0]) < 1e-13);
    let sides: Vec<f64> = all.windows(2).map(|pair| apart(&pair[0], &pair[1])).collect();
    let mean = sides.iter().sum::<f64>() / 100.0;
    assert!(sides.iter().all(|side| (side / mean - 1.0).abs() < 0.25), "{sides:?}");
    assert_eq!(motion.at_phases(&[0.0, f64::NAN]).unwrap_err().place(), "phases[1]");
    assert_eq!(motion.copies(2, 0.0, 0.1, DVec3::NAN).unwrap_err().place(), "offset");
    // Inner contacts go around, the outermost ones are fixed.
    let paths = motion.contact_paths().unwrap();
    assert_eq!((paths.len(), paths[3].len()), (7, motion.frames.len()));
    let length = |path: &[DVec3]| path.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    assert!(length(&paths[0]) == 0.0 && length(&paths[6]) == 0.0 && length(&paths[3]) > 1.0);
}

#[test]
fn what_does_not_move_in_one_way_is_refused() {
    let refused = |snake: Snake, options: &Options| {
        let error = cycle(&Linkage::new(snake).unwrap(), options, &mut on).unwrap_err();
        (error.status(), error.place().to_owned())
    };
    let default = Options::default();
    assert_eq!(refused(snake(FRAC_PI_2, &[1.2; 5]), &default), (Status::Singular, "linkage".into()));
    let (seven, five) = (snake(1.0, &[1.0, -0.7, 0.9, -0.8, 0.6, 0.3]), snake(1.0, &[1.0, -0.7, 0.9, -0.8]));
    assert_eq!(refused(seven, &default), (Status::InvalidValue, "linkage".into()));
    assert_eq!(refused(five.clone(), &default), (Status::InvalidValue, "linkage".into()));
    assert_eq!(refused(five.clone(), &Options { step_rad: 0.0, ..default }).1, "options.step_rad");
    assert_eq!(refused(five, &Options { max_steps: 0, ..default }).1, "options.max_steps");
}

#[test]
fn a_run_can_be_ended_and_has_its_frames() {
    let linkage = six_arcs();
    let mut stop = |now: &Progress| if now.step == 7 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let cut = cycle(&linkage, &Options::default(), &mut stop).unwrap();
    assert_eq!((cut.end, cut.frames.len(), cut.closing), (End::Cancelled, 8, None));
    let short = cycle(&linkage, &Options { max_steps: 5, ..Options::default() }, &mut on).unwrap();
    assert_eq!((short.end, short.frames.len()), (End::Steps, 6));
    assert_eq!(short.frames[5], cut.frames[5]);
    assert!(apart(&short.at_phases(&[1.7]).unwrap()[0], &short.frames[5]) < 1e-14);
    assert_eq!(short.snake(6).unwrap_err().place(), "frame");
}
