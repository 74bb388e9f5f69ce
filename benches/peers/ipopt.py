"""Solves the experiment of Fig. 12 of Deng et al. 2015 (see figure12.py) with IPOPT, and writes its course as JSON.

    ipopt.py N OUT.json [--form FORM] [--reference P.json] [--polished P.json] [--points]

IPOPT 3.14 with MUMPS as in the wheel of casadi (requirements.txt), on one thread, with exact first and second
derivatives; tol 1e-12, bound_relax_factor 0 and acceptable_iter 0, so that its point is feasible and as near to the
solution as it gets. It starts where every method does, at p0. With V the volume e · (d1 × d2) that the diagonals span
and A = ‖d1 × d2‖, the constraint |D| ≤ bound is given to it as one of

    plain     ± V − bound A ≤ 0, over the cube of the mean edge: two constraints for each quad
    squared   V² − bound² A² ≤ 0, over the sixth power of the mean edge: one for each quad
    ratio     −bound ≤ V / A ≤ bound, over the mean edge: one for each quad, with two sides

What is timed: `setup_seconds` makes the solver: the energy's expression, all derivatives by casadi and their places,
the code of its virtual machine. It is in the `seconds` of every iteration, which go on from the call of the solver to
IPOPT's callback at the end of that iteration; so symbolic factorisation is in them. Not timed: importing casadi, making
the mesh and the expression of one quad's constraint (`model_seconds`), what this program does in the callback, and
whatever happens once a process: the experiment on a surface of WARM_UP points a side is solved first.

Derivatives are taken for one quad and put into their places for all quads: asked for those of the whole Lagrangian,
casadi takes longer to set up than IPOPT to solve.

Objective (energy (5), with its ½), violation (of the bound, in mean edges) and optimality (`Problem.optimality`) are
computed afresh in numpy from the points; so is `delta`, the distance to p* over that of p0. p* is the reference, or
without one the point that newton.py makes of IPOPT's last. `--polished` writes that point as a reference: `multipliers`
are those of |D| ≤ bound in model units, for the quads listed as `active`, which are numbered row by row.

Points are x, y, z of vertex `row * n + column`. Numbers are written so that they read back to the same bits.
"""

import argparse
import json
import os
import sys
import time

# Before numpy and casadi are imported: their BLAS reads it once.
os.environ.update({"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"})

import casadi
import numpy
from scipy import sparse

import figure12
import newton

WARM_UP = 5
FORMS = ("plain", "squared", "ratio")
# Rows and columns of the upper triangle of a quad's Hessian.
UPPER = numpy.triu_indices(12)
OPTIONS = {
    "linear_solver": "mumps",
    "tol": 1e-12,
    "bound_relax_factor": 0.0,
    "acceptable_iter": 0,
    "print_level": 0,
    "sb": "yes",
}


def pattern(matrix):
    """The sparsity of a scipy matrix, for casadi."""
    matrix = matrix.tocsc()
    matrix.sort_indices()
    return casadi.Sparsity(*matrix.shape, matrix.indptr.tolist(), matrix.indices.tolist())


def constant(matrix):
    """A scipy matrix as a constant of casadi's."""
    matrix = matrix.tocsc()
    matrix.sort_indices()
    return casadi.DM(pattern(matrix), matrix.data)


def quad_constraint(problem, form):
    """Twelve symbols, the values constrained of a quad with these corners, and their lower and upper bounds."""
    corners = casadi.SX.sym("corners", 12)
    p0, p1, p2, p3 = (corners[3 * i : 3 * i + 3] for i in range(4))
    normal = casadi.cross(p2 - p0, p3 - p1)
    volume = casadi.dot(p1 - p0, normal)
    area_squared = casadi.dot(normal, normal)
    bound, edge = problem.bound, problem.mean_edge
    if form == "squared":
        return corners, (volume**2 - bound**2 * area_squared) / edge**6, [-numpy.inf], [0.0]
    area = casadi.sqrt(area_squared)
    if form == "ratio":
        return corners, volume / area / edge, [-bound / edge], [bound / edge]
    both = casadi.vertcat(volume - bound * area, -volume - bound * area) / edge**3
    return corners, both, [-numpy.inf] * 2, [0.0] * 2


class Callback(casadi.Callback):
    """Keeps time and points of every iteration, and how long it took to keep them."""

    def __init__(self, variable_count, constraint_count):
        casadi.Callback.__init__(self)
        sizes = {"x": variable_count, "f": 1, "g": constraint_count}
        sizes |= {"lam_x": variable_count, "lam_g": constraint_count, "lam_p": 0}
        self.sizes = [sizes[name] for name in casadi.nlpsol_out()]
        self.iterations = []
        self.own_seconds = 0.0
        self.construct("callback", {})

    def get_n_in(self):
        return len(self.sizes)

    def get_n_out(self):
        return 1

    def get_sparsity_in(self, i):
        return casadi.Sparsity.dense(self.sizes[i], 1 if self.sizes[i] else 0)

    def eval(self, arguments):
        entered = time.perf_counter()
        points = numpy.array(arguments[0]).reshape(-1, 3)
        self.iterations.append((entered - self.own_seconds, points))
        self.own_seconds += time.perf_counter() - entered
        return [0]


