"""Super-canal surfaces. Truths are recomputed here in plain Python, so that the tests run without numpy too."""

from __future__ import annotations

import json
import subprocess
import sys
from math import cos, dist, pi, sin
from pathlib import Path
from typing import Any

import pytest

import shapeop
from shapeop import canal

PROFILE = [[2.7, 0, 0], [2.5, 0, 0.5], [2.0, 0, 0.7], [1.5, 0, 0.5]]


def torus() -> canal.CanalSurface:
    return canal.CanalSurface.revolution(PROFILE, angle=pi / 2, columns=5)


def flat(rows: list[list[Any]]) -> list[Any]:
    return [point for row in rows for point in row]


def rows_of(values: Any) -> list[list[list[float]]]:
    return [[[float(number) for number in point] for point in row] for row in values]


def test_a_surface_of_revolution_is_where_it_should_be() -> None:
    with torus() as surface:
        assert surface.shape == (4, 5)
        assert surface.kind is canal.Kind.REVOLUTION
        for i, row in enumerate(rows_of(surface.points)):
            radius, height = PROFILE[i][0], PROFILE[i][2]
            for j, point in enumerate(row):
                angle = pi / 2 * j / 4
                assert dist(point, [radius * cos(angle), radius * sin(angle), height]) < 1e-12


def test_inversion_and_undo() -> None:
    surface = torus()
    before = rows_of(surface.points)
    surface.invert([0, 0, 3], 4)
    for old, new in zip(flat(before), flat(rows_of(surface.points))):
        q = [old[0], old[1], old[2] - 3]
        factor = 4 / sum(c * c for c in q)
        assert dist(new, [factor * q[0], factor * q[1], 3 + factor * q[2]]) < 1e-12
    assert surface.family == "M-revolution"
    restored = rows_of(surface.restored_points)
    assert max(dist(a, b) for a, b in zip(flat(before), flat(restored))) < 1e-12
    assert surface.undo()
    assert not surface.undo()
    assert surface.family == "revolution"


def test_quads_are_circular_after_any_chain() -> None:
    surface = torus()
    surface.combescure([1.3, 0.8, 1.1], [1, 1.5, 0.7, 1])
    surface.invert([0, 0, 3], 4)
    surface.rotate([0, 1, 1], 0.4)
    surface.scale(2)
    surface.translate([1, 2, 3])
    points = flat(rows_of(surface.points))
    quads = [[5 * i + j, 5 * i + 5 + j, 5 * i + 6 + j, 5 * i + 1 + j] for i in range(3) for j in range(4)]
    found = canal.check_circular(points, quads)
    assert max(found.planarity) < 1e-10
    assert max(found.concyclicity) < 1e-10
    assert surface.properties()["face_count"] == 12
    again = canal.CanalSurface.from_json(surface.to_json())
    assert rows_of(again.points) == rows_of(surface.points)
    assert again.chain_length == 5
    assert json.loads(surface.to_json())["rows"] == 4


def test_refined_points_contain_the_old_ones() -> None:
    surface = torus()
    fine = surface.refined(2, 3)
    assert fine.shape == (7, 13)
    coarse, fine_points = rows_of(surface.points), rows_of(fine.points)
    assert max(dist(coarse[i][j], fine_points[2 * i][3 * j]) for i in range(4) for j in range(5)) < 1e-9
    point, frame = surface.evaluate(1, 2, 0, 0)
    assert dist(list(map(float, point)), coarse[1][2]) < 1e-12
    assert len(frame) == 3


def test_a_strip_on_concentric_circles() -> None:
    guide = [[3 * cos(0.2 * k), 3 * sin(0.2 * k), 0] for k in range(8)]
    made = canal.strip(guide, [4, 0, 0], [1.0] * 8)
    assert max(abs(dist(list(map(float, point)), [0, 0, 0]) - 4) for point in made.border) < 1e-9
    assert not any(made.is_flipped)
    assert made.deviation < 1e-12
    assert len(canal.strip_circles(guide, made.border)) == 7


def test_combescure_of_grids() -> None:
    grid = torus().points
    column, row = canal.grid_lengths(grid)
    same, reversed_count = canal.combescure(grid, column, row)
    assert reversed_count == 0
    assert max(dist(a, b) for a, b in zip(flat(rows_of(grid)), flat(rows_of(same)))) < 1e-12


