"""The published client's loop: every editable constraint is edited again at every tick, then solve, then getPoints.

Unchanged edits must cost nothing: the report's seconds of the factorisation are those of the system in use, so they
stay the same number as long as it is not made anew. Usage: client_loop.py;
ctypes declares nothing, as in undeclared.py.
"""

import ctypes
import math

lib = ctypes.CDLL("ShapeOp.0.1.0.dll")

SIDE = 30


class Report(ctypes.Structure):
    _fields_ = (
        [("struct_size", ctypes.c_uint), ("outcome", ctypes.c_int)]
        + [("iterations", ctypes.c_uint), ("unconstrained_count", ctypes.c_uint)]
        + [(name, ctypes.c_double) for name in ("energy_before", "energy_after", "largest_move")]
        + [(name, ctypes.c_double) for name in ("analysis", "factorisation", "local", "global_")]
    )


class Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint), ("max_iterations", ctypes.c_uint)]


def doubles(values):
    return (ctypes.c_double * len(values))(*values)


class Sheet:
    """A cloth of edges, held at two corners, under gravity."""

    def __init__(self, op):
        self.op = op
        points = [c for i in range(SIDE * SIDE) for c in (float(i % SIDE), float(i // SIDE), 0.0)]
        lib.shapeop_setPoints(op, doubles(points), SIDE * SIDE)
        self.edges = []
        for i in range(SIDE * SIDE):
            for j in [i + 1] * (i % SIDE + 1 < SIDE) + [i + SIDE] * (i // SIDE + 1 < SIDE):
                self.edges.append(self.add(b"EdgeStrain", [i, j], 10.0))
        self.held = [(self.add(b"Closeness", [i], 1e4), points[3 * i : 3 * i + 3]) for i in (0, SIDE - 1)]
        assert self.edges[0] == 0 and self.held[1][0] == len(self.edges) + 1
        assert lib.shapeop_addGravityForce(op, doubles([0.0, 0.0, -0.5])) == 0
        assert lib.shapeop_initDynamic(op, ctypes.c_double(1), ctypes.c_double(0.95), ctypes.c_double(0.1)) == 0

    def add(self, type_name, ids, weight):
        return lib.shapeop_addConstraint(
            self.op, type_name, (ctypes.c_int * len(ids))(*ids), len(ids), ctypes.c_double(weight)
        )

    def edit_all(self, length):
        for edge in self.edges:
            assert lib.shapeop_editConstraint(self.op, b"EdgeStrain", edge, doubles([length, 0.9, 1.1]), 3) == 0
        for held, place in self.held:
            assert lib.shapeop_editConstraint(self.op, b"Closeness", held, doubles(place), 3) == 0

    def step(self):
        """One tick; returns the report, whose iterations are those asked for."""
        report = Report(struct_size=ctypes.sizeof(Report))
        options = Options(struct_size=ctypes.sizeof(Options), max_iterations=5)
        code = lib.shapeop_solveUntil(self.op, ctypes.byref(options), None, None, ctypes.byref(report))
        assert code == 0
        return report

    def points(self):
        points = doubles([math.nan] * (3 * SIDE * SIDE))
        lib.shapeop_getPoints(self.op, points, SIDE * SIDE)
        return list(points)


def main():
    edited, plain = Sheet(lib.shapeop_create()), Sheet(lib.shapeop_create())
    for sheet in (edited, plain):
        sheet.edit_all(1.0)
    first = edited.step()
    plain.step()
    assert first.factorisation > 0
    for _ in range(30):
        edited.edit_all(1.0)
        report = edited.step()
        plain.step()
        made_anew = (report.analysis, report.factorisation) != (first.analysis, first.factorisation)
        assert not made_anew, "an edit without a change made the system anew"
        assert edited.points() == plain.points(), "an edit without a change changed the result"
    assert all(math.isfinite(c) for c in edited.points())
    # A change of length is a change of rows: a new factorisation, of the same pattern.
    edited.edit_all(1.5)
    report = edited.step()
    assert report.factorisation != first.factorisation
    assert edited.points() != plain.points()
    print("client loop: 31 ticks of %d edits, one factorisation" % len(edited.edges))


main()
