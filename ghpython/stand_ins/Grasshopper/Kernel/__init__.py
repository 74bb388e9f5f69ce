from System import Guid

from Grasshopper.Kernel import Data  # noqa: F401


class _Event(object):
    def __init__(self):
        self._handlers = []

    def __iadd__(self, handler):
        self._handlers.append(handler)
        return self

    def __isub__(self, handler):
        if handler in self._handlers:
            self._handlers.remove(handler)
        return self

    def _raise(self, *arguments):
        for handler in list(self._handlers):
            handler(*arguments)


class GH_RuntimeMessageLevel(object):
    Blank = 0
    Warning = 10
    Error = 20
    Remark = 255


class GH_ScheduleDelegate(object):
    def __init__(self, function):
        self._function = function

    def Invoke(self, document):
        self._function(document)


class GH_DocObjectEventArgs(object):
    def __init__(self, document, objects):
        self.Document, self.Objects = document, objects

    @property
    def ObjectCount(self):
        return len(self.Objects)


class GH_Document(object):
    # Nested in .NET; the stubs list it beside the class.
    GH_ScheduleDelegate = GH_ScheduleDelegate

    def __init__(self):
        self.DocumentID = Guid.NewGuid()
        self.ObjectsDeleted = _Event()
        self._scheduled = []

    def AddObject(self, component, update):
        component._document = self
        return True

    def RemoveObject(self, component, update):
        component._document = None
        self.ObjectsDeleted._raise(self, GH_DocObjectEventArgs(self, [component]))
        return True

    def ScheduleSolution(self, delay, callback):
        assert delay > 0
        self._scheduled.append(callback)


class GH_DocumentServer(object):
    def __init__(self):
        self.DocumentRemoved = _Event()
        self._documents = []

    def AddDocument(self, document):
        self._documents.append(document)

    def RemoveDocument(self, document):
        self._documents.remove(document)
        self.DocumentRemoved._raise(self, document)


class GH_Component(object):
    def __init__(self):
        self.InstanceGuid = Guid.NewGuid()
        self.Message = None
        self._document = None
        self._messages = []
        self._is_expired = False

    def OnPingDocument(self):
        return self._document

    def AddRuntimeMessage(self, level, text):
        assert isinstance(text, str)
        self._messages.append((level, text))

    def ClearRuntimeMessages(self):
        self._messages = []

    def RuntimeMessages(self, level):
        return [text for found, text in self._messages if found == level]

    def ExpireSolution(self, recompute):
        self._is_expired = True
