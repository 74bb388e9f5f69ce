use dxf::Drawing;
use dxf::entities::{Entity, EntityType};

use super::*;
use crate::geometry::random::Random;
use crate::geometry::snakes::Pose;

fn shape(radius: f64, length: f64) -> ArcShape {
    ArcShape { radius, length }
}

/// Three positions of a snake of four arcs of three kinds, in any direction.
fn list() -> ArcList {
    let arcs = [shape(1.0, 1.5), shape(2.0, 0.7), shape(1.0, 1.5 + 1e-9), shape(0.5, 0.4)];
    let mut random = Random(7);
    let torsions = [0.7, -2.0, 1.1];
    let frames: Vec<Vec<DVec3>> = (0..3)
        .map(|_| {
            let pose = Pose { point: 5.0 * random.vector(), tangent: random.vector(), normal: random.vector() };
            Snake::from_arcs(&arcs, &torsions, &pose).unwrap().control().to_vec()
        })
        .collect();
    let snake = Snake::with_arcs(frames[0].clone(), arcs.to_vec(), false).unwrap();
    ArcList::new(&snake, &frames, &[0.0, 0.5, 2.0], 1e-6).unwrap()
}

#[test]
fn a_list_is_read_as_it_was_written() {
    let list = list();
    assert_eq!((list.kinds().len(), list.kind_of(), list.kinds()[0].count), (3, &[0, 1, 0, 2][..], 2));
    let text = list.to_json();
    let again = ArcList::from_json(&text).unwrap();
    assert_eq!((again.positions(), again.times()), (list.positions(), list.times()));
    assert_eq!(again.kind_of(), list.kind_of());
    for (a, b) in again.snakes()[2].shapes().iter().zip(list.snakes()[2].shapes()) {
        assert!(a.radius == b.radius && (a.length - b.length).abs() < 1e-15);
    }
    assert_eq!(text.lines().count(), 14);
}

#[test]
fn tables_say_where_arcs_are_and_what_is_to_be_made() {
    let list = list();
    let table = list.to_csv();
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 12);
    let names = table.lines().next().unwrap().split(',').count();
    for (k, row) in rows.iter().enumerate() {
        let arc = list.snakes()[k / 4].arcs()[k % 4];
        assert_eq!((row.len(), row[0] as usize, row[1] as usize), (names, k / 4, k % 4));
        assert_eq!(row[2] as usize, list.kind_of()[k % 4]);
        let vector = |at: usize| DVec3::from_slice(&row[at..at + 3]);
        assert_eq!((vector(3), row[6], vector(7)), (arc.circle.center, arc.circle.radius, arc.circle.normal));
        assert_eq!((vector(10), row[13], row[14]), (arc.start, arc.angle_rad, arc.length()));
    }
    let parts = list.kinds_csv();
    assert_eq!(parts.lines().nth(2), Some("1,2,0.7,3"));
    assert!(parts.lines().nth(1).unwrap().ends_with(",6") && parts.lines().count() == 4);
}

/// The points at the beginning, the middle and the end of the arcs of a drawing, as its format says they are found.
fn read(text: &str) -> Vec<(String, [DVec3; 3])> {
    let drawing = Drawing::load(&mut text.as_bytes()).unwrap();
    let point = |entity: &Entity| {
        let EntityType::Arc(arc) = &entity.specific else { panic!("no arc") };
        let normal = DVec3::new(arc.normal.x, arc.normal.y, arc.normal.z);
        let x = if normal.x.abs() < 1.0 / 64.0 && normal.y.abs() < 1.0 / 64.0 {
            DVec3::Y.cross(normal)
        } else {
            DVec3::Z.cross(normal)
        };
        let x = x.normalize();
        let y = normal.cross(x).normalize();
        let end = if arc.end_angle < arc.start_angle { arc.end_angle + 360.0 } else { arc.end_angle };
        let at = |part: f64| {
            let (sine, cosine) = (arc.start_angle + part * (end - arc.start_angle)).to_radians().sin_cos();
            let [u, v] = [arc.center.x + arc.radius * cosine, arc.center.y + arc.radius * sine];
            u * x + v * y + arc.center.z * normal
        };
        (entity.common.layer.clone(), [0.0, 0.5, 1.0].map(at))
    };
    drawing.entities().map(point).collect()
}

#[test]
fn a_drawing_has_the_arcs() {
    // In any direction, and in planes about across z, where the format takes other axes.
    let mut lists = vec![list()];
    for tilt in [0.0, 1e-13, 1e-3, 1.0 / 64.0, 0.02] {
        let pose = Pose { point: DVec3::new(3.0, -2.0, 1.0), tangent: DVec3::X, normal: DVec3::new(0.0, -1.0, tilt) };
        let snake = Snake::from_arcs(&[shape(1.0, 2.0), shape(0.7, 1.9)], &[3.0], &pose).unwrap();
        lists.push(ArcList::new(&snake, &[snake.control().to_vec()], &[0.0], 0.0).unwrap());
    }
    for list in lists {
        let found = read(&list.to_dxf());
        let arcs: Vec<(usize, usize, Arc)> = list.arcs().collect();
        assert_eq!(found.len(), arcs.len());
        for ((layer, points), (_, j, arc)) in found.iter().zip(&arcs) {
            assert_eq!(*layer, format!("kind-{}", list.kind_of()[*j]));
            for (point, part) in points.iter().zip([0.0, 0.5, 1.0]) {
                assert!(point.distance(arc.point(part)) < 1e-13, "{point} {}", arc.point(part));
            }
        }
    }
}

#[test]
fn what_contradicts_itself_is_refused() {
    let list = list();
    let refused = |change: fn(&mut ArcListForm)| {
        let mut form = list.form();
        change(&mut form);
        ArcList::from_json(&json::to_text(&form)).unwrap_err().place().to_owned()
    };
    assert_eq!(refused(|form| form.version = 0), "version");
    assert_eq!(refused(|form| form.frames.clear()), "frames");
    assert_eq!(refused(|form| form.closed = true), "frames[0].control");
    assert_eq!(refused(|form| form.frames[1].control[2][1] += 1e-6), "frames[1].control");
    assert_eq!(refused(|form| _ = form.frames[1].arcs.pop()), "frames[1].arcs");
    assert_eq!(refused(|form| form.frames[2].arcs[1].radius *= 1.01), "frames[2].arcs");
    assert_eq!(
        refused(|form| form.frames.iter_mut().for_each(|frame| frame.arcs[3].kind = 8)),
        "frames[0].arcs[3].kind"
    );
    assert_eq!(refused(|form| form.kinds[2].count = 2), "kinds[2]");
    assert_eq!(refused(|form| form.kinds[1].length = 0.8), "kinds[1]");
    let snake = &list.snakes()[0];
    let frame = || snake.control().to_vec();
    let refused = |frames: &[Vec<DVec3>], times: &[f64], tolerance: f64| {
        ArcList::new(snake, frames, times, tolerance).unwrap_err().place().to_owned()
    };
    assert_eq!(refused(&[], &[], 0.0), "frames");
    assert_eq!(refused(&[frame()], &[], 0.0), "times");
    assert_eq!(refused(&[frame()], &[f64::NAN], 0.0), "times[0]");
    assert_eq!(refused(&[frame(), vec![]], &[0.0, 1.0], 0.0), "frames[1]");
    assert_eq!(refused(&[frame()], &[0.0], -1.0), "tolerance");
}
