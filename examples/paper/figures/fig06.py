"""Figure 6: an existing mesh whose quads become planar, while a small weight holds every vertex near its place."""

import numpy as np

import measure
import patterns
from claims import Measure
from draw import GOOD_TO_BAD, Camera, Panel, colors_of, page

NUMBER = 6
TITLE = "Rationalizing an existing geometry"
CLAIM = "Faces become planar: much after 10 iterations, all of them to the eye after 200, and the shape is kept."
NOTES = """\
The mesh is the tube of `examples/meshes`. A weight of 0.001 holds each vertex near its place, against 1 for each
plane: enough for the shape to stay, too little to bend a face.
"""

TOLERANCE = 1.0  # percent of planarity: the red end of the colours, and what all faces must reach


def build():
    model = {
        "name": "tube",
        "mesh": "../meshes/tubemesh.obj",
        "constraints": [
            {"name": "planes", "type": "Plane", "indices": "faceVertices", "weights": [1]},
            {"name": "places", "type": "Closeness", "indices": "verticesEach", "weights": [0.001]},
        ],
        "settings": {"mode": "static", "iterations": 10},
        "stages": [{"name": "10 iterations", "solves": 1}, {"name": "200 iterations", "solves": 19}],
    }
    return {"figure": NUMBER, "title": TITLE, "models": [model]}, {}


def measures(solved):
    tube = solved["tube"]
    edge = measure.edge_lengths(tube.points, patterns.edges(tube.faces)).mean()
    late = tube["200 iterations"]
    moves = np.linalg.norm(late - tube.points, axis=1) / edge
    found = []
    for name, points, most in (
        ("input", tube.points, None),
        ("10 iterations", tube["10 iterations"], None),
        ("200 iterations", late, TOLERANCE),
    ):
        planarity = measure.planarity(points, tube.faces)
        found.append(Measure("worst planarity, " + name, planarity.max(), "%", most=most))
        found.append(Measure("mean planarity, " + name, planarity.mean(), "%"))
    return found + [
        Measure(
            "largest distance of a vertex to its face's best plane, 200 iterations",
            measure.plane_distances(late, tube.faces).max() / edge,
            "mean edges",
            most=0.005,
        ),
        Measure("largest move of a vertex, 200 iterations", moves.max(), "mean edges", most=0.5),
        Measure("mean move of a vertex, 200 iterations", moves.mean(), "mean edges"),
    ]


def picture(solved, path):
    tube = solved["tube"]
    rows = [[], []]
    for title, points in (
        ("input", tube.points),
        ("10 iterations", tube["10 iterations"]),
        ("200 iterations", tube["200 iterations"]),
    ):
        planarity = measure.planarity(points, tube.faces)
        colors = colors_of(planarity, GOOD_TO_BAD, 0, TOLERANCE)
        rows[0].append(Panel(points, tube.faces, title, floor=0))
        title = "worst %.2f %%, mean %.2f %%, above %g %%: %d of %d" % (
            planarity.max(),
            planarity.mean(),
            TOLERANCE,
            (planarity > TOLERANCE).sum(),
            len(planarity),
        )
        rows[1].append(Panel(points, tube.faces, title, face_colors=colors, floor=0))
    legend = (GOOD_TO_BAD, 0, TOLERANCE, "planarity in %: distance of the diagonals over their mean length (clipped)")
    page(path, rows, Camera(-120, 38), [legend], width=10.0)
