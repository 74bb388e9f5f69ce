"""Definitions of the examples of the ShapeOp paper, from their specs (`examples/paper/README.md` states the form).

A definition holds the models of one figure, one below the other. Each model: the mesh as text in a panel, the
constraints with their numbers in panels, settings on sliders, the solver, the mesh at the solved points. The numbers
that a spec edits over time stand in one panel, a section for each stage, and a slider chooses the stage."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, Dict, List, Sequence

from components import Component, Host
from definition import Definition, Node, Position

# Columns and rows of the canvas.
_TEXTS, _READERS, _INDEXERS, _SIGNATURES, _SOLVER, _RESULT = 0, 270, 440, 640, 900, 1200
_ROW, _MARGIN = 150, 60


class SpecError(ValueError):
    """A spec that no definition can be made of."""


def read_spec(path: Path) -> Dict[str, Any]:
    """The spec in a JSON file."""
    return json.loads(path.read_text("utf-8"))


def build(
    spec: Dict[str, Any], folder: Path, components: Dict[str, Component], parts: Dict[str, Component], host: Host
) -> Definition:
    """The definition of a figure. `folder` holds its meshes, `parts` are the components of the examples alone."""
    name = "fig%02d" % spec["figure"]
    definition = Definition(
        name + ".ghx", "%s (figure %d of the ShapeOp paper)" % (spec["title"], spec["figure"]), host
    )
    top = 0.0
    meshes: Dict[str, Node] = {}  # models of one figure may share a mesh
    for model in spec["models"]:
        top = _Model(definition, model, folder, meshes, components, parts, spec["title"], top).bottom + 2 * _MARGIN
    return definition


def scalars_of_stages(model: Dict[str, Any], constraint: Dict[str, Any]) -> List[List[List[float]]]:
    """The scalars of a constraint that are in force at the start and at the end of each stage; one entry if they never
    change, none if there are none."""
    found = [constraint["scalars"]] if "scalars" in constraint else []
    edited = False
    for stage in model["stages"]:
        edits = [e for e in stage.get("edits", ()) if e["constraints"] == constraint["name"]]
        if edits and not found:
            raise SpecError(
                "model %r edits %r, which states no scalars to begin with" % (model["name"], constraint["name"])
            )
        if found:
            found.append(edits[-1]["scalars"] if edits else found[-1])
        edited = edited or bool(edits)
    if not edited:
        return found[:1]
    count = max(len(lists) for lists in found)
    return [lists * count if len(lists) == 1 else lists for lists in found]


def is_live(model: Dict[str, Any]) -> bool:
    """Whether a model goes on from tick to tick. A static one does only if a later stage edits it."""
    edits_later = any(stage.get("edits") for stage in model["stages"][1:])
    return model["settings"]["mode"] == "live" or edits_later


def rows_text(rows: Sequence[Sequence[float]]) -> str:
    """Numbers as `ReadNumbers` reads them back, bit by bit."""
    return "\n".join(" ".join(repr(value) for value in row) for row in rows)


class _Model:
    def __init__(
        self, definition: Definition, model: Dict[str, Any], folder: Path, meshes: Dict[str, Node],
        components: Dict[str, Component], parts: Dict[str, Component], title: str, top: float,
    ) -> None:  # fmt: skip
        self.definition, self.model, self.components, self.parts = definition, model, components, parts
        self.row = top
        self.nodes: List[Node] = []
        stages = [scalars_of_stages(model, c) for c in model["constraints"]]
        self.has_stages = any(len(s) > 1 for s in stages)
        note = self._note(title)
        height = 24 + 18 * (1 + note.count("\n"))
        self.panel("note", note, (_TEXTS, self.row), (620, height))
        self.row += height + _MARGIN
        if self.has_stages:
            self.stage = self.slider("stage", "Stage", len(model["stages"]), 0, len(model["stages"]), 3, _TEXTS)
        if model["mesh"] not in meshes:
            text = (folder / model["mesh"]).read_text("utf-8")
            mesh_text = self.panel("mesh text", text, (_TEXTS, self.row), (240, 120), "Mesh")
            meshes[model["mesh"]] = self.part("ReadMesh", "mesh", _READERS)
            self.definition.wire(mesh_text, meshes[model["mesh"]], "Text")
            self.row += _ROW
        self.mesh = meshes[model["mesh"]]
        solver = self.component("ConstraintSolver", "solver", _SOLVER)
        for constraint, scalars in zip(model["constraints"], stages):
            signature = self._constraint(constraint, scalars)
            self.definition.wire((signature, "ConstraintSigs"), solver, "ConstraintSigs")
        self.definition.wire((self.mesh, "Points"), solver, "Points")
        self.definition.wire((self._settings(), "Settings"), solver, "Settings")
        moved = self.definition.component(self.key("result"), self.parts["MoveVertices"], (_RESULT, top + 2 * _ROW))
        self.definition.wire((self.mesh, "Mesh"), moved, "Mesh")
        self.definition.wire((solver, "Points"), moved, "Points")
        self.definition.group(self.key("group"), model["name"], self.nodes + [moved])
        self.bottom = self.row

    def key(self, what: str) -> str:
        return "%s/%s" % (self.model["name"], what)

    def panel(self, what: str, text: str, at: Position, extent: Position, nickname: str = "") -> Node:
        node = self.definition.panel(self.key(what), text, at, extent, nickname)
        self.nodes.append(node)
        return node

    def component(self, name: str, what: str, x: float) -> Node:
        node = self.definition.component(self.key(what), self.components["ShapeOp" + name], (x, self.row))
        self.nodes.append(node)
        return node

    def part(self, name: str, what: str, x: float) -> Node:
        node = self.definition.component(self.key(what), self.parts[name], (x, self.row))
        self.nodes.append(node)
        return node

    def slider(self, what: str, nickname: str, value: float, low: float, high: float, digits: int, x: float) -> Node:
        node = self.definition.slider(self.key(what), nickname, value, low, high, digits, (x, self.row))
        self.nodes.append(node)
        self.row += 30
        return node

    def _note(self, title: str) -> str:
        lines = ["%s: %s" % (title, self.model["name"])]
        if is_live(self.model):
            lines.append("Set Pause to False to start, press Reset to start again.")
            if self.has_stages:
                lines.append("Stage: 0 is the input; between two whole numbers the numbers of both are mixed.")
            lines += ["Stage %d: %s" % (i + 1, s["name"]) for i, s in enumerate(self.model["stages"])]
        else:
            count, lists = 0, []
            for stage in self.model["stages"]:
                count += stage["solves"] * self.model["settings"]["iterations"]
                lists.append("Iterations %d: %s" % (count, stage["name"]))
            lines += lists
        return "\n".join(lines)

    def _constraint(self, constraint: Dict[str, Any], scalars: List[List[List[float]]]) -> Node:
        name, definition = constraint["name"], self.definition
        signature = self.component("ConstraintSignature", name, _SIGNATURES)
        top = self.row
        kind = self.panel(name + " type", constraint["type"], (_TEXTS, self.row), (240, 24), name)
        definition.wire(kind, signature, "ConstraintType")
        self.row += 30
        if isinstance(constraint["indices"], str):
            indexer = self.component("MeshIndexer", name + " indices", _INDEXERS)
            pattern = self.panel(name + " pattern", constraint["indices"], (_TEXTS, self.row), (240, 24), "Pattern")
            definition.wire(pattern, indexer, "Pattern")
            definition.wire((self.mesh, "Mesh"), indexer, "Mesh")
            definition.wire((indexer, "PointIndices"), signature, "PointIndices")
            self.row += 30
        else:
            self._numbers(
                name + " indices", "Indices", rows_text(constraint["indices"]), False, signature, "PointIndices"
            )
        weights = constraint["weights"]
        if len(weights) == 1:
            panel = self.panel(name + " weight", repr(weights[0]), (_TEXTS, self.row), (240, 24), "Weight")
            definition.wire(panel, signature, "Weights")
            self.row += 30
        else:
            self._numbers(name + " weights", "Weights", rows_text([weights]), False, signature, "Weights")
        if scalars:
            text = rows_text(scalars[0])
            for stage, lists in zip(self.model["stages"], scalars[1:]):
                text += "\n# %s\n%s" % (stage["name"], rows_text(lists))
            self._numbers(name + " scalars", "Scalars", text, len(scalars) > 1, signature, "Scalars")
        self.row = max(self.row, top + _ROW)
        return signature

    def _numbers(self, what: str, nickname: str, text: str, is_staged: bool, target: Node, name: str) -> None:
        panel = self.panel(what + " text", text, (_TEXTS, self.row), (240, 64), nickname)
        reader = self.part("ReadNumbers", what, _READERS)
        self.definition.wire(panel, reader, "Text")
        if is_staged:
            self.definition.wire(self.stage, reader, "Stage")
        self.definition.wire((reader, "Numbers"), target, name)
        self.row += 74

    def _settings(self) -> Node:
        settings, definition = self.model["settings"], self.definition
        if not is_live(self.model):
            total = settings["iterations"] * sum(stage["solves"] for stage in self.model["stages"])
            node = self.component("SettingsStatic", "settings", _READERS)
            definition.wire(self.slider("iterations", "Iterations", total, 0, 2 * total, 0, _TEXTS), node, "Iterations")
            self.row += _MARGIN
            return node
        node = self.component("SettingsLive", "settings", _INDEXERS)
        live = dict({"mass": 1, "damping": 1, "time_step": 0.1, "gravity": [0, 0, 0], "dynamic": False}, **settings)
        for key, name in (
            ("iterations", "Iterations"),
            ("mass", "Mass"),
            ("damping", "Damping"),
            ("time_step", "TimeStep"),
        ):
            definition.wire(self._number_slider(name, live[key], 0 if key == "iterations" else 3), node, name)
        if live["gravity"][:2] != [0, 0]:
            raise SpecError("model %r: gravity %s is not along z" % (self.model["name"], live["gravity"]))
        unit = definition.unit_z(self.key("unit z"), (_READERS, self.row))
        self.nodes.append(unit)
        definition.wire(self._number_slider("Gravity", live["gravity"][2], 3), unit, "Factor")
        definition.wire((unit, "Unit vector"), node, "UnaryVector")
        for name, value in (("Dynamic", bool(live["dynamic"])), ("Pause", True)):
            toggle = definition.toggle(self.key(name.lower()), name, value, (_TEXTS, self.row))
            self.nodes.append(toggle)
            definition.wire(toggle, node, name)
            self.row += 30
        button = definition.button(self.key("reset"), "Reset", (_TEXTS, self.row))
        self.nodes.append(button)
        definition.wire(button, node, "Reset")
        self.row += 30 + _MARGIN
        return node

    def _number_slider(self, name: str, value: float, digits: int) -> Node:
        while round(value, digits) != value:
            digits += 1
        limit = 10.0 ** math.ceil(math.log10(max(2 * abs(value), 1)))
        low = -limit if value < 0 or name == "Gravity" else 0
        return self.slider(name.lower(), name, value, low, limit, digits, _TEXTS)
