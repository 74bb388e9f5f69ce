"""Calls that fill arrays and tell of their progress, as functions on surfaces and ruled strips do."""

from __future__ import annotations

import ctypes
import signal
import threading
from typing import Any, Callable, Optional

from . import _arrays
from ._library import check


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
