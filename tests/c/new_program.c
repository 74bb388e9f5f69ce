/* A C program that uses the whole of shapeop.h. Ends with 0 if all is well. */
#include "shapeop.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void check(int is_true, const char *what) {
    if (!is_true) {
        fprintf(stderr, "wrong: %s\n", what);
        failures++;
    }
}

static void list_types(void) {
    int i, j, count = shapeop_constraintTypeCount();
    check(count >= 7, "constraint types");
    for (i = 0; i < count; ++i) {
        shapeop_constraint_type type;
        memset(&type, 0, sizeof type);
        type.struct_size = sizeof type;
        check(shapeop_constraintType(i, &type) == SO_SUCCESS, "constraintType");
        printf("%s (%s):", type.name, type.help);
        for (j = 0; j < type.index_name_count; ++j) {
            printf(" %s", shapeop_constraintIndexName(i, j));
        }
        for (j = 0; j < type.scalar_count; ++j) {
            shapeop_constraint_scalar scalar;
            memset(&scalar, 0, sizeof scalar);
            scalar.struct_size = sizeof scalar;
            check(shapeop_constraintScalar(i, j, &scalar) == SO_SUCCESS, "constraintScalar");
            printf(" %s=%g", scalar.name, scalar.default_value);
        }
        printf(" [%s]\n", type.violation_unit);
    }
}

enum { SIDE = 20, POINTS = SIDE * SIDE, QUADS = (SIDE - 1) * (SIDE - 1) };

typedef struct Watch {
    ShapeOpSolver *solver;
    double last_energy;
    int calls;
} Watch;

static int watch(const shapeop_progress *progress, void *user) {
    Watch *seen = user;
    double energy = -1, points[3 * POINTS];
    check(progress->energy <= seen->last_energy * (1 + 1e-12), "the energy never rises");
    check(shapeop_energy(seen->solver, &energy) == SO_SUCCESS, "energy in the callback");
    check(fabs(energy - progress->energy) <= 1e-9 * energy, "it is that of the current points");
    shapeop_getPoints(seen->solver, points, POINTS);
    check(isfinite(points[0]), "points in the callback");
    check(shapeop_solve(seen->solver, 1) == 1, "busy");
    check(strstr(shapeop_lastError(seen->solver), "busy") != NULL, "and it says so");
    seen->last_energy = progress->energy;
    seen->calls++;
    return seen->calls == 30;
}

/* A bumpy sheet of quads: planar faces, near to where it was. */
static void planarise(void) {
    static double points[3 * POINTS];
    static int quads[4 * QUADS], each[POINTS], ids[QUADS];
    const int four = 4, one = 1;
    const double heavy = 1.0, light = 0.01;
    double before, after, violations[QUADS + POINTS];
    int i, n = 0;
    shapeop_solve_options options;
    shapeop_solve_report report;
    Watch seen;
    ShapeOpSolver *solver = shapeop_create();
    for (i = 0; i < POINTS; ++i) {
        points[3 * i] = i % SIDE;
        points[3 * i + 1] = i / SIDE;
        points[3 * i + 2] = sin(0.7 * (i % SIDE)) * cos(0.5 * (i / SIDE));
        each[i] = i;
        if (i % SIDE < SIDE - 1 && i / SIDE < SIDE - 1) {
            quads[n++] = i;
            quads[n++] = i + 1;
            quads[n++] = i + SIDE + 1;
            quads[n++] = i + SIDE;
        }
    }
    shapeop_setPoints(solver, points, POINTS);
    check(shapeop_addConstraints(solver, "Plane", quads, n, &four, 1, &heavy, 1, NULL, 0, 0, 0, ids) == SO_SUCCESS,
          "planes");
    check(ids[0] == 0 && ids[QUADS - 1] == QUADS - 1, "their ids");
    check(shapeop_addConstraints(solver, "Closeness", each, POINTS, &one, 1, &light, 1, NULL, 0, 0, 0, NULL) ==
              SO_SUCCESS,
          "closeness");
    check(shapeop_constraintCount(solver) == QUADS + POINTS, "constraintCount");
    check(shapeop_energy(solver, &before) == SO_SUCCESS, "energy before");
    check(shapeop_init(solver) == 0, "init");

    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    check(shapeop_defaultSolveOptions(&options) == SO_SUCCESS, "default options");
    options.max_iterations = 500;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    seen.solver = solver;
    seen.last_energy = before;
    seen.calls = 0;
    check(shapeop_solveUntil(solver, &options, watch, &seen, &report) == SO_SUCCESS, "solveUntil");
    check(report.outcome == SO_OUTCOME_CANCELLED && report.iterations == 30 && seen.calls == 30, "cancelled at 30");
    check(fabs(report.energy_before - before) <= 1e-9 * before, "energy before, reported");
    check(shapeop_energy(solver, &after) == SO_SUCCESS, "energy after");
    check(fabs(report.energy_after - after) <= 1e-9 * after, "energy after, reported");
    check(after < 0.5 * before, "it fell");
    check(shapeop_getViolations(solver, violations, QUADS + POINTS) == SO_SUCCESS, "violations");
    check(shapeop_getViolations(solver, violations, 1) == SO_INVALID_ARGUMENT_LENGTH, "violations of one");
    printf("energy %g -> %g, first violation %g\n", before, after, violations[0]);
    shapeop_delete(solver);
}

