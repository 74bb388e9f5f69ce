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
        """Per signature: the violation of each constraint."""
        by_id = self.solver.violations()
        return [[by_id[i] for i in ids] for ids in self._ids]

    def update(self, signatures, forces, settings):
        """Brings the solver up to date with its inputs. A constraint that is still there (same type, same points)
        keeps its rest state and its id; its weight and scalars are sent if they changed. New ones are added at rest
        where the points are now, missing ones removed. Scalars that are taken away make it a new constraint."""
        if signatures != self._given:
            self._given = None
            self._update_constraints(self._on_merged(plain.read(signatures)))
            self._given = plain.copied(signatures)
        self._update_forces(plain.read_forces(forces))
        self._update_settings(settings)

    def _on_merged(self, played):
        count = len(self.index_of)
        mapped = []
        for place, (type_name, index_lists, weights, scalars) in enumerate(played):
            with plain.blamed(place, type_name):
                for i in (i for indices in index_lists for i in indices):
                    if not 0 <= i < count:
                        raise ShapeOpError("index %d is out of range for %d points" % (i, count))
            merged = [[self.index_of[i] for i in indices] for indices in index_lists]
            mapped.append((type_name, merged, weights, scalars))
        return mapped

    def _update_constraints(self, played):
        if [_structure(p) for p in played] != [_structure(p) for p in self._played]:
            self._update_structure(played)
        for place, (type_name, _, weights, scalars) in enumerate(played):
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

    def _update_structure(self, played):
        """Adds and removes constraints. Afterwards `_played` has the structure of `played`, with the weights and
        scalars in force (None: the defaults)."""
        spare = {}
        for (type_name, index_lists, weights, scalars), ids in zip(self._played, self._ids):
            for k, constraint in enumerate(ids):
                key = (type_name, tuple(index_lists[k]), bool(scalars))
                spare.setdefault(key, []).append((constraint, weights[k], scalars[k] if scalars else None))
        in_force, all_ids, added = [], [], []
        try:
            for place, (type_name, index_lists, weights, scalars) in enumerate(played):
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
                        kept[k] = (constraint, weights[k], None)
                all_ids.append([constraint for constraint, _, _ in kept])
                old_weights = [weight for _, weight, _ in kept]
                old_scalars = [scalar for _, _, scalar in kept] if scalars else []
                in_force.append((type_name, index_lists, old_weights, old_scalars))
        except ShapeOpError:
            for constraint in added:
                self.solver.remove(constraint)
            raise
        for left in spare.values():
            for constraint, _, _ in left:
                self.solver.remove(constraint)
        self._played, self._ids = in_force, all_ids

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
    type_name, index_lists, _, scalars = played
    return type_name, index_lists, bool(scalars)
