"""The interactive example, without a window: its handle is dragged, the mesh follows, a picture is written."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("numpy")
pytest.importorskip("polyscope")

# Polyscope is initialised once per process.
PROGRAM = """
import json, sys
import polyscope as ps
try:
    ps.set_allow_headless_backends(True)
    ps.init("openGL3_egl")
except Exception as error:
    print("no EGL:", error)
    sys.exit(77)
sys.path.insert(0, sys.argv[1])
import interactive
import numpy as np
first, _ = interactive.read_obj(interactive.Path(sys.argv[2]))
session = interactive.main([sys.argv[2], "--picture", sys.argv[3], "--frames", "30"])
moved = session.points[session.handles] - first[session.handles]
size = float(np.linalg.norm(np.ptp(first, axis=0)))
buffer = ps.screenshot_to_buffer(False)
print(json.dumps({"moved": (moved / size).tolist(), "worst": float(session.planarity.max()),
                  "colours": len(np.unique(buffer.reshape(-1, buffer.shape[-1]), axis=0))}))
"""


def test_a_dragged_handle_takes_the_mesh_along_and_its_faces_stay_planar(meshes: Path, tmp_path: Path) -> None:
    picture = tmp_path / "picture.png"
    examples = Path(__file__).resolve().parents[1] / "examples"
    command = [sys.executable, "-c", PROGRAM, str(examples), str(meshes / "hypar.obj"), str(picture)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    if run.returncode == 77:
        pytest.skip(run.stdout.strip().splitlines()[-1])
    assert run.returncode == 0, run.stderr
    told = json.loads(run.stdout.strip().splitlines()[-1])
    # The first handle went up by a fifth of the mesh's size, the others stayed.
    dragged, *others = told["moved"]
    assert dragged == pytest.approx([0, 0, 0.2], abs=2e-3)
    assert all(other == pytest.approx([0, 0, 0], abs=2e-3) for other in others)
    assert told["worst"] < 0.01
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert told["colours"] > 50
