"""Signatures, settings and forces: plain dicts and lists that travel between components.

A constraint signature says what one ConstraintSignature component makes, many constraints of one type:
{"type": str, "pointIndices": [[int]], "weights": [float], "scalars": [[float]] or []}, one entry per constraint. Where
they are to be met exactly, it has "hard": True; where a Handles component made it, "handles": True.
"""

from contextlib import contextmanager

from shapeop_gh.errors import ShapeOpError

# The published client's help calls the type so.
ALIASES = {"AngleConstraint": "Angle"}

# What the constraints of a signature are to a solver: a compromise by weight, exact, or handles.
SOFT, HARD, HANDLES = "soft", "hard", "handles"


def make(type_name, index_lists, weights, scalar_lists, role=SOFT):
    """A signature. One weight, or one list of scalars, is repeated for all constraints; points count as x y z."""
    count = len(index_lists)
    indices = [[_whole(i, "PointIndices", n) for i in branch] for n, branch in enumerate(index_lists)]
    weights = [_number(w, "Weights", n) for n, w in enumerate(weights)]
    scalars = [_numbers(branch, "Scalars", n) for n, branch in enumerate(scalar_lists)]
    made = {
        "type": type_name.strip(),
        "pointIndices": indices,
        "weights": _for_all(weights, count, "Weights", "weight"),
        "scalars": [list(s) for s in _for_all(scalars, count, "Scalars", "list of scalars")] if scalars else [],
    }
    if role != SOFT:
        made[role] = True
    return made


def are_hard(signatures):
    """Whether a constraint of the signatures is to be met exactly."""
    return any(isinstance(s, dict) and _role(s) == HARD for s in signatures)


def _role(signature):
    return HARD if signature.get(HARD) else HANDLES if signature.get(HANDLES) else SOFT


def read(signatures):
    """The signatures as (type, index lists, weights, scalar lists, role): checked, copied, the type by its library
    name."""
    played = []
    for place, signature in enumerate(signatures):
        where = "ConstraintSigs: item %d" % place
        try:
            type_name = signature["type"].strip()
            made = make(type_name, signature["pointIndices"], signature["weights"], signature["scalars"])
            role = _role(signature)
        except (TypeError, KeyError, AttributeError, IndexError):
            raise ShapeOpError("%s: a constraint signature expected, found %r" % (where, signature))
        except ShapeOpError as error:
            raise ShapeOpError("%s: %s" % (where, error))
        type_name = ALIASES.get(type_name, type_name)
        played.append((type_name, made["pointIndices"], made["weights"], made["scalars"], role))
    return played


@contextmanager
def blamed(place, type_name):
    """Around the calls that send a signature: an error says which one it was."""
    try:
        yield
    except ShapeOpError as error:
        raise ShapeOpError('ConstraintSigs: item %d ("%s"): %s' % (place, type_name, error))


def copied(signatures):
    """A copy that later changes of the signatures do not reach."""
    return [
        dict(
            s,
            pointIndices=[list(indices) for indices in s["pointIndices"]],
            weights=list(s["weights"]),
            scalars=[list(scalars) for scalars in s["scalars"]],
        )
        for s in signatures
    ]


def settings_static(iterations):
    return {"mode": "static", "iterations": 50 if iterations is None else iterations}


def settings_live(iterations, mass, damping, time_step, unary_vector, dynamic, pause, reset):
    """The settings of a live solver with the published client's keys and defaults."""
    return {
        "mode": "live",
        "iterations": 5 if iterations is None else iterations,
        "mass": 1.0 if mass is None else mass,
        "damping": 1.0 if damping is None else damping,
        "timeStep": 0.1 if time_step is None else time_step,
        "unaryVector": unary_vector,
        "dynamic": True if dynamic is None else dynamic,
        "pause": False if pause is None else pause,
        "reset": True if reset is None else reset,
    }


def read_settings(settings):
    """The settings as a dict with all keys of `settings_live`; raises if it is none of ours."""
    if isinstance(settings, (list, tuple)) and len(settings) == 1:
        settings = settings[0]
    if not isinstance(settings, dict) or settings.get("mode") not in ("static", "live"):
        raise ShapeOpError("Settings: those of SettingsStatic or SettingsLive expected, found %r" % (settings,))
    read = settings_live(None, None, None, None, None, settings["mode"] == "live", None, False)
    read.update(settings)
    return read


def force(vector, index_lists):
    """Forces of one vector: on the points of `index_lists`, or on every point (gravity) if that is empty."""
    if vector is None:
        raise ShapeOpError("Force: a vector expected, found nothing")
    indices = [_whole(i, "PointIndices", n) for n, branch in enumerate(index_lists) for i in branch]
    return {"force": xyz(vector, "Force"), "pointIndices": indices}


def read_forces(forces):
    """The forces as (vector, point index or None for every point), in order."""
    played = []
    for place, given in enumerate(forces):
        try:
            vector, indices = given["force"], given["pointIndices"]
        except (TypeError, KeyError):
            raise ShapeOpError("Forces: item %d: a force of the Force component expected, found %r" % (place, given))
        played.extend((list(vector), index) for index in (indices or [None]))
    return played


def xyz(point, what):
    """The coordinates of a point or vector of Rhino."""
    try:
        return [float(point.X), float(point.Y), float(point.Z)]
    except AttributeError:
        raise ShapeOpError("%s: a point or vector expected, found %r" % (what, point))


def coordinates(points):
    """x y z of point 0, then of point 1, and so on."""
    return [c for i, point in enumerate(points) for c in xyz(point, "Points: item %d" % i)]


def _for_all(values, count, what, singular):
    if len(values) == count:
        return values
    if len(values) == 1:
        return values * count
    raise ShapeOpError(
        "%s: one %s for all or one for each of the %d constraints expected, found %d"
        % (what, singular, count, len(values))
    )


def _numbers(branch, what, place):
    """The numbers of a branch; a point stands for its three coordinates."""
    numbers = []
    for item in branch:
        numbers.extend(xyz(item, what) if hasattr(item, "X") else [_number(item, what, place)])
    return numbers


def _number(value, what, place):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ShapeOpError("%s: item %d: a number expected, found %r" % (what, place, value))


def _whole(value, what, place):
    try:
        number = int(value)
        if number == value:
            return number
    except (TypeError, ValueError, OverflowError):
        pass
    raise ShapeOpError("%s: item %d: a whole number expected, found %r" % (what, place, value))
