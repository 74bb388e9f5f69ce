"""The live solver, which stops by itself, and the one-shot solver, which solves to the end in one call."""

from shapeop_gh import library
from shapeop_gh import signatures as plain
from shapeop_gh.errors import ShapeOpError
from shapeop_gh.session import Session
from shapeop_gh.solver import whole_number

# Iterations of a tick without settings: few enough to look like motion.
ITERATIONS = 10

# The mean move, relative to the bounding-box diagonal, below which a live solver stops if it has no Threshold:
# under a thousandth of a pixel on a screen that the model fills.
RELATIVE_THRESHOLD = 1e-7

# Where constraints are hard, a tick solves until it is done, but no longer than that many seconds. As long as nothing
# changes the next one has twice the time, up to the second number, as contradictions are found within one call alone.
TICK_SECONDS, MOST_SECONDS = 0.1, 1.6

# Sweeps of such a tick at most: more than the time allows.
MOST_SWEEPS = 1000000

# The defaults of the one-shot solver.
MAX_ITERATIONS, PRECISION = 1000, 1e-6


class Live(object):
    """A session that is solved a few iterations at a time."""

    def __init__(self, coordinates, made_with):
        """`made_with`: the number of points, the tolerance of merging, whether iterations are accelerated, and whether
        there are hard constraints. Anything else can change while it runs."""
        self.made_with = made_with
        _, tolerance, is_accelerated, self.is_exploring = made_with
        self.seconds = TICK_SECONDS
        self.is_in_conflict = False
        self.threshold = RELATIVE_THRESHOLD * _diagonal(coordinates)
        self.session = Session(coordinates, tolerance)
        self.coordinates = coordinates  # where the points are
        self.iterations = 0
        self.mean_move = None  # of a point in an iteration (dynamic: a time step) of the last tick, in model units
        self.has_stopped = False
        if is_accelerated:
            self.session.solver.accelerate()

    def delete(self):
        self.session.delete()

    def explore(self, threshold):
        """Solves until hard constraints are met or found to contradict each other, or the time of a tick is over."""
        abi = library.declarations()
        if self.session.has_changed:
            self.seconds = TICK_SECONDS
        report = self.session.solver.solve_until(MOST_SWEEPS, PRECISION, self.seconds)
        before, self.coordinates = self.coordinates, self.session.points()
        self.iterations += report.iterations
        self.mean_move = _mean_move(before, self.coordinates) / max(report.iterations, 1)
        self.is_in_conflict = report.outcome == abi.SO_OUTCOME_INFEASIBLE
        is_at_rest = self.seconds >= MOST_SECONDS and self._is_below(threshold)
        self.has_stopped = report.outcome != abi.SO_OUTCOME_TIME_BUDGET or is_at_rest
        self.seconds = min(2 * self.seconds, MOST_SECONDS)

    def tick(self, iterations, dynamic, threshold):
        """Solves `iterations` iterations, or one time step, and finds out whether the points still move."""
        iterations = whole_number(iterations, "Iterations")
        if iterations == 0:
            raise ShapeOpError("Iterations: at least 1 expected, found 0")
        self.session.solver.solve(iterations)
        before, self.coordinates = self.coordinates, self.session.points()
        self.iterations += iterations
        self.mean_move = _mean_move(before, self.coordinates) / (1 if dynamic else iterations)
        self.has_stopped = self._is_below(threshold)

    def _is_below(self, threshold):
        return self.mean_move < (self.threshold if threshold is None else threshold)


def read(settings, forces):
    """The checked settings (None: static, ITERATIONS per tick), and the forces with the gravity that they ask for."""
    if settings is None:
        return plain.settings_live(ITERATIONS, None, None, None, None, False, None, False), forces
    settings = plain.read_settings(settings)
    if settings["unaryVector"] is None:
        return settings, forces
    return settings, forces + [plain.force(settings["unaryVector"], [])]


def solve_to_the_end(coordinates, signatures, forces, tolerance, max_iterations, precision, seconds):
    """(points, iterations, energy, violations and conflicts per signature, outcome in words); the solver is freed."""
    session = Session(coordinates, tolerance)
    try:
        session.update(signatures, forces, {"dynamic": False, "mass": 1.0})
        report = session.solver.solve_until(
            MAX_ITERATIONS if max_iterations is None else max_iterations,
            PRECISION if precision is None else precision,
            seconds or 0.0,
        )
        found = session.violations(), session.conflicts()
        return (session.points(), report.iterations, report.energy_after) + found + (_outcome(report.outcome),)
    finally:
        session.delete()


def _outcome(number):
    abi, prefix = library.declarations(), "SO_OUTCOME_"
    names = [n for n in vars(abi) if n.startswith(prefix) and getattr(abi, n) == number]
    return names[0][len(prefix) :].lower().replace("_", " ") if names else str(number)


def _mean_move(before, after):
    count = len(after) // 3
    moves = [
        ((after[i] - before[i]) ** 2 + (after[i + 1] - before[i + 1]) ** 2 + (after[i + 2] - before[i + 2]) ** 2) ** 0.5
        for i in range(0, 3 * count, 3)
    ]
    return sum(moves) / max(count, 1)


def _diagonal(coordinates):
    if not coordinates:
        return 0.0
    return sum((max(coordinates[c::3]) - min(coordinates[c::3])) ** 2 for c in range(3)) ** 0.5
