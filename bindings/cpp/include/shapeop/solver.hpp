// The solver. Included by shapeop.hpp.
#ifndef SHAPEOP_SOLVER_HPP
#define SHAPEOP_SOLVER_HPP

#include "error.hpp"
#include "exploration.hpp"
#include "span.hpp"

#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace shapeop {

/// When to stop: the fields of shapeop_solve_options, with the library's defaults.
struct SolveOptions : shapeop_solve_options {
    SolveOptions() : shapeop_solve_options{} {
        struct_size = sizeof(shapeop_solve_options);
        detail::check(shapeop_defaultSolveOptions(this), nullptr);
    }
};

/// What a solve found: the fields of shapeop_solve_report.
struct Report : shapeop_solve_report {
    Report() : shapeop_solve_report{} { struct_size = sizeof(shapeop_solve_report); }

    /// Along which motion it is unbounded, or what happened to the graphics card, if that is the outcome; else empty.
    std::string note;

    /// Why it ran on this backend, in words.
    std::string backend_reason;
};

/// The graphics card that iterates: the fields of shapeop_backend_info. The texts stay valid.
struct BackendInfo : shapeop_backend_info {
    BackendInfo() : shapeop_backend_info{} { struct_size = sizeof(shapeop_backend_info); }
};

/// Gives the graphics card back, with all memory that solvers have on it. Solves that run on it end with the outcome
/// SO_OUTCOME_BACKEND_FAILED; later ones open it again.
inline void release_backend() { detail::check(shapeop_releaseBackend(), nullptr); }

/// What a progress callback is told: iteration, energy, largest_move.
using Progress = shapeop_progress;

/// The scalars of many constraints.
class Scalars {
public:
    /// The defaults of the type.
    Scalars() = default;
    /// The same for all constraints.
    static Scalars same(Numbers set) { return Scalars(set, Kind::same); }
    /// Those of each constraint, behind each other.
    static Scalars each(Numbers sets) { return Scalars(sets, Kind::each); }

    Numbers numbers() const { return numbers_; }
    /// How many sets these are for so many constraints.
    int set_count(int constraint_count) const {
        return kind_ == Kind::defaults ? 0 : kind_ == Kind::same ? 1 : constraint_count;
    }

private:
    enum class Kind { defaults, same, each };
    Scalars(Numbers numbers, Kind kind) : numbers_(numbers), kind_(kind) {}

    Numbers numbers_;
    Kind kind_ = Kind::defaults;
};

/// Points, constraints and forces, and what solves them. Movable, not copyable. A solver that was moved from refuses
/// every call, as does one that another thread is using. It must not be destroyed during a call on it.
class Solver {
public:
    /// A solver without points.
    Solver() : op_(shapeop_create()) {
        if (!op_) {
            detail::refuse(nullptr);
        }
        if (shapeop_abiVersion() != SHAPEOP_ABI_VERSION) {
            throw Error(SO_INVALID_INPUT, "the library has ABI version " + std::to_string(shapeop_abiVersion()) +
                                          ", this program was compiled for " + std::to_string(SHAPEOP_ABI_VERSION));
        }
    }

    /// For calls of the C functions; null if moved from.
    ShapeOpSolver *handle() const noexcept { return op_.get(); }

    /// Replaces everything by a problem in its JSON form, initialised; returns its stopping rules for `solve_until`.
    SolveOptions set_problem(const std::string &json) {
        SolveOptions options;
        detail::check(shapeop_setProblem(handle(), detail::c_text(json, "json"), &options), handle());
        return options;
    }

    // Points: x0 y0 z0 x1 ... in model units.

    void set_points(Numbers points) {
        // The C function does not change them.
        double *numbers = const_cast<double *>(points.data());
        shapeop_setPoints(handle(), numbers, points.point_count("points"));
        detail::check_void(handle());
    }

    std::vector<double> points() const {
        std::vector<double> points(3 * static_cast<std::size_t>(point_count()));
        copy_points(points);
        return points;
    }

    /// Copies them into an array of this length, such as that of the last frame.
    void copy_points(Span<double> points) const {
        shapeop_getPoints(handle(), points.data(), points.point_count("points"));
        detail::check_void(handle());
    }

    int point_count() const { return detail::check_number(shapeop_pointCount(handle()), handle()); }
    int unconstrained_count() const { return detail::check_number(shapeop_unconstrainedCount(handle()), handle()); }

    // Constraints.

    /// Adds one with its type's default scalars; returns its id.
    int add_constraint(const std::string &type, Indices ids, double weight = 1) {
        return add_one(type, ids, weight, {});
    }

