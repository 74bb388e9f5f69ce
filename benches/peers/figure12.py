"""The experiment of Fig. 12 of Deng et al. 2015 (Interactive design exploration for constrained meshes).

A translation surface of n × n vertices is the initial mesh p0; so all its faces are planar. Handles: the boundary
vertices, at their places, and the centre vertex, lifted by one mean edge. Energy: (5) without soft constraints,

    F(p) = w_h/2 Σ_handles ‖p_i − t_i‖² + w_c/2 Σ_others ‖p_i − p0_i‖² + w_f/2 ‖L (p − p0)‖²,

L the uniform Laplacian p_i − mean of the neighbours, at every vertex. Hard constraints, equation (9): the lines of the
diagonals of each quad are at most a hundredth of the mean edge of p0 apart.

Here are the problem and its measures, in numpy and scipy. What this module says of a point it computes from the
coordinates alone: nothing is taken from the solver that found the point.
"""

import dataclasses

import numpy
import scipy.sparse.linalg
from scipy import sparse

HANDLE_WEIGHT = 100.0
CLOSENESS_WEIGHT = 0.1
FAIRNESS_WEIGHT = 1.0
# Greatest distance of the diagonals over the mean edge.
TOLERANCE = 0.01
# A quad counts as at its bound if its distance is below it by less than this share of it. Solvers with slack stop
# short of the bound by about their tolerance over the multiplier, 1e-8 here; the next quads are 1e-2 below at n = 21.
ACTIVE_BELOW = 1e-6

# The differences d1 = p2 − p0, d2 = p3 − p1, e = p1 − p0 of a quad's corners.
DIFFERENCES = numpy.array([[-1.0, 0, 1, 0], [0, -1, 0, 1], [-1, 1, 0, 0]])