def test_parts_of_a_surface() -> None:
    surface = torus()
    normals = [[frame[2] for frame in row] for row in rows_of_frames(surface)]
    moved = canal.offset(surface.points, normals, 0.25)
    old, new = rows_of(surface.points), rows_of(moved)
    assert max(abs(dist(old[i][j], new[i][j]) - 0.25) for i in range(4) for j in range(5)) < 1e-12
    flat = canal.panels(surface.points, normals, 0.1)
    assert len(flat.outlines) == 12
    assert max(flat.heights) < 1e-10
    nodes, corners = canal.beams(surface.points, normals, 0.3)
    assert len(nodes) == len(corners) == 3 * 5 + 4 * 4
    assert json.loads(canal.parts_json(surface.points, normals, 0.1, 0.3))["version"] == 1


def rows_of_frames(surface: canal.CanalSurface) -> list[list[list[list[float]]]]:
    return [[[list(map(float, vector)) for vector in frame] for frame in row] for row in surface.frames]


def test_the_progress_function_cancels_and_its_exceptions_arrive() -> None:
    grid = torus().points
    assert canal.node_axes(grid, progress=lambda part: part < 0.2).is_cancelled

    def fail(part: float) -> bool:
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        canal.node_axes(grid, progress=fail)


def test_two_parallel_lines_on_a_cylinder() -> None:
    guide = [[float(k), 0.0, 0.0] for k in range(6)]
    curve = [[float(k), 2.0, 0.0] for k in range(-2, 9)]
    spheres, flags = canal.touching_spheres(guide, [[0, 1, 1]] * 6, curve)
    # A normal at 45 degrees to the joining direction: the radius is 2 / (2 cos 45 deg).
    assert all(abs(float(sphere[3]) - 2**0.5) < 1e-9 for sphere in spheres)
    assert flags == [0] * 6
    found = canal.fit(guide, curve, circle_count=5, column_count=8, has_normal=1, normal_y=-1, normal_z=-1)
    assert found.surface.shape == (5, 8)
    assert found.surface.wraps == (False, True)
    # Spheres pass through both ends of an edge 1.25 long and touch the line over its middle.
    radius = (4 - 0.625**2) / (2 * 2**0.5)
    assert all(abs(float(circle[6]) - radius) < 1e-9 for circle in found.circles)
    assert all(abs(float(sphere[3]) - (radius**2 + 0.625**2) ** 0.5) < 1e-9 for sphere in found.spheres)
    assert found.sphere_flags == [0] * len(found.spheres)
    # A curve that ends before the guide does: the spheres beyond pass through its end.
    short = canal.fit(guide, curve[:6], circle_count=5, column_count=8, has_normal=1, normal_y=-1, normal_z=-1)
    middles = [0.625 + 1.25 * k for k in range(4)]
    assert short.sphere_flags == [int(middle > 3) for middle in middles]


def test_lengths_of_a_c_canal_surface_that_are_not_attainable() -> None:
    guide = [[float(k), 0.0, 0.0] for k in range(4)]
    section = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.0, 2.0, 0.0]]
    asked = [2.0, 2.1, 2.2, 3.4]
    with pytest.raises(shapeop.GeometryError, match=r"lengths\[3\]"):
        canal.c_canal(guide, section, asked)
    found = canal.c_canal(guide, section, asked, project_lengths=True)
    limits = [[float(length) for length in pair] for pair in found.attainable]
    # Of the first section its own length; of the next at most the diameter of the first quad's circle.
    assert limits[0] == [2.0, 2.0]
    assert 0 < 5**0.5 - limits[1][1] < 1e-3
    assert near(found.lengths, [*asked[:3], limits[3][1]], 1e-9)
    assert near(found.deviations, [0, 0, 0, asked[3] - limits[3][1]], 1e-9)
    assert found.is_projected == [False, False, False, True]


def test_frames_and_closing() -> None:
    ring = [[cos(2 * pi * k / 5), sin(2 * pi * k / 5), 0] for k in range(5)]
    assert canal.holonomy(ring).closes
    frame = canal.frame_of_tangent([0, 1, 0], [0, 0, 1])
    assert dist(list(map(float, frame[2])), [0, 0, 1]) < 1e-15
    assert canal.parallel_on_sphere(ring) is not None
    assert abs(canal.invert_complex([2 + 0j], 0j, 4.0)[0] - 2) < 1e-15
    plane, is_plane = canal.invert_sphere([1, 0, 0, 1], [0, 0, 0], 2)
    assert is_plane
    assert abs(float(plane[0]) - 1) < 1e-12
    assert len(canal.translation(ring[:3], [[0, 0, 0], [0, 0, 1]])) == 3
    line, tangents = canal.curve_points([[0, 0, 0], [3, 0, 0]], 4)
    assert [round(float(point[0]), 12) for point in line] == [0, 1, 2, 3]
    assert float(tangents[0][0]) == 1


