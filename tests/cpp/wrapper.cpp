// The C++ wrapper: analytic truths through it. Ends with 0 if all is well.
#include "wrapper_test.hpp"

#include <array>
#include <cmath>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>
#if __cplusplus >= 202002L
#include <span>
#endif

namespace {

// A closed chain of n edges of length 1 on a circle of radius 3: at rest the circumradius is 1 / (2 sin(pi / n)).
void polygon(int n) {
    std::vector<double> points, scalars;
    std::vector<int> edges;
    const double pi = std::acos(-1.0);
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * i / n;
        points.insert(points.end(), {3 * std::cos(angle), 3 * std::sin(angle), 0.0});
        edges.insert(edges.end(), {i, (i + 1) % n});
        scalars.insert(scalars.end(), {1.0, 1.0, 1.0});
    }
    Solver solver;
    solver.set_points(points);
    const std::vector<int> ids = solver.add_constraints("EdgeStrain", edges, {2}, {1.0}, Scalars::each(scalars));
    check(ids.size() == static_cast<std::size_t>(n) && ids.front() == 0 && ids.back() == n - 1, "ids");
    solver.init();
    shapeop::SolveOptions options;
    options.max_iterations = 5000;
    options.tolerance = 1e-12;
    solver.solve_until(options);
    solver.copy_points(points);
    near(std::hypot(points[0], points[1]), 1 / (2 * std::sin(pi / n)), "circumradius of " + std::to_string(n), 1e-6);
}

void a_point_rests_at_the_weighted_mean_of_its_targets() {
    Tug tug;
    near(tug.rest(), 3, "(1 * 0 + 3 * 4) / 4");
    near(tug.solver.energy(), 6, "(1 * 3^2 + 3 * 1^2) / 2");
    const std::vector<double> violations = tug.solver.violations();
    check(violations.size() == 2, "a violation for each constraint");
    near(violations.at(0), 3, "distance to the left");
    near(violations.at(1), 1, "distance to the right");
}

void edits_of_scalars_and_weights_move_it() {
    Tug tug;
    tug.solver.edit_constraint("Closeness", tug.right, {8, 0, 0});
    near(tug.rest(), 6, "one edited");
    tug.solver.edit_constraints("Closeness", {tug.left, tug.right}, Scalars::each({2, 0, 0, 6, 0, 0}));
    near(tug.rest(), 5, "each edited");
    tug.solver.edit_constraints("Closeness", {tug.left, tug.right}, Scalars::same({7, 0, 0}));
    near(tug.rest(), 7, "both edited alike");
    tug.solver.edit_constraint("Closeness", tug.left, {3, 0, 0});
    tug.solver.set_weights({tug.left, tug.right}, {1, 1});
    near(tug.rest(), 5, "equal weights");
    tug.solver.set_weights({tug.left, tug.right}, {2});
    near(tug.rest(), 5, "one weight for both");
    tug.solver.set_weight(tug.left, 6);
    near(tug.rest(), 4, "one heavier");
    tug.solver.remove_constraint(tug.left);
    near(tug.rest(), 7, "one removed");
    check(!tug.solver.is_constraint(tug.left) && tug.solver.is_constraint(tug.right), "which is left");
    check(tug.solver.constraint_count() == 2, "ids given out");
    near(tug.solver.violations().at(0), 0, "violation of a removed one");
}

void a_force_moves_a_held_point_by_its_size_over_the_weight() {
    Solver solver;
    solver.set_points({0, 0, 0, 5, 0, 0});
    solver.add_constraints("Closeness", {0, 1}, {1}, {2.0, 4.0});
    const int gravity = solver.add_gravity_force({0, 0, -8});
    const int pull = solver.add_vertex_force({0, 6, 0}, 0);
    solver.init();
    const auto rest = [&] {
        solver.solve(3);
        return solver.points();
    };
    near(rest()[1], 3, "6 / 2");
    near(rest()[2], -4, "-8 / 2");
    near(rest()[5], -2, "-8 / 4");
    solver.edit_vertex_force(pull, {0, 0, 16}, 1);
    near(rest()[1], 0, "the force has left the first point");
    near(rest()[5], 2, "(16 - 8) / 4");
    solver.remove_force(gravity);
    near(rest()[5], 4, "16 / 4");
    check(solver.force_count() == 2 && !solver.is_force(gravity) && solver.is_force(pull), "forces left");
}

void a_dropped_point_falls_as_implicit_euler_says() {
    Solver solver;
    solver.set_points({0, 0, 0});
    solver.add_constraint("Closeness", {0}, 0);
    solver.add_gravity_force({0, 0, -10});
    solver.init_dynamic(1, 1, 0.1);
    for (int step = 1; step <= 5; ++step) {
        solver.solve(1);
        near(solver.points()[2], -0.1 * step * (step + 1) / 2, "h^2 g n (n + 1) / 2");
    }
    solver.set_damping(0);
    solver.solve(1);
    const double before = solver.points()[2];
    solver.solve(1);
    near(solver.points()[2] - before, -0.1, "without memory of the velocity: h^2 g");
}

