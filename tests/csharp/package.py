"""Looks into the NuGet package in a folder, then runs a program on it with Mono: python package.py FOLDER PROGRAM.exe

The program lies beside the unpacked assembly, and nothing but the package's layout says where the native library is.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

NUSPEC = "{http://schemas.microsoft.com/packaging/2013/05/nuspec.xsd}"
TYPES = "{http://schemas.openxmlformats.org/package/2006/content-types}"


def check(package: zipfile.ZipFile) -> None:
    """What NuGet reads: the manifest at the root, a type for every file, the readme that the manifest names."""
    names = package.namelist()
    manifest = ElementTree.fromstring(package.read("ShapeOp.nuspec"))
    values = {element.tag.replace(NUSPEC, ""): element.text for element in manifest[0]}
    assert values["id"] == "ShapeOp" and values["license"] == "MIT OR Apache-2.0", values
    assert Path(package.filename).name == "ShapeOp.%s.nupkg" % values["version"], (package.filename, values)
    assert values["readme"] in names, values
    types = ElementTree.fromstring(package.read("[Content_Types].xml"))
    endings = {each.get("Extension") for each in types.iter(TYPES + "Default")}
    overrides = {each.get("PartName") for each in types.iter(TYPES + "Override")}
    untyped = [n for n in names if Path(n).suffix[1:] not in endings and "/" + n not in overrides]
    assert untyped == ["[Content_Types].xml"] or not untyped, untyped
    documentation = ElementTree.fromstring(package.read("lib/netstandard2.0/ShapeOp.xml"))
    documented = {each.get("name") for each in documentation.iter("member")}
    assert "T:ShapeOp.Solver" in documented and len(documented) > 100, len(documented)
    assert any(name.startswith("runtimes/") and "/native/" in name for name in names), names


def main() -> int:
    """Checks and runs; the program's exit status."""
    packages, program = map(Path, sys.argv[1:])
    (package,) = packages.glob("*.nupkg")
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(package) as unpacked:
        check(unpacked)
        unpacked.extractall(folder)
        beside = shutil.copy(program, Path(folder) / "lib/netstandard2.0")
        elsewhere = ("SHAPEOP_LIBRARY", "LD_LIBRARY_PATH")
        environment = {key: value for key, value in os.environ.items() if key not in elsewhere}
        return subprocess.run(["mono", beside], env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