static void mistakes(void) {
    ShapeOpSolver *solver = shapeop_create();
    double number = 7;
    int id = 3;
    check(shapeop_solve(solver, 1) == 1, "solve before init");
    printf("%s\n", shapeop_lastError(solver));
    check(shapeop_addConstraint(solver, "Plain", &id, 1, 1.0) == -1, "unknown type");
    printf("%s\n", shapeop_lastError(solver));
    check(strstr(shapeop_lastError(solver), "Closeness") != NULL, "it lists the names");
    shapeop_delete(solver);
    check(shapeop_energy(solver, &number) == SO_INVALID_HANDLE && number == 7, "a deleted solver");
    check(strcmp(shapeop_errorText(SO_SUCCESS), "success") == 0, "errorText");
    check(shapeop_abiVersion() == SHAPEOP_ABI_VERSION, "abiVersion");
}

static void surfaces(void) {
    const double profile[] = {2.5, 0, 0.5, 2, 0, 0.7, 1.5, 0, 0.5};
    const double origin[] = {0, 0, 0}, z[] = {0, 0, 1}, center[] = {0, 0, 3};
    double points[3 * 27];
    int count = 0;
    ShapeOpCanal *torus = shapeop_canalRevolution(profile, 3, origin, z, 1.5, 9);
    check(torus != NULL, "canalRevolution");
    check(shapeop_canalInvert(torus, center, 4) == SO_SUCCESS, "canalInvert");
    check(shapeop_canalPoints(torus, NULL, 0, &count) == SO_SUCCESS && count == 27, "the number of points");
    check(shapeop_canalPoints(torus, points, count, &count) == SO_SUCCESS, "canalPoints");
    check(fabs(points[1]) < 1e-12, "the first column is in its plane");
    check(strcmp(shapeop_canalFamily(torus), "M-revolution") == 0, "canalFamily");
    check(shapeop_canalInvert(torus, center, 0) == SO_INVALID_VALUE, "no ratio of 0");
    check(strstr(shapeop_lastError(NULL), "ratio") != NULL, "the message names the ratio");
    shapeop_canalDelete(torus);
    check(shapeop_canalUndo(torus) == -1, "a deleted surface is refused");
}

