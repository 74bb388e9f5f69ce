// shapeop in C++17: the functions of shapeop.h with values that clean up after themselves. Header-only.
//
//     shapeop::Solver solver;
//     solver.set_points({0, 0, .1, 1, 0, -.1, 1, 1, .1, 0, 1, -.1});
//     solver.add_constraint("Plane", {0, 1, 2, 3});
//     solver.init();
//     solver.solve(50);
//     std::vector<double> points = solver.points();
//
// A refused call throws shapeop::Error, whose text names the argument, what was expected and what was found; it has
// changed nothing. What each call does, its units and its limits, is said in shapeop.h beside the C function of the
// same name: shapeop_addConstraints is Solver::add_constraints. Options and reports are the structs of shapeop.h,
// filled in.
#ifndef SHAPEOP_HPP
#define SHAPEOP_HPP

#include "shapeop/problem.hpp"
#include "shapeop/registry.hpp"
#include "shapeop/solver.hpp"

#endif
