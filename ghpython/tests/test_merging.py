import random
import unittest

import support  # noqa: F401

from shapeop_gh.errors import ShapeOpError
from shapeop_gh.merging import merge


def distance(coordinates, i, j):
    return sum((coordinates[3 * i + c] - coordinates[3 * j + c]) ** 2 for c in range(3)) ** 0.5


class Merging(unittest.TestCase):
    def test_tolerance_0_merges_nothing(self):
        for tolerance in (0, 0.0, None):
            self.assertEqual(merge([1.0, 2.0, 3.0] * 2, tolerance), ([1.0, 2.0, 3.0] * 2, [0, 1]))

    def test_points_on_both_sides_of_a_cell_border_are_merged(self):
        kept, index_of = merge([0.0999, 0, 0, 0.1001, 0, 0, -0.01, 0, 0, 0.3, 0, 0], 0.1)
        self.assertEqual(index_of, [0, 0, 1, 2])
        self.assertEqual(kept, [0.0999, 0, 0, -0.01, 0, 0, 0.3, 0, 0])

    def test_merged_are_within_the_tolerance_and_the_kept_are_not(self):
        # Against the definition, on random points of several scales: seed 7.
        draw = random.Random(7)
        for scale in (1e-6, 1.0, 1e6):
            coordinates = [scale * draw.uniform(-1, 1) for _ in range(3 * 200)]
            kept, index_of = merge(coordinates, 0.3 * scale)
            count = len(kept) // 3
            self.assertTrue(1 < count < 200)
            for i in range(200):
                near = sum((coordinates[3 * i + c] - kept[3 * index_of[i] + c]) ** 2 for c in range(3)) ** 0.5
                self.assertTrue(near <= 0.3 * scale)
            for i in range(count):
                for j in range(i):
                    self.assertTrue(distance(kept, i, j) > 0.3 * scale)

    def test_a_tolerance_that_is_none_is_refused(self):
        for tolerance in (-1.0, float("nan"), float("inf")):
            self.assertRaises(ShapeOpError, merge, [0.0] * 3, tolerance)


if __name__ == "__main__":
    unittest.main()