def near(found: Any, expected: Any, tolerance: float = 1e-12) -> bool:
    return dist(list(map(float, found)), list(map(float, expected))) <= tolerance


def mirrored(point: list[float], a: list[float], b: list[float]) -> list[float]:
    """The mirror image in the plane that bisects a and b."""
    across = [(y - x) / dist(a, b) for x, y in zip(a, b)]
    height = sum(d * (p - (x + y) / 2) for d, p, x, y in zip(across, point, a, b))
    return [p - 2 * height * d for p, d in zip(point, across)]


def test_lengths_of_polylines() -> None:
    grid = rows_of(torus().points)
    column = [[2 * x for x in row[0]] for row in grid]
    row = [[1 - 0.5 * x for x in point] for point in grid[0]]
    columns, rows = canal.polyline_lengths(grid, column, row)
    assert near(columns, [dist(a, b) for a, b in zip(column, column[1:])])
    assert near(rows, [-dist(a, b) for a, b in zip(row, row[1:])])
    image, reversed_count = canal.combescure(grid, columns, rows)
    assert dist([float(x) for x in image[3][0]], [float(x) for x in image[0][0]]) - dist(column[3], column[0]) < 1e-12
    assert reversed_count == 4 * 4
    closed = canal.CanalSurface.revolution(PROFILE, columns=6)
    ring = [list(map(float, point)) for point in closed.points[0]]
    side = [row[0] for row in rows_of(closed.points)]
    _, around = canal.polyline_lengths(closed.points, side, [*ring, ring[0]], closed.wraps)
    assert near(around, [2.7] * 6)
    with pytest.raises(shapeop.InvalidValueError, match="row"):
        canal.polyline_lengths(grid, column, [*row[:-1], [9, 9, 9]])


def test_columns_on_circles_of_a_surface_of_revolution() -> None:
    radii = [1.0, 1.5, 1.2]
    circles = [[0, 0, k, 0, 0, 1, radius] for k, radius in enumerate(radii)]
    # Meridians, both ways.
    meridian = [[radius, 0, k] for k, radius in enumerate(radii)]
    guide = [[0, radius, k] for k, radius in enumerate(radii)]
    for column in (canal.column_on_circles(circles, [1, 0, 0]), canal.column_on_circles(circles, [1, 0, 0], guide)):
        assert all(near(found, expected) for found, expected in zip(column, meridian))
    with pytest.raises(shapeop.ArgumentError, match="guide"):
        canal.column_on_circles(circles, [1, 0, 0], guide[:2])


def test_points_of_sections() -> None:
    circle = [1, 0, 0, 0, 0, 1, 2]

    def on(angle: float) -> list[float]:
        return [1 + 2 * cos(angle), 2 * sin(angle), 0]

    def check(points: Any, angles: list[float]) -> None:
        assert len(points) == len(angles)
        assert all(near(point, on(angle)) for point, angle in zip(points, angles))

    check(canal.section_points(circle, on(0), 4), [0, pi / 2, pi, 1.5 * pi])
    check(canal.section_points(circle, on(0), 3, "angles", from_angle=0.2, to_angle=-0.6), [0.2, -0.2, -0.6])
    check(canal.section_points(circle, on(0), 3, canal.Section.TO_CURVE, [1, 5, 7]), [0, pi / 4, pi / 2])
    plane = {"plane_y": 1.0, "up_y": 1.0, "up_z": 0.0}
    check(canal.section_points(circle, on(0), 3, "above", **plane), [pi / 6, pi / 2, 5 * pi / 6])
    with pytest.raises(shapeop.InvalidValueError, match="target"):
        canal.section_points(circle, on(0), 3, "to-curve")


def test_two_circles_are_closed_by_a_third() -> None:
    # A prism over a hexagon: the quads are on one sphere, and the last one is like the others.
    guide = [[cos(pi / 3 * k), sin(pi / 3 * k), 0] for k in range(6)]
    border = [[0.8 * x, 0.8 * y, 0.6] for x, y, _ in guide]
    circles = canal.strip_circles(guide, border)
    closing = canal.close_circles(circles[0], circles[4], border[0], guide[0], guide[5])
    assert closing.which_case == 1
    assert not closing.is_crossed
    assert near(closing.first, border[0], 1e-9)
    assert near(closing.last, border[5], 1e-9)
    last = canal.strip_circles([guide[5], guide[0]], [border[5], border[0]])[0]
    assert near(closing.circle[:3], last[:3], 1e-9)
    assert abs(float(closing.circle[6]) - float(last[6])) < 1e-9


