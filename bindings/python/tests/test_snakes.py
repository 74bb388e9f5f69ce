"""Circular arc snakes. Truths are recomputed here in plain Python, so that the tests run without numpy too."""

from __future__ import annotations

import json
import subprocess
import sys
from math import atan2, cos, dist, hypot, pi, sin, tan
from pathlib import Path
from typing import Any, Callable, cast

import pytest

import shapeop
from shapeop import snakes

Z = [0.0, 0.0, 1.0]


def rows_of(values: Any) -> list[list[float]]:
    return [[float(number) for number in row] for row in values]


def ring(count: int, z: float = 0.0) -> list[list[float]]:
    """The corners of a regular polygon around the unit circle."""
    radius = 1 / cos(pi / count)
    return [[radius * cos(2 * pi * k / count), radius * sin(2 * pi * k / count), z] for k in range(count)]


def twisted() -> snakes.Snake:
    return snakes.Snake.from_arcs([1.0, 2.0, 1.5], [1.2, 1.5, 1.0], [0.7, -0.4])


def flat() -> snakes.Snake:
    """Five arcs of a circle of radius 2 about (0, 2, 0)."""
    return snakes.Snake.from_arcs([2.0] * 5, [0.5] * 5, [0.0] * 4)


def six_arcs() -> snakes.Snake:
    return snakes.Snake.from_arcs([1.0] * 6, [pi / 3] * 6, [1.0, -0.7, 0.9, -0.8, 0.6])


def around(point: list[float], first: float, last: float, count: int = 240) -> list[list[float]]:
    """Points of the circle about the z axis through a point."""
    angles = [first + (last - first) * k / count for k in range(count + 1)]
    x, y, z = point
    return [[cos(a) * x - sin(a) * y, sin(a) * x + cos(a) * y, z] for a in angles]


def test_a_snake_is_what_its_arcs_say() -> None:
    snake = twisted()
    with snakes.Snake(snake.control) as again:
        for each in (snake, again):
            assert [float(r) for r in each.radii] == pytest.approx([1.0, 2.0, 1.5])
            assert [float(length) for length in each.lengths] == pytest.approx([1.2, 1.5, 1.0])
            assert [float(torsion) for torsion in each.torsions] == pytest.approx([0.7, -0.4])
            assert each.length == pytest.approx(3.7)
            assert not each.is_closed
            assert each.residual < 1e-14
        samples = rows_of(again.sample(4))
        assert len(samples) == 13
        for j, arc in enumerate(again.arcs):
            assert dist(arc.start, rows_of(again.contacts)[j]) < 1e-12
            assert all(abs(dist(arc.center, p) - arc.radius) < 1e-12 for p in samples[4 * j : 4 * j + 5])
            assert arc.angle * arc.radius == pytest.approx(float(again.lengths[j]))
    assert repr(again) == "<shapeop.snakes.Snake, closed>"
    with pytest.raises(shapeop.ClosedError):
        _ = again.control
    assert repr(snake) == "<shapeop.snakes.Snake of 3 arcs, open>"


def test_closed_snakes_and_texts() -> None:
    seven = snakes.Snake(ring(7), closed=True)
    assert seven.is_closed
    assert all(abs(hypot(p[0], p[1]) - 1) < 1e-12 for p in rows_of(seven.contacts))
    with pytest.raises(shapeop.Error, match="first_tangent"):
        snakes.Snake(ring(8), closed=True)
    eight = snakes.Snake(ring(8), closed=True, first_tangent=tan(pi / 8))
    again = snakes.Snake.from_json(eight.to_json())
    assert rows_of(again.control) == rows_of(eight.control)
    (kind,) = again.kinds()
    assert (kind.radius, kind.length) == pytest.approx((1.0, pi / 4))
    assert kind.count == 8
    assert again.kind_of() == [0] * 8
    assert len(again.arcs_csv().splitlines()) == 9
    assert again.to_dxf().split().count("ARC") == 8


def test_freedoms() -> None:
    snake = twisted()
    assert snake.freedoms() == (8, 7, 7)
    assert snake.freedoms(snakes.sphere([0.3, 0.1, 0.2], 1)).free == 3
    assert flat().deviation(snakes.plane([0, 0, 0.25], [0, 0, 3])) == pytest.approx(0.25)
    assert flat().deviation(snakes.cylinder([0, 2, 5], Z, 1.9)) == pytest.approx(0.1)
    assert flat().deviation(snakes.torus([0, 2, 0], Z, 2, 0.3)) == pytest.approx(0.3)


