"""A design's mesh and its asymptotic directions."""

from __future__ import annotations

import ctypes
import weakref
from typing import Any, Optional

from .. import _abi, _arrays, meshes
from .._calls import doubles, integers, ints, optional_vector, set_options, sized, struct, vector
from .._library import ClosedError, ErrorCode, check, check_message, lib, refusal
from ._kinds import Curvatures, Directions, Field, PointStatus, Trace, TraceEnd


class _Fields:
    """The mesh of a design, its directions, and the handle."""

    def __init__(
        self,
        mesh: Any,
        faces: Optional[Any] = None,
        *,
        family: int = 0,
        hint: Optional[Any] = None,
        allow_cut: bool = False,
        least_neighbours: Optional[int] = None,
        flatness: Optional[float] = None,
        max_mask: Optional[float] = None,
    ) -> None:
        view = meshes.view(mesh, faces)
        points, lists = _arrays.points(view.points), _arrays.face_lists(view.faces, "faces")
        options = struct(_abi.shapeop_ruled_options)
        check(lib.shapeop_ruledDefaultOptions(ctypes.byref(options)))
        given = {"least_neighbours": least_neighbours, "flatness": flatness, "max_mask": max_mask}
        set_options(options, {**given, "family": family, "allow_cut": _arrays.truth(allow_cut, "allow_cut")})
        if hint is not None:
            options.hint_x, options.hint_y, options.hint_z = vector(hint, "hint")[0:3]
        arrays = (*points, *lists.indices, *lists.counts)
        self._open(lib.shapeop_ruledCreate(*arrays, ctypes.byref(options)))

    def _open(self, handle: Optional[int]) -> None:
        if handle is None:
            check_message()
            raise refusal(ErrorCode.INTERNAL, "the library gave no handle")
        self._open_handle: Optional[int] = handle
        self._finalizer = weakref.finalize(self, lib.shapeop_ruledDelete, handle)

    @property
    def _handle(self) -> int:
        if self._open_handle is None:
            raise ClosedError("the design was closed", ErrorCode.INVALID_HANDLE)
        return self._open_handle

    def close(self) -> None:
        """Deletes the design; every later call raises :class:`shapeop.ClosedError`, except this one."""
        if self._open_handle is not None:
            lib.shapeop_ruledDelete(self._open_handle)
            check_message()
            self._open_handle = None
            self._finalizer.detach()

    def _count(self, number: int) -> int:
        if number < 0:
            check_message()
        return number

    def _doubles(self, function: Any, unit: int, *before: Any) -> Any:
        return sized(doubles, unit, lambda out, room, count: function(self._handle, *before, out, room, count))

    def _ints(self, function: Any, unit: int, *before: Any) -> Any:
        return sized(ints, unit, lambda out, room, count: function(self._handle, *before, out, room, count))

    def select_family(self, family: int, hint: Optional[Any] = None, allow_cut: bool = False) -> None:
        """Takes the directions of a family, 0 or 1, that point along ``hint`` on the whole.

        With ``allow_cut`` their signs may disagree across some edges (:attr:`flips`) if they must. Takes back
        boundaries and strips.
        """
        direction, cut = optional_vector(hint, "hint"), int(_arrays.truth(allow_cut, "allow_cut"))
        check(lib.shapeop_ruledSelectFamily(self._handle, _arrays.integer(family, "family"), direction, cut))

    @property
    def triangles(self) -> Any:
        """The triangles of the mesh, (m, 3)."""
        values = self._ints(lib.shapeop_ruledTriangles, 3)
        return integers(values, len(values) // 3, 3)

    @property
    def curvatures(self) -> Curvatures:
        """The curvature at each point."""
        principal = self._doubles(lambda *a: lib.shapeop_ruledCurvatures(a[0], a[1], None, None, *a[2:]), 2)
        n = len(principal) // 2
        directions, normals, count = doubles(6 * n), doubles(3 * n), ctypes.c_int()
        check(lib.shapeop_ruledCurvatures(self._handle, None, directions, normals, n, ctypes.byref(count)))
        shaped = (_arrays.shaped(directions, n, 2, 3), _arrays.shaped(normals, n, 3))
        return Curvatures(_arrays.shaped(principal, n, 2), *shaped)

    def directions(self, family: int) -> Directions:
        """The asymptotic directions of a family, 0 or 1."""
        number = _arrays.integer(family, "family")
        status = self._ints(lambda *a: lib.shapeop_ruledDirections(a[0], a[1], None, *a[2:]), 1, number)
        vectors, count = doubles(3 * len(status)), ctypes.c_int()
        room = (vectors, None, len(status), ctypes.byref(count))
        check(lib.shapeop_ruledDirections(self._handle, number, *room))
        return Directions(_arrays.shaped(vectors, len(status), 3), [PointStatus(state) for state in status])

    @property
    def field(self) -> Field:
        """The directions that rulings follow."""
        known = self._ints(lambda *a: lib.shapeop_ruledField(a[0], None, *a[1:]), 1)
        vectors, count = doubles(3 * len(known)), ctypes.c_int()
        check(lib.shapeop_ruledField(self._handle, vectors, None, len(known), ctypes.byref(count)))
        return Field(_arrays.shaped(vectors, len(known), 3), [bool(one) for one in known])

    @property
    def flips(self) -> list[tuple[int, int]]:
        """The edges across which the field changes its sign, each as two points."""
        values = self._ints(lib.shapeop_ruledFlips, 2)
        return list(zip(values[0::2], values[1::2]))

    def trace(self, seed: Any, length: float, step: float = 0.5, backward: bool = False) -> Trace:
        """The asymptotic curve from the point nearest to ``seed``, of ``length`` at most; a step is ``step`` edges."""
        end = ctypes.c_int()
        start, sense = vector(seed, "seed"), int(_arrays.truth(backward, "backward"))
        how = (start, sense, _arrays.real(step, "step"), _arrays.real(length, "length"))
        values = self._doubles(lambda *a: lib.shapeop_ruledTrace(*a, ctypes.byref(end)), 3, *how)
        return Trace(_arrays.shaped(values, len(values) // 3, 3), TraceEnd(end.value))
