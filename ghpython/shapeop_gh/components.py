"""One function per component: inputs as Grasshopper gives them, outputs as it takes them.

A list around a dict keeps GhPython from taking the dict for a list of its keys.
"""

from Rhino.Geometry import Point3d
from System.Drawing import Color

from shapeop_gh import host, indexing, states
from shapeop_gh import signatures as plain

# The published client's.


def mesh_indexer(component, pattern, mesh):
    if not pattern or mesh is None:
        return []
    return host.tree(int, indexing.pattern(pattern, mesh))


def anchors_indexer(component, mesh, anchors):
    anchors = host.items(anchors)
    if mesh is None or not anchors or None in anchors:
        return [], []
    vertices = list(mesh.Vertices.ToPoint3dArray())
    ends = [indexing.ends(anchor, "AnchorGeo") for anchor in anchors]
    found = [(i, [indexing.nearest(vertices, start)]) for i, (start, _) in enumerate(ends)]
    return host.tree(int, found), host.tree(Point3d, [(i, [end]) for i, (_, end) in enumerate(ends)])


def constraint_signature(component, constraint_type, indices, weights, scalars, hard):
    indices, weights = host.lists(indices, "PointIndices"), host.items(weights)
    if not constraint_type or not indices or not weights:
        return []
    role = plain.HARD if hard else plain.SOFT
    return [plain.make(constraint_type, indices, weights, host.lists(scalars, "Scalars"), role)]


def settings_static(component, iterations):
    return [plain.settings_static(iterations)]


def settings_live(component, *settings):
    return [plain.settings_live(*settings)]


def constraint_solver(component, signatures, points, settings):
    from shapeop_gh import published

    signatures, given = host.items(signatures), host.items(points)
    if not signatures or not given or not settings:
        return None, None, points
    settings = plain.read_settings(settings)
    if settings["mode"] == "static":
        solved, iterations, count = published.solve_static(plain.coordinates(given), signatures, settings)
        return iterations, count, _points(solved)
    state = states.get(component)
    if settings["reset"] or state is None:
        states.drop(component)
        state = published.Published(plain.coordinates(given), signatures, settings)
        states.put(component, state)
        component.Message = None
    if not settings["reset"]:
        state.tick(len(given), signatures, settings["iterations"])
        component.Message = "Solver is Paused" if settings["pause"] else "Solver is Running Live"
        if not settings["pause"]:
            host.again(component)
    return state.iterations, state.constraint_count, _points(state.solver.points())


# Solvers that report.


def live_solver(component, signatures, points, forces, settings, threshold, tolerance, accelerate, on, reset):
    from shapeop_gh import live

    sent, given = host.branches(signatures), host.branches(points)
    flat, point_count = _flat(sent), len(_flat(given))
    if not flat or not point_count:
        return (None,) * 7
    component.Message = None
    settings, forces = live.read(settings, host.items(forces))
    reset = bool(reset) or settings["reset"]
    paused = not _is_on(on) or settings["pause"]
    made_with = (point_count, tolerance, _is_on(accelerate), plain.are_hard(flat))
    state = states.get(component)
    if reset or state is None or state.made_with != made_with:
        states.drop(component)
        state = live.Live(plain.coordinates(_flat(given)), made_with)
        states.put(component, state)
    state.session.update(flat, forces, settings)
    if not reset and not paused:
        if state.is_exploring:
            state.explore(threshold)
        else:
            state.tick(settings["iterations"], settings["dynamic"], threshold)
        if not state.has_stopped:
            host.again(component)
    component.Message = "Reset" if reset else "Paused" if paused else _how_it_goes(state)
    return (
        _like(given, state.coordinates),
        state.iterations,
        state.session.solver.energy(),
        _violations(sent, state.session.violations()),
        state.mean_move,
        state.has_stopped,
        _conflicts(sent, state.session.conflicts()),
    )


def _how_it_goes(state):
    return "In conflict" if state.is_in_conflict else "Stopped" if state.has_stopped else "Running"


def one_shot_solver(component, signatures, points, forces, tolerance, max_iterations, precision, seconds):
    from shapeop_gh import live

    sent, given = host.branches(signatures), host.branches(points)
    flat, coordinates = _flat(sent), plain.coordinates(_flat(given))
    if not flat or not coordinates:
        return (None,) * 6
    solved, iterations, energy, violations, conflicts, outcome = live.solve_to_the_end(
        coordinates, flat, host.items(forces), tolerance, max_iterations, precision, seconds
    )
    violations, conflicts = _violations(sent, violations), _conflicts(sent, conflicts)
    return _like(given, solved), iterations, energy, violations, outcome, conflicts


# What goes into them.


