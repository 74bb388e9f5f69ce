// A C++ program: both headers together, several solvers on several threads. Ends with 0 if all is well.
#include "API.h"
#include "shapeop.h"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

std::atomic<int> failures{0};

void check(bool is_true, const std::string &what) {
    if (!is_true) {
        std::fprintf(stderr, "wrong: %s\n", what.c_str());
        ++failures;
    }
}

struct Delete {
    void operator()(ShapeOpSolver *op) const { shapeop_delete(op); }
};
using Solver = std::unique_ptr<ShapeOpSolver, Delete>;

// A closed chain of n edges of rest length 1 on a circle of radius r: it comes to rest as a regular polygon of side 1,
// whose circumradius is 1 / (2 sin(pi / n)).
void polygon(int n) {
    Solver solver{shapeop_create()};
    std::vector<double> points;
    std::vector<int> edges;
    std::vector<double> scalars;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::acos(-1.0) * i / n;
        points.insert(points.end(), {3 * std::cos(angle), 3 * std::sin(angle), 0.0});
        edges.insert(edges.end(), {i, (i + 1) % n});
        scalars.insert(scalars.end(), {1.0, 1.0, 1.0});
    }
    shapeop_setPoints(solver.get(), points.data(), n);
    const int two = 2;
    const double weight = 1.0;
    std::vector<int> ids(n);
    check(shapeop_addConstraints(solver.get(), "EdgeStrain", edges.data(), 2 * n, &two, 1, &weight, 1, scalars.data(),
                                 3 * n, n, 0, ids.data()) == SO_SUCCESS,
          shapeop_lastError(solver.get()));
    check(shapeop_init(solver.get()) == 0, "init");
    check(shapeop_solve(solver.get(), 5000) == 0, shapeop_lastError(solver.get()));
    shapeop_getPoints(solver.get(), points.data(), n);
    const double radius = 1 / (2 * std::sin(std::acos(-1.0) / n));
    for (int i = 0; i < n; ++i) {
        const double found = std::hypot(points[3 * i], points[3 * i + 1]);
        check(std::abs(found - radius) < 1e-6, "circumradius of " + std::to_string(n));
    }
    std::vector<double> violations(n);
    check(shapeop_getViolations(solver.get(), violations.data(), n) == SO_SUCCESS, "violations");
    for (double violation : violations) {
        check(violation < 1e-6, "length of an edge");
    }
}

} // namespace

int main() {
    std::vector<std::thread> threads;
    for (int n = 3; n < 9; ++n) {
        threads.emplace_back(polygon, n);
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    if (failures == 0) {
        std::printf("C++ program: all is well\n");
    }
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
