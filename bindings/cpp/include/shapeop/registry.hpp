// What the library knows: its version and its constraint types. Included by shapeop.hpp.
#ifndef SHAPEOP_REGISTRY_HPP
#define SHAPEOP_REGISTRY_HPP

#include "error.hpp"

#include <string>
#include <utility>
#include <vector>

namespace shapeop {

/// The version of the library, such as "0.1.0".
inline std::string version() {
    return shapeop_version();
}

/// A constraint type: name, help, limits and unit are fields of shapeop_constraint_type. The texts stay valid.
struct ConstraintType : shapeop_constraint_type {
    /// As many as `scalar_count`, or none where that is -1 (shapes).
    std::vector<shapeop_constraint_scalar> scalars;
    /// What each point index means; the last name stands for all that follow.
    std::vector<std::string> index_names;
};

/// All constraint types.
inline std::vector<ConstraintType> constraint_types() {
    const int count = detail::check_number(shapeop_constraintTypeCount(), nullptr);
    std::vector<ConstraintType> types;
    for (int index = 0; index < count; ++index) {
        ConstraintType type{};
        type.struct_size = sizeof(shapeop_constraint_type);
        detail::check(shapeop_constraintType(index, &type), nullptr);
        for (int position = 0; position < type.scalar_count; ++position) {
            shapeop_constraint_scalar scalar{};
            scalar.struct_size = sizeof scalar;
            detail::check(shapeop_constraintScalar(index, position, &scalar), nullptr);
            type.scalars.push_back(scalar);
        }
        for (int position = 0; position < type.index_name_count; ++position) {
            type.index_names.emplace_back(shapeop_constraintIndexName(index, position));
        }
        types.push_back(std::move(type));
    }
    return types;
}

} // namespace shapeop

#endif
