"""Grasshopper's archives: a tree of chunks, each with items (named, typed values) and more chunks.

Binary form (`.gh`, `.ghuser`): the tree as bytes, compressed with raw DEFLATE. All numbers are little-endian.

    chunk   name, int32 index (-1: none), int32 count of items, int32 count of chunks, the items, the chunks
    item    name, int32 index (-1: none), int32 type, payload
    name    length in 7-bit groups (the low first), UTF-8

`Chunk` and `Item` keep the order and every bit of what was read: `encode(decode(b)) == b`. The same tree as text
(`.ghx`) is in `xml_form.py`.
"""

from __future__ import annotations

import struct
import uuid
import zlib
from dataclasses import dataclass, field
from typing import Any, Iterator, List, Optional, Tuple

NO_INDEX = -1

# A file may claim any nesting and any size: these bounds keep a damaged one from exhausting the stack or the memory.
# Grasshopper's own files nest about ten chunks.
MAX_DEPTH = 200
MAX_BYTES = 1 << 30

# The least bytes of an item (empty name, index, type, one byte) and of a chunk (empty name, index, two counts).
_LEAST_ITEM = 10
_LEAST_CHUNK = 13


class ArchiveError(ValueError):
    """An archive that is not what it claims to be. The message names the chunk's path and the offset or the line."""


@dataclass(frozen=True)
class ItemType:
    """A type of item. `fields` is the struct format of its payload; empty where the payload has a length of its own."""

    code: int
    name: str
    fields: str = ""


# `gh_date` is .NET's DateTime.ToBinary, `gh_drawing_color` is ARGB, rectangles are x y width height.
TYPES = {
    t.code: t
    for t in (
        ItemType(1, "gh_bool", "B"),
        ItemType(2, "gh_byte", "B"),
        ItemType(3, "gh_int32", "i"),
        ItemType(4, "gh_int64", "q"),
        ItemType(5, "gh_single", "f"),
        ItemType(6, "gh_double", "d"),
        ItemType(8, "gh_date", "q"),
        ItemType(9, "gh_guid"),
        ItemType(10, "gh_string"),
        ItemType(20, "gh_bytearray"),
        ItemType(21, "gh_doublearray"),
        ItemType(30, "gh_drawing_point", "ii"),
        ItemType(31, "gh_drawing_pointf", "ff"),
        ItemType(32, "gh_drawing_size", "ii"),
        ItemType(33, "gh_drawing_sizef", "ff"),
        ItemType(34, "gh_drawing_rectangle", "iiii"),
        ItemType(35, "gh_drawing_rectanglef", "ffff"),
        ItemType(36, "gh_drawing_color", "I"),
        ItemType(37, "gh_drawing_bitmap"),
        ItemType(50, "gh_point2d", "dd"),
        ItemType(51, "gh_point3d", "ddd"),
        ItemType(52, "gh_point4d", "dddd"),
        ItemType(60, "gh_interval1d", "dd"),
        ItemType(61, "gh_interval2d", "dddd"),
        ItemType(70, "gh_line", "dddddd"),
        ItemType(71, "gh_boundingbox", "dddddd"),
        ItemType(72, "gh_plane", "ddddddddd"),
        ItemType(80, "gh_version", "iii"),
    )
}
CODES = {t.name: t.code for t in TYPES.values()}

BOOL, INT32, SINGLE, DOUBLE, DATE, GUID, STRING, BYTES = 1, 3, 5, 6, 8, 9, 10, 20
DOUBLES, POINT, POINTF, RECTANGLE, RECTANGLEF, COLOUR, BITMAP, POINT3D, VERSION = 21, 30, 31, 34, 35, 36, 37, 51, 80


@dataclass
class Item:
    """A named value. `value` is a bool, int, float, str, bytes, `uuid.UUID`, or a tuple of numbers."""

    name: str
    type: int
    value: Any
    index: int = NO_INDEX


