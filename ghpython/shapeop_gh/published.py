"""The published client's solver: what it calls, in its order.

Reset: create, add, edit, force, init. Every further tick, a paused one too: edit, solve, read. Static: all of it in
one call. Constraints that had no scalars at the reset are not edited later; weights count at the reset, and so does
which constraints are hard: of those the published client knew nothing.
"""

from shapeop_gh import signatures as plain
from shapeop_gh.errors import ShapeOpError
from shapeop_gh.solver import Solver


class Published(object):
    def __init__(self, coordinates, signatures, settings):
        self.iterations = self.constraint_count = 0
        self._editable = []  # [place of the signature, ids of its constraints, scalars in force]
        self.solver = Solver()
        try:
            self.solver.set_points(coordinates)
            self._point_count = len(coordinates) // 3
            self._add(plain.read(signatures))
            self._given = plain.copied(signatures)
            self._init(settings)
        except ShapeOpError:
            self.delete()
            raise

    def _add(self, played):
        for place, (type_name, index_lists, weights, scalars, role) in enumerate(played):
            with plain.blamed(place, type_name):
                ids = self.solver.add(type_name, index_lists, weights) if index_lists else []
                if scalars:
                    self.solver.edit(type_name, ids, scalars)
                if role == plain.HARD:
                    self.solver.set_hard(ids, True)
            self.constraint_count += len(ids)
            if scalars:
                self._editable.append([place, ids, scalars])

    def _init(self, settings):
        if settings["unaryVector"] is not None:
            self.solver.add_force(plain.xyz(settings["unaryVector"], "UnaryVector"), None)
        if settings["dynamic"]:
            self.solver.init_dynamic(settings["mass"], settings["damping"], settings["timeStep"])
        else:
            self.solver.init_static()

    def delete(self):
        self.solver.delete()

    def tick(self, point_count, signatures, iterations):
        """Edits what is editable, then solves. Edits without a change are left out: they are none to the library."""
        if point_count != self._point_count:
            raise ShapeOpError(
                "Points: %d expected, as at the last Reset, found %d: Reset takes the new ones"
                % (self._point_count, point_count)
            )
        if signatures != self._given:
            self._edit(plain.read(signatures))
            self._given = plain.copied(signatures)
        self.solver.solve(iterations)
        self.iterations += int(iterations)

    def _edit(self, played):
        for editable in self._editable:
            place, ids, in_force = editable
            type_name, _, _, scalars, _ = played[place] if place < len(played) else ("", None, None, [], None)
            if len(scalars) != len(ids):
                raise ShapeOpError(
                    "ConstraintSigs: item %d: %d lists of scalars expected, as at the last Reset, found %d: Reset "
                    "takes the new ones" % (place, len(ids), len(scalars))
                )
            if scalars != in_force:
                with plain.blamed(place, type_name):
                    self.solver.edit(type_name, ids, scalars)
                editable[2] = scalars


def solve_static(coordinates, signatures, settings):
    """(points, iterations, constraint count) after one static solve with all iterations."""
    settings = dict(settings, dynamic=False, unaryVector=None)
    state = Published(coordinates, signatures, settings)
    try:
        state.tick(len(coordinates) // 3, signatures, settings["iterations"])
        return state.solver.points(), state.iterations, state.constraint_count
    finally:
        state.delete()
