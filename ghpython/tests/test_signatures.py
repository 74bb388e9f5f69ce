import unittest

from support import Canvas, signature, tree
from Rhino.Geometry import Point3d, Vector3d

from shapeop_gh import signatures
from shapeop_gh.errors import ShapeOpError


class Made(unittest.TestCase):
    def setUp(self):
        self.component = Canvas().add("ShapeOpConstraintSignature")

    def test_a_signature_has_exactly_the_published_keys(self):
        made = self.component.run(
            ConstraintType="EdgeStrain",
            PointIndices=tree([0, 1], [1, 2]),
            Weights=[1.0, 2.0],
            Scalars=tree([1.0, 0.9, 1.1], [2.0, 1.0, 1.0]),
        )["ConstraintSigs"]
        expected = {
            "type": "EdgeStrain",
            "pointIndices": [[0, 1], [1, 2]],
            "weights": [1.0, 2.0],
            "scalars": [[1.0, 0.9, 1.1], [2.0, 1.0, 1.0]],
        }
        self.assertEqual(made, [expected])

    def test_hard_is_said_only_where_it_is_so(self):
        given = dict(ConstraintType="Plane", PointIndices=tree([0, 1, 2]), Weights=[1.0])
        soft = {"type": "Plane", "pointIndices": [[0, 1, 2]], "weights": [1.0], "scalars": []}
        for hard in (None, False):
            self.assertEqual(self.component.run(Hard=hard, **given)["ConstraintSigs"], [soft])
        made = self.component.run(Hard=True, **given)["ConstraintSigs"]
        self.assertEqual(made, [dict(soft, hard=True)])
        self.assertEqual([played[4] for played in signatures.read([soft] + made)], ["soft", "hard"])
        self.assertEqual(signatures.copied(made), made)
        self.assertTrue(signatures.are_hard([soft] + made))
        for nonsense in ([soft], [], [None, 5, "hard"]):
            self.assertFalse(signatures.are_hard(nonsense))

    def test_a_component_without_the_port_makes_soft_constraints(self):
        self.component.missing = ("Hard",)
        made = self.component.run(ConstraintType="Plane", PointIndices=tree([0, 1, 2]), Weights=[1.0])
        self.assertEqual(self.component.errors(), [])
        self.assertNotIn("hard", made["ConstraintSigs"][0])

    def test_one_weight_and_one_list_of_scalars_are_repeated(self):
        (made,) = signature(Canvas(), "Area", [[0, 1, 2], [1, 2, 3], [2, 3, 4]], [3.0], [[0.5, 2.0]])
        self.assertEqual(made["weights"], [3.0] * 3)
        self.assertEqual(made["scalars"], [[0.5, 2.0]] * 3)
        made["scalars"][0][0] = 9.0
        self.assertEqual(made["scalars"][1][0], 0.5)

    def test_points_among_the_scalars_are_their_coordinates(self):
        shape = [Point3d(0, 0, 0), Point3d(1, 0, 0), Point3d(1, 1, 2)]
        (made,) = signature(Canvas(), "Rigid", [[0, 1, 2]], [1.0], [shape])
        self.assertEqual(made["scalars"], [[0, 0, 0, 1, 0, 0, 1, 1, 2]])

    def test_without_scalars_there_are_none(self):
        (made,) = signature(Canvas(), "Plane", [[0, 1, 2, 3]])
        self.assertEqual(made["scalars"], [])

    def test_without_type_indices_or_weights_there_is_no_signature(self):
        full = {"ConstraintType": "Plane", "PointIndices": tree([0, 1, 2]), "Weights": [1.0], "Scalars": tree()}
        for left_out in ("ConstraintType", "PointIndices", "Weights"):
            given = dict((k, v) for k, v in full.items() if k != left_out)
            self.assertEqual(self.component.run(**given), {"ConstraintSigs": []})
            self.assertEqual(self.component.errors(), [])

    def refused(self, text, **changed):
        given = {"ConstraintType": "Plane", "PointIndices": tree([0, 1, 2], [1, 2, 3]), "Weights": [1.0]}
        given.update(changed)
        self.assertEqual(self.component.run(**given), {"ConstraintSigs": None})
        self.assertEqual(len(self.component.errors()), 1)
        self.assertIn(text, self.component.errors()[0])

    def test_mismatched_counts_are_errors_that_name_the_input(self):
        self.refused(
            "Weights: one weight for all or one for each of the 2 constraints expected, found 3", Weights=[1.0] * 3
        )
        self.refused("Scalars: one list of scalars", Scalars=tree([1.0], [1.0], [1.0]))

    def test_what_is_no_number_is_an_error_that_names_it(self):
        self.refused("Weights: item 0: a number expected, found 'heavy'", Weights=["heavy"])
        self.refused("PointIndices: item 1: a whole number expected, found 1.5", PointIndices=tree([0, 1], [1.5, 2]))
        self.refused("Scalars: item 0: a number expected, found 'long'", Scalars=tree(["long"]))
        self.refused("PointIndices {1}: item 1 is null", PointIndices=tree([0, 1], [1, None]))


