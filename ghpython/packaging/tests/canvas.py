"""Opens a definition outside Rhino: reads its objects and wires, and solves it as Grasshopper does, with the stand-ins
of `ghpython/stand_ins` in place of Rhino. The code that runs is the one in the file."""

from __future__ import annotations

import os
import sys
import uuid
from pathlib import Path
from typing import Any, Dict, List, Tuple

import components
import definition
from archive import Chunk

GHPYTHON = Path(__file__).resolve().parents[2]
for folder in (GHPYTHON, GHPYTHON / "stand_ins"):
    sys.path.insert(0, str(folder))
os.environ.setdefault("SHAPEOP_HOME", str(GHPYTHON))

import Grasshopper  # noqa: E402
from Grasshopper.Kernel import GH_Component, GH_Document, GH_RuntimeMessageLevel  # noqa: E402
from Grasshopper.Kernel.Data import GH_Path  # noqa: E402
from Rhino.Geometry import Vector3d  # noqa: E402

# A tree of data on the canvas: its branches, each with the indices of its path.
Data = List[Tuple[Tuple[int, ...], List[Any]]]

ACCESS_NAMES = {code: name for name, code in components.ACCESS.items()}
HINT_NAMES = {guid: name for host in components.HOSTS for name, guid in host.type_hints.items()}


class Canvas:
    """An open definition. `solve` solves what has changed, and what hangs on it."""

    def __init__(self, root: Chunk) -> None:
        self.document = GH_Document()
        Grasshopper.Instances.DocumentServer.AddDocument(self.document)
        objects = root.chunk("Definition").chunk("DefinitionObjects")
        assert objects.get("ObjectCount") == len(objects.chunks)
        self.objects = [_object(chunk, self.document) for chunk in objects.chunks]
        self.by_output = {guid: item for item in self.objects for guid in item.outputs}
        self._order = self._sorted()

    def close(self) -> None:
        Grasshopper.Instances.DocumentServer.RemoveDocument(self.document)

    def find(self, nickname: str, group: str) -> "_Object":
        """The only object of that nickname in a group of that name."""
        (members,) = [g.members for g in self.objects if isinstance(g, Group) and g.nickname == group]
        (found,) = [o for o in self.objects if o.nickname == nickname and o.guid in members]
        return found

    def solve(self) -> None:
        """A new solution: all objects in the order of the wires; those without news keep their outputs."""
        changed = set()
        for item in self._order:
            sources = [guid for _, guids in item.inputs.values() for guid in guids]
            if item.is_expired or changed.intersection(sources):
                item.solve({name: self._data(guids) for name, (_, guids) in item.inputs.items()})
                item.is_expired = False
                changed.update(item.outputs)

    def tick(self) -> bool:
        """Lets the time of what is scheduled pass; whether there was anything."""
        scheduled, self.document._scheduled = self.document._scheduled, []
        for delegate in scheduled:
            delegate.Invoke(self.document)
        for item in self.objects:
            if isinstance(item, Script) and item.component._is_expired:
                item.component._is_expired, item.is_expired = False, True
        self.solve()
        return bool(scheduled)

    def errors(self) -> List[str]:
        scripts = [o for o in self.objects if isinstance(o, Script)]
        return [text for s in scripts for text in s.component.RuntimeMessages(GH_RuntimeMessageLevel.Error)]

    def _data(self, guids: List[uuid.UUID]) -> Data:
        """The sources of an input merged, branch by branch."""
        merged: Dict[Tuple[int, ...], List[Any]] = {}
        for guid in guids:
            for path, items in self.by_output[guid].outputs[guid]:
                merged.setdefault(path, []).extend(items)
        return sorted(merged.items())

    def _sorted(self) -> List["_Object"]:
        ordered: List[_Object] = []
        waiting = list(self.objects)
        while waiting:
            done = {guid for item in ordered for guid in item.outputs}
            ready = [o for o in waiting if all(g in done for _, guids in o.inputs.values() for g in guids)]
            assert ready, "the wires form a circle, or lead to no output: %s" % [o.nickname for o in waiting]
            ordered += ready
            waiting = [o for o in waiting if o not in ready]
        return ordered


class _Object:
    """What all objects have: inputs by name, as a chunk and the ids of its sources; data by the id of an output."""

    def __init__(self, container: Chunk) -> None:
        self.container = container
        self.guid = container.get("InstanceGuid")
        self.nickname = container.get("NickName")
        self.inputs: Dict[str, Tuple[Chunk, List[uuid.UUID]]] = {}
        self.outputs: Dict[uuid.UUID, Data] = {}
        self.is_expired = True

    def add_input(self, name: str, chunk: Chunk) -> None:
        self.inputs[name] = (chunk, [chunk.get("Source", i) for i in range(chunk.get("SourceCount"))])

    def solve(self, data: Dict[str, Data]) -> None:
        raise NotImplementedError


