"""Finding, loading and declaring the native library; callers that declare nothing."""

import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import GHPYTHON, IS_JYTHON, NEEDS_CTYPES, ROOT, Canvas, Direct, flat, plain, points, signature, tree

if not IS_JYTHON:
    from shapeop_gh import library
from shapeop_gh.errors import ShapeOpError

CORNERS = [0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1]


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Library(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()

    def tearDown(self):
        shutil.rmtree(self.folder)

    def refused(self, path, text):
        try:
            library.load(path)
        except ShapeOpError as error:
            self.assertIn(text, str(error))
        else:
            self.fail(path)

    def test_a_missing_library_is_an_error_that_tells_how_to_install(self):
        path = os.path.join(self.folder, library.file_name())
        self.refused(path, path)
        self.refused(path, "SHAPEOP_LIBRARY")

    def test_a_file_that_is_no_library_is_refused(self):
        path = os.path.join(self.folder, "text.so")
        with open(path, "w") as file:
            file.write("nothing to load\n")
        self.refused(path, "cannot be loaded")

    def test_another_library_and_another_abi_version_are_refused(self):
        for text, source in (
            ("is not the ShapeOp library", "int hello(void) { return 0; }"),
            ("has ABI version 99", "int shapeop_abiVersion(void) { return 99; }"),
            (
                "is older than these components",
                "int shapeop_abiVersion(void) { return %d; }" % library.declarations().ABI_VERSION,
            ),
        ):
            path = os.path.join(self.folder, "lib%d.so" % len(text))
            with open(path + ".c", "w") as file:
                file.write(source)
            subprocess.check_call(["cc", "-shared", "-fPIC", "-o", path, path + ".c"])
            self.refused(path, text)

    def test_every_function_is_declared_also_where_arrays_are_addresses(self):
        for arrays_as_addresses in (False, True):
            loaded = ctypes.CDLL(os.environ["SHAPEOP_LIBRARY"])
            library.declare(loaded, arrays_as_addresses)
            names = library.declarations().FUNCTIONS
            self.assertTrue(len(names) > 40)
            for name in names:
                self.assertIsNotNone(getattr(loaded, name).argtypes, name)
            argument = loaded.shapeop_setPoints.argtypes[1]
            self.assertEqual(argument, ctypes.c_void_p if arrays_as_addresses else ctypes.POINTER(ctypes.c_double))

    def test_declared_as_ironpython_needs_it_the_points_are_the_same_bits(self):
        usual = self.solved()
        loaded = ctypes.CDLL(os.environ["SHAPEOP_LIBRARY"])
        library.declare(loaded, True)
        path = os.path.abspath(os.environ["SHAPEOP_LIBRARY"])
        before, library._loaded[path] = library._loaded.get(path), loaded
        try:
            self.assertEqual(self.solved(), usual)
        finally:
            library._loaded[path] = before

    def solved(self):
        canvas = Canvas()
        made = signature(canvas, "Plane", [[0, 1, 2, 3]]) + signature(
            canvas, "Closeness", [[0]], [0.5], [[0.0, 0.1, 0.2]]
        )
        given = dict(ConstraintSigs=tree(made), Points=tree(points(CORNERS)))
        live, once = canvas.add("ShapeOpLiveSolver"), canvas.add("ShapeOpOneShotSolver")
        types = canvas.add("ShapeOpConstraintTypes").run()["Types"]
        result = [r for c in (live, once) for r in [flat(plain(c.run(**given)["Points"])[0][1])]]
        self.assertEqual(live.errors() + once.errors(), [])
        canvas.close()
        return result, types

    def test_texts_arrays_and_wrong_entries(self):
        self.assertEqual(library.from_c(library.to_c("Plane").value), "Plane")
        self.assertEqual(library.ints([1, 2.0, True], "ids")[:], [1, 2, 1])
        for wrong in (2**31, -(2**31) - 1, 0.5, None, "1", float("nan"), float("inf")):
            self.assertRaises(ShapeOpError, library.ints, [0, wrong], "ids")
        for wrong in (None, "one", [1.0]):
            self.assertRaises(ShapeOpError, library.doubles, [0, wrong], "Points")

    def test_a_deleted_solver_refuses(self):
        from shapeop_gh.solver import Solver

        solver = Solver()
        solver.set_points(CORNERS)
        solver.delete()
        for call in (
            lambda: solver.points(),
            lambda: solver.solve(1),
            lambda: solver.set_points(CORNERS),
            lambda: solver.energy(),
        ):
            self.assertRaises(ShapeOpError, call)


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Undeclared(unittest.TestCase):
    """The published client itself declares no types."""

    def setUp(self):
        self.library = ctypes.CDLL(os.environ["SHAPEOP_LIBRARY"])

    def test_the_published_client_s_calls_without_declarations_give_the_same_points(self):
        # Its habits: arrays by reference, a text as c_char_p, plain ints; a number where the type matters as c_double.
        lib, count = self.library, 4
        op = lib.shapeop_create()
        coordinates = (ctypes.c_double * 12)(*CORNERS)
        lib.shapeop_setPoints(op, ctypes.byref(coordinates), count)
        quad, first = (ctypes.c_int * 4)(0, 1, 2, 3), (ctypes.c_int * 1)(0)
        plane, closeness = ctypes.c_char_p(b"Plane"), ctypes.c_char_p(b"Closeness")
        self.assertEqual(lib.shapeop_addConstraint(op, plane, ctypes.byref(quad), 4, ctypes.c_double(1.0)), 0)
        self.assertEqual(lib.shapeop_addConstraint(op, closeness, ctypes.byref(first), 1, ctypes.c_double(0.5)), 1)
        force = (ctypes.c_double * 3)(0.0, 0.0, -0.1)
        lib.shapeop_addGravityForce(op, force)
        numbers = [ctypes.c_double(v) for v in (1.0, 0.9, 0.1)]
        self.assertEqual(lib.shapeop_initDynamic(op, *numbers), 0)
        direct = Direct(CORNERS)
        direct.add("Plane", [0, 1, 2, 3], 1.0)
        direct.add("Closeness", [0], 0.5)
        direct.library.shapeop_addGravityForce(direct.op, force)
        direct.library.shapeop_initDynamic(direct.op, 1.0, 0.9, 0.1)
        for tick in range(20):
            target = [0.0, 0.1 * tick, 0.2]
            scalars = (ctypes.c_double * 3)(*target)
            self.assertEqual(lib.shapeop_editConstraint(op, closeness, 1, ctypes.byref(scalars), 3), 0)
            self.assertEqual(lib.shapeop_solve(op, 5), 0)
            lib.shapeop_getPoints(op, ctypes.byref(coordinates), count)
            direct.edit("Closeness", 1, target)
            direct.library.shapeop_solve(direct.op, 5)
            self.assertEqual(list(coordinates), direct.points())
        lib.shapeop_delete(op)
        direct.delete()


class Bootstrap(unittest.TestCase):
    """How a component finds the package where it is installed: in a process of its own, from an empty folder."""

    def setUp(self):
        self.home = tempfile.mkdtemp()
        with open(os.path.join(GHPYTHON, "components", "ShapeOpSettingsStatic", "code.py")) as file:
            lines = file.read().split("Settings = ")[0]
        # Instead of the real modules, each installed package says who it is.
        self.code = lines.replace("import components, host", "import who") + "\nprint(who.name)\n"

    def tearDown(self):
        shutil.rmtree(self.home)

    def install(self, folder, name):
        package = os.path.join(self.home, folder, "shapeop_gh")
        os.makedirs(package)
        open(os.path.join(package, "__init__.py"), "w").close()
        with open(os.path.join(package, "who.py"), "w") as file:
            file.write("name = %r\n" % name)

    def run_code(self, **environment):
        script = os.path.join(self.home, "code.py")
        with open(script, "w") as file:
            file.write(self.code)
        env = dict((k, v) for k, v in os.environ.items() if k not in ("SHAPEOP_HOME", "APPDATA", "PYTHONPATH"))
        env.update(HOME=self.home, **environment)
        process = subprocess.Popen(
            [sys.executable, script], env=env, cwd=self.home, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        out, err = process.communicate()
        return out.decode().strip(), err.decode()

    def test_the_newest_version_of_either_rhino_is_taken(self):
        for data in ("appdata", "Library/Application Support"):
            packages = data + "/McNeel/Rhinoceros/packages/"
            for rhino, version in (("7.0", "0.9.0"), ("7.0", "0.10.0-beta"), ("8.0", "0.10.0"), ("8.0", "0.2.11")):
                self.install(packages + rhino + "/ShapeOp/" + version, version)
            os.makedirs(os.path.join(self.home, packages, "8.0", "ShapeOp", "0.99.0"))  # an empty folder is no package
            out, err = self.run_code(APPDATA=os.path.join(self.home, "appdata"))
            self.assertEqual(out, "0.10.0", err)
            shutil.rmtree(os.path.join(self.home, data))

    def test_shapeop_home_comes_first(self):
        self.install("appdata/McNeel/Rhinoceros/packages/8.0/ShapeOp/9.0.0", "9.0.0")
        self.install("mine", "mine")
        out, err = self.run_code(
            APPDATA=os.path.join(self.home, "appdata"), SHAPEOP_HOME=os.path.join(self.home, "mine")
        )
        self.assertEqual(out, "mine", err)

    def test_a_folder_that_python_knows_is_enough(self):
        self.install("scripts", "scripts")
        out, err = self.run_code(
            PYTHONPATH=os.path.join(self.home, "scripts"), JYTHONPATH=os.path.join(self.home, "scripts")
        )
        self.assertEqual(out, "scripts", err)

    def test_where_there_is_none_the_error_tells_how_to_install(self):
        out, err = self.run_code()
        self.assertEqual(out, "")
        self.assertIn("PackageManager", err)
        self.assertIn("SHAPEOP_HOME", err)


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Scripts(unittest.TestCase):
    def test_the_callers_that_declare_nothing_run(self):
        if sys.version_info[0] == 2:
            self.skipTest("these scripts are written for Python 3")
        folder = tempfile.mkdtemp()
        try:
            shutil.copy(os.environ["SHAPEOP_LIBRARY"], os.path.join(folder, "ShapeOp.0.1.0.dll"))
            for name in ("undeclared.py", "client_loop.py"):
                script = os.path.join(ROOT, "tests", "python", name)
                subprocess.check_call([sys.executable, script], env=dict(os.environ, LD_LIBRARY_PATH=folder))
        finally:
            shutil.rmtree(folder)


if __name__ == "__main__":
    unittest.main()
