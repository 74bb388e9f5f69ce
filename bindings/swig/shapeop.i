/* SWIG interface of the fourteen functions of libShapeOp 0.1.0, of the three that say why a call was refused, and of those
 * that explore: hard constraints, handles, references, forces on faces.
 *
 * Names are those that users of libShapeOp's own interface know: modules shapeopPython, shapeopJava and shapeopCSharp,
 * arrays doubleArray and intArray. A solver is an opaque SWIGTYPE_p_ShapeOpSolver: its pointer holds a small integer
 * and is only ever passed back. Needs SWIG 4; how to build: docs/swig.md. */
#if defined(SWIGPYTHON)
%module(threads="1") shapeopPython
%nothread;
/* These may take long: other Python threads run meanwhile. */
%thread shapeop_init;
%thread shapeop_initDynamic;
%thread shapeop_solve;
%thread shapeop_solveUntil;
%thread shapeop_getSensitivities;
#elif defined(SWIGJAVA)
%module shapeopJava
/* Loaded with the class, so by the loader of the class: Jython has one of its own. */
%pragma(java) jniclasscode=%{
  static {
    System.loadLibrary("shapeopJava");
  }
%}
#elif defined(SWIGCSHARP)
%module shapeopCSharp
#else
#error "shapeop.i is for -python, -java and -csharp"
#endif

%include "exception.i"

%{
#include "API.h"
#include "shapeop.h"

#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
%}

/* Arrays that know their length. Those of carrays.i do not: there an index out of range, or a count above the length,
 * reads and writes the memory of others. Wherever a function takes a pointer to numbers, it is given such an array.
 *
 * CTYPE has a prefix, as SWIG's modules in one Python share their types by name, and doubleArray is a common one. */
%define SHAPEOP_ARRAY(NAME, CTYPE, TYPE)

%{
typedef struct CTYPE {
    int length;
    TYPE values[1]; /* `length` of them */
} CTYPE;

static TYPE *CTYPE##_values(CTYPE *array) {
    return array ? array->values : NULL;
}

/* Answers `why`, filled in, if the index is refused, else null. */
static const char *CTYPE##_refuses_index(const CTYPE *array, int index, char why[120]) {
    if (array && index >= 0 && index < array->length) return NULL;
    if (array) {
        snprintf(why, 120, "index %d is out of range for an array of %d values", index, array->length);
    } else {
        snprintf(why, 120, "expected a " #NAME ", found null");
    }
    return why;
}

/* The same for a call that uses `count * per_count` values. `values` is null, or comes from CTYPE_values. What is null
 * or below 0 is left to the library. */
static const char *CTYPE##_refuses_count(const TYPE *values, int count, int per_count, const char *name,
                                         char why[120]) {
    long long expected = (long long)count * per_count;
    int length = values ? ((const CTYPE *)((const char *)values - offsetof(CTYPE, values)))->length : INT_MAX;
    if (!values || expected <= length) return NULL;
    snprintf(why, 120, "%s: expected at least %lld values, found an array of %d", name, expected, length);
    return why;
}
%}

%rename(NAME) CTYPE;
#if defined(SWIGPYTHON)
%rename(__getitem__) CTYPE::getitem;
%rename(__setitem__) CTYPE::setitem;
%rename(__len__) CTYPE::length;
#endif

