"""Ruled strips. Truths are recomputed here in plain Python, so that the tests run without numpy too."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from math import dist, hypot, pi, sqrt
from pathlib import Path
from typing import Any, cast

import pytest

import shapeop
from shapeop import ruled

SIDE = 21
CHORD = 0.1 * 0.1 / 4
"""The chord error of the saddle's mesh: a quarter of its squared edge."""


def grid(height: Any, side: int = SIDE) -> tuple[list[list[float]], list[list[int]]]:
    at = [2 * i / (side - 1) - 1 for i in range(side)]
    points = [[x, y, height(x, y)] for y in at for x in at]
    corner = [side * j + i for j in range(side - 1) for i in range(side - 1)]
    return points, [[k, k + 1, k + 1 + side, k + side] for k in corner]


def saddle() -> ruled.Design:
    return ruled.Design(*grid(lambda x, y: x * y))


def with_strips(count: int = 3, control_count: int = 8, shared: bool = False) -> ruled.Design:
    design = saddle()
    design.level_boundaries(count)
    design.start(control_count, shared)
    return design


def rows_of(values: Any) -> list[list[float]]:
    return [[float(number) for number in row] for row in values]


def sides_of(strip: ruled.Strip) -> list[list[list[float]]]:
    return [rows_of(side) for side in strip.control]


def basis(knots: list[float], i: int, degree: int, u: float) -> float:
    """The B-spline function i, by the recursion of de Boor and Cox; the last span has its end."""
    if degree == 0:
        last = max(k for k in range(len(knots) - 1) if knots[k] < knots[k + 1])
        return float(knots[i] <= u < knots[i + 1] or (u == knots[-1] and i == last))
    total = 0.0
    if knots[i + degree] > knots[i]:
        total += (u - knots[i]) / (knots[i + degree] - knots[i]) * basis(knots, i, degree - 1, u)
    if knots[i + degree + 1] > knots[i + 1]:
        rise = (knots[i + degree + 1] - u) / (knots[i + degree + 1] - knots[i + 1])
        total += rise * basis(knots, i + 1, degree - 1, u)
    return total


def point_of(strip: ruled.Strip, u: float, v: float) -> list[float]:
    knots = [float(knot) for knot in strip.knots]
    first, second = sides_of(strip)
    weights = [basis(knots, i, 3, u) for i in range(len(first))]
    return [sum(w * ((1 - v) * a[k] + v * b[k]) for w, a, b in zip(weights, first, second)) for k in range(3)]


def test_asymptotic_directions_of_a_saddle_are_its_lines() -> None:
    points, faces = grid(lambda x, y: x * y)
    with ruled.Design(points, faces) as design:
        assert len(design.triangles) == 2 * (SIDE - 1) ** 2
        lines = []
        for family in (0, 1):
            found = design.directions(family)
            assert set(found.status) == {ruled.PointStatus.GOOD}
            worst = []
            for axis in (0, 1):
                sines = []
                for (x, y, _), d in zip(points, rows_of(found.vectors)):
                    line = [1, 0, y] if axis == 0 else [0, 1, x]
                    cosine = sum(a * b for a, b in zip(d, line)) / sqrt(sum(a * a for a in line))
                    sines.append(sqrt(max(0, 1 - cosine**2)))
                worst.append(max(sines))
            assert min(worst) < 0.025
            lines.append(worst.index(min(worst)))
        assert sorted(lines) == [0, 1]
        curvatures = design.curvatures
        for (x, y, _), (k1, k2) in zip(points, rows_of(curvatures.principal)):
            assert abs(float(k1) * float(k2) + (1 + x * x + y * y) ** -2) < 0.02
        assert len(curvatures.directions) == len(curvatures.normals) == len(points)
        for family, axis in enumerate(lines):
            design.select_family(family, hint=[-1, -1, 0])
            field = design.field
            assert all(field.is_known)
            assert not design.flips
            assert all(vector[axis] < 0 for vector in rows_of(field.vectors))
            trace = design.trace([0.13, 0.21, 0.13 * 0.21], length=5)
            assert trace.end is ruled.TraceEnd.BOUNDARY
            assert max(abs(p[1 - axis] - [0.13, 0.21][1 - axis]) for p in rows_of(trace.points)) < 2e-3
            assert rows_of(trace.points)[-1][axis] == pytest.approx(-1)


