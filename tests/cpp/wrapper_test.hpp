// What the tests of the C++ wrapper share.
#ifndef WRAPPER_TEST_HPP
#define WRAPPER_TEST_HPP

#include <shapeop.hpp>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

using shapeop::Scalars;
using shapeop::Solver;

inline std::atomic<int> checks{0}, failures{0};

inline void check(bool is_true, const std::string &what) {
    ++checks;
    if (!is_true) {
        std::fprintf(stderr, "wrong: %s\n", what.c_str());
        ++failures;
    }
}

inline void near(double found, double expected, const std::string &what, double tolerance = 1e-9) {
    check(std::abs(found - expected) <= tolerance,
          what + ": expected " + std::to_string(expected) + ", found " + std::to_string(found));
}

// The call throws an Error of this code with these words in its text.
template <class Call>
void refused(shapeop_err code, const std::vector<std::string> &words, const std::string &what, Call call) {
    try {
        call();
        check(false, what + " was accepted");
    } catch (const shapeop::Error &error) {
        const std::string text = error.what();
        check(error.code() == code, what + ": code " + std::to_string(error.code()));
        check(!text.empty(), what + ": no message");
        for (const std::string &word : words) {
            check(text.find(word) != std::string::npos, what + ": \"" + word + "\" is not in \"" + text + "\"");
        }
    }
}

// A point between two targets, drawn to them with the weights 1 and 3.
struct Tug {
    Solver solver;
    int left, right;

    Tug() {
        solver.set_points({1, 1, 1});
        left = solver.add_constraint("Closeness", {0}, 1, {0, 0, 0});
        right = solver.add_constraint("Closeness", {0}, 3, {4, 0, 0});
        solver.init();
    }
    double rest() {
        solver.solve(3);
        return solver.points()[0];
    }
};

// A bumpy sheet of quads, far from planar, that takes hundreds of iterations.
struct Sheet {
    static constexpr int side = 8;
    std::vector<double> points;
    std::vector<int> quads, each;
    Solver solver;

    Sheet() {
        for (int i = 0; i < side * side; ++i) {
            const int x = i % side, y = i / side;
            points.insert(points.end(), {double(x), double(y), std::sin(0.7 * x) * std::cos(0.5 * y)});
            each.push_back(i);
            if (x + 1 < side && y + 1 < side) {
                quads.insert(quads.end(), {i, i + 1, i + side + 1, i + side});
            }
        }
        solver.set_points(points);
        solver.add_constraints("Plane", quads, {4});
        solver.add_constraints("Closeness", each, {1}, {0.01});
        solver.init();
        options.tolerance = 0;
    }
    shapeop::SolveOptions options;
};

using Test = std::pair<const char *, void (*)()>;

/// Runs the tests; what the program ends with.
inline int run(const std::vector<Test> &tests) {
    for (const auto &[name, test] : tests) {
        const int before = failures;
        try {
            test();
        } catch (const std::exception &error) {
            check(false, std::string("an exception: ") + error.what());
        }
        std::printf("%s %s\n", failures == before ? "ok    " : "FAILED", name);
    }
    std::printf("%d checks, %d failures\n", checks.load(), failures.load());
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#endif
