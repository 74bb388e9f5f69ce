"""Drag the corners of a mesh while its faces are kept planar; colours show how planar they are.

Usage: interactive.py [MESH.obj] [--recipe NAME] [--handles I,J,...]; needs the extra: pip install shapeop[polyscope].
With --picture FILE.png no window opens: the first handle is dragged along, and the last frame is written to the file.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import polyscope as ps
from numpy.typing import NDArray
from polyscope import imgui

import shapeop

Array = NDArray[np.float64]

HANDLE_WEIGHT = 1e3
"""Against 1 for the goal: a handle stays within about a thousandth of where it is dragged to."""

FRAME_SECONDS = 0.012
"""What the solver may take of a frame: with the drawing about a sixtieth of a second."""

LIMIT = 0.01
"""The planarity at the end of the colour map: 1 %, above which panes do not fit their frames."""


class Session:
    """A mesh, its solver and its handles."""

    def __init__(self, points: Array, faces: list[list[int]], recipe: str, handles: list[int]) -> None:
        self.faces, self.handles = faces, handles
        # Fairness spreads the moves of the handles; only a little draws points to where they were.
        problem = shapeop.recipe(recipe, points, faces, closeness=1e-4, fairness=1e-3)
        self.solver = problem.solver()
        self.held = self.solver.add("Closeness", [[i] for i in handles], weight=HANDLE_WEIGHT)
        self.solver.init()
        self.points = self.solver.points
        self.targets = self.points[handles]
        self.report = self.solver.solve_until(0)
        self.planarity = self.measured()

    def measured(self) -> Array:
        """The planarity of each face."""
        return shapeop.measure_faces("planarity", self.points, self.faces)

    def step(self, targets: Array) -> None:
        """Goes on from where the points are, for at most a frame, with the handles dragged to `targets`."""
        if not np.array_equal(targets, self.targets):
            self.solver.edit("Closeness", self.held, targets)
            self.targets = targets.copy()
        self.report = self.solver.solve_until(time_budget_seconds=FRAME_SECONDS)
        self.solver.get_points(out=self.points)
        self.planarity = self.measured()


class Window:
    """What Polyscope shows of a session."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.first_points = session.points.copy()
        self.is_paused = False
        self.mesh = ps.register_surface_mesh(
            "mesh", session.points, session.faces, edge_width=1.0, back_face_policy="identical"
        )
        self.gizmos = [ps.add_transformation_gizmo(f"handle {i}") for i in session.handles]
        for gizmo in self.gizmos:
            gizmo.set_allow_rotation(False)
            gizmo.set_allow_scaling(False)
            gizmo.set_gizmo_scale(0.4)
        self.reset()

    def reset(self) -> None:
        """Everything to where it was at the beginning."""
        self.session.solver.points = self.first_points
        for gizmo, point in zip(self.gizmos, self.first_points[self.session.handles]):
            gizmo.set_position(point)
        self.session.step(self.dragged())
        self.show()

    def dragged(self) -> Array:
        """Where the handles are."""
        return np.array([gizmo.get_transform()[:3, 3] for gizmo in self.gizmos], dtype=np.float64)

    def show(self) -> None:
        """The points and the colours of the session."""
        self.mesh.update_vertex_positions(self.session.points)
        self.mesh.add_scalar_quantity(
            "planarity",
            self.session.planarity,
            defined_on="faces",
            vminmax=(0, LIMIT),
            cmap="reds",
            enabled=True,
        )

    def frame(self) -> None:
        """Called by Polyscope for every frame."""
        _, self.is_paused = imgui.Checkbox("Pause", self.is_paused)
        imgui.SameLine()
        if imgui.Button("Reset"):
            self.reset()
        if not self.is_paused:
            self.session.step(self.dragged())
            self.show()
        report, planarity = self.session.report, self.session.planarity
        imgui.Text(f"{report.outcome.name.lower().replace('_', ' ')}, {report.iterations} iterations in this frame")
        imgui.Text(f"energy {report.energy_after:.3g}")
        worst = int(planarity.argmax())
        imgui.Text(f"worst face: {worst}, {planarity[worst]:.2%}; colours from 0 to {LIMIT:.0%}")


def read_obj(path: Path) -> tuple[Array, list[list[int]]]:
    """The points and faces of an OBJ file."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    points = np.array([[float(word) for word in words[1:4]] for words in lines if words[:1] == ["v"]])
    faces = [[int(word.split("/")[0]) - 1 for word in words[1:]] for words in lines if words[:1] == ["f"]]
    return points, faces


def extremes(points: Array) -> list[int]:
    """The points that are farthest out in the four diagonal directions of the xy plane."""
    directions = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    return sorted({int(np.argmax(points[:, :2] @ direction)) for direction in directions})


def draw(session: Session, window: Window, picture: Path, frames: int) -> None:
    """Drags the first handle up by a fifth of the mesh's size, and writes the last frame."""
    size = np.linalg.norm(np.ptp(window.first_points, axis=0))
    begin = window.first_points[session.handles[0]]
    for i in range(1, frames + 1):
        window.gizmos[0].set_position(begin + [0, 0, 0.2 * size * min(2 * i / frames, 1)])
        ps.frame_tick()
    ps.screenshot(str(picture), transparent_bg=False, include_UI=True)


def main(arguments: Any = None) -> Session:
    """Opens the window, or writes the picture; returns the session as it was left."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    default = Path(__file__).resolve().parents[3] / "examples" / "meshes" / "hypar.obj"
    parser.add_argument("mesh", nargs="?", type=Path, default=default, help="an OBJ file")
    parser.add_argument("--recipe", choices=shapeop.recipe_names(), default=shapeop.recipe_names()[0])
    parser.add_argument("--handles", help="point indices, separated by commas; default: the farthest corners")
    parser.add_argument("--picture", type=Path, help="write a picture instead of opening a window")
    parser.add_argument("--frames", type=int, default=60, help="frames before the picture")
    options = parser.parse_args(arguments)
    points, faces = read_obj(options.mesh)
    handles = [int(word) for word in options.handles.split(",")] if options.handles else extremes(points)
    session = Session(points, faces, options.recipe, handles)
    if options.picture:
        ps.set_allow_headless_backends(True)
        ps.set_use_prefs_file(False)
    ps.set_program_name("shapeop")
    ps.set_up_dir("z_up")
    ps.set_ground_plane_mode("none")
    ps.init("openGL3_egl" if options.picture else "auto")
    window = Window(session)
    ps.set_user_callback(window.frame)
    if options.picture:
        draw(session, window, options.picture, options.frames)
    else:
        ps.show()
    return session


if __name__ == "__main__":
    main()