def energy_of(problem, x):
    """F(x), its gradient, and its matrix. About p0 it is ½ yᵀ K y − yᵀ b + c with y = x − p0."""
    stiffness = sparse.kron(problem.energy_hessian(), sparse.eye_array(3)).tocsc()
    step = x - problem.start.ravel()
    pull = (problem.weights[:, None] * (problem.targets - problem.start)).ravel()
    curved = casadi.mtimes(constant(stiffness), step)
    energy = 0.5 * casadi.dot(step, curved) - casadi.dot(step, pull) + problem.energy(problem.start)
    return energy, curved - pull, stiffness


def jacobian_of(problem, of_quads, constraints_each):
    """The Jacobian of all constraints; `of_quads` has those of the quads beside each other, dense."""
    count = len(problem.quads)
    places = problem.corner_places(numpy.arange(count))
    # Entries run down the columns of each quad's Jacobian.
    rows = constraints_each * numpy.arange(count)[:, None, None] + numpy.arange(constraints_each)
    rows, columns = numpy.broadcast_arrays(rows, places[:, :, None])
    numbers = numpy.arange(1, rows.size + 1)
    shape = (constraints_each * count, problem.start.size)
    order = sparse.coo_array((numbers, (rows.ravel(), columns.ravel())), shape=shape).tocsc()
    order.sort_indices()
    return casadi.MX(pattern(order), casadi.vec(of_quads)[(order.data - 1).tolist()])


