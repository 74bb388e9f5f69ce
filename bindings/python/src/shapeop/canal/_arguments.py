"""From Python values to what the library takes, and progress."""

from __future__ import annotations

from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import CallWatch
from .._calls import doubles as _doubles
from .._calls import ints as _ints
from .._calls import optional_vector as _optional
from .._calls import vector as _vector
from .._library import ArgumentError
from ._kinds import ProgressFunction, Wraps

__all__ = [
    "_Grid",
    "_Watch",
    "_circles",
    "_doubles",
    "_frame",
    "_ints",
    "_of_length",
    "_optional",
    "_truths",
    "_vector",
]


def _truths(values: Any) -> list[bool]:
    return [bool(value) for value in values]


def _of_length(values: Any, name: str, count: int) -> Any:
    block = _arrays.numbers(values, name)
    if block.length != count:
        raise ArgumentError(f"{name}: expected {count} numbers, found {block.length}")
    return block.pointer


def _frame(value: Any, name: str = "frame") -> Any:
    rows = [list(row) for row in value]
    if len(rows) not in (2, 3) or any(len(row) != 3 for row in rows):
        raise ArgumentError(f"{name}: expected the tangents t1 and t2, found {_arrays.found(value)}")
    return _arrays.numbers([float(number) for row in rows[:2] for number in row], name).pointer


def _circles(values: Any, name: str) -> _arrays.Block:
    rows = [[float(number) for number in row] for row in values]
    if any(len(row) != 7 for row in rows):
        raise ArgumentError(f"{name}: expected 7 numbers for each circle, found {_arrays.found(values)}")
    return _arrays.Block(_arrays.numbers([number for row in rows for number in row], name).pointer, len(rows))


class _Grid:
    """A grid in the library's layout."""

    def __init__(self, values: Any, wraps: Wraps) -> None:
        if _arrays.is_array(values):
            if values.ndim != 3 or values.shape[2] != 3:
                raise ArgumentError(f"grid: expected shape (rows, columns, 3), found {_arrays.found(values)}")
            self.rows, self.columns = int(values.shape[0]), int(values.shape[1])
            flat = values.reshape(-1, 3)
        else:
            lists = [list(row) for row in values]
            self.rows, self.columns = len(lists), len(lists[0]) if lists else 0
            if any(len(row) != self.columns for row in lists):
                raise ArgumentError("grid: expected rows of one length")
            flat = [point for row in lists for point in row]
        self._points = _arrays.points(flat, "grid")
        self.wraps = [_arrays.truth(wrap, "wraps") for wrap in wraps]
        self.bits = int(self.wraps[0]) | int(self.wraps[1]) << 1
        self.arguments = (self._points.pointer, self.rows, self.columns, self.bits)
        self.count = self.rows * self.columns
        self.spans = (self.rows - 1 + self.wraps[0], self.columns - 1 + self.wraps[1])

    def shaped(self, values: Any) -> Any:
        return _arrays.shaped(values, self.rows, self.columns, 3)

    def axes(self, values: Any) -> Any:
        other = _Grid(values, (False, False))
        if (other.rows, other.columns) != (self.rows, self.columns):
            raise ArgumentError(f"axes: expected shape ({self.rows}, {self.columns}, 3), found {_arrays.found(values)}")
        return other._points.pointer


class _Watch(CallWatch):
    """From the library's progress callback to the caller's, which is told the part done."""

    def __init__(self, progress: Optional[ProgressFunction]) -> None:
        super().__init__(_abi.shapeop_canal_progress_callback, progress, lambda told: told.fraction)