@dataclasses.dataclass(frozen=True)
class Problem:
    """Points are arrays of n² × 3 in model units, vertex `row * n + column`; x grows along a row."""

    n: int
    start: numpy.ndarray  # p0
    quads: numpy.ndarray  # (n − 1)² × 4 corners in order around the face, row by row
    handles: numpy.ndarray  # n² booleans
    targets: numpy.ndarray  # where handles and all others are drawn to
    weights: numpy.ndarray  # n²: of each vertex's distance from its target
    laplacian: sparse.csr_array  # n² × n²
    mean_edge: float
    bound: float  # greatest distance of the diagonals

    def energy(self, points):
        """F(p)."""
        pull = numpy.sum(self.weights[:, None] * (points - self.targets) ** 2)
        return 0.5 * pull + 0.5 * FAIRNESS_WEIGHT * numpy.sum((self.laplacian @ (points - self.start)) ** 2)

    def energy_gradient(self, points):
        """∇F(p), n² × 3."""
        bent = self.laplacian.T @ (self.laplacian @ (points - self.start))
        return self.weights[:, None] * (points - self.targets) + FAIRNESS_WEIGHT * bent

    def energy_hessian(self):
        """The matrix of F, n² × n²: the same for x, y and z."""
        return sparse.diags_array(self.weights) + FAIRNESS_WEIGHT * (self.laplacian.T @ self.laplacian)

    def distances(self, points):
        """The signed distance of the lines of each quad's diagonals: the volume that they span over its base."""
        first, second, edge = (self._differences(points)[:, i] for i in range(3))
        normal = numpy.cross(first, second)
        return numpy.sum(edge * normal, axis=1) / numpy.linalg.norm(normal, axis=1)

    def violation(self, points):
        """The greatest excess of a distance over the bound, in mean edges; 0 if all are within."""
        return max(0.0, float(numpy.abs(self.distances(points)).max() - self.bound)) / self.mean_edge

    def delta(self, points, solution):
        """‖p − p*‖ / ‖p0 − p*‖, equation (12)."""
        return float(numpy.linalg.norm(points - solution) / numpy.linalg.norm(self.start - solution))

    def _differences(self, points):
        return numpy.einsum("ij,qjk->qik", DIFFERENCES, points[self.quads])

    def distance_derivatives(self, points, active):
        """Of the signed distances of the quads `active`: values, gradients (m × 12, corner by corner) and Hessians
        (m × 12 × 12).

        With V = e · (d1 × d2) and A = ‖d1 × d2‖ the distance is D = V / A, so that
        D' = (V' − D A') / A  and  D'' = (V'' − D A'' − D' A'ᵀ − A' D'ᵀ) / A.
        """
        first, second, edge = (self._differences(points)[active, i] for i in range(3))
        normal = numpy.cross(first, second)
        area = numpy.linalg.norm(normal, axis=1)
        unit = normal / area[:, None]
        value = numpy.sum(edge * normal, axis=1) / area
        m = len(value)
        volume_gradient = numpy.concatenate([numpy.cross(second, edge), numpy.cross(edge, first), normal], axis=1)
        # (d1 × d2)' as a matrix, 3 × 9.
        normal_jacobian = numpy.zeros((m, 3, 9))
        normal_jacobian[:, :, 0:3] = -cross_matrices(second)
        normal_jacobian[:, :, 3:6] = cross_matrices(first)
        area_gradient = numpy.einsum("qi,qij->qj", unit, normal_jacobian)
        gradient = (volume_gradient - value[:, None] * area_gradient) / area[:, None]

        volume_hessian = numpy.zeros((m, 9, 9))
        set_block(volume_hessian, 0, 1, -cross_matrices(edge))
        set_block(volume_hessian, 2, 0, -cross_matrices(second))
        set_block(volume_hessian, 2, 1, cross_matrices(first))
        area_hessian = numpy.einsum("qij,qik->qjk", normal_jacobian, normal_jacobian)
        area_hessian = (area_hessian - outer(area_gradient, area_gradient)) / area[:, None, None]
        bilinear = numpy.zeros((m, 9, 9))
        set_block(bilinear, 0, 1, -cross_matrices(unit))
        area_hessian += bilinear
        mixed = outer(gradient, area_gradient)
        hessian = volume_hessian - value[:, None, None] * area_hessian - mixed - mixed.transpose(0, 2, 1)
        hessian /= area[:, None, None]
        to_corners = numpy.kron(DIFFERENCES, numpy.eye(3))
        return value, gradient @ to_corners, to_corners.T @ hessian @ to_corners

    def corner_places(self, active):
        """The places of the 12 coordinates of each active quad among the 3 n² of all."""
        return (3 * self.quads[active][:, :, None] + numpy.arange(3)).reshape(-1, 12)

    def bound_jacobian(self, points, active):
        """Of |D| of the quads `active`, by the coordinates of all vertices: m × 3 n²."""
        value, gradient, _ = self.distance_derivatives(points, active)
        rows = numpy.repeat(numpy.arange(len(active)), 12)
        entries = (numpy.sign(value)[:, None] * gradient).ravel()
        shape = (len(active), points.size)
        return sparse.csr_array((entries, (rows, self.corner_places(active).ravel())), shape=shape)

    def active_quads(self, points):
        """The quads at their bound or beyond."""
        return numpy.flatnonzero(numpy.abs(self.distances(points)) > self.bound * (1 - ACTIVE_BELOW))

    def multipliers(self, points, active):
        """The λ for which ‖∇F + Jᵀ λ‖ is least, J being the Jacobian of |D| of the quads `active`."""
        jacobian = self.bound_jacobian(points, active)
        slope = jacobian @ self.energy_gradient(points).ravel()
        return numpy.atleast_1d(scipy.sparse.linalg.spsolve((jacobian @ jacobian.T).tocsc(), -slope))

    def optimality(self, points):
        """How far `points` are from satisfying the first-order conditions.

        The multipliers λ are those of least squares on the quads at their bound. Stationarity is ‖∇F + Jᵀ λ‖ over ‖∇F‖,
        which does not vanish at a solution with active constraints. Complementarity is the greatest λ |bound − |D||
        over the greatest λ times the bound. At a solution no multiplier is below 0; the least is over the greatest.
        """
        active = self.active_quads(points)
        gradient = self.energy_gradient(points).ravel()
        scale = float(numpy.linalg.norm(gradient))
        if len(active) == 0:
            return Optimality(1.0, 0.0, 0.0, active, numpy.zeros(0))
        jacobian, multipliers = self.bound_jacobian(points, active), self.multipliers(points, active)
        stationarity = float(numpy.linalg.norm(gradient + jacobian.T @ multipliers)) / scale
        gaps = self.bound - numpy.abs(self.distances(points)[active])
        greatest = float(numpy.abs(multipliers).max())
        complementarity = float(numpy.abs(multipliers * gaps).max()) / (greatest * self.bound)
        return Optimality(stationarity, complementarity, float(multipliers.min()) / greatest, active, multipliers)


