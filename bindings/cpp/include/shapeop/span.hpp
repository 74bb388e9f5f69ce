// Arrays as arguments. Included by shapeop.hpp.
#ifndef SHAPEOP_SPAN_HPP
#define SHAPEOP_SPAN_HPP

#include "error.hpp"

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace shapeop {

/// An array that a call reads or writes and that belongs to the caller. It is made from whatever lies contiguously in
/// memory and has this element type: a vector, a std::array, a C array, a std::span, a matrix with data() and size();
/// from a pointer and a length; and, if it is only read, from numbers in braces. It is meant for arguments alone.
template <class T> class Span {
public:
    Span() = default;
    Span(T *first, std::size_t size) : first_(first), size_(size) {}

    template <class Range,
              class = std::enable_if_t<std::is_convertible_v<decltype(std::data(std::declval<Range &>())), T *> &&
                                       !std::is_same_v<std::decay_t<Range>, Span>>>
    Span(Range &&range) : first_(std::data(range)), size_(static_cast<std::size_t>(std::size(range))) {}

    // The numbers live as long as the call that they are an argument of.
    Span(std::initializer_list<std::remove_const_t<T>> numbers) : size_(numbers.size()) { first_ = numbers.begin(); }

    T *data() const { return first_; }
    std::size_t size() const { return size_; }

    /// The length as C has it.
    int length(const char *name) const {
        if (size_ > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
            throw Error(SO_TOO_LARGE, std::string(name) + ": " + std::to_string(size_) + " do not fit an int");
        }
        return static_cast<int>(size_);
    }

    /// The number of points: the length is 3 times that.
    int point_count(const char *name) const {
        if (size_ % 3 != 0) {
            throw Error(SO_INVALID_ARGUMENT_LENGTH, std::string(name) + ": expected x y z of each point, found " +
                                                        std::to_string(size_) + " numbers");
        }
        return Span(first_, size_ / 3).length(name);
    }

    /// The number of triangles: the length is 3 times that.
    int triangle_count(const char *name) const {
        if (size_ % 3 != 0) {
            throw Error(SO_INVALID_ARGUMENT_LENGTH, std::string(name) + ": expected 3 indices of each triangle, found " +
                                                        std::to_string(size_));
        }
        return Span(first_, size_ / 3).length(name);
    }

private:
    T *first_ = nullptr;
    std::size_t size_ = 0;
};

using Numbers = Span<const double>;
using Indices = Span<const int>;

namespace detail {

/// How many constraints or faces `counts` cuts `indices` into: one count is that of all.
inline std::size_t part_count(Indices indices, Indices counts) {
    if (counts.size() != 1) {
        return counts.size();
    }
    return *counts.data() > 0 ? indices.size() / static_cast<std::size_t>(*counts.data()) : 0;
}

} // namespace detail
} // namespace shapeop

#endif
