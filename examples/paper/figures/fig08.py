"""Figure 8: a flat mesh of regular triangles and squares that becomes a shell of regular triangles and squares."""

import math

import numpy as np

import measure
import meshes
from claims import Measure
from draw import GOOD_TO_BAD, Camera, Panel, colors_of, page

NUMBER = 8
TITLE = "A shell of regular triangles and squares"
CLAIM = "While four anchors bend the mesh, every triangle becomes equilateral and every square a square again."
NOTES = """\
The snub square tiling: 50 squares and 97 triangles. Similar shapes may be of any size, but all faces share edges, so
they are of one size in the end, a little smaller than in the input. If the anchors only came closer, the mesh would
shrink flat; as two of them go up, it has to bend.
"""

COUNT = 5
#: Where the four corners go: closer together, and two of them up; in shares of the mesh's width.
CLOSER, HIGHER = 0.8, 0.3
TRIANGLE = [0, 0, 0, 1, 0, 0, 0.5, math.sqrt(3) / 2, 0]
SQUARE = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
STAGES = {"1 iteration": 1, "100 iterations": 99, "500 iterations": 400}
LIMIT = 5  # degrees at the red end of the colours


def build():
    points, faces = meshes.snub_square(COUNT)
    directions = np.array([[-1, -1.001, 0], [1, -1, 0], [1, 1.001, 0], [-1, 1, 0]])
    anchors = [int(np.argmax(points @ direction)) for direction in directions]
    places = points[anchors] * CLOSER
    places[[1, 3], 2] = HIGHER * np.ptp(points[:, 0])
    shapes = {3: ("triangles", TRIANGLE), 4: ("squares", SQUARE)}
    model = {
        "name": "shell",
        "mesh": "meshes/fig08.obj",
        "constraints": [
            {
                "name": name,
                "type": "Similarity",
                "indices": [f for f in faces if len(f) == sides],
                "weights": [1],
                "scalars": [shape],
            }
            for sides, (name, shape) in shapes.items()
        ]
        + [
            {
                "name": "anchors",
                "type": "Closeness",
                "indices": [[a] for a in anchors],
                "weights": [1000],
                "scalars": places.tolist(),
            }
        ],
        "settings": {"mode": "static", "iterations": 1},
        "stages": [{"name": name, "solves": solves} for name, solves in STAGES.items()],
    }
    return {"figure": NUMBER, "title": TITLE, "models": [model]}, {"meshes/fig08.obj": (points, faces)}


def angle_errors(shell, points):
    """For each face: its worst angle's distance to 60 degrees in triangles, to 90 in squares."""
    return np.array(
        [np.abs(measure.face_angles(points, face) - (60 if len(face) == 3 else 90)).max() for face in shell.faces]
    )


def side_errors(shell, points):
    """For each face: its longest over its shortest side, minus 1, in percent."""
    ratios = []
    for face in shell.faces:
        sides = np.linalg.norm(points[np.roll(face, -1)] - points[face], axis=1)
        ratios.append(sides.max() / sides.min() - 1)
    return 100 * np.array(ratios)


def measures(solved):
    shell = solved["shell"]
    squares = [face for face in shell.faces if len(face) == 4]
    found = []
    for name in STAGES:
        is_last = name == "500 iterations"
        points = shell[name]
        found += [
            Measure(
                "worst angle off 60 or 90 degrees, " + name,
                angle_errors(shell, points).max(),
                "degrees",
                most=1 if is_last else None,
            ),
            Measure(
                "worst longest over shortest side of a face, minus 1, " + name,
                side_errors(shell, points).max(),
                "%",
                most=2 if is_last else None,
            ),
            Measure(
                "worst planarity of a square, " + name,
                measure.planarity(points, squares).max(),
                "%",
                most=0.5 if is_last else None,
            ),
        ]
    height = np.ptp(points[:, 2]) / np.ptp(shell.points[:, 0])
    return found + [Measure("height over the width of the input, 500 iterations", height, least=0.25)]


def picture(solved, path):
    shell = solved["shell"]
    anchors = [tree[0] for tree in shell.trees["anchors"]]
    moves = list(zip(shell.points[anchors], shell.model["constraints"][2]["scalars"], strict=True))
    panels = []
    for title, points in [("input, and where the anchors go", shell.points)] + [(name, shell[name]) for name in STAGES]:
        is_input = points is shell.points
        errors = angle_errors(shell, points)
        if not is_input:
            title += "\nangles up to %.1f° off, sides up to %.1f %%" % (errors.max(), side_errors(shell, points).max())
        panels.append(
            Panel(
                points,
                shell.faces,
                title,
                face_colors=colors_of(errors, GOOD_TO_BAD, 0, LIMIT),
                marks=points[anchors],
                arrows=moves if is_input else [],
                floor=-0.4,
            )
        )
    legend = (GOOD_TO_BAD, 0, LIMIT, "worst angle of a face, in degrees off 60 (triangles) or 90 (squares); clipped")
    page(path, [panels[:2], panels[2:]], Camera(-118, 30), [legend], width=9.0)
