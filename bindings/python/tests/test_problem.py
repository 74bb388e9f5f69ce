"""Problems as plain data and as JSON."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import pytest

import shapeop
from near import assert_near
from samples import SQUARE, saddle
from shapeop import (
    Constraint,
    Edit,
    Force,
    Handle,
    Objective,
    Outcome,
    Problem,
    ReferenceMesh,
    ReferencePolyline,
    Settings,
    _library,
)


def canonical(text: str) -> str:
    """The library's form of a text."""
    answer: bytes = _library.lib.shapeop_problemText(text.encode())
    return answer.decode()


def sample() -> Problem:
    return Problem(
        points=[*saddle(0.1), [0.1, 1 / 3, 1e-300]],
        constraints=[
            Constraint("Plane", [0, 1, 2, 3], 2.5),
            Constraint("Closeness", (4,), scalars=(0, 0, 0.5)),
            Constraint("Closeness", range(3, 4)),
        ],
        forces=[Force("gravity", [0, 0, -1]), Force("vertex", [1, 0, 0], 4)],
        edits=[Edit(2, 1, [0, 0, 1])],
        faces=[[0, 1, 2, 3]],
        edges=[(0, 4)],
        mode="dynamic",
        masses=2,
        damping=0.5,
        timestep=0.25,
        settings=Settings(max_iterations=7, tolerance=0, steps=3, acceleration="anderson", acceleration_memory=4),
        extra={"author": "Ünal", "list": [1, None, {"x": True}]},
    )


def explored() -> Problem:
    """A saddle to be planar exactly, its first corner dragged to the height 1; the others stay about where they are."""
    return Problem(
        points=saddle(0.1),
        constraints=[
            Constraint("Plane", [0, 1, 2, 3], 2.0, hard=True),
            Constraint("OnCurve", [3], scalars=[1]),
        ],
        forces=[Force("normal", magnitude=0.0, faces=[[0, 1, 2]])],
        faces=[[0, 1, 2, 3]],
        references=[ReferenceMesh(SQUARE, [[0, 1, 2]]), ReferencePolyline(SQUARE, closed=True)],
        objective=Objective(handle_weight=50, fairness="second-differences", polylines=[[0, 1, 2, 3]], tolerance=1e-10),
        handles=[Handle(0, [0, 0, 1])],
    )


def test_what_is_explored_survives_as_text() -> None:
    text = explored().to_json()
    assert text == canonical(text)
    assert Problem.from_json(text) == explored()
    # The defaults of the objective are the library's.
    problem = Problem(SQUARE, faces=[[0, 1, 2, 3]], objective=Objective())
    least = json.dumps({"version": 1, "points": SQUARE, "faces": [[0, 1, 2, 3]], "objective": {}})
    assert problem.to_json() == canonical(least)
    problem.objective = Objective(handle_weight=0)
    with pytest.raises(shapeop.InvalidValueError, match=r"objective\.handle_weight: expected a number above 0"):
        problem.to_json()


def test_the_text_is_the_library_s_own() -> None:
    text = sample().to_json()
    assert text == canonical(text)
    assert Problem.from_json(text).to_json() == text
    least = '{"version": 1, "points": [[0, 1, 2]]}'
    assert Problem.from_json(least).to_json() == canonical(least)
    # The defaults of the dataclasses are the library's.
    assert Problem([[0, 1, 2]]).to_json() == canonical(least)
    assert Problem.from_json(least) == Problem([[0.0, 1.0, 2.0]])


@pytest.mark.parametrize("name", ["circularize.json", "hanging_cloth.json", "regularize.json"])
def test_the_examples_round_trip(repository: Path, tmp_path: Path, name: str) -> None:
    text = (repository / "examples" / name).read_text(encoding="utf-8")
    problem = Problem.load(repository / "examples" / name)
    assert problem.to_json() == canonical(text)
    problem.save(tmp_path / "copy.json")
    assert (tmp_path / "copy.json").read_text(encoding="utf-8") == canonical(text)
    assert Problem.load(str(tmp_path / "copy.json")) == problem


def test_no_field_of_the_schema_is_missing(repository: Path) -> None:
    schema = json.loads((repository / "docs" / "problem.schema.json").read_text(encoding="utf-8"))
    kinds = {
        "Signature": Constraint,
        "ForceSignature": Force,
        "Edit": Edit,
        "Settings": Settings,
        "Handle": Handle,
        "Objective": Objective,
    }
    for name, kind in kinds.items():
        assert {field.name for field in dataclasses.fields(kind)} == set(schema["$defs"][name]["properties"]), name
    references: dict[str, Any] = {"polyline": ReferencePolyline, "mesh": ReferenceMesh}
    for one in schema["$defs"]["Reference"]["oneOf"]:
        for name, form in one["properties"].items():
            assert {field.name for field in dataclasses.fields(references[name])} == set(form["properties"]), name
    assert {field.name for field in dataclasses.fields(Problem)} == set(schema["properties"])


