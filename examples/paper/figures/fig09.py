"""Figure 9: random meshes at three resolutions, under the same constraints on angles, boundaries and areas."""

import numpy as np
from matplotlib.colors import ListedColormap

import measure
import meshes
import patterns
from claims import Measure
from draw import Camera, Panel, page

NUMBER = 9
TITLE = "Random meshes with angles in a range"
CLAIM = "At every resolution angles come into 80 to 110 degrees, boundaries onto circles, and face areas are kept."
NOTES = """\
A canopy about a middle, lifted, twisted and shaken at random: the same waves at three resolutions. Angles ask for 81
to 109 degrees, as iterations only approach the end of a range. Areas and angles contradict each other in shaken
faces: with these weights the angles are met, and areas give, by some percent on the whole and up to a quarter in
single faces. So areas are kept only as far as the angles let them. The last model says what it costs to weigh the areas
more: they change less, and some angles stay outside.
"""

SEED = 9
MODELS = {"coarse": (24, 5), "medium": (48, 9), "fine": (96, 18)}
LEAST_ANGLE, MOST_ANGLE = 80, 110
#: The constraint asks for a little more, as iterations only approach the end of a range.
MARGIN = 1
AREA_WEIGHT, HEAVY_AREA_WEIGHT = 0.3, 1
STAGE = "5000 iterations"
SCORES = ListedColormap(["#2f855a", "#8fc06c", "#f3e08a", "#e07b39", "#9b1c1c"])


def build():
    made = {name: meshes.canopy(*size, SEED) for name, size in MODELS.items()}
    models = [model(name, made[name], "meshes/fig09-%s.obj" % name, AREA_WEIGHT) for name in MODELS]
    models.append(model("coarse, areas weigh more", made["coarse"], "meshes/fig09-coarse.obj", HEAVY_AREA_WEIGHT))
    return {"figure": NUMBER, "title": TITLE, "models": models}, {
        "meshes/fig09-%s.obj" % name: mesh for name, mesh in made.items()
    }


def model(name, mesh, path, area_weight):
    points, faces = mesh
    angles = np.radians([LEAST_ANGLE + MARGIN, MOST_ANGLE - MARGIN]).tolist()
    return {
        "name": name,
        "mesh": path,
        "constraints": [
            {"name": "angles", "type": "Angle", "indices": "faceAngleVertices", "weights": [10], "scalars": [angles]},
            {"name": "boundaries", "type": "Circle", "indices": "nakedVertices", "weights": [10]},
            {"name": "areas", "type": "Area", "indices": halves(points, faces), "weights": [area_weight]},
            {
                "name": "displacements",
                "type": "LaplacianDisplacement",
                "indices": "vertexNeighbours",
                "weights": [0.003],
            },
            {
                "name": "bending",
                "type": "Bending",
                "indices": patterns.hinges(faces),
                "weights": [0.001],
                "scalars": [[0, 1]],
            },
        ],
        "settings": {"mode": "static", "iterations": 1000},
        "stages": [{"name": STAGE, "solves": 5}],
    }


def halves(points, quads):
    """Each quad as the two triangles along its shorter diagonal."""
    triangles = []
    for a, b, c, d in quads:
        is_shorter = np.linalg.norm(points[a] - points[c]) <= np.linalg.norm(points[b] - points[d])
        triangles += [[a, b, c], [a, c, d]] if is_shorter else [[a, b, d], [b, c, d]]
    return triangles


def scores(shell, points):
    """For each face: how many of its angles are outside the range, 0 to 4."""
    angles = measure.all_angles(points, shell.faces)
    return ((angles < LEAST_ANGLE) | (angles > MOST_ANGLE)).sum(axis=1)


def boundary_distance(shell, points):
    """The largest distance of a boundary vertex to its boundary's circle, in mean edges."""
    edge = measure.edge_lengths(shell.points, patterns.edges(shell.faces)).mean()
    return max(measure.circle_distances(points[loop]).max() for loop in shell.trees["boundaries"]) / edge


def area_errors(shell, points):
    """For each face: its area over that in the input, minus 1, in percent."""
    return 100 * np.abs(measure.areas(points, shell.faces) / measure.areas(shell.points, shell.faces) - 1)


def measures(solved):
    found = []
    for name, shell in solved.items():
        points, is_main = shell[STAGE], name in MODELS
        angle_count = 4 * len(shell.faces)
        found += [
            Measure(
                name + ": angles outside 80 to 110 degrees, input",
                scores(shell, shell.points).sum(),
                "of %d" % angle_count,
            ),
            Measure(
                name + ": angles outside 80 to 110 degrees",
                scores(shell, points).sum(),
                "of %d" % angle_count,
                most=0 if is_main else None,
            ),
            Measure(
                name + ": largest distance of a boundary vertex to its circle, input",
                boundary_distance(shell, shell.points),
                "mean edges",
            ),
            Measure(
                name + ": largest distance of a boundary vertex to its circle",
                boundary_distance(shell, points),
                "mean edges",
                most=0.01 if is_main else None,
            ),
            Measure(name + ": mean change of a face's area", area_errors(shell, points).mean(), "%", most=5),
            Measure(name + ": largest change of a face's area", area_errors(shell, points).max(), "%", most=25),
            Measure(
                name + ": sharpest angle between faces, input",
                measure.face_face_angles(shell.points, shell.faces).min(),
                "degrees",
            ),
            Measure(
                name + ": sharpest angle between faces",
                measure.face_face_angles(points, shell.faces).min(),
                "degrees",
                least=90,
            ),
        ]
    return found


def picture(solved, path):
    rows = []
    for name in MODELS:
        shell, row = solved[name], []
        for title, points in (("input", shell.points), (STAGE, shell[STAGE])):
            found = scores(shell, points)
            title += ": %d of %d angles outside\nboundaries up to %.3f edges off circles" % (
                found.sum(),
                4 * len(found),
                boundary_distance(shell, points),
            )
            width = {"coarse": 0.6, "medium": 0.4, "fine": 0.2}[name]
            row.append(
                Panel(
                    points,
                    shell.faces,
                    title,
                    face_colors=SCORES(found),
                    line_width=width,
                    floor=min(points[:, 2].min(), shell.points[:, 2].min()),
                )
            )
        rows.append(row)
    labels = ["%s, %d faces" % (name, len(solved[name].faces)) for name in MODELS]
    legend = (SCORES, -0.5, 4.5, "angles of a face outside 80 to 110 degrees, 0 to 4")
    page(path, rows, Camera(-70, 34), [legend], width=9.5, row_labels=labels)
