"""The definitions of the paper's examples: committed as they are built, and solved outside Rhino."""

from __future__ import annotations

import functools
import os
import sys
from pathlib import Path

import pytest

import archive
import build
import components
import dump
import paper
import xml_form
from components import HOSTS
from test_definition import assert_no_overlap

if "SHAPEOP_LIBRARY" not in os.environ:
    raise RuntimeError("set SHAPEOP_LIBRARY to the file of the shapeop library, such as /dist/lib/libshapeop.so")

SPECS = sorted(build.SPECS.glob("fig*.json"))
sys.path.insert(0, str(build.SPECS))
sys.path.insert(0, str(build.ROOT / "bindings" / "python" / "src"))

import solve  # noqa: E402  (of examples/paper)

from canvas import Canvas  # noqa: E402

# Both solve the same problem with the same library. What may differ is how numbers are added up where constraints
# were added in another order.
RELATIVE_TOLERANCE = 1e-9


@functools.cache
def expected_of(spec: Path) -> list:
    """The models of a spec with their points, solved once for all hosts."""
    return [(model, solve.solve(model)) for model in paper.read_spec(spec)["models"]]


@pytest.mark.parametrize("host", HOSTS, ids=lambda h: h.name)
def test_committed_definitions_are_those_that_are_built(host) -> None:
    built = build.definitions(components.load_all(build.COMPONENTS), host)
    committed = {p.name: p.read_bytes() for p in (build.DEFINITIONS / host.name).glob("*.ghx")}
    assert len(built) == 8
    assert sorted(built) == sorted(committed)
    for name in built:
        assert built[name] == committed[name], "%s: run build.py --definitions" % name


@pytest.mark.parametrize("spec", SPECS, ids=lambda p: p.stem)
@pytest.mark.parametrize("host", HOSTS, ids=lambda h: h.name)
def test_a_definition_solved_outside_rhino_gives_the_points_of_its_spec(host, spec: Path, say) -> None:
    root = dump.load(build.DEFINITIONS / host.name / (spec.stem + ".ghx"))
    canvas = Canvas(root)
    canvas.solve()
    assert canvas.errors() == []
    for model, expected in expected_of(spec):
        diagonal = float(((expected.points.max(axis=0) - expected.points.min(axis=0)) ** 2).sum() ** 0.5)
        worst, compared = 0.0, 0
        for stage, points in (live if paper.is_live(model) else static)(canvas, model):
            assert canvas.errors() == []
            wanted = expected[stage]
            assert len(points) == len(wanted)
            found = max(abs(a - b) for p, w in zip(points, wanted) for a, b in zip((p.X, p.Y, p.Z), w))
            worst, compared = max(worst, found / diagonal), compared + 1
        say("%s %s, %s: %d stages, %.1e of the diagonal apart" % (host.name, spec.stem, model["name"], compared, worst))
        assert worst < RELATIVE_TOLERANCE
    canvas.close()


def static(canvas: Canvas, model):
    """The points of each stage, by the slider of iterations."""
    slider = canvas.find("Iterations", model["name"])
    solves = 0
    for stage in model["stages"]:
        solves += stage["solves"]
        slider.value = solves * model["settings"]["iterations"]
        canvas.solve()
        yield stage["name"], result(canvas, model)


def live(canvas: Canvas, model):
    """The points of each stage: unpaused, started by Reset, ticked as often as the stage says, at its place on the
    slider of stages."""
    group = model["name"]
    reset, pause = canvas.find("Reset", group), canvas.find("Pause", group)
    stages = canvas.find("Stage", group) if any(s.get("edits") for s in model["stages"]) else None
    if stages:
        stages.value = 0
    reset.value, pause.value = True, False
    canvas.solve()
    assert not canvas.tick(), "nothing runs while Reset is pressed"
    for number, stage in enumerate(model["stages"], 1):
        is_ramp = any(edit.get("ramp") for edit in stage.get("edits", ()))
        for k in range(1, stage["solves"] + 1):
            if stages:
                stages.value = number - 1 + k / stage["solves"] if is_ramp else number
            if reset.value:
                reset.value = False
                canvas.solve()
            else:
                assert canvas.tick(), "the live solver schedules itself"
        yield stage["name"], result(canvas, model)
    pause.value = True
    canvas.tick()
    assert not canvas.tick(), "a paused solver does not schedule itself"


def result(canvas: Canvas, model):
    points = canvas.find("SOSolver", model["name"]).output("Points")
    (moved,) = canvas.find("MoveVertices", model["name"]).output("Moved")
    assert [(p.X, p.Y, p.Z) for p in moved.Vertices.ToPoint3dArray()] == [(p.X, p.Y, p.Z) for p in points]
    return points


@pytest.mark.parametrize("spec", SPECS, ids=lambda p: p.stem)
def test_objects_of_the_examples_do_not_overlap(spec: Path) -> None:
    root = dump.load(build.DEFINITIONS / "rhino8" / (spec.stem + ".ghx"))
    boxes = []
    for item in root.chunk("Definition").chunk("DefinitionObjects").chunks:
        attributes = item.chunk("Container").chunk("Attributes")
        if attributes.find("Bounds"):
            boxes.append((item.chunk("Container").get("NickName"), attributes.get("Bounds")))
    assert len(boxes) > 10
    assert_no_overlap(boxes)


def test_a_definition_reads_back_as_a_gh_file_too(tmp_path: Path) -> None:
    tree = dump.load(build.DEFINITIONS / "rhino7" / "fig05.ghx")
    path = tmp_path / "fig05.gh"
    path.write_bytes(archive.write(tree))
    assert xml_form.text(dump.load(path)) == xml_form.text(tree)


def test_an_edit_of_scalars_that_were_never_stated_is_refused() -> None:
    model = {
        "name": "m",
        "constraints": [{"name": "c", "type": "EdgeStrain"}],
        "stages": [{"name": "s", "solves": 1, "edits": [{"constraints": "c", "scalars": [[1, 1, 1]]}]}],
    }
    with pytest.raises(paper.SpecError, match="'m' edits 'c', which states no scalars"):
        paper.scalars_of_stages(model, model["constraints"][0])


def test_scalars_of_one_list_are_repeated_where_an_edit_has_more() -> None:
    edits = [{"constraints": "c", "scalars": [[2], [3]]}]
    model = {"name": "m", "stages": [{"name": "a", "solves": 1}, {"name": "b", "solves": 1, "edits": edits}]}
    assert paper.scalars_of_stages(model, {"name": "c", "scalars": [[1]]}) == [[[1], [1]], [[1], [1]], [[2], [3]]]
    assert paper.scalars_of_stages({**model, "stages": []}, {"name": "c", "scalars": [[1]]}) == [[[1]]]