class Settings(unittest.TestCase):
    def test_static_settings_have_the_published_keys_and_default(self):
        component = Canvas().add("ShapeOpSettingsStatic")
        self.assertEqual(component.run()["Settings"], [{"mode": "static", "iterations": 50}])
        self.assertEqual(component.run(Iterations=7)["Settings"], [{"mode": "static", "iterations": 7}])

    def test_live_settings_have_the_published_keys_and_defaults(self):
        component = Canvas().add("ShapeOpSettingsLive")
        defaults = {
            "mode": "live",
            "iterations": 5,
            "mass": 1.0,
            "damping": 1.0,
            "timeStep": 0.1,
            "unaryVector": None,
            "dynamic": True,
            "pause": False,
            "reset": True,
        }
        self.assertEqual(component.run()["Settings"], [defaults])
        force = Vector3d(0, 0, -1)
        given = dict(
            Iterations=3, Mass=2.0, Damping=0.5, TimeStep=0.2, UnaryVector=force, Dynamic=False, Pause=True, Reset=False
        )
        (made,) = component.run(**given)["Settings"]
        expected = dict(
            mode="live",
            iterations=3,
            mass=2.0,
            damping=0.5,
            timeStep=0.2,
            unaryVector=force,
            dynamic=False,
            pause=True,
            reset=False,
        )
        self.assertEqual(made, expected)

    def test_settings_of_nobody_are_refused(self):
        for nonsense in (5, {}, {"mode": "fast"}, "static", [{"mode": "live"}, {"mode": "live"}]):
            self.assertRaises(ShapeOpError, signatures.read_settings, nonsense)


class Read(unittest.TestCase):
    def test_the_published_name_of_the_angle_type_is_taken(self):
        made = signature(Canvas(), "AngleConstraint", [[0, 1, 2]])
        self.assertEqual(made[0]["type"], "AngleConstraint")
        self.assertEqual(signatures.read(made)[0][0], "Angle")

    def test_what_is_no_signature_is_named(self):
        good = signature(Canvas(), "Plane", [[0, 1, 2]])[0]
        for bad in (None, 5, "Plane", {}, {"type": "Plane"}, dict(good, type=5), dict(good, pointIndices=3)):
            try:
                signatures.read([good, bad])
            except ShapeOpError as error:
                self.assertIn("ConstraintSigs: item 1", str(error))
            else:
                self.fail(repr(bad))

    def test_a_force_acts_on_points_or_on_all(self):
        component = Canvas().add("ShapeOpForce")
        some = component.run(Force=Vector3d(1, 2, 3), PointIndices=tree([0, 4], [2]))["Forces"]
        self.assertEqual(signatures.read_forces(some), [([1, 2, 3], 0), ([1, 2, 3], 4), ([1, 2, 3], 2)])
        every = component.run(Force=Vector3d(0, 0, -9))["Forces"]
        self.assertEqual(signatures.read_forces(every), [([0, 0, -9], None)])
        self.assertEqual(component.run(), {"Forces": None})
        self.assertIn("Force: a vector expected", component.errors()[0])
        self.assertRaises(ShapeOpError, signatures.read_forces, [5])


if __name__ == "__main__":
    unittest.main()