@dataclass
class Chunk:
    """A named node of the tree."""

    name: str
    items: List[Item] = field(default_factory=list)
    chunks: List["Chunk"] = field(default_factory=list)
    index: int = NO_INDEX

    def set(self, name: str, type: int, value: Any, index: int = NO_INDEX) -> None:
        """Adds an item, or replaces the one of that name and index. Items stay sorted by name, as Grasshopper's are."""
        kept = [i for i in self.items if (i.name, i.index) != (name, index)]
        self.items = sorted(kept + [Item(name, type, value, index)], key=lambda i: (i.name, i.index))

    def add(self, chunk: "Chunk") -> "Chunk":
        """Appends a chunk, and returns it."""
        self.chunks.append(chunk)
        return chunk

    def find(self, name: str, index: int = NO_INDEX) -> Optional[Item]:
        """The item of that name and index, or None."""
        return next((i for i in self.items if i.name == name and i.index == index), None)

    def get(self, name: str, index: int = NO_INDEX) -> Any:
        """The value of an item.

        Raises `ArchiveError` if there is none."""
        item = self.find(name, index)
        if item is None:
            raise ArchiveError("chunk %r has no item %s" % (self.name, _label(name, index)))
        return item.value

    def chunk(self, name: str, index: int = NO_INDEX) -> "Chunk":
        """The chunk of that name and index.

        Raises `ArchiveError` if there is none."""
        for chunk in self.chunks:
            if chunk.name == name and chunk.index == index:
                return chunk
        raise ArchiveError("chunk %r has no chunk %s" % (self.name, _label(name, index)))

    def walk(self, path: str = "") -> Iterator[Tuple[str, "Chunk"]]:
        """Every chunk of the tree with its path, this one first."""
        path = path + "/" + _label(self.name, self.index)
        yield path, self
        for chunk in self.chunks:
            yield from chunk.walk(path)


def _label(name: str, index: int) -> str:
    return name if index == NO_INDEX else "%s[%d]" % (name, index)


def decode(data: bytes) -> Chunk:
    """The tree of uncompressed bytes.

    Raises `ArchiveError`, with the offset and the chunk's path, if they are no archive."""
    reader = _Reader(data)
    root = reader.chunk("", 0)
    if reader.at != len(data):
        raise reader.error("/" + root.name, "%d bytes follow the last chunk" % (len(data) - reader.at))
    return root


def encode(root: Chunk) -> bytes:
    """The bytes of a tree, uncompressed.

    Raises `ArchiveError`, with the path, if a value does not fit its type."""
    out = bytearray()
    _write_chunk(out, root, "")
    return bytes(out)


def inflate(data: bytes) -> bytes:
    """Decompresses raw DEFLATE.

    Raises `ArchiveError` if it is none, is cut short, or is followed by other bytes."""
    stream = zlib.decompressobj(-zlib.MAX_WBITS)
    try:
        out = stream.decompress(data, MAX_BYTES)
    except zlib.error as error:
        raise ArchiveError("no archive: not compressed with DEFLATE (%s)" % error) from None
    if not stream.eof:
        # A stream that ends exactly at the bound is not told apart from a longer one; none is near it.
        reason = "the compressed data is cut short" if len(out) < MAX_BYTES else "more than %d bytes" % MAX_BYTES
        raise ArchiveError("no archive: %s (after %d bytes of it)" % (reason, len(out)))
    if stream.unused_data:
        raise ArchiveError("%d bytes follow the compressed data" % len(stream.unused_data))
    return out


def deflate(data: bytes) -> bytes:
    """Compresses as Grasshopper does: raw DEFLATE at zlib's default level."""
    stream = zlib.compressobj(6, zlib.DEFLATED, -zlib.MAX_WBITS)
    return stream.compress(data) + stream.flush()


def read(data: bytes) -> Chunk:
    """The tree of a `.gh` or `.ghuser` file, or of an archive inside one."""
    return decode(inflate(data))


def write(root: Chunk) -> bytes:
    """The file of a tree."""
    return deflate(encode(root))


