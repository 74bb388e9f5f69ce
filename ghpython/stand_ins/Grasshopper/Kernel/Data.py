class GH_Path(object):
    def __init__(self, *indices):
        assert indices and all(isinstance(i, int) for i in indices)
        self.Indices = list(indices)

    @property
    def Length(self):
        return len(self.Indices)

    def AppendElement(self, index):
        return GH_Path(*(self.Indices + [index]))

    def ToString(self):
        return "{" + ";".join(str(i) for i in self.Indices) + "}"

    def __eq__(self, other):
        return isinstance(other, GH_Path) and self.Indices == other.Indices

    def __ne__(self, other):
        return not self == other

    __hash__ = None
