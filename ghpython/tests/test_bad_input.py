"""The ordinary mistakes: an error names them, the outputs are empty, and the next good input works."""

import unittest

from support import IS_JYTHON, NEEDS_CTYPES, Canvas, flat, plain, points, signature, tree
from Rhino.Geometry import Vector3d

CORNERS = [0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1]
NAN = float("nan")


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Mistakes(unittest.TestCase):
    def setUp(self):
        self.canvas = Canvas()
        self.good = signature(self.canvas, "Plane", [[0, 1, 2, 3]]) + signature(self.canvas, "Closeness", [[0], [2]])
        live = self.canvas.add("ShapeOpSettingsLive").run
        self.reset, self.run = live(Reset=True)["Settings"][0], live(Reset=False)["Settings"][0]
        self.static = self.canvas.add("ShapeOpSettingsStatic").run()["Settings"][0]

    def tearDown(self):
        self.canvas.close()

    def bad_signatures(self):
        good = self.good[0]
        return [
            ("99", signature(self.canvas, "Plane", [[0, 1, 99]])),
            ("-1", signature(self.canvas, "Plane", [[0, 1, -1]])),
            ("Plain", signature(self.canvas, "Plain", [[0, 1, 2]])),
            ("at least 3", signature(self.canvas, "Plane", [[0, 1]])),
            ("min <= max", signature(self.canvas, "EdgeStrain", [[0, 1]], [1.0], [[1.0, 2.0, 1.0]])),
            ("3", signature(self.canvas, "EdgeStrain", [[0, 1]], [1.0], [[1.0, 2.0]])),
            ("Plane", signature(self.canvas, "Plane", [[0, 1, 2]], [1.0], [[1.0]])),
            ("-5", signature(self.canvas, "Plane", [[0, 1, 2]], [-5.0])),
            ("Closeness", signature(self.canvas, "Closeness", [[0]], [1.0], [[NAN, 0.0, 0.0]])),
            ("a constraint signature expected", ["Plane"]),
            ("Weights: one weight for all", [dict(good, weights=[1.0, 2.0])]),
            ("a constraint signature expected", [good, {"type": "Plane"}]),
        ]

    def refused(self, component, text, **given):
        made = component.run(**given)
        self.assertEqual(len(component.errors()), 1, (text, component.errors()))
        self.assertIn(text, component.errors()[0])
        self.assertEqual(set(made.values()), {None})
        self.assertEqual(self.canvas.document._scheduled, [])

    def test_wrong_signatures_in_every_solver(self):
        for text, signatures in self.bad_signatures():
            for settings in (self.static, self.reset, self.run):
                old = self.canvas.add("ShapeOpConstraintSolver")
                self.refused(old, text, ConstraintSigs=signatures, Points=points(CORNERS), Settings=settings)
            for name in ("ShapeOpLiveSolver", "ShapeOpOneShotSolver"):
                solver = self.canvas.add(name)
                self.refused(solver, text, ConstraintSigs=tree(signatures), Points=tree(points(CORNERS)))
                result = solver.run(ConstraintSigs=tree(self.good), Points=tree(points(CORNERS)))
                self.assertEqual(solver.errors(), [])
                self.assertNotEqual(flat(plain(result["Points"])[0][1]), CORNERS)
                self.canvas.document._scheduled = []

    def test_a_running_solver_outlives_wrong_signatures_and_goes_on(self):
        for text, signatures in self.bad_signatures():
            twin, solver = [self.canvas.add("ShapeOpLiveSolver") for _ in range(2)]
            given = dict(Points=tree(points(CORNERS)), Threshold=0.0)
            for component in (twin, solver):
                component.run(ConstraintSigs=tree(self.good), **given)
            self.canvas.document._scheduled = []
            # The signature before the wrong one is new, too: it must not stay behind.
            new = signature(self.canvas, "Closeness", [[1]], [100.0], [[5.0, 5.0, 5.0]])
            self.refused(solver, text, ConstraintSigs=tree(new + signatures + self.good), **given)
            results = [c.run(ConstraintSigs=tree(self.good), **given) for c in (twin, solver)]
            self.canvas.document._scheduled = []
            self.assertEqual(solver.errors(), [])
            self.assertEqual([r["Iterations"] for r in results], [20, 20])
            self.assertEqual(*[flat(plain(r["Points"])[0][1]) for r in results])

    def test_a_running_published_solver_refuses_other_counts_and_goes_on(self):
        targets = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
        good = signature(self.canvas, "Closeness", [[0], [2]], [1.0], targets)
        solver = self.canvas.add("ShapeOpConstraintSolver")
        solver.run(ConstraintSigs=good, Points=points(CORNERS), Settings=self.reset)
        fewer = signature(self.canvas, "Closeness", [[0]], [1.0], targets[:1])
        self.refused(
            solver, "2 lists of scalars expected", ConstraintSigs=fewer, Points=points(CORNERS), Settings=self.run
        )
        self.refused(solver, "Points: 4 expected", ConstraintSigs=good, Points=points(CORNERS[:9]), Settings=self.run)
        self.assertEqual(solver.run(ConstraintSigs=good, Points=points(CORNERS), Settings=self.run)["Iterations"], 5)
        self.assertEqual(solver.errors(), [])

    def test_wrong_points(self):
        for text, wrong in (
            ("Points: item 1", points(CORNERS[:3]) + [None]),
            ("Points: item 0", ["origin"]),
            ("points[1]", points([0, 0, 0, NAN, 0, 0, 1, 1, 1, 2, 2, 2])),
        ):
            old = self.canvas.add("ShapeOpConstraintSolver")
            self.refused(old, text, ConstraintSigs=self.good, Points=wrong, Settings=self.static)
            for name in ("ShapeOpLiveSolver", "ShapeOpOneShotSolver"):
                self.refused(self.canvas.add(name), text, ConstraintSigs=tree(self.good), Points=tree(wrong))

    def test_wrong_settings(self):
        def changed(**values):
            return dict(self.run, **values)

        for text, settings in (
            ("Settings", 5),
            ("Settings", {"mode": "fast"}),
            ("Iterations", changed(iterations=-1)),
            ("Iterations", changed(iterations="many")),
            ("masses", changed(mass=0.0)),
            ("Mass", changed(mass="heavy")),
            ("damping", changed(damping=-1.0)),
            ("time", changed(timeStep=NAN)),
            ("UnaryVector", changed(unaryVector=5)),
        ):
            old = self.canvas.add("ShapeOpConstraintSolver")
            self.refused(old, text, ConstraintSigs=self.good, Points=points(CORNERS), Settings=settings)
            new = self.canvas.add("ShapeOpLiveSolver")
            text = "Force" if text == "UnaryVector" else text
            given = dict(ConstraintSigs=tree(self.good), Points=tree(points(CORNERS)))
            self.refused(new, text, Settings=settings, **given)

    def test_wrong_forces_tolerances_and_limits(self):
        given = dict(ConstraintSigs=tree(self.good), Points=tree(points(CORNERS)))
        force = self.canvas.add("ShapeOpForce").run
        far, nan = force(Force=Vector3d(1, 0, 0), PointIndices=tree([44])), force(Force=Vector3d(NAN, 0, 0))
        for text, wrong in (
            ("Forces: index 44 is out of range for 4 points", {"Forces": far["Forces"]}),
            ("finite", {"Forces": nan["Forces"]}),
            ("Forces: item 0", {"Forces": ["up"]}),
            ("Tolerance", {"Tolerance": -1.0}),
        ):
            for name in ("ShapeOpLiveSolver", "ShapeOpOneShotSolver"):
                self.refused(self.canvas.add(name), text, **dict(given, **wrong))
        for text, wrong in (("MaxIterations", {"MaxIterations": -1}), ("tolerance", {"Precision": -1.0})):
            self.refused(self.canvas.add("ShapeOpOneShotSolver"), text, **dict(given, **wrong))

    def test_a_force_that_nothing_resists_is_an_error_and_not_a_flight(self):
        alone = signature(self.canvas, "Plane", [[0, 1, 2, 3]])
        gravity = self.canvas.add("ShapeOpForce").run(Force=Vector3d(0, 0, -1))["Forces"]
        for name in ("ShapeOpLiveSolver", "ShapeOpOneShotSolver"):
            given = dict(ConstraintSigs=tree(alone), Points=tree(points(CORNERS)), Forces=gravity)
            self.refused(self.canvas.add(name), "force", **given)


if __name__ == "__main__":
    unittest.main()
