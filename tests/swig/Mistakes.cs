using System;
using System.Linq;
using System.Threading;

/// <summary>Mistakes through the SWIG classes: each is refused with its reason, and the program goes on. Ends with 1 if
/// not.</summary>
public static class Mistakes
{
    static int passed = 0;
    static int failed = 0;

    static void Check(string truth, bool isTrue, object found = null)
    {
        if (isTrue) passed++;
        else failed++;
        Console.WriteLine(isTrue ? "ok    " + truth : "WRONG " + truth + ": found " + found);
    }

    /// <summary>The call just made on the solver was refused, and the message has all the words.</summary>
    static void Refused(string truth, SWIGTYPE_p_ShapeOpSolver op, bool isRefused, params string[] words)
    {
        string message = shapeopCSharp.shapeop_lastError(op);
        Check(truth, isRefused && words.All(message.Contains), message);
    }

    static void Accepted(string truth, SWIGTYPE_p_ShapeOpSolver op, bool isAccepted = true)
    {
        string message = shapeopCSharp.shapeop_lastError(op);
        Check(truth, isAccepted && message == "", message);
    }

    static void Raises<T>(string truth, Action call, params string[] words) where T : Exception
    {
        try
        {
            call();
            Check(truth, false, "no exception");
        }
        catch (T exception)
        {
            Check(truth, words.All(exception.Message.Contains), exception.Message);
        }
    }

    static doubleArray Doubles(params double[] values)
    {
        var array = new doubleArray(values.Length);
        for (int i = 0; i < values.Length; i++) array.setitem(i, values[i]);
        return array;
    }

    static intArray Ints(params int[] values)
    {
        var array = new intArray(values.Length);
        for (int i = 0; i < values.Length; i++) array.setitem(i, values[i]);
        return array;
    }

    /// <summary>Corners 0.1 above and below their plane in turn.</summary>
    static readonly double[] square = { 0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1 };

    static SWIGTYPE_p_ShapeOpSolver Square()
    {
        var op = shapeopCSharp.shapeop_create();
        shapeopCSharp.shapeop_setPoints(op, Doubles(square).cast(), 4);
        return op;
    }

    static double[] PointsOf(SWIGTYPE_p_ShapeOpSolver op, int count)
    {
        var points = new doubleArray(3 * count);
        shapeopCSharp.shapeop_getPoints(op, points.cast(), count);
        return Enumerable.Range(0, 3 * count).Select(points.getitem).ToArray();
    }

    static void Arrays()
    {
        var array = Doubles(1, 2, 3);
        Check("an array starts with zeros", new doubleArray(2).getitem(1) == 0);
        Check("an array keeps what is set", array.getitem(0) == 1 && array.getitem(2) == 3, array.getitem(2));
        Check("an array ends where it ends", array.length() == 3 && new intArray(0).length() == 0, array.length());
        Raises<IndexOutOfRangeException>("an index at the end is refused", () => array.getitem(3), "3", "array of 3");
        Raises<IndexOutOfRangeException>("an index below 0 is refused", () => array.setitem(-1, 0), "-1");
        Raises<ArgumentOutOfRangeException>("a length below 0 is refused", () => new doubleArray(-1), "nelements");
        var disposed = new doubleArray(1);
        disposed.Dispose();
        disposed.Dispose();
        Raises<IndexOutOfRangeException>("a disposed array has no values", () => disposed.getitem(0), "null");
        Raises<ArgumentOutOfRangeException>("a disposed array has no length", () => disposed.length(), "null");
    }

