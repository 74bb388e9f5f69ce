/* SWIG interface of the fourteen functions of libShapeOp 0.1.0, and of the three that say why a call was refused.
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
%typemap(in) unsigned int iteration {
    if ($input < 0 || $input > UINT_MAX) SWIG_exception(SWIG_ValueError, "iteration: expected 0 to 4294967295");
    $1 = (unsigned int)$input;
}
#endif

%include "Common.h"
%include "API.h"

/* As shapeop.h documents them. */
const char *shapeop_lastError(ShapeOpSolver *op);
const char *shapeop_errorText(int error);
const char *shapeop_version(void);