def test_nothing_is_lost_on_the_way() -> None:
    again = Problem.from_json(sample().to_json())
    assert again.points == [*saddle(0.1), [0.1, 1 / 3, 1e-300]]
    assert again.constraints[1] == Constraint("Closeness", [4], 1.0, [0, 0, 0.5])
    assert again.constraints[2].scalars is None
    assert again.forces == [Force("gravity", [0, 0, -1]), Force("vertex", [1, 0, 0], 4)]
    assert again.settings == sample().settings
    assert again.extra == sample().extra
    assert [edit.constraint for edit in again.edits_before(2)] == [1]
    assert again.edits_before(1) == []


def test_its_solver_has_everything_and_its_settings() -> None:
    problem = Problem(saddle(0.1), settings=Settings(max_iterations=1, tolerance=0))
    problem.constraints.append(Constraint("Plane", [0, 1, 2, 3]))
    problem.constraints.extend(Constraint("Closeness", [i], 0.25) for i in range(4))
    with problem.solver() as solver:
        report = solver.solve_until()
        assert (report.iterations, report.outcome) == (1, Outcome.ITERATION_LIMIT)
        assert solver.solve_until(5, tolerance=1).outcome is Outcome.CONVERGED
        # Edits find the types of the constraints; a plane of the 4 targets and nothing else is a plane.
        solver.edit(None, [1, 2, 3, 4], SQUARE)
        solver.solve(200)
        assert_near(solver.points, SQUARE, 1e-9)
        with pytest.raises(shapeop.ArgumentError, match="found Closeness and Plane"):
            solver.edit(None, [0, 1], [0, 0, 0])


def test_a_dynamic_problem_steps_like_a_solver_that_is_filled_by_hand() -> None:
    problem = sample()
    with problem.solver() as solver, shapeop.Solver(problem.points) as by_hand:
        by_hand.set_acceleration("anderson", 4)
        for one in problem.constraints:
            by_hand.add(one.type, list(one.indices), weight=one.weight, scalars=one.scalars)
        by_hand.add_gravity([0, 0, -1])
        by_hand.add_vertex_force([1, 0, 0], 4)
        by_hand.init_dynamic(2, 0.5, 0.25)
        for step in range(1, problem.settings.steps + 1):
            for edit in problem.edits_before(step):
                solver.edit(None, edit.constraint, edit.scalars)
                by_hand.edit("Closeness", edit.constraint, edit.scalars)
            solver.solve_until()
            by_hand.solve_until(7, 0)
            assert_near(solver.points, by_hand.points, 0)
        assert max(abs(a - b) for p, q in zip(solver.points, sample().points) for a, b in zip(p, q)) > 0.1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "EOF"),
        ("[]", "expected"),
        ('{"version": 1}', "missing field `points`"),
        ('{"version": 1, "points": [[0, 0]]}', r"points\[0\]"),
        ('{"version": 1, "points": [[0, 0, 0]], "colour": 1}', "colour: unknown field"),
        ('{"version": 9, "points": []}', "version: expected 1, found 9"),
        (
            '{"version": 1, "points": [[0, 0, 0]], "constraints": [{"type": "Closeness", "indices": [3]}]}',
            r"constraints\[0\].*3",
        ),
    ],
)
def test_a_text_that_is_no_problem_is_refused_with_the_place(text: str, message: str) -> None:
    with pytest.raises(shapeop.Error, match=message):
        Problem.from_json(text)


def test_a_problem_that_errs_is_refused_with_the_place() -> None:
    problem = sample()
    problem.constraints[1].weight = -1
    for call in (problem.to_json, problem.solver):
        with pytest.raises(shapeop.Error, match=r"constraints\[1\].*weight.*-1"):
            call()
    problem.constraints[1] = Constraint("Closeness", [4], float("nan"))
    with pytest.raises(shapeop.Error, match=r"constraints\[1\]\.weight"):
        problem.to_json()
    with pytest.raises(shapeop.ArgumentTypeError, match="plain data, found object"):
        Problem([[0, 0, 0]], extra={"x": object()}).to_json()
    with pytest.raises(shapeop.ArgumentTypeError, match="text: expected a str, found bytes"):
        Problem.from_json(b"{}")  # type: ignore[arg-type]


def test_arrays_are_written_as_lists() -> None:
    np = pytest.importorskip("numpy")
    problem = Problem(np.array(saddle(0.1)), faces=np.array([[0, 1, 2, 3]]))
    problem.constraints.append(Constraint("Closeness", np.array([0]), np.float64(2), np.zeros(3)))
    plain = Problem(saddle(0.1), [Constraint("Closeness", [0], 2.0, [0, 0, 0])], faces=[[0, 1, 2, 3]])
    assert problem.to_json() == plain.to_json()