class Group(_Object):
    def __init__(self, container: Chunk) -> None:
        super().__init__(container)
        self.members = {container.get("ID", i) for i in range(container.get("ID_Count"))}

    def solve(self, data: Dict[str, Data]) -> None:
        pass


class Value(_Object):
    """A slider, panel, toggle or button. Set `value` to move it."""

    def __init__(self, container: Chunk, value: Any) -> None:
        super().__init__(container)
        self._value = value
        self.outputs[self.guid] = []
        assert container.get("SourceCount") == 0, "no wire leads into these here"

    @property
    def value(self) -> Any:
        return self._value

    @value.setter
    def value(self, value: Any) -> None:
        self.is_expired = value != self._value
        self._value = value

    def solve(self, data: Dict[str, Data]) -> None:
        self.outputs[self.guid] = [((0,), [self._value])]


class UnitZ(_Object):
    def __init__(self, container: Chunk) -> None:
        super().__init__(container)
        self.add_input("Factor", container.chunk("param_input", 0))
        self.output = container.chunk("param_output", 0).get("InstanceGuid")
        self.outputs[self.output] = []

    def solve(self, data: Dict[str, Data]) -> None:
        self.outputs[self.output] = [(path, [Vector3d(0, 0, f) for f in items]) for path, items in data["Factor"]]


class Script(_Object):
    """A scripting component of either host."""

    def __init__(self, container: Chunk, document: Any) -> None:
        super().__init__(container)
        self.code = compile(components.code_of(container), self.nickname, "exec")
        self.component = GH_Component()
        document.AddObject(self.component, False)
        parameters = container.chunk("ParameterData")
        for index in range(parameters.get("InputCount")):
            chunk = parameters.chunk("InputParam", index)
            self.add_input(chunk.get("Name"), chunk)
        self.names = {}
        for index in range(parameters.get("OutputCount")):
            chunk = parameters.chunk("OutputParam", index)
            self.names[chunk.get("InstanceGuid")] = chunk.get("Name")
            self.outputs[chunk.get("InstanceGuid")] = []

    def output(self, name: str) -> List[Any]:
        (guid,) = [g for g, n in self.names.items() if n == name]
        return [item for _, items in self.outputs[guid] for item in items]

    def solve(self, data: Dict[str, Data]) -> None:
        self.component.ClearRuntimeMessages()
        scope: Dict[str, Any] = {
            "__name__": "__main__",
            "ghenv": type("Environment", (), {"Component": self.component}),
        }
        for name, branches in data.items():
            scope[name] = _argument(self.inputs[name][0], branches)
        exec(self.code, scope)
        for guid, name in self.names.items():
            self.outputs[guid] = _result(scope.get(name))


def _object(chunk: Chunk, document: Any) -> _Object:
    kind, container = chunk.get("GUID"), chunk.chunk("Container")
    if kind in [host.base_id for host in components.HOSTS]:
        return Script(container, document)
    if kind == definition.SLIDER:
        return Value(container, container.chunk("Slider").get("Value"))
    if kind == definition.PANEL:
        assert container.chunk("PanelProperties").get("Multiline"), "a panel here gives its text as one item"
        return Value(container, container.get("UserText"))
    if kind == definition.TOGGLE:
        return Value(container, container.get("ToggleValue"))
    if kind == definition.BUTTON:
        return Value(container, False)
    if kind == definition.UNIT_Z:
        return UnitZ(container)
    assert kind == definition.GROUP, chunk.get("Name")
    return Group(container)


def _argument(chunk: Chunk, branches: Data) -> Any:
    """The data of an input as its access and its type hint pass them to the code."""
    convert = CONVERSIONS.get(HINT_NAMES[chunk.get("TypeHintID")], lambda value: value)
    branches = [(path, [convert(item) for item in items]) for path, items in branches]
    access = ACCESS_NAMES[chunk.get("ScriptParamAccess")]
    if access == "tree":
        tree = Grasshopper.DataTree[object]()
        for path, items in branches:
            for item in items:
                tree.Add(item, GH_Path(*path))
        return tree
    assert len(branches) <= 1, "%s: Grasshopper would run the component once for each branch" % chunk.get("Name")
    items = branches[0][1] if branches else []
    if access == "list":
        return items
    assert len(items) <= 1, "%s: Grasshopper would run the component once for each item" % chunk.get("Name")
    return items[0] if items else None


def _whole(value: Any) -> int:
    return int(round(float(value)))


def _truth(value: Any) -> bool:
    assert isinstance(value, bool), value
    return value


CONVERSIONS = {"str": str, "float": float, "int": _whole, "bool": _truth}


def _result(value: Any) -> Data:
    """An output of the code as Grasshopper takes it."""
    if value is None:
        return []
    if hasattr(value, "Branches"):
        return [(tuple(p.Indices), list(b)) for p, b in zip(value.Paths, value.Branches)]
    if isinstance(value, (list, tuple)):
        return [((0,), list(value))]
    return [((0,), [value])]
