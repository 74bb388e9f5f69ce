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
    check(report.backend == SO_BACKEND_CPU && report.gpu_iterations == 0, "the processor iterated");

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
    // Types that refer to a shape take the first of its kind unless they are told.
    sheet.solver.add_reference_polyline(sheet.points);
    sheet.solver.add_reference_mesh(sheet.points, {0, 1, 2});
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

void a_hard_plane_is_the_best_fit_plane() {
    // Corners alternately above and below z = 0: with closeness alone the nearest planar quad is the square itself.
    Solver solver;
    solver.set_points({0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1});
    const std::vector<int> planes = solver.add_constraints("Plane", {0, 1, 2, 3}, {4}, {1.0}, {}, true);
    check(solver.is_hard(planes.at(0)) && !solver.is_hard(7), "which are hard");
    shapeop::Objective objective;
    near(objective.handle_weight, 100, "a default");
    objective.fairness_weight = 0;
    solver.set_objective(objective);
    solver.init();
    check(solver.solve_until().outcome == SO_OUTCOME_CONVERGED, "converged");
    const std::vector<double> points = solver.points();
    const std::vector<double> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    for (std::size_t i = 0; i < points.size(); ++i) {
        near(points[i], square[i], "the square", 1e-11);
    }
    const shapeop::Exploration found = solver.exploration();
    check(found.is_solution == 1 && found.worst_constraint == 0 && found.largest_violation < 1e-11, "a solution");
    near(found.closeness_term, 0.002, "half of 0.1 times 4 * 0.1^2", 1e-12);
    check(solver.conflicts().empty(), "no contradiction");
    solver.set_hard(planes[0], false);
    check(!solver.is_hard(planes[0]), "soft again");
}

void a_handle_takes_its_edge_along_as_the_weights_say() {
    // A hard length 1 along x: 3 (t - 1)^2 + t^2 is least at t = 3/4, and dt / d ln w is 3/16 for the handle.
    Solver solver;
    solver.set_points({0, 0, 0, 1, 0, 0});
    const int edge = solver.add_constraint("EdgeLength", {0, 1}, 1, {1, 1});
    solver.set_hard(edge);
    shapeop::Objective objective;
    objective.handle_weight = 3;
    objective.closeness_weight = 1;
    objective.fairness_weight = 0;
    solver.set_objective(objective);
    solver.init();
    solver.set_handle(1, {2, 0, 0});
    solver.solve_until();
    near(solver.points()[0], 0.75, "t");
    near(solver.exploration().handle_term, 3.0 / 32, "half of 3 / 16");
    const shapeop::Sensitivities answer = solver.sensitivities();
    check(answer.classes == std::vector<std::string>({"handles", "closeness", "fairness"}), "the classes");
    check(answer.points.size() == 3 * 2 * 3 && answer.squares.size() == 9, "their sizes");
    near(answer.points.at(0), 3.0 / 16, "handles", 1e-8);
    near(answer.points.at(6), -3.0 / 16, "closeness", 1e-8);
    near(answer.points.at(12), 0, "fairness", 1e-12);
    near(answer.squares.at(0), -2 * 3 * 0.25 * 3 / 16, "the square of the handle", 1e-8);
    solver.release_handle(1);
    solver.solve_until();
    near(solver.points()[0], 0, "released");
}

