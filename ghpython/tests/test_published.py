"""ConstraintSolver: what the published client calls, in its order."""

import unittest

from support import IS_JYTHON, NEEDS_CTYPES, Calls, Canvas, Direct, doubles, flat, points, signature
from Rhino.Geometry import Vector3d

CORNERS = [0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1]
TARGETS = [[0.0, 0.0, 0.3], [1.3, 0.0, 0.2]]


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Published(unittest.TestCase):
    def setUp(self):
        self.canvas = Canvas()
        self.solver = self.canvas.add("ShapeOpConstraintSolver")

    def tearDown(self):
        self.canvas.close()

    def signatures(self, targets):
        made = signature(self.canvas, "Plane", [[0, 1, 2, 3]], [1.0])
        made += signature(self.canvas, "EdgeStrain", [[0, 1], [1, 2], [2, 3]], [2.0], [[1.0, 0.9, 1.1]])
        return made + signature(self.canvas, "Closeness", [[0], [1]], [5.0, 7.0], targets)

    def settings(self, **given):
        return self.canvas.add("ShapeOpSettingsLive").run(**given)["Settings"][0]

    def run_live(self, targets, **settings):
        made = self.solver.run(
            ConstraintSigs=self.signatures(targets), Points=points(CORNERS), Settings=self.settings(**settings)
        )
        self.assertEqual(self.solver.errors(), [])
        return made

    def direct(self, dynamic):
        """The published client's reset, called through C."""
        direct = Direct(CORNERS)
        direct.add("Plane", [0, 1, 2, 3], 1.0)
        for edge in ([0, 1], [1, 2], [2, 3]):
            direct.edit("EdgeStrain", direct.add("EdgeStrain", edge, 2.0), [1.0, 0.9, 1.1])
        for point, weight in ((0, 5.0), (1, 7.0)):
            direct.edit("Closeness", direct.add("Closeness", [point], weight), TARGETS[point])
        direct.library.shapeop_addGravityForce(direct.op, doubles([0.0, 0.1, -0.5]))
        if dynamic:
            self.assertEqual(direct.library.shapeop_initDynamic(direct.op, 2.0, 0.9, 0.05), 0)
        else:
            self.assertEqual(direct.library.shapeop_init(direct.op), 0)
        return direct

    def direct_tick(self, direct, targets):
        for edge in (1, 2, 3):
            direct.edit("EdgeStrain", edge, [1.0, 0.9, 1.1])
        for place in (0, 1):
            direct.edit("Closeness", 4 + place, targets[place])
        self.assertEqual(direct.library.shapeop_solve(direct.op, 7), 0)
        return direct.points()

    def test_reset_a_moved_target_pause_and_a_second_reset_are_the_same_calls_through_c(self):
        moved = [TARGETS[0], [1.5, -0.2, 0.6]]
        for dynamic in (True, False):
            given = dict(Iterations=7, Mass=2.0, Damping=0.9, TimeStep=0.05, Dynamic=dynamic)
            given["UnaryVector"] = Vector3d(0, 0.1, -0.5)
            direct = self.direct(dynamic)
            made = self.run_live(TARGETS, Reset=True, **given)
            self.assertEqual((flat(made["Points"]), made["Iterations"], made["ConstraintCount"]), (CORNERS, 0, 6))
            for count, (targets, paused) in enumerate(
                [(TARGETS, False), (moved, False), (moved, True), (moved, False)]
            ):
                made = self.run_live(targets, Reset=False, Pause=paused, **given)
                # A paused tick solves once too.
                self.assertEqual(flat(made["Points"]), self.direct_tick(direct, targets))
                self.assertEqual((made["Iterations"], made["ConstraintCount"]), (7 * (count + 1), 6))
            direct.delete()
            second = self.direct(dynamic)
            made = self.run_live(TARGETS, Reset=True, **given)
            self.assertEqual((flat(made["Points"]), made["Iterations"]), (CORNERS, 0))
            made = self.run_live(TARGETS, Reset=False, **given)
            self.assertEqual(flat(made["Points"]), self.direct_tick(second, TARGETS))
            second.delete()

    def test_static_settings_solve_all_iterations_in_one_call_and_free_the_solver(self):
        direct = Direct(CORNERS)
        direct.add("Plane", [0, 1, 2, 3], 1.0)
        direct.edit("Closeness", direct.add("Closeness", [0], 0.5), [0.0, 0.0, 0.2])
        direct.library.shapeop_init(direct.op)
        direct.library.shapeop_solve(direct.op, 25)
        made = signature(self.canvas, "Plane", [[0, 1, 2, 3]])
        made += signature(self.canvas, "Closeness", [[0]], [0.5], [[0.0, 0.0, 0.2]])
        settings = self.canvas.add("ShapeOpSettingsStatic").run(Iterations=25)["Settings"][0]
        with Calls() as calls:
            result = self.solver.run(ConstraintSigs=made, Points=points(CORNERS), Settings=settings)
            self.assertEqual((calls["shapeop_create"], calls["shapeop_delete"]), (1, 1))
        self.assertEqual(flat(result["Points"]), direct.points())
        self.assertEqual((result["Iterations"], result["ConstraintCount"]), (25, 2))
        self.assertEqual(self.canvas.document._scheduled, [])
        direct.delete()

    def test_running_schedules_the_next_tick_and_pausing_or_resetting_does_not(self):
        for reset, pause, message in ((True, False, None), (False, True, "Solver is Paused")):
            self.run_live(TARGETS, Reset=reset, Pause=pause)
            self.assertEqual(self.canvas.document._scheduled, [])
            self.assertEqual(self.solver.component.Message, message)
        first = self.run_live(TARGETS, Reset=False)
        self.assertEqual(self.solver.component.Message, "Solver is Running Live")
        given = dict(
            ConstraintSigs=self.signatures(TARGETS), Points=points(CORNERS), Settings=self.settings(Reset=False)
        )
        second = self.solver.run_scheduled(**given)
        self.assertEqual(second["Iterations"], first["Iterations"] + 5)

    def test_a_tick_without_changes_sends_nothing_but_solve_and_read(self):
        with Calls() as calls:
            self.run_live(TARGETS, Reset=True)
            calls.clear()
            self.run_live(TARGETS, Reset=False)
            self.assertEqual(calls.without("shapeop_lastError"), {"shapeop_solve": 1, "shapeop_getPoints": 1})
            calls.clear()
            self.run_live([TARGETS[0], [1, 1, 1]], Reset=False)
            expected = {"shapeop_editConstraints": 1, "shapeop_solve": 1, "shapeop_getPoints": 1}
            self.assertEqual(calls.without("shapeop_lastError"), expected)

    def test_a_definition_opened_without_reset_runs(self):
        made = self.run_live(TARGETS, Reset=False)
        self.assertEqual(made["Iterations"], 5)

    def test_without_inputs_the_points_pass_through(self):
        given = points(CORNERS)
        made = self.solver.run(Points=given)
        self.assertEqual(made, {"Iterations": None, "ConstraintCount": None, "Points": given})
        self.assertEqual(self.solver.errors(), [])

    def test_the_published_name_of_the_angle_type_solves(self):
        made = signature(self.canvas, "AngleConstraint", [[0, 1, 3]], [1.0], [[0.5, 0.6]])
        settings = self.canvas.add("ShapeOpSettingsStatic").run()["Settings"][0]
        result = self.solver.run(ConstraintSigs=made, Points=points(CORNERS), Settings=settings)
        self.assertEqual(self.solver.errors(), [])
        self.assertNotEqual(flat(result["Points"]), CORNERS)


if __name__ == "__main__":
    unittest.main()
