"""A circular arc snake on a torus: a curve of constant curvature, arcs along it, the surface that they sweep.

Usage: circular_arc_snakes.py [FOLDER]: prints what was made, and writes the arcs and the parts to the folder.
"""

from __future__ import annotations

import sys
from math import pi
from pathlib import Path

from shapeop import snakes


def main(arguments: list[str]) -> str:
    """Makes the snake, moves it, and tells of it."""
    torus = snakes.torus(center=[0, 0, 0], axis=[0, 0, 1], radius=2, tube=0.7)
    curve = snakes.curve(torus, start=[2.6, 0.5, 0.2], tangent=[0.2, 1, 0.3], curvature=1.8, length=2)
    fitted = snakes.fit(curve.points, arc_count=6)
    told = [f"6 arcs, {fitted.deviation:.1e} from the curve, {fitted.snake.freedoms(torus).free} freedoms"]
    with snakes.evolve(fitted.snake, torus, direction="sideways", step=0.02, max_steps=20, max_deviation=0.05) as moved:
        points, quads = moved.mesh(per_arc=4)
        told.append(
            f"{len(moved)} positions ({moved.stop.name}), {max(moved.deviations):.1e} from the torus at most, "
            f"arcs kept to {max(moved.residuals):.0e}: {len(points)} points, {len(quads)} quads"
        )
        for kind in moved.kinds():
            told.append(f"{kind.count * len(moved)} arcs of radius {kind.radius:.4f} and length {kind.length:.4f}")
        if arguments:
            folder = Path(arguments[0])
            folder.mkdir(parents=True, exist_ok=True)
            for name, text in (
                ("arcs.json", moved.to_json()),
                ("arcs.csv", moved.to_csv()),
                ("arcs.dxf", moved.to_dxf()),
                ("parts.csv", moved.kinds_csv()),
            ):
                (folder / name).write_text(text, encoding="utf-8")
    # Six arcs between two hinges move in one way, and come back.
    six = snakes.Snake.from_arcs([1.0] * 6, [pi / 3] * 6, [1.0, -0.7, 0.9, -0.8, 0.6])
    cycle = snakes.Linkage(six).cycle()
    told.append(f"a linkage: {cycle.motion.end.name} after {len(cycle)} positions, {cycle.motion.closing:.0e} off")
    return "\n".join(told)


if __name__ == "__main__":
    print(main(sys.argv[1:]))