@dataclasses.dataclass(frozen=True)
class Optimality:
    """Plain numbers; see `Problem.optimality`. Multipliers belong to |D| ≤ bound in model units."""

    stationarity: float
    complementarity: float
    least_multiplier: float
    active: numpy.ndarray
    multipliers: numpy.ndarray

    def residual(self):
        """The greatest of the three."""
        return max(self.stationarity, self.complementarity, -self.least_multiplier)


def problem(n):
    """The problem of n × n vertices; n is odd, so that there is a centre, and at least 5."""
    if n < 5 or n % 2 == 0:
        raise ValueError(f"n: expected an odd number of at least 5, found {n}")
    steps = numpy.linspace(-1.0, 1.0, n)
    u, v = (axis.ravel() for axis in numpy.meshgrid(steps, steps))
    start = 0.5 * n * numpy.stack([u, v, 0.35 * (numpy.cos(1.2 * u) + numpy.cos(1.5 * v))], axis=1)
    places = numpy.arange(n * n).reshape(n, n)
    pairs = [(places[:, :-1], places[:, 1:]), (places[:-1], places[1:])]
    first, second = (numpy.concatenate([pair[i].ravel() for pair in pairs]) for i in range(2))
    mean_edge = float(numpy.linalg.norm(start[first] - start[second], axis=1).mean())
    quads = numpy.stack([places[:-1, :-1], places[:-1, 1:], places[1:, 1:], places[1:, :-1]], axis=-1).reshape(-1, 4)

    ends = (numpy.concatenate([first, second]), numpy.concatenate([second, first]))
    adjacency = sparse.csr_array((numpy.ones(len(ends[0])), ends), shape=(n * n, n * n))
    laplacian = sparse.eye_array(n * n) - sparse.diags_array(1.0 / adjacency.sum(axis=1)) @ adjacency

    handles = numpy.ones((n, n), dtype=bool)
    handles[1:-1, 1:-1] = False
    handles[n // 2, n // 2] = True
    targets = start.copy()
    targets[places[n // 2, n // 2], 2] += mean_edge
    handles = handles.ravel()
    return Problem(
        n=n,
        start=start,
        quads=quads,
        handles=handles,
        targets=targets,
        weights=numpy.where(handles, HANDLE_WEIGHT, CLOSENESS_WEIGHT),
        laplacian=laplacian.tocsr(),
        mean_edge=mean_edge,
        bound=TOLERANCE * mean_edge,
    )


def cross_matrices(vectors):
    """The matrices [v]× with [v]× w = v × w, of m vectors."""
    x, y, z = vectors.T
    zero = numpy.zeros_like(x)
    rows = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return numpy.stack([numpy.stack(row, axis=-1) for row in rows], axis=1)


def set_block(matrices, row, column, blocks):
    """Writes 3 × 3 blocks and their mirror images."""
    matrices[:, 3 * row : 3 * row + 3, 3 * column : 3 * column + 3] = blocks
    matrices[:, 3 * column : 3 * column + 3, 3 * row : 3 * row + 3] = blocks.transpose(0, 2, 1)


def outer(first, second):
    """The m matrices a bᵀ."""
    return first[:, :, None] * second[:, None, :]
