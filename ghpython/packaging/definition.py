"""Writes Grasshopper definitions: components, panels, sliders, toggles, buttons and groups on a canvas, and wires.

Every id comes from the definition's name and the object's key, so that each build gives the same bits. A wire is stored
at its target: the ids of its sources, in order. A source is an output of a component, or an object that is a parameter
itself (slider, panel, toggle, button)."""

from __future__ import annotations

import uuid
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence, Tuple, Union

import archive
import components
from archive import Chunk
from components import Component, Host

_NAMESPACE = uuid.UUID("5f7d7a38-0b61-4b0f-9f2b-6c1a51f1a0e4")

PANEL = uuid.UUID("59e0b89a-e487-49f8-bab8-b5bab16be14c")
SLIDER = uuid.UUID("57da07bd-ecab-415d-9d86-af36d7073abc")
TOGGLE = uuid.UUID("2e78987b-9dfb-42a2-8b76-3923ac8bd91a")
BUTTON = uuid.UUID("a8b97322-2d53-47cd-905e-b932c3ccd74e")
GROUP = uuid.UUID("c552a431-af5b-46a9-a8a4-0fcbc27ef596")
UNIT_Z = uuid.UUID("9103c240-a6a9-4223-9b42-dbd19bf38e2b")

# 2025-01-01 as .NET's DateTime.ToBinary: a fixed date, for the same bits in each build.
_DATE = 638712864000000000
_PANEL_YELLOW = 0xFFFFFA5A
_GROUP_BLUE = 0x96AAC8E6

# Sizes on the canvas, in its pixels. Grasshopper lays components out anew when it opens a file; the pivots stay.
ROW_HEIGHT = 20
_LETTER_WIDTH = 7
_ICON_WIDTH = 36

Position = Tuple[float, float]


@dataclass
class Node:
    """An object on the canvas. The parameters of a component have names; an object that is a parameter has "" alone."""

    guid: uuid.UUID
    inputs: Dict[str, Chunk] = field(default_factory=dict)
    outputs: Dict[str, uuid.UUID] = field(default_factory=dict)


Source = Union[Node, Tuple[Node, str]]


