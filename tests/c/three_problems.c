/* Solves the three problems of tests/languages/README.md: three_problems mesh.obj folder */
#include "shapeop.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 20, CLOTH_POINTS = SIDE * SIDE, CLOTH_EDGES = 2 * SIDE * (SIDE - 1) };

static void fail(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(EXIT_FAILURE);
}

/* Ends the program if the last call on `op` was refused, whatever kind of function it was. */
static void check(ShapeOpSolver *op, const char *what) {
    if (*shapeop_lastError(op) != '\0') {
        fail(what, shapeop_lastError(op));
    }
}

static ShapeOpSolver *create(double *points, int count) {
    ShapeOpSolver *op = shapeop_create();
    if (op == NULL) {
        fail("create", shapeop_lastError(NULL));
    }
    shapeop_setPoints(op, points, count);
    check(op, "points");
    return op;
}

/* Adds constraints of `size` points each, of one weight, with one set of scalars or none. */
static void add(ShapeOpSolver *op, const char *type, const int *ids, int nb_ids, int size, double weight,
                const double *scalars, int nb_scalars) {
    shapeop_addConstraints(op, type, ids, nb_ids, &size, 1, &weight, 1, scalars, nb_scalars, nb_scalars > 0, 0, NULL);
    check(op, type);
}

/* Writes the points and deletes the solver. */
static void finish(ShapeOpSolver *op, double *points, int count, const char *folder, const char *name) {
    char path[4096];
    FILE *file;
    int i;
    shapeop_getPoints(op, points, count);
    check(op, name);
    shapeop_delete(op);
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path || (file = fopen(path, "w")) == NULL) {
        fail(name, "cannot be written");
        return;
    }
    for (i = 0; i < count; ++i) {
        fprintf(file, "%.17g %.17g %.17g\n", points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    }
    if (fclose(file) != 0) {
        fail(name, "cannot be written");
    }
}

static void quad(const char *folder) {
    double points[] = {0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1};
    const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, target[] = {0, 0, 0.2};
    const int ids[] = {0, 1, 2, 3};
    ShapeOpSolver *op = create(points, 4);
    add(op, "Plane", ids, 4, 4, 1, NULL, 0);
    add(op, "Rigid", ids, 4, 4, 2, square, 12);
    add(op, "Closeness", ids, 1, 1, 0.5, target, 3);
    shapeop_init(op);
    check(op, "init");
    shapeop_solve(op, 25);
    check(op, "solve");
    finish(op, points, 4, folder, "quad.txt");
}

static void planarise(const char *mesh, const char *folder) {
    FILE *file = fopen(mesh, "r");
    char line[1024];
    double x, y, z, *points;
    int i, f[4], *quads, *each, point_count = 0, quad_count = 0;
    ShapeOpSolver *op;
    if (file == NULL) {
        fail(mesh, "cannot be read");
        return;
    }
    while (fgets(line, sizeof line, file) != NULL) {
        point_count += line[0] == 'v' && line[1] == ' ';
        quad_count += line[0] == 'f' && line[1] == ' ';
    }
    points = calloc((size_t)point_count + 1, 3 * sizeof(double));
    quads = calloc((size_t)quad_count + 1, sizeof f);
    each = calloc((size_t)point_count + 1, sizeof(int));
    if (points == NULL || quads == NULL || each == NULL) {
        fail(mesh, "out of memory");
        return;
    }
    rewind(file);
    point_count = quad_count = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "v %lf %lf %lf", &x, &y, &z) == 3) {
            points[3 * point_count] = x;
            points[3 * point_count + 1] = y;
            points[3 * point_count + 2] = z;
            each[point_count] = point_count;
            point_count++;
        } else if (sscanf(line, "f %d %d %d %d", &f[0], &f[1], &f[2], &f[3]) == 4) {
            for (i = 0; i < 4; ++i) {
                quads[4 * quad_count + i] = f[i] - 1;
            }
            quad_count++;
        } else if (line[0] == 'f' && line[1] == ' ') {
            fail(mesh, "a face is no quad");
        }
    }
    fclose(file);
    op = create(points, point_count);
    add(op, "Plane", quads, 4 * quad_count, 4, 1, NULL, 0);
    add(op, "Closeness", each, point_count, 1, 0.05, NULL, 0);
    shapeop_init(op);
    check(op, "init");
    shapeop_solve(op, 100);
    check(op, "solve");
    finish(op, points, point_count, folder, "planarise.txt");
    free(points);
    free(quads);
    free(each);
}

static void cloth(const char *folder) {
    double points[3 * CLOTH_POINTS], gravity[] = {0, 0, -1}, first[] = {0.5, 0, 2}, second[] = {0, 0.5, -1};
    const double strain[] = {1, 0.9, 1.1}, moved[] = {14, 14, 5};
    const int corners[] = {0, 19, 399};
    int i, j, step, edges[2 * CLOTH_EDGES], n = 0, held, force;
    ShapeOpSolver *op;
    for (j = 0; j < SIDE; ++j) {
        for (i = 0; i < SIDE; ++i) {
            const int here = SIDE * j + i;
            points[3 * here] = i;
            points[3 * here + 1] = j;
            points[3 * here + 2] = 0;
            if (i < SIDE - 1) {
                edges[n++] = here;
                edges[n++] = here + 1;
            }
            if (j < SIDE - 1) {
                edges[n++] = here;
                edges[n++] = here + SIDE;
            }
        }
    }
    op = create(points, CLOTH_POINTS);
    add(op, "EdgeStrain", edges, n, 2, 10, strain, 3);
    add(op, "Closeness", corners, 3, 1, 1000, NULL, 0);
    held = shapeop_constraintCount(op) - 1;
    shapeop_addGravityForce(op, gravity);
    check(op, "gravity");
    force = shapeop_addVertexForce(op, first, 380);
    check(op, "vertex force");
    shapeop_initDynamic(op, 1, 0.95, 0.1);
    check(op, "init");
    for (step = 1; step <= 60; ++step) {
        if (step == 11) {
            shapeop_editConstraint(op, "Closeness", held, moved, 3);
            check(op, "edit of a constraint");
        }
        if (step == 31) {
            shapeop_editVertexForce(op, force, second, 380);
            check(op, "edit of a force");
        }
        shapeop_solve(op, 5);
        check(op, "step");
    }
    finish(op, points, CLOTH_POINTS, folder, "cloth.txt");
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fail("usage", "three_problems mesh.obj folder");
    }
    quad(argv[2]);
    planarise(argv[1], argv[2]);
    cloth(argv[2]);
    return EXIT_SUCCESS;
}
