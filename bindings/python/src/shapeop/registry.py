"""The constraint types that the library has."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum
from functools import cache
from types import MappingProxyType
from typing import Any, Optional

from . import _abi
from ._library import check, lib, text


class Projection(IntEnum):
    """What a type promises of its projection."""

    NEAREST = _abi.SO_PROJECTION_NEAREST
    """The nearest feasible configuration: plain iterations never raise the energy."""
    FEASIBLE = _abi.SO_PROJECTION_FEASIBLE
    """A feasible configuration, not always the nearest."""
    APPROXIMATE = _abi.SO_PROJECTION_APPROXIMATE
    """A step towards a feasible configuration."""


@dataclass(frozen=True)
class Scalar:
    """One scalar of a constraint type."""

    name: str
    """Its name, ending in its unit unless it is in model units or has none."""
    default: Optional[float]
    """``None`` where the points at creation decide."""


@dataclass(frozen=True)
class ConstraintType:
    """A constraint type."""

    name: str
    """The name that :meth:`Solver.add` takes."""
    help: str
    """One line about it."""
    least_indices: int
    """The least number of point indices."""
    greatest_indices: Optional[int]
    """The greatest number of point indices; ``None`` for any."""
    index_names: tuple[str, ...]
    """What the indices mean, such as "apex"; the last stands for all that follow."""
    scalars: tuple[Scalar, ...]
    """Its scalars; empty for types that cannot be edited and for those that take shapes."""
    takes_shapes: bool
    """Whether its scalars are shapes: x y z of each point of each shape."""
    projection: Projection
    """What its projection promises."""
    is_centred: bool
    """Whether it sees its points only relative to their mean, so that alone it leaves translations free."""
    energy_scale_power: int
    """The power of the model's scale with which its energy grows."""
    violation_unit: str
    """The unit of its violation, such as "model units" or "rad"."""
    edited_as: Optional[str]
    """Another type's name that :meth:`Solver.edit` takes for it too."""

    @property
    def is_editable(self) -> bool:
        """Whether :meth:`Solver.edit` takes it."""
        return self.takes_shapes or len(self.scalars) > 0


def constraint_types() -> MappingProxyType[str, ConstraintType]:
    """The constraint types by name, in the library's order."""
    return _constraint_types()


@cache
def _constraint_types() -> MappingProxyType[str, ConstraintType]:
    types = map(_constraint_type, range(lib.shapeop_constraintTypeCount()))
    return MappingProxyType({one.name: one for one in types})


def _constraint_type(index: int) -> ConstraintType:
    told = _sized(_abi.shapeop_constraint_type)
    check(lib.shapeop_constraintType(index, ctypes.byref(told)))
    return ConstraintType(
        name=text(told.name),
        help=text(told.help),
        least_indices=told.least_indices,
        greatest_indices=None if told.greatest_indices < 0 else told.greatest_indices,
        index_names=tuple(text(lib.shapeop_constraintIndexName(index, i)) for i in range(told.index_name_count)),
        scalars=tuple(_scalar(index, i) for i in range(told.scalar_count)),
        takes_shapes=told.scalar_count < 0,
        projection=Projection(told.projection),
        is_centred=bool(told.is_centred),
        energy_scale_power=told.energy_scale_power,
        violation_unit=text(told.violation_unit),
        edited_as=text(told.edited_as) or None,
    )


def _scalar(index: int, scalar_index: int) -> Scalar:
    told = _sized(_abi.shapeop_constraint_scalar)
    check(lib.shapeop_constraintScalar(index, scalar_index, ctypes.byref(told)))
    return Scalar(text(told.name), told.default_value if told.has_default else None)


def _sized(struct: Any) -> Any:
    return struct(struct_size=ctypes.sizeof(struct))
