"""Figure 4: a hanging cloth, torn far apart and let go."""

import numpy as np

import measure
import meshes
import patterns
from claims import Measure
from draw import STRAIN, SURFACE, Camera, Panel, colors_of, page

NUMBER = 4
TITLE = "Hanging cloth"
CLAIM = "Stable and fast: 100 steps after its anchors jumped far apart and back, the cloth hangs as if never torn."
NOTES = """\
A square cloth of 800 triangles hangs from three of its corners. In the first time step the anchors jump to four times
their distance from the middle, before the second they are back. The reference is the same cloth, never torn, after
1000 steps. A stiff cloth makes 10 iterations in each of its 100 steps, 1000 in all: that is the picture. A soft cloth,
whose edges weigh a thirtieth, needs one in each, the 100 iterations of the paper, but stretches far at its anchors.
How many iterations it takes is a matter of stiffness against mass and gravity, which the paper does not state.
"""

COUNT, SIZE = 20, 10.0
APART = 4.0  # times farther from the middle
LIMIT = 6  # strain in percent at the ends of the colours


#: Weight of the edges, and iterations in each time step.
CLOTHS = {"stiff": (3000, 10), "soft": (100, 1)}


def build():
    cloth = meshes.cloth(COUNT, SIZE)
    anchors = [0, COUNT, (COUNT + 1) * (COUNT + 1) - 1]
    home = cloth[0][anchors]
    torn = [
        {"name": "torn", "solves": 1, "edits": [{"constraints": "anchors", "scalars": (APART * home).tolist()}]},
        {"name": "let go", "solves": 100, "edits": [{"constraints": "anchors", "scalars": home.tolist()}]},
    ]
    models = []
    for name, (weight, iterations) in CLOTHS.items():
        models.append(model(name, anchors, home, weight, iterations, torn))
        models.append(
            model(name + ", never torn", anchors, home, weight, iterations, [{"name": "at rest", "solves": 1000}])
        )
    return {"figure": NUMBER, "title": TITLE, "models": models}, {"meshes/fig04.obj": cloth}


def model(name, anchors, home, weight, iterations, stages):
    return {
        "name": name,
        "mesh": "meshes/fig04.obj",
        "constraints": [
            {"name": "edges", "type": "EdgeStrain", "indices": "edgeVertices", "weights": [weight]},
            {"name": "bending", "type": "Bending", "indices": "edgeFaceVertices", "weights": [0.5]},
            {
                "name": "anchors",
                "type": "Closeness",
                "indices": [[a] for a in anchors],
                "weights": [100000],
                "scalars": home.tolist(),
            },
        ],
        "settings": {
            "mode": "live",
            "iterations": iterations,
            "mass": 1,
            "damping": 0.9,
            "time_step": 0.5,
            "gravity": [0, 0, -1],
            "dynamic": True,
        },
        "stages": stages,
    }


def measures(solved):
    found = []
    for name, (_, iterations) in CLOTHS.items():
        cloth, untorn = solved[name], solved[name + ", never torn"]
        edges = patterns.edges(cloth.faces)
        rest, before = untorn["at rest"], untorn.frames["at rest"][-2]
        torn, back = (100 * measure.strains(cloth[stage], cloth.points, edges) for stage in ("torn", "let go"))
        of = "% of the diagonal"
        to_rest = name + ": largest distance to the cloth never torn, %d iterations after"
        found += [
            Measure(name + ": largest strain of an edge, torn", torn.max(), "%", least=500),
            Measure(name + ": largest strain of an edge, 100 steps after", np.abs(back).max(), "%"),
            Measure(name + ": mean strain of an edge, 100 steps after", np.abs(back).mean(), "%"),
            Measure(to_rest % (10 * iterations), _distance(cloth.frames["let go"][9], rest), of),
            Measure(to_rest % (100 * iterations), _distance(cloth["let go"], rest), of, most=0.5),
            Measure(name + ": last move of the cloth never torn", _distance(rest, before), of, most=1e-6),
        ]
    return found


def _distance(points, others):
    """The largest distance of a point to its other, in percent of the cloth's diagonal."""
    return 100 * np.linalg.norm(points - others, axis=1).max() / (SIZE * np.sqrt(2))


def picture(solved, path):
    cloth = solved["stiff"]
    edges = patterns.edges(cloth.faces)
    anchors = [tree[0] for tree in cloth.trees["anchors"]]
    rows = [[], []]
    for title, points in (
        ("input", cloth.points),
        ("first step, the anchors 4 times as far apart", cloth["torn"]),
        ("100 steps (1000 iterations) after they are back", cloth["let go"]),
    ):
        strains = 100 * measure.strains(points, cloth.points, edges)
        if points is not cloth.points:
            title += "\nstrain %+.1f to %+.1f %%" % (min(strains.min(), 0), max(strains.max(), 0))
        marks = points[anchors]
        wires = colors_of(strains, STRAIN, -LIMIT, LIMIT)
        rows[0].append(
            Panel(
                points, cloth.faces, title, has_faces=False, edges=edges, edge_colors=wires, line_width=0.7, marks=marks
            )
        )
        rows[1].append(Panel(points, cloth.faces, face_colors=SURFACE, line_width=0.2, marks=marks))
    page(
        path,
        rows,
        Camera(158, 20),
        [(STRAIN, -LIMIT, LIMIT, "strain of edges in % (blue: tension, red: compression; clipped)")],
        is_one_scale=False,
    )
