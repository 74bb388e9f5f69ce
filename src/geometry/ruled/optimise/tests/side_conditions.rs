use super::*;

#[test]
fn conditions_hold_and_contradictions_are_named() {
    let surface = saddle(0.1, 0.8);
    let cover = surface.mesh(15, 15).unwrap().points;
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 9, 0.02);
    let joints = Joints::chain(2);
    let normal = DVec3::new(0.0, 3.0, 0.1);
    let direction = DVec3::new(0.1, 2.0, -1.0);
    let axis = DVec3::new(1.0, 0.05, 0.1);
    let position = DVec3::new(-1.01, -0.82, 0.7);
    let mut conditions = vec![
        Condition::PlanarBoundary { strip: 0, side: 1, normal, offset: 0.02 },
        Condition::FixedEnd { strip: 0, side: 0, end: End::Start, position },
        Condition::FixedEndRuling { strip: 0, end: End::Finish, direction },
        Condition::Conoidal { strip: 1, axis },
        Condition::PlanarBoundary { strip: 1, side: 0, normal, offset: 0.02 },
    ];
    let run = |conditions: &[Condition], is_shared| {
        let joints = Joints { is_shared, ..joints.clone() };
        optimise(
            Task { cover: &cover, joints: &joints, ..task(&strips, &surface, &joints, conditions) },
            &Options::default(),
            &mut on,
        )
    };
    for is_shared in [false, true] {
        let found = run(&conditions, is_shared).unwrap();
        assert!(falls(&found) && found.history.len() > 2);
        let [first, second] = [&found.strips[0], &found.strips[1]];
        let mut residuals = vec![first.control(0)[0].distance(position)];
        for i in 0..9 {
            residuals.push((first.control(1)[i].dot(normal) - 0.02).abs());
            residuals.push((second.control(0)[i].dot(normal) - 0.02).abs());
            residuals.push((second.control(1)[i] - second.control(0)[i]).dot(axis).abs());
        }
        residuals.push((first.control(1)[8] - first.control(0)[8]).cross(direction).length());
        let largest = residuals.iter().fold(0.0_f64, |most, r| most.max(*r));
        assert!(largest <= 1e-10, "{residuals:?}");
        // A plane on a shared boundary says twice the same.
        let equations = if is_shared { 9 + 3 + 2 + 9 } else { 9 + 3 + 2 + 9 + 9 };
        assert_eq!(found.free_count + equations, if is_shared { 81 } else { 108 });
    }
    conditions.push(Condition::PlanarBoundary { strip: 1, side: 0, normal: DVec3::Y, offset: 0.1 });
    conditions[4] = Condition::PlanarBoundary { strip: 0, side: 1, normal: DVec3::Y, offset: 0.0 };
    let error = run(&conditions, true).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::Infeasible, "conditions[5]"));
    assert!(error.to_string().contains("the plane of the first boundary of strip 1"), "{error}");
    let place = |condition: Condition| run(&[condition], false).unwrap_err().place().to_owned();
    assert_eq!(place(Condition::Conoidal { strip: 2, axis }), "conditions[0].strip");
    assert_eq!(place(Condition::Conoidal { strip: 1, axis: DVec3::ZERO }), "conditions[0].axis");
    assert_eq!(place(Condition::PlanarBoundary { strip: 0, side: 2, normal, offset: 0.0 }), "conditions[0].side");
    assert_eq!(
        place(Condition::PlanarBoundary { strip: 0, side: 0, normal, offset: f64::NAN }),
        "conditions[0].offset"
    );
}

#[test]
fn bounds_are_kept_where_they_can_be() {
    let surface = saddle(0.1, 0.8);
    let cover = surface.mesh(15, 15).unwrap().points;
    let joints = Joints::chain(2);
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 8, 0.0);
    let free = task(&strips, &surface, &joints, &[]);
    let free = Task { cover: &cover, ..free };
    let options = Options { max_iterations: 25, ..Options::default() };
    let reached = optimise(free, &options, &mut on).unwrap().last().largest_deviation;
    let bound = 0.7 * reached;
    let bounds = Bounds { largest_deviation: Some(bound), least_width: None };
    let found = optimise(free, &Options { bounds, ..options }, &mut on).unwrap();
    // To a ten-millionth of the diagonal.
    let slack = 1e-7 * surface.diagonal();
    assert!(falls(&found) && found.last().largest_deviation <= bound + slack, "{:?}", found.last());
    // A narrow strip beside a wide one.
    let strips = rows(&surface, &[-0.8, -0.7, 0.8], 8, 0.0);
    let narrow = Task { strips: &strips, ..free };
    let bounds = Bounds { largest_deviation: None, least_width: Some(0.3) };
    let found = optimise(narrow, &Options { bounds, ..options }, &mut on).unwrap();
    let width = |strip: &Strip| strip.rulings(21).iter().map(|[a, b]| a.distance(*b)).fold(f64::INFINITY, f64::min);
    assert!(falls(&found) && found.strips.iter().all(|strip| width(strip) >= 0.3 - 1e-7), "{:?}", found.last());
    // Out of reach: what is left is said.
    let ends = Condition::fixed_ends(&strips);
    let stuck = optimise(Task { conditions: &ends, ..narrow }, &Options { bounds, ..options }, &mut on).unwrap();
    let ends = [0.0, strips[0].length_u()].map(|u| strips[0].ruling(u)).map(|[a, b]| 0.3 - a.distance(b));
    assert!((stuck.last().excess - ends[0].max(ends[1])).abs() < 1e-6, "{ends:?} {:?}", stuck.last());
}
