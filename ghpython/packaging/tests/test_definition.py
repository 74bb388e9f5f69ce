"""Definitions: their structure beside that of a public one, wires, and that each build gives the same bits."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path
from typing import Dict, Set, Tuple

import pytest

import archive
import components
import definition
import xml_form
from archive import Chunk
from components import HOSTS, RHINO7
from definition import Definition

SAMPLE = Path(__file__).parent / "sample"


def sample(host=RHINO7) -> Definition:
    """A definition with each kind of object."""
    made = Definition("sample.ghx", "A definition for the tests", host)
    component = components.load(SAMPLE / "Sum")
    first = made.component("sum", component, (400, 100))
    second = made.component("sum of sums", component, (600, 100), "again")
    slider = made.slider("slider", "A", 0.25, 0, 1, 2, (100, 100))
    whole = made.slider("whole", "B", 3, 0, 10, 0, (100, 130))
    panel = made.panel("panel", "1.5", (100, 160), (160, 40), "C")
    toggle = made.toggle("toggle", "D", True, (100, 220))
    button = made.button("button", "E", (100, 260))
    unit = made.unit_z("unit z", (100, 300))
    for source in (slider, whole, panel):
        made.wire(source, first, "Numbers")
    made.wire((first, "Total"), second, "Numbers")
    made.wire(slider, unit, "Factor")
    made.wire((unit, "Unit vector"), second, "Mesh")
    made.group("group", "Inputs", [slider, whole, panel, toggle, button])
    return made


def places_by_kind(root: Chunk) -> Dict[str, Set[Tuple[str, int]]]:
    """What is at each place outside the objects, and in each kind of object."""
    found: Dict[str, Set[Tuple[str, int]]] = defaultdict(set)
    objects = root.chunk("Definition").chunk("DefinitionObjects")
    kept, objects.chunks = objects.chunks, []
    trees = [("", root)] + [(str(o.get("GUID")), o) for o in kept]
    for kind, tree in trees:
        for path, chunk in tree.walk():
            place = kind + re.sub(r"\[\d+\]", "[]", path)
            found[place] |= {(i.name + ("[]" if i.index >= 0 else ""), i.type) for i in chunk.items}
            found[place] |= {(c.name + ("[]" if c.index >= 0 else ""), 0) for c in chunk.chunks}
    objects.chunks = kept
    return found


def test_our_definitions_have_the_structure_of_a_public_one(public_files, say) -> None:
    (name,) = [n for n in public_files if n.endswith(".gh")]
    public = places_by_kind(archive.read(public_files[name]))
    # Unit Z beside its sister Unit Y; no public file here has a toggle.
    unit_y, unit_z = "d3d195ea-2d59-4ffa-90b1-8b7ff3369f69", str(definition.UNIT_Z)
    public.update({p.replace(unit_y, unit_z): names for p, names in list(public.items()) if p.startswith(unit_y)})
    # What Rhino 8's and COMPAS's user objects have in a component's state; the public definition is of Rhino 7.
    state = {("IconDisplay", archive.INT32), ("IconOverride", archive.BITMAP)}
    flags = {("ReverseData", archive.BOOL), ("SimplifyData", archive.BOOL), ("WireDisplay", archive.INT32)}
    compared = 0
    for place, names in places_by_kind(sample().tree()).items():
        if place.startswith(str(definition.TOGGLE)):
            continue
        assert place in public, place
        extra = names - public[place] - state - flags
        assert not extra, (place, extra)
        compared += len(names)
    say("definition: %d kinds of items and chunks found in the public one" % compared)


def test_a_wire_is_the_id_of_its_source_at_its_target() -> None:
    objects = sample().tree().chunk("Definition").chunk("DefinitionObjects")
    assert objects.get("ObjectCount") == len(objects.chunks) == 9
    ids = {o.chunk("Container").get("NickName"): o.chunk("Container").get("InstanceGuid") for o in objects.chunks}
    numbers = objects.chunk("Object", 0).chunk("Container").chunk("ParameterData").chunk("InputParam", 0)
    assert numbers.get("SourceCount") == 3
    assert [numbers.get("Source", i) for i in range(3)] == [ids["A"], ids["B"], ids["C"]]
    output = objects.chunk("Object", 0).chunk("Container").chunk("ParameterData").chunk("OutputParam", 0)
    again = objects.chunk("Object", 1).chunk("Container").chunk("ParameterData").chunk("InputParam", 0)
    assert again.get("Source", 0) == output.get("InstanceGuid")


@pytest.mark.parametrize("host", HOSTS, ids=lambda h: h.name)
def test_ids_are_unique_and_each_build_gives_the_same_bits(host) -> None:
    made = sample(host).tree()
    ids = [i.value for _, c in made.walk() for i in c.items if i.name == "InstanceGuid"]
    assert len(ids) == len(set(ids)) == 17
    assert archive.encode(sample(host).tree()) == archive.encode(made)
    assert xml_form.parse(xml_form.text(made)) is not made
    assert archive.encode(xml_form.parse(xml_form.text(made))) == archive.encode(made)


def test_objects_do_not_overlap() -> None:
    boxes = []
    for item in sample().tree().chunk("Definition").chunk("DefinitionObjects").chunks:
        attributes = item.chunk("Container").chunk("Attributes")
        if attributes.find("Bounds"):
            boxes.append((item.get("Name"), attributes.get("Bounds")))
    assert_no_overlap(boxes)


def assert_no_overlap(boxes) -> None:
    for i, (name, (x, y, w, h)) in enumerate(boxes):
        for other, (u, v, s, t) in boxes[:i]:
            assert x + w <= u or u + s <= x or y + h <= v or v + t <= y, (name, (x, y, w, h), other, (u, v, s, t))


def test_wrong_wires_keys_and_sliders_are_refused() -> None:
    made = sample()
    a, b = made.slider("x", "X", 1, 0, 2, 0, (0, 0)), made.component("y", components.load(SAMPLE / "Sum"), (0, 0))
    with pytest.raises(KeyError, match="no input 'Nothing', there are .*'Mesh', 'Numbers'"):
        made.wire(a, b, "Nothing")
    with pytest.raises(KeyError, match="no output 'Nothing', there are .*'Total'"):
        made.wire((b, "Nothing"), b, "Mesh")
    with pytest.raises(KeyError, match="two objects have the key 'x'"):
        made.toggle("x", "", True, (0, 0))
    for value in (3, 0.5):
        with pytest.raises(ValueError, match="slider 'z': .* is not in"):
            made.slider("z", "Z", value, 0, 2, 0, (0, 0))