def test_strips_lie_on_the_saddle_and_cover_it() -> None:
    design = with_strips()
    assert design.strip_count == len(design.boundary_pairs) == 4
    assert design.level_report.stop is ruled.Stop.NONE
    assert min(map(float, design.level_values)) == 0
    seen: list[ruled.Progress] = []
    found = design.optimise(progress=seen.append)
    assert found.after < found.before
    assert found.after == pytest.approx(found.proximity + found.gap + found.coverage + found.way)
    history = rows_of(design.history)
    assert len(history) == found.iterations + 1
    assert all(after[0] < before[0] for before, after in zip(history, history[1:]))
    assert [progress.iteration for progress in seen] == list(range(len(seen)))
    worst, inside = 0.0, 0
    for number, strip in enumerate(design.strips):
        assert [float(knot) for knot in strip.knots] == [0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5]
        for i in range(21):
            for j in range(6):
                x, y, z = point_of(strip, 5 * i / 20, j / 5)
                if i == 7:
                    assert dist(list(map(float, design.evaluate(number, 5 * i / 20, j / 5).point)), [x, y, z]) < 1e-12
                if max(abs(x), abs(y)) <= 1:
                    worst, inside = max(worst, abs(z - x * y)), inside + 1
    assert inside > 200
    assert worst < 2 * CHORD
    report = design.report()
    assert 0.995 < report.coverage < 1.02
    assert worst < report.largest_deviation + 2 * CHORD
    assert max(strip.largest_deviation for strip in report.strips) == report.largest_deviation
    assert [joint.strips for joint in report.joints] == design.joints == [(0, 1), (1, 2), (2, 3)]
    assert json.loads(report.json)["coverage"] == report.coverage
    assert list(report.too_wide) == [i for i, strip in enumerate(report.strips) if strip.is_too_wide]
    assert all(strip.width_over_feature > 0.5 for strip in report.strips if strip.is_too_wide)
    # The integral of sqrt(1 + x^2 + y^2) over the square, by the midpoint rule.
    at = [(2 * i + 1) / 100 - 1 for i in range(100)]
    area = sum(sqrt(1 + x * x + y * y) for x in at for y in at) / 2500
    assert report.reference_area == pytest.approx(area, rel=2e-3)
    assert report.trimmed_area == pytest.approx(area, rel=5e-3)


def test_rulings_of_the_saddle_are_lines_of_it() -> None:
    design = with_strips()
    design.optimise()
    rulings = design.rulings(9)
    assert len(rulings.ends) == len(rulings.parameters) == len(rulings.strip_of)
    for (a, b), u, strip in zip(rulings.ends, rulings.parameters, rulings.strip_of):
        for t in (0.0, 0.3, 0.5, 1.0):
            x, y, z = (float(p) + t * (float(q) - float(p)) for p, q in zip(a, b))
            assert abs(z - x * y) < 2 * CHORD
            assert max(abs(x), abs(y)) < 1 + 1e-3
        whole = design.strip(strip)
        assert dist(point_of(whole, float(u), 0), point_of(whole, float(u), 1)) >= dist(*rows_of([a, b])) - 1e-9
    table = design.rulings_csv(9).splitlines()
    assert len(table) == len(rulings.ends) + 1
    assert design.rulings_obj(9).count("\nl ") == len(rulings.ends)


def test_meshes_of_strips_are_what_they_say() -> None:
    design = with_strips()
    design.optimise()
    whole = design.mesh(columns_per_span=2, rows=3)
    assert len(whole.faces) == len(whole.strip_of) == 4 * 5 * 2 * 2
    one = design.mesh(strip=2, columns_per_span=2, rows=3)
    assert set(one.strip_of) == {2}
    strip = design.strip(2)
    for corner in ((0.0, 0.0), (5.0, 1.0), (2.5, 0.5)):
        nearest = min(dist(point_of(strip, *corner), point) for point in rows_of(one.points))
        assert nearest < 1e-12
    trimmed = design.trimmed_mesh()
    points = rows_of(trimmed.points)
    assert max(abs(number) for point in points for number in point[:2]) < 1.01
    area = 0.0  # seen from above
    for face in trimmed.faces:
        a, b, c = (points[int(i)] for i in face)
        e, f = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        area += abs(e[0] * f[1] - e[1] * f[0]) / 2
    assert area == pytest.approx(4, abs=0.02)
    assert all(hypot(*normal) == pytest.approx(1) for normal in rows_of(trimmed.normals))
    shown = ruled.zebra(trimmed.points, trimmed.normals, [0, 0, 10])
    assert all(-1 <= float(value) <= 1 for value in shown)


