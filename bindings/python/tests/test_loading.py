"""Which library is loaded, and that another ABI is refused."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import shapeop
from shapeop import _abi, _library


def run(program: str, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **variables}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def test_the_environment_variable_overrides_the_bundled_library(tmp_path: Path) -> None:
    copy = tmp_path / ("copy of " + shapeop.LIBRARY_PATH.name)
    shutil.copy(shapeop.LIBRARY_PATH, copy)
    told = run("import shapeop; print(shapeop.LIBRARY_PATH)", SHAPEOP_LIBRARY=str(copy))
    assert (told.stdout.strip(), told.stderr) == (str(copy.resolve()), "")


def test_a_missing_library_is_named_with_its_variable(tmp_path: Path) -> None:
    missing = str(tmp_path / "no.so")
    told = run("import shapeop", SHAPEOP_LIBRARY=missing)
    assert told.returncode != 0
    assert "LoadError" in told.stderr
    assert f"SHAPEOP_LIBRARY names, found no file {missing}" in told.stderr


def test_a_file_that_is_no_library_is_refused(tmp_path: Path) -> None:
    text = tmp_path / "text.so"
    text.write_text("no library")
    with pytest.raises(shapeop.LoadError, match=r"text\.so, but it cannot be loaded"):
        _library.load(text)


@pytest.mark.skipif(sys.platform == "win32", reason="no library is found that has the name on every Windows")
def test_another_library_is_refused() -> None:
    name = "/usr/lib/libSystem.B.dylib" if sys.platform == "darwin" else "libc.so.6"
    with pytest.raises(shapeop.LoadError, match="found one without shapeop_abiVersion"):
        _library.load(name)


def test_another_abi_version_is_refused_with_both_numbers_and_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    found = _abi.ABI_VERSION
    monkeypatch.setattr(_abi, "ABI_VERSION", found + 41)
    with pytest.raises(shapeop.LoadError) as caught:
        _library.load(shapeop.LIBRARY_PATH)
    assert str(caught.value) == f"expected ABI version {found + 41}, found {found} in {shapeop.LIBRARY_PATH}"
    assert isinstance(caught.value, ImportError)


def test_the_version_is_the_crate_s(repository: Path) -> None:
    lines = (repository / "Cargo.toml").read_text(encoding="utf-8").splitlines()
    assert f'version = "{shapeop.__version__}"' in lines


def test_everything_that_needs_no_numpy_works_without(repository: Path) -> None:
    names = ("solver", "mistakes", "threads", "problem", "recipes", "registry", "exploration")
    tests = [f"test_{name}.py" for name in names]
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests]
    environment = {**os.environ, "SHAPEOP_TEST_WITHOUT_NUMPY": "1"}
    folder = Path(__file__).parent
    told = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=folder)
    assert told.returncode == 0, told.stdout
    program = "import sys; sys.modules['numpy'] = None; import shapeop; print(type(shapeop.Solver([[0, 0, 0]]).points))"
    assert run(program).stdout.strip() == "<class 'list'>"
