"""A component's source folder (`code.py`, `metadata.json`, `icon.png`) and its state in a Grasshopper archive.

The layout of the folder is that of COMPAS's componentizer. The state is what a `.ghuser` holds and what a definition
holds for each component; it differs between the GhPython component (Rhino 7) and the script component (Rhino 8)."""

from __future__ import annotations

import base64
import json
import struct
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterable, List, Optional, Tuple

import archive
from archive import Chunk

ACCESS = {"item": 0, "list": 1, "tree": 2}
WIRES = {"default": 0, "faint": 1, "hidden": 2}

# Grasshopper's GH_Exposure: in which section of the tab's panel the component stands; -1 hides it.
EXPOSURES = (-1, 2, 4, 8, 16, 32, 64, 128)

PNG = b"\x89PNG\r\n\x1a\n"
ICON_SIZE = (24, 24)


class ComponentError(ValueError):
    """A component's folder that cannot be used. The message names the file and the place in it."""


@dataclass(frozen=True)
class Host:
    """A scripting component that runs our code, and the ids that it uses in archives."""

    name: str
    base_id: uuid.UUID
    object_name: str
    input_id: uuid.UUID
    output_id: uuid.UUID
    library_id: uuid.UUID
    type_hints: Dict[str, uuid.UUID]


# Converters of inputs that both hosts know under one id.
_COMMON_HINTS = {
    "bool": "d60527f5-b5af-4ef6-8970-5f96fe412559",
    "int": "48d01794-d3d8-4aef-990e-127168822244",
    "color": "24b1d1a3-ab79-498c-9e44-c5b14607c4d3",
    "point": "e1937b56-b1da-4c12-8bd8-e34ee81746ef",
    "vector": "15a50725-e3d3-4075-9f7c-142ba5f40747",
    "plane": "3897522d-58e9-4d60-b38c-978ddacfedd8",
    "interval": "589748aa-e558-4dd9-976f-78e3ab91fc77",
    "line": "f802a8cd-e699-4a94-97ea-83b5406271de",
    "polyline": "66fa617b-e3e8-4480-9f1e-2c0688c1d21b",
    "curve": "9ba89ec2-5315-435f-a621-b66c5fa2f301",
    "mesh": "794a1f9d-21d5-4379-b987-9e8bbf433912",
    "surface": "f4070a37-c822-410f-9057-100d2e22a22d",
    "brep": "2ceb0405-fdfe-403d-a4d6-8786da45fb9d",
    "geometrybase": "c37956f4-d39c-49c7-af71-1e87f8031b26",
}
# The ids that differ. "ghdoc" makes geometry ids of GhPython's own document; "none" passes data as it is.
_RHINO7_HINTS = {
    "none": "35915213-5534-4277-81b8-1bdc9e7383d2",
    "ghdoc": "87f87f55-5b71-41f4-8aea-21d494016f81",
    "float": "39fbc626-7a01-46ab-a18e-ec1c0c41685b",
    "str": "37261734-eec7-4f50-b6a8-b8d1f3c4396b",
}
_RHINO8_HINTS = {
    "none": "6a184b65-baa3-42d1-a548-3915b401de53",
    "ghdoc": "1c282eeb-dd16-439f-94e4-7d92b542fe8b",
    "float": "9d51e32e-c038-4352-9554-f4137ca91b9a",
    "str": "3aceb454-6dbd-4c5b-9b6b-e71f8c1cdf88",
}


def _hints(own: Dict[str, str]) -> Dict[str, uuid.UUID]:
    return {name: uuid.UUID(text) for name, text in {**_COMMON_HINTS, **own}.items()}


RHINO7 = Host(
    name="rhino7",
    base_id=uuid.UUID("410755b1-224a-4c1e-a407-bf32fb45ea7e"),
    object_name="GhPython Script",
    input_id=uuid.UUID("84fa917c-1ed8-4db3-8be1-7bdc4a6495a2"),
    output_id=uuid.UUID("8ec86459-bf01-4409-baee-174d0d2b13d0"),
    library_id=uuid.UUID("00000000-0000-0000-0000-000000000000"),
    type_hints=_hints(_RHINO7_HINTS),
)
RHINO8 = Host(
    name="rhino8",
    base_id=uuid.UUID("c9b2d725-6f87-4b07-af90-bd9aefef68eb"),
    object_name="Script",
    input_id=uuid.UUID("08908df5-fa14-4982-9ab2-1aa0927566aa"),
    output_id=uuid.UUID("08908df5-fa14-4982-9ab2-1aa0927566aa"),
    library_id=uuid.UUID("066d0a87-236f-4eae-a0f4-9e42f5327962"),
    type_hints=_hints(_RHINO8_HINTS),
)
HOSTS = (RHINO7, RHINO8)


@dataclass(frozen=True)
class Parameter:
    """An input or output of a component. Access, hint and the flags matter for inputs only."""

    name: str
    nickname: str
    description: str
    access: str = "item"
    type_hint: str = "none"
    optional: bool = True
    allow_tree_access: bool = True
    show_type_hints: bool = True
    reverse: bool = False
    simplify: bool = False
    wire_display: int = 0