    static void Arguments()
    {
        var op = Square();
        shapeopCSharp.shapeop_setPoints(op, null, 4);
        Refused("null points are refused", op, true, "points", "null");
        var disposed = new doubleArray(12);
        disposed.Dispose();
        shapeopCSharp.shapeop_setPoints(op, disposed, 4);
        Refused("a disposed array of points is refused", op, true, "points", "null");
        var notANumber = Doubles(square);
        notANumber.setitem(5, double.NaN);
        shapeopCSharp.shapeop_setPoints(op, notANumber, 4);
        Refused("points that are not numbers are refused", op, true, "points[1]", "finite");
        shapeopCSharp.shapeop_setPoints(op, Doubles(square), -4);
        Refused("a count below 0 is refused", op, true, "nb_points", "-4");
        Check("a refused call changes no point", PointsOf(op, 4).SequenceEqual(square));
        var room = new doubleArray(15);
        room.setitem(0, 7);
        shapeopCSharp.shapeop_getPoints(op, room, 5);
        Refused("points are not read with another count", op, room.getitem(0) == 7, "nb_points", "4", "5");

        Raises<ArgumentOutOfRangeException>("points that are fewer than said are refused",
            () => shapeopCSharp.shapeop_setPoints(op, new doubleArray(11), 4), "points", "12", "11");
        Raises<ArgumentOutOfRangeException>("room for fewer points than said is refused",
            () => shapeopCSharp.shapeop_getPoints(op, new doubleArray(11), 4), "points", "12", "11");
        Raises<ArgumentOutOfRangeException>("indices that are fewer than said are refused",
            () => shapeopCSharp.shapeop_addConstraint(op, "Plane", Ints(0, 1, 2), 4, 1), "ids", "4", "3");
        Raises<ArgumentOutOfRangeException>("scalars that are fewer than said are refused",
            () => shapeopCSharp.shapeop_editConstraint(op, "Closeness", 0, new doubleArray(2), 3), "scalars", "3", "2");
        Raises<ArgumentOutOfRangeException>("a force of two numbers is refused",
            () => shapeopCSharp.shapeop_addGravityForce(op, new doubleArray(2)), "force", "3", "2");
        Check("what was refused by its type changed nothing", PointsOf(op, 4).SequenceEqual(square));
        shapeopCSharp.shapeop_delete(op);
    }

    static void ConstraintsAndForces()
    {
        var op = Square();
        var plane = Ints(0, 1, 2, 3);
        Refused("an index beyond the points is refused", op,
            shapeopCSharp.shapeop_addConstraint(op, "Plane", Ints(0, 1, 99), 3, 1) == -1, "Plane", "99", "4 points");
        Refused("too few indices are refused", op,
            shapeopCSharp.shapeop_addConstraint(op, "Plane", plane, 2, 1) == -1, "Plane", "3", "2");
        Refused("an unknown type is refused with the known ones", op,
            shapeopCSharp.shapeop_addConstraint(op, "Plain", plane, 4, 1) == -1, "Plain", "EdgeStrain", "Plane");
        Refused("no type is refused", op, shapeopCSharp.shapeop_addConstraint(op, null, plane, 4, 1) == -1, "null");
        Refused("no indices are refused", op,
            shapeopCSharp.shapeop_addConstraint(op, "Plane", null, 4, 1) == -1, "ids", "null");
        Refused("a weight below 0 is refused", op,
            shapeopCSharp.shapeop_addConstraint(op, "Plane", plane, 4, -1) == -1, "weight");
        Accepted("the first accepted constraint has id 0", op,
            shapeopCSharp.shapeop_addConstraint(op, "Closeness", Ints(0), 1, 1) == 0);
        Accepted("the second has id 1", op, shapeopCSharp.shapeop_addConstraint(op, "Plane", plane, 4, 1) == 1);
        var target = Doubles(0, 0, 0.1);
        Refused("an id of no constraint is not edited", op,
            shapeopCSharp.shapeop_editConstraint(op, "Closeness", 7, target, 3)
                == shapeop_err.SO_UNMATCHING_CONSTRAINT_ID, "7");
        Refused("a wrong number of scalars is refused", op,
            shapeopCSharp.shapeop_editConstraint(op, "Closeness", 0, target, 2)
                == shapeop_err.SO_INVALID_ARGUMENT_LENGTH, "3", "2");
        Refused("a type without scalars is not edited", op,
            shapeopCSharp.shapeop_editConstraint(op, "Plane", 1, target, 3)
                == shapeop_err.SO_INVALID_CONSTRAINT_TYPE, "Plane");
        Refused("a force beyond the points is refused", op,
            shapeopCSharp.shapeop_addVertexForce(op, target, 9) == -1, "9", "4 points");
        Refused("no force is refused", op, shapeopCSharp.shapeop_addGravityForce(op, null) == -1, "force", "null");
        shapeopCSharp.shapeop_editVertexForce(op, 5, target, 0);
        Refused("a force that is none is not edited", op, true, "5");
        Refused("solving before init is refused", op, shapeopCSharp.shapeop_solve(op, 1) == 1, "init");
        Refused("masses below 0 are refused", op,
            shapeopCSharp.shapeop_initDynamic(op, -1, 1, 1) == 1, "masses", "-1");
        shapeopCSharp.shapeop_delete(op);
    }

