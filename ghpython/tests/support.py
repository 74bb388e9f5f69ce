"""Runs component code as Grasshopper does: compiled once, executed with its inputs as global variables."""

import ctypes as _ctypes  # Jython has a module of this name, without what is needed
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
GHPYTHON = os.path.dirname(HERE)
ROOT = os.path.dirname(GHPYTHON)
COMPONENTS = os.path.join(GHPYTHON, "components")
FIXTURES = os.path.join(ROOT, "tests", "fixtures")

for folder in (os.path.join(GHPYTHON, "stand_ins"), GHPYTHON):
    if folder not in sys.path:
        sys.path.insert(0, folder)
os.environ["SHAPEOP_HOME"] = GHPYTHON

import Grasshopper  # noqa: E402
from Grasshopper.Kernel import GH_Component, GH_Document, GH_RuntimeMessageLevel  # noqa: E402
from Grasshopper.Kernel.Data import GH_Path  # noqa: E402
from Rhino.Geometry import Mesh, Point3d  # noqa: E402

IS_JYTHON = sys.platform.startswith("java")
NEEDS_CTYPES = "ctypes calls no library under Jython"

if not IS_JYTHON and "SHAPEOP_LIBRARY" not in os.environ:
    raise RuntimeError("set SHAPEOP_LIBRARY to the file of the shapeop library, such as /dist/lib/libshapeop.so")


class Canvas(object):
    """A Grasshopper document with components on it."""

    def __init__(self):
        self.document = GH_Document()
        Grasshopper.Instances.DocumentServer.AddDocument(self.document)

    def add(self, folder):
        return Component(self, folder)

    def close(self):
        Grasshopper.Instances.DocumentServer.RemoveDocument(self.document)


class Component(object):
    def __init__(self, canvas, folder):
        self.canvas = canvas
        self.metadata = read_json(os.path.join(COMPONENTS, folder, "metadata.json"))
        with open(os.path.join(COMPONENTS, folder, "code.py")) as file:
            self.code = compile(file.read(), folder, "exec")
        self.inputs = [p["name"] for p in self.metadata["ghpython"]["inputParameters"]]
        self.outputs = [p["name"] for p in self.metadata["ghpython"]["outputParameters"]]
        self.component = GH_Component()
        self.missing = ()  # ports that this one does not have, as one whose code alone was replaced
        canvas.document.AddObject(self.component, False)

    def run(self, **inputs):
        """Solves the component; an input that is not given is not connected. Returns its outputs by name."""
        assert set(inputs) <= set(self.inputs), inputs
        self.component.ClearRuntimeMessages()
        scope = {"__name__": "__main__", "ghenv": _Environment(self.component)}
        scope.update((name, inputs.get(name)) for name in self.inputs if name not in self.missing)
        _execute(self.code, scope)
        return dict((name, scope[name]) for name in self.outputs)

    def run_scheduled(self, **inputs):
        """As Grasshopper does when time has passed: runs what is scheduled, solves the component if that expired it.
        None if it was not."""
        scheduled, self.canvas.document._scheduled = self.canvas.document._scheduled, []
        self.component._is_expired = False
        for delegate in scheduled:
            delegate.Invoke(self.canvas.document)
        return self.run(**inputs) if self.component._is_expired else None

    def errors(self):
        return self.component.RuntimeMessages(GH_RuntimeMessageLevel.Error)

    def delete(self):
        self.canvas.document.RemoveObject(self.component, False)


def _execute(code, scope):
    """On its own, as Python 2 wants it."""
    exec(code, scope)


class _Environment(object):
    def __init__(self, component):
        self.Component = component


def read_json(path):
    with open(path) as file:
        return json.load(file)


def tree(*branches):
    """A tree input {0}, {1}, ... without a type hint."""
    made = Grasshopper.DataTree[object]()
    for n, branch in enumerate(branches):
        for item in branch:
            made.Add(item, GH_Path(n))
    return made


def plain(made):
    """A tree as [(indices of the path, items)]."""
    return [(path.Indices, list(branch)) for path, branch in zip(made.Paths, made.Branches)]


def points(flat):
    return [Point3d(*flat[i : i + 3]) for i in range(0, len(flat), 3)]


def flat(given):
    return [c for p in given for c in (p.X, p.Y, p.Z)]


def grid(columns, rows, height=lambda i, j: 0.0):
    """A mesh of quads with columns x rows vertices."""
    mesh = Mesh()
    for j in range(rows):
        for i in range(columns):
            mesh.Vertices.Add(i, j, height(i, j))
    for j in range(rows - 1):
        for i in range(columns - 1):
            a = j * columns + i
            mesh.Faces.AddFace(a, a + 1, a + 1 + columns, a + columns)
    return mesh


def signature(canvas, constraint_type, indices, weights=(1.0,), scalars=(), **others):
    """The output of a ConstraintSignature component."""
    made = canvas.add("ShapeOpConstraintSignature").run(
        ConstraintType=constraint_type,
        PointIndices=tree(*indices),
        Weights=list(weights),
        Scalars=tree(*scalars),
        **others
    )
    return made["ConstraintSigs"]


class Calls(object):
    """Counts the calls of the native library by new solvers: `with Calls() as calls: ... calls["shapeop_solve"]`."""

    def __enter__(self):
        from shapeop_gh import library

        self._library, self._load = library, library.load
        self._counts, real = {}, library.load()
        counts = self._counts

        class Counting(object):
            def __getattr__(self, name):
                counts[name] = counts.get(name, 0) + 1
                return getattr(real, name)

        library.load = lambda path=None: Counting()
        return self

    def __exit__(self, *exception):
        self._library.load = self._load

    def __getitem__(self, name):
        return self._counts.get(name, 0)

    def without(self, name):
        """The counts of all functions but one."""
        return dict((n, count) for n, count in self._counts.items() if n != name)

    def clear(self):
        self._counts.clear()


class Direct(object):
    """The library called directly, as a C program would: one solver, no Python in between but ctypes."""

    def __init__(self, coordinates):
        from shapeop_gh import library

        self.library, self.count = library.load(), len(coordinates) // 3
        self.op = self.library.shapeop_create()
        self.library.shapeop_setPoints(self.op, doubles(coordinates), self.count)

    def add(self, constraint_type, indices, weight):
        array = (_ctypes.c_int * len(indices))(*indices)
        return self.library.shapeop_addConstraint(self.op, constraint_type.encode(), array, len(indices), weight)

    def edit(self, constraint_type, constraint, scalars):
        array = doubles(scalars)
        assert (
            self.library.shapeop_editConstraint(self.op, constraint_type.encode(), constraint, array, len(array)) == 0
        )

    def points(self):
        array = doubles([0.0] * (3 * self.count))
        self.library.shapeop_getPoints(self.op, array, self.count)
        return list(array)

    def delete(self):
        self.library.shapeop_delete(self.op)


def doubles(values):
    return (_ctypes.c_double * len(values))(*values)
