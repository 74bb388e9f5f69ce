"""The library: where it is, whether it fits, its texts, and its refusals as exceptions."""

from __future__ import annotations

import ctypes
import os
import sys
from enum import IntEnum
from pathlib import Path
from typing import Any, Optional, Union

from . import _abi

LIBRARY_VARIABLE = "SHAPEOP_LIBRARY"
"""The environment variable that names a library file to load instead of the one in the package."""


class ErrorCode(IntEnum):
    """Why the library refused a call: ``shapeop_err`` of the C header."""

    INVALID_CONSTRAINT_TYPE = _abi.SO_INVALID_CONSTRAINT_TYPE
    INVALID_ARGUMENT_LENGTH = _abi.SO_INVALID_ARGUMENT_LENGTH
    UNMATCHING_CONSTRAINT_ID = _abi.SO_UNMATCHING_CONSTRAINT_ID
    INVALID_VALUE = _abi.SO_INVALID_VALUE
    INDEX_OUT_OF_RANGE = _abi.SO_INDEX_OUT_OF_RANGE
    UNMATCHING_FORCE_ID = _abi.SO_UNMATCHING_FORCE_ID
    NOT_INITIALISED = _abi.SO_NOT_INITIALISED
    UNBOUNDED = _abi.SO_UNBOUNDED
    BUSY = _abi.SO_BUSY
    INVALID_HANDLE = _abi.SO_INVALID_HANDLE
    NULL_POINTER = _abi.SO_NULL_POINTER
    INVALID_INPUT = _abi.SO_INVALID_INPUT
    TOO_LARGE = _abi.SO_TOO_LARGE
    INTERNAL = _abi.SO_INTERNAL
    NOT_GRID = _abi.SO_NOT_GRID
    NOT_PLANAR = _abi.SO_NOT_PLANAR
    NOT_CIRCULAR = _abi.SO_NOT_CIRCULAR
    DEGENERATE = _abi.SO_DEGENERATE
    NO_INTERSECTION = _abi.SO_NO_INTERSECTION
    NO_SOLUTION = _abi.SO_NO_SOLUTION
    SINGULAR = _abi.SO_SINGULAR
    NOT_CLOSED = _abi.SO_NOT_CLOSED
    NOT_MANIFOLD = _abi.SO_NOT_MANIFOLD
    CURVATURE_SIGN = _abi.SO_CURVATURE_SIGN
    NOT_ORIENTABLE = _abi.SO_NOT_ORIENTABLE
    INFEASIBLE = _abi.SO_INFEASIBLE
    OUT_OF_DOMAIN = _abi.SO_OUT_OF_DOMAIN
    BACKEND_UNAVAILABLE = _abi.SO_BACKEND_UNAVAILABLE
    BACKEND_FAILED = _abi.SO_BACKEND_FAILED


class Error(Exception):
    """The library refused a call, and changed nothing.

    ``code`` is an :class:`ErrorCode`, ``None`` if the library could not be loaded, a plain number if it is
    newer than this package and has one more.
    """

    def __init__(self, message: str, code: Optional[int] = None) -> None:
        super().__init__(message)
        self.code = code


class InvalidValueError(Error, ValueError):
    """A name, a count or a number does not fit."""


class UnknownIdError(Error, LookupError):
    """The id is no constraint of that type, or no force of that kind."""


class IndexRangeError(Error, IndexError):
    """A point index is out of range."""


class BusyError(Error, RuntimeError):
    """Another call is using the solver."""


class ClosedError(Error, RuntimeError):
    """The solver was closed."""


class NotInitialisedError(Error, RuntimeError):
    """Another call must come first: a solver's ``init()``, or one that finds what is to be told."""


class UnboundedError(Error, RuntimeError):
    """A force acts along a motion that no constraint resists."""


class BackendError(Error, RuntimeError):
    """There is no graphics card to solve on, or it was lost or refused work; ``code`` says which."""


class GeometryError(Error, ValueError):
    """The points are not what the construction needs, or it has no solution for them; ``code`` says which."""


class LoadError(Error, ImportError):
    """The library file is missing, cannot be loaded or has another ABI version."""


class ArgumentError(ValueError):
    """An argument has the wrong shape, length or size."""


