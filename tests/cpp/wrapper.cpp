// The C++ wrapper: analytic truths through it, and mistakes that it must answer with the library's words. Ends with 0 if
// all is well.
#include <shapeop.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>
#if __cplusplus >= 202002L
#include <span>
#endif

namespace {

using shapeop::Scalars;
using shapeop::Solver;

std::atomic<int> checks{0}, failures{0};

void check(bool is_true, const std::string &what) {
    ++checks;
    if (!is_true) {
        std::fprintf(stderr, "wrong: %s\n", what.c_str());
        ++failures;
    }
}

void near(double found, double expected, const std::string &what, double tolerance = 1e-9) {
    check(std::abs(found - expected) <= tolerance,
          what + ": expected " + std::to_string(expected) + ", found " + std::to_string(found));
}

// The call throws an Error of this code (where the C function gives one) with these words in its text.
template <class Call>
void refused(std::optional<shapeop_err> code, const std::vector<std::string> &words, const std::string &what, Call call) {
    try {
        call();
        check(false, what + " was accepted");
    } catch (const shapeop::Error &error) {
        const std::string text = error.what();
        check(error.code() == code, what + ": code " + (error.code() ? std::to_string(*error.code()) : "none"));
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

void solvers_on_different_threads_do_not_meet() {
    std::vector<std::thread> threads;
    for (int n = 3; n < 9; ++n) {
        threads.emplace_back(polygon, n);
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

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
    const shapeop::Report all =
        sheet.solver.solve_until(sheet.options, [&](const shapeop::Progress &) { ++calls; });
    check(calls == 5 && all.outcome == SO_OUTCOME_ITERATION_LIMIT, "a callback that returns nothing goes on");
}

void an_exception_in_the_callback_comes_out_of_solve_until() {
    Sheet sheet;
    struct Custom {
        int number;
    };
    unsigned int calls = 0;
    try {
        sheet.solver.solve_until(sheet.options, [&](const shapeop::Progress &) {
            if (++calls == 3) {
                throw Custom{42};
            }
        });
        check(false, "the exception was lost");
    } catch (const Custom &custom) {
        check(custom.number == 42 && calls == 3, "the same exception, at once");
    }
    check(sheet.solver.points() != sheet.points, "what was reached is kept");
    try {
        sheet.solver.solve_until(sheet.options,
                                 [](const shapeop::Progress &) -> bool { throw std::runtime_error("enough"); });
        check(false, "the second exception was lost");
    } catch (const std::runtime_error &error) {
        check(std::string(error.what()) == "enough", "a second exception");
    }
    refused(std::nullopt, {"busy"}, "moving points from inside the callback", [&] {
        sheet.solver.solve_until(sheet.options, [&](const shapeop::Progress &) { sheet.solver.set_points(sheet.points); });
    });
    sheet.solver.solve(1); // and it goes on
}

void a_solver_in_use_by_another_thread_refuses() {
    Sheet sheet;
    std::atomic<bool> is_inside{false}, is_done{false};
    std::thread other([&] {
        sheet.solver.solve_until(sheet.options, [&](const shapeop::Progress &) {
            is_inside = true;
            while (!is_done) {
                std::this_thread::yield();
            }
            return false;
        });
    });
    while (!is_inside) {
        std::this_thread::yield();
    }
    refused(SO_BUSY, {"busy"}, "an edit meanwhile", [&] { sheet.solver.set_weight(0, 2); });
    refused(SO_BUSY, {"busy"}, "reading meanwhile", [&] { sheet.solver.energy(); });
    refused(std::nullopt, {"busy"}, "solving meanwhile", [&] { sheet.solver.solve(1); });
    refused(std::nullopt, {"busy"}, "points meanwhile", [&] { sheet.solver.set_points(sheet.points); });
    refused(std::nullopt, {"busy"}, "counting meanwhile", [&] { sheet.solver.constraint_count(); });
    is_done = true;
    other.join();
    sheet.solver.set_weight(0, 2);
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
    refused(std::nullopt, {"force"}, "a plain solve of it", [&] { solver.solve(1); });
    check(solver.points() == std::vector<double>({0, 0, 0, 1, 0, 0}), "nothing moved");
}

void a_solver_that_was_moved_from_refuses() {
    Solver solver;
    solver.set_points({1, 2, 3});
    Solver moved = std::move(solver);
    check(moved.points() == std::vector<double>({1, 2, 3}), "what was moved");
    check(solver.handle() == nullptr, "nothing is left");
    const std::vector<std::string> words{"handle"};
    refused(std::nullopt, words, "set_points", [&] { solver.set_points({0, 0, 0}); });
    refused(std::nullopt, words, "points", [&] { solver.points(); });
    refused(std::nullopt, words, "init", [&] { solver.init(); });
    refused(std::nullopt, words, "solve", [&] { solver.solve(1); });
    refused(std::nullopt, words, "add_gravity_force", [&] { solver.add_gravity_force({0, 0, 1}); });
    refused(SO_INVALID_HANDLE, words, "add_constraint", [&] { solver.add_constraint("Closeness", {0}); });
    refused(SO_INVALID_HANDLE, words, "solve_until", [&] { solver.solve_until(); });
    refused(SO_INVALID_HANDLE, words, "energy", [&] { solver.energy(); });
    refused(SO_INVALID_HANDLE, words, "set_problem", [&] { solver.set_problem("{}"); });
    solver = std::move(moved);
    check(solver.points().size() == 3, "moved back");
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

void wrong_arguments_are_named_and_change_nothing() {
    Sheet sheet;
    Solver &solver = sheet.solver;
    const int count = solver.constraint_count();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused(SO_INVALID_CONSTRAINT_TYPE, {"\"Plain\"", "Plane"}, "type", [&] { solver.add_constraint("Plain", {0, 1, 2}); });
    refused(SO_INVALID_INPUT, {"type", "zero byte"}, "type with a zero",
            [&] { solver.add_constraint(std::string("Plane\0x", 7), {0, 1, 2}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"5000", "64"}, "index", [&] { solver.add_constraint("Plane", {0, 1, 5000}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"-1"}, "negative index", [&] { solver.add_constraint("Plane", {0, 1, -1}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"Plane"}, "too few indices", [&] { solver.add_constraint("Plane", {0, 1}); });
    refused(SO_INVALID_VALUE, {"weight"}, "weight", [&] { solver.add_constraint("Plane", {0, 1, 2}, -1); });
    refused(SO_INVALID_VALUE, {"weight"}, "weight", [&] { solver.add_constraint("Plane", {0, 1, 2}, nan); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalars"}, "scalars",
            [&] { solver.add_constraint("EdgeStrain", {0, 1}, 1, {1, 1}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalars"}, "no scalars where there should be some",
            [&] { solver.add_constraint("EdgeStrain", {0, 1}, 1, std::vector<double>()); });
    refused(SO_INVALID_VALUE, {}, "scalar", [&] { solver.add_constraint("EdgeStrain", {0, 1}, 1, {nan, 1, 1}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"ids"}, "counts", [&] { solver.add_constraints("Plane", {0, 1, 2, 3, 4}, {3}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "count 0", [&] { solver.add_constraints("Plane", {0, 1, 2}, {0}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "no counts", [&] { solver.add_constraints("Plane", {0, 1, 2}, {}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"weights"}, "weights",
            [&] { solver.add_constraints("Plane", sheet.quads, {4}, {1, 2, 3}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalars"}, "scalars of each",
            [&] { solver.add_constraints("EdgeStrain", {0, 1, 2, 3}, {2}, {1}, Scalars::each({1, 1, 1})); });
    check(solver.constraint_count() == count, "none was added");

    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "id", [&] { solver.edit_constraint("Closeness", 9999, {0, 0, 0}); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {}, "id of another type", [&] { solver.edit_constraint("Closeness", 0, {0, 0, 0}); });
    refused(SO_INVALID_CONSTRAINT_TYPE, {"Plane"}, "uneditable", [&] { solver.edit_constraint("Plane", 0, {1}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {}, "edit", [&] { solver.edit_constraint("Closeness", count - 1, {0, 0}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalar"}, "edits without scalars",
            [&] { solver.edit_constraints("Closeness", {count - 1, count - 2}, Scalars()); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"-7"}, "weight of none", [&] { solver.set_weight(-7, 1); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "weights of some", [&] { solver.set_weights({0, 9999}, {1}); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "removing none", [&] { solver.remove_constraint(9999); });
    refused(SO_UNMATCHING_FORCE_ID, {"0"}, "removing no force", [&] { solver.remove_force(0); });

    refused(SO_INVALID_ARGUMENT_LENGTH, {"points", "7"}, "7 numbers", [&] { solver.set_points({1, 2, 3, 4, 5, 6, 7}); });
    refused(std::nullopt, {"point"}, "fewer points than are used", [&] { solver.set_points({0, 0, 0}); });
    std::vector<double> bad = sheet.points;
    bad[4] = nan;
    refused(std::nullopt, {"points", "NaN"}, "a point that is none", [&] { solver.set_points(bad); });
    std::vector<double> too_short(3, 7.0);
    refused(std::nullopt, {"64"}, "room for one", [&] { solver.copy_points(too_short); });
    check(too_short == std::vector<double>(3, 7.0), "nothing was written");
    refused(SO_INVALID_ARGUMENT_LENGTH, {"force", "2"}, "two components", [&] { solver.add_gravity_force({0, 1}); });
    refused(std::nullopt, {"64"}, "force on no point", [&] { solver.add_vertex_force({0, 0, 1}, 64); });
    refused(std::nullopt, {"force"}, "edit of no force", [&] { solver.edit_vertex_force(3, {0, 0, 1}, 0); });
    check(solver.force_count() == 0 && solver.points() == sheet.points, "as it was");

    refused(std::nullopt, {"mass"}, "mass", [&] { solver.init_dynamic(0, 1, 1); });
    refused(std::nullopt, {"timestep"}, "time step", [&] { solver.set_time_step(-1); });
    refused(std::nullopt, {"damping"}, "damping", [&] { solver.set_damping(nan); });
    refused(SO_INVALID_VALUE, {"5000"}, "threads", [&] { solver.set_thread_count(5000); });
    refused(SO_INVALID_VALUE, {"memory"}, "memory", [&] { solver.set_acceleration(SO_ACCELERATION_ANDERSON, 65); });
    shapeop::SolveOptions options;
    options.tolerance = -1;
    refused(SO_INVALID_VALUE, {"tolerance"}, "tolerance", [&] { solver.solve_until(options); });
    Solver fresh;
    refused(std::nullopt, {"init"}, "solve before init", [&] { fresh.solve(1); });
    refused(SO_NOT_INITIALISED, {"init"}, "solve_until before init", [&] { fresh.solve_until(); });
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
    for (std::size_t i : {0, 1, 2, 27, 28, 29}) {
        near(points[i], sheet.points[i], "anchor", 1e-2);
    }
    refused(std::nullopt, {"anchors", "64"}, "an anchor that is no point",
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
    refused(SO_INVALID_VALUE, {"\"flatness\"", "planarity"}, "measure",
            [&] { shapeop::measure_faces("flatness", quad, twice, {4}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "counts", [&] { shapeop::measure_faces("planarity", quad, twice, {3, 3}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"4"}, "corner", [&] { shapeop::measure_faces("planarity", quad, {0, 1, 4}, {3}); });
}

void a_problem_that_cannot_be_read_is_refused_with_its_place() {
    Tug tug;
    refused(SO_INVALID_INPUT, {}, "no JSON", [&] { tug.solver.set_problem("{"); });
    refused(SO_INVALID_INPUT, {"zero byte"}, "JSON with a zero", [&] { tug.solver.set_problem(std::string("{}\0", 3)); });
    const std::string json = R"({"version": 1, "points": [[0, 0, 0]],
        "constraints": [{"type": "Closeness", "indices": [0]}, {"type": "Closeness", "indices": [3]}]})";
    refused(SO_INDEX_OUT_OF_RANGE, {"constraints[1]"}, "index in JSON", [&] { tug.solver.set_problem(json); });
    near(tug.rest(), 3, "the solver is as before");
    refused(std::nullopt, {"constraints[1]"}, "the same as text", [&] { shapeop::problem_text(json); });
    check(!shapeop::recipe_names().empty(), "recipes");
    refused(std::nullopt, {"\"flatten\"", shapeop::recipe_names().front()}, "recipe",
            [&] { shapeop::recipe("flatten", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {3}); });
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
    const std::map<std::string, void (*)()> tests{
#define TEST(name) {#name, name}
        TEST(a_point_rests_at_the_weighted_mean_of_its_targets),
        TEST(edits_of_scalars_and_weights_move_it),
        TEST(a_force_moves_a_held_point_by_its_size_over_the_weight),
        TEST(a_dropped_point_falls_as_implicit_euler_says),
        TEST(solvers_on_different_threads_do_not_meet),
        TEST(progress_sees_every_iterate_and_can_stop),
        TEST(an_exception_in_the_callback_comes_out_of_solve_until),
        TEST(a_solver_in_use_by_another_thread_refuses),
        TEST(an_unbounded_problem_is_an_outcome_with_a_note),
        TEST(a_solver_that_was_moved_from_refuses),
        TEST(solvers_are_deleted_once_and_in_time),
        TEST(wrong_arguments_are_named_and_change_nothing),
        TEST(the_registry_describes_every_type),
        TEST(a_recipe_is_the_problem_that_one_would_add_by_hand),
        TEST(anchors_keep_their_place),
        TEST(faces_are_measured),
        TEST(a_problem_that_cannot_be_read_is_refused_with_its_place),
        TEST(arrays_of_all_kinds_are_taken_as_they_lie),
#undef TEST
    };
    for (const auto &[name, test] : tests) {
        const int before = failures;
        try {
            test();
        } catch (const std::exception &error) {
            check(false, std::string("an exception: ") + error.what());
        }
        std::printf("%s %s\n", failures == before ? "ok    " : "FAILED", name.c_str());
    }
    std::printf("%d checks, %d failures\n", checks.load(), failures.load());
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
