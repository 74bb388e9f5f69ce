/* The fourteen functions of libShapeOp 0.1.0, as this library has them. For programs written for it; new ones include
 * shapeop.h, which documents these functions and more. Both may be included, in any order. C99, C++ and SWIG. */
#ifndef SHAPEOP_COMPAT_API_H
#define SHAPEOP_COMPAT_API_H

#include "Common.h"

#ifdef __cplusplus
extern "C" {
#endif

/* shapeop.h declares these two as well, unless this file came first. */
#ifndef SHAPEOP_H

/* A solver: a small integer in a pointer's place, never to be dereferenced. */
typedef struct ShapeOpSolver ShapeOpSolver;

/* Why a call was refused. */
typedef enum shapeop_err {
    SO_SUCCESS = 0,
    SO_INVALID_CONSTRAINT_TYPE = 1,
    SO_INVALID_ARGUMENT_LENGTH = 2,
    SO_UNMATCHING_CONSTRAINT_ID = 3,
    SO_INVALID_VALUE = 16,
    SO_INDEX_OUT_OF_RANGE = 17,
    SO_UNMATCHING_FORCE_ID = 18,
    SO_NOT_INITIALISED = 19,
    SO_UNBOUNDED = 20,
    SO_BUSY = 21,
    SO_INVALID_HANDLE = 22,
    SO_NULL_POINTER = 23,
    SO_INVALID_INPUT = 24,
    SO_TOO_LARGE = 25,
    SO_INTERNAL = 26,
    SO_NOT_GRID = 27,
    SO_NOT_PLANAR = 28,
    SO_NOT_CIRCULAR = 29,
    SO_DEGENERATE = 30,
    SO_NO_INTERSECTION = 31,
    SO_NO_SOLUTION = 32,
    SO_SINGULAR = 33,
    SO_NOT_CLOSED = 34,
    SO_NOT_MANIFOLD = 35,
    SO_CURVATURE_SIGN = 36,
    SO_NOT_ORIENTABLE = 37,
    SO_INFEASIBLE = 38,
    SO_OUT_OF_DOMAIN = 39,
    SO_BACKEND_UNAVAILABLE = 40,
    SO_BACKEND_FAILED = 41
} shapeop_err;

#endif

/* Solvers. */
SHAPEOP_API ShapeOpSolver *shapeop_create(void);
SHAPEOP_API void shapeop_delete(ShapeOpSolver *op);

/* Preparing and solving: 0, or 1 if it failed. */
SHAPEOP_API int shapeop_init(ShapeOpSolver *op);
SHAPEOP_API int shapeop_initDynamic(ShapeOpSolver *op, ShapeOpScalar masses, ShapeOpScalar damping,
                                    ShapeOpScalar timestep);
SHAPEOP_API int shapeop_solve(ShapeOpSolver *op, unsigned int iteration);

/* Points: 3 * nb_points numbers, x y z of the first point first. */
SHAPEOP_API void shapeop_setPoints(ShapeOpSolver *op, ShapeOpScalar *points, int nb_points);
SHAPEOP_API void shapeop_getPoints(ShapeOpSolver *op, ShapeOpScalar *points, int nb_points);

/* Dynamics. */
SHAPEOP_API void shapeop_setTimeStep(ShapeOpSolver *op, ShapeOpScalar timestep);
SHAPEOP_API void shapeop_setDamping(ShapeOpSolver *op, ShapeOpScalar damping);

/* Constraints: an id from 0 up, or -1. */
SHAPEOP_API int shapeop_addConstraint(ShapeOpSolver *op, const char *constraintType, int *ids, int nb_ids,
                                      ShapeOpScalar weight);
SHAPEOP_API shapeop_err shapeop_editConstraint(ShapeOpSolver *op, const char *constraintType, int constraint_id,
                                               const ShapeOpScalar *scalars, int nb_scl);

/* Forces of 3 components: an id from 0 up, or -1. */
SHAPEOP_API int shapeop_addGravityForce(ShapeOpSolver *op, ShapeOpScalar *force);
SHAPEOP_API int shapeop_addVertexForce(ShapeOpSolver *op, ShapeOpScalar *force, int id);
SHAPEOP_API void shapeop_editVertexForce(ShapeOpSolver *op, int force_id, ShapeOpScalar *force, int id);

#ifdef __cplusplus
}
#endif

#endif
