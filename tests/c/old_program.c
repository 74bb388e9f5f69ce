/* A program as one writes it for libShapeOp 0.1.0: only its header, only its functions. Every number that it checks is
 * derived by hand. Ends with 0 if all is well. */
#include "API.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int failures = 0;

static void check(int is_true, const char *what) {
    if (!is_true) {
        fprintf(stderr, "wrong: %s\n", what);
        failures++;
    }
}

static int near_to(ShapeOpScalar a, ShapeOpScalar b, ShapeOpScalar tolerance) {
    return fabs(a - b) <= tolerance;
}

/* A square whose corners are h above and below its plane in turn. With a plane of weight 1 and a closeness of weight w per
 * corner, each height is h w / (w + 1) after one iteration: the best-fit plane is z = 0 all along. */
static void planarise(void) {
    ShapeOpScalar points[12] = {0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1};
    int corners[4] = {0, 1, 2, 3};
    const ShapeOpScalar target[3] = {5, 5, 5};
    const ShapeOpScalar start[3] = {0, 0, 0.1};
    ShapeOpSolver *solver = shapeop_create();
    int plane, i, closeness[4];
    check(solver != NULL, "create");
    shapeop_setPoints(solver, points, 4);
    plane = shapeop_addConstraint(solver, "Plane", corners, 4, 1.0);
    for (i = 0; i < 4; ++i) {
        closeness[i] = shapeop_addConstraint(solver, "Closeness", &corners[i], 1, 0.25);
    }
    check(plane == 0 && closeness[0] == 1 && closeness[3] == 4, "ids count up from 0");
    check(shapeop_editConstraint(solver, "Closeness", closeness[0], target, 3) == SO_SUCCESS, "edit");
    check(shapeop_editConstraint(solver, "Closeness", closeness[0], start, 3) == SO_SUCCESS, "edit back");
    check(shapeop_editConstraint(solver, "Plane", plane, start, 3) == SO_INVALID_CONSTRAINT_TYPE, "no scalars");
    check(shapeop_editConstraint(solver, "Closeness", plane, start, 3) == SO_UNMATCHING_CONSTRAINT_ID, "a plane's id");
    check(shapeop_editConstraint(solver, "Closeness", closeness[1], start, 2) == SO_INVALID_ARGUMENT_LENGTH, "2 of 3");
    check(shapeop_addConstraint(solver, "NoSuchType", corners, 4, 1.0) == -1, "no such type");
    check(shapeop_addConstraint(solver, "Plane", corners, 2, 1.0) == -1, "two points are no plane");
    check(shapeop_init(solver) == 0, "init");
    check(shapeop_solve(solver, 1) == 0, "solve");
    shapeop_getPoints(solver, points, 4);
    for (i = 0; i < 4; ++i) {
        check(near_to(points[3 * i + 2], (i % 2 == 0 ? 0.1 : -0.1) * 0.25 / 1.25, 1e-15), "height of a corner");
        check(near_to(points[3 * i], i == 1 || i == 2 ? 1 : 0, 1e-15), "x of a corner");
    }
    shapeop_delete(solver);
}

/* A spring of rest length 1 and weight w between a held point and one that a force f pulls: at rest w (x - 1) = f, x its
 * length. The held point is as good as fixed. */
static void hang(void) {
    ShapeOpScalar points[6] = {0, 0, 0, 0, 0, -1};
    ShapeOpScalar gravity[3] = {0, 0, -0.5};
    int held[1] = {0};
    int edge[2] = {0, 1};
    ShapeOpSolver *solver = shapeop_create();
    shapeop_setPoints(solver, points, 2);
    check(shapeop_addConstraint(solver, "Closeness", held, 1, 1e9) == 0, "hold");
    check(shapeop_addConstraint(solver, "EdgeStrain", edge, 2, 2.0) == 1, "spring");
    check(shapeop_addVertexForce(solver, gravity, 0) == 0, "force");
    shapeop_editVertexForce(solver, 0, gravity, 1);
    check(shapeop_init(solver) == 0, "init");
    check(shapeop_solve(solver, 50) == 0, "solve");
    shapeop_getPoints(solver, points, 2);
    check(near_to(points[5], -1.25, 1e-6), "the spring's length is 1 + 0.5 / 2");
    shapeop_delete(solver);
}

/* Free fall with implicit Euler: after k steps z = -step^2 g k (k + 1) / 2. */
static void fall(void) {
    ShapeOpScalar points[6] = {0, 0, 0, 3, 2, 1};
    ShapeOpScalar gravity[3] = {0, 0, -10};
    ShapeOpSolver *solver = shapeop_create();
    int k;
    shapeop_setPoints(solver, points, 2);
    check(shapeop_addGravityForce(solver, gravity) == 0, "gravity");
    check(shapeop_initDynamic(solver, 1.0, 1.0, 0.1) == 0, "initDynamic");
    for (k = 1; k <= 20; ++k) {
        check(shapeop_solve(solver, 3) == 0, "step");
        shapeop_getPoints(solver, points, 2);
        check(near_to(points[2], -0.1 * k * (k + 1) / 2.0, 1e-11), "height in free fall");
        check(near_to(points[5], 1 - 0.1 * k * (k + 1) / 2.0, 1e-11), "height of the other");
    }
    shapeop_setDamping(solver, 0.5);
    shapeop_setTimeStep(solver, 0.05);
    check(shapeop_solve(solver, 3) == 0, "a smaller step");
    shapeop_delete(solver);
    shapeop_delete(NULL);
}

int main(void) {
    planarise();
    hang();
    fall();
    if (failures == 0) {
        printf("old program: all is well\n");
    }
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
