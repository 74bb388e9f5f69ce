"""The component folders: code, metadata, icon, documentation."""

import os
import re
import struct
import unittest
import uuid

from support import COMPONENTS, GHPYTHON, ROOT, read_json

NAMES = sorted(n for n in os.listdir(COMPONENTS) if os.path.isdir(os.path.join(COMPONENTS, n)) and n != "__pycache__")

# The published client's: name, nickname, inputs, outputs. Existing definitions are wired to these.
PUBLISHED = {
    "ShapeOpMeshIndexer": ("SOMI", "Pattern Mesh", "PointIndices"),
    "ShapeOpAnchorsIndexer": ("SOAI", "Mesh AnchorGeo", "PointIndices AnchorPts"),
    "ShapeOpConstraintSignature": ("SOCSig", "ConstraintType PointIndices Weights Scalars", "ConstraintSigs"),
    "ShapeOpSettingsStatic": ("SOSS", "Iterations", "Settings"),
    "ShapeOpSettingsLive": ("SOSL", "Iterations Mass Damping TimeStep UnaryVector Dynamic Pause Reset", "Settings"),
    "ShapeOpConstraintSolver": ("SOSolver", "ConstraintSigs Points Settings", "Iterations ConstraintCount Points"),
}

# Ports that ours have behind those, which definitions need not be wired to.
ADDED = {"ShapeOpConstraintSignature": ["Hard"]}

# The access that the published client's code relies on.
ACCESS = {
    "ShapeOpAnchorsIndexer": {"AnchorGeo": "list"},
    "ShapeOpConstraintSignature": {"PointIndices": "tree", "Weights": "list", "Scalars": "tree"},
    "ShapeOpConstraintSolver": {"ConstraintSigs": "list", "Points": "list"},
}

EXPECTED_BOOTSTRAP = "# The same lines in every component"


def text(*path):
    with open(os.path.join(*path)) as file:
        return file.read()


def metadata(name):
    return read_json(os.path.join(COMPONENTS, name, "metadata.json"))


def ports(name, side):
    return metadata(name)["ghpython"][side + "Parameters"]


class Folders(unittest.TestCase):
    def test_the_published_components_keep_names_and_ports(self):
        for name, (nickname, inputs, outputs) in PUBLISHED.items():
            self.assertEqual(metadata(name)["name"], "ShapeOp " + name[len("ShapeOp") :])
            self.assertEqual(metadata(name)["nickname"], nickname)
            self.assertEqual([p["name"] for p in ports(name, "input")], inputs.split() + ADDED.get(name, []))
            self.assertTrue(all(port["optional"] for port in ports(name, "input")))
            self.assertEqual([p["name"] for p in ports(name, "output")], outputs.split())
            for port in ports(name, "input"):
                self.assertEqual(port["scriptParamAccess"], ACCESS.get(name, {}).get(port["name"], "item"))

    def test_names_nicknames_and_guids_are_unique(self):
        for key in ("name", "nickname", "instanceGuid"):
            self.assertEqual(len(set(metadata(n)[key] for n in NAMES)), len(NAMES), key)
        for name in NAMES:
            self.assertEqual(str(uuid.UUID(metadata(name)["instanceGuid"])), metadata(name)["instanceGuid"])

    def test_every_port_says_what_it_is_for_and_is_named_as_its_variable(self):
        for name in NAMES:
            self.assertTrue(metadata(name)["description"])
            for port in ports(name, "input") + ports(name, "output"):
                self.assertEqual(port["name"], port["nickname"])
                self.assertTrue(port["description"].endswith("."), (name, port["name"]))

    def test_the_code_is_the_bootstrap_and_one_call_of_all_ports(self):
        parts = []
        for name in NAMES:
            head, rest = text(COMPONENTS, name, "code.py").split(EXPECTED_BOOTSTRAP)
            self.assertEqual(head, '"""%s"""\n\n' % metadata(name)["description"])
            bootstrap, end, call = rest.partition('restart Rhino" % error\n    )\n')
            self.assertTrue(end)
            parts.append(bootstrap + end)
            # A port that definitions may not have is asked for.
            call = re.sub(r"globals\(\)\.get\(\"(\w+)\"\),  # .*", r"\1,", call)
            found = re.match(r"^\n([\w, ]+) = host\.run\(([\w.,\s]+)\)\n$", call)
            self.assertTrue(found, (name, call))
            outputs, arguments = [[a.strip() for a in group.strip(", \n").split(",")] for group in found.groups()]
            self.assertEqual(outputs, [p["name"] for p in ports(name, "output")])
            self.assertEqual(arguments[:2], ["ghenv", str(len(outputs))])
            self.assertTrue(arguments[2].startswith("components."), arguments[2])
            self.assertEqual(arguments[3:], [p["name"] for p in ports(name, "input")])
        self.assertEqual(len(set(parts)), 1)

    def test_icons_are_24_pixels_square_and_no_two_alike(self):
        icons = set()
        for name in NAMES:
            with open(os.path.join(COMPONENTS, name, "icon.png"), "rb") as file:
                icon = file.read()
            self.assertEqual(icon[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack(">II", icon[16:24]), (24, 24))
            icons.add(icon)
        self.assertEqual(len(icons), len(NAMES))

    def test_the_documentation_lists_every_component_and_port(self):
        documented = text(ROOT, "docs", "grasshopper.md")
        for name in NAMES:
            described = metadata(name)
            start = documented.index("### %s (%s)\n" % (described["name"], described["nickname"]))
            section = documented[start:].split("\n### ")[0].split("\n## ")[0]
            self.assertIn(described["description"], section)
            rows = re.findall(r"^\| (in|out) \| `(\w+)` \| (.*) \|$", section, re.M)
            expected = [("in", p["name"], p["description"]) for p in ports(name, "input")]
            expected += [("out", p["name"], p["description"]) for p in ports(name, "output")]
            self.assertEqual(rows, expected)
        self.assertEqual(len(re.findall(r"^### ShapeOp ", documented, re.M)), len(NAMES))

    def test_no_list_of_constraint_types_is_written_a_second_time(self):
        # Two are named for what they do: handles are Closeness, and the published client's name of Angle is known.
        allowed = {"components.py": {"Closeness"}, "signatures.py": {"Angle"}}
        types = re.findall(r"^\| ([A-Z]\w+) \|.*\|$", text(ROOT, "docs", "constraints.md"), re.M)
        self.assertTrue(len(types) > 15 and "Closeness" in types)
        for name in sorted(os.listdir(os.path.join(GHPYTHON, "shapeop_gh"))):
            if name.endswith(".py") and name != "_abi.py":
                found = set(t for t in types if '"%s"' % t in text(GHPYTHON, "shapeop_gh", name))
                self.assertEqual(found, allowed.get(name, set()), name)


if __name__ == "__main__":
    unittest.main()
