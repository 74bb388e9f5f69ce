"""The specs are what the rules make, the library takes them, and what the figures claim is measured."""

import functools
import json
import re

import numpy as np
import pytest

import meshes
import page
import patterns
import run
import solve
from claims import Measure, number
from figures import ALL

#: Results are the same bits on one machine. Another instruction set changes the last digits, which thousands of
#: iterations and switching targets could magnify; nothing that the page shows depends on more than this.
RELATIVE_TOLERANCE = 0.02
#: Below this, in any of the units, a measure is round-off.
ROUND_OFF = 1e-6
#: The largest picture, for the page to load quickly.
MOST_PICTURE_BYTES = 300_000

figures = pytest.mark.parametrize("figure", sorted(ALL))


@functools.cache
def solved(figure):
    return {model["name"]: solve.solve(model) for model in solve.read_spec(figure)["models"]}


@functools.cache
def measured(figure):
    return ALL[figure].measures(solved(figure))


def stored():
    return json.loads(run.MEASURES.read_text(encoding="utf-8"))


@figures
def test_files_are_what_the_rules_make(figure):
    spec, made = ALL[figure].build()
    assert (solve.FOLDER / ("fig%02d.json" % figure)).read_text() == solve.spec_text(spec)
    for path, mesh in made.items():
        assert (solve.FOLDER / path).read_text() == meshes.obj_text(mesh)


@figures
def test_specs_keep_to_the_form(figure):
    spec = solve.read_spec(figure)
    assert set(spec) == {"figure", "title", "models"}
    assert len({model["name"] for model in spec["models"]}) == len(spec["models"])
    for model in spec["models"]:
        assert set(model) == {"name", "mesh", "constraints", "settings", "stages"}
        points, faces = solve.mesh_of(model)
        names = [constraints["name"] for constraints in model["constraints"]]
        assert len(set(names)) == len(names)
        counts = {}
        for constraints in model["constraints"]:
            assert set(constraints) - {"scalars"} == {"name", "type", "indices", "weights"}
            count = counts[constraints["name"]] = len(solve.tree_of(constraints, len(points), faces))
            for values in (constraints["weights"], constraints.get("scalars", [None])):
                assert len(values) in (1, count)
                if isinstance(constraints["indices"], str):
                    assert constraints["indices"] in patterns.PATTERNS
                    assert len(values) == 1, "the order of a pattern's lists is not part of the form"
        live = {"mass", "damping", "time_step", "gravity", "dynamic"} if model["settings"]["mode"] == "live" else set()
        assert set(model["settings"]) == {"mode", "iterations"} | live
        for stage in model["stages"]:
            assert set(stage) - {"edits"} == {"name", "solves"}
            for edit in stage.get("edits", []):
                assert set(edit) - {"ramp"} == {"constraints", "scalars"}
                assert len(edit["scalars"]) in (1, counts[edit["constraints"]])


@figures
def test_all_points_are_finite_and_every_stage_moved_some(figure):
    for model in solved(figure).values():
        last = model.points
        for stage in model.model["stages"]:
            assert np.isfinite(model.frames[stage["name"]]).all()
            assert np.abs(model[stage["name"]] - last).max() > 0
            last = model[stage["name"]]


@figures
def test_claims_are_met(figure):
    bounded = [measure for measure in measured(figure) if measure.claim()]
    assert bounded
    assert [measure for measure in bounded if not measure.is_met] == []


@figures
def test_claims_fail_on_a_solver_that_does_nothing(figure):
    idle = {}
    for name, model in solved(figure).items():
        idle[name] = solve.Solved(model.model, model.points, model.faces, model.trees)
        idle[name].frames = {stage: [model.points] * len(frames) for stage, frames in model.frames.items()}
    with np.errstate(all="ignore"):
        assert any(not measure.is_met for measure in ALL[figure].measures(idle))


@figures
def test_the_page_shows_what_is_measured(figure):
    shown = stored()["fig%02d" % figure]["measures"]
    assert [found["what"] for found in shown] == [measure.what for measure in measured(figure)]
    for found, measure in zip(shown, measured(figure), strict=True):
        data = measure.data()
        assert {key: found.get(key) for key in ("unit", "most", "least")} == {
            key: data.get(key) for key in ("unit", "most", "least")
        }
        assert data["value"] == pytest.approx(found["value"], rel=RELATIVE_TOLERANCE, abs=ROUND_OFF), measure.what


