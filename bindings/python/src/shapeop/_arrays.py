"""Numbers on their way to the library: checks of type and shape, and ctypes pointers.

numpy is optional. An array that already has the library's layout is passed without a copy; everything else is copied
into one flat array. The library checks the values.
"""

from __future__ import annotations

import ctypes
import operator
from array import array
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from ._library import ArgumentError, ArgumentTypeError

try:
    import numpy as numpy
except ImportError:
    numpy = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Doubles = NDArray[numpy.float64]
    """What comes back: an array, or lists of the same shape where numpy is not installed."""
    PointsLike = Union[Sequence[Sequence[float]], NDArray[Any]]
    Numbers = Union[float, Sequence[float], NDArray[Any]]
    ScalarsLike = Union[Sequence[float], Sequence[Sequence[float]], Sequence[Sequence[Sequence[float]]], NDArray[Any]]
    Ids = Union[int, Sequence[int], range, NDArray[Any]]

INT_MAX = 2**31 - 1
UINT_MAX = 2**32 - 1

_DOUBLE_POINTER = ctypes.POINTER(ctypes.c_double)
_INT_POINTER = ctypes.POINTER(ctypes.c_int)


class Block(NamedTuple):
    """Numbers in the library's layout: the pointer keeps them alive."""

    pointer: Any
    length: int


class IndexLists(NamedTuple):
    """Index lists behind each other, and how many each has; one count if all have the same number."""

    indices: Block
    counts: Block
    list_count: int
    is_one: bool


def is_array(values: object) -> bool:
    """Whether it is a numpy array."""
    return numpy is not None and isinstance(values, numpy.ndarray)


def found(value: object) -> str:
    """What was found, for messages."""
    if is_array(value):
        return f"an array of {value.dtype} of shape {value.shape}"  # type: ignore[attr-defined]
    text = repr(value)
    return f"{type(value).__name__} {text if len(text) <= 60 else text[:57] + '...'}"


def integer(value: object, name: str, least: int = 0, greatest: int = INT_MAX) -> int:
    """A whole number that fits the ABI."""
    try:
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentTypeError(f"{name}: expected an integer, found {found(value)}") from None
    if not least <= number <= greatest:
        raise ArgumentError(f"{name}: expected an integer from {least} to {greatest}, found {number}")
    return number


def real(value: object, name: str) -> float:
    """A number."""
    if not isinstance(value, (str, bytes, bytearray)):
        try:
            return float(value)  # type: ignore[arg-type]
        except OverflowError:
            raise ArgumentError(f"{name}: expected a number that a float can hold, found {found(value)}") from None
        except (TypeError, ValueError):
            pass
    raise ArgumentTypeError(f"{name}: expected a number, found {found(value)}")


def truth(value: object, name: str) -> bool:
    """A truth; 1 and 0 are none, so that a weight in its place is noticed."""
    if isinstance(value, bool) or (numpy is not None and isinstance(value, numpy.bool_)):
        return bool(value)
    raise ArgumentTypeError(f"{name}: expected True or False, found {found(value)}")


def name_bytes(value: object, name: str) -> bytes:
    """A name, as the library takes it."""
    if not isinstance(value, str):
        raise ArgumentTypeError(f"{name}: expected a str, found {found(value)}")
    if "\0" in value:
        raise ArgumentError(f"{name}: expected a name without a zero character, found {value!r}")
    return value.encode()


def _sequence(values: object, name: str, expected: str) -> Any:
    """`values` as something with a length; iterators are not looked into twice, so they are refused."""
    if isinstance(values, (str, bytes, bytearray, dict, set, frozenset)) or not hasattr(values, "__len__"):
        raise ArgumentTypeError(f"{name}: expected {expected}, found {found(values)}")
    return values


def _array_block(values: Any, name: str) -> Block:
    """A numpy array of real numbers, of any shape; without a copy where it is float64 and C-contiguous."""
    if values.dtype.kind not in "fiu":
        raise ArgumentTypeError(f"{name}: expected real numbers, found {found(values)}")
    block = numpy.ascontiguousarray(values, dtype=numpy.float64)
    return Block(block.ctypes.data_as(_DOUBLE_POINTER), block.size)


