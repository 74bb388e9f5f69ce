import unittest

from support import Canvas, points, tree

from shapeop_gh import colours
from shapeop_gh.errors import ShapeOpError


class Scales(unittest.TestCase):
    def test_planarity_runs_from_light_at_0_to_dark_red_at_the_limit_and_beyond(self):
        light, middle, dark = colours.PLANARITY
        self.assertEqual(colours.planarity(0.0, 0.01), light)
        self.assertEqual(colours.planarity(0.005, 0.01), middle)
        self.assertEqual(colours.planarity(0.01, 0.01), dark)
        self.assertEqual(colours.planarity(7.0, 0.01), dark)
        shades = [sum(colours.planarity(n / 1000.0, 0.01)) for n in range(11)]
        self.assertEqual(shades, sorted(shades, reverse=True))

    def test_tension_is_blue_and_compression_is_red(self):
        for value in (0.002, 0.01, 5.0):
            red, _, blue = colours.strain(value, 0.01)
            self.assertTrue(blue > red)
            red, _, blue = colours.strain(-value, 0.01)
            self.assertTrue(red > blue)
        self.assertEqual(colours.strain(0.0, 0.01), colours.REST)

    def test_a_limit_of_0_is_refused(self):
        self.assertRaises(ShapeOpError, colours.planarity, 0.1, 0)
        self.assertRaises(ShapeOpError, colours.strain, 0.1, -1.0)


class Strain(unittest.TestCase):
    def setUp(self):
        self.component = Canvas().add("ShapeOpStrain")
        self.points = points([0, 0, 0, 2, 0, 0, 2, 1, 0])

    def test_strain_is_the_change_of_length_over_the_length_at_rest(self):
        made = self.component.run(Points=self.points, PointIndices=tree([0, 1], [1, 2]), RestLengths=[1.0, 2.0])
        self.assertEqual([b[0] for b in made["Strain"].Branches], [1.0, -0.5])
        stretched, pressed = [b[0] for b in made["Colours"].Branches]
        self.assertTrue(stretched.B > stretched.R and pressed.R > pressed.B)
        self.assertEqual(made["Worst"], 0)

    def test_wrong_index_count_and_length_are_errors(self):
        for text, changed in (
            ("index 7 is out of range for 3 points", {"PointIndices": tree([0, 7])}),
            ("RestLengths: 1 or 2 expected, found 3", {"RestLengths": [1.0] * 3}),
            ("above 0 expected, found 0.0", {"RestLengths": [0.0]}),
        ):
            given = dict(Points=self.points, PointIndices=tree([0, 1], [1, 2]), RestLengths=[1.0])
            given.update(changed)
            made = self.component.run(**given)
            self.assertEqual(set(made.values()), {None})
            self.assertIn(text, self.component.errors()[0])


if __name__ == "__main__":
    unittest.main()