void fairness_is_measured_on_what_it_is_told() {
    // Second differences of 3 points along z, the last drawn to 1: the gradient w (z - t) + f L^T L z vanishes.
    const auto solved = [](const std::vector<int> &indices, const std::vector<int> &counts) {
        Solver solver;
        solver.set_points({0, 0, 0, 1, 0, 0, 2, 0, 0});
        shapeop::Objective objective;
        objective.handle_weight = 4;
        objective.closeness_weight = 0.5;
        objective.fairness_weight = 2;
        solver.set_objective(objective);
        solver.set_fairness(SO_FAIRNESS_SECOND_DIFFERENCES, indices, counts);
        solver.set_handle(2, {2, 0, 1});
        solver.init();
        solver.solve_until();
        const std::vector<double> points = solver.points();
        return std::array<double, 3>{points[2], points[5], points[8]};
    };
    const auto z = solved({0, 1, 2}, {3});
    const double difference = z[0] - 2 * z[1] + z[2];
    near(0.5 * z[0] + 2 * difference, 0, "first");
    near(0.5 * z[1] - 4 * difference, 0, "second");
    near(4 * (z[2] - 1) + 2 * difference, 0, "last");
    check(std::abs(difference) > 1e-2, "fairness counts");
    // Once for all, once for each: the same row twice.
    const auto twice = solved({0, 1, 2, 0, 1, 2}, {3});
    check(twice == solved({0, 1, 2, 0, 1, 2}, {3, 3}), "counts of both kinds");
    near(0.5 * twice[0] + 4 * (twice[0] - 2 * twice[1] + twice[2]), 0, "twice");
}

void a_contradiction_is_named() {
    Solver solver;
    solver.set_points({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    solver.add_constraints("EdgeLength", {0, 1, 1, 2, 2, 3, 3, 0}, {2}, {2.0}, Scalars::same({1, 1}), true);
    const int planted = solver.add_constraints("EdgeLength", {0, 1}, {2}, {1.0}, Scalars::same({3, 3}), true)[0];
    solver.set_fairness(SO_FAIRNESS_LAPLACIAN, {0, 1, 2, 3}, {4});
    solver.init();
    check(solver.solve_until().outcome == SO_OUTCOME_INFEASIBLE, "infeasible");
    check(solver.conflicts() == std::vector<int>{planted}, "which one");
}

void points_are_drawn_to_references() {
    Solver solver;
    const std::vector<double> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const int open = solver.add_reference_polyline(square), closed = solver.add_reference_polyline(square, true);
    const int mesh = solver.add_reference_mesh(square, {0, 1, 2, 0, 2, 3});
    check(open == 0 && closed == 1 && mesh == 2 && solver.reference_count() == 3, "ids");
    solver.set_points({-1, 0.25, 0, -1, 0.25, 0, 0.75, 0.25, 3});
    solver.add_constraints("OnCurve", {0, 1}, {1}, {1.0}, Scalars::each({double(open), double(closed)}));
    solver.add_constraint("OnMesh", {2}, 1, {double(mesh)});
    solver.init();
    solver.solve(1);
    const std::vector<double> points = solver.points();
    check(points[0] == 0 && points[1] == 0, "the end of the open one");
    check(points[3] == 0 && points[4] == 0.25, "the last segment of the closed one");
    check(points[6] == 0.75 && points[7] == 0.25 && points[8] == 0, "the mesh");
}

void forces_on_faces_move_held_points_by_their_size_over_the_weight() {
    Solver solver;
    const std::vector<double> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    solver.set_points(square);
    solver.add_constraints("Closeness", {0, 1, 2, 3}, {1}, {2.0});
    const int pressure = solver.add_pressure({0, 1, 2, 3}, {4}, 8);
    solver.init();
    const auto height = [&] {
        solver.set_points(square);
        solver.solve(1);
        return solver.points()[2];
    };
    near(height(), 1, "a quarter of 8 over 2");
    solver.edit_force_magnitude(pressure, -4);
    near(height(), -0.5, "a quarter of -4 over 2");
    solver.remove_force(pressure);
    solver.add_normal_force({0, 1, 2, 0, 2, 3}, {3}, 3);
    near(height(), 1.5, "3 over 2, once per point");
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
        {"a hard plane is the best fit plane", a_hard_plane_is_the_best_fit_plane},
        {"a handle takes its edge along as the weights say", a_handle_takes_its_edge_along_as_the_weights_say},
        {"fairness is measured on what it is told", fairness_is_measured_on_what_it_is_told},
        {"a contradiction is named", a_contradiction_is_named},
        {"points are drawn to references", points_are_drawn_to_references},
        {"forces on faces move held points by their size over the weight",
         forces_on_faces_move_held_points_by_their_size_over_the_weight},
        {"arrays of all kinds are taken as they lie", arrays_of_all_kinds_are_taken_as_they_lie},
    });
}
