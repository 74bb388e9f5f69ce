"""Yak packages: a ZIP with `manifest.yml` at its root, which Rhino's package manager installs.

    manifest.yml icon.png                for the package manager
    <component>.ghuser                   at the root, where Grasshopper looks for them
    shapeop_gh/*.py shapeop_gh/_abi.py   the module that the components import
    shapeop_gh/shapeop.dll               the native library, which the module loads by its absolute path
    definitions/*.ghx misc/              the examples; licences and what to read

Rhino unpacks it into `.../packages/8.0/ShapeOp/0.1.0/`. The file name carries the distribution tag:
`shapeop-0.1.0-rh8_0-win.yak` is for Rhino 8.0 and later on Windows. `any` stands for both platforms. Zip entries are
sorted and dated alike: the same input gives the same bits."""

from __future__ import annotations

import io
import json
import re
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, List, Sequence, Tuple

from components import RHINO7, RHINO8, Host

# The components look for the package's folder under this name.
NAME = "ShapeOp"
AUTHORS = ("The shapeop contributors",)
DESCRIPTION = (
    "Freeform shapes that can be built: points and constraints, solved in milliseconds. Planar faces, circular faces, "
    "equal lengths, angles, strain, handles that follow the mouse; for static and dynamic models."
)
KEYWORDS = ("shapeop", "constraints", "geometry", "form-finding", "planarize", "mesh", "optimization", "dynamics")

MODULE = "shapeop_gh"
_DATE = (2025, 1, 1, 0, 0, 0)
_PLAIN_FILE = 0o100644 << 16


@dataclass(frozen=True)
class Platform:
    """A system that a native library is for. `tag` is empty if Rhino does not run there."""

    name: str
    tag: str
    file_name: str
    magics: Tuple[bytes, ...]


# A library is told by its first bytes, whatever its file is called.
PLATFORMS = (
    Platform("Windows", "win", "shapeop.dll", (b"MZ",)),
    Platform("macOS", "mac", "libshapeop.dylib", (b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe", b"\xca\xfe\xba\xbf")),
    Platform("Linux", "", "libshapeop.so", (b"\x7fELF",)),
)
_HOSTS = {RHINO7.name: ("rh7_0", ("Windows", "Linux")), RHINO8.name: ("rh8_0", ("Windows", "macOS", "Linux"))}


class PackageError(ValueError):
    """A package that cannot be made. The message says of what, and why."""


def platform_of(library: Path) -> Platform:
    """The platform of a native library.

    Raises `PackageError` if the file is none."""
    try:
        with library.open("rb") as file:
            head = file.read(4)
    except OSError as error:
        raise PackageError("library %s: %s" % (library, error.strerror)) from None
    for platform in PLATFORMS:
        if head.startswith(platform.magics):
            return platform
    raise PackageError("%s is no native library (neither PE nor Mach-O nor ELF)" % library)


def by_platform(libraries: Iterable[Path]) -> Dict[Platform, Path]:
    """The libraries by platform.

    Raises `PackageError` for two of one platform."""
    found: Dict[Platform, Path] = {}
    for library in libraries:
        platform = platform_of(library)
        if platform in found:
            raise PackageError("%s and %s are both for %s" % (found[platform], library, platform.name))
        found[platform] = library
    return found


def usable(host: Host, libraries: Dict[Platform, Path]) -> Dict[Platform, Path]:
    """Those of the libraries that `host` can load: Python in Rhino 7 for Mac loads no native library."""
    return {p: path for p, path in libraries.items() if p.name in _HOSTS[host.name][1]}


def file_name(version: str, host: Host, platforms: Iterable[Platform]) -> str:
    """The name of a package. One without a library for Rhino's systems is tagged `linux`, which no package server
    takes: it is for tests."""
    tags = sorted({p.tag for p in platforms if p.tag})
    platform = "linux" if not tags else tags[0] if len(tags) == 1 else "any"
    return "%s-%s-%s-%s.yak" % (NAME.lower(), version, _HOSTS[host.name][0], platform)


def manifest(version: str, url: str, platforms: Sequence[Platform]) -> str:
    """The text of `manifest.yml`. Texts are written as JSON, which YAML contains."""
    names = ", ".join(sorted(p.name for p in platforms))
    lines = ["name: " + NAME, "version: " + json.dumps(version), "authors:"]
    lines += ["  - " + json.dumps(author) for author in AUTHORS]
    lines.append("description: " + json.dumps("%s Holds the native library for %s." % (DESCRIPTION, names)))
    if url:
        lines.append("url: " + json.dumps(url))
    lines += ["icon: icon.png", "keywords:"]
    lines += ["  - " + json.dumps(keyword) for keyword in KEYWORDS]
    return "\n".join(lines) + "\n"


def archive(files: Dict[str, bytes]) -> bytes:
    """A ZIP of files by their path in it."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as package:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = _PLAIN_FILE
            entry.create_system = 3
            package.writestr(entry, files[name], compresslevel=9)
    return buffer.getvalue()


def version_of(cargo_toml: Path) -> str:
    """The version of the project, which `Cargo.toml` alone states."""
    found = re.search(r'^version = "([^"]+)"', cargo_toml.read_text("utf-8"), re.MULTILINE)
    if not found:
        raise PackageError("%s states no version" % cargo_toml)
    return found.group(1)


def files_of(
    root: Path, host: Host, user_objects: Dict[str, bytes], definitions: Dict[str, bytes],
    libraries: Dict[Platform, Path], version: str, url: str,
) -> Dict[str, bytes]:  # fmt: skip
    """All files of a package by their path in it. `root` is the root of the source tree."""
    module = root / "ghpython" / MODULE
    abi = root / "bindings" / "python" / "src" / "shapeop" / "_abi.py"
    sources: List[Path] = sorted(module.glob("*.py"))
    if not sources:
        raise PackageError("%s holds no module" % module)
    files = {"manifest.yml": manifest(version, url, list(libraries)).encode("utf-8")}
    files["icon.png"] = (Path(__file__).parent / "icon.png").read_bytes()
    files.update(user_objects)
    files.update({"%s/%s" % (MODULE, path.name): path.read_bytes() for path in sources})
    files["%s/_abi.py" % MODULE] = abi.read_bytes()
    files.update({"%s/%s" % (MODULE, p.file_name): path.read_bytes() for p, path in libraries.items()})
    files.update({"definitions/" + name: data for name, data in definitions.items()})
    for name in ("LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY", "CHANGELOG.md"):
        files["misc/" + name] = (root / name).read_bytes()
    return files