def test_gaps_of_given_axes() -> None:
    # All axes lean by 0.4 along one family of edges: beams of that family reach 1 / cos(0.4) down, the others 1.
    grid = [[[float(i), float(j), 0.0] for j in range(4)] for i in range(3)]
    gaps, depths = canal.node_gaps(grid, [[[sin(0.4), 0, cos(0.4)]] * 4] * 3, 2.0)
    assert all(near(row, [1 / cos(0.4) - 1] * 4) for row in gaps)
    assert all(near(row, [2 / cos(0.4)] * 4) for row in depths)
    assert all(near(row, [0.0] * 4) for row in canal.node_gaps(grid, [[[0, 0, 1]] * 4] * 3)[0])


def test_faces_are_cut_at_fractions() -> None:
    surface = torus()
    fine = surface.refined_at([0.5], [0.25, 0.5])
    assert fine.shape == (7, 13)
    points = rows_of(fine.points)
    for i in (0, 2, 4, 6):
        radius, _, height = PROFILE[i // 2]
        for j, part in enumerate([0, 0.25, 0.5] * 4 + [0]):
            angle = pi / 8 * (j // 3 + part)
            assert near(points[i][j], [radius * cos(angle), radius * sin(angle), height], 1e-9)
    with pytest.raises(shapeop.InvalidValueError, match=r"one\[1\]"):
        surface.refined_at([0.5, 0.5], [])


def test_what_a_profile_along_a_rail_does_is_told() -> None:
    # The rail is on a circle. The profile leans by 0.1 from the plane across it, to either side in turns, and ends
    # beyond the center.
    rail = [[cos(0.2 * k), sin(0.2 * k), 0.0] for k in range(6)]
    profile = [[1.0, 0.0, 0.0], [1 - 0.5 * cos(0.1), -0.5 * sin(0.1), 0.5], [1 - 1.5 * cos(0.1), -1.5 * sin(0.1), 0.7]]
    point, expected = profile[2], 0
    for a, b in zip(rail, rail[1:]):
        image = mirrored(point, a, b)
        expected += sum((b[k] - a[k]) * (image[k] - point[k]) for k in range(3)) < 0
        point = image
    assert expected == 2
    for sweep in (canal.moulding, canal.monge):
        found = sweep(rail, profile)
        assert found.surface.shape == (6, 3)
        assert abs(found.obliquity - 0.1) < 1e-9
        assert found.reversed_count == expected
        assert found.closing_gap == 0
    # A closed rail in space: the profile comes back mirrored in the bisecting planes of all edges.
    ring = [[cos(pi / 3 * k), sin(pi / 3 * k), 0.2 * (k % 3)] for k in range(6)]
    end = [1.3, 0.0, 0.2]
    found = canal.monge([*ring, ring[0]], [ring[0], [1.2, 0.0, 0.05], end])
    back = end
    for a, b in zip(ring, [*ring[1:], ring[0]]):
        back = mirrored(back, a, b)
    assert found.closing_gap > 0.01
    assert abs(found.closing_gap - dist(back, end)) < 1e-12
    assert found.surface.wraps == (False, False)


def test_what_a_moulding_surface_of_given_corners_misses_is_told() -> None:
    curve = [[-2, 0, 0], [-3, 0.5, 0], [-2.5, 1.2, 0], [-1, 1, 0]]

    def arch(count: int) -> list[list[float]]:
        parts = [k / count for k in range(count + 1)]
        return [[4 * part - 2, 0.0, 2 * sin(pi * part)] for part in parts]

    # The corners are those of an isosceles trapezoid: no inversion. Of an odd number of symmetric edges the middle one
    # has the trapezoid's mirror; the mirrors of the others cancel.
    found = canal.m_moulding(curve, arch(13), [1, 1, 0])
    assert found.surface.family == "moulding"
    assert found.corner_gap < 1e-12
    assert near(found.surface.points[3][13], [1, 1, 0])
    assert found.closing_gap == 0
    rows = rows_of(found.surface.base_points)
    edges = [[[b[k] - a[k] for k in range(3)] for a, b in zip(row, row[1:])] for row in rows]
    turned = [sum(x * y for x, y in zip(edge, own)) < 0 for row in edges for edge, own in zip(row, edges[0])]
    assert found.reversed_count == sum(turned) > 0
    # Of an even number it misses the corner.
    found = canal.m_moulding(curve, arch(4), [1, 1, 0])
    assert found.corner_gap > 1e-3
    assert abs(found.corner_gap - dist(rows_of(found.surface.points)[3][4], [1, 1, 0])) < 1e-12
    same = canal.CanalSurface.m_moulding(curve, arch(4), [1, 1, 0])
    assert rows_of(same.points) == rows_of(found.surface.points)


def test_kinks() -> None:
    # Unit squares in the plane: along the crease tangents lean by the angle, and back at the next column.
    grid = [[[float(i), float(j), 0.0] for j in range(3)] for i in range(3)]
    tangents = [[1, 0, 0], [0, 1, 0]]
    surface = canal.CanalSurface(grid, tangents, kinks=canal.Kinks(2, [1], [0.3]))
    for row in rows_of_frames(surface):
        for frame, lean in zip(row, (0, 0.3, -0.3)):
            assert near(frame[1], [0, cos(lean), sin(lean)])
    again = canal.CanalSurface.from_json(surface.to_json()).kinks
    assert again is not None
    assert (again.direction, again.lines, list(again.angles)) == (2, [1], [0.3])
    fine = surface.refined(1, 4).kinks
    assert fine is not None
    assert fine.lines == [4]
    assert torus().kinks is None
    with pytest.raises(shapeop.Error, match=r"lines\[0\]"):
        canal.CanalSurface(grid, tangents, kinks=canal.Kinks(2, [3], [0.3]))
    with pytest.raises(shapeop.ArgumentError, match="angles"):
        canal.CanalSurface(grid, tangents, kinks=canal.Kinks(2, [1], []))


def test_frames_go_round_a_circle() -> None:
    frame = canal.frame_across([[0, 1, 0], [0, 0, 1]], [cos(0.7) - 1, sin(0.7), 0])
    assert near(frame[0], [-sin(0.7), cos(0.7), 0])
    assert near(frame[1], [0, 0, 1])
    assert near(frame[2], [cos(0.7), sin(0.7), 0])


def test_a_sphere_under_pressure_is_in_equilibrium() -> None:
    profile = [[2 * cos(0.2 * k), 0, 2 * sin(0.2 * k)] for k in range(4)]
    sphere = canal.CanalSurface.revolution(profile, angle=1, columns=4)
    normal = rows_of_frames(sphere)[0][0][2]
    pressure = 3.0 if normal[0] > 0 else -3.0
    # Half the pressure times the radius; twice that leaves as much as the pressure itself.
    assert sphere.membrane_residual_of(pressure, [3.0] * 9, [3.0] * 9) < 1e-9
    assert abs(sphere.membrane_residual_of(pressure, [6.0] * 9, [6.0] * 9) - 1) < 1e-9
    with pytest.raises(shapeop.ArgumentError, match="forces_two"):
        sphere.membrane_residual_of(1, [1.0] * 9, [1.0] * 8)


def test_a_large_mesh_follows_a_handle_parallel_to_itself() -> None:
    # Only the column of the handle moves: the least of (d - 3.2)^2 + 33e-6 d^2.
    points = [[float(k % 33), float(k // 33), 0.0] for k in range(33 * 33)]
    quads = [[k, k + 1, k + 34, k + 33] for k in range(33 * 32) if k % 33 != 32]
    found = canal.nearest_parallel(points, quads, [33 * 33 - 1], [[32 + 3.2, 32, 0]])
    for point, new in zip(points, found):
        moved = 3.2 / (1 + 33e-6) if point[0] == 32 else 0
        assert near(new, [point[0] + moved, point[1], 0], 1e-6)


def test_mistakes_are_told() -> None:
    with pytest.raises(shapeop.GeometryError, match="profile") as refused:
        canal.CanalSurface.revolution([[2, 0, 0], [2, 1, 1]])
    assert refused.value.code == shapeop.ErrorCode.NOT_PLANAR
    with pytest.raises(shapeop.InvalidValueError, match="ratio"):
        torus().invert([0, 0, 3], 0)
    with pytest.raises(shapeop.ArgumentError):
        canal.strip([[0, 0, 0], [1, 0, 0]], [0, 1, 0], [1.0])
    surface = torus()
    surface.close()
    with pytest.raises(shapeop.ClosedError):
        surface.undo()
    assert canal.family_names()[0] == "canal"
    steps = [canal.Step.COMBESCURE, canal.Step.MOEBIUS]
    assert canal.family_steps("MC-canal") == (canal.Kind.CANAL, steps)


def test_the_example_runs(repository: Path, tmp_path: Path) -> None:
    script = repository / "bindings" / "python" / "examples" / "super_canal.py"
    parts = tmp_path / "parts.json"
    done = subprocess.run([sys.executable, str(script), str(parts)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "264 panels" in done.stdout
    assert len(json.loads(parts.read_text(encoding="utf-8"))["panels"]) == 264
