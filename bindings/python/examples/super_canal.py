"""A super-canal surface from a strip: a canal surface between two curves, inverted, refined, and cut into panels.

Usage: super_canal.py [FILE.json]: prints what was made, and writes the parts for a workshop to the file.
"""

from __future__ import annotations

import sys
from math import cos, sin
from pathlib import Path

from shapeop import canal


def main(arguments: list[str]) -> str:
    """Makes the surface, and tells of it."""
    guide = [[3 * cos(0.1 * k), 3 * sin(0.1 * k), 0.0] for k in range(16)]
    curve = [[1.5 * cos(0.1 * k), 1.5 * sin(0.1 * k), 0.4] for k in range(-4, 20)]
    fit = canal.fit(guide, curve, circle_count=12, column_count=7, section="to-curve", angle=1.0)
    surface = fit.surface
    surface.invert([0.0, 0.0, 6.0], 30.0)
    fine = surface.refined(2, 2)
    normals = [[[float(number) for number in frame[2]] for frame in row] for row in fine.frames]
    panels = canal.panels(fine.points, normals, thickness=0.02)
    if arguments:
        Path(arguments[0]).write_text(canal.parts_json(fine.points, normals, 0.02, 0.1), encoding="utf-8")
    rows, columns = fine.shape
    return (
        f"{surface.family} of {rows} by {columns} points, {len(panels.heights)} panels, "
        f"flat within {max(panels.heights):.1e}, {fit.deviation:.1e} from the second curve"
    )


if __name__ == "__main__":
    print(main(sys.argv[1:]))
