"""Solvers are freed: none outlives its component or its document."""

import unittest

from support import IS_JYTHON, NEEDS_CTYPES, Calls, Canvas, points, signature, tree

from scriptcontext import sticky

CORNERS = [0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1]


@unittest.skipIf(IS_JYTHON, NEEDS_CTYPES)
class Freed(unittest.TestCase):
    def setUp(self):
        self.canvas = Canvas()
        self.calls = Calls()
        self.calls.__enter__()

    def tearDown(self):
        self.calls.__exit__()

    def alive(self):
        return self.calls["shapeop_create"] - self.calls["shapeop_delete"]

    def live(self, canvas, reset=False):
        """A running LiveSolver and a running ConstraintSolver."""
        made = signature(canvas, "Closeness", [[0], [1], [2], [3]])
        new, old = canvas.add("ShapeOpLiveSolver"), canvas.add("ShapeOpConstraintSolver")
        settings = canvas.add("ShapeOpSettingsLive").run(Reset=reset)["Settings"][0]
        runs = [
            (new, dict(ConstraintSigs=tree(made), Points=tree(points(CORNERS)), Reset=reset)),
            (old, dict(ConstraintSigs=made, Points=points(CORNERS), Settings=settings)),
        ]
        for component, given in runs:
            component.run(**given)
            self.assertEqual(component.errors(), [])
        return runs

    def test_a_deleted_component_frees_its_solver_and_no_other(self):
        (new, given), (old, _) = self.live(self.canvas)
        self.assertEqual(self.alive(), 2)
        new.delete()
        self.assertEqual(self.alive(), 1)
        old.delete()
        self.assertEqual(self.alive(), 0)

    def test_a_component_that_was_deleted_before_its_tick_is_left_alone(self):
        (new, given), _ = self.live(self.canvas)
        new.delete()
        self.assertEqual(new.run_scheduled(**given), None)

    def test_undoing_a_deletion_starts_a_new_solver(self):
        (new, given), (old, _) = self.live(self.canvas)
        new.delete()
        self.canvas.document.AddObject(new.component, False)
        self.assertEqual(new.run(**given)["Iterations"], 10)
        self.assertEqual(self.alive(), 2)
        new.delete()
        self.assertEqual(self.alive(), 1)
        old.delete()

    def test_a_closed_document_frees_its_solvers_and_those_of_no_other(self):
        other = Canvas()
        self.live(self.canvas)
        self.live(other)
        self.canvas.close()
        self.assertEqual(self.alive(), 2)
        self.assertEqual(self.canvas.document.ObjectsDeleted._handlers, [])
        other.close()
        self.assertEqual(self.alive(), 0)
        self.assertEqual(sticky["shapeop_gh"]["states"], {})

    def test_resets_free_what_they_replace(self):
        runs = self.live(self.canvas, reset=True)
        for _ in range(50):
            for component, given in runs:
                component.run(**given)
        self.assertEqual(self.alive(), 2)
        self.assertTrue(self.calls["shapeop_create"] > 100)
        self.canvas.close()

    def test_a_reset_that_fails_frees_its_solver(self):
        (new, given), (old, old_given) = self.live(self.canvas, reset=True)
        wrong = signature(self.canvas, "Plane", [[0, 1, 99]])
        new.run(**dict(given, ConstraintSigs=tree(wrong)))
        old.run(**dict(old_given, ConstraintSigs=wrong))
        self.assertEqual((len(new.errors()), len(old.errors())), (1, 1))
        self.canvas.close()
        self.assertEqual(self.alive(), 0)

    def test_a_document_is_watched_once(self):
        for _ in range(3):
            self.live(self.canvas)
        self.assertEqual(len(self.canvas.document.ObjectsDeleted._handlers), 1)
        self.canvas.close()

    def test_two_copies_of_a_component_in_two_documents_have_two_solvers(self):
        # As clusters and Hops make them: the same InstanceGuid in another document.
        other = Canvas()
        (new, given), _ = self.live(self.canvas)
        twin = other.add("ShapeOpLiveSolver")
        twin.component.InstanceGuid = new.component.InstanceGuid
        self.assertEqual(twin.run(**given)["Iterations"], 10)
        self.assertEqual(new.run(**given)["Iterations"], 20)
        self.canvas.close()
        other.close()
        self.assertEqual(self.alive(), 0)


if __name__ == "__main__":
    unittest.main()
