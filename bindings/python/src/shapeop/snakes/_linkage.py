"""Snakes as linkages, with hinges at their end arcs."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import set_options, struct, vector
from .._library import check, lib
from ._frames import Frames, control_points
from ._handle import Handle, watch
from ._kinds import CycleEnd, Motion, ProgressFunction
from ._snake import Snake


class Cycle(Frames):
    """The positions of a linkage on its way around; ``motion`` tells what was found of it."""

    motion: Motion

    def __enter__(self) -> Cycle:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.snakes.Cycle, closed>"
        return f"<shapeop.snakes.Cycle of {len(self)} positions, {self.motion.end.name}>"

    @property
    def is_closed(self) -> bool:
        """Whether the linkage came back to its start."""
        return self.motion.end is CycleEnd.CLOSED

    @property
    def angles(self) -> Any:
        """By how much the first and the last arc are turned at each position, (frames, 2)."""
        values = self._doubles(lib.shapeop_snakeCycleAngles, 2)
        return _arrays.shaped(values, len(values) // 2, 2)

    def contact_path(self, contact: int) -> Any:
        """The path of a contact point, one point for each position."""
        return self._points(lib.shapeop_snakeContactPath, _arrays.integer(contact, "contact"))

    def at_phases(self, phases: Any) -> Any:
        """The control points at phases of the motion, (phases, n, 3): 0 is the start, 1 the start again."""
        block = _arrays.numbers(phases, "phases")
        return control_points(self._doubles(lib.shapeop_snakeAtPhases, 3, *block), block.length, "phases")

    def copies(self, count: int, shift: float, offset: Any, phase: float = 0.0) -> Any:
        """Copies that move together, (count, n, 3).

        Each is ``shift`` later than the one before, and moved by ``offset`` from it.
        """
        number = _arrays.integer(count, "count")
        how = (number, _arrays.real(phase, "phase"), _arrays.real(shift, "shift"), vector(offset, "offset"))
        return control_points(self._doubles(lib.shapeop_snakeCopies, 3, *how), number, "count")


class Linkage(Handle):
    """An open snake whose end arcs turn about hinges, as its first two control points and its last two are fixed.

    One of six arcs can move in one way.
    """

    def __init__(self, snake: Snake) -> None:
        self._open(lib.shapeop_snakeCopy(snake._handle))
        if lib.shapeop_snakeLinkageFreedoms(self._handle) < 0:
            self._count(-1)

    def __enter__(self) -> Linkage:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.snakes.Linkage, closed>"
        return f"<shapeop.snakes.Linkage of {self.freedoms} freedoms>"

    @property
    def freedoms(self) -> int:
        """In how many independent ways it can move."""
        return self._count(lib.shapeop_snakeLinkageFreedoms(self._handle))

    @property
    def determinant(self) -> float:
        """The determinant of its hinges, of six arcs; near 0, it is in a singular position."""
        value = ctypes.c_double()
        check(lib.shapeop_snakeDeterminant(self._handle, ctypes.byref(value)))
        return value.value

    def cycle(
        self,
        *,
        step: Optional[float] = None,
        max_steps: Optional[int] = None,
        reversed: bool = False,
        progress: Optional[ProgressFunction] = None,
    ) -> Cycle:
        """Moves it until it is back where it began; in a step the driving arc turns by ``step``."""
        options = struct(_abi.shapeop_snake_cycle_options)
        check(lib.shapeop_snakeDefaultCycleOptions(ctypes.byref(options)))
        is_reversed = _arrays.truth(reversed, "reversed")
        set_options(options, {"step": step, "max_steps": max_steps, "is_reversed": is_reversed})
        told = struct(_abi.shapeop_snake_cycle)
        found = Cycle.__new__(Cycle)
        found._open(lib.shapeop_snakeCopy(self._handle))
        with watch(progress) as watching:
            answer = lib.shapeop_snakeCycle(
                found._handle, ctypes.byref(options), watching.callback, None, ctypes.byref(told)
            )
        check(answer)
        found.motion = Motion(
            end=CycleEnd(told.end),
            free=told.free,
            closing=None if told.closing < 0 else told.closing,
            ranges=(told.first_range, told.last_range),
            turns=(told.first_turns, told.last_turns),
            switch_count=told.switch_count,
            residual=told.residual,
        )
        return found
