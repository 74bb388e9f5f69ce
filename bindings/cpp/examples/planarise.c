/* Planarises the faces of a mesh: planarise in.obj out.obj
 *
 * The whole way from C: points and constraints in, iterations with a stopping rule, points and a report out. Every call
 * that can be refused is looked at; shapeop_lastError says why in words. */
#include <shapeop.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Faces are point indices behind each other; counts says how many belong to each: the library takes them so. */
typedef struct Mesh {
    double *points;
    int *corners, *counts;
    int point_count, corner_count, face_count;
} Mesh;

static void fail(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(EXIT_FAILURE);
}

/* Makes room for one more entry behind `count`: the room is doubled at each power of two. */
static void *grow(void *array, int count, size_t size) {
    if ((count & (count - 1)) == 0) {
        array = realloc(array, (size_t)(count > 0 ? 2 * count : 1) * size);
        if (array == NULL) {
            fail("mesh", "out of memory");
        }
    }
    return array;
}

/* Reads the lines "v x y z" and "f i j k ..." (or "f i/t/n ..."), which count points from 1. */
static Mesh read_obj(const char *path) {
    Mesh mesh = {NULL, NULL, NULL, 0, 0, 0};
    char line[4096], *word;
    double x, y, z;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        fail(path, "cannot be read");
    }
    while (fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "v %lf %lf %lf", &x, &y, &z) == 3) {
            mesh.points = grow(mesh.points, mesh.point_count, 3 * sizeof(double));
            mesh.points[3 * mesh.point_count] = x;
            mesh.points[3 * mesh.point_count + 1] = y;
            mesh.points[3 * mesh.point_count + 2] = z;
            mesh.point_count++;
        } else if (strncmp(line, "f ", 2) == 0) {
            mesh.counts = grow(mesh.counts, mesh.face_count, sizeof(int));
            mesh.counts[mesh.face_count] = 0;
            for (word = strtok(line + 2, " \t\r\n"); word != NULL; word = strtok(NULL, " \t\r\n")) {
                mesh.corners = grow(mesh.corners, mesh.corner_count, sizeof(int));
                mesh.corners[mesh.corner_count++] = atoi(word) - 1;
                mesh.counts[mesh.face_count]++;
            }
            mesh.face_count++;
        }
    }
    fclose(file);
    return mesh;
}

static void write_obj(const char *path, const Mesh *mesh) {
    int i, j, corner = 0;
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        fail(path, "cannot be written");
    }
    for (i = 0; i < mesh->point_count; ++i) {
        const double *p = mesh->points + 3 * i;
        fprintf(file, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    }
    for (i = 0; i < mesh->face_count; ++i) {
        fprintf(file, "f");
        for (j = 0; j < mesh->counts[i]; ++j) {
            fprintf(file, " %d", mesh->corners[corner++] + 1);
        }
        fprintf(file, "\n");
    }
    if (fclose(file) != 0) {
        fail(path, "cannot be written");
    }
}

/* The greatest distance of a corner from the plane of its face. Violations come one per constraint, in the order in
 * which they were added: those of the faces are first. */
static double worst_face(ShapeOpSolver *op, const Mesh *mesh) {
    const int count = shapeop_constraintCount(op);
    double *violations = malloc((size_t)count * sizeof(double)), worst = 0;
    int i;
    if (violations == NULL || shapeop_getViolations(op, violations, count) != SO_SUCCESS) {
        fail("violations", shapeop_lastError(op));
    }
    for (i = 0; i < mesh->face_count; ++i) {
        worst = violations[i] > worst ? violations[i] : worst;
    }
    free(violations);
    return worst;
}

/* Called after every iteration. Returning anything but 0 would end the solve. */
static int show_progress(const shapeop_progress *progress, void *user) {
    (void)user;
    if (progress->iteration % 50 == 0) {
        printf("iteration %u: energy %g\n", progress->iteration, progress->energy);
    }
    return 0;
}

int main(int argc, char **argv) {
    const double face_weight = 1.0, closeness_weight = 0.001;
    const int one = 1;
    Mesh mesh;
    ShapeOpSolver *op;
    shapeop_solve_options options;
    shapeop_solve_report report;
    double before, after;
    int i, *every_point;

    if (argc != 3) {
        fail("usage", "planarise in.obj out.obj");
    }
    mesh = read_obj(argv[1]);

    op = shapeop_create();
    if (op == NULL) {
        fail("create", shapeop_lastError(NULL));
    }
    shapeop_setPoints(op, mesh.points, mesh.point_count);
    if (*shapeop_lastError(op) != '\0') { /* how a function without a result says that it refused */
        fail("points", shapeop_lastError(op));
    }

    /* Each face wants to be planar: one call for all of them. */
    if (shapeop_addConstraints(op, "Plane", mesh.corners, mesh.corner_count, mesh.counts, mesh.face_count, &face_weight,
                               1, NULL, 0, 0, 0, NULL) != SO_SUCCESS) {
        fail("faces", shapeop_lastError(op));
    }

    /* Each point wants, a thousand times less, to stay where it is: without that a mesh may collapse. */
    every_point = malloc((size_t)mesh.point_count * sizeof(int));
    if (every_point == NULL) {
        fail("mesh", "out of memory");
    }
    for (i = 0; i < mesh.point_count; ++i) {
        every_point[i] = i;
    }
    if (shapeop_addConstraints(op, "Closeness", every_point, mesh.point_count, &one, 1, &closeness_weight, 1, NULL, 0,
                               0, 0, NULL) != SO_SUCCESS) {
        fail("closeness", shapeop_lastError(op));
    }
    free(every_point);

    /* Structs say their size first, so that this program runs with later versions of the library too. */
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    if (shapeop_defaultSolveOptions(&options) != SO_SUCCESS) {
        fail("options", shapeop_lastError(NULL));
    }
    options.max_iterations = 500;

    before = worst_face(op, &mesh);
    if (shapeop_init(op) != 0 || shapeop_solveUntil(op, &options, show_progress, NULL, &report) != SO_SUCCESS) {
        fail("solve", shapeop_lastError(op));
    }
    after = worst_face(op, &mesh);
    printf("%s after %u iterations; the worst face is %g out of plane, was %g\n",
           report.outcome == SO_OUTCOME_CONVERGED ? "converged" : "stopped", report.iterations, after, before);

    shapeop_getPoints(op, mesh.points, mesh.point_count);
    shapeop_delete(op);
    write_obj(argv[2], &mesh);
    free(mesh.points);
    free(mesh.corners);
    free(mesh.counts);
    return EXIT_SUCCESS;
}
