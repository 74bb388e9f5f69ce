"""Figure 11: the shell of figure 10 with fabrication constraints: angles in a range, planar faces, both."""

import numpy as np

import measure
import patterns
from claims import Measure
from draw import GOOD_TO_BAD, Camera, Panel, colors_of, page
from figures import fig10

NUMBER = 11
TITLE = "Funicular form finding under fabrication constraints"
CLAIM = (
    "Edges of 2.0, interior angles in a range, planar faces: each row meets what it asks for, the last one all three."
)
NOTES = """\
The mesh, gravity and weights of figure 10. The paper does not say its range of angles; the flat hexagon has 60 and
120 degrees, so these are the ends here (the constraint asks for 61 to 119). Planar faces with equal edges are rhombi,
and a mesh of rhombi is three surfaces of translation: rows 3 and 4 show it. All rows are at rest.
"""

LEAST_ANGLE, MOST_ANGLE = 60, 120
#: The constraint asks for a little more, as iterations only approach the end of a range.
MARGIN = 1
#: Against the weight 1000 of the edges.
ANGLE_WEIGHT, PLANE_WEIGHT = 3000, 3000
STAGE = "100000 iterations"
ROWS = {
    "edges": (),
    "edges, angles": ("angles",),
    "edges, planes": ("planes",),
    "edges, angles, planes": ("angles", "planes"),
}
LENGTH_LIMIT, ANGLE_LIMIT, PLANARITY_LIMIT = 5, 20, 2  # the red ends of the colours


def build():
    angle_range = np.radians([LEAST_ANGLE + MARGIN, MOST_ANGLE - MARGIN]).tolist()
    more = {
        "angles": {
            "name": "angles",
            "type": "Angle",
            "indices": "faceAngleVertices",
            "weights": [ANGLE_WEIGHT],
            "scalars": [angle_range],
        },
        "planes": {"name": "planes", "type": "Plane", "indices": "faceVertices", "weights": [PLANE_WEIGHT]},
    }
    models = [
        fig10.model(name, fig10.WEIGHT, 1000, {STAGE: 100}, [more[kind] for kind in kinds])
        for name, kinds in ROWS.items()
    ]
    return {"figure": NUMBER, "title": TITLE, "models": models}, {}


def angle_errors(shell, points):
    """For each corner of each face: the degrees by which its angle misses the range."""
    angles = measure.all_angles(points, shell.faces)
    return np.maximum(0, np.maximum(LEAST_ANGLE - angles, angles - MOST_ANGLE))


def measures(solved):
    found = []
    for name, kinds in ROWS.items():
        shell, points = solved[name], solved[name][STAGE]
        lengths = np.abs(fig10.length_errors(shell, points))
        angles, planarity = angle_errors(shell, points), measure.planarity(points, shell.faces)
        last = shell.frames[STAGE][-2]
        found += [
            Measure(name + ": largest deviation of an edge from 2.0", lengths.max(), "%", most=3),
            Measure(name + ": mean deviation", lengths.mean(), "%", most=1),
            Measure(
                name + ": angles outside %d to %d degrees" % (LEAST_ANGLE, MOST_ANGLE),
                (angles > 0).sum(),
                "of %d" % angles.size,
                most=0 if "angles" in kinds else None,
            ),
            Measure(name + ": worst miss of the range", angles.max(), "degrees"),
            Measure(name + ": worst planarity", planarity.max(), "%", most=0.5 if "planes" in kinds else None),
            Measure(name + ": mean planarity", planarity.mean(), "%"),
            Measure(
                name + ": move in the last 1000 iterations",
                100 * np.linalg.norm(points - last, axis=1).max() / points[:, 2].max(),
                "% of the height",
                most=1,
            ),
        ]
    return found


def picture(solved, path):
    rows = []
    for name in ROWS:
        shell, points = solved[name], solved[name][STAGE]
        faces, edges = shell.faces, patterns.edges(shell.faces)
        corners = [tree[0] for tree in shell.trees["corners"]]
        lengths = np.abs(fig10.length_errors(shell, points))
        angles, planarity = angle_errors(shell, points), measure.planarity(points, faces)
        rows.append(
            [
                Panel(points, faces, "height %.2f" % points[:, 2].max(), marks=points[corners], floor=0),
                Panel(
                    points,
                    faces,
                    "edges up to %.1f %% off" % lengths.max(),
                    floor=0,
                    edges=edges,
                    edge_colors=colors_of(lengths, GOOD_TO_BAD, 0, LENGTH_LIMIT),
                    line_width=1.4,
                ),
                Panel(
                    points,
                    faces,
                    "%d angles of %d outside" % ((angles > 0).sum(), angles.size),
                    floor=0,
                    face_colors=colors_of(angles.max(axis=1), GOOD_TO_BAD, 0, ANGLE_LIMIT),
                ),
                Panel(
                    points,
                    faces,
                    "planarity up to %.2f %%" % planarity.max(),
                    floor=0,
                    face_colors=colors_of(planarity, GOOD_TO_BAD, 0, PLANARITY_LIMIT),
                ),
            ]
        )
    legends = [
        (GOOD_TO_BAD, 0, LENGTH_LIMIT, "edge length off 2.0, in %"),
        (GOOD_TO_BAD, 0, ANGLE_LIMIT, "worst angle outside %d to %d, in degrees" % (LEAST_ANGLE, MOST_ANGLE)),
        (GOOD_TO_BAD, 0, PLANARITY_LIMIT, "planarity in % (all clipped)"),
    ]
    page(path, rows, Camera(-75, 24), legends, width=12.0, row_labels=list(ROWS))
