// Why a call was refused. Included by shapeop.hpp.
#ifndef SHAPEOP_ERROR_HPP
#define SHAPEOP_ERROR_HPP

#include "shapeop.h"

#include <stdexcept>
#include <string>

namespace shapeop {

/// A refused call. It has changed nothing.
class Error : public std::runtime_error {
public:
    Error(shapeop_err code, const std::string &message) : std::runtime_error(message), code_(code) {}

    /// The kind of refusal.
    shapeop_err code() const noexcept { return code_; }

private:
    shapeop_err code_;
};

namespace detail {

/// Throws what the library said of the last call on `op`, which was refused.
[[noreturn]] inline void refuse(ShapeOpSolver *op) {
    throw Error(shapeop_lastErrorCode(op), shapeop_lastError(op));
}

/// Throws if the call that answered with `code` was refused.
inline void check(shapeop_err code, ShapeOpSolver *op) {
    if (code != SO_SUCCESS) {
        refuse(op);
    }
}

/// Throws if the last call on `op`, of a function without a result, was refused.
inline void check_void(ShapeOpSolver *op) {
    if (shapeop_lastErrorCode(op) != SO_SUCCESS) {
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
