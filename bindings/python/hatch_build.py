"""Builds the library with cargo and puts it into the wheel."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface
from packaging.tags import platform_tags

LIBRARY_VARIABLE = "SHAPEOP_LIBRARY_TO_BUNDLE"
"""The environment variable that names a library file, built before, to take instead of running cargo."""

SUFFIXES = (".so", ".dylib", ".dll")


def repository(root: str) -> Path:
    """The repository's root, two folders above the package's."""
    path = Path(root).resolve().parent.parent
    if not (path / "Cargo.toml").is_file():
        raise RuntimeError(
            f"expected the sources of the shapeop crate in {path}, found no Cargo.toml there: "
            "build the package from a checkout of the whole repository"
        )
    return path


def library(root: str) -> Path:
    """The library file for the wheel."""
    named = os.environ.get(LIBRARY_VARIABLE)
    if named:
        path = Path(named).resolve()
        if path.suffix not in SUFFIXES or not path.is_file():
            raise RuntimeError(f"expected {LIBRARY_VARIABLE} to name a shared library, found no such file: {named}")
        return path
    return built(repository(root))


def built(source: Path) -> Path:
    """The library file, built by cargo, which also says where it is."""
    cargo = shutil.which(os.environ.get("CARGO", "cargo"))
    if cargo is None:
        raise RuntimeError(
            "cargo was not found, and the library is built with it: install Rust from https://rustup.rs, "
            f"or set {LIBRARY_VARIABLE} to a library file built before"
        )
    command = [cargo, "build", "--release", "--locked", "--package", "shapeop", "--lib"]
    command.append("--message-format=json-render-diagnostics")
    run = subprocess.run(command, cwd=source, stdout=subprocess.PIPE, text=True, check=False)
    if run.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} in {source} ended with {run.returncode}")
    messages = (json.loads(line) for line in run.stdout.splitlines() if line.startswith("{"))
    files = (
        Path(name)
        for message in messages
        if message.get("reason") == "compiler-artifact" and message["target"]["name"] == "shapeop"
        for name in message["filenames"]
    )
    return next(path for path in files if path.suffix in SUFFIXES)


class CustomMetadataHook(MetadataHookInterface):
    """The version is that of the crate."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Reads it from the workspace's Cargo.toml, where it is the first of its key."""
        lines = (repository(self.root) / "Cargo.toml").read_text(encoding="utf-8").splitlines()
        metadata["version"] = next(line.split('"')[1] for line in lines if line.startswith("version = "))


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Any Python 3 can use the wheel, on one platform."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Adds the library. An editable installation has none: it is run with SHAPEOP_LIBRARY set."""
        if version == "editable":
            return
        path = library(self.root)
        names = {".so": "libshapeop.so", ".dylib": "libshapeop.dylib", ".dll": "shapeop.dll"}
        build_data["force_include"][str(path)] = f"shapeop/{names[path.suffix]}"
        for licence in repository(self.root).glob("LICENSE-*"):
            place = f"shapeop-{self.metadata.version}.dist-info/licenses/{licence.name}"
            build_data["force_include"][str(licence)] = place
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{next(platform_tags())}"
