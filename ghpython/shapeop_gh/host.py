"""Grasshopper: data trees, messages, the next tick."""

from Grasshopper import DataTree
from Grasshopper.Kernel import GH_Document, GH_RuntimeMessageLevel
from Grasshopper.Kernel.Data import GH_Path

from shapeop_gh.errors import ShapeOpError

# Until the next tick of a live solver. The published client's value.
TICK_MILLISECONDS = 10


def run(ghenv, output_count, function, *inputs):
    """`function(component, *inputs)`, which gives `output_count` outputs: alone if it is one, else in a tuple. If it
    raises a ShapeOpError, the component shows the text as its error and the outputs are empty."""
    try:
        return function(ghenv.Component, *inputs)
    except ShapeOpError as error:
        ghenv.Component.AddRuntimeMessage(GH_RuntimeMessageLevel.Error, str(error))
        return None if output_count == 1 else (None,) * output_count


def again(component):
    """Has Grasshopper solve `component`, and what hangs on it, once more after TICK_MILLISECONDS."""

    def expire(document):
        if component.OnPingDocument() is not None:  # it may have been deleted since
            component.ExpireSolution(False)

    component.OnPingDocument().ScheduleSolution(TICK_MILLISECONDS, GH_Document.GH_ScheduleDelegate(expire))


def items(values):
    """The items of a list input, which may be None or one bare item; refuses nulls."""
    if values is None:
        return []
    if isinstance(values, (dict, str)) or not hasattr(values, "__iter__"):
        values = [values]
    return list(values)


def points(values, what):
    """The points of a list input as a list without nulls."""
    return [_not_null(p, what, i) for i, p in enumerate(items(values))]


def branches(tree):
    """The branches of a tree input as a list of (path, list); a list or one item counts as one branch {0}."""
    if tree is None:
        return []
    if not hasattr(tree, "Branches"):
        values = items(tree)
        return [(GH_Path(0), values)] if values else []
    return [(path, list(branch)) for path, branch in zip(tree.Paths, tree.Branches)]


def lists(tree, what):
    """The branches of a tree input as lists without nulls."""
    return [
        [_not_null(v, "%s {%d}" % (what, n), i) for i, v in enumerate(b)] for n, (_, b) in enumerate(branches(tree))
    ]


def tree(item_type, paths_and_lists):
    """A DataTree; a path is a GH_Path or an index."""
    made = DataTree[item_type]()
    for path, values in paths_and_lists:
        path = GH_Path(path) if isinstance(path, int) else path
        for value in values:
            made.Add(value, path)
    return made


def _not_null(value, what, place):
    if value is None:
        raise ShapeOpError("%s: item %d is null" % (what, place))
    return value
