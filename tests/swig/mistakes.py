"""Mistakes through the SWIG module: each is refused with its reason, and the program goes on. Ends with 1 if not."""

from __future__ import print_function

import sys
import threading

from shapeopPython import *

passed = 0
failed = 0


def check(truth, is_true, found=""):
    global passed, failed
    passed += bool(is_true)
    failed += not is_true
    print("ok    " + truth if is_true else "WRONG %s: found %s" % (truth, found))


def refused(truth, op, is_refused, words):
    """The call just made on `op` was refused, and the message has all the words."""
    message = shapeop_lastError(op)
    check(truth, is_refused and all(word in message for word in words), repr(message))


def accepted(truth, op, is_accepted=True):
    check(truth, is_accepted and shapeop_lastError(op) == "", repr(shapeop_lastError(op)))


def raises(truth, kind, words, call, *arguments):
    try:
        found = call(*arguments)
    except kind as error:
        check(truth, all(word in str(error) for word in words), str(error))
    except Exception as error:
        check(truth, False, repr(error))
    else:
        check(truth, False, repr(found))


def filled(kind, values):
    array = kind(len(values))
    for i, value in enumerate(values):
        array[i] = value
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
    return list(points)


def arrays():
    array = doubles(1, 2, 3)
    check("an array starts with zeros and keeps what is set", list(doubleArray(2)) + list(array) == [0, 0, 1, 2, 3])
    check("an array ends where it ends", len(array) == 3 and len(intArray(0)) == 0)
    raises("an index at the end is refused", IndexError, ["3", "array of 3"], array.__getitem__, 3)
    raises("an index below 0 is refused", IndexError, ["-1"], array.__setitem__, -1, 0.0)
    raises("a length below 0 is refused", ValueError, ["nelements"], doubleArray, -1)
    raises("a text is no number", TypeError, ["double"], array.__setitem__, 0, "1")
    raises("a fraction is no index", TypeError, ["int"], ints(0).__setitem__, 0, 0.5)
    raises("2^31 is no int", OverflowError, ["int"], ints(0).__setitem__, 0, 2**31)


def arguments():
    op = square()
    shapeop_setPoints(op, None, 4)
    refused("null points are refused", op, True, ["points", "null"])
    shapeop_setPoints(op, doubles(*[float("nan")] * 12), 4)
    refused("points that are not numbers are refused", op, True, ["points[0]", "finite"])
    shapeop_setPoints(op, doubles(*SQUARE), -4)
    refused("a count below 0 is refused", op, True, ["nb_points", "-4"])
    check("a refused call changes no point", points_of(op, 4) == SQUARE, points_of(op, 4))
    out = doubles(*[7] * 15)
    shapeop_getPoints(op, out, 5)
    refused("points are not read with another count", op, list(out) == [7] * 15, ["nb_points", "4", "5"])

    raises("points that are fewer than said are refused", ValueError, ["points", "12", "11"],
           shapeop_setPoints, op, doubleArray(11), 4)
    raises("room for fewer points than said is refused", ValueError, ["points", "12", "11"],
           shapeop_getPoints, op, doubleArray(11), 4)
    raises("indices that are fewer than said are refused", ValueError, ["ids", "4", "3"],
           shapeop_addConstraint, op, "Plane", ints(0, 1, 2), 4, 1.0)
    raises("scalars that are fewer than said are refused", ValueError, ["scalars", "3", "2"],
           shapeop_editConstraint, op, "Closeness", 0, doubleArray(2), 3)
    raises("a force of two numbers is refused", ValueError, ["force", "3", "2"],
           shapeop_addGravityForce, op, doubleArray(2))
    raises("ints are no points", TypeError, ["doubleArray"], shapeop_setPoints, op, intArray(12), 4)
    raises("a list is no array", TypeError, ["intArray"], shapeop_addConstraint, op, "Plane", [0, 1, 2], 3, 1.0)
    raises("a text is no count", TypeError, ["int"], shapeop_setPoints, op, doubleArray(12), "4")
    raises("an array is no solver", TypeError, ["ShapeOpSolver"], shapeop_init, doubleArray(1))
    raises("iterations below 0 are refused", OverflowError, ["unsigned"], shapeop_solve, op, -1)
    check("what was refused by its type changed nothing", points_of(op, 4) == SQUARE, points_of(op, 4))
    shapeop_delete(op)


