"""The reference trajectories of libShapeOp 0.1.0, played through components."""

import json
import os
import unittest

from support import FIXTURES, IS_JYTHON, NEEDS_CTYPES, Canvas, flat, plain, points, signature, tree
from Rhino.Geometry import Vector3d


def fixtures():
    for name in sorted(os.listdir(FIXTURES)):
        if name.endswith(".json"):
            with open(os.path.join(FIXTURES, name)) as file:
                for fixture in json.load(file):
                    yield fixture


def kinds(fixture, key):
    return set(entry["kind"] for entry in fixture[key])


def signatures(canvas, fixture, edits, made=None):
    """One signature per constraint, in the order of the ids; `edits` replaces scalars. As Grasshopper does, only the
    ConstraintSignature components whose inputs changed since `made` are solved again."""
    made = made or [None] * len(fixture["constraints"])
    for number, constraint in enumerate(fixture["constraints"]):
        if made[number] is None or number in edits:
            scalars = edits.get(number, constraint["scalars"])
            kind, weight = str(constraint["type"]), constraint["weight"]
            (made[number],) = signature(canvas, kind, [constraint["indices"]], [weight], [scalars] if scalars else [])
    return made


def share_of_tolerance(fixture, snapshot, solved):
    given = fixture["points"]
    diagonal = sum((max(p[c] for p in given) - min(p[c] for p in given)) ** 2 for c in range(3)) ** 0.5
    tolerance = max(1e-9, 1e4 * fixture["sensitivity_to_1e_minus15_input_noise"][snapshot]) * diagonal
    expected = fixture["expected"][snapshot]
    return max(
        abs(a[c] - b) / tolerance for a, row in zip(expected, zip(*[iter(solved)] * 3)) for c, b in enumerate(row)
    )


class Played(object):
    """What both ways of playing share."""

    def setUp(self):
        self.canvas = Canvas()

    def tearDown(self):
        self.canvas.close()

    def play(self, fixture, start, tick):
        """Calls `start`, then `tick(events of it)` as often as the fixture solves; returns the worst share of the
        tolerance. Both answer the points."""
        start()
        worst = 0.0
        for solve in range(1, fixture["solves"] + 1):
            solved = tick([e for e in fixture["events"] if e["before_solve"] == solve])
            if str(solve) in fixture["expected"]:
                worst = max(worst, share_of_tolerance(fixture, str(solve), solved))
        self.assertTrue(worst <= 1.0, "%s: %g of the tolerance" % (fixture["name"], worst))
        return worst


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Published(Played, unittest.TestCase):
    def test_every_fixture_without_vertex_forces_gives_the_reference_points(self):
        played, worst = 0, 0.0
        for fixture in fixtures():
            if "vertex" in kinds(fixture, "forces"):
                continue
            self.assertTrue(kinds(fixture, "events") <= {"editConstraint"})
            worst = max(worst, self.play_published(fixture))
            played += 1
        print("\nConstraintSolver: %d fixtures, worst at %.3g of its tolerance" % (played, worst))
        self.assertEqual(played, 139)

    def play_published(self, fixture):
        canvas, edits = self.canvas, {}
        solver, live = canvas.add("ShapeOpConstraintSolver"), canvas.add("ShapeOpSettingsLive")
        # An edit can only come later for a constraint that had scalars at the reset: its own place, for Closeness.
        for event in fixture["events"]:
            number = event["id"]
            if fixture["constraints"][number]["scalars"] is None:
                self.assertEqual(event["type"], "Closeness")
                edits[number] = fixture["points"][fixture["constraints"][number]["indices"][0]]
        forces = [f["force"] for f in fixture["forces"]]
        self.assertTrue(len(forces) <= 1)
        made = signatures(canvas, fixture, edits)
        given = [c for p in fixture["points"] for c in p]

        def run(reset):
            (settings,) = live.run(
                Iterations=fixture["iterations_per_solve"],
                Mass=fixture["masses"],
                Damping=fixture["damping"],
                TimeStep=fixture["timestep"],
                UnaryVector=Vector3d(*forces[0]) if forces else None,
                Dynamic=fixture["mode"] == "dynamic",
                Reset=reset,
            )["Settings"]
            result = solver.run(ConstraintSigs=made, Points=points(given), Settings=settings)
            self.assertEqual(solver.errors(), [])
            return flat(result["Points"])

        def tick(events):
            if events:
                signatures(canvas, fixture, dict((e["id"], e["scalars"]) for e in events), made)
            return run(False)

        return self.play(fixture, lambda: run(True), tick)


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Live(Played, unittest.TestCase):
    def test_plain_iterations_give_the_reference_points_with_forces_and_edits_while_it_runs(self):
        played, left_out, worst = 0, 0, 0.0
        for fixture in fixtures():
            # The component has no ports for these: static solving has no time step, and nothing initialises anew alone.
            static = fixture["mode"] == "static"
            if "reinit" in kinds(fixture, "events") or (static and "setTimeStep" in kinds(fixture, "events")):
                left_out += 1
                continue
            worst = max(worst, self.play_live(fixture))
            played += 1
        print("\nLiveSolver: %d fixtures (%d left out), worst at %.3g of its tolerance" % (played, left_out, worst))
        self.assertEqual((played, left_out), (145, 4))

    def play_live(self, fixture):
        canvas, now = self.canvas, {"damping": fixture["damping"], "timestep": fixture["timestep"]}
        solver, live, force = [canvas.add(n) for n in ("ShapeOpLiveSolver", "ShapeOpSettingsLive", "ShapeOpForce")]
        forces = [(f["force"], f.get("id") if f["kind"] == "vertex" else None) for f in fixture["forces"]]
        made = signatures(canvas, fixture, {})
        given = [c for p in fixture["points"] for c in p]

        def run(reset):
            (settings,) = live.run(
                Iterations=fixture["iterations_per_solve"],
                Mass=fixture["masses"],
                Damping=now["damping"],
                TimeStep=now["timestep"],
                Dynamic=fixture["mode"] == "dynamic",
                Reset=reset,
            )["Settings"]
            acting = []
            for vector, index in forces:
                indices = None if index is None else tree([index])
                acting += force.run(Force=Vector3d(*vector), PointIndices=indices)["Forces"]
            result = solver.run(
                ConstraintSigs=tree(made),
                Points=tree(points(given)),
                Forces=acting,
                Settings=settings,
                Threshold=0.0,
                Accelerate=False,
            )
            self.assertEqual(solver.errors(), [])
            return flat(plain(result["Points"])[0][1])

        def tick(events):
            for event in events:
                if event["kind"] == "editConstraint":
                    signatures(canvas, fixture, {event["id"]: event["scalars"]}, made)
                elif event["kind"] == "editVertexForce":
                    forces[event["force_id"]] = (event["force"], event["id"])
                else:
                    now[{"setDamping": "damping", "setTimeStep": "timestep"}[event["kind"]]] = event["value"]
            return run(False)

        return self.play(fixture, lambda: run(True), tick)


if __name__ == "__main__":
    unittest.main()