class _Reader:
    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0

    def error(self, path: str, reason: str, at: Optional[int] = None) -> ArchiveError:
        return ArchiveError("offset %d, in %s: %s" % (self.at if at is None else at, path or "/", reason))

    def take(self, count: int, path: str, what: str) -> bytes:
        left = len(self.data) - self.at
        if not 0 <= count <= left:
            raise self.error(path, "%s takes %d bytes, and %d are left" % (what, count, left))
        self.at += count
        return self.data[self.at - count : self.at]

    def numbers(self, fields: str, path: str, what: str) -> Tuple[Any, ...]:
        return struct.unpack("<" + fields, self.take(struct.calcsize("<" + fields), path, what))

    def int32(self, path: str, what: str) -> int:
        return self.numbers("i", path, what)[0]

    def count(self, path: str, what: str, least_bytes: int) -> int:
        at = self.at
        count = self.int32(path, what)
        if not 0 <= count <= (len(self.data) - self.at) // least_bytes:
            left = len(self.data) - self.at
            raise self.error(path, "%s is %d, and %d bytes are left" % (what, count, left), at)
        return count

    def text(self, path: str, what: str) -> str:
        start, length, shift = self.at, 0, 0
        while True:
            (byte,) = self.take(1, path, "the length of " + what)
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > 28:
                raise self.error(path, "the length of %s has more than five bytes" % what, start)
        if byte == 0 and shift > 7:
            raise self.error(path, "the length of %s is not written in its shortest form" % what, start)
        try:
            return self.take(length, path, what).decode("utf-8")
        except UnicodeDecodeError as error:
            raise self.error(path, "%s is not UTF-8 (%s)" % (what, error.reason), start) from None

    def chunk(self, parent: str, depth: int) -> Chunk:
        if depth > MAX_DEPTH:
            raise self.error(parent, "chunks are nested more than %d deep" % MAX_DEPTH)
        name = self.text(parent, "the name of a chunk")
        index = self.int32(parent, "the index of chunk %r" % name)
        path = parent + "/" + _label(name, index)
        item_count = self.count(path, "the count of items", _LEAST_ITEM)
        chunk_count = self.count(path, "the count of chunks", _LEAST_CHUNK)
        chunk = Chunk(name, index=index)
        chunk.items = [self.item(path) for _ in range(item_count)]
        chunk.chunks = [self.chunk(path, depth + 1) for _ in range(chunk_count)]
        return chunk

    def item(self, path: str) -> Item:
        start = self.at
        name = self.text(path, "the name of an item")
        index = self.int32(path, "the index of item %r" % name)
        code = self.int32(path, "the type of item %r" % name)
        what = "item %s" % _label(name, index)
        if code not in TYPES:
            raise self.error(path, "%s is of type %d, which is unknown" % (what, code), start)
        return Item(name, code, self.value(code, path, what), index)

    def value(self, code: int, path: str, what: str) -> Any:
        if code == STRING:
            return self.text(path, what)
        if code == GUID:
            return uuid.UUID(bytes_le=self.take(16, path, what))
        if code in (BYTES, BITMAP):
            return self.take(self.int32(path, "the length of " + what), path, what)
        if code == DOUBLES:
            return self.numbers("%dd" % self.count(path, "the length of " + what, 8), path, what)
        values = self.numbers(TYPES[code].fields, path, what)
        if code == BOOL and values[0] > 1:
            raise self.error(path, "%s is a bool of value %d" % (what, values[0]), self.at - 1)
        if code == BOOL:
            return bool(values[0])
        return values[0] if len(values) == 1 else values


def _write_text(out: bytearray, text: str) -> None:
    data = text.encode("utf-8")
    length = len(data)
    while length > 127:
        out.append(length & 127 | 128)
        length >>= 7
    out.append(length)
    out += data


def _write_chunk(out: bytearray, chunk: Chunk, parent: str) -> None:
    path = parent + "/" + _label(chunk.name, chunk.index)
    _write_text(out, chunk.name)
    out += struct.pack("<iii", chunk.index, len(chunk.items), len(chunk.chunks))
    for item in chunk.items:
        try:
            _write_text(out, item.name)
            out += struct.pack("<ii", item.index, item.type)
            _write_value(out, item.type, item.value)
        except (struct.error, TypeError, AttributeError, KeyError, OverflowError) as error:
            known = TYPES[item.type].name if item.type in TYPES else "an unknown type, %d" % item.type
            reason = "%s is %s, its value %.60r does not fit (%s)" % (item.name, known, item.value, error)
            raise ArchiveError("in %s: %s" % (path, reason)) from None
    for child in chunk.chunks:
        _write_chunk(out, child, path)


def _write_value(out: bytearray, code: int, value: Any) -> None:
    if code == STRING:
        _write_text(out, value)
    elif code == GUID:
        out += value.bytes_le
    elif code in (BYTES, BITMAP):
        out += struct.pack("<i", len(value)) + bytes(value)
    elif code == DOUBLES:
        out += struct.pack("<i%dd" % len(value), len(value), *value)
    else:
        out += struct.pack("<" + TYPES[code].fields, *(value if isinstance(value, tuple) else (value,)))