def test_the_page_is_made_from_the_stored_measures():
    assert (run.DOCS / "paper-examples.md").read_text(encoding="utf-8") == page.text(stored(), ALL)


@figures
def test_pictures_are_there_and_small(figure):
    picture = run.DOCS / "images" / "paper" / ("fig%02d.png" % figure)
    assert 10_000 < picture.stat().st_size <= MOST_PICTURE_BYTES


def test_figures_are_drawn(tmp_path):
    run.main([str(tmp_path), "--figure", "8"])
    assert (tmp_path / "fig08.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert list(json.loads((tmp_path / "measures.json").read_text(encoding="utf-8"))) == ["fig08"]


def test_the_example_in_the_readme_can_be_solved():
    example = re.search(r"```json\n(.*?)```", (solve.FOLDER / "README.md").read_text(encoding="utf-8"), re.S)
    for model in json.loads(example[1])["models"]:
        assert solve.solve(model)["300 iterations"].shape[1] == 3


def test_a_ramp_moves_scalars_evenly_and_other_edits_at_once(tmp_path):
    (tmp_path / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    model = {
        "name": "triangle",
        "mesh": str(tmp_path / "mesh.obj"),
        "constraints": [
            {"name": "places", "type": "Closeness", "indices": "verticesEach", "weights": [1]},
            {"name": "handle", "type": "Closeness", "indices": [[0]], "weights": [1e12], "scalars": [[0, 0, 0]]},
        ],
        "settings": {"mode": "static", "iterations": 1},
        "stages": [
            {"name": "ramp", "solves": 4, "edits": [{"constraints": "handle", "scalars": [[8, 0, 0]], "ramp": True}]},
            {"name": "on", "solves": 2, "edits": [{"constraints": "handle", "scalars": [[8, 0, 4]], "ramp": True}]},
            {"name": "at once", "solves": 2, "edits": [{"constraints": "handle", "scalars": [[1, 1, 1]]}]},
        ],
    }
    solved = solve.solve(model)
    handle = [frame[0] for name in ("ramp", "on", "at once") for frame in solved.frames[name]]
    expected = [[2, 0, 0], [4, 0, 0], [6, 0, 0], [8, 0, 0], [8, 0, 2], [8, 0, 4], [1, 1, 1], [1, 1, 1]]
    assert np.allclose(handle, expected, atol=1e-9)


def test_live_static_settings_apply_gravity_and_dynamic_ones_make_time_steps(tmp_path):
    (tmp_path / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    model = {
        "name": "triangle",
        "mesh": str(tmp_path / "mesh.obj"),
        "constraints": [{"name": "places", "type": "Closeness", "indices": "verticesEach", "weights": [4]}],
        "settings": {
            "mode": "live",
            "iterations": 1,
            "mass": 2,
            "damping": 1,
            "time_step": 0.5,
            "gravity": [0, 0, -2],
            "dynamic": False,
        },
        "stages": [{"name": "one", "solves": 1}],
    }
    # Static: weight times the sag is the force. Dynamic: y = 0.25 * -2, M = 2 / 0.25, and (4 + M) z = M y.
    assert solve.solve(model)["one"][:, 2] == pytest.approx([-0.5] * 3)
    model["settings"]["dynamic"] = True
    assert solve.solve(model)["one"][:, 2] == pytest.approx([-1 / 3] * 3)


@pytest.mark.parametrize(
    ("value", "shown"),
    [(12, "12"), (0.123456, "0.123"), (3e-14, "< 1e-9"), (0, "0"), (1048.7, "1049"), (2e-6, "2e-6"), (-3, "-3")],
)
def test_numbers_are_shown_short(value, shown):
    assert number(value) == shown


def test_a_bound_is_met_by_its_own_value_and_not_beyond():
    assert Measure("", 1, most=1, least=1).is_met
    assert not Measure("", 1.001, most=1).is_met
    assert not Measure("", 0.999, least=1).is_met
    assert not Measure("", float("nan"), most=1).is_met


def test_notes_count_the_faces_right():
    counts = {figure: [len(face) for face in next(iter(solved(figure).values())).faces] for figure in (4, 8, 10)}
    assert "%d triangles" % len(counts[4]) in ALL[4].NOTES
    assert "%d squares and %d triangles" % (counts[8].count(4), counts[8].count(3)) in ALL[8].NOTES
    assert "%d quads" % len(counts[10]) in ALL[10].NOTES