def force(component, vector, indices):
    return [plain.force(vector, host.lists(indices, "PointIndices"))]


def handles(component, points, handles, strength, reset):
    points, handles = host.points(points, "Points"), host.points(handles, "Handles")
    if not points or not handles:
        states.drop(component)
        return [], []
    ends = [indexing.ends(handle, "Handles") for handle in handles]
    grabbed = states.get(component)
    if reset or grabbed is None or grabbed.sizes != (len(points), len(handles)):
        grabbed = _Grabbed((len(points), len(handles)), [indexing.nearest(points, start) for start, _ in ends])
        states.put(component, grabbed)
    weights = host.items(strength) or [1000.0]
    targets = [plain.xyz(end, "Handles") for _, end in ends]
    made = plain.make("Closeness", [[i] for i in grabbed.indices], weights, targets, plain.HANDLES)
    return [made], host.tree(int, [(n, [i]) for n, i in enumerate(grabbed.indices)])


class _Grabbed(object):
    """Which points the handles hold: those nearest when they were first seen."""

    def __init__(self, sizes, indices):
        self.sizes, self.indices = sizes, indices

    def delete(self):
        pass


def constraint_types(component, filter_text):
    from shapeop_gh import library

    types = library.constraint_types(library.load())
    if filter_text:
        types = [t for t in types if filter_text.lower() in (t["name"] + " " + t["help"]).lower()]
    points = ["%s: %s" % (_count(t["least"], t["greatest"]), ", ".join(t["points"])) for t in types]
    scalars = [", ".join(t["scalars"]) for t in types]
    return [t["name"] for t in types], [t["help"] for t in types], points, scalars, [t["unit"] for t in types]


def _is_on(switch):
    """A switch that is on unless it is set to False."""
    return switch is None or bool(switch)


def _count(least, greatest):
    return (
        "%d" % least if least == greatest else "%d or more" % least if greatest < 0 else "%d to %d" % (least, greatest)
    )


# Seeing what came out.


def planarity(component, points, indices, limit):
    from shapeop_gh import colours, library

    sent, coordinates = host.branches(indices), plain.coordinates(host.points(points, "Points"))
    if not sent or not coordinates:
        return (None,) * 4
    faces, loaded = host.lists(indices, "PointIndices"), library.load()
    ratios = library.measure_faces(loaded, "planarity", coordinates, faces)
    distances = library.measure_faces(loaded, "plane_distance", coordinates, faces)
    limit = 0.01 if limit is None else limit
    shown = [colours.planarity(ratio, limit) for ratio in ratios]
    return _per_branch(float, sent, ratios), _colours(sent, shown), _per_branch(float, sent, distances), _worst(ratios)


def strain(component, points, indices, rest_lengths, limit):
    from shapeop_gh import colours

    sent, coordinates = host.branches(indices), plain.coordinates(host.points(points, "Points"))
    rest_lengths = host.points(rest_lengths, "RestLengths")
    if not sent or not coordinates or not rest_lengths:
        return (None,) * 3
    strains = colours.strains(coordinates, host.lists(indices, "PointIndices"), rest_lengths)
    limit = 0.01 if limit is None else limit
    shown = [colours.strain(value, limit) for value in strains]
    return _per_branch(float, sent, strains), _colours(sent, shown), _worst([abs(value) for value in strains])


def _points(coordinates):
    return [Point3d(*coordinates[i : i + 3]) for i in range(0, len(coordinates), 3)]


def _flat(branches):
    return [item for _, branch in branches for item in branch]


def _like(branches, coordinates):
    """A tree of points with the branches of the given ones."""
    solved, made, start = _points(coordinates), [], 0
    for path, branch in branches:
        made.append((path, solved[start : start + len(branch)]))
        start += len(branch)
    return host.tree(Point3d, made)


def _violations(branches, per_signature):
    """Branch {path; i}: the violations of the signature `i` in the branch `path`, one per constraint, in order."""
    paths = [path.AppendElement(i) for path, branch in branches for i in range(len(branch))]
    return host.tree(float, zip(paths, per_signature))


def _conflicts(branches, per_signature):
    """Branch {path; i}: which constraints of the signature `i` in the branch `path` are in conflict."""
    paths = [path.AppendElement(i) for path, branch in branches for i in range(len(branch))]
    return host.tree(int, zip(paths, per_signature))


def _per_branch(item_type, branches, values):
    return host.tree(item_type, [(path, [value]) for (path, _), value in zip(branches, values)])


def _colours(branches, colours):
    return _per_branch(Color, branches, [Color.FromArgb(*colour) for colour in colours])


def _worst(values):
    """The place of the greatest value."""
    return max(range(len(values)), key=lambda i: values[i])