def test_projections_keep_distances() -> None:
    snake = twisted()
    target = [[p[k] + 0.02 * sin(7 * i + 3 * k) for k in range(3)] for i, p in enumerate(rows_of(snake.control))]
    found = snake.project(target, exact=True)
    assert found.is_nearest
    assert found.residual < 1e-12
    assert snake.residual < 1e-12
    assert max(dist(a, b) for a, b in zip(target, rows_of(snake.control))) == pytest.approx(found.moved)
    snake.move(target)
    assert snake.residual > 1e-3
    found = snake.project(target, fixed=[0])
    assert not found.is_nearest
    assert dist(rows_of(snake.control)[0], target[0]) == 0
    with pytest.raises(shapeop.InvalidValueError, match="target"):
        snake.project(target[1:])


def test_a_snake_in_a_plane_moves_rigidly() -> None:
    snake, plane = flat(), snakes.plane([0, 0, 0], Z)
    seen: list[snakes.Progress] = []
    evolution = snakes.evolve(snake, plane, direction="sideways", step=0.02, max_steps=6, progress=seen.append)
    assert evolution.stop is snakes.Stop.STEPS
    assert (evolution.stop_rail, len(evolution)) == (None, 7)
    assert [now.step for now in seen] == list(range(7))
    assert [float(t) for t in evolution.times] == pytest.approx([0.02 * k for k in range(7)])
    assert seen[6].time == pytest.approx(float(evolution.times[6]))
    assert max(map(float, evolution.residuals)) < 1e-12
    assert max(map(float, evolution.deviations)) < 1e-12
    assert max(map(float, evolution.height_residuals)) < 1e-12
    assert evolution.congruence().rms < 1e-12
    frames = [rows_of(frame) for frame in evolution.frames]
    assert frames[0] == rows_of(snake.control)
    assert frames[6] == rows_of(evolution.snake().control)
    assert dist(frames[6][0], frames[0][0]) > 0.05
    found = snakes.velocity(snake, plane, direction="sideways")
    assert found.residual < 1e-12
    assert all(abs(v[2]) < 1e-9 for v in rows_of(found.vectors))
    assert "stopped by STEPS" in repr(evolution)
    with evolution:
        pass
    with pytest.raises(shapeop.ClosedError):
        len(evolution)


def test_runs_are_cancelled_and_errors_come_through() -> None:
    evolution = snakes.evolve(twisted(), direction=Z, progress=lambda now: now.step < 3)
    assert (evolution.stop, len(evolution)) == (snakes.Stop.CANCELLED, 4)

    def fails(now: snakes.Progress) -> None:
        raise ZeroDivisionError(now.step)

    with pytest.raises(ZeroDivisionError):
        snakes.evolve(twisted(), direction=Z, progress=fails)