def test_conditions_hold_exactly_and_contradictions_are_refused() -> None:
    design = ruled.Design(*grid(lambda x, y: x * y + 0.1 * (x**3 - 3 * x * y * y)))
    planes = [([1, 0.2, 0], offset) for offset in (-0.6, 0.1, 0.7)]
    for family in (0, 1):
        design.select_family(family)
        with contextlib.suppress(shapeop.GeometryError):  # the field does not cross the sections
            angles = design.planar_boundaries(planes)
            break
    assert all(pi / 12 < float(angle) <= pi / 2 for angle in angles)
    design.start(7)
    design.constrain_cut_planes()
    corner, along = [-0.6 - 0.2 * 1.3, 1.3, -0.3], [1, 0.3, 0.2]
    design.constrain_point(1, 0, "start", corner)
    design.constrain_end_direction(1, ruled.End.FINISH, along)
    design.optimise()
    first, second = sides_of(design.strip(1))
    assert dist(first[0], corner) < 1e-10
    ruling = [b - a for a, b in zip(first[-1], second[-1])]
    cosine = sum(a * b for a, b in zip(ruling, along)) / (hypot(*ruling) * hypot(*along))
    assert abs(abs(cosine) - 1) < 1e-12
    for side, offset in ((first, -0.6), (second, 0.1)):
        assert max(abs(x + 0.2 * y - offset) for x, y, _ in side) < 1e-10
    number = design.condition_count
    design.constrain_point(1, 0, "start", [0, 0, 0])
    assert design.condition_count == number
    with pytest.raises(shapeop.GeometryError, match=r"conditions\[\d+\].*contradicts") as refused:
        design.optimise()
    assert refused.value.code == shapeop.ErrorCode.INFEASIBLE
    assert sides_of(design.strip(1))[0][0] == first[0]
    design.clear_conditions()
    assert design.condition_count == 0
    design.constrain_ends()
    ends = [point for side in sides_of(design.strip(1)) for point in (side[0], side[-1])]
    design.optimise(max_iterations=2)
    moved = [point for side in sides_of(design.strip(1)) for point in (side[0], side[-1])]
    assert max(dist(a, b) for a, b in zip(ends, moved)) < 1e-12


def test_a_conoidal_strip_becomes_planks() -> None:
    design = with_strips(2)
    axis = design.strip_axis(1)
    assert hypot(*map(float, axis.direction)) == pytest.approx(1)
    design.constrain_conoid(1)
    design.optimise()
    first, second = sides_of(design.strip(1))
    axis = design.strip_axis(1)
    w = [float(number) for number in axis.direction]
    assert axis.error < 1e-8
    assert max(abs(sum(c * (b - a) for c, a, b in zip(w, p, q))) for p, q in zip(first, second)) < 1e-9
    planks = design.planks(1, 0.25, depth=0.05)
    height = abs(sum(c * (b - a) for c, a, b in zip(w, first[0], first[-1])))
    assert sum(plank.filled * 0.25 for plank in planks.planks) == pytest.approx(height, abs=1e-6)
    assert len(planks.dowels[0]) == len(planks.planks) + 1
    for plank in planks.planks:
        outline = rows_of(plank.outline)
        for ruling in plank.rulings:
            for x, y in rows_of(ruling):
                for (ax, ay), (bx, by) in zip(outline, outline[1:] + outline[:1]):
                    assert (bx - ax) * (y - ay) - (by - ay) * (x - ax) > -1e-9
        assert plank.heights[1] - plank.heights[0] == pytest.approx(0.25)
    assert "<svg" in design.planks_svg("one & all", 500)
    assert "one &amp; all" in design.planks_svg("one & all", 500)
    assert json.loads(planks.json)["thickness"] == 0.25
    design.optimise()
    with pytest.raises(shapeop.NotInitialisedError):
        design.planks_svg("none")


