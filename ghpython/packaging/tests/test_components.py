"""User objects: their structure beside that of public ones, and what a wrong component folder is answered with."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shutil
from collections import defaultdict
from pathlib import Path
from typing import Dict, Set, Tuple

import pytest

import archive
import components
from archive import Chunk
from components import RHINO7, RHINO8, ComponentError, Host

SAMPLE = Path(__file__).parent / "sample"
COMPONENTS = Path(__file__).resolve().parents[2] / "components"

Places = Dict[str, Set[Tuple[str, int]]]


def places(root: Chunk) -> Places:
    """Names and types of items, and names of chunks (as type 0), at each place of the tree, indices left out."""
    found: Places = defaultdict(set)
    for path, chunk in root.walk():
        place = re.sub(r"\[\d+\]", "[]", path)
        found[place] |= {(item.name + ("[]" if item.index >= 0 else ""), item.type) for item in chunk.items}
        found[place] |= {(child.name + ("[]" if child.index >= 0 else ""), 0) for child in chunk.chunks}
    return found


def every_place(root: Chunk) -> Places:
    found = {"outer" + place: names for place, names in places(root).items()}
    found.update({"inner" + p: names for p, names in places(archive.read(root.get("Object"))).items()})
    return found


def public_places(files: Dict[str, bytes], host: Host) -> Tuple[Places, Places, int]:
    """What at least one, and what each, public user object of `host` has at each place; and their number."""
    some: Places = {}
    each: Places = {}
    count = 0
    for name, data in files.items():
        root = archive.read(data)
        if not name.endswith(".ghuser") or root.get("BaseID") != host.base_id:
            continue
        count += 1
        for place, names in every_place(root).items():
            some[place] = some.get(place, set()) | names
            each[place] = each.get(place, names) & names
    return some, each, count


def ours() -> Dict[str, components.Component]:
    found = components.load_all(SAMPLE)
    if COMPONENTS.is_dir():
        found.update(components.load_all(COMPONENTS))
    return found


@pytest.mark.parametrize("host", components.HOSTS, ids=lambda h: h.name)
def test_our_user_objects_have_the_structure_of_public_ones(public_files, host: Host, say) -> None:
    some, each, count = public_places(public_files, host)
    assert count > 30
    # GhPython's editor writes the place of its window and of the component on the canvas; a user object needs none,
    # and those of COMPAS have none.
    optional = {"EditorLocation", "EditorSize", "InputIsPath", "InstanceGuid", "Attributes"}
    for name, component in ours().items():
        root = components.user_object(component, host)
        mine = every_place(root)
        for place, names in mine.items():
            assert place in some, "%s: no public file has a chunk at %s" % (name, place)
            assert names <= some[place], (name, place, names - some[place])
            missing = {n for n in each[place] - names if n[0] not in optional}
            assert not missing, (name, place, missing)
    say("%s: %d of ours compared with %d public ones" % (host.name, len(ours()), count))


@pytest.mark.parametrize("host", components.HOSTS, ids=lambda h: h.name)
def test_a_user_object_says_what_its_folder_says(host: Host) -> None:
    component = components.load(SAMPLE / "Sum")
    root = archive.read(archive.write(components.user_object(component, host)))
    assert root.get("Name") == "Sum of Numbers" and root.get("NickName") == "Σ"
    assert root.get("Exposure") == 4 and root.get("BaseID") == host.base_id
    assert root.get("Icon") == (SAMPLE / "Sum" / "icon.png").read_bytes()
    state = archive.read(root.get("Object"))
    assert components.code_of(state) == (SAMPLE / "Sum" / "code.py").read_text("utf-8")
    data = state.chunk("ParameterData")
    assert (data.get("InputCount"), data.get("OutputCount")) == (2, 1)
    numbers, mesh = data.chunk("InputParam", 0), data.chunk("InputParam", 1)
    assert (numbers.get("ScriptParamAccess"), mesh.get("ScriptParamAccess")) == (1, 2)
    assert numbers.get("TypeHintID") == host.type_hints["float"] and mesh.get("TypeHintID") == host.type_hints["mesh"]
    assert (mesh.get("NickName"), mesh.get("Optional")) == ("Mesh", True)
    guids = [c.get("InstanceGuid") for c in data.chunks]
    assert len(set(guids)) == 3


def test_the_script_of_rhino_8_is_base64_of_utf_8() -> None:
    state = archive.read(components.user_object(components.load(SAMPLE / "Sum"), RHINO8).get("Object"))
    script = state.chunk("Script")
    assert base64.b64decode(script.get("Text")).startswith(b'"""Adds numbers')
    assert script.chunk("LanguageSpec").get("Taxon") == "*.*.python"


