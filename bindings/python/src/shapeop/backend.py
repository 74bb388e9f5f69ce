"""The graphics card that a solver may iterate on."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from . import _abi
from ._library import check, lib, text


class AdapterKind(IntEnum):
    """What kind of adapter it is, the fastest first."""

    DISCRETE = _abi.SO_ADAPTER_DISCRETE
    """A card with memory of its own."""
    INTEGRATED = _abi.SO_ADAPTER_INTEGRATED
    """A part of the processor that shares its memory."""
    VIRTUAL = _abi.SO_ADAPTER_VIRTUAL
    """A card that a virtual machine lends."""
    OTHER = _abi.SO_ADAPTER_OTHER
    """Not known."""
    SOFTWARE = _abi.SO_ADAPTER_SOFTWARE
    """A program that behaves like a card: for tests."""


class BackendInfo(NamedTuple):
    """The graphics card that iterates, and its limits."""

    kind: AdapterKind
    """Its kind."""
    group_count: int
    """Workgroups at most, in one dimension of a run."""
    buffer_bytes: int
    """Bytes of one buffer at most."""
    binding_bytes: int
    """Bytes of what one binding reaches at most; what is larger is split."""
    adapter: str
    """Its name."""
    api: str
    """The interface it is driven by, such as "vulkan"."""
    driver: str
    """The driver, and its version."""


def info_of(struct: _abi.shapeop_backend_info) -> BackendInfo:
    """The library's description as a :class:`BackendInfo`."""
    return BackendInfo(
        AdapterKind(struct.kind),
        struct.group_count,
        int(struct.buffer_bytes),
        int(struct.binding_bytes),
        text(struct.adapter),
        text(struct.api),
        text(struct.driver),
    )


def release_backend() -> None:
    """Gives the graphics card back, with all memory that solvers have on it: for a host that needs it.

    Solves that run on it end with ``Outcome.BACKEND_FAILED``, at the points of their last read-back; later ones open it
    again. Where there is nothing to give back, it does nothing.
    """
    check(lib.shapeop_releaseBackend())