def _list_block(values: Iterable[Any], name: str, expected: str) -> Block:
    """Numbers from any iterable of them."""
    try:
        block = array("d", values)
    except (TypeError, OverflowError) as error:
        raise ArgumentTypeError(f"{name}: expected {expected}: {error}") from None
    return Block((ctypes.c_double * len(block)).from_buffer(block), len(block))


def points(values: PointsLike, name: str = "points") -> Block:
    """(n, 3) numbers; the count is that of the points."""
    expected = "an (n, 3) array or a list of [x, y, z]"
    if is_array(values):
        if values.ndim != 2 or values.shape[1] != 3:  # type: ignore[union-attr]
            raise ArgumentError(f"{name}: expected an array of shape (n, 3), found {found(values)}")
        block = _array_block(values, name)
    else:
        rows = _sequence(values, name, expected)
        try:
            wrong = next(((i, row) for i, row in enumerate(rows) if len(row) != 3), None)
        except TypeError:
            raise ArgumentTypeError(f"{name}: expected {expected}, found {found(values)}") from None
        if wrong:
            raise ArgumentError(f"{name}[{wrong[0]}]: expected 3 coordinates, found {found(wrong[1])}")
        block = _list_block(chain.from_iterable(rows), name, expected)
    return Block(block.pointer, integer(block.length // 3, f"number of {name}"))


def vector(values: Any, name: str) -> Block:
    """Three numbers."""
    block = numbers(values, name)
    if block.length != 3:
        raise ArgumentError(f"{name}: expected 3 numbers, found {found(values)}")
    return block


def numbers(values: Any, name: str) -> Block:
    """One number, or a list or 1-D array of them."""
    if is_array(values):
        if values.ndim > 1:
            raise ArgumentError(f"{name}: expected a number or a 1-D array, found {found(values)}")
        return _array_block(values, name)
    if hasattr(values, "__len__"):
        expected = "a number or a list of numbers"
        return _list_block(_sequence(values, name, expected), name, expected)
    return _list_block([real(values, name)], name, "a number")


def _flat(values: Any, name: str) -> Iterable[Any]:
    """The numbers in nested lists."""
    for value in values:
        if hasattr(value, "__len__"):
            yield from _flat(_sequence(value, name, "numbers"), name)
        else:
            yield value


def scalar_sets(values: Optional[ScalarsLike], name: str, set_count: Optional[int]) -> tuple[Block, int]:
    """The scalars of constraints, and the number of their sets.

    With ``set_count`` given, nested values are one set for each of so many constraints, and may be nested deeper (a
    shape as a list of points); otherwise all values are one set.
    """
    if values is None:
        return Block(None, 0), 0
    if is_array(values):
        is_nested, length = values.ndim > 1, len(values) if values.ndim else 0  # type: ignore[union-attr]
        block = _array_block(values, name)
    else:
        sets: Any = _sequence(values, name, "a list of numbers or of lists of numbers")
        length = len(sets)
        is_nested = length > 0 and hasattr(sets[0], "__len__")
        is_deep = is_nested and (is_array(sets[0]) or (len(sets[0]) > 0 and hasattr(sets[0][0], "__len__")))
        numbers = sets if not is_nested else _flat(sets, name) if is_deep else chain.from_iterable(sets)
        try:
            block = _list_block(numbers, name, "a list of numbers or of lists of numbers")
        except ArgumentTypeError:
            block = _list_block(_flat(sets, name), name, "a list of numbers or of lists of numbers")
    if not is_nested or set_count is None:
        return block, 1
    if length != set_count:
        raise ArgumentError(f"{name}: expected one set, or {set_count}, one per constraint; found {length} sets")
    return block, set_count


def ids(values: Any, name: str) -> Block:
    """A list or 1-D array of integers."""
    if is_array(values):
        if values.ndim != 1:
            raise ArgumentError(f"{name}: expected a 1-D array of integers, found {found(values)}")
        return _int_array_block(values, name)
    return _int_block(_sequence(values, name, "a list of integers"), name)


def _int_array_block(values: Any, name: str) -> Block:
    if values.dtype.kind not in "iu":
        raise ArgumentTypeError(f"{name}: expected integers, found {found(values)}")
    if values.size and values.dtype != numpy.int32:
        for value in (values.min(), values.max()):
            integer(value, name, -INT_MAX - 1)
    block = numpy.ascontiguousarray(values, dtype=numpy.int32)
    return Block(block.ctypes.data_as(_INT_POINTER), integer(block.size, f"number of {name}"))


def _int_block(values: Iterable[Any], name: str) -> Block:
    try:
        block = array("i", values)
    except (TypeError, OverflowError) as error:
        kind = ArgumentTypeError if isinstance(error, TypeError) else ArgumentError
        raise kind(f"{name}: expected integers of 32 bits: {error}") from None
    return Block((ctypes.c_int * len(block)).from_buffer(block), integer(len(block), f"number of {name}"))


def index_lists(values: Any, name: str) -> IndexLists:
    """One index list, or many: nested lists (of different lengths or not) or an (n, k) array."""
    if is_array(values):
        if values.ndim not in (1, 2):
            raise ArgumentError(f"{name}: expected an array of shape (k,) or (n, k), found {found(values)}")
        rows = values if values.ndim == 2 else values.reshape(1, -1)
        counts = _int_block([rows.shape[1]], name)
        return IndexLists(_int_array_block(values, name), counts, rows.shape[0], values.ndim == 1)
    lists = _sequence(values, name, "a list of point indices, or of such lists")
    if len(lists) == 0 or hasattr(lists[0], "__len__"):
        try:
            counts = _int_block(map(len, lists), name)
        except ArgumentTypeError:
            raise ArgumentTypeError(f"{name}: expected lists of point indices, found {found(values)}") from None
        return IndexLists(_int_block(chain.from_iterable(lists), name), counts, len(lists), False)
    indices = _int_block(lists, name)
    return IndexLists(indices, _int_block([indices.length], name), 1, True)


def face_lists(values: Any, name: str, corner_count: Optional[int] = None) -> IndexLists:
    """Many index lists; each of ``corner_count`` indices if that is given."""
    lists = index_lists(values, name)
    if lists.is_one:
        raise ArgumentError(f"{name}: expected a list of lists of point indices, found {found(values)}")
    counts = lists.counts.pointer[: lists.counts.length]
    wrong = [count for count in counts if corner_count is not None and count != corner_count]
    if wrong:
        place = name if is_array(values) else f"{name}[{counts.index(wrong[0])}]"
        raise ArgumentError(f"{place}: expected {corner_count} point indices, found {wrong[0]}")
    return lists


def doubles(values: Any) -> Doubles:
    """Numbers that the library filled into a ctypes array, as they are handed out."""
    if numpy is None:
        return list(values)
    # Without its type in words: the description that ctypes gives of empty arrays is wrong in Python 3.9.
    return numpy.frombuffer(values).copy() if len(values) > 0 else numpy.empty(0)


def shaped(values: Any, *shape: int) -> Any:
    """Numbers that the library filled into a ctypes array, as an array of a shape, or nested lists."""
    if numpy is not None:
        return doubles(values).reshape(shape)
    nested: Any = list(values)
    for length in reversed(shape[1:]):
        nested = [nested[i : i + length] for i in range(0, len(nested), length)]
    return nested


def member(kind: Any, value: Any, name: str) -> int:
    """The number of a member of an enum that is given as such or by its name."""
    if isinstance(value, str):
        for one in kind:
            if one.name.lower() == value.lower().replace("-", "_"):
                return int(one)
        names = ", ".join(one.name.lower().replace("_", "-") for one in kind)
        raise ArgumentError(f"{name}: expected one of {names}, found {value!r}")
    return integer(value, name)