    /// Adds one with these scalars; returns its id.
    int add_constraint(const std::string &type, Indices ids, double weight, Numbers scalars) {
        return add_one(type, ids, weight, Scalars::same(scalars));
    }

    /// Adds many of one type, all or none; returns their ids. `ids` are the point indices of all, behind each other;
    /// `counts` says how many belong to each, `weights` how heavy it is: one number for all, or one for each. Hard ones
    /// are met exactly.
    std::vector<int> add_constraints(const std::string &type, Indices ids, Indices counts, Numbers weights = {1.0},
                                     Scalars scalars = {}, bool is_hard = false) {
        std::vector<int> added(detail::part_count(ids, counts));
        add(type, ids, counts, weights, scalars, is_hard, added);
        return added;
    }

    void edit_constraint(const std::string &type, int id, Numbers scalars) {
        detail::check(shapeop_editConstraint(handle(), detail::c_text(type, "type"), id, scalars.data(),
                                             scalars.length("scalars")),
                      handle());
    }

    /// Edits many of one type, all or none: the same scalars for all, or those of each.
    void edit_constraints(const std::string &type, Indices constraints, Scalars scalars) {
        const int count = constraints.length("constraints");
        const Numbers numbers = scalars.numbers();
        detail::check(shapeop_editConstraints(handle(), detail::c_text(type, "type"), constraints.data(), count,
                                              numbers.data(), numbers.length("scalars"), scalars.set_count(count)),
                      handle());
    }

    void set_weight(int id, double weight) { detail::check(shapeop_setWeight(handle(), id, weight), handle()); }

    /// Sets many, all or none: one weight for all, or one for each.
    void set_weights(Indices constraints, Numbers weights) {
        detail::check(shapeop_setWeights(handle(), constraints.data(), constraints.length("constraints"),
                                         weights.data(), weights.length("weights")),
                      handle());
    }

    void remove_constraint(int id) { detail::check(shapeop_removeConstraint(handle(), id), handle()); }

    /// The number of ids given out: the length of arrays with one entry per constraint.
    int constraint_count() const { return detail::check_number(shapeop_constraintCount(handle()), handle()); }
    bool is_constraint(int id) const { return detail::check_number(shapeop_isConstraint(handle(), id), handle()) != 0; }
    bool is_degenerate(int id) const { return detail::check_number(shapeop_isDegenerate(handle(), id), handle()) != 0; }

    // References: shapes that "OnCurve" and "OnMesh" constraints name in their scalar by their id. Their points are none
    // of the solver.

    int add_reference_polyline(Numbers points, bool is_closed = false) {
        return detail::check_number(
            shapeop_addReferencePolyline(handle(), points.data(), points.point_count("points"), is_closed), handle());
    }

    /// `triangles`: 3 indices of points each.
    int add_reference_mesh(Numbers points, Indices triangles) {
        return detail::check_number(shapeop_addReferenceMesh(handle(), points.data(), points.point_count("points"),
                                                             triangles.data(), triangles.triangle_count("triangles")),
                                    handle());
    }

    int reference_count() const { return detail::check_number(shapeop_referenceCount(handle()), handle()); }

    // Exploration: hard constraints are met exactly, handles are dragged, and everything else changes as little and as
    // fairly as that allows.

    /// Hard: to be met exactly; the weight is then the priority where not everything can be met.
    void set_hard(int id, bool is_hard = true) { detail::check(shapeop_setHard(handle(), id, is_hard), handle()); }
    bool is_hard(int id) const { return detail::check_number(shapeop_isHard(handle(), id), handle()) != 0; }

    /// Makes a point a handle, drawn to `target`, 3 coordinates, or moves its target.
    void set_handle(int point, Numbers target) {
        detail::check(shapeop_setHandle(handle(), point, three(target, "target")), handle());
    }

    void release_handle(int point) { detail::check(shapeop_releaseHandle(handle(), point), handle()); }

    void set_objective(const Objective &objective) {
        detail::check(shapeop_setObjective(handle(), &objective), handle());
    }

    /// What the fairness term measures: faces or polylines as index lists behind each other, cut by `counts`: one
    /// number for all, or one for each.
    void set_fairness(shapeop_fairness kind, Indices indices, Indices counts) {
        std::vector<int> each(counts.data(), counts.data() + counts.size());
        if (each.size() == 1) {
            each.assign(detail::part_count(indices, counts), each.front());
        }
        detail::check(shapeop_setFairness(handle(), kind, indices.data(), indices.length("indices"), each.data(),
                                          Indices(each).length("counts")),
                      handle());
    }

