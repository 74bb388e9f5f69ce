"""The kinds of meshes that recipes take: arrays, and the meshes of COMPAS, meshio and trimesh."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional

from . import _arrays
from ._library import ArgumentError, ArgumentTypeError

if TYPE_CHECKING:
    from ._arrays import Doubles


class View(NamedTuple):
    """A mesh as the library sees it."""

    points: Any
    """(n, 3) coordinates."""
    faces: Any
    """Index lists, or an (m, k) array."""
    indices_of: Callable[[Any], Any]
    """From the names that the mesh has for its points to their indices."""
    with_points: Callable[[Doubles], Any]
    """A mesh of the same kind with other points."""


def view(mesh: Any, faces: Optional[Any] = None) -> View:
    """The points and faces of a mesh, or of ``mesh`` as points with ``faces``."""
    if faces is not None:
        return View(mesh, faces, _same, _same)
    for module, name, read in (
        ("compas.datastructures", "Mesh", _compas),
        ("meshio", "Mesh", _meshio),
        ("trimesh", "Trimesh", _trimesh),
    ):
        # Whoever has such a mesh has imported its module.
        kind = getattr(sys.modules.get(module), name, None)
        if kind is not None and isinstance(mesh, kind):
            return read(mesh)
    expected = "a mesh of compas, meshio or trimesh, or points together with faces"
    raise ArgumentTypeError(f"mesh: expected {expected}, found {_arrays.found(mesh)}")


def _same(value: Any) -> Any:
    return value


def _compas(mesh: Any) -> View:
    keys = list(mesh.vertices())
    index = {key: i for i, key in enumerate(keys)}
    faces = [[index[key] for key in mesh.face_vertices(face)] for face in mesh.faces()]

    def indices_of(names: Any) -> list[int]:
        try:
            return [index[name] for name in names]
        except KeyError as error:
            raise ArgumentError(f"anchors: expected vertex keys of the mesh, found {error}") from None

    def with_points(points: Any) -> Any:
        changed = mesh.copy()
        for key, (x, y, z) in zip(keys, points):
            changed.vertex_attributes(key, "xyz", (float(x), float(y), float(z)))
        return changed

    return View([mesh.vertex_coordinates(key) for key in keys], faces, indices_of, with_points)


_LINEAR_CELLS = ("triangle", "quad", "polygon")
"""What the names of meshio's flat cells begin with, up to the number of corners."""


def _meshio(mesh: Any) -> View:
    faces: list[Sequence[int]] = []
    for block in mesh.cells:
        if block.dim > 1:
            if block.type.rstrip("0123456789") not in _LINEAR_CELLS or block.type in ("triangle6", "triangle7"):
                raise ArgumentError(f"mesh: expected triangles, quads and polygons, found cells of type {block.type!r}")
            faces.extend(block.data.tolist())

    def with_points(points: Any) -> Any:
        changed = mesh.copy()
        changed.points = points
        return changed

    return View(mesh.points, faces, _same, with_points)


def _trimesh(mesh: Any) -> View:
    def with_points(points: Any) -> Any:
        changed = mesh.copy()
        changed.vertices = points
        return changed

    return View(_arrays.numpy.asarray(mesh.vertices), _arrays.numpy.asarray(mesh.faces), _same, with_points)