def test_strips_are_written_read_moved_and_copied() -> None:
    design = with_strips(2, 6, shared=True)
    assert design.is_shared
    text, before = design.to_json(), [sides_of(strip) for strip in design.strips]
    assert before[0][1] == before[1][0]
    assert json.loads(text)["strips"][1]["control"] == before[1]
    other = design.copy()
    moved = [[[x, y, z + 0.5] for x, y, z in side] for side in before[1]]
    design.set_control(1, moved)
    assert sides_of(design.strip(0))[1] == moved[0]
    assert sides_of(design.strip(2))[0] == moved[1]
    assert [sides_of(strip) for strip in other.strips] == before
    design.set_strips(text)
    assert [sides_of(strip) for strip in design.strips] == before
    assert "cstype bspline" in design.surfaces_obj()
    assert "3 strips" in repr(design)


def test_boundaries_of_other_kinds() -> None:
    design = saddle()
    axis = next(k for k in (0, 1) if abs(rows_of(design.field.vectors)[0][k]) > 0.5)
    assert design.field.vectors[0][axis] > 0
    # Lines across the rulings.
    lines = [[[at, t, at * t] if axis == 0 else [t, at, at * t] for t in (-1, -0.5, 0, 0.5, 1)] for at in (-0.5, 0.5)]
    design.drawn_boundaries(lines, closed=[False, False])
    assert [boundary.level for boundary in design.boundaries] == [0, 1]
    started = design.start(6)
    assert len(started.missed) == len(started.moved) == 1
    # Where the field (1, 0, y) is orthogonal to (-0.2, 0, 1) y is 0.2.
    curves = design.great_circle([-0.2, 0, 1] if axis == 0 else [0, -0.2, 1])
    assert max(abs(p[1 - axis] - 0.2) for curve in curves for p in rows_of(curve)) < 0.03
    design.level_boundaries(width=0.5, kind="equidistant", overshoots=False)
    count = len(design.boundaries)
    assert design.level_report.stop is not ruled.Stop.CANCELLED
    assert float(design.level_history[-1]) <= float(design.level_history[0])
    assert count > 2
    design.level_boundaries(3, overshoots=False)
    assert len(design.boundaries) == 3
    design.set_levels(5, overshoots=False, least_length=0)
    # Of the outer levels there is a curve in both corners, and one that joins both, from where a strip leads on.
    assert (len({round(boundary.level, 9) for boundary in design.boundaries}), len(design.boundaries)) == (5, 9)
    found = design.boundary_axis(1)
    assert hypot(*map(float, found.direction)) == pytest.approx(1)
    assert design.critical_points == []
    assert list(design.unmatched_levels) == []
    assert all(curve.length > 0 for curve in design.dropped_curves)


def test_progress_ends_a_run_and_its_exceptions_pass_through() -> None:
    design = with_strips()
    found = design.optimise(progress=lambda progress: progress.iteration < 1)
    assert (found.stop, found.iterations) == (ruled.Stop.CANCELLED, 1)
    assert found.after < found.before

    def fail(progress: ruled.Progress) -> None:
        raise KeyError(progress.iteration)

    with pytest.raises(KeyError):
        design.optimise(progress=fail)

    def look(progress: ruled.Progress) -> None:
        with pytest.raises(shapeop.BusyError):
            design.to_json()

    design.optimise(max_iterations=1, progress=look)