    static void Solvers()
    {
        var op = Square();
        var other = Square();
        shapeopCSharp.shapeop_delete(op);
        Accepted("a solver is deleted", op);
        Refused("a deleted solver does not solve", op, shapeopCSharp.shapeop_solve(op, 1) == 1, "deleted");
        shapeopCSharp.shapeop_delete(op);
        Refused("a solver is deleted once", op, true, "deleted");
        Refused("null is no solver", null, shapeopCSharp.shapeop_init(null) == 1, "null");
        // Along z each corner minimises w (z - h)^2 + z^2 with w = 1/4 and h its height: z = h / 5.
        for (int i = 0; i < 4; i++) shapeopCSharp.shapeop_addConstraint(other, "Closeness", Ints(i), 1, 0.25);
        shapeopCSharp.shapeop_addConstraint(other, "Plane", Ints(0, 1, 2, 3), 4, 1);
        Accepted("another solver is initialised", other, shapeopCSharp.shapeop_init(other) == 0);
        Accepted("and solves", other, shapeopCSharp.shapeop_solve(other, 1) == 0);
        var found = PointsOf(other, 4);
        Check("and finds what it should",
            Enumerable.Range(0, 12).All(i => Math.Abs(found[i] - (i % 3 == 2 ? square[i] / 5 : square[i])) < 1e-12));
        shapeopCSharp.shapeop_delete(other);
    }

    static SWIGTYPE_p_ShapeOpSolver Grid(int size)
    {
        int count = size * size;
        var points = Enumerable.Range(0, count).SelectMany(i => new double[] { i % size, i / size, i * 7 % 3 });
        var op = shapeopCSharp.shapeop_create();
        shapeopCSharp.shapeop_setPoints(op, Doubles(points.ToArray()), count);
        for (int i = 0; i < count - size; i++)
        {
            shapeopCSharp.shapeop_addConstraint(op, "EdgeStrain", Ints(i, i + size), 2, 1);
        }
        shapeopCSharp.shapeop_addConstraint(op, "Closeness", Ints(0), 1, 1);
        shapeopCSharp.shapeop_init(op);
        return op;
    }

    static void Threads()
    {
        var op = Grid(60);
        string result = null;
        var thread = new Thread(() =>
        {
            // A call of the other thread may be in the way of the first try.
            do
            {
                shapeopCSharp.shapeop_solve(op, 5000);
                result = shapeopCSharp.shapeop_lastError(op);
            } while (result.Contains("busy"));
        });
        thread.Start();
        do
        {
            shapeopCSharp.shapeop_setDamping(op, 1);
        } while (thread.IsAlive && shapeopCSharp.shapeop_lastError(op) == "");
        Refused("a solver in use by another thread is busy", op, true, "busy");
        shapeopCSharp.shapeop_delete(op);
        Refused("a busy solver is not deleted", op, true, "busy");
        thread.Join();
        Check("the thread's own call succeeded", result == "", result);
        Accepted("the solver can be used again", op, shapeopCSharp.shapeop_solve(op, 1) == 0);
        shapeopCSharp.shapeop_delete(op);
    }

    static void Texts()
    {
        int number = (int)shapeop_err.SO_INDEX_OUT_OF_RANGE;
        Check("an error code has its number and a text",
            number == 17 && shapeopCSharp.shapeop_errorText(number).Contains("out of range"), number);
        Check("what is no error code says so", shapeopCSharp.shapeop_errorText(999).Contains("not an error code"));
        string version = shapeopCSharp.shapeop_version();
        Check("the library has a version", version.Split('.').Length == 3, version);
    }

