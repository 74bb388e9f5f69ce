"""Calls that fill arrays and tell of their progress, as functions on surfaces, ruled strips and snakes do."""

from __future__ import annotations

import ctypes
import signal
import threading
from typing import Any, Callable, Optional

from . import _arrays
from ._library import check, check_message, text


def doubles(count: int) -> Any:
    """Room for so many numbers."""
    return (ctypes.c_double * max(count, 0))()


def ints(count: int) -> Any:
    """Room for so many integers."""
    return (ctypes.c_int * max(count, 0))()


def vector(value: Any, name: str) -> Any:
    """A pointer to three numbers."""
    return _arrays.vector(value, name).pointer


def optional_vector(value: Any, name: str) -> Any:
    """A pointer to three numbers, or ``None``."""
    return None if value is None else vector(value, name)


def sized(room: Callable[[int], Any], unit: int, call: Callable[[Any, int, Any], int]) -> Any:
    """What a call writes that takes room, its capacity and a place for the count: ``unit`` numbers for each result."""
    count = ctypes.c_int()
    check(call(None, 0, ctypes.byref(count)))
    values = room(unit * count.value)
    check(call(values, count.value, ctypes.byref(count)))
    return values


def integers(values: Any, *shape: int) -> Any:
    """Integers that the library filled into a ctypes array, as an array of a shape, or nested lists."""
    if _arrays.numpy is not None:
        return _arrays.numpy.array(values[:], dtype=_arrays.numpy.int32).reshape(shape)
    nested: Any = list(values)
    for length in reversed(shape[1:]):
        nested = [nested[i : i + length] for i in range(0, len(nested), length)]
    return nested


def struct(kind: Any) -> Any:
    """A struct of the library with its size."""
    return kind(struct_size=ctypes.sizeof(kind))


def set_options(options: Any, given: dict[str, Any]) -> Any:
    """Sets the fields of a struct whose values are given, by their kind: a truth, an integer or a number."""
    kinds = dict(options._fields_)
    for name, value in given.items():
        if value is None:
            continue
        if isinstance(value, bool):
            setattr(options, name, int(value))
        elif kinds[name] is ctypes.c_double:
            setattr(options, name, _arrays.real(value, name))
        else:
            setattr(options, name, _arrays.integer(value, name))
    return options


def told_text(value: Optional[bytes]) -> str:
    """A text, which the library refuses by none."""
    if value is None:
        check_message()
    return text(value)


class CallWatch:
    """From a progress callback of the library to the caller's: no exception crosses over; Ctrl-C ends the call.

    ``told`` makes of the struct that the library tells what the caller's function is called with.
    """

    def __init__(self, callback: Any, progress: Optional[Callable[[Any], object]], told: Callable[[Any], Any]) -> None:
        self._progress = progress
        self._told = told
        self._error: Optional[BaseException] = None
        self._interrupted = False
        self._handler: Any = None
        self.callback: Any = callback(self._called)

    def __enter__(self) -> CallWatch:
        if threading.current_thread() is threading.main_thread() and callable(signal.getsignal(signal.SIGINT)):
            self._handler = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.callback = None
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
        if error is None and self._error is not None:
            raise self._error
        if error is None and self._interrupted:
            raise KeyboardInterrupt

    def _note(self, number: int, frame: Any) -> None:
        self._interrupted = True

    def _called(self, told: Any, _user: Optional[int]) -> int:
        try:
            if self._interrupted:
                return 1
            answer = None if self._progress is None else self._progress(self._told(told.contents))
            return int(answer is not None and not answer)
        except BaseException as error:
            self._error = error
            return 1