class Definition:
    """A definition in the making. Positions are those of the upper left corner of an object."""

    def __init__(self, name: str, description: str, host: Host) -> None:
        self.name, self.description, self.host = name, description, host
        self.guid = uuid.uuid5(_NAMESPACE, "%s %s" % (name, host.name))
        self._objects: List[Chunk] = []
        self._keys: Dict[str, Node] = {}

    def component(self, key: str, component: Component, at: Position, nickname: str = "") -> Node:
        """A scripting component with the code of `component` in it."""
        node, container = self._object(key, self.host.base_id, self.host.object_name, self.host.library_id)
        components.fill_state(container, component, self.host, node.guid)
        container.set("InstanceGuid", archive.GUID, node.guid)
        if nickname:
            container.set("NickName", archive.STRING, nickname)
        width, height = size(component)
        attributes = _attributes(at, (width, height), (at[0] + width / 2, at[1] + height / 2))
        container.chunks.insert(0, attributes)
        data = container.chunk("ParameterData")
        for direction, parameters in (("Input", component.inputs), ("Output", component.outputs)):
            column = 2 + max((_text_width(p.name) for p in parameters), default=0)
            left = at[0] + 2 if direction == "Input" else at[0] + width - 2 - column
            for index, parameter in enumerate(parameters):
                chunk = data.chunk(direction + "Param", index)
                row = (height - 4) / len(parameters)
                corner = (left, at[1] + 2 + index * row)
                chunk.add(_attributes(corner, (column, row), (left + column / 2, corner[1] + row / 2)))
                if direction == "Input":
                    node.inputs[parameter.name] = chunk
                else:
                    node.outputs[parameter.name] = chunk.get("InstanceGuid")
        return node

    def panel(self, key: str, text: str, at: Position, extent: Position, nickname: str = "") -> Node:
        """A panel that gives its text as one item."""
        node, container = self._parameter(key, PANEL, "Panel", nickname, "A panel for custom notes and text values")
        container.set("ScrollRatio", archive.DOUBLE, 0.0)
        container.set("UserText", archive.STRING, text)
        attributes = container.add(_attributes(at, extent, at))
        for margin in ("MarginLeft", "MarginRight", "MarginTop"):
            attributes.set(margin, archive.INT32, 0)
        properties = container.add(Chunk("PanelProperties"))
        properties.set("Colour", archive.COLOUR, _PANEL_YELLOW)
        flags = {"DrawIndices": False, "DrawPaths": False, "Multiline": True}
        flags.update({"SpecialCodes": False, "Stream": False, "Wrap": True})
        for name, value in flags.items():
            properties.set(name, archive.BOOL, value)
        return node

    def slider(self, key: str, nickname: str, value: float, low: float, high: float, digits: int, at: Position) -> Node:
        """A number slider; with no digits it gives whole numbers."""
        if not low <= value <= high or round(value, digits) != value:
            raise ValueError("slider %r: %r is not in [%r, %r] with %d digits" % (key, value, low, high, digits))
        description = "Numeric slider for single values"
        node, container = self._parameter(key, SLIDER, "Number Slider", nickname, description)
        container.add(_attributes(at, (240, 20), at))
        slider = container.add(Chunk("Slider"))
        slider.set("Digits", archive.INT32, digits)
        slider.set("GripDisplay", archive.INT32, 1)
        slider.set("Interval", archive.INT32, 0 if digits else 1)
        slider.set("Max", archive.DOUBLE, float(high))
        slider.set("Min", archive.DOUBLE, float(low))
        slider.set("SnapCount", archive.INT32, 0)
        slider.set("Value", archive.DOUBLE, float(value))
        return node

    def toggle(self, key: str, nickname: str, value: bool, at: Position) -> Node:
        """A boolean toggle."""
        node, container = self._parameter(key, TOGGLE, "Boolean Toggle", nickname, "Boolean (true/false) toggle")
        container.set("ToggleValue", archive.BOOL, value)
        container.add(_attributes(at, (120, 22)))
        return node

    def button(self, key: str, nickname: str, at: Position) -> Node:
        """A button: true while it is pressed."""
        node, container = self._parameter(key, BUTTON, "Button", nickname, "Button object with two values")
        container.set("ExpressionNormal", archive.STRING, "False")
        container.set("ExpressionPressed", archive.STRING, "True")
        container.add(_attributes(at, (92, 22)))
        return node

    def unit_z(self, key: str, at: Position) -> Node:
        """Grasshopper's own component of a vector along z, times a factor."""
        node, container = self._object(key, UNIT_Z, "Unit Z")
        container.set("Description", archive.STRING, "Unit vector parallel to the world {z} axis.")
        container.set("InstanceGuid", archive.GUID, node.guid)
        container.set("Name", archive.STRING, "Unit Z")
        container.set("NickName", archive.STRING, "Z")
        container.add(_attributes(at, (94, 28), (at[0] + 40, at[1] + 14)))
        sides = (
            ("param_input", "Factor", "F", "Unit multiplication"),
            ("param_output", "Unit vector", "V", "World {z} vector"),
        )
        for side, name, nickname, description in sides:
            chunk = container.add(Chunk(side, index=0))
            chunk.set("Description", archive.STRING, description)
            chunk.set("InstanceGuid", archive.GUID, uuid.uuid5(node.guid, side))
            chunk.set("Name", archive.STRING, name)
            chunk.set("NickName", archive.STRING, nickname)
            chunk.set("Optional", archive.BOOL, False)
            chunk.set("SourceCount", archive.INT32, 0)
            left = at[0] + (2 if side == "param_input" else 65)
            chunk.add(_attributes((left, at[1] + 2), (27, 24), (left + 13, at[1] + 14)))
            if side == "param_input":
                node.inputs[name] = chunk
            else:
                node.outputs[name] = chunk.get("InstanceGuid")
        return node

    def group(self, key: str, nickname: str, nodes: Sequence[Node]) -> None:
        """A named box behind objects."""
        node, container = self._object(key, GROUP, "Group")
        container.set("Border", archive.INT32, 1)
        container.set("Colour", archive.COLOUR, _GROUP_BLUE)
        container.set("Description", archive.STRING, "A group of Grasshopper objects")
        container.set("ID_Count", archive.INT32, len(nodes))
        for index, member in enumerate(nodes):
            container.set("ID", archive.GUID, member.guid, index)
        container.set("InstanceGuid", archive.GUID, node.guid)
        container.set("Name", archive.STRING, "Group")
        container.set("NickName", archive.STRING, nickname)
        container.add(Chunk("Attributes"))

    def wire(self, source: Source, target: Node, name: str = "") -> None:
        """Connects an output to an input, after those that are connected already."""
        node, output = source if isinstance(source, tuple) else (source, "")
        if output not in node.outputs:
            raise KeyError("no output %r, there are %s" % (output, sorted(node.outputs)))
        if name not in target.inputs:
            raise KeyError("no input %r, there are %s" % (name, sorted(target.inputs)))
        chunk = target.inputs[name]
        count = chunk.get("SourceCount")
        chunk.set("Source", archive.GUID, node.outputs[output], count)
        chunk.set("SourceCount", archive.INT32, count + 1)

    def tree(self) -> Chunk:
        """The archive of the definition."""
        root = Chunk("Root")
        root.set("ArchiveVersion", archive.VERSION, (0, 2, 2))
        definition = root.add(Chunk("Definition"))
        definition.set("plugin_version", archive.VERSION, (1, 0, 7))
        header = definition.add(Chunk("DocumentHeader"))
        header.set("DocumentID", archive.GUID, self.guid)
        header.set("Preview", archive.STRING, "Shaded")
        header.set("PreviewMeshType", archive.INT32, 1)
        header.set("PreviewNormal", archive.COLOUR, 0x64960000)
        header.set("PreviewSelected", archive.COLOUR, 0x64009600)
        properties = definition.add(Chunk("DefinitionProperties"))
        properties.set("Date", archive.DATE, _DATE)
        properties.set("Description", archive.STRING, self.description)
        properties.set("Name", archive.STRING, self.name)
        properties.add(Chunk("Revisions")).set("RevisionCount", archive.INT32, 0)
        projection = properties.add(Chunk("Projection"))
        projection.set("Target", archive.POINT, (0, 0))
        projection.set("Zoom", archive.SINGLE, 1.0)
        properties.add(Chunk("Views")).set("ViewCount", archive.INT32, 0)
        definition.add(Chunk("RcpLayout")).set("GroupCount", archive.INT32, 0)
        definition.add(Chunk("GHALibraries")).set("Count", archive.INT32, 0)
        objects = definition.add(Chunk("DefinitionObjects"))
        objects.set("ObjectCount", archive.INT32, len(self._objects))
        objects.chunks = self._objects
        return root

    def _object(self, key: str, kind: uuid.UUID, name: str, library: Optional[uuid.UUID] = None) -> Tuple[Node, Chunk]:
        if key in self._keys:
            raise KeyError("two objects have the key %r" % key)
        node = self._keys[key] = Node(uuid.uuid5(self.guid, key))
        item = Chunk("Object", index=len(self._objects))
        item.set("GUID", archive.GUID, kind)
        if library is not None:
            item.set("Lib", archive.GUID, library)
        item.set("Name", archive.STRING, name)
        self._objects.append(item)
        return node, item.add(Chunk("Container"))

    def _parameter(self, key: str, kind: uuid.UUID, name: str, nickname: str, description: str) -> Tuple[Node, Chunk]:
        node, container = self._object(key, kind, name)
        container.set("Description", archive.STRING, description)
        container.set("InstanceGuid", archive.GUID, node.guid)
        container.set("Name", archive.STRING, name)
        container.set("NickName", archive.STRING, nickname)
        container.set("Optional", archive.BOOL, False)
        container.set("SourceCount", archive.INT32, 0)
        node.inputs[""] = container
        node.outputs[""] = node.guid
        return node, container


def size(component: Component) -> Tuple[float, float]:
    """Width and height of a component on the canvas, about."""
    columns = [max((_text_width(p.name) for p in side), default=0) for side in (component.inputs, component.outputs)]
    rows = max(len(component.inputs), len(component.outputs), 1)
    return float(sum(columns) + _ICON_WIDTH + 8), float(rows * ROW_HEIGHT + 4)


def _text_width(text: str) -> int:
    return _LETTER_WIDTH * len(text) + 6


def _attributes(at: Position, extent: Position, pivot: Optional[Position] = None) -> Chunk:
    chunk = Chunk("Attributes")
    chunk.set("Bounds", archive.RECTANGLEF, tuple(float(v) for v in at + extent))
    if pivot is not None:
        chunk.set("Pivot", archive.POINTF, tuple(float(v) for v in pivot))
    return chunk
