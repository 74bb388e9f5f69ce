from Grasshopper import Kernel


class _DataTree(object):
    """DataTree[int]() and its like. An item of another type is refused, as .NET does; an int is a float there too."""

    _item_type = None

    def __init__(self):
        self._branches = []

    def Add(self, item, path):
        wanted = self._item_type
        if wanted is not None and not (isinstance(item, wanted) or (wanted is float and type(item) is int)):
            raise TypeError("DataTree[%s] takes no %r" % (wanted.__name__, item))
        assert isinstance(path, Kernel.Data.GH_Path)
        for known, branch in self._branches:
            if known == path:
                branch.append(item)
                return
        self._branches.append((path, [item]))
        self._branches.sort(key=lambda pair: pair[0].Indices)

    @property
    def Paths(self):
        return [path for path, _ in self._branches]

    @property
    def Branches(self):
        return [branch for _, branch in self._branches]

    @property
    def BranchCount(self):
        return len(self._branches)

    @property
    def DataCount(self):
        return sum(len(branch) for branch in self.Branches)


class _Generic(object):
    def __getitem__(self, item_type):
        class Typed(_DataTree):
            _item_type = None if item_type is object else item_type

        return Typed


DataTree = _Generic()


class Instances(object):
    DocumentServer = Kernel.GH_DocumentServer()
