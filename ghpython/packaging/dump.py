"""Prints a Grasshopper file (`.gh`, `.ghuser`, `.ghx`) as text: `python dump.py FILE`.

One line per item: its name, its type, its value. Archives inside the file are opened."""

from __future__ import annotations

import argparse
import base64
import binascii
import struct
import sys
from pathlib import Path
from typing import Iterator, List, Optional

sys.path.insert(0, str(Path(__file__).resolve().parent))

import archive  # noqa: E402
import xml_form  # noqa: E402

PNG = b"\x89PNG\r\n\x1a\n"


def load(path: Path) -> archive.Chunk:
    """The tree of a file, whichever of the two forms it has."""
    data = path.read_bytes()
    if data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return xml_form.parse(data.decode("utf-8-sig"))
    return archive.read(data)


def lines(chunk: archive.Chunk, show_text: bool = False, depth: int = 0) -> Iterator[str]:
    """The lines of a tree. `show_text` prints long texts (sources) in full."""
    margin = "  " * depth
    yield "%s%s" % (margin, _label(chunk.name, chunk.index))
    for item in chunk.items:
        yield "%s  %s  %s  %s" % (margin, _label(item.name, item.index), archive.TYPES[item.type].name, _value(item))
        inner = _inner_archive(item)
        if inner is not None:
            yield from lines(inner, show_text, depth + 2)
        text = _long_text(chunk, item) if show_text else None
        if text is not None:
            yield from (margin + "    | " + line for line in text.splitlines())
    for child in chunk.chunks:
        yield from lines(child, show_text, depth + 1)


def _label(name: str, index: int) -> str:
    return name if index == archive.NO_INDEX else "%s[%d]" % (name, index)


def _value(item: archive.Item) -> str:
    value = item.value
    if isinstance(value, bytes):
        if value.startswith(PNG) and len(value) >= 24:
            return "%d bytes, PNG %d x %d" % ((len(value),) + struct.unpack(">II", value[16:24]))
        return "%d bytes" % len(value)
    if isinstance(value, str):
        return repr(value) if len(value) <= 100 else "%r... (%d characters)" % (value[:100], len(value))
    return str(value)


def _inner_archive(item: archive.Item) -> Optional[archive.Chunk]:
    if not isinstance(item.value, bytes):
        return None
    try:
        return archive.read(item.value)
    except archive.ArchiveError:
        return None


def _long_text(chunk: archive.Chunk, item: archive.Item) -> Optional[str]:
    if not isinstance(item.value, str) or len(item.value) <= 100:
        return None
    if chunk.name == "Script" and item.name == "Text":
        try:
            return base64.b64decode(item.value, validate=True).decode("utf-8")
        except (binascii.Error, UnicodeDecodeError):
            return item.value
    return item.value


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog="Archives inside the file are opened.")
    parser.add_argument("file", type=Path, help="a .gh, .ghuser or .ghx file")
    parser.add_argument("--text", action="store_true", help="print long texts, such as sources, in full")
    options = parser.parse_args(arguments)
    try:
        for line in lines(load(options.file), options.text):
            print(line)
    except (OSError, UnicodeDecodeError, archive.ArchiveError) as error:
        print("%s: %s" % (options.file, error), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
