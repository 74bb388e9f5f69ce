"""Builds all that Grasshopper gets: user objects, the definitions of the paper's examples, Yak packages."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Dict, List, Optional

PACKAGING = Path(__file__).resolve().parent
ROOT = PACKAGING.parents[1]
sys.path.insert(0, str(PACKAGING))

import archive  # noqa: E402
import components  # noqa: E402
import paper  # noqa: E402
import xml_form  # noqa: E402
import yak  # noqa: E402
from components import HOSTS, Component, Host  # noqa: E402

COMPONENTS = ROOT / "ghpython" / "components"
PARTS = ROOT / "ghpython" / "definitions" / "parts"
SPECS = ROOT / "examples" / "paper"
DEFINITIONS = ROOT / "ghpython" / "definitions"

EPILOG = """
Writes into OUT:
  rhino7/*.ghuser              components for Rhino 7 and older (GhPython); a user copies them into
                               Grasshopper's folder User Objects (File > Special Folders)
  rhino8/*.ghuser              components for Rhino 8 (script component, Python 3)
  definitions/rhino*/*.ghx     the examples of the ShapeOp paper, for Grasshopper's File > Open
  shapeop-<version>-rh7_0-<platform>.yak, shapeop-<version>-rh8_0-<platform>.yak
                               packages for Rhino's package manager: drag the file onto Rhino, or push it
                               with `yak push FILE`

Each --library is a native library of the project (shapeop.dll, libshapeop.dylib, libshapeop.so), of which the
packages take one for each platform. The platform is read from the file, not from its name. Without a library for
Windows there is no package for Rhino 7 but for tests: its Python loads no native library on macOS. A package with a
library for Linux alone is tagged linux: it is for tests, Rhino does not run there.

The same input gives the same files, bit by bit.

  python ghpython/packaging/build.py out --library shapeop.dll --library libshapeop.dylib
  python ghpython/packaging/build.py --definitions     # renews the committed definitions
"""


def user_objects(found: Dict[str, Component], host: Host) -> Dict[str, bytes]:
    """The `.ghuser` files of all components, by file name."""
    trees = {name: components.user_object(component, host) for name, component in found.items()}
    return {name + ".ghuser": archive.write(tree) for name, tree in trees.items()}


def definitions(found: Dict[str, Component], host: Host, specs: Path = SPECS) -> Dict[str, bytes]:
    """The `.ghx` files of the paper's examples, by file name."""
    parts = components.load_all(PARTS)
    files = {}
    for path in sorted(specs.glob("fig*.json")):
        tree = paper.build(paper.read_spec(path), specs, found, parts, host).tree()
        files[path.stem + ".ghx"] = xml_form.text(tree).encode("utf-8")
    return files


def write_all(folder: Path, files: Dict[str, bytes]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        (folder / name).write_bytes(data)
        print("wrote %s (%d bytes)" % (folder / name, len(data)))


def build(out: Path, libraries: List[Path], url: str) -> None:
    """Builds everything into `out`.

    Raises an error of `components`, `paper`, `archive` or `yak` that says what is wrong."""
    by_platform = yak.by_platform(libraries)
    version = yak.version_of(ROOT / "Cargo.toml")
    found = components.load_all(COMPONENTS)
    for host in HOSTS:
        objects, examples = user_objects(found, host), definitions(found, host)
        write_all(out / host.name, objects)
        write_all(out / "definitions" / host.name, examples)
        usable = yak.usable(host, by_platform)
        if not usable:
            print("no package for %s: no library that it can load was given" % host.name)
            continue
        files = yak.files_of(ROOT, host, objects, examples, usable, version, url)
        write_all(out, {yak.file_name(version, host, usable): yak.archive(files)})
        print("  it holds the native library for: %s" % ", ".join(sorted(p.name for p in usable)))


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path, nargs="?", metavar="OUT", help="a folder; it is made if it is missing")
    parser.add_argument(
        "--library", type=Path, action="append", default=[], metavar="FILE", help="a native library; one per platform"
    )
    parser.add_argument("--url", default="", help="the project's page, for the packages' manifest")
    parser.add_argument("--definitions", action="store_true", help="only write the definitions into the source tree")
    options = parser.parse_args(arguments)
    if (options.out is None) != options.definitions:
        parser.error("give either OUT or --definitions")
    try:
        if options.definitions:
            found = components.load_all(COMPONENTS)
            for host in HOSTS:
                write_all(DEFINITIONS / host.name, definitions(found, host))
        else:
            build(options.out, options.library, options.url)
    except (components.ComponentError, paper.SpecError, archive.ArchiveError, yak.PackageError, OSError) as error:
        print("build.py: %s" % error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
