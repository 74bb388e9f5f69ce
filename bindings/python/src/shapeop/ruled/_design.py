"""Designs of ruled strips, and what they are for other programs."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Optional, Union

from .. import _abi, _arrays
from .._calls import doubles, integers, ints, optional_vector, set_options, struct, told_text, vector
from .._library import ArgumentError, check, lib
from ._kinds import Axis, Plank, Planks, Rulings, StripMesh
from ._rhino import write
from ._strips import _Strips

_ALL = -1


class Design(_Strips):
    """A negatively curved mesh, strip boundaries across its asymptotic curves, and ruled strips between these.

    ``mesh``: a mesh of COMPAS, meshio or trimesh, or points together with ``faces``. ``family``: which of the two
    families of asymptotic curves rulings follow, along ``hint`` on the whole; :meth:`select_family` takes the other.
    Each step needs those before it and takes back those after it. It is deleted by :meth:`close`, at the end of a
    ``with`` block, or when nothing refers to it any more.

    >>> xs = [i / 8 - 1 for i in range(17)]
    >>> points = [[x, y, x * y] for y in xs for x in xs]
    >>> quads = [[17 * j + i, 17 * j + i + 1, 17 * j + i + 18, 17 * j + i + 17] for j in range(16) for i in range(16)]
    >>> design = Design(points, quads)
    >>> design.level_boundaries(4)
    >>> started = design.start(control_count=8)
    >>> optimised = design.optimise()
    >>> design.report().coverage > 0.995
    True
    """

    def __enter__(self) -> Design:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.ruled.Design, closed>"
        return f"<shapeop.ruled.Design of {len(self.boundary_pairs)} pairs of boundaries, {self.strip_count} strips>"

    def copy(self) -> Design:
        """Another design like this one, with all that was made of it."""
        design = Design.__new__(Design)
        design._open(lib.shapeop_ruledCopy(self._handle))
        return design

    def _mesh(self, function: Any, corners: int, *how: Any) -> StripMesh:
        count, face_count = ctypes.c_int(), ctypes.c_int()
        counts = (ctypes.byref(count), ctypes.byref(face_count))
        check(function(self._handle, *how, None, None, 0, counts[0], None, None, 0, counts[1]))
        n, m = count.value, face_count.value
        points, normals, faces, strip_of = doubles(3 * n), doubles(3 * n), ints(corners * m), ints(m)
        check(function(self._handle, *how, points, normals, n, counts[0], faces, strip_of, m, counts[1]))
        shaped = (_arrays.shaped(points, n, 3), integers(faces, m, corners), _arrays.shaped(normals, n, 3))
        return StripMesh(*shaped, list(strip_of))

    def mesh(self, strip: Optional[int] = None, columns_per_span: int = 4, rows: int = 2) -> StripMesh:
        """A strip, or all, as a mesh of quads; strips share no points."""
        number = _ALL if strip is None else _arrays.integer(strip, "strip")
        how = (_arrays.integer(columns_per_span, "columns_per_span"), _arrays.integer(rows, "rows"))
        return self._mesh(lib.shapeop_ruledMesh, 4, number, *how)

    def trimmed_mesh(
        self, strip: Optional[int] = None, columns_per_span: int = 4, tolerance: float = 1e-7
    ) -> StripMesh:
        """What is left of a strip, or of all, within the boundary of the mesh, as triangles.

        ``tolerance``: how far the cut may be from the boundary, as a part of the mesh's diagonal.
        """
        number = _ALL if strip is None else _arrays.integer(strip, "strip")
        how = (_arrays.integer(columns_per_span, "columns_per_span"), _arrays.real(tolerance, "tolerance"))
        return self._mesh(lib.shapeop_ruledTrimmedMesh, 3, number, *how)

    def rulings(self, count: int, strip: Optional[int] = None, trimmed: bool = True) -> Rulings:
        """``count`` rulings of a strip, or of each, evenly spread; what is left of them if they are ``trimmed``."""
        number = _ALL if strip is None else _arrays.integer(strip, "strip")
        how = (number, _arrays.integer(count, "count"), int(_arrays.truth(trimmed, "trimmed")))
        told = ctypes.c_int()
        check(lib.shapeop_ruledRulings(self._handle, *how, None, None, None, 0, ctypes.byref(told)))
        n = told.value
        ends, parameters, strip_of = doubles(6 * n), doubles(n), ints(n)
        check(lib.shapeop_ruledRulings(self._handle, *how, ends, parameters, strip_of, n, ctypes.byref(told)))
        return Rulings(_arrays.shaped(ends, n, 2, 3), _arrays.doubles(parameters), list(strip_of))

    def surfaces_obj(self) -> str:
        """The strips as B-spline surfaces of a Wavefront OBJ file, which CAD programs read."""
        return told_text(lib.shapeop_ruledSurfacesObj(self._handle))

    def to_3dm(self, path: Union[str, os.PathLike[str]], unit: str = "meters") -> None:
        """Writes the strips as NURBS surfaces of a Rhino file; it needs the package rhino3dm.

        ``unit`` is what a model unit is, by rhino3dm's name for it.
        """
        write(path, self.strips, unit)

    def rulings_obj(self, count: int) -> str:
        """Trimmed rulings, ``count`` of each strip, as lines of a Wavefront OBJ file."""
        return told_text(lib.shapeop_ruledRulingsObj(self._handle, _arrays.integer(count, "count")))

    def rulings_csv(self, count: int) -> str:
        """Trimmed rulings, ``count`` of each strip, as a table with their ends and lengths."""
        return told_text(lib.shapeop_ruledRulingsCsv(self._handle, _arrays.integer(count, "count")))

    def strip_axis(self, strip: int) -> Axis:
        """The axis that all rulings of a strip are most nearly orthogonal to, and the greatest angle by which not."""
        direction, deviation = doubles(3), ctypes.c_double()
        number = _arrays.integer(strip, "strip")
        check(lib.shapeop_ruledStripAxis(self._handle, number, direction, ctypes.byref(deviation)))
        return Axis(_arrays.doubles(direction), deviation.value)

    def planks(
        self,
        strip: int,
        thickness: float,
        *,
        depth: float = 0.0,
        axis: Optional[Any] = None,
        first_cut: Optional[float] = None,
        tolerance: Optional[float] = None,
    ) -> Planks:
        """Cuts a conoidal strip into planks of constant thickness across its axis.

        ``depth``: how far their long sides are beyond the rulings; ``first_cut``: ``axis . x`` of one of the cuts;
        ``tolerance``: the angle between rulings and planks that counts as none. :meth:`planks_svg` draws them.
        """
        options, told = struct(_abi.shapeop_ruled_plank_options), struct(_abi.shapeop_ruled_planks)
        check(lib.shapeop_ruledDefaultPlankOptions(ctypes.byref(options)))
        given = {"thickness": thickness, "depth": depth, "first_cut": first_cut, "tolerance": tolerance}
        set_options(options, {**given, "has_first_cut": first_cut is not None})
        how = (ctypes.byref(options), optional_vector(axis, "axis"), ctypes.byref(told))
        check(lib.shapeop_ruledCutPlanks(self._handle, _arrays.integer(strip, "strip"), *how))
        dowels = [self._doubles(lib.shapeop_ruledDowels, 3, side) for side in (0, 1)]
        shaped = [_arrays.shaped(points, len(points) // 3, 3) for points in dowels]
        return Planks(
            axis=(told.axis_x, told.axis_y, told.axis_z),
            thickness=told.thickness,
            deviation=told.deviation,
            stock_area=told.stock_area,
            offcut=told.offcut,
            planks=tuple(self._plank(i) for i in range(told.plank_count)),
            dowels=(shaped[0], shaped[1]),
            json=told_text(lib.shapeop_ruledPlanksText(self._handle)),
        )

    def _plank(self, index: int) -> Plank:
        told, frame, outline, rulings = struct(_abi.shapeop_ruled_plank), doubles(9), doubles(8), doubles(8)
        check(lib.shapeop_ruledPlank(self._handle, index, ctypes.byref(told), frame, outline, rulings))
        return Plank(
            heights=(told.lower, told.upper),
            filled=told.filled,
            parameters=(told.first_u, told.last_u),
            frame=_arrays.shaped(frame, 3, 3),
            outline=_arrays.shaped(outline, 4, 2),
            rulings=_arrays.shaped(rulings, 2, 2, 2),
            length=told.length,
            width=told.width,
            end_angles=(told.first_end_angle, told.second_end_angle),
            offcut=told.offcut,
        )

    def planks_svg(self, name: str, millimetres: float = 1000.0) -> str:
        """The planks that were cut last, drawn in true scale; ``millimetres`` are in a model unit."""
        title, scale = _arrays.name_bytes(name, "name"), _arrays.real(millimetres, "millimetres")
        return told_text(lib.shapeop_ruledPlanksSvg(self._handle, title, scale))


def zebra(
    points: Any,
    normals: Any,
    eye: Any,
    *,
    parallel: bool = False,
    direction: Any = (1.0, 0.0, 0.0),
    count: int = 24,
    turn: float = 0.0,
) -> Any:
    """What zebra stripes show at points of any surface, from -1, dark, to 1, light: reflections of light tubes.

    ``eye`` is a point, or with ``parallel`` the direction in which all eyes look; ``direction`` is that of the tubes,
    of which ``count`` are around a full turn, turned by ``turn``.
    """
    blocks = (_arrays.points(points), _arrays.points(normals, "normals"))
    if blocks[0].length != blocks[1].length:
        raise ArgumentError(f"normals: expected {blocks[0].length}, one for each point; found {blocks[1].length}")
    out = doubles(blocks[0].length)
    seen = (vector(eye, "eye"), int(_arrays.truth(parallel, "parallel")), vector(direction, "direction"))
    tubes = (_arrays.integer(count, "count"), _arrays.real(turn, "turn"))
    check(lib.shapeop_ruledZebra(blocks[0].pointer, blocks[1].pointer, blocks[0].length, *seen, *tubes, out))
    return _arrays.doubles(out)
