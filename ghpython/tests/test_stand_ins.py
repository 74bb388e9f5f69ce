"""The stand-ins promise nothing that Rhino does not have: every public name is compared with the published stubs of
Rhino 7 and Rhino 8. And the sources keep to the syntax of Python 2.7."""

import ast
import keyword
import os
import re
import subprocess
import sys
import unittest

from support import COMPONENTS, GHPYTHON

STAND_INS = os.path.join(GHPYTHON, "stand_ins")
# Packages of tests/requirements.txt, by the folders that they install.
STUBS = {"Rhino 7": ("Rhino-stubs", "Grasshopper-stubs"), "Rhino 8": ("Rhino", "Grasshopper")}
# Not in the stubs: the generic DataTree (the SDK has Add, Paths, Branches, BranchCount and DataCount); that the
# delegate is nested in its document; and in those of Rhino 7 the generic list that Polyline inherits.
UNKNOWN = {("Grasshopper", "DataTree"), ("Grasshopper.Kernel", "GH_Document", "GH_ScheduleDelegate")}
INHERITED_IN_RHINO_7 = {("Rhino.Geometry", "Polyline", "First"), ("Rhino.Geometry", "Polyline", "Last")}


def classes(path):
    """Per class of a source or stub: its bases, its members, and what its methods set on self."""
    with open(path) as file:
        # Some stubs have parameters that are called as Python's keywords.
        source = re.sub(r"([(,]\s*)(%s):" % "|".join(keyword.kwlist), r"\1\2_:", file.read())
    module = ast.parse(source)
    found = {}
    for node in module.body:
        if isinstance(node, ast.ClassDef):
            bases, members = found.setdefault(node.name, (set(), set()))
            bases.update(b.id if isinstance(b, ast.Name) else getattr(b, "attr", "") for b in node.bases)
            for part in ast.walk(node):
                if isinstance(part, ast.FunctionDef):
                    members.add(part.name)
                elif isinstance(part, ast.Attribute) and isinstance(part.ctx, ast.Store) and is_self(part.value):
                    members.add(part.attr)
                elif isinstance(part, ast.Assign) and part in node.body:
                    members.update(t.id for t in part.targets if isinstance(t, ast.Name))
                elif isinstance(part, ast.AnnAssign) and part in node.body:
                    members.add(part.target.id)
    return found


def is_self(node):
    return isinstance(node, ast.Name) and node.id == "self"


def all_members(known, name, seen=()):
    bases, members = known[name]
    inherited = set(members)
    for base in bases:
        if base in known and base not in seen:
            inherited |= all_members(known, base, seen + (name,))
    return inherited


def stand_in_modules():
    for folder, _, files in os.walk(STAND_INS):
        for file in files:
            if file.endswith(".py") and os.path.relpath(folder, STAND_INS).split(os.sep)[0] in ("Rhino", "Grasshopper"):
                path = os.path.join(folder, file)
                parts = os.path.relpath(path, STAND_INS)[: -len(".py")].split(os.sep)
                yield ".".join(p for p in parts if p != "__init__"), path


def site_packages():
    return [p for p in sys.path if os.path.isdir(os.path.join(p, "Rhino-stubs"))]


# They come with what the tests under the newest Python install, which leave nothing out.
@unittest.skipUnless(site_packages(), "without the stubs: pip install -r ghpython/tests/requirements.txt")
class Honest(unittest.TestCase):
    def stub(self, version, module):
        site = site_packages()[0]
        package, _, rest = module.partition(".")
        (folder,) = [f for f in STUBS[version] if f.split("-")[0] == package]
        path = os.path.join(site, folder, *rest.split("."))
        return path + ".pyi" if os.path.isfile(path + ".pyi") else os.path.join(path, "__init__.pyi")

    def test_every_public_name_of_a_stand_in_is_one_of_rhino_7_and_of_rhino_8(self):
        compared, missing = 0, []
        for version in STUBS:
            unknown = UNKNOWN | (INHERITED_IN_RHINO_7 if version == "Rhino 7" else set())
            for module, path in stand_in_modules():
                known = classes(self.stub(version, module))
                for name, (_, members) in classes(path).items():
                    if name.startswith("_"):
                        continue
                    if name not in known:
                        missing.append((version, module, name))
                        continue
                    promised = all_members(known, name)
                    for member in members:
                        if member.startswith("_") or (module, name, member) in unknown:
                            continue
                        compared += 1
                        # An event is a pair of methods in the stubs.
                        if member not in promised and "add_" + member not in promised:
                            missing.append((version, module, name, member))
        print("\n%d names of stand-ins compared with the stubs" % compared)
        self.assertEqual(missing, [])
        self.assertTrue(compared > 100, compared)

    def test_the_comparison_finds_a_name_that_rhino_does_not_have(self):
        known = classes(self.stub("Rhino 7", "Rhino.Geometry"))
        self.assertIn("GetNakedEdges", all_members(known, "Mesh"))
        self.assertNotIn("GetNakedVertices", all_members(known, "Mesh"))

    def test_what_the_components_take_from_rhino_is_in_the_stand_ins(self):
        # So that nothing of Rhino is used that was not compared.
        taken = set()
        folder = os.path.join(GHPYTHON, "shapeop_gh")
        for file in os.listdir(folder):
            if file.endswith(".py"):
                with open(os.path.join(folder, file)) as source:
                    for node in ast.walk(ast.parse(source.read())):
                        if isinstance(node, ast.ImportFrom) and node.module.split(".")[0] in ("Rhino", "Grasshopper"):
                            taken.update((node.module, alias.name) for alias in node.names)
        self.assertTrue(taken)
        present = dict((module, classes(path)) for module, path in stand_in_modules())
        for module, name in taken:
            if (module, name) not in UNKNOWN:
                self.assertIn(name, present[module])


@unittest.skipUnless(site_packages(), "without vermin: pip install -r ghpython/tests/requirements.txt")
class Syntax(unittest.TestCase):
    def test_everything_keeps_to_the_syntax_of_python_2_7(self):
        folders = [COMPONENTS] + [os.path.join(GHPYTHON, f) for f in ("shapeop_gh", "stand_ins", "tests")]
        checker = [
            os.path.join(os.path.dirname(sys.executable), "vermin"),
            "-t=2.7-",
            "--violations",
            "--no-tips",
            "--eval-annotations",
        ]
        for folder in folders:
            sources = [os.path.join(d, f) for d, _, files in os.walk(folder) for f in files if f.endswith(".py")]
            sources = [s for s in sources if os.path.basename(s) != os.path.basename(__file__)]  # reads stubs: 3 only
            process = subprocess.Popen(checker + sources, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            out, _ = process.communicate()
            self.assertEqual(process.returncode, 0, out.decode())


if __name__ == "__main__":
    unittest.main()