def constraints_and_forces():
    op = square()
    plane = ints(0, 1, 2, 3)
    refused("an index beyond the points is refused", op,
            shapeop_addConstraint(op, "Plane", ints(0, 1, 99), 3, 1.0) == -1, ["Plane", "99", "4 points"])
    refused("too few indices are refused", op,
            shapeop_addConstraint(op, "Plane", plane, 2, 1.0) == -1, ["Plane", "3", "2"])
    refused("an unknown type is refused with the known ones", op,
            shapeop_addConstraint(op, "Plain", plane, 4, 1.0) == -1, ["Plain", "EdgeStrain", "Plane"])
    refused("no type is refused", op, shapeop_addConstraint(op, None, plane, 4, 1.0) == -1, ["null"])
    refused("no indices are refused", op, shapeop_addConstraint(op, "Plane", None, 4, 1.0) == -1, ["ids", "null"])
    refused("a weight below 0 is refused", op, shapeop_addConstraint(op, "Plane", plane, 4, -1.0) == -1, ["weight"])
    accepted("the first accepted constraint has id 0", op, shapeop_addConstraint(op, "Closeness", ints(0), 1, 1.0) == 0)
    accepted("the second has id 1", op, shapeop_addConstraint(op, "Plane", plane, 4, 1.0) == 1)
    target = doubles(0, 0, 0.1)
    refused("an id of no constraint is not edited", op,
            shapeop_editConstraint(op, "Closeness", 7, target, 3) == SO_UNMATCHING_CONSTRAINT_ID, ["7"])
    refused("a wrong number of scalars is refused", op,
            shapeop_editConstraint(op, "Closeness", 0, target, 2) == SO_INVALID_ARGUMENT_LENGTH, ["3", "2"])
    refused("a type without scalars is not edited", op,
            shapeop_editConstraint(op, "Plane", 1, target, 3) == SO_INVALID_CONSTRAINT_TYPE, ["Plane"])
    refused("a force beyond the points is refused", op, shapeop_addVertexForce(op, target, 9) == -1, ["9", "4 points"])
    refused("no force is refused", op, shapeop_addGravityForce(op, None) == -1, ["force", "null"])
    shapeop_editVertexForce(op, 5, target, 0)
    refused("a force that is none is not edited", op, True, ["5"])
    refused("solving before init is refused", op, shapeop_solve(op, 1) == 1, ["init"])
    refused("masses below 0 are refused", op, shapeop_initDynamic(op, -1.0, 1.0, 1.0) == 1, ["masses", "-1"])
    shapeop_delete(op)


def solvers():
    op, other = square(), square()
    shapeop_delete(op)
    accepted("a solver is deleted", op)
    refused("a deleted solver does not solve", op, shapeop_solve(op, 1) == 1, ["deleted"])
    shapeop_delete(op)
    refused("a solver is deleted once", op, True, ["deleted"])
    refused("null is no solver", None, shapeop_init(None) == 1, ["null"])
    # Along z each corner minimises w (z - h)^2 + z^2 with w = 1/4 and h its height: z = h / 5.
    for i in range(4):
        shapeop_addConstraint(other, "Closeness", ints(i), 1, 0.25)
    shapeop_addConstraint(other, "Plane", ints(0, 1, 2, 3), 4, 1.0)
    accepted("another solver is initialised", other, shapeop_init(other) == 0)
    accepted("and solves", other, shapeop_solve(other, 1) == 0)
    found = points_of(other, 4)
    expected = [x / 5 if i % 3 == 2 else x for i, x in enumerate(SQUARE)]
    check("and finds what it should", max(abs(a - b) for a, b in zip(found, expected)) < 1e-12, found)
    shapeop_delete(other)