def test_a_circle_sweeps_a_cylinder() -> None:
    evolution = snakes.evolve(
        snakes.Snake(ring(7), closed=True), snakes.cylinder([0, 0, 0], Z, 1), direction=Z, step=0.25, max_steps=4
    )
    mesh = evolution.mesh(per_arc=3)
    points = rows_of(mesh.points)
    assert (len(points), len(mesh.faces)) == (5 * 21, 4 * 21)
    assert all(abs(hypot(p[0], p[1]) - 1) < 1e-9 for p in points)
    assert all(abs(p[2] - 0.25 * (k // 21)) < 1e-9 for k, p in enumerate(points))
    assert len(evolution.mesh(3, comes_back=True).faces) == 5 * 21
    assert all(arc.center[2] == pytest.approx(1) for arc in evolution.arcs())
    assert all(arc.center[2] == pytest.approx(0.25) for arc in evolution.arcs(1))
    form = json.loads(evolution.to_json())
    assert (len(form["frames"]), form["kinds"][0]["count"]) == (5, 35)
    assert len(evolution.to_csv().splitlines()) == 36
    assert evolution.kinds_csv().splitlines()[1].endswith(",35")
    assert evolution.to_dxf().split().count("ARC") == 35
    assert evolution.kinds()[0].count == 7
    pipe = evolution.pipe(0.2, frame=0, per_arc=4, around=10)
    assert all(abs(hypot(hypot(p[0], p[1]) - 1, p[2]) - 0.2) < 1e-12 for p in rows_of(pipe.points))
    band = rows_of(evolution.lamellae(0.5, along="normal", per_arc=4).points)
    assert all(abs(hypot(p[0], p[1]) - 1.5) < 1e-9 for p in band[28:])
    assert len(rows_of(evolution.sample(2, per_arc=2))) == 14
    with pytest.raises(shapeop.ArgumentError, match="frame"):
        evolution.arcs(-6)
    with pytest.raises(shapeop.IndexRangeError, match="frame"):
        evolution.arcs(5)


def test_pipes_and_lamellae_of_a_snake() -> None:
    snake = flat()
    pipe = rows_of(snake.pipe(0.5, per_arc=4).points)
    assert all(abs(hypot(hypot(p[0], p[1] - 2) - 2, p[2]) - 0.5) < 1e-12 for p in pipe)
    rings = rows_of(snake.lamellae(0.5, per_arc=4).points)
    assert {round(hypot(p[0], p[1] - 2), 9) for p in rings} == {2.0, 2.5}
    assert {round(p[2], 9) for p in rows_of(snake.lamellae(0.5, along=[0, 0, 2]).points)} == {0.0, 0.5}
    with pytest.raises(shapeop.NotInitialisedError, match="surface"):
        snake.lamellae(0.5, along="normal")
    with pytest.raises(shapeop.ArgumentError, match="along"):
        snake.lamellae(0.5, along="up")


def test_rails_turn_a_snake_rigidly() -> None:
    snake = twisted()
    snake.move([[x + 4, y, z] for x, y, z in rows_of(snake.control)])
    control, contact = rows_of(snake.control), rows_of(snake.contacts)[1]
    rails = [
        snakes.drive(0, around(control[0], -0.25, 0.75), speed=control[0][0]),
        snakes.follow(4, around(control[4], -0.25, 0.75)),
        snakes.glide(1, around(contact, -0.25, 0.75)),
    ]
    evolution = snakes.sweep(snake, rails, step=0.05)
    assert (evolution.stop, evolution.stop_rail) == (snakes.Stop.RAIL_END, 0)
    assert evolution.congruence().rms < 1e-6
    assert max(map(float, evolution.incongruences)) < 1e-6
    end = rows_of(evolution.snake().control)[0]
    assert atan2(end[1], end[0]) - atan2(control[0][1], control[0][0]) > 0.7
    with pytest.raises(shapeop.InvalidValueError, match="points"):
        snakes.sweep(snake, [snakes.drive(1, rails[0].curve)])
    with pytest.raises(shapeop.ArgumentError, match="curve"):
        snakes.sweep(snake, [snakes.drive(1, [])])


def test_wishes() -> None:
    snake = twisted()
    found = rows_of(snakes.velocity(snake, fixed=[0], wishes=[snakes.with_velocity(4, Z)]).vectors)
    assert dist(found[4], Z) < 1e-6
    assert hypot(*found[0]) < 1e-9
    wishes = [snakes.with_velocity(4, Z), snakes.in_plane(4, [0, 5, 5], 1e6)]
    found = rows_of(snakes.velocity(snake, fixed=[0], wishes=wishes).vectors)
    assert abs(found[4][1] + found[4][2]) < 1e-3
    found = rows_of(snakes.velocity(snake, direction=[0, 3, 0], speeds=[2.0] * 5).vectors)
    assert all(dist(v, [0, 2, 0]) < 1e-6 for v in found)


def test_curves_of_constant_curvature_and_snakes_along_them() -> None:
    sphere = snakes.sphere([0, 0, 0], 2)
    left = snakes.curve(sphere, [2, 0, 0], [0, 1, 1], 0.8, 3)
    right = snakes.curve(sphere, [2, 0, 0], [0, 1, 1], 0.8, 3, turns="right", steps=100)
    points = rows_of(left.points)
    assert left.end is snakes.CurveEnd.LENGTH
    assert (len(points), len(right.points)) == (201, 101)
    assert dist(points[0], points[200]) == pytest.approx(2 / 0.8 * sin(0.5 * 3 * 0.8))
    assert rows_of(right.points)[100][0] == pytest.approx(points[200][0])
    fitted = snakes.fit(left.points, 2)
    assert fitted.is_converged
    assert fitted.deviation < 1e-6
    assert fitted.snake.length == pytest.approx(3)
    assert fitted.snake.deviation(sphere) < 1e-5
    bent = snakes.curve(sphere, [2, 0, 0], [0, 1, 1], [0.9, 0.1], 3)
    assert bent.end is snakes.CurveEnd.BENDS_MORE
    assert bent.curvature < abs(bent.normal_curvature)
    with pytest.raises(shapeop.GeometryError, match="curvatures") as refused:
        snakes.curve(sphere, [2, 0, 0], [0, 1, 1], 0.4, 3)
    assert refused.value.code is shapeop.ErrorCode.NO_SOLUTION
    closed = snakes.fit(around([1.5, 0, 0.3], 0, 2 * pi)[:-1], 8, closed=True)
    assert closed.snake.is_closed
    assert closed.deviation < 1e-9


def test_meshes() -> None:
    at = [k / 5 - 1 for k in range(11)]
    points = [[x, y, 0.0] for y in at for x in at]
    faces = [[11 * j + i, 11 * j + i + 1, 11 * j + i + 12, 11 * j + i + 11] for j in range(10) for i in range(10)]
    found = snakes.curve((points, faces), [0.1, 0, 0], [1, 0, 0], 0.0, 2)
    assert found.end is snakes.CurveEnd.BOUNDARY
    assert found.length == pytest.approx(0.9)
    # Up and down along a mesh is what the plane would do.
    snake = snakes.Snake.from_arcs([0.5] * 3, [0.2] * 3, [0.0] * 2)
    evolutions = [
        snakes.evolve(snake, surface, direction="sideways", step=0.02, max_steps=3)
        for surface in ((points, faces), snakes.plane([0, 0, 0], Z))
    ]
    a, b = (rows_of(evolution.snake().control) for evolution in evolutions)
    assert max(dist(p, q) for p, q in zip(a, b)) < 1e-9


def test_a_covering_is_judged() -> None:
    at = [1.25 * k / 40 for k in range(41)]
    wall = [[2.01 * sin(a), 2 - 2.01 * cos(a), z] for z in (0.0, 2.0) for a in at]
    faces = [[k, k + 1, k + 42, k + 41] for k in range(40)]
    evolution = snakes.evolve(flat(), direction=Z, step=0.25, max_steps=4)
    alone = evolution.covering()
    assert not alone.is_compared
    assert (alone.position_count, alone.arc_count, alone.kind_count) == (5, 25, 1)
    assert alone.length == pytest.approx(12.5)
    assert alone.area == pytest.approx(2.5, abs=1e-2)
    # The heights over the wall are kept, and so it moves along it.
    evolution = snakes.evolve(flat(), (wall, faces), direction=Z, step=0.25, max_steps=4)
    found = evolution.covering(distance=0.05, per_arc=20)
    assert found.is_compared
    assert found.coverage == pytest.approx(0.52, abs=0.03)
    assert found.reference_area == pytest.approx(5.025, abs=0.01)
    assert found.largest_deviation < 0.015
    assert json.loads(found.json)["reference"]["distance"] == 0.05
    with pytest.raises(shapeop.InvalidValueError, match="options->distance"):
        evolution.covering(distance=-1)


def test_a_linkage_moves_around() -> None:
    linkage = snakes.Linkage(six_arcs())
    assert linkage.freedoms == 1
    assert abs(linkage.determinant) > 1e-3
    cycle = linkage.cycle()
    motion = cycle.motion
    assert cycle.is_closed
    assert motion.closing is not None
    assert motion.closing < 1e-8
    assert motion.ranges == pytest.approx((1.1605, 1.8245), abs=2e-3)
    assert motion.turns == (0, 0)
    angles = rows_of(cycle.angles)
    assert len(angles) == len(cycle)
    assert max(a for a, _ in angles) - min(a for a, _ in angles) == pytest.approx(motion.ranges[0], abs=1e-3)
    start = rows_of(cycle.frames[0])
    path = rows_of(cycle.contact_path(1))
    assert max(abs(dist(p, start[1]) - dist(path[0], start[1])) for p in path) < 1e-10
    phases = [rows_of(frame) for frame in cycle.at_phases([0, 1, 0.3])]
    assert max(dist(a, b) for a, b in zip(phases[0] + phases[1], start + start)) < 1e-9
    copies = [rows_of(copy) for copy in cycle.copies(2, 0.2, Z, phase=0.1)]
    assert max(dist([x, y, z - 1], p) for (x, y, z), p in zip(copies[1], phases[2])) < 1e-9
    assert len(cycle.mesh(2, comes_back=True).faces) == 12 * len(cycle)
    assert "CLOSED" in repr(cycle)
    seen: list[float] = []

    def stop(now: snakes.Progress) -> bool:
        seen.append(now.first_angle)
        return now.step < 5

    stopped = linkage.cycle(progress=stop, step=0.05, reversed=True)
    assert stopped.motion.end is snakes.CycleEnd.CANCELLED
    assert stopped.motion.closing is None
    assert abs(seen[-1]) > 0.01
    with pytest.raises(shapeop.Error, match="snake"):
        snakes.Linkage(snakes.Snake.from_arcs([1.0] * 2, [1.0] * 2, [0.3]))
    singular = snakes.Linkage(snakes.Snake.from_arcs([1.0] * 6, [pi / 2] * 6, [1.2] * 5))
    assert abs(singular.determinant) < 1e-9
    with pytest.raises(shapeop.GeometryError):
        singular.cycle()


@pytest.mark.parametrize(
    ("mistake", "expected", "place"),
    [
        (lambda: snakes.Snake([[0, 0, 0], [1, 0, 0]]), shapeop.InvalidValueError, "control"),
        (lambda: snakes.Snake("control"), shapeop.ArgumentTypeError, "control"),
        (lambda: snakes.Snake(ring(7), closed=cast("Any", 1)), shapeop.ArgumentTypeError, "closed"),
        (lambda: snakes.Snake(ring(8), True, float("nan")), shapeop.InvalidValueError, "first_tangent"),
        (lambda: snakes.Snake.from_arcs([1.0], [1.0, 1.0]), shapeop.ArgumentError, "lengths"),
        (lambda: snakes.Snake.from_arcs([-1.0], [1.0]), shapeop.InvalidValueError, r"radii\[0\]"),
        (lambda: snakes.Snake.from_json("{}"), shapeop.InvalidValueError, "version"),
        (lambda: snakes.sphere([0, 0], 1), shapeop.ArgumentError, "center"),
        (lambda: flat().deviation(snakes.sphere([0, 0, 0], -1)), shapeop.InvalidValueError, r"numbers\[3\]"),
        (lambda: flat().deviation("plane"), shapeop.ArgumentTypeError, "mesh"),
        (lambda: snakes.evolve(flat(), direction="sideways"), shapeop.InvalidValueError, "direction"),
        (lambda: snakes.evolve(flat(), direction="up"), shapeop.ArgumentError, "direction"),
        (lambda: snakes.evolve(flat(), step=0), shapeop.InvalidValueError, "options->step"),
        (lambda: snakes.evolve(flat(), step=cast("Any", "1")), shapeop.ArgumentTypeError, "step"),
        (lambda: snakes.evolve(flat(), max_deviation=-1), shapeop.ArgumentError, "max_deviation"),
        (lambda: snakes.evolve(flat(), speeds=[1.0, 2.0]), shapeop.InvalidValueError, "nb_speeds"),
        (lambda: snakes.evolve(flat(), fixed=[7]), shapeop.IndexRangeError, r"points\[0\]"),
        (lambda: snakes.evolve(flat(), second_order=cast("Any", 2)), shapeop.ArgumentTypeError, "second_order"),
        (lambda: snakes.fit(ring(7), 0), shapeop.InvalidValueError, "nb_arcs"),
        (lambda: snakes.fit(ring(7), 3, nearness=0), shapeop.InvalidValueError, "options->nearness"),
        (lambda: snakes.curve(snakes.sphere([0, 0, 0], 1), [1, 0, 0], Z, 2, 1, turns="up"), ValueError, "turns"),
        (lambda: snakes.curve(snakes.sphere([0, 0, 0], 1), [1, 0, 0], Z, 2, 0), shapeop.InvalidValueError, "length"),
    ],
)
def test_mistakes_name_the_argument(mistake: Callable[[], object], expected: type[Exception], place: str) -> None:
    with pytest.raises(expected, match=place):
        mistake()


def test_the_example_runs(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[1] / "examples" / "circular_arc_snakes.py"
    command = [sys.executable, str(example), str(tmp_path)]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    assert "126 arcs of radius" in told.stdout
    assert "CLOSED" in told.stdout
    assert len((tmp_path / "arcs.csv").read_text(encoding="utf-8").splitlines()) == 127
