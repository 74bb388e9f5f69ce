"""shapeop: shapes that meet geometric constraints.

Points, and constraints on them: these faces planar, these edges of one length, this point here. The solver finds the
shape that meets them as well as possible.

Recipes make a problem from a mesh and solve it. The library names them (:func:`recipe_names`), and each is a function
here, such as ``shapeop.planarize(mesh)``.
"""

from . import canal, ruled, snakes
from ._library import (
    LIBRARY_PATH,
    ArgumentError,
    ArgumentTypeError,
    BackendError,
    BusyError,
    ClosedError,
    Error,
    ErrorCode,
    GeometryError,
    IndexRangeError,
    InvalidValueError,
    LoadError,
    NotInitialisedError,
    UnboundedError,
    UnknownIdError,
    version,
)
from .backend import AdapterKind, BackendInfo, release_backend
from .exploration import Exploration, Fairness, Sensitivities
from .problem import (
    Constraint,
    Edit,
    Force,
    Handle,
    Objective,
    Problem,
    ReferenceMesh,
    ReferencePolyline,
    Settings,
)
from .recipes import FairnessKind, Recipe, Result, measure_faces, measure_names, recipe, recipe_names
from .registry import ConstraintType, Projection, Scalar, constraint_types
from .report import Acceleration, Backend, LinearSolver, Outcome, Progress, Report
from .solver import Solver

__version__ = version()

__all__ = [
    "LIBRARY_PATH",
    "Acceleration",
    "AdapterKind",
    "ArgumentError",
    "ArgumentTypeError",
    "Backend",
    "BackendError",
    "BackendInfo",
    "BusyError",
    "ClosedError",
    "Constraint",
    "ConstraintType",
    "Edit",
    "Error",
    "ErrorCode",
    "Exploration",
    "Fairness",
    "FairnessKind",
    "Force",
    "GeometryError",
    "Handle",
    "IndexRangeError",
    "InvalidValueError",
    "LinearSolver",
    "LoadError",
    "NotInitialisedError",
    "Objective",
    "Outcome",
    "Problem",
    "Progress",
    "Projection",
    "Recipe",
    "ReferenceMesh",
    "ReferencePolyline",
    "Report",
    "Result",
    "Scalar",
    "Sensitivities",
    "Settings",
    "Solver",
    "UnboundedError",
    "UnknownIdError",
    "canal",
    "constraint_types",
    "measure_faces",
    "measure_names",
    "recipe",
    "recipe_names",
    "release_backend",
    "ruled",
    "snakes",
    "version",
]


def __getattr__(name: str) -> Recipe:
    """The recipes, under the names that the library has for them."""
    if name in recipe_names():
        found = Recipe(name)
        globals()[name] = found
        return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *recipe_names()})
