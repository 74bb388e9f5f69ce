"""Set-up of the packaging's tests: where the modules are, and the public Grasshopper files to compare with."""

from __future__ import annotations

import os
import sys
import zipfile
from pathlib import Path
from typing import Dict

import pytest

PACKAGING = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PACKAGING))

WHEELS = ("compas", "compas_fab", "ladybug_grasshopper")


@pytest.fixture(scope="session")
def public_files() -> Dict[str, bytes]:
    """The `.ghuser` and `.gh` files of three public wheels, by `wheel/path`."""
    folder = os.environ.get("SHAPEOP_GH_FILES")
    found: Dict[str, bytes] = {}
    wheels = sorted(Path(folder).glob("*.whl")) if folder else []
    for path in wheels:
        with zipfile.ZipFile(path) as wheel:
            for name in wheel.namelist():
                if name.endswith((".ghuser", ".gh")):
                    found["%s/%s" % (path.name.split("-")[0], name)] = wheel.read(name)
    missing = [w for w in WHEELS if not any(name.startswith(w + "/") for name in found)]
    if missing:
        reason = "SHAPEOP_GH_FILES is %r: no wheel of %s there; nothing is compared with public Grasshopper files"
        reason = reason % (folder, ", ".join(missing))
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return found


@pytest.fixture
def say(capsys):
    """Prints past pytest's capture, so that counts are seen in the log."""

    def print_line(line: str) -> None:
        with capsys.disabled():
            print("\n  " + line, end="")

    return print_line