class ArgumentTypeError(TypeError):
    """An argument is of the wrong type, or an array of the wrong dtype."""


_CLASSES: dict[int, type[Error]] = {
    ErrorCode.INVALID_CONSTRAINT_TYPE: InvalidValueError,
    ErrorCode.INVALID_ARGUMENT_LENGTH: InvalidValueError,
    ErrorCode.UNMATCHING_CONSTRAINT_ID: UnknownIdError,
    ErrorCode.INVALID_VALUE: InvalidValueError,
    ErrorCode.INDEX_OUT_OF_RANGE: IndexRangeError,
    ErrorCode.UNMATCHING_FORCE_ID: UnknownIdError,
    ErrorCode.NOT_INITIALISED: NotInitialisedError,
    ErrorCode.UNBOUNDED: UnboundedError,
    ErrorCode.BUSY: BusyError,
    ErrorCode.INVALID_HANDLE: ClosedError,
    ErrorCode.INVALID_INPUT: InvalidValueError,
    ErrorCode.NOT_GRID: GeometryError,
    ErrorCode.NOT_PLANAR: GeometryError,
    ErrorCode.NOT_CIRCULAR: GeometryError,
    ErrorCode.DEGENERATE: GeometryError,
    ErrorCode.NO_INTERSECTION: GeometryError,
    ErrorCode.NO_SOLUTION: GeometryError,
    ErrorCode.SINGULAR: GeometryError,
    ErrorCode.NOT_CLOSED: GeometryError,
    ErrorCode.NOT_MANIFOLD: GeometryError,
    ErrorCode.CURVATURE_SIGN: GeometryError,
    ErrorCode.NOT_ORIENTABLE: GeometryError,
    ErrorCode.INFEASIBLE: GeometryError,
    ErrorCode.OUT_OF_DOMAIN: GeometryError,
    ErrorCode.BACKEND_UNAVAILABLE: BackendError,
    ErrorCode.BACKEND_FAILED: BackendError,
}


def refusal(code: int, message: str) -> Error:
    """The exception for an error code of the library; the code may be one that is newer than this package."""
    try:
        code = ErrorCode(code)
    except ValueError:
        return Error(message, code)
    return _CLASSES.get(code, Error)(message, code)


def file_name() -> str:
    """The name that cargo gives the library on this platform."""
    if sys.platform == "win32":
        return "shapeop.dll"
    return "libshapeop.dylib" if sys.platform == "darwin" else "libshapeop.so"


def find() -> Path:
    """The library file to load."""
    named = os.environ.get(LIBRARY_VARIABLE)
    path = Path(named) if named else Path(__file__).resolve().parent / file_name()
    if not path.is_file():
        where = f"the environment variable {LIBRARY_VARIABLE} names" if named else "the package should hold"
        raise LoadError(f"expected the library that {where}, found no file {path}")
    return path.resolve()


def load(path: Union[str, Path]) -> Any:
    """Loads and declares the library at ``path``, if it speaks the ABI version of this package."""
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise LoadError(f"expected a library in {path}, but it cannot be loaded: {error}") from error
    try:
        version = int(library.shapeop_abiVersion())
    except AttributeError as error:
        raise LoadError(f"expected the shapeop library in {path}, found one without shapeop_abiVersion") from error
    if version != _abi.ABI_VERSION:
        raise LoadError(f"expected ABI version {_abi.ABI_VERSION}, found {version} in {path}")
    _abi.declare(library)  # type: ignore[no-untyped-call]
    return library


LIBRARY_PATH: Path = find()
"""The library file that is in use."""

lib: Any = load(LIBRARY_PATH)


def text(value: Optional[bytes]) -> str:
    """A text of the library."""
    return (value or b"").decode()


def version() -> str:
    """The version of the library, such as ``0.1.0``."""
    return text(lib.shapeop_version())


def check(code: int, handle: Optional[int] = None) -> None:
    """Raises what the library refused, for functions that answer with an error code."""
    if code != _abi.SO_SUCCESS:
        raise refusal(code, text(lib.shapeop_lastError(handle)) or text(lib.shapeop_errorText(code)))


def check_message(handle: Optional[int] = None) -> None:
    """Raises what the library refused, for functions that answer without an error code."""
    check(lib.shapeop_lastErrorCode(handle), handle)
