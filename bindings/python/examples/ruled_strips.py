"""Ruled strips on a saddle: from a mesh to strips, what they are off by, planks of one of them.

Usage: ruled_strips.py [FOLDER]: prints what was made, and writes surfaces, rulings and planks to the folder.
"""

from __future__ import annotations

import sys
from math import degrees
from pathlib import Path

from shapeop import ruled


def saddle(side: int = 25) -> tuple[list[list[float]], list[list[int]]]:
    """A bent saddle over a square, as points and quads."""
    at = [2 * i / (side - 1) - 1 for i in range(side)]
    points = [[x, y, x * y + 0.1 * (x**3 - 3 * x * y**2)] for y in at for x in at]
    corner = [side * j + i for j in range(side - 1) for i in range(side - 1)]
    return points, [[k, k + 1, k + 1 + side, k + side] for k in corner]


def main(arguments: list[str]) -> str:
    """Makes the strips, and tells of them."""
    points, faces = saddle()
    with ruled.Design(points, faces, family=0) as design:
        design.level_boundaries(6, kind="orthogonal")
        design.start(control_count=10)
        found = design.optimise()
        report = design.report()
        told = [
            f"{design.strip_count} strips after {found.iterations} iterations,",
            f"{report.largest_deviation:.1e} from the mesh, {report.largest_gap:.1e} apart,",
            f"kinks up to {degrees(report.largest_kink):.1f} degrees, {report.coverage:.1%} covered",
        ]
        # A strip for carpenters: its rulings parallel to a plane.
        middle = design.strip_count // 2
        design.constrain_conoid(middle)
        design.optimise()
        planks = design.planks(middle, thickness=0.05, depth=0.02)
        told.append(f"strip {middle}: {len(planks.planks)} planks, {planks.offcut:.0%} offcut")
        if arguments:
            folder = Path(arguments[0])
            folder.mkdir(parents=True, exist_ok=True)
            for name, text in (
                ("strips.json", design.to_json()),
                ("strips.obj", design.surfaces_obj()),
                ("rulings.csv", design.rulings_csv(12)),
                ("planks.svg", design.planks_svg(f"strip {middle}")),
            ):
                (folder / name).write_text(text, encoding="utf-8")
    return "\n".join(told)


if __name__ == "__main__":
    print(main(sys.argv[1:]))
