"""What the figures claim, measured on points and faces alone. Lengths in model units, angles in degrees, planarity in
percent."""

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
    """The circle through points in space that is the best in the least-squares sense: `(centre, radius, u, v)`, u and v
    spanning its plane. The plane is the best-fit plane; the circle in it starts from the algebraic fit and is refined
    by Gauss-Newton on the true distances."""
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


def nearest_shapes(shapes, corners, allow_scale=False):
    """For each polygon, of k corners: which of the shapes (m, k, 3) is nearest to it in the least-squares sense if it
    is moved, turned (not mirrored) and, with `allow_scale`, scaled, starts at any corner and runs either way round;
    and how far its farthest corner then is. `corners` is (n, k, 3); returns two arrays of n (Kabsch 1976, Umeyama
    1991)."""
    corners = corners - corners.mean(axis=1, keepdims=True)
    least = np.full(len(corners), np.inf)
    index, farthest = np.zeros(len(corners), dtype=int), np.zeros(len(corners))
    for which, shape in enumerate(np.asarray(shapes, dtype=float)):
        shape = shape - shape.mean(axis=0)
        for start in range(len(shape)):
            for candidate in (np.roll(shape, start, axis=0), np.roll(shape, start, axis=0)[::-1]):
                left, singular, right = np.linalg.svd(corners.transpose(0, 2, 1) @ candidate)
                sign = np.ones_like(singular)
                sign[:, 2] = np.sign(np.linalg.det(left @ right))
                scale = (singular * sign).sum(axis=1) / (shape**2).sum() if allow_scale else np.ones(len(corners))
                placed = candidate @ (left * sign[:, None, :] @ right).transpose(0, 2, 1) * scale[:, None, None]
                distances = np.linalg.norm(corners - placed, axis=2)
                squares = (distances**2).sum(axis=1)
                is_nearer = squares < least
                least[is_nearer], index[is_nearer] = squares[is_nearer], which
                farthest[is_nearer] = distances[is_nearer].max(axis=1)
    return index, farthest


def face_normals(points, faces):
    """The unit normals of polygons in space: the directions of the sums of their cross products."""
    normals = []
    for face in faces:
        corners = points[face] - points[face].mean(axis=0)
        normals.append(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0))
    normals = np.array(normals)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def face_face_angles(points, faces):
    """The angle between every two faces that share an edge: 180 degrees if they are level. Faces are oriented alike."""
    faces_of = {}
    for k, face in enumerate(faces):
        for start, end in zip(face, face[1:] + face[:1], strict=True):
            faces_of.setdefault(frozenset((start, end)), []).append(k)
    pairs = np.array([both for both in faces_of.values() if len(both) == 2])
    normals = face_normals(points, faces)
    cosines = np.sum(normals[pairs[:, 0]] * normals[pairs[:, 1]], axis=1)
    return 180 - np.degrees(np.arccos(np.clip(cosines, -1, 1)))