@dataclass(frozen=True)
class Component:
    """What a component's folder says."""

    name: str
    nickname: str
    category: str
    subcategory: str
    description: str
    exposure: int
    guid: uuid.UUID
    is_advanced: bool
    hide_input: bool
    hide_output: bool
    icon_display: int
    inputs: Tuple[Parameter, ...]
    outputs: Tuple[Parameter, ...]
    code: str
    icon: bytes

    def parameter_guid(self, owner: uuid.UUID, direction: str, index: int) -> uuid.UUID:
        """The instance id of a parameter: a function of the component's own, so that each build gives the same."""
        parameter = (self.inputs if direction == "input" else self.outputs)[index]
        return uuid.uuid5(owner, "%s %d %s" % (direction, index, parameter.name))


def load(folder: Path) -> Component:
    """Reads a component's folder.

    Raises `ComponentError` if a file is missing or says what cannot be."""
    path = folder / "metadata.json"
    try:
        metadata = json.loads(path.read_text("utf-8"))
        code = (folder / "code.py").read_text("utf-8").replace("\r\n", "\n")
        icon = (folder / "icon.png").read_bytes()
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise ComponentError("component %r: %s" % (folder.name, error)) from None
    if not icon.startswith(PNG) or len(icon) < 24 or struct.unpack(">II", icon[16:24]) != ICON_SIZE:
        raise ComponentError("%s: expected a PNG of %d x %d pixels" % ((folder / "icon.png",) + ICON_SIZE))
    top = _Place(path, "", metadata)
    python = _Place(path, "ghpython", top.get("ghpython", dict))
    exposure = top.get("exposure", int, 2)
    if exposure not in EXPOSURES:
        raise ComponentError("%s: exposure is %r, expected one of %s" % (path, exposure, EXPOSURES))
    return Component(
        name=top.get("name", str),
        nickname=top.get("nickname", str),
        category=top.get("category", str),
        subcategory=top.get("subcategory", str),
        description=top.get("description", str),
        exposure=exposure,
        guid=top.guid("instanceGuid"),
        is_advanced=python.get("isAdvancedMode", bool, False),
        hide_input=python.get("hideInput", bool, True),
        hide_output=python.get("hideOutput", bool, True),
        icon_display=python.get("iconDisplay", int, 0),
        inputs=_parameters(python, "inputParameters"),
        outputs=_parameters(python, "outputParameters"),
        code=code,
        icon=icon,
    )


def load_all(folder: Path) -> Dict[str, Component]:
    """All components in the folders of `folder`, by folder name, sorted.

    Raises `ComponentError`, also if two have one name or one id."""
    names = sorted(p.parent.name for p in folder.glob("*/metadata.json"))
    if not names:
        raise ComponentError("%s holds no component (no */metadata.json)" % folder)
    components = {name: load(folder / name) for name in names}
    for what in ("name", "guid"):
        seen: Dict[Any, str] = {}
        for name, component in components.items():
            value = getattr(component, what)
            if value in seen:
                raise ComponentError("components %r and %r have the same %s, %s" % (seen[value], name, what, value))
            seen[value] = name
    return components


class _Place:
    """An object in a metadata file, with its place for messages."""

    def __init__(self, path: Path, place: str, values: Any) -> None:
        if not isinstance(values, dict):
            raise ComponentError("%s: %s is %.40r, expected an object" % (path, place or "the file", values))
        self.path, self.place, self.values = path, place, values

    def get(self, key: str, kind: type, default: Any = None) -> Any:
        value = self.values.get(key, default)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            where = "%s.%s" % (self.place, key) if self.place else key
            raise ComponentError("%s: %s is %.40r, expected %s" % (self.path, where, value, kind.__name__))
        return value

    def one_of(self, key: str, names: Iterable[str], default: str) -> str:
        name = self.get(key, str, default)
        if name not in names:
            where = "%s.%s" % (self.place, key)
            raise ComponentError(
                "%s: %s is %r, expected one of %s" % (self.path, where, name, ", ".join(sorted(names)))
            )
        return name

    def guid(self, key: str) -> uuid.UUID:
        text = self.get(key, str)
        try:
            return uuid.UUID(text)
        except ValueError:
            raise ComponentError("%s: %s is %r, expected a GUID" % (self.path, key, text)) from None


def _parameters(python: _Place, key: str) -> Tuple[Parameter, ...]:
    parameters: List[Parameter] = []
    for index, values in enumerate(python.get(key, list, [])):
        place = _Place(python.path, "%s[%d]" % (key, index), values)
        name = place.get("name", str)
        parameters.append(
            Parameter(
                name=name,
                nickname=place.get("nickname", str, name),
                description=place.get("description", str, ""),
                access=place.one_of("scriptParamAccess", ACCESS, "item"),
                type_hint=place.one_of("typeHintID", RHINO7.type_hints, "none"),
                optional=place.get("optional", bool, True),
                allow_tree_access=place.get("allowTreeAccess", bool, True),
                show_type_hints=place.get("showTypeHints", bool, True),
                reverse=place.get("reverse", bool, False),
                simplify=place.get("simplify", bool, False),
                wire_display=WIRES[place.one_of("wireDisplay", WIRES, "default")],
            )
        )
    return tuple(parameters)


