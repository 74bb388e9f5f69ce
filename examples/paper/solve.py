"""Solves the models of a figure as its JSON states them: see README.md."""

import json
import re
from pathlib import Path

import numpy as np
import shapeop

import meshes
import patterns

FOLDER = Path(__file__).resolve().parent


class Solved:
    """A solved model: its mesh, the trees of indices by constraint name, and the points after every solve call."""

    def __init__(self, model, points, faces, trees):
        self.model, self.points, self.faces, self.trees = model, points, faces, trees
        self.frames = {}

    def __getitem__(self, stage):
        """The points at the end of a stage."""
        return self.frames[stage][-1]


def read_spec(number):
    return json.loads((FOLDER / ("fig%02d.json" % number)).read_text())


def spec_text(spec):
    """The JSON text of a spec: innermost lists on one line each, numbers with as many decimals as in meshes."""
    text = json.dumps(_rounded(spec), indent=1)
    return (
        re.sub(r"\[[^][{}]*\]", lambda found: " ".join(found[0].split()).replace("[ ", "[").replace(" ]", "]"), text)
        + "\n"
    )


def mesh_of(model):
    return meshes.read_obj(FOLDER / model["mesh"])


def tree_of(constraints, vertex_count, faces):
    indices = constraints["indices"]
    return patterns.PATTERNS[indices](vertex_count, faces) if isinstance(indices, str) else indices


def solve(model, progress=lambda: None):
    points, faces = mesh_of(model)
    solver = shapeop.Solver(points)
    settings = model["settings"]
    trees, added, scalars = {}, {}, {}
    for constraints in model["constraints"]:
        name = constraints["name"]
        trees[name] = tree_of(constraints, len(points), faces)
        scalars[name] = constraints.get("scalars")
        added[name] = (
            constraints["type"],
            solver.add(
                constraints["type"],
                trees[name],
                weight=one_or_each(constraints["weights"]),
                scalars=one_or_each(scalars[name]),
            ),
        )
    if settings["mode"] == "live":
        solver.add_gravity(settings["gravity"])
    if settings.get("dynamic"):
        solver.init_dynamic(settings["mass"], settings["damping"], settings["time_step"])
    else:
        solver.init()

    solved = Solved(model, points, faces, trees)
    for stage in model["stages"]:
        frames = solved.frames[stage["name"]] = []
        edits = [(edit, scalars[edit["constraints"]]) for edit in stage.get("edits", [])]
        for k in range(1, stage["solves"] + 1):
            for edit, before in edits:
                if k == 1 or edit.get("ramp"):
                    share = k / stage["solves"] if edit.get("ramp") else 1.0
                    now = _between(before, edit["scalars"], share)
                    scalars[edit["constraints"]] = now
                    solver.edit(*added[edit["constraints"]], one_or_each(now))
            solver.solve(settings["iterations"])
            frames.append(solver.points)
            progress()
    return solved


def one_or_each(values):
    """A list of one as its one item, which the package repeats for all constraints."""
    return values[0] if values is not None and len(values) == 1 else values


def solve_count(spec):
    return sum(stage["solves"] for model in spec["models"] for stage in model["stages"])


def _rounded(value):
    if isinstance(value, dict):
        return {key: _rounded(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(one) for one in value]
    return round(float(value), meshes.DECIMALS) + 0.0 if isinstance(value, (float, np.floating)) else value


def _between(before, after, share):
    """`before + (after - before) * share`, list by list; `after` itself where share is 1."""
    if share == 1.0:
        return after
    return (np.array(before) + (np.array(after) - np.array(before)) * share).tolist()
