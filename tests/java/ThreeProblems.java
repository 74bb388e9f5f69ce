import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.List;

/** Three problems (tests/languages/README.md) through the SWIG classes: ThreeProblems MESH FOLDER. */
public class ThreeProblems {
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

    static void check(SWIGTYPE_p_ShapeOpSolver op, boolean isDone) {
        if (!isDone) throw new IllegalStateException(shapeopJava.shapeop_lastError(op));
    }

    static SWIGTYPE_p_ShapeOpSolver start(double... points) {
        SWIGTYPE_p_ShapeOpSolver op = shapeopJava.shapeop_create();
        shapeopJava.shapeop_setPoints(op, doubles(points).cast(), points.length / 3);
        check(op, shapeopJava.shapeop_lastError(op).isEmpty());
        return op;
    }

    static int add(SWIGTYPE_p_ShapeOpSolver op, String type, double weight, int... ids) {
        int constraint = shapeopJava.shapeop_addConstraint(op, type, ints(ids).cast(), ids.length, weight);
        check(op, constraint >= 0);
        return constraint;
    }

    static void edit(SWIGTYPE_p_ShapeOpSolver op, String type, int constraint, double... scalars) {
        shapeop_err error =
            shapeopJava.shapeop_editConstraint(op, type, constraint, doubles(scalars).cast(), scalars.length);
        check(op, error == shapeop_err.SO_SUCCESS);
    }

    static void solve(SWIGTYPE_p_ShapeOpSolver op, int iterations) {
        check(op, shapeopJava.shapeop_solve(op, iterations) == 0);
    }

    /** Writes the points and deletes the solver. */
    static void finish(SWIGTYPE_p_ShapeOpSolver op, int pointCount, Path path) throws IOException {
        doubleArray points = new doubleArray(3 * pointCount);
        shapeopJava.shapeop_getPoints(op, points.cast(), pointCount);
        check(op, shapeopJava.shapeop_lastError(op).isEmpty());
        List<String> lines = new ArrayList<>();
        for (int i = 0; i < 3 * pointCount; i += 3) {
            lines.add(points.getitem(i) + " " + points.getitem(i + 1) + " " + points.getitem(i + 2));
        }
        Files.write(path, lines);
        shapeopJava.shapeop_delete(op);
    }

    static void quad(Path path) throws IOException {
        SWIGTYPE_p_ShapeOpSolver op = start(0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1);
        add(op, "Plane", 1, 0, 1, 2, 3);
        int rigid = add(op, "Rigid", 2, 0, 1, 2, 3);
        edit(op, "Rigid", rigid, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0);
        int closeness = add(op, "Closeness", 0.5, 0);
        edit(op, "Closeness", closeness, 0, 0, 0.2);
        check(op, shapeopJava.shapeop_init(op) == 0);
        solve(op, 25);
        finish(op, 4, path);
    }

    static void planarise(Path mesh, Path path) throws IOException {
        List<Double> points = new ArrayList<>();
        List<int[]> faces = new ArrayList<>();
        for (String line : Files.readAllLines(mesh)) {
            String[] words = line.trim().split("\\s+");
            if (words[0].equals("v")) {
                for (int i = 1; i <= 3; i++) points.add(Double.parseDouble(words[i]));
            } else if (words[0].equals("f")) {
                int[] face = new int[words.length - 1];
                for (int i = 0; i < face.length; i++) face[i] = Integer.parseInt(words[i + 1]) - 1;
                faces.add(face);
            }
        }
        int pointCount = points.size() / 3;
        SWIGTYPE_p_ShapeOpSolver op = start(points.stream().mapToDouble(Double::doubleValue).toArray());
        for (int[] face : faces) add(op, "Plane", 1, face);
        for (int i = 0; i < pointCount; i++) add(op, "Closeness", 0.05, i);
        check(op, shapeopJava.shapeop_init(op) == 0);
        solve(op, 100);
        finish(op, pointCount, path);
    }

    static void addEdge(SWIGTYPE_p_ShapeOpSolver op, int from, int to) {
        edit(op, "EdgeStrain", add(op, "EdgeStrain", 10, from, to), 1, 0.9, 1.1);
    }

    static void cloth(Path path) throws IOException {
        int size = 20;
        double[] points = new double[3 * size * size];
        for (int point = 0; point < size * size; point++) {
            points[3 * point] = point % size;
            points[3 * point + 1] = point / size;
        }
        SWIGTYPE_p_ShapeOpSolver op = start(points);
        for (int j = 0; j < size; j++) {
            for (int i = 0; i < size; i++) {
                int point = size * j + i;
                if (i < size - 1) addEdge(op, point, point + 1);
                if (j < size - 1) addEdge(op, point, point + size);
            }
        }
        add(op, "Closeness", 1000, 0);
        add(op, "Closeness", 1000, 19);
        int corner = add(op, "Closeness", 1000, 399);
        check(op, shapeopJava.shapeop_addGravityForce(op, doubles(0, 0, -1).cast()) >= 0);
        int pull = shapeopJava.shapeop_addVertexForce(op, doubles(0.5, 0, 2).cast(), 380);
        check(op, pull >= 0);
        check(op, shapeopJava.shapeop_initDynamic(op, 1, 0.95, 0.1) == 0);
        for (int step = 1; step <= 60; step++) {
            if (step == 11) edit(op, "Closeness", corner, 14, 14, 5);
            if (step == 31) {
                shapeopJava.shapeop_editVertexForce(op, pull, doubles(0, 0.5, -1).cast(), 380);
                check(op, shapeopJava.shapeop_lastError(op).isEmpty());
            }
            solve(op, 5);
        }
        finish(op, size * size, path);
    }

    public static void main(String[] arguments) throws IOException {
        if (arguments.length != 2) {
            System.err.println("usage: ThreeProblems MESH FOLDER");
            System.exit(2);
        }
        Path folder = Path.of(arguments[1]);
        quad(folder.resolve("quad.txt"));
        planarise(Path.of(arguments[0]), folder.resolve("planarise.txt"));
        cloth(folder.resolve("cloth.txt"));
    }
}
