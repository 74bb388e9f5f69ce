"""What all tests use. With SHAPEOP_TEST_WITHOUT_NUMPY set, numpy cannot be imported."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

if os.environ.get("SHAPEOP_TEST_WITHOUT_NUMPY"):
    sys.modules["numpy"] = None  # type: ignore[assignment]

PACKAGE = Path(__file__).resolve().parents[1]
REPOSITORY = PACKAGE.parents[1]


@pytest.fixture
def repository() -> Path:
    """The repository's root."""
    return REPOSITORY


@pytest.fixture
def meshes() -> Path:
    """The folder of example meshes."""
    return REPOSITORY / "examples" / "meshes"
