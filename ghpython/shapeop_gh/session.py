"""Points, signatures and forces in a solver. Points are sent once; later only what changed is sent."""

from shapeop_gh import signatures as plain
from shapeop_gh.errors import ShapeOpError
from shapeop_gh.merging import merge
from shapeop_gh.solver import Solver


class Session(object):
    """A solver that follows its inputs while it runs: see `update`."""

    def __init__(self, coordinates, tolerance):
        merged, self.index_of = merge(coordinates, tolerance)
        self.iterations = 0
        self._given = None  # a copy of the signatures that are in force, to see with one comparison that none changed
        self._played = []  # the signatures in force, as `signatures.read` gives them
        self._ids = []  # per signature: the id of each constraint
        self._handles = {}  # the target of each point that is a handle
        self._handle_weight = None
        self._handles_of = {}  # per place of a signature of handles: (point, target) of each
        self._is_exploring = False  # whether there are hard constraints
        self.has_changed = False  # whether the last `update` found other signatures
        self._forces = []  # ((vector, index or None), id)
        self._settings = None
        self.solver = Solver()
        try:
            self.solver.set_points(merged)
        except ShapeOpError:
            self.delete()
            raise

    def delete(self):
        self.solver.delete()

    def points(self):
        """The coordinates of all given points, merged ones included."""
        merged = self.solver.points()
        return [c for k in self.index_of for c in merged[3 * k : 3 * k + 3]]

    def violations(self):
        """Per signature: the violation of each constraint; of a handle its distance from the target."""
        by_id, points = self.solver.violations(), None
        per_signature = [[by_id[i] for i in ids] for ids in self._ids]
        for place, handles in self._handles_of.items():
            points = points or self.solver.points()
            per_signature[place] = [_distance(points[3 * i : 3 * i + 3], target) for i, target in handles]
        return per_signature

    def conflicts(self):
        """Per signature: which of its constraints contradict each other, or others, counted from 0."""
        found = set(self.solver.conflicts()) if self._is_exploring else ()
        return [[k for k, constraint in enumerate(ids) if constraint in found] for ids in self._ids]

    def update(self, signatures, forces, settings):
        """Brings the solver up to date with its inputs. A constraint that is still there (same type, same points)
        keeps its rest state and its id; its weight and scalars are sent if they changed. New ones are added at rest
        where the points are now, missing ones removed. Scalars that are taken away make it a new constraint. Where
        there are hard constraints, handles are the library's own."""
        self._is_exploring = plain.are_hard(signatures)
        if self._is_exploring and settings["dynamic"]:
            raise ShapeOpError("Settings: Dynamic must be False where constraints are hard, found True")
        self.has_changed = signatures != self._given
        if self.has_changed:
            self._given = None
            played = self._on_merged(plain.read(signatures))
            handles, weight = _handles(played) if self._is_exploring else ({}, None)
            self._update_constraints([_nothing(p) if n in handles else p for n, p in enumerate(played)])
            self._update_handles(handles, weight)
            self._given = plain.copied(signatures)
        self._update_forces(plain.read_forces(forces))
        self._update_settings(settings)

    def _on_merged(self, played):
        count = len(self.index_of)
        mapped = []
        for place, (type_name, index_lists, weights, scalars, role) in enumerate(played):
            with plain.blamed(place, type_name):
                for i in (i for indices in index_lists for i in indices):
                    if not 0 <= i < count:
                        raise ShapeOpError("index %d is out of range for %d points" % (i, count))
            merged = [[self.index_of[i] for i in indices] for indices in index_lists]
            mapped.append((type_name, merged, weights, scalars, role))
        return mapped

    def _update_constraints(self, played):
        if [_structure(p) for p in played] != [_structure(p) for p in self._played]:
            self._update_structure(played)
        for place, (type_name, _, weights, scalars, role) in enumerate(played):
            ids, in_force = self._ids[place], self._played[place]
            changed = [k for k in range(len(ids)) if weights[k] != in_force[2][k]]
            if changed:
                with plain.blamed(place, type_name):
                    self.solver.set_weights([ids[k] for k in changed], [weights[k] for k in changed])
                in_force[2][:] = weights
            changed = [k for k in range(len(scalars)) if scalars[k] != in_force[3][k]]
            if changed:
                with plain.blamed(place, type_name):
                    self.solver.edit(type_name, [ids[k] for k in changed], [scalars[k] for k in changed])
                in_force[3][:] = scalars
            is_hard = role == plain.HARD
            changed = [k for k in range(len(ids)) if in_force[4][k] != is_hard]
            if changed:
                with plain.blamed(place, type_name):
                    self.solver.set_hard([ids[k] for k in changed], is_hard)
                in_force[4][:] = [is_hard] * len(ids)

    def _update_structure(self, played):
        """Adds and removes constraints. Afterwards `_played` has the structure of `played`, with the weights and
        scalars in force (None: the defaults), and whether each constraint is hard."""
        spare = {}
        for (type_name, index_lists, weights, scalars, are_hard), ids in zip(self._played, self._ids):
            for k, constraint in enumerate(ids):
                key = (type_name, tuple(index_lists[k]), bool(scalars))
                kept = (constraint, weights[k], scalars[k] if scalars else None, are_hard[k])
                spare.setdefault(key, []).append(kept)
        in_force, all_ids, added = [], [], []
        try:
            for place, (type_name, index_lists, weights, scalars, _) in enumerate(played):
                kept = []
                for indices in index_lists:
                    same = spare.get((type_name, tuple(indices), bool(scalars)))
                    kept.append(same.pop(0) if same else None)
                new = [k for k, constraint in enumerate(kept) if constraint is None]
                if new:
                    with plain.blamed(place, type_name):
                        ids = self.solver.add(type_name, [index_lists[k] for k in new], [weights[k] for k in new])
                    added.extend(ids)
                    for k, constraint in zip(new, ids):
                        kept[k] = (constraint, weights[k], None, False)
                all_ids.append([constraint for constraint, _, _, _ in kept])
                old_weights = [weight for _, weight, _, _ in kept]
                old_scalars = [scalar for _, _, scalar, _ in kept] if scalars else []
                are_hard = [is_hard for _, _, _, is_hard in kept]
                in_force.append((type_name, index_lists, old_weights, old_scalars, are_hard))
        except ShapeOpError:
            for constraint in added:
                self.solver.remove(constraint)
            raise
        for left in spare.values():
            for constraint, _, _, _ in left:
                self.solver.remove(constraint)
        self._played, self._ids = in_force, all_ids

    def _update_handles(self, handles, weight):
        """`handles`: per place of a signature the (point, target) of each of its handles; `weight`: that of all."""
        targets = dict(pair for pairs in handles.values() for pair in pairs)
        for point in [p for p in self._handles if p not in targets]:
            self.solver.release_handle(point)
            del self._handles[point]
        if handles and weight != self._handle_weight:
            self.solver.set_handle_weight(weight)
            self._handle_weight = weight
        for point, target in targets.items():
            if self._handles.get(point) != target:
                self.solver.set_handle(point, target)
                self._handles[point] = target
        self._handles_of = handles

    def _update_forces(self, forces):
        count = len(self.index_of)
        for _, index in forces:
            if index is not None and not 0 <= index < count:
                raise ShapeOpError("Forces: index %d is out of range for %d points" % (index, count))
        forces = [(vector, None if index is None else self.index_of[index]) for vector, index in forces]
        for place, (vector, index) in enumerate(forces):
            if place == len(self._forces):
                self._forces.append(((vector, index), self.solver.add_force(vector, index)))
                continue
            old, force_id = self._forces[place]
            if old == (vector, index):
                continue
            if None not in (old[1], index):
                self.solver.edit_vertex_force(force_id, vector, index)
            else:
                old_id, force_id = force_id, self.solver.add_force(vector, index)
                self.solver.remove_force(old_id)
            self._forces[place] = ((vector, index), force_id)
        while len(self._forces) > len(forces):
            self.solver.remove_force(self._forces[-1][1])
            self._forces.pop()

    def _update_settings(self, settings):
        """Initialises the solver if that is needed, and sets damping and time step, which can change while it runs."""
        old, keys = self._settings, ("dynamic", "mass")
        if old is None or [old[k] for k in keys] != [settings[k] for k in keys]:
            if settings["dynamic"]:
                self.solver.init_dynamic(settings["mass"], settings["damping"], settings["timeStep"])
            else:
                self.solver.init_static()
        elif settings["dynamic"]:
            if old["damping"] != settings["damping"]:
                self.solver.set_damping(settings["damping"])
            if old["timeStep"] != settings["timeStep"]:
                self.solver.set_time_step(settings["timeStep"])
        self._settings = dict(settings)


def _structure(played):
    type_name, index_lists, _, scalars, _ = played
    return type_name, index_lists, bool(scalars)


def _nothing(played):
    """A signature of the same type without constraints."""
    return played[0], [], [], [], plain.SOFT


def _handles(played):
    """The handles that can be the library's own, per place of their signature, and their weight: it has one for all,
    above 0, and one target per point. Where that is not so, they stay the constraints that they are elsewhere."""
    given = [(n, p) for n, p in enumerate(played) if p[4] == plain.HANDLES and len(p[3]) == len(p[1])]
    weights = [weight for _, p in given for weight in p[2]]
    points = [indices[0] for _, p in given for indices in p[1]]
    if not points or min(weights) <= 0 or len(set(weights)) > 1 or len(set(points)) < len(points):
        return {}, None
    return dict((n, [(i[0], target) for i, target in zip(p[1], p[3])]) for n, p in given), weights[0]


def _distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5
