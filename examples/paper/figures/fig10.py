"""Figure 10: a hexagonal mesh, held at its corners, finds the shell in which all edges are 2.0 long under inverse
gravity."""

import numpy as np

import measure
import meshes
import patterns
from claims import Measure
from draw import GOOD_TO_BAD, Camera, Panel, colors_of, page

NUMBER = 10
TITLE = "A funicular shell of edges 2.0 long"
CLAIM = (
    "Held at six corners under inverse gravity, the mesh rises in 1000 iterations to an equilibrium with edges of 2.0."
)
NOTES = """\
A regular hexagon of 108 quads with edges of 1.8. Gravity stretches the edges: their deviation is the load over the
weight. A weight 30 times as large leaves about a thirtieth of it, but the load then lifts the mesh as much less per
iteration: after 1000 of them the edges are right and the shell is still rising. So the figure's "equilibrium at
iteration 1000" sets the weight, and with it the deviation; more iterations buy less of it. A force out of balance is
computed here from lengths, weights and the load.
"""

COUNT, INPUT_EDGE, LENGTH = 6, 1.8, 2.0
WEIGHT, STIFF_WEIGHT = 1000, 30000
STAGES = {"1 iteration": 1, "10 iterations": 9, "1000 iterations": 990}
LIMIT = 5  # percent of the length at the red end of the colours


def hexagon():
    """The mesh, and the indices of its six corners."""
    points, faces = meshes.hexagon(COUNT, INPUT_EDGE)
    away = np.linalg.norm(points, axis=1)
    return (points, faces), np.flatnonzero(away > COUNT * INPUT_EDGE - 1e-6).tolist()


def model(name, weight, iterations, stages, more=()):
    _, corners = hexagon()
    return {
        "name": name,
        "mesh": "meshes/fig10.obj",
        "constraints": [
            {
                "name": "edges",
                "type": "EdgeStrain",
                "indices": "edgeVertices",
                "weights": [weight],
                "scalars": [[LENGTH, 1, 1]],
            },
            {"name": "corners", "type": "Closeness", "indices": [[c] for c in corners], "weights": [1000000]},
            *more,
        ],
        "settings": {
            "mode": "live",
            "iterations": iterations,
            "mass": 1,
            "damping": 1,
            "time_step": 1,
            "gravity": [0, 0, 1],
            "dynamic": False,
        },
        "stages": [{"name": stage, "solves": solves} for stage, solves in stages.items()],
    }


def build():
    models = [
        model("shell", WEIGHT, 1, STAGES),
        model("at rest", WEIGHT, 1000, {"100000 iterations": 100}),
        model("stiff", STIFF_WEIGHT, 1000, {"1000 iterations": 1, "100000 iterations": 99}),
    ]
    return {"figure": NUMBER, "title": TITLE, "models": models}, {"meshes/fig10.obj": hexagon()[0]}


def length_errors(shell, points):
    """For each edge: its length over 2.0, minus 1, in percent."""
    return 100 * (measure.edge_lengths(points, patterns.edges(shell.faces)) / LENGTH - 1)


def imbalance(shell, points):
    """The largest force on a free vertex that edges and load leave, over the load of a vertex. The force of an edge is
    the derivative of its energy `w l₀ (l / L - 1)² / 2`, with w the weight, l₀ its length in the input and L = 2.0."""
    edges = np.array(patterns.edges(shell.faces))
    along = points[edges[:, 1]] - points[edges[:, 0]]
    lengths = np.linalg.norm(along, axis=1)
    weight, gravity = (
        shell.model["constraints"][0]["weights"][0],
        np.array(shell.model["settings"]["gravity"], dtype=float),
    )
    tension = weight * measure.edge_lengths(shell.points, edges) / LENGTH * (lengths / LENGTH - 1)
    pulls = along * (tension / lengths)[:, None]
    forces = np.tile(gravity, (len(points), 1))
    np.add.at(forces, edges[:, 0], pulls)
    np.add.at(forces, edges[:, 1], -pulls)
    forces[[tree[0] for tree in shell.trees["corners"]]] = 0
    return np.linalg.norm(forces, axis=1).max() / np.linalg.norm(gravity)


def measures(solved):
    shell, rest, stiff = solved["shell"], solved["at rest"]["100000 iterations"], solved["stiff"]
    found = []
    for name in STAGES:
        errors = np.abs(length_errors(shell, shell[name]))
        is_last = name == "1000 iterations"
        found.append(
            Measure("largest deviation of an edge from 2.0, " + name, errors.max(), "%", most=3 if is_last else None)
        )
        found.append(Measure("mean deviation, " + name, errors.mean(), "%", most=0.5 if is_last else None))
    away = np.linalg.norm(shell["1000 iterations"] - rest, axis=1).max() / rest[:, 2].max()
    errors = {name: np.abs(length_errors(stiff, stiff[name])) for name in stiff.frames}
    lengths = length_errors(solved["at rest"], rest)
    return found + [
        Measure("height of the shell, 1000 iterations", shell["1000 iterations"][:, 2].max(), "units", least=4),
        Measure("largest distance to the equilibrium, 1000 iterations", 100 * away, "% of the height", most=2),
        Measure(
            "force out of balance, 1000 iterations",
            imbalance(shell, shell["1000 iterations"]),
            "loads of a vertex",
            most=0.5,
        ),
        Measure(
            "force out of balance, 100000 iterations",
            imbalance(solved["at rest"], rest),
            "loads of a vertex",
            most=1e-6,
        ),
        Measure("edges in tension there (in the shell upside down: compression)", 100 * (lengths > 0).mean(), "%"),
        Measure("weight 30 times as large: largest deviation, 1000 iterations", errors["1000 iterations"].max(), "%"),
        Measure("the same: force out of balance", imbalance(stiff, stiff["1000 iterations"]), "loads of a vertex"),
        Measure(
            "weight 30 times as large: largest deviation, 100000 iterations",
            errors["100000 iterations"].max(),
            "%",
            most=0.1,
        ),
        Measure(
            "the same: force out of balance",
            imbalance(stiff, stiff["100000 iterations"]),
            "loads of a vertex",
            most=0.01,
        ),
    ]


def picture(solved, path):
    shell = solved["shell"]
    corners = [tree[0] for tree in shell.trees["corners"]]
    panels = []
    for title, points in [("input", shell.points)] + [(name, shell[name]) for name in STAGES]:
        errors = np.abs(length_errors(shell, points))
        title += "\nedges up to %.1f %% off 2.0, mean %.2f %%" % (errors.max(), errors.mean())
        colors = colors_of(errors, GOOD_TO_BAD, 0, LIMIT)
        panels.append(
            Panel(
                points,
                shell.faces,
                title,
                edges=patterns.edges(shell.faces),
                edge_colors=colors,
                line_width=1.5,
                marks=points[corners],
                floor=0,
            )
        )
    legend = (GOOD_TO_BAD, 0, LIMIT, "deviation of an edge's length from 2.0, in % (clipped)")
    page(path, [panels[:2], panels[2:]], Camera(-75, 24), [legend], width=9.0)
