import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.Callable;
import java.util.concurrent.atomic.AtomicBoolean;

/** Mistakes through the SWIG classes: each is refused with its reason, and the program goes on. Ends with 1 if not. */
public class Mistakes {
    static int passed = 0;
    static int failed = 0;

    static void check(String truth, boolean isTrue, Object found) {
        if (isTrue) passed++;
        else failed++;
        System.out.println(isTrue ? "ok    " + truth : "WRONG " + truth + ": found " + found);
    }

    static boolean hasAll(String text, String... words) {
        for (String word : words) {
            if (!text.contains(word)) return false;
        }
        return true;
    }

    /** The call just made on `op` was refused, and the message has all the words. */
    static void refused(String truth, SWIGTYPE_p_ShapeOpSolver op, boolean isRefused, String... words) {
        String message = shapeopJava.shapeop_lastError(op);
        check(truth, isRefused && hasAll(message, words), message);
    }

    static void accepted(String truth, SWIGTYPE_p_ShapeOpSolver op, boolean isAccepted) {
        String message = shapeopJava.shapeop_lastError(op);
        check(truth, isAccepted && message.isEmpty(), message);
    }

    static void raises(String truth, Class<?> kind, Callable<?> call, String... words) {
        try {
            check(truth, false, call.call());
        } catch (Exception exception) {
            check(truth, kind.isInstance(exception) && hasAll(exception.getMessage(), words), exception);
        }
    }

    static doubleArray doubles(double... values) {
        doubleArray array = new doubleArray(values.length);
        for (int i = 0; i < values.length; i++) array.setitem(i, values[i]);
        return array;
    }

    static intArray ints(int... values) {
        intArray array = new intArray(values.length);
        for (int i = 0; i < values.length; i++) array.setitem(i, values[i]);
        return array;
    }

    /** Corners 0.1 above and below their plane in turn. */
    static final double[] SQUARE = {0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1};

    static SWIGTYPE_p_ShapeOpSolver square() {
        SWIGTYPE_p_ShapeOpSolver op = shapeopJava.shapeop_create();
        shapeopJava.shapeop_setPoints(op, doubles(SQUARE).cast(), 4);
        return op;
    }

    /** Whether the points are these, within `tolerance`. */
    static boolean areAt(SWIGTYPE_p_ShapeOpSolver op, double[] expected, double tolerance) {
        doubleArray points = new doubleArray(expected.length);
        shapeopJava.shapeop_getPoints(op, points.cast(), expected.length / 3);
        for (int i = 0; i < expected.length; i++) {
            if (!(Math.abs(points.getitem(i) - expected[i]) <= tolerance)) return false;
        }
        return true;
    }

    static void arrays() {
        doubleArray array = doubles(1, 2, 3);
        check("an array starts with zeros", new doubleArray(2).getitem(1) == 0, null);
        check("an array keeps what is set", array.getitem(0) == 1 && array.getitem(2) == 3, array.getitem(2));
        check("an array ends where it ends", array.length() == 3 && new intArray(0).length() == 0, array.length());
        raises("an index at the end is refused", IndexOutOfBoundsException.class, () -> array.getitem(3), "3",
            "array of 3");
        raises("an index below 0 is refused", IndexOutOfBoundsException.class, () -> {
            array.setitem(-1, 0);
            return null;
        }, "-1");
        raises("a length below 0 is refused", IllegalArgumentException.class, () -> new doubleArray(-1), "nelements");
        doubleArray deleted = new doubleArray(1);
        deleted.delete();
        deleted.delete();
        raises("a deleted array has no values", IndexOutOfBoundsException.class, () -> deleted.getitem(0), "null");
        raises("a deleted array has no length", IllegalArgumentException.class, deleted::length, "null");
    }

