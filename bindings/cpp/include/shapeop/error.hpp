// Why a call was refused. Included by shapeop.hpp.
#ifndef SHAPEOP_ERROR_HPP
#define SHAPEOP_ERROR_HPP

#include "shapeop.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace shapeop {

/// A refused call. It has changed nothing.
class Error : public std::runtime_error {
public:
    Error(std::optional<shapeop_err> code, const std::string &message) : std::runtime_error(message), code_(code) {}

    /// The kind of refusal; empty where the C function says no more than that it refused: points, forces, init, solve,
    /// counts. The text says it in every case.
    std::optional<shapeop_err> code() const noexcept { return code_; }

private:
    std::optional<shapeop_err> code_;
};

namespace detail {

/// Throws what the library said of the last call on `op`, which was refused.
[[noreturn]] inline void refuse(ShapeOpSolver *op, std::optional<shapeop_err> code = std::nullopt) {
    throw Error(code, shapeop_lastError(op));
}

/// Throws if the call that answered with `code` was refused.
inline void check(shapeop_err code, ShapeOpSolver *op) {
    if (code != SO_SUCCESS) {
        refuse(op, code);
    }
}

/// Throws if the last call on `op`, of a function without a result, was refused.
inline void check_void(ShapeOpSolver *op) {
    if (*shapeop_lastError(op) != '\0') {
        refuse(op);
    }
}

/// Throws if a count, an id or a truth is the -1 of a refused call.
inline int check_number(int number, ShapeOpSolver *op) {
    if (number < 0) {
        refuse(op);
    }
    return number;
}

/// Throws if a C function would see only the beginning of `text`.
inline const char *c_text(const std::string &text, const char *name) {
    if (const auto zero = text.find('\0'); zero != std::string::npos) {
        throw Error(SO_INVALID_INPUT, std::string(name) + ": a zero byte at " + std::to_string(zero));
    }
    return text.c_str();
}

} // namespace detail
} // namespace shapeop

#endif
