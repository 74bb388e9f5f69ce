"""The programs in README.md, docs/python.md and docs/from-compas-shapeop.md run as they stand."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
DOCUMENTS = [ROOT / "bindings/python/README.md", ROOT / "docs/python.md", ROOT / "docs/from-compas-shapeop.md"]


def programs(document: Path) -> list[str]:
    """The Python programs in a document."""
    return re.findall(r"^```python\n(.*?)^```", document.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


CASES = [(document.name, i, text) for document in DOCUMENTS for i, text in enumerate(programs(document))]


def run(program: str, folder: Path) -> str:
    for package in ("compas", "numpy", "meshio", "trimesh"):
        if f"import {package}" in program or f"from {package}" in program:
            pytest.importorskip(package)
    shutil.copy(ROOT / "examples/meshes/tubemesh.obj", folder / "roof.obj")
    shutil.copy(ROOT / "examples/hanging_cloth.json", folder / "cloth.json")
    command = [sys.executable, "-W", "error", "-c", program]
    told = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    assert told.returncode == 0, told.stderr
    return told.stdout


@pytest.mark.parametrize(("name", "number", "program"), CASES, ids=[f"{name} {i}" for name, i, _ in CASES])
def test_every_program_in_the_documents_runs(name: str, number: int, program: str, tmp_path: Path) -> None:
    run(program, tmp_path)


def test_the_first_script_of_the_readme_planarises_a_compas_mesh_from_a_file(tmp_path: Path) -> None:
    datastructures = pytest.importorskip("compas.datastructures")
    import shapeop

    script = programs(DOCUMENTS[0])[0]
    assert len(script.strip().splitlines()) <= 10
    told = run(script, tmp_path)
    found = re.fullmatch(r"CONVERGED after \d+ iterations; worst face ([\d.]+)%\n", told)
    assert found, told
    before, after = (datastructures.Mesh.from_obj(tmp_path / name) for name in ("roof.obj", "planar.obj"))
    worst = [100 * max(shapeop.measure_faces("planarity", mesh)) for mesh in (before, after)]
    assert worst[0] > 9
    assert float(found[1]) < worst[0] / 10
    # The file has three decimals.
    assert abs(worst[1] - float(found[1])) < 0.5
