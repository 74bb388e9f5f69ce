"""LiveSolver, OneShotSolver, Handles."""

import unittest

from support import IS_JYTHON, NEEDS_CTYPES, Calls, Canvas, Direct, flat, grid, plain, points, signature, tree
from Rhino.Geometry import LineCurve, Point3d, Vector3d


def bumpy(i, j):
    return 0.2 * ((i * 7 + j * 3) % 5)


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Case(unittest.TestCase):
    def setUp(self):
        self.canvas = Canvas()
        mesh = grid(5, 4, bumpy)
        self.given = flat(mesh.Vertices.ToPoint3dArray())
        run = self.canvas.add("ShapeOpMeshIndexer").run
        self.faces = run(Pattern="faceVertices", Mesh=mesh)["PointIndices"].Branches
        self.each = run(Pattern="verticesEach", Mesh=mesh)["PointIndices"].Branches

    def tearDown(self):
        self.canvas.close()

    def planes(self, weight=1.0):
        return signature(self.canvas, "Plane", self.faces, [weight])

    def held(self, weight=0.1):
        return signature(self.canvas, "Closeness", self.each, [weight])


class Running(Case):
    def setUp(self):
        Case.setUp(self)
        self.solver = self.canvas.add("ShapeOpLiveSolver")

    def tick(self, signatures, **given):
        given.setdefault("Points", tree(points(self.given)))
        result = self.solver.run(ConstraintSigs=tree(signatures), **given)
        self.assertEqual(self.solver.errors(), [])
        return result

    def settle(self, signatures, **given):
        """Ticks until it schedules no further one."""
        result = self.tick(signatures, **given)
        for _ in range(200):
            if not self.canvas.document._scheduled:
                return result
            given.setdefault("Points", tree(points(self.given)))
            result = self.solver.run_scheduled(ConstraintSigs=tree(signatures), **given)
        self.fail("it does not stop")

    def where(self, result):
        return flat([p for _, branch in plain(result["Points"]) for p in branch])


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Live(Running):
    def test_it_stops_by_itself_where_the_energy_is_that_of_a_long_plain_solve(self):
        made = self.planes() + self.held()
        self.assertEqual(self.tick(made, Reset=True)["Iterations"], 0)
        self.assertEqual(self.canvas.document._scheduled, [])
        result = self.settle(made)
        self.assertTrue(result["Stopped"])
        self.assertEqual(self.solver.component.Message, "Stopped")
        # The mean move of the last tick is below a ten-millionth of the diagonal of the given points.
        self.assertTrue(result["Move"] < 1e-7 * (4**2 + 3**2 + 0.8**2) ** 0.5)
        direct = Direct(self.given)
        for face in self.faces:
            direct.add("Plane", face, 1.0)
        for (vertex,) in self.each:
            direct.add("Closeness", [vertex], 0.1)
        direct.library.shapeop_init(direct.op)
        direct.library.shapeop_solve(direct.op, 20000)
        far = max(abs(a - b) for a, b in zip(direct.points(), self.where(result)))
        direct.delete()
        self.assertTrue(far < 1e-4, far)

    def test_a_higher_threshold_stops_earlier(self):
        made = self.planes() + self.held()
        early = self.settle(made, Threshold=1e-3)["Iterations"]
        self.tick(made, Reset=True)
        late = self.settle(made, Threshold=1e-9)["Iterations"]
        self.assertTrue(early < late, (early, late))

    def test_points_keep_the_tree_of_the_inputs_and_violations_that_of_the_signatures(self):
        from Grasshopper import DataTree
        from Grasshopper.Kernel.Data import GH_Path

        given, sent = DataTree[object](), DataTree[object]()
        all_points = points(self.given)
        for n, point in enumerate(all_points):
            given.Add(point, GH_Path(3, n // 7))
        for path, made in (
            (GH_Path(0, 5), self.planes()),
            (GH_Path(2, 1), self.planes()),
            (GH_Path(2, 1), self.held()),
        ):
            sent.Add(made[0], path)
        result = self.solver.run(ConstraintSigs=sent, Points=given, Reset=True)
        self.assertEqual(
            [(path, len(branch)) for path, branch in plain(result["Points"])], [([3, 0], 7), ([3, 1], 7), ([3, 2], 6)]
        )
        self.assertEqual(self.where(result), self.given)
        violations = plain(result["Violations"])
        self.assertEqual(
            [(path, len(b)) for path, b in violations], [([0, 5, 0], 12), ([2, 1, 0], 12), ([2, 1, 1], 20)]
        )
        # Held points are where they are held; hardly a face is planar.
        self.assertEqual(violations[2][1], [0.0] * 20)
        self.assertEqual(violations[0][1], violations[1][1])
        self.assertTrue(max(violations[0][1]) > 0.1)

    def test_a_violation_is_that_of_its_own_branch(self):
        # Edges of length 1 that should be 1, 2 and 5 long: off by 0, 1 and 4 where they are.
        edges = [[0, 1], [1, 2], [2, 3]]
        line = [0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0]
        made = signature(self.canvas, "EdgeStrain", edges, [1.0], [[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [5.0, 1.0, 1.0]])
        result = self.tick(made, Points=tree(points(line)), Reset=True)
        self.assertEqual([round(v, 12) for v in plain(result["Violations"])[0][1]], [0.0, 1.0, 4.0])

    def test_weights_and_targets_change_while_it_runs_without_a_reset(self):
        made = self.planes() + self.held()
        self.settle(made)
        target = [1.0, 1.0, 3.0]
        handle = signature(self.canvas, "Closeness", [[6]], [1000.0], [target])
        pulled = self.settle(made + handle)
        far = max(abs(a - b) for a, b in zip(self.where(pulled)[18:21], target))
        self.assertTrue(far < 0.01, far)
        self.assertTrue(pulled["Iterations"] > 20)
        target[2] = 0.0
        moved = self.settle(made + signature(self.canvas, "Closeness", [[6]], [1000.0], [target]))
        self.assertTrue(abs(self.where(moved)[20]) < 0.01)
        let_go = self.settle(made + signature(self.canvas, "Closeness", [[6]], [0.0], [target]))
        self.assertTrue(abs(self.where(let_go)[20]) > 0.01)

    def test_what_is_added_and_removed_again_leaves_the_solution_as_it_was(self):
        made = self.planes() + self.held()
        first = self.where(self.settle(made, Threshold=1e-10))
        handle = signature(self.canvas, "Closeness", [[6]], [1000.0], [[1.0, 1.0, 1.0]])
        self.assertNotEqual(self.where(self.settle(made + handle, Threshold=1e-10)), first)
        last = self.where(self.settle(made, Threshold=1e-10))
        far = max(abs(a - b) for a, b in zip(first, last))
        self.assertTrue(far < 1e-6, far)

    def test_a_constraint_that_stays_keeps_its_rest_state_when_others_come_and_go(self):
        # The edge is at rest at length 1. If it were added again after the stretch, it would be at rest there.
        line, edge = [0, 0, 0, 1, 0, 0], signature(self.canvas, "EdgeStrain", [[0, 1]], [1.0])
        ends = lambda x: signature(self.canvas, "Closeness", [[0], [1]], [1e6], [[0, 0, 0], [x, 0, 0]])  # noqa: E731
        given = dict(Points=tree(points(line)))
        self.settle(edge + ends(3.0), **given)
        stretched = self.settle(ends(3.0) + edge, **given)
        self.assertAlmostEqual(plain(stretched["Violations"])[1][1][0], 2.0, 4)
        free = self.where(self.settle(edge, **given))
        self.assertAlmostEqual(free[3] - free[0], 1.0, 5)

    def test_scalars_that_are_taken_away_make_the_default(self):
        line = [0, 0, 0, 1, 0, 0]
        given = dict(Points=tree(points(line)))
        longer = signature(self.canvas, "EdgeStrain", [[0, 1]], [1.0], [[2.0, 1.0, 1.0]])
        x = self.where(self.settle(longer, **given))
        self.assertAlmostEqual(x[3] - x[0], 2.0, 6)
        plain_edge = signature(self.canvas, "EdgeStrain", [[0, 1]], [1.0])
        result = self.tick(plain_edge, **given)
        self.assertAlmostEqual(plain(result["Violations"])[0][1][0], 0.0, 6)

    def test_a_tick_without_changes_sends_nothing(self):
        made, force = (
            self.planes() + self.held(),
            self.canvas.add("ShapeOpForce").run(Force=Vector3d(0, 0, -0.1))["Forces"],
        )
        given = dict(Points=tree(points(self.given)), Forces=force, Threshold=0.0)
        expected = dict.fromkeys(["shapeop_solve", "shapeop_getPoints", "shapeop_energy"], 1)
        expected.update(dict.fromkeys(["shapeop_constraintCount", "shapeop_getViolations"], 1))
        with Calls() as calls:
            self.tick(made, Reset=True, **given)
            self.assertEqual(calls["shapeop_setPoints"], 1)
            calls.clear()
            self.tick(made, **given)
            self.assertEqual(calls.without("shapeop_lastError"), expected)
            calls.clear()
            self.tick(self.planes(2.0) + self.held(), **given)
            self.assertEqual(calls.without("shapeop_lastError"), dict(expected, shapeop_setWeights=1))
            calls.clear()
            handle = signature(self.canvas, "Closeness", [[6]], [9.0])
            self.tick(self.planes(2.0) + self.held() + handle, **given)
            self.assertEqual(calls.without("shapeop_lastError"), dict(expected, shapeop_addConstraints=1))
            calls.clear()
            self.tick(self.planes(2.0) + self.held(), **given)
            self.assertEqual(calls.without("shapeop_lastError"), dict(expected, shapeop_removeConstraint=1))
            calls.clear()
            self.tick(self.planes(2.0) + self.held(), **dict(given, Forces=[]))
            self.assertEqual(calls.without("shapeop_lastError"), dict(expected, shapeop_removeForce=1))

    def test_off_pauses_and_on_goes_on_from_there(self):
        made = self.planes() + self.held()
        running = self.tick(made, Threshold=0.0)
        self.canvas.document._scheduled = []
        paused = self.tick(made, On=False)
        self.assertEqual(self.canvas.document._scheduled, [])
        self.assertEqual((self.where(paused), paused["Iterations"]), (self.where(running), 10))
        self.assertEqual(self.solver.component.Message, "Paused")
        self.assertEqual(self.tick(made)["Iterations"], 20)

    def test_reset_gives_the_points_back(self):
        made = self.planes() + self.held()
        self.settle(made)
        self.assertEqual(self.where(self.tick(made, Reset=True)), self.given)

    def test_another_number_of_points_starts_again(self):
        made = signature(self.canvas, "Plane", [[0, 1, 2, 3]]) + signature(self.canvas, "Closeness", [[0]])
        self.tick(made)
        fewer = self.tick(made, Points=tree(points(self.given[:30])))
        self.assertEqual((fewer["Iterations"], len(self.where(fewer))), (10, 30))

    def test_points_within_the_tolerance_move_as_one(self):
        # Two unwelded triangles: the shared corners are 1 and 3, 2 and 5. Only the first triangle's corner is pulled.
        loose = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1e-4]
        made = signature(self.canvas, "Closeness", [[i] for i in range(6)], [1.0])
        made += signature(self.canvas, "Closeness", [[1]], [1000.0], [[2.0, 0.0, 0.0]])
        x = self.where(self.settle(made, Points=tree(points(loose)), Tolerance=1e-3))
        self.assertTrue(x[3] > 1.9)
        self.assertEqual((x[3:6], x[6:9]), (x[9:12], x[15:18]))
        x = self.where(self.settle(made, Points=tree(points(loose))))
        self.assertEqual(x[9:12], [1.0, 0.0, 0.0])

    def test_forces_on_all_and_on_some_points_bend_what_is_held(self):
        # Held at x by weight w against a force f: the point settles at x + f / w.
        line = [0, 0, 0, 1, 0, 0, 2, 0, 0]
        made = signature(self.canvas, "Closeness", [[0], [1], [2]], [4.0])
        force = self.canvas.add("ShapeOpForce").run
        every, one = (
            force(Force=Vector3d(0, 0, -1.0))["Forces"],
            force(Force=Vector3d(0, 2.0, 0), PointIndices=tree([1]))["Forces"],
        )
        given = dict(Points=tree(points(line)), Threshold=1e-12)
        x = self.where(self.settle(made, Forces=every + one, **given))
        for found, expected in zip(x, [0, 0, -0.25, 1, 0.5, -0.25, 2, 0, -0.25]):
            self.assertAlmostEqual(found, expected, 9)
        x = self.where(self.settle(made, Forces=one + every, **given))
        self.assertAlmostEqual(x[4], 0.5, 9)
        x = self.where(self.settle(made, **given))
        for found, expected in zip(x, line):
            self.assertAlmostEqual(found, expected, 9)

    def test_settings_of_the_published_client_make_it_dynamic(self):
        # One step of a free fall: v = g t, x = g t^2, with the weight of a held point too small to matter.
        live = self.canvas.add("ShapeOpSettingsLive").run(UnaryVector=Vector3d(0, 0, -9.81), Reset=False)["Settings"][0]
        made = signature(self.canvas, "Closeness", [[0]], [1e-12])
        x = self.where(self.tick(made, Points=tree(points([0, 0, 0])), Settings=live))
        self.assertAlmostEqual(x[2], -9.81 * 0.1**2, 9)

    def test_move_is_the_mean_over_the_points_per_iteration_or_per_time_step(self):
        # One of two points jumps 3 to its target at once, and stays there for the other 3 iterations.
        live = self.canvas.add("ShapeOpSettingsLive").run
        made = signature(self.canvas, "Closeness", [[0], [1]], [1.0], [[0.0, 0.0, 3.0], [1.0, 0.0, 0.0]])
        given = dict(Points=tree(points([0, 0, 0, 1, 0, 0])))
        result = self.tick(made, Settings=live(Iterations=4, Dynamic=False, Reset=False)["Settings"][0], **given)
        self.assertAlmostEqual(result["Move"], 3.0 / 2 / 4, 12)
        # A step of a free fall: g t^2.
        fall = live(Iterations=4, UnaryVector=Vector3d(0, 0, -9.81), Reset=False)["Settings"][0]
        loose = signature(self.canvas, "Closeness", [[0], [1]], [1e-12])
        result = self.tick(loose, Settings=fall, Points=tree(points([0, 0, 0, 1, 0, 0])), Accelerate=False)
        self.assertAlmostEqual(result["Move"], 9.81 * 0.1**2, 9)

    def test_handles_drag_points_while_it_runs(self):
        component = self.canvas.add("ShapeOpHandles")
        made, all_points = self.planes() + self.held(0.01), points(self.given)
        grabbed = component.run(Points=all_points, Handles=[Point3d(2.1, 1.1, 0.5)])
        self.assertEqual(plain(grabbed["PointIndices"]), [([0], [7])])
        self.tick(made + grabbed["ConstraintSigs"])
        # It is dragged near other points, and still holds its own.
        dragged = component.run(Points=all_points, Handles=[Point3d(0.0, 3.0, 2.0)])
        self.assertEqual(plain(dragged["PointIndices"]), [([0], [7])])
        with Calls() as calls:
            x = self.where(self.settle(made + dragged["ConstraintSigs"]))
            self.assertEqual(calls["shapeop_create"], 0)
        self.assertTrue(max(abs(a - b) for a, b in zip(x[21:24], [0.0, 3.0, 2.0])) < 0.01)
        again = component.run(Points=all_points, Handles=[Point3d(0.0, 3.0, 2.0)], Reset=True)
        self.assertEqual(plain(again["PointIndices"]), [([0], [15])])
        curve = component.run(
            Points=all_points, Handles=[LineCurve(Point3d(4, 0, 0), Point3d(4, 0, 9))], Strength=[5.0], Reset=True
        )
        (made,) = curve["ConstraintSigs"]
        self.assertEqual((made["pointIndices"], made["scalars"], made["weights"]), ([[4]], [[4, 0, 9]], [5.0]))


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Hard(Running):
    def hard_planes(self, weight=1.0):
        return signature(self.canvas, "Plane", self.faces, [weight], Hard=True)

    def branch(self, made, place):
        return dict((path[-1], items) for path, items in plain(made)).get(place, [])

    def test_hard_planes_are_planes_to_round_off_and_soft_ones_are_not(self):
        result = self.settle(self.hard_planes() + self.held())
        self.assertTrue(result["Stopped"])
        self.assertEqual(self.solver.component.Message, "Stopped")
        self.assertTrue(max(self.branch(result["Violations"], 0)) < 1e-9)
        self.assertEqual(plain(result["Conflicts"]), [])
        soft = self.settle(self.planes() + self.held())
        self.assertTrue(max(self.branch(soft["Violations"], 0)) > 1e-4)

    def test_with_nothing_else_a_hard_plane_is_the_best_fit_plane(self):
        saddle = [0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1]
        made = signature(self.canvas, "Plane", [[0, 1, 2, 3]], Hard=True)
        x = self.where(self.settle(made, Points=tree(points(saddle))))
        for found, expected in zip(x, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]):
            self.assertAlmostEqual(found, expected, 10)

    def test_a_handle_takes_a_hard_edge_along_as_its_strength_says(self):
        # Both points move by t along x: s (t - 1)^2 + 0.1 t^2, 0.1 being the library's closeness: t = s / (s + 0.1).
        line, component = points([0, 0, 0, 1, 0, 0]), self.canvas.add("ShapeOpHandles")
        edge = signature(self.canvas, "EdgeLength", [[0, 1]], [1.0], [[1.0, 1.0]], Hard=True)
        given = dict(Points=tree(line))
        with Calls() as calls:
            for x, strength in ((1.0, 0.3), (2.0, 0.3), (3.0, 0.3), (3.0, 0.9)):
                handles = component.run(Points=line, Handles=[Point3d(x, 0, 0)], Strength=[strength])["ConstraintSigs"]
                self.assertEqual(handles[0]["pointIndices"], [[1]])
                result = self.settle(edge + handles, **given)
                t = (x - 1) * strength / (strength + 0.1)
                self.assertAlmostEqual(self.where(result)[0], t, 8)
                # The violation of a handle is its distance from the target.
                self.assertAlmostEqual(self.branch(result["Violations"], 1)[0], x - 1 - t, 8)
            sent = ("create", "addConstraints", "editConstraints", "setHard", "setHandle", "setObjective")
            self.assertEqual([calls["shapeop_" + name] for name in sent], [1, 1, 1, 1, 3, 2])
            # Let go, it goes back.
            self.assertAlmostEqual(self.where(self.settle(edge, **given))[0], 0.0, 8)
            self.assertEqual(calls["shapeop_releaseHandle"], 1)

    def test_handles_of_unlike_strengths_stay_soft_constraints_of_their_own(self):
        line, component = points([0, 0, 0, 1, 0, 0]), self.canvas.add("ShapeOpHandles")
        edge = signature(self.canvas, "EdgeLength", [[0, 1]], [1.0], [[1.0, 1.0]], Hard=True)
        ends = [LineCurve(Point3d(0, 0, 0), Point3d(-0.5, 0, 0)), LineCurve(Point3d(1, 0, 0), Point3d(1, 0, 0))]
        handles = component.run(Points=line, Handles=ends, Strength=[3.0, 1.0])["ConstraintSigs"]
        with Calls() as calls:
            result = self.settle(edge + handles, Points=tree(line))
            self.assertEqual((calls["shapeop_setHandle"], calls["shapeop_addConstraints"]), (0, 2))
        # 3 (t + 0.5)^2 + t^2 and the library's closeness of both points: t (3 + 1 + 0.2) = -1.5.
        self.assertAlmostEqual(self.where(result)[0], -1.5 / 4.2, 6)

    def test_hard_constraints_come_and_go_with_a_fresh_start_and_change_on_the_way(self):
        some = [signature(self.canvas, "Closeness", self.each[:5], [weight]) for weight in (0.1, 5.0)]
        made = self.hard_planes() + some[0]
        first = self.where(self.settle(made))
        with Calls() as calls:
            # Another weight of what is soft, then the first again: the same solution, without a new solver.
            other = self.where(self.settle(self.hard_planes() + some[1]))
            again = self.where(self.settle(made))
            self.assertEqual(calls["shapeop_create"], 0)
        self.assertTrue(max(abs(a - b) for a, b in zip(first, other)) > 1e-3)
        self.assertTrue(max(abs(a - b) for a, b in zip(first, again)) < 1e-6)
        with Calls() as calls:
            soft = self.where(self.settle(self.planes() + self.held(), Threshold=1e-10))
            self.assertEqual((calls["shapeop_create"], calls["shapeop_setHard"]), (1, 0))
        fresh = self.canvas.add("ShapeOpLiveSolver")
        self.solver = fresh
        x = self.where(self.settle(self.planes() + self.held(), Threshold=1e-10))
        self.assertTrue(max(abs(a - b) for a, b in zip(soft, x)) < 1e-9)

    def test_one_of_two_hard_signatures_becomes_soft_and_hard_again_while_it_runs(self):
        half = len(self.faces) // 2
        first = signature(self.canvas, "Plane", self.faces[:half], Hard=True)
        second = [signature(self.canvas, "Plane", self.faces[half:], Hard=hard) for hard in (True, False)]
        with Calls() as calls:
            both = self.settle(first + second[0] + self.held())
            self.assertEqual(calls["shapeop_setHard"], len(self.faces))
            calls.clear()
            one = self.settle(first + second[1] + self.held())
            self.assertEqual((calls["shapeop_setHard"], calls["shapeop_create"]), (len(self.faces) - half, 0))
        self.assertTrue(max(self.branch(one["Violations"], 0)) < 1e-9 < 1e-4 < max(self.branch(one["Violations"], 1)))
        again = self.settle(first + second[0] + self.held())
        far = max(abs(a - b) for a, b in zip(self.where(both), self.where(again)))
        self.assertTrue(far < 1e-6, far)

    def test_a_contradiction_is_named_where_it_is(self):
        square = points([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])
        edges = [[0, 1], [1, 2], [2, 3], [3, 0]]
        made = signature(self.canvas, "EdgeLength", edges, [2.0], [[1.0, 1.0]], Hard=True)
        made += signature(self.canvas, "LaplacianDisplacement", [[0, 1, 3], [1, 0, 2], [2, 1, 3], [3, 2, 0]])
        planted = [[1, 2], [0, 1]]
        made += signature(self.canvas, "EdgeLength", planted, [1.0], [[1.0, 1.0], [3.0, 3.0]], Hard=True)
        result = self.settle(made, Points=tree(square))
        self.assertEqual(plain(result["Conflicts"]), [([0, 2], [1])])
        self.assertEqual(self.solver.component.Message, "In conflict")
        self.assertTrue(result["Stopped"])
        solver = self.canvas.add("ShapeOpOneShotSolver")
        once = solver.run(ConstraintSigs=tree(made), Points=tree(square))
        self.assertEqual(solver.errors(), [])
        self.assertEqual((once["Outcome"], plain(once["Conflicts"])), ("infeasible", [([0, 2], [1])]))

    def test_points_that_are_merged_are_dragged_as_one(self):
        loose = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1e-4]
        made = signature(self.canvas, "Plane", [[0, 1, 2], [3, 4, 5]], Hard=True)
        handles = self.canvas.add("ShapeOpHandles").run
        ends = [LineCurve(Point3d(1, 0, 0), Point3d(2, 0, 0))]
        grabbed = handles(Points=points(loose), Handles=ends)["ConstraintSigs"]
        x = self.where(self.settle(made + grabbed, Points=tree(points(loose)), Tolerance=1e-3))
        self.assertTrue(x[3] > 1.9)
        self.assertEqual((x[3:6], x[6:9]), (x[9:12], x[15:18]))

    def test_hard_constraints_in_dynamics_are_an_error_that_names_the_setting(self):
        live = self.canvas.add("ShapeOpSettingsLive").run
        given = dict(ConstraintSigs=tree(self.hard_planes()), Points=tree(points(self.given)))
        made = self.solver.run(Settings=live(Reset=False)["Settings"][0], **given)
        self.assertEqual(set(made.values()), {None})
        self.assertIn("Dynamic must be False", self.solver.errors()[0])
        made = self.solver.run(Settings=live(Dynamic=False, Reset=False)["Settings"][0], **given)
        self.assertEqual(self.solver.errors(), [])
        self.assertTrue(max(self.branch(made["Violations"], 0)) < 1e-9)

    def test_what_cannot_be_hard_is_an_error_on_its_item(self):
        line = dict(Points=tree(points([0, 0, 0, 1, 0, 0])))
        for kind, indices in (("EdgeStrain", [[0, 0]]),):
            made = signature(self.canvas, kind, indices, Hard=True)
            self.solver.run(ConstraintSigs=tree(made), **line)
            self.assertIn('ConstraintSigs: item 0 ("%s")' % kind, self.solver.errors()[0])

    def test_the_published_solver_takes_them_too(self):
        settings = self.canvas.add("ShapeOpSettingsStatic").run(Iterations=300)["Settings"][0]
        solver = self.canvas.add("ShapeOpConstraintSolver")
        saddle = [0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1]
        made = signature(self.canvas, "Plane", [[0, 1, 2, 3]], Hard=True)
        x = flat(solver.run(ConstraintSigs=made, Points=points(saddle), Settings=settings)["Points"])
        self.assertEqual(solver.errors(), [])
        for found, expected in zip(x, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]):
            self.assertAlmostEqual(found, expected, 6)


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class OneShot(Case):
    def run_once(self, **given):
        solver = self.canvas.add("ShapeOpOneShotSolver")
        made = self.planes() + self.held()
        result = solver.run(ConstraintSigs=tree(made), Points=tree(points(self.given)), **given)
        self.assertEqual(solver.errors(), [])
        self.assertEqual(self.canvas.document._scheduled, [])
        return result

    def test_one_call_solves_to_the_end_and_keeps_nothing(self):
        with Calls() as calls:
            result = self.run_once()
            self.assertEqual((calls["shapeop_create"], calls["shapeop_delete"]), (1, 1))
        self.assertEqual(result["Outcome"], "converged")
        again = self.run_once()
        self.assertEqual(flat(plain(again["Points"])[0][1]), flat(plain(result["Points"])[0][1]))
        # At the minimum the energy is not lowered by further plain iterations from there.
        settings = self.canvas.add("ShapeOpSettingsStatic").run(Iterations=1)["Settings"][0]
        solver = self.canvas.add("ShapeOpConstraintSolver")
        solved = plain(result["Points"])[0][1]
        held = signature(self.canvas, "Closeness", self.each, [0.1], [[p] for p in points(self.given)])
        moved = solver.run(ConstraintSigs=self.planes() + held, Points=solved, Settings=settings)["Points"]
        far = max(abs(a - b) for a, b in zip(flat(moved), flat(solved)))
        self.assertTrue(far < 1e-4, far)

    def test_limits_end_it_and_say_so(self):
        result = self.run_once(MaxIterations=3)
        self.assertEqual((result["Iterations"], result["Outcome"]), (3, "iteration limit"))
        self.assertTrue(self.run_once(Precision=1e-2)["Iterations"] < self.run_once(Precision=1e-8)["Iterations"])
        self.assertEqual(self.run_once(Seconds=1e-9, Precision=0.0)["Outcome"], "time budget")

    def test_energy_falls_and_violations_are_in_the_tree_of_the_signatures(self):
        result = self.run_once()
        self.assertTrue(result["Energy"] > 0.0)
        self.assertTrue(result["Energy"] < self.run_once(MaxIterations=1)["Energy"])
        self.assertEqual([(path, len(b)) for path, b in plain(result["Violations"])], [([0, 0], 12), ([0, 1], 20)])


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Seeing(Case):
    def test_planarity_of_a_quad_is_the_distance_of_its_diagonals_over_their_mean_length(self):
        # Unit square, one corner lifted by h: both diagonals pass the middle; the first ends h higher, so its middle is
        # h / 2 above the second's, and they are sqrt(2 + h^2) and sqrt(2) long.
        h = 0.01
        quad = points([0, 0, 0, 1, 0, 0, 1, 1, h, 0, 1, 0, 2, 0, 0, 2, 1, 0])
        component = self.canvas.add("ShapeOpPlanarity")
        made = component.run(Points=quad, PointIndices=tree([1, 4, 5, 1], [0, 1, 2, 3]))
        self.assertEqual(component.errors(), [])
        # The lines cross at the projection; their distance is along the common normal.
        d1, d2 = (1.0, 1.0, h), (-1.0, 1.0, 0.0)
        cross = (d1[1] * d2[2] - d1[2] * d2[1], d1[2] * d2[0] - d1[0] * d2[2], d1[0] * d2[1] - d1[1] * d2[0])
        length = sum(c * c for c in cross) ** 0.5
        expected = abs(cross[0] * 1.0) / length / (0.5 * ((2 + h * h) ** 0.5 + 2**0.5))
        values = [b[0] for b in made["Planarity"].Branches]
        self.assertAlmostEqual(values[1], expected, 12)
        self.assertEqual(made["Worst"], 1)
        self.assertEqual([path for path, _ in plain(made["Colours"])], [[0], [1]])

    def test_planarity_of_a_face_that_points_nowhere_is_an_error(self):
        component = self.canvas.add("ShapeOpPlanarity")
        made = component.run(Points=points(self.given), PointIndices=tree([0, 1, 99]))
        self.assertEqual(set(made.values()), {None})
        self.assertIn("99", component.errors()[0])

    def test_the_list_of_types_is_the_library_s(self):
        from shapeop_gh import library

        component = self.canvas.add("ShapeOpConstraintTypes")
        made = component.run()
        count = library.load().shapeop_constraintTypeCount()
        self.assertEqual(set(len(column) for column in made.values()), {count})
        row = made["Types"].index("EdgeStrain")
        self.assertEqual(made["Points"][row], "2: start, end")
        self.assertEqual(made["Scalars"][row], "length, range_min = 1, range_max = 1")
        self.assertEqual(made["Units"][row], "model units")
        self.assertEqual(made["Points"][made["Types"].index("Plane")][:9], "3 or more")
        # Every listed name can be used; those of reference shapes, which have no ports yet, say what is missing.
        for name in made["Types"]:
            row = made["Types"].index(name)
            least = int(made["Points"][row].split(" ")[0].split(":")[0])
            held = self.planes() + signature(self.canvas, name, [list(range(least))])
            solver = self.canvas.add("ShapeOpOneShotSolver")
            solver.run(ConstraintSigs=tree(held + self.held()), Points=tree(points(self.given)), MaxIterations=1)
            if made["Scalars"][row] == "reference":
                self.assertIn("0 references", solver.errors()[0])
            else:
                self.assertEqual(solver.errors(), [])
        self.assertEqual(component.run(Filter="sphere")["Types"], ["Sphere"])


if __name__ == "__main__":
    unittest.main()