@pytest.mark.parametrize(
    ("mistake", "kind", "message"),
    [
        (lambda: ruled.Design(*grid(lambda x, y: x * x + y * y)), shapeop.GeometryError, "negatively curved"),
        (lambda: ruled.Design([[0, 0, 0]], [[0, 1, 2]]), shapeop.IndexRangeError, r"faces\[0\]"),
        (lambda: ruled.Design("mesh"), shapeop.ArgumentTypeError, "mesh"),
        (lambda: ruled.Design(*grid(lambda x, y: x * y), family=2), shapeop.Error, "options->family"),
        (
            lambda: ruled.Design(*grid(lambda x, y: x * y), allow_cut=cast(bool, 1)),
            shapeop.ArgumentTypeError,
            "allow_cut",
        ),
        (lambda: saddle().level_boundaries(), shapeop.ArgumentError, "count, width and values"),
        (lambda: saddle().level_boundaries(3, kind="straight"), shapeop.ArgumentError, "kind"),
        (lambda: saddle().level_boundaries(3, orthogonal=-1), shapeop.InvalidValueError, "options->orthogonal"),
        (lambda: saddle().level_boundaries(values=[1e9]), shapeop.GeometryError, r"values\[0\]"),
        (lambda: saddle().planar_boundaries([[1, 2]]), shapeop.ArgumentError, r"planes\[0\]"),
        (lambda: saddle().planar_boundaries([([1, 0, 0], 9)]), shapeop.GeometryError, r"planes\[0\]"),
        (lambda: saddle().start(), shapeop.GeometryError, "boundaries"),
        (lambda: saddle().optimise(), shapeop.InvalidValueError, "strips"),
        (lambda: saddle().set_levels(3), shapeop.NotInitialisedError, "level"),
        (lambda: with_strips().start(3), shapeop.InvalidValueError, "control_count"),
        (lambda: with_strips().evaluate(0, 9, 0), shapeop.InvalidValueError, "u"),
        (lambda: with_strips().strip(9), shapeop.IndexRangeError, "strip"),
        (lambda: with_strips().optimise(gap=float("nan")), shapeop.InvalidValueError, "options->gap"),
        (lambda: with_strips().optimise(least_width=0), shapeop.ArgumentError, "least_width"),
        (lambda: with_strips().constrain_point(0, 0, "middle"), shapeop.ArgumentError, "end"),
        (lambda: with_strips().constrain_conoid(0, [0, 0, 0]), shapeop.InvalidValueError, "axis"),
        (lambda: with_strips().set_control(0, [[[0, 0, 0]] * 5] * 2), shapeop.InvalidValueError, "count"),
        (lambda: with_strips().planks(0, 0), shapeop.InvalidValueError, "options->thickness"),
        (lambda: with_strips().planks(0, 0.1, axis=[0, 0, 1]), shapeop.GeometryError, "strip"),
        (lambda: with_strips().trimmed_mesh(tolerance=1), shapeop.InvalidValueError, "tolerance"),
        (lambda: with_strips().set_strips("{}"), shapeop.InvalidValueError, "version"),
    ],
)
def test_mistakes_are_named(mistake: Any, kind: Any, message: str) -> None:
    with pytest.raises(kind, match=message):
        mistake()


def test_a_closed_design_is_refused() -> None:
    design = saddle()
    design.close()
    design.close()
    assert repr(design) == "<shapeop.ruled.Design, closed>"
    with pytest.raises(shapeop.ClosedError):
        design.start()
    with pytest.raises(shapeop.ClosedError), design:
        pass


def test_a_mesh_of_compas_is_taken() -> None:
    structures = pytest.importorskip("compas.datastructures")
    points, faces = grid(lambda x, y: x * y, 11)
    design = ruled.Design(structures.Mesh.from_vertices_and_faces(points, faces))
    assert len(design.triangles) == 200


def test_a_rhino_file_has_the_strips(tmp_path: Path) -> None:
    rhino = pytest.importorskip("rhino3dm")
    design = with_strips()
    path = tmp_path / "strips.3dm"
    design.to_3dm(path, unit="millimeters")
    model: Any = rhino.File3dm.Read(str(path))
    assert model.Settings.ModelUnitSystem == rhino.UnitSystem.Millimeters
    assert [thing.Attributes.Name for thing in model.Objects] == [f"strip-{i}" for i in range(4)]
    for thing, strip in zip(model.Objects, design.strips):
        # A surface becomes a boundary representation of one face.
        surface: Any = thing.Geometry if hasattr(thing.Geometry, "PointAt") else thing.Geometry.Surfaces[0]
        for u, v in ((0.0, 0.0), (1.3, 0.4), (5.0, 1.0)):
            at = surface.PointAt(u, v)
            assert dist([at.X, at.Y, at.Z], point_of(strip, u, v)) < 1e-12
    with pytest.raises(shapeop.ArgumentError, match="unit"):
        design.to_3dm(path, unit="ells")
    with pytest.raises(OSError, match="path"):
        design.to_3dm(tmp_path / "none" / "strips.3dm")


def test_a_rhino_file_needs_its_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    with pytest.raises(ImportError, match="pip install rhino3dm"):
        with_strips().to_3dm(tmp_path / "strips.3dm")


def test_the_example_runs(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[1] / "examples" / "ruled_strips.py"
    ran = subprocess.run(
        [sys.executable, str(example), str(tmp_path / "made")], capture_output=True, text=True, check=True
    )
    assert "strips after" in ran.stdout
    assert "planks" in ran.stdout
    names = {path.name for path in (tmp_path / "made").iterdir()}
    assert names == {"strips.json", "strips.obj", "rulings.csv", "planks.svg"}
