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