def test_user_objects_are_the_same_bits_in_each_build() -> None:
    """The digests are of the uncompressed bytes: those do not depend on the version of zlib."""
    component = components.load(SAMPLE / "Sum")
    for host in components.HOSTS:
        assert archive.write(components.user_object(component, host)) == archive.write(
            components.user_object(components.load(SAMPLE / "Sum"), host)
        )
    inner = archive.read(components.user_object(component, RHINO7).get("Object"))
    digest = hashlib.sha256(archive.encode(inner)).hexdigest()
    assert digest == "888e80ccd19f08956bd86f97cbcd086fb2b467dd7f37c1c52ac8ae6d883b2c0a"


def test_type_hints_of_public_files_are_known(public_files) -> None:
    """Each converter id in a public script component is one of ours, so no name of ours stands for a made-up id."""
    used: Dict[str, Set[str]] = defaultdict(set)
    for name, data in public_files.items():
        root = archive.read(data)
        host = next((h for h in components.HOSTS if name.endswith(".ghuser") and root.get("BaseID") == h.base_id), None)
        if host is None:
            continue
        for _, chunk in archive.read(root.get("Object")).walk():
            hint = chunk.find("TypeHintID")
            if hint is not None:
                assert hint.value in host.type_hints.values(), (name, hint.value)
                used[host.name].add(str(hint.value))
    assert len(used["rhino7"]) >= 13 and len(used["rhino8"]) >= 5


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(SAMPLE / "Sum", tmp_path / "Sum"))


def spoil(folder: Path, change) -> None:
    path = folder / "metadata.json"
    metadata = json.loads(path.read_text("utf-8"))
    change(metadata)
    path.write_text(json.dumps(metadata), "utf-8")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m.pop("name"), "metadata.json: name is None, expected str"),
        (lambda m: m.update(exposure=3), "exposure is 3, expected one of"),
        (lambda m: m.update(instanceGuid="x"), "instanceGuid is 'x', expected a GUID"),
        (lambda m: m.update(ghpython=[]), "ghpython is .*, expected dict"),
        (lambda m: m["ghpython"]["inputParameters"][0].update(scriptParamAccess="all"), r"inputParameters\[0\].script"),
        (lambda m: m["ghpython"]["inputParameters"][1].update(typeHintID="float64"), r"\[1\].typeHintID is 'float64'"),
        (lambda m: m["ghpython"]["outputParameters"].append(7), r"outputParameters\[1\] is 7, expected an object"),
        (lambda m: m["ghpython"].update(isAdvancedMode=1), "ghpython.isAdvancedMode is 1, expected bool"),
    ],
)
def test_wrong_metadata_is_named(folder: Path, change, message: str) -> None:
    spoil(folder, change)
    with pytest.raises(ComponentError, match=message):
        components.load(folder)


def test_a_missing_or_wrong_icon_is_named(folder: Path) -> None:
    (folder / "icon.png").write_bytes(b"GIF89a")
    with pytest.raises(ComponentError, match="icon.png: expected a PNG of 24 x 24 pixels"):
        components.load(folder)
    (folder / "icon.png").unlink()
    with pytest.raises(ComponentError, match="component 'Sum': .*icon.png"):
        components.load(folder)


def test_two_components_of_one_id_are_refused(folder: Path) -> None:
    shutil.copytree(folder, folder.parent / "Twin")
    with pytest.raises(ComponentError, match="components 'Sum' and 'Twin' have the same name"):
        components.load_all(folder.parent)
    spoil(folder.parent / "Twin", lambda m: m.update(name="Twin"))
    with pytest.raises(ComponentError, match="have the same guid"):
        components.load_all(folder.parent)


def test_a_folder_without_components_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ComponentError, match="holds no component"):
        components.load_all(tmp_path)
