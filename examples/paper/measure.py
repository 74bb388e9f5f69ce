"""What the figures claim, measured on points and faces alone. Lengths in model units, angles in degrees, planarity in percent."""

import numpy as np


def edge_lengths(points, edges):
    edges = np.asarray(edges)
    return np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)


def strains(points, rest_points, edges):
    """Length over rest length, minus 1: positive is tension."""
    return edge_lengths(points, edges) / edge_lengths(rest_points, edges) - 1


def face_angles(points, face):
    """The interior angle at each corner, between the edges that leave it: 0 to 180 degrees."""
    corners = points[face]
    ahead = np.roll(corners, -1, axis=0) - corners
    back = np.roll(corners, 1, axis=0) - corners
    cosines = np.sum(ahead * back, axis=1) / (np.linalg.norm(ahead, axis=1) * np.linalg.norm(back, axis=1))
    return np.degrees(np.arccos(np.clip(cosines, -1, 1)))


def all_angles(points, faces):
    """One row of interior angles for each face; all faces have the same number of corners."""
    return np.array([face_angles(points, face) for face in faces])


def planarity(points, quads):
    """For each quad: the distance of its diagonals over their mean length, in percent."""
    a, b, c, d = (points[np.asarray(quads)[:, k]] for k in range(4))
    normal = np.cross(c - a, d - b)
    size = np.linalg.norm(normal, axis=1)
    distance = np.abs(np.sum((b - a) * normal, axis=1)) / np.where(size > 0, size, 1)
    return 100 * distance / (0.5 * (np.linalg.norm(c - a, axis=1) + np.linalg.norm(d - b, axis=1)))


def plane_distances(points, faces):
    """For each face: the largest distance of a corner to the best-fit plane."""
    largest = []
    for face in faces:
        centred = points[face] - points[face].mean(axis=0)
        normal = np.linalg.svd(centred)[2][2]
        largest.append(np.abs(centred @ normal).max())
    return np.array(largest)


def area(points, face):
    """The area of a polygon in space: half the length of the sum of its cross products."""
    corners = points[face] - points[face[0]]
    return 0.5 * np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0))


def areas(points, faces):
    return np.array([area(points, face) for face in faces])


def best_circle(corners):
    """The circle through points in space that is the best in the least-squares sense: `(centre, radius, u, v)`, u and v spanning
    its plane. The plane is the best-fit plane; the circle in it starts from the algebraic fit and is refined by Gauss-Newton on the true distances."""
    middle = corners.mean(axis=0)
    u, v = np.linalg.svd(corners - middle)[2][:2]
    flat = np.stack([(corners - middle) @ u, (corners - middle) @ v], axis=1)
    system = np.column_stack([2 * flat, np.ones(len(flat))])
    x, y, c = np.linalg.lstsq(system, (flat**2).sum(axis=1), rcond=None)[0]
    circle = np.array([x, y, np.sqrt(c + x * x + y * y)])
    for _ in range(20):
        offset = flat - circle[:2]
        away = np.linalg.norm(offset, axis=1)
        jacobian = np.column_stack([-offset / away[:, None], -np.ones(len(flat))])
        circle = circle - np.linalg.lstsq(jacobian, away - circle[2], rcond=None)[0]
    return middle + circle[0] * u + circle[1] * v, circle[2], u, v


def circle_distances(corners):
    """The distance of each point to `best_circle` of all of them."""
    centre, radius, u, v = best_circle(corners)
    offset = corners - centre
    in_plane = np.hypot(offset @ u, offset @ v) - radius
    off_plane = offset @ np.cross(u, v)
    return np.hypot(in_plane, off_plane)


def fit(shape, corners, allow_scale):
    """The rotation (and scale) of `shape` and the translation that bring it nearest to `corners`: the distances that remain, one
    for each corner (Kabsch 1976, Umeyama 1991; no reflection)."""
    a, b = shape - shape.mean(axis=0), corners - corners.mean(axis=0)
    left, singular, right = np.linalg.svd(b.T @ a)
    sign = np.array([1, 1, np.sign(np.linalg.det(left @ right))])
    scale = (singular * sign).sum() / (a * a).sum() if allow_scale else 1.0
    return np.linalg.norm(b - scale * a @ (left * sign @ right).T, axis=1)


def nearest_shape(shapes, corners, allow_scale=False):
    """Which of the shapes, started at any corner and run either way round, is nearest in the least-squares sense, and how far its
    farthest corner is: `(index, distance)`."""
    best = None
    for index, shape in enumerate(shapes):
        for start in range(len(shape)):
            turned = np.roll(shape, start, axis=0)
            for candidate in (turned, turned[::-1]):
                left = fit(candidate, corners, allow_scale)
                if best is None or (left**2).sum() < best[0]:
                    best = ((left**2).sum(), index, left.max())
    return best[1], best[2]
