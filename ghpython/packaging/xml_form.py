"""The text form of Grasshopper's archives (`.ghx`): the tree of `archive.py` as XML.

    <Archive name="Root">
      <items count="1"> <item name="..." index="0" type_name="gh_int32" type_code="3">7</item> </items>
      <chunks count="1"> <chunk name="..." index="0"> ... </chunk> </chunks>
    </Archive>

`parse(text(root))` is `root`, bit by bit. Numbers are written in the shortest form that reads back the same."""

from __future__ import annotations

import base64
import binascii
import struct
import uuid
import xml.etree.ElementTree as ElementTree
from typing import Any, List, Optional, Tuple
from xml.sax.saxutils import escape, quoteattr

import archive
from archive import ArchiveError, Chunk, Item

# The elements that the parts of a value have. Of the types left out (4D points, 2D intervals) no text was seen.
_PARTS = {
    30: ("X", "Y"),
    31: ("X", "Y"),
    32: ("W", "H"),
    33: ("W", "H"),
    34: ("X", "Y", "W", "H"),
    35: ("X", "Y", "W", "H"),
    50: ("X", "Y"),
    51: ("X", "Y", "Z"),
    60: ("A", "B"),
    70: ("Ax", "Ay", "Az", "Bx", "By", "Bz"),
    71: ("MinX", "MinY", "MinZ", "MaxX", "MaxY", "MaxZ"),
    72: ("Ox", "Oy", "Oz", "Xx", "Xy", "Xz", "Yx", "Yy", "Yz"),
    80: ("Major", "Minor", "Revision"),
}


def text(root: Chunk) -> str:
    """The XML of a tree.

    Raises `ArchiveError` for a text that XML cannot hold."""
    lines = ['<?xml version="1.0" encoding="utf-8" standalone="yes"?>']
    _write_chunk(lines, "Archive", root, "", 0)
    return "\n".join(lines) + "\n"


def parse(document: str) -> Chunk:
    """The tree of XML.

    Raises `ArchiveError`, with the line or the chunk's path, if it is no archive."""
    if "<!DOCTYPE" in document:
        raise ArchiveError("no archive: a document type is declared")
    try:
        root = ElementTree.fromstring(document.encode("utf-8"))
    except (ElementTree.ParseError, UnicodeEncodeError) as error:
        raise ArchiveError("no archive: not XML (%s)" % error) from None
    if root.tag != "Archive":
        raise ArchiveError("no archive: the root element is %r, not 'Archive'" % root.tag)
    return _parse_chunk(root, "", 0)


def _write_chunk(lines: List[str], tag: str, chunk: Chunk, parent: str, depth: int) -> None:
    margin = "  " * depth
    path = "%s/%s" % (parent, chunk.name)
    lines.append("%s<%s name=%s%s>" % (margin, tag, quoteattr(chunk.name), _index(chunk.index)))
    if chunk.items:
        lines.append('%s  <items count="%d">' % (margin, len(chunk.items)))
        for item in chunk.items:
            head = "%s    <item name=%s%s" % (margin, quoteattr(item.name), _index(item.index))
            type_name = archive.TYPES[item.type].name if item.type in archive.TYPES else "unknown"
            head += ' type_name="%s" type_code="%d">' % (type_name, item.type)
            lines.append(head + _write_value(item, path) + "</item>")
        lines.append(margin + "  </items>")
    if chunk.chunks:
        lines.append('%s  <chunks count="%d">' % (margin, len(chunk.chunks)))
        for child in chunk.chunks:
            _write_chunk(lines, "chunk", child, path, depth + 2)
        lines.append(margin + "  </chunks>")
    lines.append("%s</%s>" % (margin, tag))


def _index(index: int) -> str:
    return "" if index == archive.NO_INDEX else ' index="%d"' % index


def _write_value(item: Item, path: str) -> str:
    code, value = item.type, item.value
    try:
        if code == archive.STRING:
            return _escape(value)
        if code == archive.BOOL:
            return "true" if value else "false"
        if code == archive.GUID:
            return str(value)
        if code in (archive.BYTES, archive.BITMAP):
            return _stream("bitmap" if code == archive.BITMAP else "stream", len(value), value)
        if code == archive.DOUBLES:
            return _stream("stream", len(value), struct.pack("<%dd" % len(value), *value))
        if code == archive.COLOUR:
            return "<ARGB>%d;%d;%d;%d</ARGB>" % struct.unpack("BBBB", struct.pack(">I", value))
        if code in _PARTS:
            kind = archive.TYPES[code].fields[0]
            return "".join("<%s>%s</%s>" % (p, _number(v, kind), p) for p, v in zip(_PARTS[code], value))
        if isinstance(value, tuple):
            raise ValueError("its form as XML is unknown")
        return _number(value, archive.TYPES[code].fields)
    except (struct.error, TypeError, AttributeError, KeyError, ValueError, OverflowError) as error:
        raise ArchiveError("in %s: item %r of type %d: %s" % (path, item.name, code, error)) from None