def fill_state(state: Chunk, component: Component, host: Host, owner: uuid.UUID) -> None:
    """Writes a component's state into `state`; `owner` is the id from which its parameters' ids come."""
    state.set("Description", archive.STRING, component.description)
    state.set("IconDisplay", archive.INT32, component.icon_display)
    state.set("IconOverride", archive.BITMAP, component.icon)
    state.set("Name", archive.STRING, component.name)
    state.set("NickName", archive.STRING, component.nickname)
    if host is RHINO7:
        state.set("CodeInput", archive.STRING, component.code)
        state.set("HideInput", archive.BOOL, component.hide_input)
        state.set("HideOutput", archive.BOOL, component.hide_output)
        state.set("IsAdvancedMode", archive.BOOL, component.is_advanced)
        state.set("MarshalOutGuids", archive.BOOL, True)
    else:
        state.set("MarshalGuids", archive.BOOL, True)
        state.set("UsingLibraryInputParam", archive.BOOL, False)
        state.set("UsingScriptInputParam", archive.BOOL, False)
        state.set("UsingStandardOutputParam", archive.BOOL, False)
    data = state.add(Chunk("ParameterData"))
    data.set("InputCount", archive.INT32, len(component.inputs))
    data.set("OutputCount", archive.INT32, len(component.outputs))
    for index, parameter in enumerate(component.inputs):
        data.set("InputId", archive.GUID, host.input_id, index)
        chunk = data.add(Chunk("InputParam", index=index))
        _fill_parameter(chunk, parameter, host, component.parameter_guid(owner, "input", index))
        chunk.set("AllowTreeAccess", archive.BOOL, parameter.allow_tree_access)
        chunk.set("Optional", archive.BOOL, parameter.optional)
        chunk.set("ScriptParamAccess", archive.INT32, ACCESS[parameter.access])
        chunk.set("ShowTypeHints", archive.BOOL, parameter.show_type_hints)
        chunk.set("TypeHintID", archive.GUID, host.type_hints[parameter.type_hint])
        chunk.set("WireDisplay", archive.INT32, parameter.wire_display)
    for index, parameter in enumerate(component.outputs):
        data.set("OutputId", archive.GUID, host.output_id, index)
        chunk = data.add(Chunk("OutputParam", index=index))
        _fill_parameter(chunk, parameter, host, component.parameter_guid(owner, "output", index))
        chunk.set("Optional", archive.BOOL, False)
    if host is RHINO8:
        script = state.add(Chunk("Script"))
        script.set("Text", archive.STRING, base64.b64encode(component.code.encode("utf-8")).decode("ascii"))
        script.set("Title", archive.STRING, "S")
        language = script.add(Chunk("LanguageSpec"))
        language.set("Taxon", archive.STRING, "*.*.python")
        language.set("Version", archive.STRING, "3.-1")


def _fill_parameter(chunk: Chunk, parameter: Parameter, host: Host, guid: uuid.UUID) -> None:
    chunk.set("Description", archive.STRING, parameter.description)
    chunk.set("InstanceGuid", archive.GUID, guid)
    chunk.set("Name", archive.STRING, parameter.name)
    chunk.set("NickName", archive.STRING, parameter.nickname)
    chunk.set("ReverseData", archive.BOOL, parameter.reverse)
    chunk.set("SimplifyData", archive.BOOL, parameter.simplify)
    chunk.set("SourceCount", archive.INT32, 0)
    if host is RHINO8:
        chunk.set("ToolTip", archive.STRING, parameter.description)


def code_of(state: Chunk) -> Optional[str]:
    """The source that a component's state holds, whichever the host; None if it is no Python component."""
    if state.find("CodeInput") is not None:
        return state.get("CodeInput")
    scripts = [c for c in state.chunks if c.name == "Script"]
    return base64.b64decode(scripts[0].get("Text")).decode("utf-8") if scripts else None


def user_object(component: Component, host: Host) -> Chunk:
    """The tree of a component's `.ghuser` file."""
    state = Chunk("UserObject")
    fill_state(state, component, host, component.guid)
    root = Chunk("UserObject")
    root.set("BaseID", archive.GUID, host.base_id)
    root.set("Category", archive.STRING, component.category)
    root.set("Description", archive.STRING, component.description)
    root.set("Exposure", archive.INT32, component.exposure)
    root.set("Icon", archive.BYTES, component.icon)
    root.set("InstanceGuid", archive.GUID, component.guid)
    root.set("Name", archive.STRING, component.name)
    root.set("NickName", archive.STRING, component.nickname)
    root.set("Object", archive.BYTES, archive.write(state))
    root.set("SubCategory", archive.STRING, component.subcategory)
    if host is RHINO8:
        root.set("ToolTip", archive.STRING, component.description)
    return root