    static void arguments() {
        SWIGTYPE_p_ShapeOpSolver op = square();
        shapeopJava.shapeop_setPoints(op, null, 4);
        refused("null points are refused", op, true, "points", "null");
        doubleArray deleted = new doubleArray(12);
        deleted.delete();
        shapeopJava.shapeop_setPoints(op, deleted, 4);
        refused("a deleted array of points is refused", op, true, "points", "null");
        doubleArray notANumber = doubles(SQUARE);
        notANumber.setitem(5, Double.NaN);
        shapeopJava.shapeop_setPoints(op, notANumber, 4);
        refused("points that are not numbers are refused", op, true, "points[1]", "finite");
        shapeopJava.shapeop_setPoints(op, doubles(SQUARE), -4);
        refused("a count below 0 is refused", op, true, "nb_points", "-4");
        check("a refused call changes no point", areAt(op, SQUARE, 0), null);
        doubleArray out = new doubleArray(15);
        out.setitem(0, 7);
        shapeopJava.shapeop_getPoints(op, out, 5);
        refused("points are not read with another count", op, out.getitem(0) == 7, "nb_points", "4", "5");

        raises("points that are fewer than said are refused", IllegalArgumentException.class, () -> {
            shapeopJava.shapeop_setPoints(op, new doubleArray(11), 4);
            return null;
        }, "points", "12", "11");
        raises("room for fewer points than said is refused", IllegalArgumentException.class, () -> {
            shapeopJava.shapeop_getPoints(op, new doubleArray(11), 4);
            return null;
        }, "points", "12", "11");
        raises("indices that are fewer than said are refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_addConstraint(op, "Plane", ints(0, 1, 2), 4, 1), "ids", "4", "3");
        raises("scalars that are fewer than said are refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_editConstraint(op, "Closeness", 0, new doubleArray(2), 3), "scalars", "3", "2");
        raises("a force of two numbers is refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_addGravityForce(op, new doubleArray(2)), "force", "3", "2");
        raises("iterations below 0 are refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_solve(op, -1), "iteration");
        raises("more iterations than a C unsigned int holds are refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_solve(op, 1L << 32), "iteration");
        check("what was refused by its type changed nothing", areAt(op, SQUARE, 0), null);
        shapeopJava.shapeop_delete(op);
    }

    static void constraintsAndForces() {
        SWIGTYPE_p_ShapeOpSolver op = square();
        intArray plane = ints(0, 1, 2, 3);
        refused("an index beyond the points is refused", op,
            shapeopJava.shapeop_addConstraint(op, "Plane", ints(0, 1, 99), 3, 1) == -1, "Plane", "99", "4 points");
        refused("too few indices are refused", op,
            shapeopJava.shapeop_addConstraint(op, "Plane", plane, 2, 1) == -1, "Plane", "3", "2");
        refused("an unknown type is refused with the known ones", op,
            shapeopJava.shapeop_addConstraint(op, "Plain", plane, 4, 1) == -1, "Plain", "EdgeStrain", "Plane");
        refused("no type is refused", op, shapeopJava.shapeop_addConstraint(op, null, plane, 4, 1) == -1, "null");
        refused("no indices are refused", op,
            shapeopJava.shapeop_addConstraint(op, "Plane", null, 4, 1) == -1, "ids", "null");
        refused("a weight below 0 is refused", op,
            shapeopJava.shapeop_addConstraint(op, "Plane", plane, 4, -1) == -1, "weight");
        refused("a name beyond ASCII comes back as it is", op,
            shapeopJava.shapeop_addConstraint(op, "Fl\u00e4che", plane, 4, 1) == -1, "Fl\u00e4che");
        refused("a name beyond the basic plane is refused", op,
            shapeopJava.shapeop_addConstraint(op, "\ud83d\ude00", plane, 4, 1) == -1, "is not one of");
        accepted("the first accepted constraint has id 0", op,
            shapeopJava.shapeop_addConstraint(op, "Closeness", ints(0), 1, 1) == 0);
        accepted("the second has id 1", op, shapeopJava.shapeop_addConstraint(op, "Plane", plane, 4, 1) == 1);
        doubleArray target = doubles(0, 0, 0.1);
        refused("an id of no constraint is not edited", op,
            shapeopJava.shapeop_editConstraint(op, "Closeness", 7, target, 3)
                == shapeop_err.SO_UNMATCHING_CONSTRAINT_ID, "7");
        refused("a wrong number of scalars is refused", op,
            shapeopJava.shapeop_editConstraint(op, "Closeness", 0, target, 2)
                == shapeop_err.SO_INVALID_ARGUMENT_LENGTH, "3", "2");
        refused("a type without scalars is not edited", op,
            shapeopJava.shapeop_editConstraint(op, "Plane", 1, target, 3)
                == shapeop_err.SO_INVALID_CONSTRAINT_TYPE, "Plane");
        refused("a force beyond the points is refused", op,
            shapeopJava.shapeop_addVertexForce(op, target, 9) == -1, "9", "4 points");
        refused("no force is refused", op, shapeopJava.shapeop_addGravityForce(op, null) == -1, "force", "null");
        shapeopJava.shapeop_editVertexForce(op, 5, target, 0);
        refused("a force that is none is not edited", op, true, "5");
        refused("solving before init is refused", op, shapeopJava.shapeop_solve(op, 1) == 1, "init");
        refused("masses below 0 are refused", op,
            shapeopJava.shapeop_initDynamic(op, -1, 1, 1) == 1, "masses", "-1");
        shapeopJava.shapeop_delete(op);
    }

    static void solvers() {
        SWIGTYPE_p_ShapeOpSolver op = square();
        SWIGTYPE_p_ShapeOpSolver other = square();
        shapeopJava.shapeop_delete(op);
        accepted("a solver is deleted", op, true);
        refused("a deleted solver does not solve", op, shapeopJava.shapeop_solve(op, 1) == 1, "deleted");
        shapeopJava.shapeop_delete(op);
        refused("a solver is deleted once", op, true, "deleted");
        refused("null is no solver", null, shapeopJava.shapeop_init(null) == 1, "null");
        // Along z each corner minimises w (z - h)^2 + z^2 with w = 1/4 and h its height: z = h / 5.
        double[] expected = SQUARE.clone();
        for (int i = 0; i < 4; i++) {
            shapeopJava.shapeop_addConstraint(other, "Closeness", ints(i), 1, 0.25);
            expected[3 * i + 2] /= 5;
        }
        shapeopJava.shapeop_addConstraint(other, "Plane", ints(0, 1, 2, 3), 4, 1);
        accepted("another solver is initialised", other, shapeopJava.shapeop_init(other) == 0);
        accepted("and solves", other, shapeopJava.shapeop_solve(other, 1) == 0);
        check("and finds what it should", areAt(other, expected, 1e-12), null);
        shapeopJava.shapeop_delete(other);
    }

    static SWIGTYPE_p_ShapeOpSolver grid(int size) {
        double[] points = new double[3 * size * size];
        for (int point = 0; point < size * size; point++) {
            points[3 * point] = point % size;
            points[3 * point + 1] = point / size;
            points[3 * point + 2] = point * 7 % 3;
        }
        SWIGTYPE_p_ShapeOpSolver op = shapeopJava.shapeop_create();
        shapeopJava.shapeop_setPoints(op, doubles(points), size * size);
        for (int point = 0; point < size * size - size; point++) {
            shapeopJava.shapeop_addConstraint(op, "EdgeStrain", ints(point, point + size), 2, 1);
        }
        shapeopJava.shapeop_addConstraint(op, "Closeness", ints(0), 1, 1);
        shapeopJava.shapeop_init(op);
        return op;
    }

    static void threads() throws InterruptedException {
        SWIGTYPE_p_ShapeOpSolver op = grid(60);
        List<String> results = new ArrayList<>();
        Thread thread = new Thread(() -> {
            // A call of the other thread may be in the way of the first try.
            while (shapeopJava.shapeop_solve(op, 5000) != 0 && shapeopJava.shapeop_lastError(op).contains("busy")) {
            }
            results.add(shapeopJava.shapeop_lastError(op));
        });
        thread.start();
        do {
            shapeopJava.shapeop_setDamping(op, 1);
        } while (thread.isAlive() && shapeopJava.shapeop_lastError(op).isEmpty());
        refused("a solver in use by another thread is busy", op, true, "busy");
        shapeopJava.shapeop_delete(op);
        refused("a busy solver is not deleted", op, true, "busy");
        thread.join();
        check("the thread's own call succeeded", results.equals(List.of("")), results);
        accepted("the solver can be used again", op, shapeopJava.shapeop_solve(op, 1) == 0);
        shapeopJava.shapeop_delete(op);
    }

    static void collections() throws InterruptedException {
        SWIGTYPE_p_ShapeOpSolver op = shapeopJava.shapeop_create();
        AtomicBoolean isDone = new AtomicBoolean();
        Thread collector = new Thread(() -> {
            while (!isDone.get()) {
                System.gc();
                System.runFinalization();
            }
        });
        collector.start();
        // Large, so that a collection falls into the call. It can only fail in compiled code (java -Xcomp): interpreted
        // code holds on to what it no longer needs.
        int pointCount = 3_000_000;
        int refusedCount = 0;
        for (int i = 0; i < 40; i++) {
            shapeopJava.shapeop_setPoints(op, new doubleArray(3 * pointCount).cast(), pointCount);
            if (!shapeopJava.shapeop_lastError(op).isEmpty()) refusedCount++;
        }
        isDone.set(true);
        collector.join();
        check("an array that nothing else holds outlives its call", refusedCount == 0, refusedCount);
        shapeopJava.shapeop_delete(op);
    }

    static void texts() {
        int number = shapeop_err.SO_INDEX_OUT_OF_RANGE.swigValue();
        check("an error code has its number and a text",
            number == 17 && shapeopJava.shapeop_errorText(number).contains("out of range"), number);
        check("what is no error code says so", shapeopJava.shapeop_errorText(999).contains("not an error code"), null);
        check("the library has a version", shapeopJava.shapeop_version().matches("\\d+\\.\\d+\\.\\d+.*"),
            shapeopJava.shapeop_version());
    }

    static void exploring() {
        // With closeness alone a plane that is met exactly is the best-fit plane: z = 0.
        SWIGTYPE_p_ShapeOpSolver op = square();
        int plane = shapeopJava.shapeop_addConstraint(op, "Plane", ints(0, 1, 2, 3), 4, 1);
        accepted("a constraint is made hard", op, shapeopJava.shapeop_setHard(op, plane, 1) == shapeop_err.SO_SUCCESS);
        shapeop_objective objective = new shapeop_objective();
        check("an objective begins with the defaults", objective.getHandle_weight() == 100, objective.getHandle_weight());
        objective.setFairness_weight(0);
        shapeopJava.shapeop_setObjective(op, objective);
        shapeopJava.shapeop_init(op);
        shapeop_solve_report report = new shapeop_solve_report();
        shapeop_solve_options options = new shapeop_solve_options();
        raises("iterations at most below 0 are refused", IllegalArgumentException.class, () -> {
            options.setMax_iterations(-1);
            return null;
        }, "max_iterations");
        accepted("it solves", op, shapeopJava.shapeop_solveUntil(op, options, report) == shapeop_err.SO_SUCCESS);
        check("and converges", report.getOutcome() == shapeop_outcome.SO_OUTCOME_CONVERGED, report.getOutcome());
        double[] flat = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        check("a hard plane with closeness alone is the best-fit plane", areAt(op, flat, 1e-11), null);
        shapeop_exploration found = new shapeop_exploration();
        shapeopJava.shapeop_getExploration(op, found);
        check("it is a solution", found.getIs_solution() == 1 && found.getWorst_constraint() == plane, null);
        check("there is no contradiction", shapeopJava.shapeop_getConflicts(op, null, 0) == 0, null);
        check("weights have names", shapeopJava.shapeop_weightClassName(op, 1).equals("closeness"), null);
        doubleArray squares = new doubleArray(9);
        accepted("sensitivities are told", op,
            shapeopJava.shapeop_getSensitivities(op, new doubleArray(36), 4, squares, 3) == shapeop_err.SO_SUCCESS);
        raises("room for fewer moves than there are is refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_getSensitivities(op, new doubleArray(35), 4, squares, 3), "points", "36", "35");
        raises("a target of two numbers is refused", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_setHandle(op, 0, new doubleArray(2)), "target", "3", "2");
        refused("what is no handle is not let go", op,
            shapeopJava.shapeop_releaseHandle(op, 0) == shapeop_err.SO_INVALID_VALUE, "point 0 is no handle");
        int mesh = shapeopJava.shapeop_addReferenceMesh(op, doubles(SQUARE), 4, ints(0, 1, 2), 1);
        check("a reference has an id", mesh == 0 && shapeopJava.shapeop_referenceCount(op) == 1, mesh);
        raises("indices that are fewer than said are no triangles", IllegalArgumentException.class,
            () -> shapeopJava.shapeop_addReferenceMesh(op, doubles(SQUARE), 4, ints(0, 1, 2), 2), "triangles", "6", "3");
        int pressure = shapeopJava.shapeop_addPressure(op, ints(0, 1, 2, 3), 4, ints(4), 1, 1);
        accepted("a pressure is edited", op,
            shapeopJava.shapeop_editForceMagnitude(op, pressure, 2) == shapeop_err.SO_SUCCESS);
        shapeopJava.shapeop_delete(op);
    }

    public static void main(String[] unused) throws InterruptedException {
        arrays();
        arguments();
        constraintsAndForces();
        solvers();
        exploring();
        threads();
        collections();
        texts();
        System.out.println(passed + " passed, " + failed + " failed");
        System.exit(failed > 0 ? 1 : 0);
    }
}