def _escape(value: str) -> str:
    for character in value:
        if (character < " " and character not in "\t\n\r") or character in "\ufffe\uffff":
            raise ValueError("the character %r cannot be written as XML" % character)
    return escape(value, {"\r": "&#xD;"})


def _stream(tag: str, length: int, data: bytes) -> str:
    return '<%s length="%d">%s</%s>' % (tag, length, base64.b64encode(data).decode("ascii"), tag)


def _number(value: float, kind: str) -> str:
    if kind not in "fd":
        return "%d" % value
    shortest = repr(value)
    if kind == "f":
        bits = struct.pack("<f", value)
        candidates = ("%.*g" % (digits, value) for digits in range(6, 10))
        shortest = next(c for c in candidates if c == "nan" or struct.pack("<f", float(c)) == bits)
    named = {"inf": "Infinity", "-inf": "-Infinity", "nan": "NaN"}.get(shortest, shortest)
    return named[:-2] if named.endswith(".0") else named


def _parse_chunk(element: Any, parent: str, depth: int) -> Chunk:
    if depth > archive.MAX_DEPTH:
        raise ArchiveError("in %s: chunks are nested more than %d deep" % (parent, archive.MAX_DEPTH))
    name, index = _name_and_index(element, parent)
    chunk = Chunk(name, index=index)
    path = "%s/%s" % (parent, name)
    chunk.items = [_parse_item(e, path) for e in _children(element, "items", "item", path)]
    chunk.chunks = [_parse_chunk(e, path, depth + 1) for e in _children(element, "chunks", "chunk", path)]
    return chunk


def _name_and_index(element: Any, path: str) -> Tuple[str, int]:
    name = element.get("name")
    if name is None:
        raise ArchiveError("in %s: an element %r has no name" % (path or "/", element.tag))
    try:
        return name, int(element.get("index", archive.NO_INDEX))
    except ValueError:
        raise ArchiveError("in %s: the index of %r is %r" % (path or "/", name, element.get("index"))) from None


def _children(element: Any, group: str, tag: str, path: str) -> List[Any]:
    container = element.find(group)
    if container is None:
        return []
    children = container.findall(tag)
    if container.get("count") != str(len(children)):
        reason = "the count of %s is %r, and there are %d" % (group, container.get("count"), len(children))
        raise ArchiveError("in %s: %s" % (path, reason))
    return children


def _parse_item(element: Any, path: str) -> Item:
    name, index = _name_and_index(element, path)
    try:
        code = int(element.get("type_code", ""))
        if code not in archive.TYPES:
            raise ValueError("type %d is unknown" % code)
        return Item(name, code, _parse_value(element, code), index)
    except (ValueError, KeyError, struct.error, binascii.Error, OverflowError) as error:
        raise ArchiveError("in %s: item %r: %s" % (path, name, error)) from None


def _parse_value(element: Any, code: int) -> Any:
    content = element.text or ""
    if code == archive.STRING:
        return content
    if code == archive.GUID:
        return uuid.UUID(content.strip())
    if code == archive.BOOL:
        return {"true": True, "false": False}[content.strip().lower()]
    if code in (archive.BYTES, archive.BITMAP):
        tag = "bitmap" if code == archive.BITMAP else "stream"
        return base64.b64decode(_part(element, tag), validate=True)
    if code == archive.DOUBLES:
        data = base64.b64decode(_part(element, "stream"), validate=True)
        return struct.unpack("<%dd" % (len(data) // 8), data)
    if code == archive.COLOUR:
        return struct.unpack(">I", bytes(int(v) for v in _part(element, "ARGB").split(";")))[0]
    fields = archive.TYPES[code].fields
    number = float if fields[0] in "fd" else int
    if len(fields) > 1 and code not in _PARTS:
        raise ValueError("its form as XML is unknown")
    values = tuple(number(_part(element, p)) for p in _PARTS[code]) if code in _PARTS else number(content)
    whole = values if isinstance(values, tuple) else (values,)
    exact = struct.unpack("<" + fields, struct.pack("<" + fields, *whole))
    return exact if isinstance(values, tuple) else exact[0]


def _part(element: Any, tag: str) -> str:
    part: Optional[Any] = element.find(tag)
    if part is None:
        raise ValueError("it has no element %r" % tag)
    return (part.text or "").strip()
