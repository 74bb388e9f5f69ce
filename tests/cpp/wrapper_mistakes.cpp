// The C++ wrapper: mistakes are answered in the library's words, and change nothing. Ends with 0 if all is well.
#include "wrapper_test.hpp"

#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

void wrong_arguments_are_named_and_change_nothing() {
    Sheet sheet;
    Solver &solver = sheet.solver;
    const int count = solver.constraint_count();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused(SO_INVALID_CONSTRAINT_TYPE, {"\"Plain\"", "Plane"}, "type",
            [&] { solver.add_constraint("Plain", {0, 1, 2}); });
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
    refused(SO_INVALID_ARGUMENT_LENGTH, {"ids"}, "counts",
            [&] { solver.add_constraints("Plane", {0, 1, 2, 3, 4}, {3}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "count 0",
            [&] { solver.add_constraints("Plane", {0, 1, 2}, {0}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "no counts",
            [&] { solver.add_constraints("Plane", {0, 1, 2}, {}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"weights"}, "weights",
            [&] { solver.add_constraints("Plane", sheet.quads, {4}, {1, 2, 3}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalars"}, "scalars of each",
            [&] { solver.add_constraints("EdgeStrain", {0, 1, 2, 3}, {2}, {1}, Scalars::each({1, 1, 1})); });
    check(solver.constraint_count() == count, "none was added");

    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "id", [&] { solver.edit_constraint("Closeness", 9999, {0, 0, 0}); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {}, "id of another type",
            [&] { solver.edit_constraint("Closeness", 0, {0, 0, 0}); });
    refused(SO_INVALID_CONSTRAINT_TYPE, {"Plane"}, "uneditable", [&] { solver.edit_constraint("Plane", 0, {1}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {}, "edit", [&] { solver.edit_constraint("Closeness", count - 1, {0, 0}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"scalar"}, "edits without scalars",
            [&] { solver.edit_constraints("Closeness", {count - 1, count - 2}, Scalars()); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"-7"}, "weight of none", [&] { solver.set_weight(-7, 1); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "weights of some", [&] { solver.set_weights({0, 9999}, {1}); });
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"9999"}, "removing none", [&] { solver.remove_constraint(9999); });
    refused(SO_UNMATCHING_FORCE_ID, {"0"}, "removing no force", [&] { solver.remove_force(0); });

    refused(SO_INVALID_ARGUMENT_LENGTH, {"points", "7"}, "7 numbers",
            [&] { solver.set_points({1, 2, 3, 4, 5, 6, 7}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"point"}, "fewer points than are used", [&] { solver.set_points({0, 0, 0}); });
    std::vector<double> bad = sheet.points;
    bad[4] = nan;
    refused(SO_INVALID_VALUE, {"points", "NaN"}, "a point that is none", [&] { solver.set_points(bad); });
    std::vector<double> too_short(3, 7.0);
    refused(SO_INVALID_ARGUMENT_LENGTH, {"64"}, "room for one", [&] { solver.copy_points(too_short); });
    check(too_short == std::vector<double>(3, 7.0), "nothing was written");
    refused(SO_INVALID_ARGUMENT_LENGTH, {"force", "2"}, "two components", [&] { solver.add_gravity_force({0, 1}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"64"}, "force on no point", [&] { solver.add_vertex_force({0, 0, 1}, 64); });
    refused(SO_UNMATCHING_FORCE_ID, {"force"}, "edit of no force", [&] { solver.edit_vertex_force(3, {0, 0, 1}, 0); });
    check(solver.force_count() == 0 && solver.points() == sheet.points, "as it was");

    refused(SO_INVALID_VALUE, {"mass"}, "mass", [&] { solver.init_dynamic(0, 1, 1); });
    refused(SO_INVALID_VALUE, {"timestep"}, "time step", [&] { solver.set_time_step(-1); });
    refused(SO_INVALID_VALUE, {"damping"}, "damping", [&] { solver.set_damping(nan); });
    refused(SO_INVALID_VALUE, {"5000"}, "threads", [&] { solver.set_thread_count(5000); });
    refused(SO_INVALID_VALUE, {"memory"}, "memory", [&] { solver.set_acceleration(SO_ACCELERATION_ANDERSON, 65); });
    // The greatest number that fits the two bits of the enumeration.
    refused(SO_INVALID_VALUE, {"backend", "3"}, "no backend",
            [&] { solver.set_backend(static_cast<shapeop_backend>(3)); });
    refused(SO_INVALID_VALUE, {"binding_bytes"}, "half a byte", [&] { solver.set_backend_options("", 0.5); });
    refused(SO_INVALID_INPUT, {"adapter", "zero byte"}, "a card with a zero",
            [&] { solver.set_backend_options(std::string("a\0b", 3)); });
    // The libraries that these tests run with are built without the feature.
    refused(SO_BACKEND_UNAVAILABLE, {"feature", "gpu"}, "no card", [&] { solver.set_backend(SO_BACKEND_GPU); });
    refused(SO_BACKEND_UNAVAILABLE, {"feature", "gpu"}, "no card to describe", [&] { solver.backend_info(); });
    check(solver.backend() == SO_BACKEND_CPU, "the backend is as it was");
    shapeop::SolveOptions options;
    options.tolerance = -1;
    refused(SO_INVALID_VALUE, {"tolerance"}, "tolerance", [&] { solver.solve_until(options); });
    Solver fresh;
    refused(SO_NOT_INITIALISED, {"init"}, "solve before init", [&] { fresh.solve(1); });
    refused(SO_NOT_INITIALISED, {"init"}, "solve_until before init", [&] { fresh.solve_until(); });
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
    refused(SO_BUSY, {"busy"}, "solving meanwhile", [&] { sheet.solver.solve(1); });
    refused(SO_BUSY, {"busy"}, "points meanwhile", [&] { sheet.solver.set_points(sheet.points); });
    refused(SO_BUSY, {"busy"}, "counting meanwhile", [&] { sheet.solver.constraint_count(); });
    is_done = true;
    other.join();
    sheet.solver.set_weight(0, 2);
}

void a_solver_that_was_moved_from_refuses() {
    Solver solver;
    solver.set_points({1, 2, 3});
    Solver moved = std::move(solver);
    check(moved.points() == std::vector<double>({1, 2, 3}), "what was moved");
    check(solver.handle() == nullptr, "nothing is left");
    const std::vector<std::string> words{"handle"};
    refused(SO_INVALID_HANDLE, words, "set_points", [&] { solver.set_points({0, 0, 0}); });
    refused(SO_INVALID_HANDLE, words, "points", [&] { solver.points(); });
    refused(SO_INVALID_HANDLE, words, "init", [&] { solver.init(); });
    refused(SO_INVALID_HANDLE, words, "solve", [&] { solver.solve(1); });
    refused(SO_INVALID_HANDLE, words, "add_gravity_force", [&] { solver.add_gravity_force({0, 0, 1}); });
    refused(SO_INVALID_HANDLE, words, "add_constraint", [&] { solver.add_constraint("Closeness", {0}); });
    refused(SO_INVALID_HANDLE, words, "solve_until", [&] { solver.solve_until(); });
    refused(SO_INVALID_HANDLE, words, "energy", [&] { solver.energy(); });
    refused(SO_INVALID_HANDLE, words, "backend", [&] { solver.backend(); });
    refused(SO_INVALID_HANDLE, words, "set_problem", [&] { solver.set_problem("{}"); });
    solver = std::move(moved);
    check(solver.points().size() == 3, "moved back");
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
    refused(SO_BUSY, {"busy"}, "moving points from inside the callback", [&] {
        sheet.solver.solve_until(sheet.options,
                                 [&](const shapeop::Progress &) { sheet.solver.set_points(sheet.points); });
    });
    sheet.solver.solve(1); // and it goes on
}

void what_cannot_be_explored_is_named_and_changes_nothing() {
    Tug tug;
    Solver &solver = tug.solver;
    const double nan = std::nan("");
    refused(SO_UNMATCHING_CONSTRAINT_ID, {"77"}, "no constraint", [&] { solver.set_hard(77); });
    refused(SO_INVALID_VALUE, {"EdgeStrain", "cannot be hard"}, "no length",
            [&] { solver.add_constraints("EdgeStrain", {0, 0}, {2}, {1.0}, {}, true); });
    refused(SO_INDEX_OUT_OF_RANGE, {"1 is out of range for 1 points"}, "no point",
            [&] { solver.set_handle(1, {0, 0, 0}); });
    refused(SO_INVALID_VALUE, {"target", "NaN"}, "target", [&] { solver.set_handle(0, {0, nan, 0}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"target", "3", "2"}, "short target", [&] { solver.set_handle(0, {0, 0}); });
    refused(SO_INVALID_VALUE, {"point 0 is no handle"}, "release", [&] { solver.release_handle(0); });
    shapeop::Objective objective;
    objective.closeness_weight = -1;
    refused(SO_INVALID_VALUE, {"closeness_weight", "-1"}, "weight", [&] { solver.set_objective(objective); });
    refused(SO_INDEX_OUT_OF_RANGE, {"indices[1]", "4"}, "fairness",
            [&] { solver.set_fairness(SO_FAIRNESS_LAPLACIAN, {0, 4}, {2}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts[0]", "3"}, "counts",
            [&] { solver.set_fairness(SO_FAIRNESS_LAPLACIAN, {0, 0}, {3, 1}); });
    refused(SO_INVALID_VALUE, {"kind", "3"}, "kind",
            [&] { solver.set_fairness(static_cast<shapeop_fairness>(3), {}, {}); });
    refused(SO_NOT_INITIALISED, {"no exploration yet"}, "nothing found", [&] { solver.exploration(); });
    refused(SO_NOT_INITIALISED, {"solve"}, "no solution", [&] { solver.sensitivities(); });
    check(solver.conflicts().empty(), "no contradiction");
    refused(SO_INVALID_ARGUMENT_LENGTH, {"points", "at least 2", "1"}, "a polyline of one point",
            [&] { solver.add_reference_polyline({0, 0, 0}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"triangles[0][2]", "3"}, "no corner",
            [&] { solver.add_reference_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 3}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"triangles", "found 4"}, "four indices",
            [&] { solver.add_reference_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2, 0}); });
    refused(SO_INVALID_VALUE, {"NaN"}, "pressure", [&] { solver.add_pressure({0, 0, 0}, {3}, nan); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"faces[0]", "2"}, "two corners",
            [&] { solver.add_normal_force({0, 0}, {2}, 1); });
    refused(SO_UNMATCHING_FORCE_ID, {"0"}, "no force", [&] { solver.edit_force_magnitude(0, 1); });
    check(solver.reference_count() == 0 && solver.force_count() == 0 && solver.constraint_count() == 2, "as it was");
    near(tug.rest(), 3, "and as it rested");
    solver.init_dynamic(1, 1, 1);
    refused(SO_INVALID_VALUE, {"static"}, "hard in dynamic mode", [&] { solver.set_hard(tug.left); });
    Solver moved = std::move(solver);
    refused(SO_INVALID_HANDLE, {"handle"}, "moved from", [&] { solver.set_handle(0, {0, 0, 0}); });
    refused(SO_INVALID_HANDLE, {"handle"}, "moved from", [&] { solver.sensitivities(); });
}

void a_problem_that_cannot_be_read_is_refused_with_its_place() {
    Tug tug;
    refused(SO_INVALID_INPUT, {}, "no JSON", [&] { tug.solver.set_problem("{"); });
    refused(SO_INVALID_INPUT, {"zero byte"}, "JSON with a zero",
            [&] { tug.solver.set_problem(std::string("{}\0", 3)); });
    const std::string json = R"({"version": 1, "points": [[0, 0, 0]],
        "constraints": [{"type": "Closeness", "indices": [0]}, {"type": "Closeness", "indices": [3]}]})";
    refused(SO_INDEX_OUT_OF_RANGE, {"constraints[1]"}, "index in JSON", [&] { tug.solver.set_problem(json); });
    near(tug.rest(), 3, "the solver is as before");
    refused(SO_INDEX_OUT_OF_RANGE, {"constraints[1]"}, "the same as text", [&] { shapeop::problem_text(json); });
    check(!shapeop::recipe_names().empty(), "recipes");
    refused(SO_INVALID_VALUE, {"\"flatten\"", shapeop::recipe_names().front()}, "recipe",
            [&] { shapeop::recipe("flatten", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {3}); });
}

void faces_that_cannot_be_measured_are_refused() {
    const std::vector<double> quad{1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
    const std::vector<int> twice{0, 1, 2, 3, 1, 2, 3, 0};
    refused(SO_INVALID_VALUE, {"\"flatness\"", "planarity"}, "measure",
            [&] { shapeop::measure_faces("flatness", quad, twice, {4}); });
    refused(SO_INVALID_ARGUMENT_LENGTH, {"counts"}, "counts",
            [&] { shapeop::measure_faces("planarity", quad, twice, {3, 3}); });
    refused(SO_INDEX_OUT_OF_RANGE, {"4"}, "corner", [&] { shapeop::measure_faces("planarity", quad, {0, 1, 4}, {3}); });
}

} // namespace

int main() {
    return run({
        {"wrong arguments are named and change nothing", wrong_arguments_are_named_and_change_nothing},
        {"a solver in use by another thread refuses", a_solver_in_use_by_another_thread_refuses},
        {"a solver that was moved from refuses", a_solver_that_was_moved_from_refuses},
        {"an exception in the callback comes out of solve until",
         an_exception_in_the_callback_comes_out_of_solve_until},
        {"what cannot be explored is named and changes nothing", what_cannot_be_explored_is_named_and_changes_nothing},
        {"a problem that cannot be read is refused with its place",
         a_problem_that_cannot_be_read_is_refused_with_its_place},
        {"faces that cannot be measured are refused", faces_that_cannot_be_measured_are_refused},
    });
}