    static void Exploring()
    {
        // With closeness alone a plane that is met exactly is the best-fit plane: z = 0.
        var op = Square();
        int plane = shapeopCSharp.shapeop_addConstraint(op, "Plane", Ints(0, 1, 2, 3), 4, 1);
        Accepted("a constraint is made hard", op, shapeopCSharp.shapeop_setHard(op, plane, 1) == shapeop_err.SO_SUCCESS);
        var objective = new shapeop_objective();
        Check("an objective begins with the defaults", objective.handle_weight == 100, objective.handle_weight);
        objective.fairness_weight = 0;
        shapeopCSharp.shapeop_setObjective(op, objective);
        shapeopCSharp.shapeop_init(op);
        var report = new shapeop_solve_report();
        shapeop_err error = shapeopCSharp.shapeop_solveUntil(op, new shapeop_solve_options(), report);
        Accepted("it solves", op, error == shapeop_err.SO_SUCCESS);
        Check("and converges", report.outcome == shapeop_outcome.SO_OUTCOME_CONVERGED, report.outcome);
        double[] found = PointsOf(op, 4);
        bool isThere = found.Select((x, i) => Math.Abs(x - (i % 3 == 2 ? 0 : square[i]))).All(apart => apart < 1e-11);
        Check("a hard plane with closeness alone is the best-fit plane", isThere, string.Join(" ", found));
        var exploration = new shapeop_exploration();
        shapeopCSharp.shapeop_getExploration(op, exploration);
        Check("it is a solution", exploration.is_solution == 1 && exploration.worst_constraint == plane);
        Check("there is no contradiction", shapeopCSharp.shapeop_getConflicts(op, null, 0) == 0);
        Check("weights have names", shapeopCSharp.shapeop_weightClassName(op, 1) == "closeness");
        var squares = new doubleArray(9);
        error = shapeopCSharp.shapeop_getSensitivities(op, new doubleArray(36), 4, squares, 3);
        Accepted("sensitivities are told", op, error == shapeop_err.SO_SUCCESS);
        Raises<ArgumentOutOfRangeException>(
            "room for fewer moves than there are is refused",
            () => shapeopCSharp.shapeop_getSensitivities(op, new doubleArray(35), 4, squares, 3), "points", "36", "35");
        Raises<ArgumentOutOfRangeException>(
            "a target of two numbers is refused", () => shapeopCSharp.shapeop_setHandle(op, 0, new doubleArray(2)),
            "target", "3", "2");
        error = shapeopCSharp.shapeop_releaseHandle(op, 0);
        Refused("what is no handle is not let go", op, error == shapeop_err.SO_INVALID_VALUE, "point 0 is no handle");
        int mesh = shapeopCSharp.shapeop_addReferenceMesh(op, Doubles(square), 4, Ints(0, 1, 2), 1);
        Check("a reference has an id", mesh == 0 && shapeopCSharp.shapeop_referenceCount(op) == 1, mesh);
        Raises<ArgumentOutOfRangeException>(
            "indices that are fewer than said are no triangles",
            () => shapeopCSharp.shapeop_addReferenceMesh(op, Doubles(square), 4, Ints(0, 1, 2), 2), "triangles", "6", "3");
        int pressure = shapeopCSharp.shapeop_addPressure(op, Ints(0, 1, 2, 3), 4, Ints(4), 1, 1);
        error = shapeopCSharp.shapeop_editForceMagnitude(op, pressure, 2);
        Accepted("a pressure is edited", op, error == shapeop_err.SO_SUCCESS);
        shapeopCSharp.shapeop_delete(op);
    }

    public static int Main()
    {
        Arrays();
        Arguments();
        ConstraintsAndForces();
        Solvers();
        Exploring();
        Threads();
        Texts();
        Console.WriteLine(passed + " passed, " + failed + " failed");
        return failed > 0 ? 1 : 0;
    }
}
