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

COUNT, SIZE = 24, 10.0
APART = 4.0  # times farther from the middle


def build():
    cloth = meshes.cloth(COUNT, SIZE)
    corners = [0, COUNT, (COUNT + 1) * (COUNT + 1) - 1]
    home = cloth[0][corners]
    rest = measure.edge_lengths(cloth[0], patterns.edges(cloth[1]))
    constraints = [
        {"name": "edges", "type": "EdgeStrain", "indices": "edgeVertices", "weights": [60]},
        {"name": "bending", "type": "Bending", "indices": "edgeFaceVertices", "weights": [0.02]},
        {"name": "anchors", "type": "Closeness", "indices": [[c] for c in corners], "weights": [10000], "scalars": home.tolist()},
    ]
    model = {
        "mesh": "meshes/fig04.obj",
        "constraints": constraints,
        "settings": {"mode": "live", "iterations": 1, "mass": 1, "damping": 1, "time_step": 1, "gravity": [0, 0, -0.04], "dynamic": False},
    }
    stages = [
        {"name": "torn", "solves": 1, "edits": [{"constraints": "anchors", "scalars": (APART * home).tolist()}]},
        {"name": "let go", "solves": 100, "edits": [{"constraints": "anchors", "scalars": home.tolist()}]},
    ]
    models = [
        {"name": "cloth", **model, "stages": stages},
        {"name": "never torn", **model, "stages": [{"name": "at rest", "solves": 3000}]},
    ]
    return {"figure": NUMBER, "title": TITLE, "models": models}, {"meshes/fig04.obj": cloth}
