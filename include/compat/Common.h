/* What API.h builds on: the number type, and how its functions are imported. For programs written for libShapeOp 0.1.0;
 * new ones include shapeop.h. C99, C++ and SWIG. */
#ifndef SHAPEOP_COMPAT_COMMON_H
#define SHAPEOP_COMPAT_COMMON_H

/* Every coordinate, weight and scalar. */
typedef double ShapeOpScalar;

#ifndef SHAPEOP_API
#if defined(_WIN32) && !defined(SWIG)
#define SHAPEOP_API __declspec(dllimport)
#else
#define SHAPEOP_API
#endif
#endif

#endif