    /// What the last exploration found; refused if there was none.
    Exploration exploration() const {
        Exploration found;
        detail::check(shapeop_getExploration(handle(), &found), handle());
        return found;
    }

    /// The hard constraints in the contradiction that the last exploration found; empty if there is none. Without them
    /// the others can be met.
    std::vector<int> conflicts() const {
        const int count = detail::check_number(shapeop_getConflicts(handle(), nullptr, 0), handle());
        std::vector<int> ids(static_cast<std::size_t>(count));
        detail::check_number(shapeop_getConflicts(handle(), ids.data(), count), handle());
        return ids;
    }

    /// How the solution answers a change of each weight; refused unless the last solve ended in one.
    Sensitivities sensitivities() {
        const int count = detail::check_number(shapeop_weightClassCount(handle()), handle());
        const auto classes = static_cast<std::size_t>(count);
        const int points = point_count();
        Sensitivities found;
        found.points.resize(3 * classes * static_cast<std::size_t>(points));
        found.squares.resize(classes * classes);
        detail::check(shapeop_getSensitivities(handle(), found.points.data(), points, found.squares.data(), count),
                      handle());
        for (int index = 0; index < count; ++index) {
            found.classes.emplace_back(shapeop_weightClassName(handle(), index));
        }
        return found;
    }

    // Forces, of 3 components.

    int add_gravity_force(Numbers force) {
        return detail::check_number(shapeop_addGravityForce(handle(), components(force)), handle());
    }

    int add_vertex_force(Numbers force, int point) {
        return detail::check_number(shapeop_addVertexForce(handle(), components(force), point), handle());
    }

    void edit_vertex_force(int id, Numbers force, int point) {
        shapeop_editVertexForce(handle(), id, components(force), point);
        detail::check_void(handle());
    }

    // Forces on faces, which follow the points. `faces` are point indices behind each other; `counts` says how many belong
    // to each: one number for all, or one for each.

    /// `pressure`: force per area, along the normals.
    int add_pressure(Indices faces, Indices counts, double pressure) {
        return detail::check_number(shapeop_addPressure(handle(), faces.data(), faces.length("faces"), counts.data(),
                                                        counts.length("counts"), pressure),
                                    handle());
    }

    /// A force of this length on every corner, along the normal there.
    int add_normal_force(Indices faces, Indices counts, double magnitude) {
        return detail::check_number(shapeop_addNormalForce(handle(), faces.data(), faces.length("faces"), counts.data(),
                                                           counts.length("counts"), magnitude),
                                    handle());
    }

    /// Replaces a pressure, or the length of a normal force.
    void edit_force_magnitude(int id, double magnitude) {
        detail::check(shapeop_editForceMagnitude(handle(), id, magnitude), handle());
    }

    void remove_force(int id) { detail::check(shapeop_removeForce(handle(), id), handle()); }

    /// The number of ids given out.
    int force_count() const { return detail::check_number(shapeop_forceCount(handle()), handle()); }
    bool is_force(int id) const { return detail::check_number(shapeop_isForce(handle(), id), handle()) != 0; }

    // Solving.

    void init() { check_flag(shapeop_init(handle())); }

    void init_dynamic(double masses, double damping, double time_step) {
        check_flag(shapeop_initDynamic(handle(), masses, damping, time_step));
    }

    void set_time_step(double time_step) {
        shapeop_setTimeStep(handle(), time_step);
        detail::check_void(handle());
    }

    void set_damping(double damping) {
        shapeop_setDamping(handle(), damping);
        detail::check_void(handle());
    }

    void set_thread_count(int count) { detail::check(shapeop_setThreadCount(handle(), count), handle()); }

    void set_acceleration(shapeop_acceleration kind, unsigned int memory = 0) {
        detail::check(shapeop_setAcceleration(handle(), kind, memory), handle());
    }

    void set_linear_solver(shapeop_linear_solver kind) {
        detail::check(shapeop_setLinearSolver(handle(), kind), handle());
    }

    /// What carries out the iterations of the following solves. SO_BACKEND_GPU is refused where there is no graphics card,
    /// and by a library without the feature gpu.
    void set_backend(shapeop_backend backend) {
        detail::check(shapeop_setBackend(handle(), backend), handle());
    }

    /// What was set.
    shapeop_backend backend() const {
        return static_cast<shapeop_backend>(detail::check_number(shapeop_getBackend(handle()), handle()));
    }

