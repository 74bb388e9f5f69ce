// What an exploration minimises and what it finds. Included by shapeop.hpp.
#ifndef SHAPEOP_EXPLORATION_HPP
#define SHAPEOP_EXPLORATION_HPP

#include "error.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace shapeop {

/// The weights of what is minimised while hard constraints are met: the fields of shapeop_objective, with the library's
/// defaults.
struct Objective : shapeop_objective {
    Objective() : shapeop_objective{} {
        struct_size = sizeof(shapeop_objective);
        detail::check(shapeop_defaultObjective(this), nullptr);
    }
};

/// What the last exploration found: the fields of shapeop_exploration.
struct Exploration : shapeop_exploration {
    Exploration() : shapeop_exploration{} { struct_size = sizeof(shapeop_exploration); }
};

/// How a solution answers a change of each weight.
struct Sensitivities {
    /// "handles", "closeness", "fairness", and the name of each type of soft constraints.
    std::vector<std::string> classes;
    /// How far each point moves per change of the logarithm of a weight, in model units: x y z of every point for the
    /// first class, then for the next. Doubling the weight moves a point by about 0.69 times that.
    std::vector<double> points;
    /// How the sum of weighted squares of each class answers: a row per weight that is changed, a column per class.
    std::vector<double> squares;
};

} // namespace shapeop

#endif
