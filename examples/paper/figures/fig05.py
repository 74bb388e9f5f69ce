"""Figure 5: a shell whose grid lines are circular arcs and whose faces are nearly square, shaped by five anchors."""

import numpy as np

import measure
import meshes
from claims import Measure
from draw import NEAR_TO_FAR, Camera, Panel, colors_of, page

NUMBER = 5
TITLE = "A shell whose grid lines are circles"
CLAIM = (
    "The vertices of every grid line come to lie on a circle while five anchors are moved and faces stay nearly square."
)
NOTES = """\
All 30 grid lines, those of the boundary too, are constrained to circles (weight 3), the faces to squares of any size
(weight 0.1): the squares keep the lines from bunching. Distances are to the best circle in the least-squares sense,
fitted here anew.
"""

COUNT = 14  # faces along a side, of 1 x 1
ANCHORS = {
    (0, 0): (-5.5, -5.5, 0),
    (COUNT, 0): (6, -5, 0),
    (COUNT, COUNT): (5.5, 6, 1),
    (0, COUNT): (-5.5, 5.5, 2),
    (COUNT // 2, COUNT // 2): (0.5, 0.5, 6),
}
SQUARE = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
LIMIT = 0.01  # distance at the red end of the colours


def build():
    half = COUNT / 2
    grid = meshes.grid(COUNT, COUNT, lambda i, j: (i - half, j - half, 0))
    anchors = [[(COUNT + 1) * j + i] for i, j in ANCHORS]
    model = {
        "name": "shell",
        "mesh": "meshes/fig05.obj",
        "constraints": [
            {"name": "circles", "type": "Circle", "indices": meshes.grid_lines(COUNT, COUNT), "weights": [3]},
            {"name": "squares", "type": "Similarity", "indices": "faceVertices", "weights": [0.1], "scalars": [SQUARE]},
            {
                "name": "anchors",
                "type": "Closeness",
                "indices": anchors,
                "weights": [100],
                "scalars": [list(at) for at in ANCHORS.values()],
            },
        ],
        "settings": {"mode": "static", "iterations": 10},
        "stages": [{"name": "10 iterations", "solves": 1}, {"name": "300 iterations", "solves": 29}],
    }
    return {"figure": NUMBER, "title": TITLE, "models": [model]}, {"meshes/fig05.obj": grid}


def measures(solved):
    shell = solved["shell"]
    early, late = shell["10 iterations"], shell["300 iterations"]
    targets = np.array(shell.model["constraints"][2]["scalars"])
    anchors = [tree[0] for tree in shell.trees["anchors"]]
    angles = np.abs(measure.all_angles(late, shell.faces) - 90)
    return [
        Measure(
            "largest distance of a vertex to its line's circle, 10 iterations",
            line_distances(shell, early).max(),
            "edges",
        ),
        Measure(
            "largest distance of a vertex to its line's circle, 300 iterations",
            line_distances(shell, late).max(),
            "edges",
            most=0.02,
        ),
        Measure(
            "that against 10 iterations",
            line_distances(shell, early).max() / line_distances(shell, late).max(),
            "times less",
            least=20,
        ),
        Measure("mean angle of faces off 90 degrees, 300 iterations", angles.mean(), "degrees", most=10),
        Measure(
            "largest distance of an anchor to its place, 300 iterations",
            np.linalg.norm(late[anchors] - targets, axis=1).max(),
            "edges",
            most=0.001,
        ),
    ]


def line_distances(shell, points):
    """The largest distance of each grid line's vertices to their best circle. The edges of the input are 1 long."""
    return np.array([measure.circle_distances(points[line]).max() for line in shell.trees["circles"]])


def arc(corners):
    """The arc of the best circle from the first to the last of the points, carried on a little at both ends."""
    centre, radius, u, v = measure.best_circle(corners)
    angles = np.unwrap([np.arctan2((p - centre) @ v, (p - centre) @ u) for p in corners])
    more = 0.06 * (angles[-1] - angles[0])
    steps = np.linspace(angles[0] - more, angles[-1] + more, 80)
    return centre + radius * (np.outer(np.cos(steps), u) + np.outer(np.sin(steps), v))


def picture(solved, path):
    shell = solved["shell"]
    anchors = [tree[0] for tree in shell.trees["anchors"]]
    moves = list(zip(shell.points[anchors], shell.model["constraints"][2]["scalars"], strict=True))
    panels = [
        Panel(
            shell.points,
            shell.faces,
            "input, and where the anchors go",
            arrows=moves,
            marks=shell.points[anchors],
            floor=0,
        )
    ]
    for stage in ("10 iterations", "300 iterations"):
        points = shell[stage]
        title = "%s\nvertices up to %.3f edges off a circle" % (stage, line_distances(shell, points).max())
        panels.append(Panel(points, shell.faces, title, marks=points[anchors], floor=0))
    colors = colors_of(line_distances(shell, points), NEAR_TO_FAR, 0, LIMIT)
    lines = [(arc(points[line]), color, 1.1) for line, color in zip(shell.trees["circles"], colors, strict=True)]
    panels.append(
        Panel(points, shell.faces, "circles of the grid lines\n300 iterations", has_faces=False, lines=lines, floor=0)
    )
    legend = (NEAR_TO_FAR, 0, LIMIT, "largest distance of a grid line's vertices to its circle, in edges of the input")
    page(path, [panels[:2], panels[2:]], Camera(-66, 30), [legend], width=9.0)
