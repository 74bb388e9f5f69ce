"""Newton's method on the first-order conditions of Fig. 12's problem, from a point near its solution.

The active quads are held at their bound as equations; each step solves

    [ H   Jᵀ ] [ step ]     [ ∇F + Jᵀ λ ]
    [ J   0  ] [ Δλ   ] = − [ |D| − bound ],      H = ∇²F + Σ λ ∇²|D|,

with the exact second derivatives that are written out in figure12.py. Once it has converged, quads whose multiplier is
below 0 are let go and quads beyond their bound are taken in; then it goes on, until neither is left. Source: Nocedal
and Wright, Numerical Optimization, 2006, chapter 18 (the equations) and section 16.5 (the active set).
"""

import numpy
import scipy.sparse.linalg
from scipy import sparse

# Residuals below this are round-off: coordinates of 30 times weights of 100 in units of 1e-16, over gradients of 1.
RESIDUAL = 1e-13
STEPS = 30
ROUNDS = 20


def polish(problem, points, active=None):
    """The solution next to `points`, and the number of steps taken.

    `active` are the quads first held at their bound; by default those that are there.

    Raises RuntimeError if the steps do not converge or the active set does not settle: then `points` were too far away.
    """
    active = problem.active_quads(points) if active is None else active
    taken = 0
    for _ in range(ROUNDS):
        points, multipliers, steps = settle(problem, points, active)
        taken += steps
        keeps = multipliers > 0
        is_beyond = numpy.abs(problem.distances(points)) > problem.bound * (1 + 1e-11)
        is_beyond[active] = False
        if keeps.all() and not is_beyond.any():
            return points, taken
        active = numpy.union1d(active[keeps], numpy.flatnonzero(is_beyond))
    raise RuntimeError("the active set did not settle: start nearer to the solution")


def settle(problem, points, active):
    """Newton's steps with the quads `active` at their bound: points, multipliers, number of steps."""
    stiffness = sparse.kron(problem.energy_hessian(), sparse.eye_array(3)).tocsc()
    multipliers = problem.multipliers(points, active)
    best = None
    for step in range(STEPS):
        value, _, hessian = problem.distance_derivatives(points, active)
        sign = numpy.sign(value)
        jacobian = problem.bound_jacobian(points, active)
        energy_gradient = problem.energy_gradient(points).ravel()
        slope = energy_gradient + jacobian.T @ multipliers
        excess = sign * value - problem.bound
        residual = max(
            float(numpy.linalg.norm(slope)) / float(numpy.linalg.norm(energy_gradient)),
            float(numpy.abs(excess).max(initial=0.0)) / problem.bound,
        )
        # Round-off decides where it stops falling; the best point is kept.
        if best is None or residual < 0.5 * best[0]:
            best = (residual, points, multipliers, step)
        elif best[0] < 1e-11:
            break
        if residual < RESIDUAL:
            break
        places = problem.corner_places(active)
        rows, columns = numpy.repeat(places, 12, axis=1), numpy.tile(places, (1, 12))
        bent = (sign * multipliers)[:, None, None] * hessian
        shape = (points.size, points.size)
        curvature = sparse.coo_array((bent.ravel(), (rows.ravel(), columns.ravel())), shape=shape)
        matrix = sparse.block_array([[stiffness + curvature, jacobian.T], [jacobian, None]], format="csc")
        change = scipy.sparse.linalg.spsolve(matrix, -numpy.concatenate([slope, excess]))
        if not numpy.isfinite(change).all():
            raise RuntimeError("the equations of the active set are singular")
        points = points + change[: points.size].reshape(-1, 3)
        multipliers = multipliers + change[points.size :]
    residual, points, multipliers, step = best
    if residual > 1e-10:
        raise RuntimeError(f"Newton's steps did not converge: residual {residual:.1e} after {STEPS}")
    return points, multipliers, step