def exploring():
    # With closeness alone a plane that is met exactly is the best-fit plane: z = 0.
    op = square()
    plane = shapeop_addConstraint(op, "Plane", ints(0, 1, 2, 3), 4, 1.0)
    accepted("a constraint is made hard", op, shapeop_setHard(op, plane, 1) == SO_SUCCESS)
    check("and knows it", shapeop_isHard(op, plane) == 1 and shapeop_isHard(op, 7) == 0)
    objective = shapeop_objective()
    check("an objective begins with the defaults", objective.handle_weight == 100, objective.handle_weight)
    objective.fairness_weight = 0
    accepted("weights are set", op, shapeop_setObjective(op, objective) == SO_SUCCESS)
    found = shapeop_exploration()
    refused("nothing is found before it was looked for", op,
            shapeop_getExploration(op, found) == SO_NOT_INITIALISED, ["no exploration yet"])
    report = shapeop_solve_report()
    shapeop_init(op)
    accepted("it solves", op, shapeop_solveUntil(op, shapeop_solve_options(), report) == SO_SUCCESS)
    check("and converges", report.outcome == SO_OUTCOME_CONVERGED and report.iterations > 0, report.outcome)
    expected = [0 if i % 3 == 2 else x for i, x in enumerate(SQUARE)]
    apart = max(abs(a - b) for a, b in zip(points_of(op, 4), expected))
    check("a hard plane with closeness alone is the best-fit plane", apart < 1e-11, apart)
    accepted("what was found is told", op, shapeop_getExploration(op, found) == SO_SUCCESS)
    check("it is a solution", found.is_solution == 1 and found.worst_constraint == plane, found.largest_violation)
    check("closeness is half of 0.1 times 4 times 0.1 squared", abs(found.closeness_term - 0.002) < 1e-12)
    check("there is no contradiction", shapeop_getConflicts(op, None, 0) == 0)

    count = shapeop_weightClassCount(op)
    names = [shapeop_weightClassName(op, i) for i in range(count)]
    check("weights have names", names == ["handles", "closeness", "fairness"], names)
    moves, squares = doubleArray(3 * 4 * count), doubleArray(count * count)
    accepted("sensitivities are told", op, shapeop_getSensitivities(op, moves, 4, squares, count) == SO_SUCCESS)
    check("no weight moves this solution", max(abs(x) for x in moves) < 1e-9, max(abs(x) for x in moves))
    raises("room for fewer moves than there are is refused", ValueError, ["points", "36", "35"],
           shapeop_getSensitivities, op, doubleArray(35), 4, squares, count)
    raises("room for fewer squares than there are is refused", ValueError, ["squares", "9", "8"],
           shapeop_getSensitivities, op, moves, 4, doubleArray(8), count)
    raises("counts beyond all memory are refused", ValueError, ["too large"],
           shapeop_getSensitivities, op, moves, 2**30, squares, 2**30)

    accepted("a point becomes a handle", op, shapeop_setHandle(op, 0, doubles(0, 0, 1)) == SO_SUCCESS)
    accepted("fairness is set", op, shapeop_setFairness(
        op, SO_FAIRNESS_LAPLACIAN, ints(0, 1, 2, 3), 4, ints(4), 1) == SO_SUCCESS)
    shapeop_solveUntil(op, None, None)
    check("which is drawn", points_of(op, 4)[2] > 0.1, points_of(op, 4))
    accepted("and is let go", op, shapeop_releaseHandle(op, 0) == SO_SUCCESS)
    refused("once", op, shapeop_releaseHandle(op, 0) == SO_INVALID_VALUE, ["point 0 is no handle"])
    refused("a point that is none is no handle", op,
            shapeop_setHandle(op, 4, doubles(0, 0, 0)) == SO_INDEX_OUT_OF_RANGE, ["4", "4 points"])
    raises("a target of two numbers is refused", ValueError, ["target", "3", "2"],
           shapeop_setHandle, op, 0, doubleArray(2))
    refused("no objective is refused", op, shapeop_setObjective(op, None) == SO_NULL_POINTER, ["objective", "null"])
    raises("indices that are fewer than said are no faces", ValueError, ["indices", "4", "3"],
           shapeop_setFairness, op, SO_FAIRNESS_LAPLACIAN, intArray(3), 4, ints(4), 1)
    raises("nor counts", ValueError, ["counts", "2", "1"],
           shapeop_setFairness, op, SO_FAIRNESS_LAPLACIAN, ints(0, 1, 2, 3), 4, ints(4), 2)
    shapeop_delete(op)

    op = square()
    curve = shapeop_addReferencePolyline(op, doubles(*SQUARE), 4, 1)
    mesh = shapeop_addReferenceMesh(op, doubles(*SQUARE), 4, ints(0, 1, 2), 1)
    check("references have ids", (curve, mesh, shapeop_referenceCount(op)) == (0, 1, 2), (curve, mesh))
    raises("points that are fewer than said are no curve", ValueError, ["points", "15", "12"],
           shapeop_addReferencePolyline, op, doubles(*SQUARE), 5, 0)
    raises("indices that are fewer than said are no triangles", ValueError, ["triangles", "6", "3"],
           shapeop_addReferenceMesh, op, doubles(*SQUARE), 4, ints(0, 1, 2), 2)
    for i in range(4):
        shapeop_addConstraint(op, "Closeness", ints(i), 1, 2.0)
    flat = [0 if i % 3 == 2 else x for i, x in enumerate(SQUARE)]
    pressure = shapeop_addPressure(op, ints(0, 1, 2, 3), 4, ints(4), 1, 8.0)
    normal = shapeop_addNormalForce(op, ints(0, 1, 2, 3), 4, ints(4), 1, 0.0)
    accepted("forces on faces have ids", op, (pressure, normal) == (0, 1))
    accepted("and are edited", op, shapeop_editForceMagnitude(op, pressure, 4.0) == SO_SUCCESS)
    shapeop_init(op)
    shapeop_setPoints(op, doubles(*flat), 4)
    shapeop_solve(op, 1)
    # A quarter of 4 over 2, above where they are held.
    check("a pressure moves a held point by its share over the weight", abs(points_of(op, 4)[2] - 0.6) < 1e-12)
    violations, energy = doubleArray(4), doubleArray(1)
    accepted("violations are told", op, shapeop_getViolations(op, violations, 4) == SO_SUCCESS)
    check("and are the distances", abs(violations[0] - 0.5) < 1e-12, violations[0])
    accepted("energy is told", op, shapeop_energy(op, energy) == SO_SUCCESS)
    accepted("a force is removed", op, shapeop_removeForce(op, normal) == SO_SUCCESS)
    refused("once", op, shapeop_editForceMagnitude(op, normal, 1.0) == SO_UNMATCHING_FORCE_ID, ["1"])
    shapeop_delete(op)

    op = shapeop_create()
    shapeop_setPoints(op, doubles(*flat), 4)
    for a, b, length, weight in ((0, 1, 1.0, 2.0), (1, 2, 1.0, 2.0), (2, 3, 1.0, 2.0), (3, 0, 1.0, 2.0), (0, 1, 3.0, 1.0)):
        edge = shapeop_addConstraint(op, "EdgeLength", ints(a, b), 2, weight)
        shapeop_editConstraint(op, "EdgeLength", edge, doubles(length, length), 2)
        shapeop_setHard(op, edge, 1)
    shapeop_setFairness(op, SO_FAIRNESS_LAPLACIAN, ints(0, 1, 2, 3), 4, ints(4), 1)
    shapeop_init(op)
    accepted("a contradiction is no refusal", op, shapeop_solveUntil(op, None, report) == SO_SUCCESS)
    ids = intArray(1)
    check("two lengths of one edge cannot be met", report.outcome == SO_OUTCOME_INFEASIBLE, report.outcome)
    check("the one of less priority is named", shapeop_getConflicts(op, ids, 1) == 1 and ids[0] == edge, ids[0])
    raises("room for fewer ids than said is refused", ValueError, ["ids", "2", "1"], shapeop_getConflicts, op, ids, 2)
    shapeop_delete(op)


