"""Comparing numbers, with numpy or without."""

from __future__ import annotations

from typing import Any


def flat(values: Any) -> list[float]:
    """The numbers in nested lists or arrays."""
    if hasattr(values, "__len__"):
        return [number for value in values for number in flat(value)]
    return [float(values)]


def assert_near(found: Any, expected: Any, tolerance: float = 1e-12) -> None:
    """Each number within `tolerance`, absolutely, and as many of them."""
    a, b = flat(found), flat(expected)
    assert len(a) == len(b), (found, expected)
    assert all(abs(x - y) <= tolerance for x, y in zip(a, b)), (found, expected)
