"""Figure 4: a hanging cloth, torn far apart and let go."""

import numpy as np

import measure
import meshes
import patterns
from claims import Measure
from draw import SURFACE, STRAIN, Camera, Panel, colors_of, page

NUMBER = 4
TITLE = "Hanging cloth"
CLAIM = (
    "Stable and fast: anchors that jump far apart and back leave, after 100 iterations, the cloth that was never torn."
)

COUNT, SIZE = 20, 10.0
APART = 4.0  # times farther from the middle
LIMIT = 6  # strain in percent at the ends of the colours


def build():
    cloth = meshes.cloth(COUNT, SIZE)
    corners = [0, COUNT, (COUNT + 1) * (COUNT + 1) - 1]
    home = cloth[0][corners]
    rest = measure.edge_lengths(cloth[0], patterns.edges(cloth[1]))
    constraints = [
        {"name": "edges", "type": "EdgeStrain", "indices": "edgeVertices", "weights": [3000]},
        {"name": "bending", "type": "Bending", "indices": "edgeFaceVertices", "weights": [0.5]},
        {"name": "anchors", "type": "Closeness", "indices": [[c] for c in corners], "weights": [100000], "scalars": home.tolist()},
    ]
    model = {
        "mesh": "meshes/fig04.obj",
        "constraints": constraints,
        "settings": {"mode": "live", "iterations": 10, "mass": 1, "damping": 0.9, "time_step": 0.5, "gravity": [0, 0, -1], "dynamic": True},
    }
    stages = [
        {"name": "torn", "solves": 1, "edits": [{"constraints": "anchors", "scalars": (APART * home).tolist()}]},
        {"name": "let go", "solves": 100, "edits": [{"constraints": "anchors", "scalars": home.tolist()}]},
    ]
    models = [
        {"name": "cloth", **model, "stages": stages},
        {"name": "never torn", **model, "stages": [{"name": "at rest", "solves": 1000}]},
    ]
    return {"figure": NUMBER, "title": TITLE, "models": models}, {"meshes/fig04.obj": cloth}


def measures(solved):
    cloth, untorn = solved["cloth"], solved["never torn"]
    edges = patterns.edges(cloth.faces)
    rest, last = untorn["at rest"], untorn.frames["at rest"][-2]
    torn, back = (measure.strains(cloth[stage], cloth.points, edges) for stage in ("torn", "let go"))
    diagonal = SIZE * np.sqrt(2)
    away = np.linalg.norm(cloth["let go"] - rest, axis=1).max()
    early = np.linalg.norm(cloth.frames["let go"][9] - rest, axis=1).max()
    return [
        Measure("largest strain of an edge, torn", 100 * torn.max(), "%", least=500),
        Measure("largest strain of an edge, 100 steps after", 100 * np.abs(back).max(), "%", most=10),
        Measure("largest distance from the cloth never torn, 10 steps after", 100 * early / diagonal, "% of the diagonal"),
        Measure("largest distance from the cloth never torn, 100 steps after", 100 * away / diagonal, "% of the diagonal", most=0.5),
        Measure("last move of the cloth never torn", 100 * np.linalg.norm(rest - last, axis=1).max() / diagonal, "% of the diagonal", most=1e-6),
    ]


def picture(solved, path):
    cloth = solved["cloth"]
    edges = patterns.edges(cloth.faces)
    anchors = [tree[0] for tree in cloth.trees["anchors"]]
    rows = [[], []]
    for title, points in (
        ("input", cloth.points),
        ("first step, anchors 4 times as far apart", cloth["torn"]),
        ("100 steps after the anchors are back", cloth["let go"]),
    ):
        strains = 100 * measure.strains(points, cloth.points, edges)
        title += "\nstrain %+.1f to %+.1f %%" % (min(strains.min(), 0), max(strains.max(), 0))
        marks = points[anchors]
        wires = colors_of(strains, STRAIN, -LIMIT, LIMIT)
        rows[0].append(Panel(points, cloth.faces, title, has_faces=False, edges=edges, edge_colors=wires, line_width=0.7, marks=marks))
        rows[1].append(Panel(points, cloth.faces, face_colors=SURFACE, line_width=0.2, marks=marks))
    page(path, rows, Camera(158, 20), [(STRAIN, -LIMIT, LIMIT, "strain of edges in % (blue: tension, red: compression; clipped)")], is_one_scale=False)
