// Problems as JSON text, recipes that make them from a mesh, measures of faces. Included by shapeop.hpp.
#ifndef SHAPEOP_PROBLEM_HPP
#define SHAPEOP_PROBLEM_HPP

#include "span.hpp"

#include <string>
#include <vector>

namespace shapeop {

/// What recipes take: the fields of shapeop_recipe_options, with the library's defaults.
struct RecipeOptions : shapeop_recipe_options {
    RecipeOptions() : shapeop_recipe_options{} {
        struct_size = sizeof(shapeop_recipe_options);
        detail::check(shapeop_defaultRecipeOptions(this), nullptr);
    }
};

namespace detail {

inline std::string made_text(const char *text) {
    if (text == nullptr) {
        refuse(nullptr);
    }
    return text;
}

inline std::vector<std::string> names(int count, const char *(*name)(int)) {
    std::vector<std::string> names;
    for (int index = 0; index < check_number(count, nullptr); ++index) {
        names.push_back(made_text(name(index)));
    }
    return names;
}

} // namespace detail

/// The JSON form of a problem, checked, with every default written out.
inline std::string problem_text(const std::string &json) {
    return detail::made_text(shapeop_problemText(detail::c_text(json, "json")));
}

inline std::vector<std::string> recipe_names() {
    return detail::names(shapeop_recipeCount(), [](int index) { return shapeop_recipeName(index); });
}

/// The problem that a recipe makes of a mesh, as JSON for Solver::set_problem. `faces` are the point indices of all
/// faces, behind each other; `counts` says how many belong to each: one number for all, or one for each. `anchors`, if
/// there are any, stand in for those of the options.
inline std::string recipe(const std::string &name, Numbers points, Indices faces, Indices counts,
                          const RecipeOptions &options = {}, Indices anchors = {}) {
    RecipeOptions with_anchors = options;
    if (anchors.size() > 0) {
        with_anchors.anchors = anchors.data();
        with_anchors.nb_anchors = anchors.length("anchors");
    }
    return detail::made_text(shapeop_recipe(detail::c_text(name, "name"), points.data(), points.point_count("points"),
                                            faces.data(), faces.length("faces"), counts.data(), counts.length("counts"),
                                            &with_anchors));
}

inline std::vector<std::string> measure_names() {
    return detail::names(shapeop_measureCount(), [](int index) { return shapeop_measureName(index); });
}

/// One number per face; what they mean is said with shapeop_measureFaces. Faces are as in `recipe`.
inline std::vector<double> measure_faces(const std::string &measure, Numbers points, Indices faces, Indices counts) {
    std::vector<double> measured(detail::part_count(faces, counts));
    detail::check(shapeop_measureFaces(detail::c_text(measure, "measure"), points.data(), points.point_count("points"),
                                       faces.data(), faces.length("faces"), counts.data(), counts.length("counts"),
                                       measured.data(), Numbers(measured).length("faces")),
                  nullptr);
    return measured;
}

} // namespace shapeop

#endif
