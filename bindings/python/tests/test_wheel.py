"""The wheel: what is in it, what it is called, and what is said where it cannot be built."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

import shapeop

pytest.importorskip("hatchling")

PACKAGE = Path(__file__).resolve().parents[1]


@pytest.fixture
def hook() -> ModuleType:
    """hatch_build.py as a module."""
    spec = importlib.util.spec_from_file_location("hatch_build", PACKAGE / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_wheel_holds_the_library_and_suits_every_python_3(tmp_path: Path) -> None:
    environment = {**os.environ, "SHAPEOP_LIBRARY_TO_BUNDLE": str(shapeop.LIBRARY_PATH)}
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=PACKAGE, env=environment)
    assert run.returncode == 0, run.stderr
    (wheel,) = tmp_path.glob("*.whl")
    assert wheel.name.startswith(f"shapeop-{shapeop.__version__}-py3-none-")
    assert not wheel.name.endswith("-any.whl")
    with zipfile.ZipFile(wheel) as contents:
        names = set(contents.namelist())
        info = f"shapeop-{shapeop.__version__}.dist-info"
        licences = {f"{info}/licenses/LICENSE-{name}" for name in ("MIT", "APACHE", "THIRD-PARTY")}
        assert {"shapeop/py.typed"} | licences <= names
        assert contents.read(f"shapeop/{shapeop._library.file_name()}") == shapeop.LIBRARY_PATH.read_bytes()
        sources = {f"shapeop/{path.name}" for path in (PACKAGE / "src" / "shapeop").glob("*.py")}
        assert sources <= names
        assert "Root-Is-Purelib: false" in contents.read(f"{info}/WHEEL").decode()


def test_a_missing_cargo_is_named_with_the_remedies(
    hook: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("SHAPEOP_LIBRARY_TO_BUNDLE", raising=False)
    monkeypatch.delenv("CARGO", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(RuntimeError, match=r"cargo was not found.*https://rustup.rs.*SHAPEOP_LIBRARY_TO_BUNDLE"):
        hook.library(str(PACKAGE))


def test_missing_sources_are_named(hook: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("SHAPEOP_LIBRARY_TO_BUNDLE", raising=False)
    with pytest.raises(RuntimeError, match=r"expected the sources of the shapeop crate in .*found no Cargo\.toml"):
        hook.library(str(tmp_path))


def test_a_library_to_bundle_that_is_none_is_named(
    hook: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in (tmp_path / "no.so", PACKAGE / "README.md"):
        monkeypatch.setenv("SHAPEOP_LIBRARY_TO_BUNDLE", str(name))
        with pytest.raises(RuntimeError, match="expected SHAPEOP_LIBRARY_TO_BUNDLE to name a shared library"):
            hook.library(str(PACKAGE))


@pytest.mark.skipif(sys.platform == "win32", reason="the script that stands for cargo is one of a Unix shell")
def test_a_build_that_fails_is_an_error(hook: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cargo = tmp_path / "cargo"
    cargo.write_text("#!/bin/sh\nexit 101\n")
    cargo.chmod(0o755)
    monkeypatch.setenv("CARGO", str(cargo))
    with pytest.raises(RuntimeError, match=r"cargo build --release .* ended with 101"):
        hook.built(PACKAGE.parents[1])
