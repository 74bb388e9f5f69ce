"""The native library through ctypes: found, loaded by its absolute path, declared, its ABI version compared.

The declarations are those of `_abi.py`, which the build makes from the library's sources and the package carries
beside this file. IronPython 2.7 (Rhino 7) differs from CPython in ways that the code here and in `solver` keeps to:

- An argument declared as POINTER(c_double) refuses an array or takes it, depending on the version; byref(array) is
  always refused, and a pointer object may be passed as its own address. An array for a declared c_void_p works in all
  versions. So pointers to numbers are declared as c_void_p there.
- byref(struct) for POINTER(struct) works.
- str is unicode, and b"..." is another type that c_char_p() refuses: texts go in as c_char_p(str).
- None is refused for a callback; a callback object made without a function is a null pointer.
- Reading a c_char_p field of a struct that is null crashes: no such field is read.
"""

import ctypes
import os
import sys

from shapeop_gh.errors import ShapeOpError

FOLDER = os.path.dirname(os.path.abspath(__file__))

_loaded = {}


def load(path=None):
    """The declared library, loaded once per path. `path`: by default SHAPEOP_LIBRARY, else the file beside this one."""
    path = os.path.abspath(path or os.environ.get("SHAPEOP_LIBRARY") or os.path.join(FOLDER, file_name()))
    if path not in _loaded:
        _loaded[path] = _load(path)
    return _loaded[path]


def file_name():
    """The file name of the library on this platform."""
    if os.name == "nt":
        return "shapeop.dll"
    return "libshapeop.dylib" if sys.platform == "darwin" else "libshapeop.so"


def declarations():
    """The module `_abi`: beside this file in a package, among the Python bindings in the source tree."""
    try:
        from shapeop_gh import _abi
    except ImportError:
        folder = os.path.join(FOLDER, "..", "..", "bindings", "python", "src", "shapeop")
        sys.path.insert(0, folder)
        try:
            import _abi
        except ImportError:
            raise ShapeOpError("_abi.py is missing in %s: reinstall the ShapeOp package" % FOLDER)
        finally:
            sys.path.remove(folder)
    return _abi


def declare(library, arrays_as_addresses):
    """Sets argument and result types; `arrays_as_addresses` declares pointers to numbers as c_void_p, as IronPython
    needs them."""
    abi = declarations()
    abi.declare(library)
    if not arrays_as_addresses:
        return
    pointers = (ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int))
    for name in abi.FUNCTIONS:
        function = getattr(library, name)
        function.argtypes = [ctypes.c_void_p if a in pointers else a for a in function.argtypes]


def _load(path):
    if not os.path.isfile(path):
        raise ShapeOpError(
            "the ShapeOp library is not at %s: reinstall the ShapeOp package, or set the environment variable "
            "SHAPEOP_LIBRARY to the library's file" % path
        )
    try:
        library = ctypes.CDLL(path)
    except (OSError, NotImplementedError) as error:
        raise ShapeOpError("the ShapeOp library %s cannot be loaded: %s" % (path, error))
    expected = declarations().ABI_VERSION
    try:
        found = library.shapeop_abiVersion()
    except AttributeError:
        raise ShapeOpError("%s is not the ShapeOp library" % path)
    if found != expected:
        raise ShapeOpError("%s has ABI version %s, but version %s is needed" % (path, found, expected))
    try:
        declare(library, sys.platform == "cli")
    except AttributeError as error:
        raise ShapeOpError("%s is older than these components: %s" % (path, error))
    return library


_texts = {}


def to_c(text):
    """`text` for a `const char *`. Kept for ever, as IronPython frees none of them: pass names, which are few."""
    if text not in _texts:
        _texts[text] = ctypes.c_char_p(
            text if isinstance(text, str) and sys.version_info[0] == 2 else text.encode("utf-8")
        )
    return _texts[text]


def from_c(text):
    """A text of the library as str."""
    return text if isinstance(text, str) else text.decode("utf-8")


def doubles(values, what):
    return _array(ctypes.c_double, float, values, what)


def ints(values, what):
    return _array(ctypes.c_int, _int, values, what)


def _int(value):
    number = int(value)
    if number != value or not -(2**31) <= number < 2**31:
        raise ValueError
    return number


def _array(c_type, convert, values, what):
    """A C array of `values`, which are converted one by one; `what` names them in the error."""
    try:
        return (c_type * len(values))(*[convert(v) for v in values])
    except (TypeError, ValueError, OverflowError):
        for i, value in enumerate(values):
            try:
                convert(value)
            except (TypeError, ValueError, OverflowError):
                place = what if len(values) == 1 else "%s: item %d" % (what, i)
                expected = "a number" if c_type is ctypes.c_double else "a whole number"
                raise ShapeOpError("%s: %s expected, found %r" % (place, expected, value))
        raise


def error_of(library, handle):
    return from_c(library.shapeop_lastError(handle))


def constraint_types(library):
    """All constraint types as dicts: name, help, least and greatest (-1: any) number of points, scalars, unit."""
    abi = declarations()
    return [_constraint_type(library, abi, i) for i in range(library.shapeop_constraintTypeCount())]


def _constraint_type(library, abi, index):
    entry = abi.shapeop_constraint_type()
    entry.struct_size = ctypes.sizeof(abi.shapeop_constraint_type)
    _check(library, library.shapeop_constraintType(index, ctypes.byref(entry)))
    scalars = []
    for i in range(entry.scalar_count):
        scalar = abi.shapeop_constraint_scalar()
        scalar.struct_size = ctypes.sizeof(abi.shapeop_constraint_scalar)
        _check(library, library.shapeop_constraintScalar(index, i, ctypes.byref(scalar)))
        default = " = %.12g" % scalar.default_value if scalar.has_default else ""
        scalars.append(from_c(scalar.name) + default)
    names = [from_c(library.shapeop_constraintIndexName(index, i)) for i in range(entry.index_name_count)]
    return {
        "name": from_c(entry.name),
        "help": from_c(entry.help),
        "least": entry.least_indices,
        "greatest": entry.greatest_indices,
        "points": names,
        "scalars": scalars if entry.scalar_count >= 0 else ["x y z of each point of each shape"],
        "unit": from_c(entry.violation_unit),
    }


def measure_faces(library, measure, coordinates, faces):
    """One number per face: see shapeop_measureFaces. `faces`: a list of lists of point indices."""
    points = doubles(coordinates, "Points")
    indices = ints([i for face in faces for i in face], "PointIndices")
    counts = ints([len(face) for face in faces], "PointIndices")
    out = (ctypes.c_double * len(faces))()
    _check(
        library,
        library.shapeop_measureFaces(
            to_c(measure), points, len(points) // 3, indices, len(indices), counts, len(counts), out, len(out)
        ),
    )
    return out[:]


def _check(library, code):
    if code != 0:
        raise ShapeOpError(error_of(library, None))