/* SWIG calls the first two arguments arg1 and arg2. */
%exception CTYPE::CTYPE {
    if (arg1 < 0) SWIG_exception(SWIG_ValueError, "nelements: expected 0 or more");
    $action
    if (!result) SWIG_exception(SWIG_MemoryError, "no memory for an array of that length");
}
%exception CTYPE::length {
    if (!arg1) SWIG_exception(SWIG_ValueError, "expected an array, found null");
    $action
}
%exception CTYPE::getitem {
    char why[120];
    if (CTYPE##_refuses_index(arg1, arg2, why)) SWIG_exception(SWIG_IndexError, why);
    $action
}
%exception CTYPE::setitem {
    char why[120];
    if (CTYPE##_refuses_index(arg1, arg2, why)) SWIG_exception(SWIG_IndexError, why);
    $action
}

/* cast() is for programs that call it, as those written for carrays.i do. */
%typemap(javacode) struct CTYPE %{
  public NAME cast() {
    return this;
  }
%}
%typemap(cscode) struct CTYPE %{
  public NAME cast() {
    return this;
  }
%}

typedef struct CTYPE {
    %extend {
        CTYPE(int nelements) {
            CTYPE *array = NULL;
            if ((size_t)nelements <= ((size_t)-1 - sizeof(CTYPE)) / sizeof(TYPE)) {
                array = (CTYPE *)calloc(1, sizeof(CTYPE) + (size_t)nelements * sizeof(TYPE));
            }
            if (array) array->length = nelements;
            return array;
        }
        ~CTYPE() { free($self); }
        TYPE getitem(int index) { return $self->values[index]; }
        void setitem(int index, TYPE value) { $self->values[index] = value; }
        int length() { return $self->length; }
#if defined(SWIGPYTHON)
        %pythoncode %{
    def cast(self):
        return self
        %}
#endif
    }
} CTYPE;

#if defined(SWIGPYTHON)
%typemap(in) TYPE * (void *array = 0, int status = 0) {
    status = SWIG_ConvertPtr($input, &array, $descriptor(CTYPE *), 0);
    if (!SWIG_IsOK(status)) {
        SWIG_exception_fail(SWIG_ArgError(status), "in method '$symname', argument $argnum of type '" #NAME "'");
    }
    $1 = CTYPE##_values((CTYPE *)array);
}
#elif defined(SWIGJAVA)
%typemap(jni) TYPE * "jlong"
%typemap(jtype) TYPE * "long"
%typemap(jstype) TYPE * #NAME
%typemap(javain) TYPE * "NAME.getCPtr($javainput)"
%typemap(in) TYPE * {
    $1 = CTYPE##_values(*(CTYPE **)&$input);
}
#elif defined(SWIGCSHARP)
%typemap(ctype) TYPE * "void *"
%typemap(imtype) TYPE * "global::System.Runtime.InteropServices.HandleRef"
%typemap(cstype) TYPE * #NAME
%typemap(csin) TYPE * "NAME.getCPtr($csinput)"
%typemap(in) TYPE * {
    $1 = CTYPE##_values((CTYPE *)$input);
}
#endif
%apply TYPE * { const TYPE * };

%enddef

SHAPEOP_ARRAY(doubleArray, shapeop_doubleArray, double)
SHAPEOP_ARRAY(intArray, shapeop_intArray, int)

%typemap(check, canthrow=1) (ShapeOpScalar *points, int nb_points) {
    char why[120];
    if (shapeop_doubleArray_refuses_count($1, $2, 3, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
%typemap(check, canthrow=1) (const ShapeOpScalar *scalars, int nb_scl) {
    char why[120];
    if (shapeop_doubleArray_refuses_count($1, $2, 1, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
%typemap(check, canthrow=1) ShapeOpScalar *force {
    char why[120];
    if (shapeop_doubleArray_refuses_count($1, 1, 3, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
%typemap(check, canthrow=1) (int *ids, int nb_ids) {
    char why[120];
    if (shapeop_intArray_refuses_count($1, $2, 1, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}

#if defined(SWIGJAVA)
/* A long in Java: a number below 0 would become billions of iterations. */
%typemap(in) unsigned int iteration, unsigned int max_iterations {
    if ($input < 0 || $input > UINT_MAX) SWIG_exception(SWIG_ValueError, "$1_name: expected 0 to 4294967295");
    $1 = (unsigned int)$input;
}
#endif

%include "Common.h"
%include "API.h"

/* As shapeop.h documents them. */
const char *shapeop_lastError(ShapeOpSolver *op);
const char *shapeop_errorText(int error);
const char *shapeop_version(void);

/* The functions that explore, as shapeop.h documents them. Arrays that are shorter than their counts say never get to
 * them. */
%define SHAPEOP_COUNTED(CTYPE, TYPE, NAME, COUNT, PER_COUNT)
%typemap(check, canthrow=1) (TYPE *NAME, int COUNT) {
    char why[120];
    if (CTYPE##_refuses_count($1, $2, PER_COUNT, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
%enddef
SHAPEOP_COUNTED(shapeop_doubleArray, const double, points, nb_points, 3)
SHAPEOP_COUNTED(shapeop_intArray, const int, triangles, nb_triangles, 3)
SHAPEOP_COUNTED(shapeop_intArray, const int, indices, nb_indices, 1)
SHAPEOP_COUNTED(shapeop_intArray, const int, counts, nb_counts, 1)
SHAPEOP_COUNTED(shapeop_intArray, int, ids, nb, 1)
SHAPEOP_COUNTED(shapeop_doubleArray, double, violations, nb_violations, 1)
%typemap(check, canthrow=1) const double *target {
    char why[120];
    if (shapeop_doubleArray_refuses_count($1, 1, 3, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
%typemap(check, canthrow=1) double *energy {
    char why[120];
    if (shapeop_doubleArray_refuses_count($1, 1, 1, "$1_name", why)) SWIG_exception(SWIG_ValueError, why);
}
/* `nb_points` points of each of the `nb_classes` classes, and a square matrix of them. Products that do not fit an int are
 * no lengths of arrays. */
%typemap(check, canthrow=1) (double *points, int nb_points, double *squares, int nb_classes) {
    char why[120];
    int are_counts = $2 >= 0 && $4 >= 0;
    if (are_counts && $4 > 0 && ($2 > INT_MAX / 3 / $4 || $4 > INT_MAX / $4)) {
        SWIG_exception(SWIG_ValueError, "nb_points, nb_classes: too large");
    }
    if (are_counts && (shapeop_doubleArray_refuses_count($1, 3 * $2, $4, "points", why) ||
                       shapeop_doubleArray_refuses_count($3, $4, $4, "squares", why))) {
        SWIG_exception(SWIG_ValueError, why);
    }
}
/* No callback: languages have their own ways, and no exception may come out of one. */
%typemap(in, numinputs=0) (shapeop_progress_callback progress, void *user) {
    $1 = NULL;
    $2 = NULL;
}

/* Structs know their size, and begin with the library's defaults. */
%define SHAPEOP_STRUCT(NAME, FILL)
%extend NAME {
    NAME() {
        NAME *self = (NAME *)calloc(1, sizeof(NAME));
        if (self) {
            self->struct_size = sizeof(NAME);
            FILL;
        }
        return self;
    }
    ~NAME() { free($self); }
}
%exception NAME::NAME {
    $action
    if (!result) SWIG_exception(SWIG_MemoryError, "no memory for a NAME");
}
%enddef

enum shapeop_outcome {
    SO_OUTCOME_CONVERGED = 0,
    SO_OUTCOME_ITERATION_LIMIT = 1,
    SO_OUTCOME_TIME_BUDGET = 2,
    SO_OUTCOME_CANCELLED = 3,
    SO_OUTCOME_STALLED = 4,
    SO_OUTCOME_UNBOUNDED = 5,
    SO_OUTCOME_INFEASIBLE = 6
};

enum shapeop_fairness {
    SO_FAIRNESS_LAPLACIAN = 0,
    SO_FAIRNESS_SECOND_DIFFERENCES = 1,
    SO_FAIRNESS_THIRD_DIFFERENCES = 2
};

typedef struct shapeop_solve_options {
    unsigned int max_iterations;
    double tolerance;
    double time_budget_seconds;
} shapeop_solve_options;

typedef struct shapeop_objective {
    double handle_weight;
    double closeness_weight;
    double fairness_weight;
    double tolerance;
} shapeop_objective;

%immutable;
typedef struct shapeop_solve_report {
    enum shapeop_outcome outcome;
    unsigned int iterations;
    double energy_before;
    double energy_after;
    double largest_move;
} shapeop_solve_report;

typedef struct shapeop_exploration {
    unsigned int sweep_count;
    unsigned int newton_step_count;
    int is_solution;
    double largest_violation;
    int worst_constraint;
    int capped_count;
    double primal_residual;
    double dual_residual;
    double handle_term;
    double closeness_term;
    double fairness_term;
    double soft_term;
    double penalty;
} shapeop_exploration;
%mutable;

SHAPEOP_STRUCT(shapeop_solve_options, shapeop_defaultSolveOptions(self))
SHAPEOP_STRUCT(shapeop_objective, shapeop_defaultObjective(self))
SHAPEOP_STRUCT(shapeop_solve_report, (void)0)
SHAPEOP_STRUCT(shapeop_exploration, (void)0)

shapeop_err shapeop_solveUntil(ShapeOpSolver *op, const shapeop_solve_options *options,
                               shapeop_progress_callback progress, void *user, shapeop_solve_report *report);
shapeop_err shapeop_energy(ShapeOpSolver *op, double *energy);
int shapeop_constraintCount(ShapeOpSolver *op);
shapeop_err shapeop_getViolations(ShapeOpSolver *op, double *violations, int nb_violations);

shapeop_err shapeop_setHard(ShapeOpSolver *op, int constraint_id, int is_hard);
int shapeop_isHard(ShapeOpSolver *op, int constraint_id);
shapeop_err shapeop_setHandle(ShapeOpSolver *op, int point, const double *target);
shapeop_err shapeop_releaseHandle(ShapeOpSolver *op, int point);
shapeop_err shapeop_setObjective(ShapeOpSolver *op, const shapeop_objective *objective);
shapeop_err shapeop_setFairness(ShapeOpSolver *op, int kind, const int *indices, int nb_indices, const int *counts,
                                int nb_counts);
shapeop_err shapeop_getExploration(ShapeOpSolver *op, shapeop_exploration *out);
int shapeop_getConflicts(ShapeOpSolver *op, int *ids, int nb);
int shapeop_weightClassCount(ShapeOpSolver *op);
const char *shapeop_weightClassName(ShapeOpSolver *op, int index);
shapeop_err shapeop_getSensitivities(ShapeOpSolver *op, double *points, int nb_points, double *squares, int nb_classes);

int shapeop_addReferencePolyline(ShapeOpSolver *op, const double *points, int nb_points, int is_closed);
int shapeop_addReferenceMesh(ShapeOpSolver *op, const double *points, int nb_points, const int *triangles,
                             int nb_triangles);
int shapeop_referenceCount(ShapeOpSolver *op);

int shapeop_addPressure(ShapeOpSolver *op, const int *indices, int nb_indices, const int *counts, int nb_counts,
                        double pressure);
int shapeop_addNormalForce(ShapeOpSolver *op, const int *indices, int nb_indices, const int *counts, int nb_counts,
                           double magnitude);
shapeop_err shapeop_editForceMagnitude(ShapeOpSolver *op, int force_id, double magnitude);
shapeop_err shapeop_removeForce(ShapeOpSolver *op, int force_id);
