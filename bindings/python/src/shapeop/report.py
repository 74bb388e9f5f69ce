"""What a solve is told and what it answers."""

from __future__ import annotations

import dataclasses
from enum import IntEnum
from typing import NamedTuple

from . import _abi


class Outcome(IntEnum):
    """Why a solve ended."""

    CONVERGED = _abi.SO_OUTCOME_CONVERGED
    """The largest move fell below the tolerance."""
    ITERATION_LIMIT = _abi.SO_OUTCOME_ITERATION_LIMIT
    """The iterations were used up."""
    TIME_BUDGET = _abi.SO_OUTCOME_TIME_BUDGET
    """The time was used up."""
    CANCELLED = _abi.SO_OUTCOME_CANCELLED
    """The progress function said so."""
    STALLED = _abi.SO_OUTCOME_STALLED
    """Neither the energy nor the largest move fell any more."""
    UNBOUNDED = _abi.SO_OUTCOME_UNBOUNDED
    """A force acts along a motion that no constraint resists; the points did not move."""
    INFEASIBLE = _abi.SO_OUTCOME_INFEASIBLE
    """Hard constraints contradict each other: :meth:`Solver.conflicts` names a small set; the others are met."""
    BACKEND_FAILED = _abi.SO_OUTCOME_BACKEND_FAILED
    """The graphics card was lost or refused work; the points are those of ``read_back_iteration``."""


class Acceleration(IntEnum):
    """How iterations are accelerated."""

    NONE = _abi.SO_ACCELERATION_NONE
    """Not at all."""
    ANDERSON = _abi.SO_ACCELERATION_ANDERSON
    """Safeguarded Anderson acceleration."""
    QUASI_NEWTON = _abi.SO_ACCELERATION_QUASI_NEWTON
    """L-BFGS with the matrix of the global step as initial Hessian, and a line search."""
    AUTOMATIC = _abi.SO_ACCELERATION_AUTOMATIC
    """The default: none in ``solve``, quasi-Newton in ``solve_until``."""


class LinearSolver(IntEnum):
    """How the linear system of an iteration is solved."""

    AUTOMATIC = _abi.SO_LINEAR_SOLVER_AUTOMATIC
    """The default: a factor if it fits in memory, else conjugate gradients."""
    DIRECT = _abi.SO_LINEAR_SOLVER_DIRECT
    """A Cholesky factor, computed once and used in every iteration."""
    CONJUGATE_GRADIENTS = _abi.SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS
    """Conjugate gradients, preconditioned by multigrid."""


class Backend(IntEnum):
    """What carries out the iterations of a solve."""

    CPU = _abi.SO_BACKEND_CPU
    """The default: the processor, in double precision."""
    GPU = _abi.SO_BACKEND_GPU
    """The graphics card, in single precision; what a tolerance asks for beyond that the processor finishes."""
    AUTOMATIC = _abi.SO_BACKEND_AUTOMATIC
    """The card where there is one that is faster on the model at hand; else the processor."""


class Progress(NamedTuple):
    """What a progress function is told after every iteration."""

    iteration: int
    """Iterations made so far, from 1."""
    energy: float
    """The energy at the current points."""
    largest_move: float
    """The largest move of a point in this iteration, relative to the bounding-box diagonal."""


@dataclasses.dataclass(frozen=True)
class Report:
    """What a solve found."""

    outcome: Outcome
    """Why it ended."""
    iterations: int
    """Iterations made."""
    unconstrained_count: int
    """Points that no constraint of a weight above 0 holds."""
    energy_before: float
    """The energy at the points that the iterations started from."""
    energy_after: float
    """The energy at the points that were reached."""
    largest_move: float
    """The largest move of a point in the last iteration, relative to the bounding-box diagonal."""
    analysis_seconds: float
    """Seconds spent on ordering and symbolic analysis when the system in use was made."""
    factorisation_seconds: float
    """Seconds spent on the factorisation when the system in use was made."""
    local_seconds: float
    """Seconds spent on projections."""
    global_seconds: float
    """Seconds spent on right-hand sides, linear solves and acceleration."""
    evaluations: int
    """Local steps at points that were tried, kept or not."""
    rejected_energy_rose: int
    """Evaluations whose energy was higher than before, or not as much lower as the line search asks for."""
    rejected_not_finite: int
    """Evaluations whose energy was not finite."""
    rejected_ill_conditioned: int
    """Iterations in which acceleration left out a part of its history as ill-conditioned."""
    rejected_not_descent: int
    """Directions of acceleration that were not tried, as the energy would rise along them."""
    rejected_line_search: int
    """Directions of acceleration that were given up, as no step along them was accepted."""
    ordering_count: int
    """Orderings made since the solver was created."""
    factorisation_count: int
    """Numeric factorisations made since the solver was created."""
    linear_solver: LinearSolver
    """How linear systems were solved."""
    linear_iterations: int
    """Iterations of conjugate gradients; 0 with a factor."""
    backend: Backend
    """``GPU`` if the graphics card made any of the iterations, else ``CPU``."""
    gpu_iterations: int
    """Those of the iterations that the card made."""
    read_back_iteration: int
    """The iteration after which points were read back from the card last."""
    gpu_seconds: float
    """Seconds in which the card worked."""
    transfer_seconds: float
    """Seconds in which points went to the card and back."""
    backend_reason: str = ""
    """Why it ran on that backend."""
    message: str = ""
    """For ``Outcome.UNBOUNDED``: which point or component the force acts on; for ``Outcome.BACKEND_FAILED``: what
    happened to the card; else empty."""


def report_of(struct: _abi.shapeop_solve_report, backend_reason: str, message: str) -> Report:
    """The library's report as a :class:`Report`."""
    texts = ("backend_reason", "message")
    names = [field.name for field in dataclasses.fields(Report) if field.name not in texts]
    values = {name: getattr(struct, name) for name in names}
    values["outcome"] = Outcome(values["outcome"])
    values["linear_solver"] = LinearSolver(values["linear_solver"])
    values["backend"] = Backend(values["backend"])
    has_message = values["outcome"] in (Outcome.UNBOUNDED, Outcome.BACKEND_FAILED)
    return Report(**values, backend_reason=backend_reason, message=message if has_message else "")
