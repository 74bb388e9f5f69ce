#!/usr/bin/env python3
"""Makes the NuGet package ShapeOp: the assembly, its documentation, and the native library of each platform.

lib/netstandard2.0/ShapeOp.dll ShapeOp.xml   what programs compile against
runtimes/<rid>/native/                       what they load: one library per platform
"""

from __future__ import annotations

import argparse
import re
import sys
import zipfile
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape

EPILOG = """\
example:
  cargo xtask dist shapeop
  mcs -langversion:7.2 -target:library -doc:ShapeOp.xml -out:ShapeOp.dll -recurse:'bindings/csharp/ShapeOp/*.cs'
  python bindings/csharp/pack.py ShapeOp.dll --native linux-x64=shapeop/lib/libshapeop.so --out packages

Repeat --native for every platform. The same files give the same package, bit for bit.
"""
NAME = "ShapeOp"
DESCRIPTION = (
    "Freeform shapes that can be built: points and constraints, solved in milliseconds. Planar faces, circles, equal "
    "lengths, angles, strain; static and dynamic models; handles that follow the mouse."
)
ROOT = Path(__file__).resolve().parents[2]
#: The earliest date that a ZIP can hold: entries do not say when they were made.
DATE = (1980, 1, 1, 0, 0, 0)


class Platform(NamedTuple):
    """How a platform calls the library, and what such a file begins with."""

    file_name: str
    magic: bytes


WINDOWS = Platform("shapeop.dll", b"MZ")
MACOS = Platform("libshapeop.dylib", b"\xcf\xfa\xed\xfe")
LINUX = Platform("libshapeop.so", b"\x7fELF")
#: By .NET's runtime identifiers (RID).
PLATFORMS = {
    "%s-%s" % (system, machine): platform
    for system, platform in (("win", WINDOWS), ("osx", MACOS), ("linux", LINUX))
    for machine in ("x64", "arm64")
}


class PackError(ValueError):
    """A package that cannot be made. The message says of what, and why."""


def version() -> str:
    """The crate's version. Raises `PackError` if the assembly's is another."""
    crate = re.search(r'^version = "([^"]+)"', read(ROOT / "Cargo.toml"), re.MULTILINE)
    assembly = re.search(r'AssemblyVersion\("([^"]+)"\)', read(ROOT / "bindings/csharp/ShapeOp/AssemblyInfo.cs"))
    if not crate or not assembly or crate[1] != assembly[1]:
        found = [match[1] if match else "none" for match in (crate, assembly)]
        raise PackError("the version in Cargo.toml is %s, in AssemblyInfo.cs %s" % tuple(found))
    return crate[1]


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def native(text: str) -> tuple[str, bytes]:
    """Path in the package and bytes of a library given as `RID=FILE`."""
    rid, separator, name = text.partition("=")
    if not separator or rid not in PLATFORMS:
        raise PackError("--native %s: expected RID=FILE, with RID one of %s" % (text, ", ".join(sorted(PLATFORMS))))
    platform, data = PLATFORMS[rid], Path(name).read_bytes()
    if not data.startswith(platform.magic):
        raise PackError("--native %s: %s is no library for %s" % (text, name, rid))
    return "runtimes/%s/native/%s" % (rid, platform.file_name), data


def nuspec(number: str) -> str:
    """The package's manifest."""
    return f"""<?xml version="1.0" encoding="utf-8"?>
<package xmlns="http://schemas.microsoft.com/packaging/2013/05/nuspec.xsd">
  <metadata>
    <id>{NAME}</id>
    <version>{number}</version>
    <authors>The shapeop contributors</authors>
    <requireLicenseAcceptance>false</requireLicenseAcceptance>
    <license type="expression">MIT OR Apache-2.0</license>
    <readme>README.md</readme>
    <description>{escape(DESCRIPTION)}</description>
    <tags>geometry constraints form-finding mesh optimization dynamics</tags>
    <dependencies><group targetFramework=".NETStandard2.0" /></dependencies>
  </metadata>
</package>
"""


def relationships() -> str:
    """Where in the package its manifest is, in the words of the Open Packaging Conventions."""
    return f"""<?xml version="1.0" encoding="utf-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
  <Relationship Type="http://schemas.microsoft.com/packaging/2010/07/manifest" Target="/{NAME}.nuspec" Id="manifest" />
</Relationships>
"""


def content_types(names: list[str]) -> str:
    """The media type of every file, by its ending or, where it has none, by its name."""
    types = {"rels": "application/vnd.openxmlformats-package.relationships+xml"}
    endings = sorted({Path(name).suffix[1:] for name in names} - {""})
    lines = [
        '  <Default Extension="%s" ContentType="%s" />' % (ending, types.get(ending, "application/octet-stream"))
        for ending in endings
    ]
    lines += [
        '  <Override PartName="/%s" ContentType="application/octet-stream" />' % name
        for name in names
        if not Path(name).suffix
    ]
    head = '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', head, *lines, "</Types>", ""])


def files_of(assembly: Path, natives: list[str], number: str) -> dict[str, bytes]:
    """The package's files by their path in it."""
    if not natives:
        raise PackError("expected at least one --native RID=FILE, found none")
    files = {
        "lib/netstandard2.0/ShapeOp.dll": assembly.read_bytes(),
        "lib/netstandard2.0/ShapeOp.xml": assembly.with_suffix(".xml").read_bytes(),
        "README.md": (ROOT / "docs/csharp.md").read_bytes(),
    }
    for licence in ("LICENSE-APACHE", "LICENSE-MIT", "LICENSE-THIRD-PARTY"):
        files[licence] = (ROOT / licence).read_bytes()
    for text in natives:
        name, data = native(text)
        if name in files:
            raise PackError("--native %s: this platform was given twice" % text)
        files[name] = data
    files[NAME + ".nuspec"] = nuspec(number).encode()
    files["_rels/.rels"] = relationships().encode()
    files["[Content_Types].xml"] = content_types(sorted(files) + ["_rels/x.rels"]).encode()
    return files


def write(path: Path, files: dict[str, bytes]) -> None:
    """A ZIP of `files`, the same for the same files."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w") as package:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system, entry.external_attr = 3, 0o100644 << 16  # the same on every system
            package.writestr(entry, files[name])


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("assembly", type=Path, metavar="ShapeOp.dll", help="its documentation, ShapeOp.xml, beside it")
    parser.add_argument("--native", action="append", default=[], metavar="RID=FILE", help="a native library")
    parser.add_argument("--out", type=Path, default=Path("."), metavar="FOLDER", help="where the package goes (here)")
    options = parser.parse_args()
    try:
        number = version()
        path = options.out / ("%s.%s.nupkg" % (NAME, number))
        write(path, files_of(options.assembly, options.native, number))
    except (PackError, OSError) as error:
        print("pack.py: %s" % error, file=sys.stderr)
        return 1
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
