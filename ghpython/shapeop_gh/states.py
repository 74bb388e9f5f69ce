"""What outlives a tick: one state per component, kept in scriptcontext.sticky under the document and the component.

A state has a method `delete`, which frees its solver. It is called when another state takes its place, when the
component is deleted, and when its document is closed.
"""

import Grasshopper
from scriptcontext import sticky

_STORE = "shapeop_gh"


def get(component):
    """The state of `component`, or None."""
    return _store()["states"].get(_key(component))


def put(component, state):
    drop(component)
    _store()["states"][_key(component)] = state
    _watch(component.OnPingDocument())


def drop(component):
    _drop(_key(component))


def _store():
    if _STORE not in sticky:
        sticky[_STORE] = {"states": {}, "watched": set()}
    return sticky[_STORE]


def _key(component):
    return _document_key(component.OnPingDocument()), str(component.InstanceGuid)


def _document_key(document):
    return "" if document is None else str(document.DocumentID)


def _drop(key):
    state = _store()["states"].pop(key, None)
    if state is not None:
        state.delete()


def _watch(document):
    watched = _store()["watched"]
    server = Grasshopper.Instances.DocumentServer
    if "server" not in watched and server is not None:
        server.DocumentRemoved += _on_document_removed
        watched.add("server")
    if document is not None and _document_key(document) not in watched:
        document.ObjectsDeleted += _on_objects_deleted
        watched.add(_document_key(document))


def _on_objects_deleted(sender, event):
    for deleted in event.Objects:
        _drop((_document_key(event.Document), str(deleted.InstanceGuid)))


def _on_document_removed(server, document):
    closed = _document_key(document)
    if closed not in _store()["watched"]:
        return
    document.ObjectsDeleted -= _on_objects_deleted
    _store()["watched"].discard(closed)
    for key in list(_store()["states"]):
        if key[0] == closed:
            _drop(key)