def grid(size):
    op = shapeop_create()
    shapeop_setPoints(op, doubles(*[x for j in range(size) for i in range(size) for x in (i, j, i * j % 3)]), size**2)
    for point in range(size**2 - size):
        shapeop_addConstraint(op, "EdgeStrain", ints(point, point + size), 2, 1.0)
    shapeop_addConstraint(op, "Closeness", ints(0), 1, 1.0)
    shapeop_init(op)
    return op


def threads():
    op = grid(60)
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
    shapeop_delete(op)
    refused("a busy solver is not deleted", op, not results, ["busy"])
    thread.join()
    check("the thread's own call succeeded", results == [""], results)
    accepted("the solver can be used again", op, shapeop_solve(op, 1) == 0)
    check("its points are finite", all(abs(x) < 1e6 for x in points_of(op, 3600)))
    shapeop_delete(op)


def texts():
    check("an error code has a text", "out of range" in shapeop_errorText(SO_INDEX_OUT_OF_RANGE))
    check("what is no error code says so", "not an error code" in shapeop_errorText(999))
    check("the library has a version", shapeop_version().count(".") == 2, shapeop_version())
    name = b"Fl\xc3\xa4che".decode("utf-8") if sys.version_info[0] > 2 else "Fl\xc3\xa4che"
    op = square()
    refused("a name beyond ASCII comes back as it is", op,
            shapeop_addConstraint(op, name, ints(0), 1, 1.0) == -1, [name])
    shapeop_delete(op)


for part in (arrays, arguments, constraints_and_forces, solvers, exploring, threads, texts):
    part()
print("%d passed, %d failed" % (passed, failed))
sys.exit(failed > 0)