static void strips(void) {
    enum { SIDE = 13 };
    double points[3 * SIDE * SIDE], control[6 * 6], point[3];
    int quads[4 * (SIDE - 1) * (SIDE - 1)], four = 4, count = 0, i, j, k = 0;
    shapeop_ruled_optimise_report found;
    ShapeOpRuled *design;
    for (j = 0; j < SIDE; ++j) {
        for (i = 0; i < SIDE; ++i) {
            double *p = points + 3 * (SIDE * j + i);
            p[0] = 2.0 * i / (SIDE - 1) - 1;
            p[1] = 2.0 * j / (SIDE - 1) - 1;
            p[2] = p[0] * p[1];
            if (i + 1 < SIDE && j + 1 < SIDE) {
                quads[k++] = SIDE * j + i;
                quads[k++] = SIDE * j + i + 1;
                quads[k++] = SIDE * j + i + 1 + SIDE;
                quads[k++] = SIDE * j + i + SIDE;
            }
        }
    }
    design = shapeop_ruledCreate(points, SIDE * SIDE, quads, k, &four, 1, NULL);
    check(design != NULL, "ruledCreate");
    check(shapeop_ruledStart(design, 6, 0) == SO_NO_SOLUTION, "no strips without boundaries");
    check(strstr(shapeop_lastError(NULL), "boundaries") != NULL, "the message names the boundaries");
    check(shapeop_ruledSetLevelBoundaries(design, NULL, 2, 0, NULL, 0, NULL, NULL, NULL) == SO_SUCCESS, "boundaries");
    check(shapeop_ruledStart(design, 6, 0) == SO_SUCCESS, "ruledStart");
    memset(&found, 0, sizeof found);
    found.struct_size = sizeof found;
    check(shapeop_ruledOptimise(design, NULL, NULL, NULL, &found) == SO_SUCCESS, "ruledOptimise");
    check(found.after < found.before && found.largest_deviation < 0.02, "strips near the saddle");
    check(shapeop_ruledControl(design, 1, NULL, 0, &count, NULL) == SO_SUCCESS && count == 6, "control points");
    check(shapeop_ruledControl(design, 1, control, count, &count, NULL) == SO_SUCCESS, "ruledControl");
    check(shapeop_ruledEvaluate(design, 1, 0, 1, point, NULL, NULL) == SO_SUCCESS, "ruledEvaluate");
    check(memcmp(point, control + 18, sizeof point) == 0, "a strip begins at its first control points");
    shapeop_ruledDelete(design);
    check(shapeop_ruledStripCount(design) == -1, "a deleted design is refused");
}

static int stop_at_two(const shapeop_snake_progress *progress, void *user) {
    *(int *)user += 1;
    return progress->step >= 2;
}

static void snakes(void) {
    const double one[] = {1, 1, 1, 1, 1, 1}, torsions[] = {1, -0.7, 0.9, -0.8, 0.6}, up[] = {0, 0, 2};
    const double origin[] = {0, 0, 0}, x[] = {1, 0, 0}, y[] = {0, 1, 0};
    double control[3 * 8], frames[3 * 8 * 3], sum = 0;
    int count = 0, calls = 0, i;
    shapeop_snake_report told;
    shapeop_snake_evolution found;
    ShapeOpSnake *snake = shapeop_snakeCreateFromArcs(one, one, 6, torsions, 5, origin, x, y);
    check(snake != NULL, "snakeCreateFromArcs");
    memset(&told, 0, sizeof told);
    told.struct_size = sizeof told;
    check(shapeop_snakeReport(snake, &told) == SO_SUCCESS && told.control_count == 8, "snakeReport");
    check(fabs(told.length - 6) < 1e-12 && told.residual < 1e-12, "the length of the arcs");
    check(shapeop_snakeControl(snake, NULL, 0, &count) == SO_SUCCESS && count == 8, "the number of control points");
    check(shapeop_snakeControl(snake, control, count, &count) == SO_SUCCESS, "snakeControl");
    check(shapeop_snakeSetDirection(snake, SO_SNAKE_DIRECTION_ALONG, up) == SO_SUCCESS, "snakeSetDirection");
    check(shapeop_snakeFrameCount(snake) == -1, "no frames yet");
    check(strstr(shapeop_lastError(NULL), "evolve") != NULL, "the message says what comes first");
    memset(&found, 0, sizeof found);
    found.struct_size = sizeof found;
    check(shapeop_snakeEvolve(snake, NULL, stop_at_two, &calls, &found) == SO_SUCCESS, "snakeEvolve");
    check(calls == 3 && found.stop == SO_SNAKE_STOP_CANCELLED && found.frame_count == 3, "a run is cancelled");
    check(shapeop_snakeFrames(snake, frames, 24, &count) == SO_SUCCESS && count == 24, "snakeFrames");
    for (i = 0; i < 8; ++i) {
        sum += fabs(frames[48 + 3 * i + 2] - control[3 * i + 2] - found.time);
    }
    check(sum < 1e-6, "all points moved up");
    check(shapeop_snakeLinkageFreedoms(snake) == 1, "snakeLinkageFreedoms");
    check(strstr(shapeop_snakeKindsCsv(snake, SHAPEOP_SNAKE_ALL, 1e-6), ",18\n") != NULL, "one kind of arc, 18 times");
    shapeop_snakeDelete(snake);
    check(shapeop_snakeRailCount(snake) == -1, "a deleted snake is refused");
}

int main(void) {
    printf("shapeop %s\n", shapeop_version());
    list_types();
    planarise();
    mistakes();
    surfaces();
    strips();
    snakes();
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
