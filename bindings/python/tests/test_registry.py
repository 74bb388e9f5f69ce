"""The constraint types, enums and reports follow the library's declarations."""

from __future__ import annotations

import dataclasses
from enum import IntEnum

import pytest

import shapeop
from shapeop import _abi, _library


def test_constraint_types_are_the_library_s() -> None:
    types = shapeop.constraint_types()
    assert len(types) == _library.lib.shapeop_constraintTypeCount() >= 18
    angle = types["Angle"]
    assert (angle.least_indices, angle.greatest_indices, angle.index_names[0]) == (3, 3, "apex")
    assert [scalar.name for scalar in angle.scalars] == ["min_rad", "max_rad"]
    assert angle.violation_unit == "rad"
    assert types["Plane"].greatest_indices is None
    assert not types["Plane"].is_editable
    assert types["Rigid"].takes_shapes
    assert types["Rigid"].is_editable
    assert types["Rigid"].edited_as == "Similarity"
    assert all(name == one.name and one.help for name, one in types.items())


def test_every_type_can_be_added_by_what_the_registry_says_of_it() -> None:
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]
    for one in shapeop.constraint_types().values():
        with shapeop.Solver(corners) as solver:
            # Types that refer to a shape take the first of its kind unless they are told.
            solver.add_reference_polyline(corners)
            solver.add_reference_mesh(corners, [[0, 1, 2]])
            assert solver.add(one.name, list(range(one.least_indices))) == 0
            with pytest.raises(shapeop.InvalidValueError) as caught:
                solver.add(one.name, [list(range(one.least_indices - 1))])
            assert caught.value.code is shapeop.ErrorCode.INVALID_ARGUMENT_LENGTH


@pytest.mark.parametrize(
    ("kind", "prefix"),
    [
        (shapeop.Outcome, "SO_OUTCOME_"),
        (shapeop.Acceleration, "SO_ACCELERATION_"),
        (shapeop.LinearSolver, "SO_LINEAR_SOLVER_"),
        (shapeop.AdapterKind, "SO_ADAPTER_"),
        (shapeop.Projection, "SO_PROJECTION_"),
        (shapeop.Fairness, "SO_FAIRNESS_"),
        (shapeop.canal.Kind, "SO_CANAL_KIND_"),
        (shapeop.canal.Center, "SO_CANAL_CENTER_"),
        (shapeop.canal.Section, "SO_CANAL_SECTION_"),
        (shapeop.canal.Spacing, "SO_CANAL_SPACING_"),
        (shapeop.canal.Step, "SO_CANAL_STEP_"),
        (shapeop.canal.Stop, "SO_CANAL_STOP_"),
        (shapeop.ruled.PointStatus, "SO_RULED_POINT_"),
        (shapeop.ruled.TraceEnd, "SO_RULED_END_"),
        (shapeop.ruled.Levels, "SO_RULED_LEVELS_"),
        (shapeop.ruled.Image, "SO_RULED_IMAGE_"),
        (shapeop.ruled.Stop, "SO_RULED_STOP_"),
        (shapeop.snakes.Stop, "SO_SNAKE_STOP_"),
        (shapeop.snakes.CurveEnd, "SO_SNAKE_CURVE_"),
        (shapeop.snakes.CycleEnd, "SO_SNAKE_CYCLE_"),
    ],
)
def test_no_member_of_an_enum_is_missing(kind: type[IntEnum], prefix: str) -> None:
    declared = {name[len(prefix) :]: value for name, value in vars(_abi).items() if name.startswith(prefix)}
    assert {member.name: member.value for member in kind} == declared


def test_no_error_code_is_missing() -> None:
    solvers = ("SO_OUTCOME_", "SO_ACCELERATION_", "SO_LINEAR_SOLVER_", "SO_PROJECTION_", "SO_FAIRNESS_", "SO_SUCCESS")
    backends = ("SO_BACKEND_CPU", "SO_BACKEND_GPU", "SO_BACKEND_AUTOMATIC", "SO_ADAPTER_")
    enums = (*solvers, *backends, "SO_CANAL_", "SO_RULED_", "SO_SNAKE_")
    names = [name for name in vars(_abi) if name.startswith("SO_") and not name.startswith(enums)]
    assert {code.name for code in shapeop.ErrorCode} == {name[len("SO_") :] for name in names}
    for code in shapeop.ErrorCode:
        assert _library.refusal(code, "why").code is code
    assert _library.refusal(4711, "a newer library's").code == 4711


def test_the_report_and_the_progress_have_every_field_of_their_structs() -> None:
    fields = [field.name for field in dataclasses.fields(shapeop.Report)]
    told = [name for name, *_ in _abi.shapeop_solve_report._fields_[1:] if name != "reserved"]
    assert fields == [*told, "backend_reason", "message"]
    told = [name for name, *_ in _abi.shapeop_backend_info._fields_[1:] if name != "reserved"]
    assert list(shapeop.BackendInfo._fields) == told
    members = {name[len("SO_BACKEND_") :]: vars(_abi)[name] for name in ("SO_BACKEND_CPU", "SO_BACKEND_GPU")}
    members["AUTOMATIC"] = _abi.SO_BACKEND_AUTOMATIC
    assert {member.name: member.value for member in shapeop.Backend} == members
    fields = [field.name for field in dataclasses.fields(shapeop.Exploration)]
    assert fields == [name for name, *_ in _abi.shapeop_exploration._fields_[1:]]
    assert list(shapeop.Progress._fields) == [name for name, *_ in _abi.shapeop_progress._fields_[1:]]


def test_a_report_cannot_be_changed() -> None:
    with shapeop.Solver([[0, 0, 0]]) as solver:
        solver.add("Closeness", [0])
        solver.init()
        report = solver.solve_until()
    with pytest.raises(dataclasses.FrozenInstanceError):
        report.iterations = 3  # type: ignore[misc]
