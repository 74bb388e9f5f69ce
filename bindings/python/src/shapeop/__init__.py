"""shapeop: shapes that meet geometric constraints.

Points, and constraints on them: these faces planar, these edges of one length, this point here. The solver finds the
shape that meets them as well as possible.
"""

from ._library import (
    LIBRARY_PATH,
    ArgumentError,
    ArgumentTypeError,
    BusyError,
    ClosedError,
    Error,
    ErrorCode,
    IndexRangeError,
    InvalidValueError,
    LoadError,
    NotInitialisedError,
    UnboundedError,
    UnknownIdError,
    version,
)
from .report import Acceleration, LinearSolver, Outcome, Progress, Report
from .solver import Solver

__version__ = version()

__all__ = [
    "LIBRARY_PATH",
    "Acceleration",
    "ArgumentError",
    "ArgumentTypeError",
    "BusyError",
    "ClosedError",
    "Error",
    "ErrorCode",
    "IndexRangeError",
    "InvalidValueError",
    "LinearSolver",
    "LoadError",
    "NotInitialisedError",
    "Outcome",
    "Progress",
    "Report",
    "Solver",
    "UnboundedError",
    "UnknownIdError",
    "version",
]
