"""From the library's progress callback to the caller's function: no exception crosses the C boundary."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any, Callable, Optional

from . import _abi
from .report import Progress

ProgressFunction = Callable[[Progress], object]
"""Called after every iteration; ``False`` (or anything false but ``None``) ends the solve."""


class Watch:
    """Watches over one solve.

    It is a context manager around the call, which gets its ``callback``. At the end it raises what went wrong in the
    meantime: an exception of the progress function, or Ctrl-C. Python would raise KeyboardInterrupt on entry to the
    callback, outside any ``try``, where ctypes prints and forgets it; so as long as the library runs a handler of our
    own notes Ctrl-C, and at the end hands it to the handler that was there before.
    """

    def __init__(self, progress: Optional[ProgressFunction]) -> None:
        self.callback: Any = _abi.shapeop_progress_callback(self._called)
        self._progress = progress
        self._error: Optional[BaseException] = None
        self._interrupt: Optional[tuple[int, Optional[FrameType]]] = None
        self._handler: Any = None
        self._is_in_progress = False

    def __enter__(self) -> Watch:
        if threading.current_thread() is threading.main_thread():
            handler = signal.getsignal(signal.SIGINT)
            if callable(handler):
                try:
                    signal.signal(signal.SIGINT, self._note)
                    self._handler = handler
                except ValueError:  # a subinterpreter: signals are not its business
                    pass
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.callback = None  # it refers to this object
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
        if error is not None:
            return
        if self._error is not None:
            try:
                raise self._error
            finally:
                self._error = None
        if self._interrupt is not None:
            self._handler(*self._interrupt)

    def _note(self, number: int, frame: Optional[FrameType]) -> None:
        if self._is_in_progress:
            self._handler(number, frame)
        else:
            self._interrupt = (number, frame)

    def _called(self, progress: Any, _user: Optional[int]) -> int:
        try:
            if self._interrupt is not None:
                return 1
            if self._progress is None:
                return 0
            told = progress.contents
            self._is_in_progress = True
            answer = self._progress(Progress(told.iteration, told.energy, told.largest_move))
            return int(answer is not None and not answer)
        except BaseException as error:
            self._error = error
            return 1
        finally:
            self._is_in_progress = False