def hessian_of(problem, stiffness, energy_multiplier, of_quads):
    """The upper triangle of the Lagrangian's Hessian; `of_quads` has a column for each quad, the entries of `UPPER`.

    Entries of quads that share an edge fall on each other: a constant matrix of zeros and ones adds them up.
    """
    places = problem.corner_places(numpy.arange(len(problem.quads)))
    first, second = places[:, UPPER[0]].ravel(), places[:, UPPER[1]].ravel()
    quad_entries = (numpy.minimum(first, second), numpy.maximum(first, second))
    own = sparse.triu(stiffness).tocoo()
    rows, columns = (numpy.concatenate(pair) for pair in zip(quad_entries, own.coords))
    # By columns, then rows: the order of casadi's sparsity.
    keys, numbers = numpy.unique(columns.astype(numpy.int64) * problem.start.size + rows, return_inverse=True)
    place = (keys % problem.start.size, keys // problem.start.size)
    triangle = sparse.csc_array((numpy.ones(len(keys)), place), shape=stiffness.shape)
    quad_numbers, own_numbers = numbers[: len(first)], numbers[len(first) :]
    spread = (numpy.ones(len(first)), (quad_numbers, numpy.arange(len(first))))
    gather = sparse.csc_array(spread, shape=(len(keys), len(first)))
    own_entries = numpy.zeros(len(keys))
    own_entries[own_numbers] = own.data
    entries = energy_multiplier * casadi.DM(own_entries) + casadi.mtimes(constant(gather), casadi.vec(of_quads))
    return casadi.MX(pattern(triangle), entries)


def make_solver(problem, callback, corners, values):
    """The solver of nlpsol; `values` of `corners` are the constraints of one quad."""
    constraints_each, count = values.numel(), len(problem.quads)
    multipliers = casadi.SX.sym("multipliers", constraints_each)
    hessian = casadi.densify(casadi.hessian(casadi.dot(multipliers, values), corners)[0])
    half = casadi.vertcat(*(hessian[int(i), int(j)] for i, j in zip(*UPPER)))
    jacobian = casadi.densify(casadi.jacobian(values, corners))
    quad_values = casadi.Function("values", [corners], [values]).map(count)
    quad_jacobian = casadi.Function("jacobian", [corners], [jacobian]).map(count)
    quad_hessian = casadi.Function("hessian", [corners, multipliers], [half]).map(count)

    x, p = casadi.MX.sym("x", problem.start.size), casadi.MX.sym("p", 0)
    lam_f, lam_g = casadi.MX.sym("lam_f"), casadi.MX.sym("lam_g", constraints_each * count)
    places = problem.corner_places(numpy.arange(count))
    all_corners = casadi.reshape(x[places.ravel().tolist()], 12, count)
    energy, gradient, stiffness = energy_of(problem, x)
    constrained = casadi.vec(quad_values(all_corners))
    all_jacobian = jacobian_of(problem, quad_jacobian(all_corners), constraints_each)
    bent = quad_hessian(all_corners, casadi.reshape(lam_g, constraints_each, count))
    lagrangian = hessian_of(problem, stiffness, lam_f, bent)

    options = {
        "grad_f": casadi.Function("grad_f", [x, p], [energy, gradient], ["x", "p"], ["f", "grad_f_x"]),
        "jac_g": casadi.Function("jac_g", [x, p], [constrained, all_jacobian], ["x", "p"], ["g", "jac_g_x"]),
        "hess_lag": casadi.Function(
            "hess_lag", [x, p, lam_f, lam_g], [lagrangian], ["x", "p", "lam_f", "lam_g"], ["triu_hess_gamma_x_x"]
        ),
        "iteration_callback": callback,
        "print_time": False,
        "ipopt": OPTIONS,
    }
    return casadi.nlpsol("ipopt", "ipopt", {"x": x, "f": energy, "g": constrained}, options)


def solve(problem, form):
    """IPOPT from p0: its course, its last point, and what it says of itself."""
    started = time.perf_counter()
    corners, values, lower, upper = quad_constraint(problem, form)
    model_seconds = time.perf_counter() - started
    count = len(problem.quads)
    callback = Callback(problem.start.size, len(lower) * count)
    started = time.perf_counter()
    solver = make_solver(problem, callback, corners, values)
    setup_seconds = time.perf_counter() - started
    started = time.perf_counter()
    found = solver(x0=problem.start.ravel(), lbg=lower * count, ubg=upper * count)
    solve_seconds = time.perf_counter() - started - callback.own_seconds
    if not solver.stats()["success"]:
        sys.exit(f"IPOPT did not solve it: {solver.stats()['return_status']}")
    course = [(setup_seconds + entered - started, points) for entered, points in callback.iterations]
    times = {"model_seconds": model_seconds, "setup_seconds": setup_seconds, "solve_seconds": solve_seconds}
    return course, numpy.array(found["x"]).reshape(-1, 3), times


def describe(problem, points):
    """The measures of a point."""
    optimality = problem.optimality(points)
    return {
        "objective": float(problem.energy(points)),
        "violation": problem.violation(points),
        "optimality": optimality.residual(),
        "active_count": len(optimality.active),
    }


def reference(problem, points):
    """A solution as it is kept."""
    optimality = problem.optimality(points)
    return {
        "n": problem.n,
        "mean_edge": problem.mean_edge,
        **describe(problem, points),
        "active": optimality.active.tolist(),
        "multipliers": optimality.multipliers.tolist(),
        "points": points.tolist(),
    }


def read_reference(path, problem):
    """p* of a file that `--polished` wrote."""
    with open(path, encoding="utf-8") as file:
        kept = json.load(file)
    points = numpy.array(kept["points"])
    if kept["n"] != problem.n or points.shape != problem.start.shape:
        found = f"n = {kept['n']} and an array of {points.shape}"
        sys.exit(f"{path}: expected the points of {problem.n} x {problem.n} vertices, found {found}")
    return points


def write(path, content):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(content, file)
        file.write("\n")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__.partition("\n")[0],
        epilog="What is timed, and what the files hold: see the top of the program.",
    )
    parser.add_argument("n", type=int, metavar="N", help="vertices along a side, odd: 21 and 61 in the experiment")
    parser.add_argument("out", metavar="OUT.json", help="the course of the iteration, and the last points")
    parser.add_argument("--form", choices=FORMS, default="plain", help="of the constraint; plain is the fastest")
    parser.add_argument("--reference", metavar="P.json", help="the solution p* that delta is measured to")
    parser.add_argument("--polished", metavar="P.json", help="write the solution, polished by Newton's method")
    parser.add_argument("--points", action="store_true", help="write the points of every iteration too")
    arguments = parser.parse_args()
    try:
        problem = figure12.problem(arguments.n)
    except ValueError as error:
        parser.error(str(error))
    given = read_reference(arguments.reference, problem) if arguments.reference else None

    solve(figure12.problem(WARM_UP), arguments.form)
    course, points, times = solve(problem, arguments.form)
    polished = newton.polish(problem, points)[0] if given is None or arguments.polished else None
    solution = polished if given is None else given
    iterations = []
    for number, (seconds, at) in enumerate(course):
        iterations.append(
            {
                "iteration": number,
                "seconds": seconds,
                "delta": problem.delta(at, solution),
                "objective": float(problem.energy(at)),
                "violation": problem.violation(at),
            }
        )
        if arguments.points:
            iterations[-1]["points"] = at.tolist()
    write(
        arguments.out,
        {
            "peer": "ipopt",
            "casadi": casadi.__version__,
            "form": arguments.form,
            "n": problem.n,
            "mean_edge": problem.mean_edge,
            **times,
            "iteration_count": len(course) - 1,
            **describe(problem, points),
            "delta": problem.delta(points, solution),
            "iterations": iterations,
            "points": points.tolist(),
        },
    )
    if arguments.polished:
        write(arguments.polished, reference(problem, polished))


if __name__ == "__main__":
    main()
