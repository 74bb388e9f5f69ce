class IndexPair(object):
    def __init__(self, i, j):
        self.I, self.J = i, j  # noqa: E741