    /// Chooses the graphics card by a part of its name (empty: any), the bytes of one binding at most, and the bytes that
    /// the solver may take of it; 0: no limit.
    void set_backend_options(const std::string &adapter, double binding_bytes = 0, double memory_bytes = 0) {
        detail::check(shapeop_setBackendOptions(handle(), detail::c_text(adapter, "adapter"), binding_bytes, memory_bytes),
                      handle());
    }

    /// The graphics card of this solver. The first call takes a while: it opens it.
    BackendInfo backend_info() const {
        BackendInfo info;
        detail::check(shapeop_backendInfo(handle(), &info), handle());
        return info;
    }

    /// Static: so many iterations. Dynamic: one time step with so many iterations.
    void solve(unsigned int iterations) { check_flag(shapeop_solve(handle(), iterations)); }

    /// Iterates until the options say to stop.
    Report solve_until(const SolveOptions &options = {}) {
        Report report;
        detail::check(shapeop_solveUntil(handle(), &options, nullptr, nullptr, &report), handle());
        tell(report);
        return report;
    }

    /// The same; after every iteration `progress` is called with a `const shapeop::Progress &`. It returns true to go
    /// on and false to stop, or nothing. It may read from the solver. What it throws ends the solve, which keeps the
    /// points that it reached, and is thrown again from here.
    template <class Callback> Report solve_until(const SolveOptions &options, Callback &&progress) {
        Watch<std::remove_reference_t<Callback>> watch{progress, nullptr};
        Report report;
        const shapeop_err code = shapeop_solveUntil(handle(), &options, watch.call, &watch, &report);
        if (watch.thrown) {
            std::rethrow_exception(watch.thrown);
        }
        detail::check(code, handle());
        tell(report);
        return report;
    }

    double energy() const {
        double energy = 0;
        detail::check(shapeop_energy(handle(), &energy), handle());
        return energy;
    }

    /// One for every constraint id, each in its type's unit; 0 for removed ones.
    std::vector<double> violations() const {
        std::vector<double> violations(static_cast<std::size_t>(constraint_count()));
        detail::check(shapeop_getViolations(handle(), violations.data(), Numbers(violations).length("violations")),
                      handle());
        return violations;
    }

private:
    void tell(Report &report) const {
        report.note = shapeop_lastError(handle());
        if (const char *reason = shapeop_backendReason(handle())) {
            report.backend_reason = reason;
        }
    }

    struct Delete {
        void operator()(ShapeOpSolver *op) const noexcept { shapeop_delete(op); }
    };

    /// A callback on its way through C, which no exception may cross.
    template <class Callback> struct Watch {
        Callback &callback;
        std::exception_ptr thrown;

        static int call(const shapeop_progress *progress, void *user) noexcept {
            auto &watch = *static_cast<Watch *>(user);
            try {
                if constexpr (std::is_void_v<std::invoke_result_t<Callback &, const Progress &>>) {
                    watch.callback(*progress);
                    return 0;
                } else {
                    return watch.callback(*progress) ? 0 : 1;
                }
            } catch (...) {
                watch.thrown = std::current_exception();
                return 1;
            }
        }
    };

    void add(const std::string &type, Indices ids, Indices counts, Numbers weights, Scalars scalars, bool is_hard,
             Span<int> added) {
        const Numbers numbers = scalars.numbers();
        const int sets = scalars.set_count(added.length("constraints"));
        detail::check(shapeop_addConstraints(handle(), detail::c_text(type, "type"), ids.data(), ids.length("ids"),
                                             counts.data(), counts.length("counts"), weights.data(),
                                             weights.length("weights"), numbers.data(), numbers.length("scalars"), sets,
                                             is_hard ? SHAPEOP_HARD : 0, added.data()),
                      handle());
    }

    int add_one(const std::string &type, Indices ids, double weight, Scalars scalars) {
        int id = 0;
        add(type, ids, {ids.length("ids")}, {weight}, scalars, false, {&id, 1});
        return id;
    }

    static const double *three(Numbers numbers, const char *name) {
        if (numbers.size() != 3) {
            throw Error(SO_INVALID_ARGUMENT_LENGTH,
                        std::string(name) + ": expected 3 numbers, found " + std::to_string(numbers.size()));
        }
        return numbers.data();
    }

    // The C functions do not change them.
    static double *components(Numbers force) { return const_cast<double *>(three(force, "force")); }

    void check_flag(int is_refused) {
        if (is_refused != 0) {
            detail::refuse(handle());
        }
    }

    std::unique_ptr<ShapeOpSolver, Delete> op_;
};

} // namespace shapeop

#endif