void solvers_on_different_threads_do_not_meet() {
    std::vector<std::thread> threads;
    for (int n = 3; n < 9; ++n) {
        threads.emplace_back(polygon, n);
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

void progress_sees_every_iterate_and_can_stop() {
    Sheet sheet;
    unsigned int calls = 0;
    const auto progress = [&](const shapeop::Progress &now) {
        ++calls;
        check(now.iteration == calls, "iterations count up");
        near(sheet.solver.energy(), now.energy, "energy read in the callback", 1e-9);
        check(sheet.solver.points().size() == sheet.points.size(), "points read in the callback");
        return calls < 7;
    };
    const shapeop::Report report = sheet.solver.solve_until(sheet.options, progress);
    check(calls == 7 && report.iterations == 7 && report.outcome == SO_OUTCOME_CANCELLED, "stopped at 7");
    check(report.energy_after < report.energy_before, "the energy fell");
    near(sheet.solver.energy(), report.energy_after, "energy after");
    check(report.note.empty(), "nothing to note");

    sheet.options.max_iterations = 5;
    calls = 0;
    const shapeop::Report all = sheet.solver.solve_until(sheet.options, [&](const shapeop::Progress &) { ++calls; });
    check(calls == 5 && all.outcome == SO_OUTCOME_ITERATION_LIMIT, "a callback that returns nothing goes on");
}

void an_unbounded_problem_is_an_outcome_with_a_note() {
    Solver solver;
    solver.set_points({0, 0, 0, 1, 0, 0});
    solver.add_constraint("EdgeStrain", {0, 1});
    solver.add_gravity_force({0, 0, -1});
    solver.init();
    const shapeop::Report report = solver.solve_until();
    check(report.outcome == SO_OUTCOME_UNBOUNDED, "unbounded");
    check(report.note.find("force") != std::string::npos, "it says along what: " + report.note);
    const shapeop::Report watched = solver.solve_until({}, [](const shapeop::Progress &) {});
    check(watched.outcome == SO_OUTCOME_UNBOUNDED && watched.note == report.note, "the same with a callback");
    refused(SO_UNBOUNDED, {"force"}, "a plain solve of it", [&] { solver.solve(1); });
    check(solver.points() == std::vector<double>({0, 0, 0, 1, 0, 0}), "nothing moved");
}

void solvers_are_deleted_once_and_in_time() {
    // The library has room for 65536.
    Solver kept;
    kept.set_points({1, 2, 3});
    for (int i = 0; i < 70000; ++i) {
        Solver passing;
        if (i % 2 == 0) {
            kept = std::move(passing);
        }
    }
    check(kept.point_count() == 0, "the last one");
}

void the_registry_describes_every_type() {
    Sheet sheet;
    const std::vector<shapeop::ConstraintType> types = shapeop::constraint_types();
    check(types.size() >= 18, "those of libShapeOp at least");
    for (const shapeop::ConstraintType &type : types) {
        const std::string name = type.name;
        check(type.help != nullptr && *type.help != '\0' && type.violation_unit != nullptr, name);
        check(static_cast<int>(type.scalars.size()) == (type.scalar_count > 0 ? type.scalar_count : 0), name);
        check(static_cast<int>(type.index_names.size()) == type.index_name_count, name);
        std::vector<int> ids;
        while (static_cast<int>(ids.size()) + 1 < type.least_indices) {
            ids.push_back(static_cast<int>(ids.size()));
        }
        refused(SO_INVALID_ARGUMENT_LENGTH, {name}, name, [&] { sheet.solver.add_constraint(name, ids); });
        ids.push_back(static_cast<int>(ids.size()));
        const int id = sheet.solver.add_constraint(name, ids);
        check(sheet.solver.is_constraint(id), name);
    }
    check(!shapeop::version().empty(), "version");
}

void a_recipe_is_the_problem_that_one_would_add_by_hand() {
    Sheet by_hand;
    shapeop::RecipeOptions options;
    options.closeness = 0.01;
    const std::string json = shapeop::recipe("planarize", by_hand.points, by_hand.quads, {4}, options);
    check(shapeop::problem_text(json) == json, "a recipe's text is canonical");
    Solver solver;
    const shapeop::SolveOptions stopping = solver.set_problem(json);
    check(stopping.max_iterations > 0, "the problem's stopping rules");
    solver.solve(20);
    by_hand.solver.solve(20);
    const std::vector<double> left = solver.points(), right = by_hand.solver.points();
    check(left.size() == right.size(), "as many points");
    for (std::size_t i = 0; i < left.size() && i < right.size(); ++i) {
        near(left[i], right[i], "coordinate " + std::to_string(i), 1e-12);
    }
}

void anchors_keep_their_place() {
    const Sheet sheet;
    Solver solver;
    shapeop::RecipeOptions options;
    const shapeop::SolveOptions stopping =
        solver.set_problem(shapeop::recipe("smooth", sheet.points, sheet.quads, {4}, options, {0, 9}));
    solver.solve_until(stopping);
    const std::vector<double> points = solver.points();
    for (std::size_t i : {0u, 1u, 2u, 27u, 28u, 29u}) {
        near(points[i], sheet.points[i], "anchor", 1e-2);
    }
    refused(SO_INDEX_OUT_OF_RANGE, {"anchors", "64"}, "an anchor that is no point",
            [&] { shapeop::recipe("smooth", sheet.points, sheet.quads, {4}, options, {64}); });
}

void faces_are_measured() {
    // The diagonals are 2 long and 0.1 apart; every edge is sqrt(2 + 0.1^2) long.
    const std::vector<double> quad{1, 0, 0.05, 0, 1, -0.05, -1, 0, 0.05, 0, -1, -0.05};
    const std::vector<int> twice{0, 1, 2, 3, 1, 2, 3, 0};
    const std::vector<double> planarity = shapeop::measure_faces("planarity", quad, twice, {4});
    check(planarity.size() == 2, "one for each face");
    near(planarity.at(0), 0.05, "0.1 / 2");
    near(shapeop::measure_faces("mean_edge", quad, twice, {4, 4}).at(1), std::sqrt(2.01), "edge");
    near(shapeop::measure_faces("plane_distance", quad, twice, {4}).at(0), 0.05, "half of the distance");
    for (const std::string &name : shapeop::measure_names()) {
        check(shapeop::measure_faces(name, quad, twice, {4}).size() == 2, name);
    }
}

void arrays_of_all_kinds_are_taken_as_they_lie() {
    static_assert(!std::is_copy_constructible_v<Solver> && !std::is_copy_assignable_v<Solver>);
    static_assert(std::is_nothrow_move_constructible_v<Solver> && std::is_nothrow_move_assignable_v<Solver>);
    // Other element types do not compile: no number is converted behind the caller's back.
    static_assert(!std::is_convertible_v<std::vector<long> &, shapeop::Indices>);
    static_assert(!std::is_convertible_v<std::vector<double> &, shapeop::Indices>);
    static_assert(!std::is_convertible_v<std::vector<float> &, shapeop::Numbers>);
    static_assert(!std::is_convertible_v<const std::vector<double> &, shapeop::Span<double>>);
    Solver solver;
    double c_array[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::array<double, 9> array{0, 0, 1, 1, 0, 1, 0, 1, 1};
    const std::vector<int> ids{0, 1, 2};
    solver.set_points(c_array);
    check(solver.points()[2] == 0, "C array");
    solver.set_points(array);
    check(solver.points()[2] == 1, "std::array");
    solver.set_points({c_array, 9});
    check(solver.points()[2] == 0, "pointer and length");
    solver.add_constraint("Plane", ids);
    solver.add_constraint("Plane", {ids.data(), 3});
#if __cplusplus >= 202002L
    solver.add_constraint("Plane", std::span(ids));
    solver.set_points(std::span<const double, 9>(array));
    check(solver.points()[2] == 1, "std::span");
#endif
    solver.copy_points(c_array);
    check(solver.constraint_count() >= 2 && c_array[3] == 1, "copied into a C array");
}

} // namespace

int main() {
    return run({
        {"a point rests at the weighted mean of its targets", a_point_rests_at_the_weighted_mean_of_its_targets},
        {"edits of scalars and weights move it", edits_of_scalars_and_weights_move_it},
        {"a force moves a held point by its size over the weight",
         a_force_moves_a_held_point_by_its_size_over_the_weight},
        {"a dropped point falls as implicit euler says", a_dropped_point_falls_as_implicit_euler_says},
        {"solvers on different threads do not meet", solvers_on_different_threads_do_not_meet},
        {"progress sees every iterate and can stop", progress_sees_every_iterate_and_can_stop},
        {"an unbounded problem is an outcome with a note", an_unbounded_problem_is_an_outcome_with_a_note},
        {"solvers are deleted once and in time", solvers_are_deleted_once_and_in_time},
        {"the registry describes every type", the_registry_describes_every_type},
        {"a recipe is the problem that one would add by hand", a_recipe_is_the_problem_that_one_would_add_by_hand},
        {"anchors keep their place", anchors_keep_their_place},
        {"faces are measured", faces_are_measured},
        {"arrays of all kinds are taken as they lie", arrays_of_all_kinds_are_taken_as_they_lie},
    });
}
