"""Mistakes from Jython, through the SWIG classes: each is refused with its reason, and the program goes on.

What Java and Jython share is tested in tests/java/Mistakes.java; here is what Jython makes of it. Ends with 1 if a
check failed."""

import sys
import threading

from java.lang import IllegalArgumentException, IndexOutOfBoundsException

import doubleArray
import intArray
import shapeop_err
import shapeop_objective
import shapeop_outcome
import shapeop_solve_report
from shapeopJava import *

passed = 0
failed = 0


def check(truth, is_true, found=""):
    global passed, failed
    passed += bool(is_true)
    failed += not is_true
    print "ok    " + truth if is_true else "WRONG %s: found %s" % (truth, found)


def refused(truth, op, is_refused, words):
    """The call just made on `op` was refused, and the message has all the words."""
    message = shapeop_lastError(op)
    check(truth, is_refused and all(word in message for word in words), repr(message))


def raises(truth, kind, words, call, *arguments):
    try:
        found = call(*arguments)
    except kind as error:
        check(truth, all(word in str(error) for word in words), str(error))
    else:
        check(truth, False, repr(found))


def filled(kind, values):
    array = kind(len(values))
    for i, value in enumerate(values):
        array.setitem(i, value)
    return array


def doubles(*values):
    return filled(doubleArray, values)


def ints(*values):
    return filled(intArray, values)


# Corners 0.1 above and below their plane in turn.
SQUARE = [0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1]


def square():
    op = shapeop_create()
    shapeop_setPoints(op, doubles(*SQUARE), 4)
    return op


def points_of(op, count):
    points = doubleArray(3 * count)
    shapeop_getPoints(op, points, count)
    return [points.getitem(i) for i in range(3 * count)]


def types_and_arrays():
    op = square()
    array = doubles(1, 2, 3)
    raises("an index at the end is refused", IndexOutOfBoundsException, ["3", "array of 3"], array.getitem, 3)
    raises("an index below 0 is refused", IndexOutOfBoundsException, ["-1"], array.setitem, -1, 0.0)
    raises("a length below 0 is refused", IllegalArgumentException, ["nelements"], doubleArray, -1)
    raises("a text is no number", TypeError, ["setitem"], array.setitem, 0, "1")
    raises("a text is no count", TypeError, ["shapeop_setPoints"], shapeop_setPoints, op, array, "1")
    raises("a list is no array", TypeError, ["shapeop_setPoints"], shapeop_setPoints, op, [0.0] * 3, 1)
    raises("ints are no points", TypeError, ["shapeop_setPoints"], shapeop_setPoints, op, ints(0, 0, 0), 1)
    raises("an array is no solver", TypeError, ["shapeop_init"], shapeop_init, array)
    raises("a missing argument is refused", TypeError, ["shapeop_setPoints"], shapeop_setPoints, op, array)
    raises("2^31 is no int", TypeError, ["setitem"], ints(0).setitem, 0, 2**31)
    raises("iterations below 0 are refused", IllegalArgumentException, ["iteration"], shapeop_solve, op, -1)
    raises("points that are fewer than said are refused", IllegalArgumentException, ["points", "12", "11"],
           shapeop_setPoints, op, doubleArray(11), 4)
    check("what was refused changed no point", points_of(op, 4) == SQUARE, points_of(op, 4))
    shapeop_delete(op)


def calls():
    op = square()
    shapeop_setPoints(op, None, 4)
    refused("None is no array", op, True, ["points", "null"])
    refused("an index beyond the points is refused", op,
            shapeop_addConstraint(op, "Plane", ints(0, 1, 99), 3, 1.0) == -1, ["Plane", "99", "4 points"])
    refused("an unknown type is refused with the known ones", op,
            shapeop_addConstraint(op, "Plain", ints(0, 1, 2), 3, 1.0) == -1, ["Plain", "EdgeStrain", "Plane"])
    refused("an id of no constraint is not edited", op,
            shapeop_editConstraint(op, "Closeness", 7, doubles(0, 0, 0), 3) == shapeop_err.SO_UNMATCHING_CONSTRAINT_ID,
            ["7"])
    refused("solving before init is refused", op, shapeop_solve(op, 1) == 1, ["init"])
    shapeop_delete(op)
    refused("a deleted solver does not solve", op, shapeop_solve(op, 1) == 1, ["deleted"])
    shapeop_delete(op)
    refused("a solver is deleted once", op, True, ["deleted"])
    refused("None is no solver", None, shapeop_init(None) == 1, ["null"])


def threads():
    size = 60
    op = shapeop_create()
    points = [x for j in range(size) for i in range(size) for x in (i, j, i * j % 3)]
    shapeop_setPoints(op, doubles(*points), size**2)
    for point in range(size**2 - size):
        shapeop_addConstraint(op, "EdgeStrain", ints(point, point + size), 2, 1.0)
    shapeop_addConstraint(op, "Closeness", ints(0), 1, 1.0)
    shapeop_init(op)
    results = []

    def work():
        # A call of the other thread may be in the way of the first try.
        while shapeop_solve(op, 5000) != 0 and "busy" in shapeop_lastError(op):
            pass
        results.append(shapeop_lastError(op))

    thread = threading.Thread(target=work)
    thread.start()
    while not results:
        shapeop_setDamping(op, 1.0)
        if shapeop_lastError(op):
            break
    refused("a solver in use by another thread is busy", op, True, ["busy"])
    thread.join()
    check("the thread's own call succeeded", results == [""], results)
    check("the solver can be used again", shapeop_solve(op, 1) == 0, shapeop_lastError(op))
    shapeop_delete(op)


def exploring():
    op = shapeop_create()
    shapeop_setPoints(op, doubles(*SQUARE), 4)
    shapeop_setHard(op, shapeop_addConstraint(op, "Plane", ints(0, 1, 2, 3), 4, 1.0), 1)
    objective = shapeop_objective()
    objective.setFairness_weight(0)
    shapeop_setObjective(op, objective)
    shapeop_init(op)
    report = shapeop_solve_report()
    shapeop_solveUntil(op, None, report)
    check("it converges", report.outcome == shapeop_outcome.SO_OUTCOME_CONVERGED, report.outcome)
    points = doubleArray(12)
    shapeop_getPoints(op, points, 4)
    heights = [points.getitem(i) for i in (2, 5, 8, 11)]
    check("a hard plane with closeness alone is the best-fit plane", max(abs(z) for z in heights) < 1e-11, heights)
    shapeop_delete(op)


for part in (types_and_arrays, calls, exploring, threads):
    part()
print "%d passed, %d failed" % (passed, failed)
sys.exit(failed > 0)
