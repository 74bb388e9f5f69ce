"""Figure 7: a box of rigid faces, of which each takes the nearest of three sizes while the box is pulled apart."""

import numpy as np
from matplotlib.patches import Patch

import measure
import meshes
from claims import Measure
from draw import EDGE, Camera, Panel, page

NUMBER = 7
TITLE = "A box with three rigid sizes of faces"
CLAIM = (
    "Pulled apart, faces ripple from the short to the medium to the long target, and each matches the one that it took."
)
NOTES = """\
A box of 12 x 3 x 3 faces, closed at both ends, is pulled to twice its length in 160 time steps and held. It then has
10 rings of long and 2 of medium faces, which are 23 long together, while its ends are 24 apart: each face is 1/12 too
long, 1/24 at either end, and that is what is measured. When the ends are eased to 23, every face is congruent to its
target.
"""

LENGTH, SIDE = 12, 3
WIDTHS = {"short": 1.0, "medium": 1.5, "long": 2.0}
COLORS = {"short": "#4c78a8", "medium": "#f2c14e", "long": "#d1495b"}
PULL_STEPS, HOLD_STEPS = 40, 80
#: What the sides are apart in the end: 10 long and 2 medium faces, which is what the pull leaves.
EASED = 23


def build():
    points, faces = meshes.box(LENGTH, SIDE, SIDE)
    fixed, pulled = (np.flatnonzero(points[:, 0] == x) for x in (0, LENGTH))
    targets = [c for w in WIDTHS.values() for c in (0, 0, 0, w, 0, 0, w, 1, 0, 0, 1, 0)]

    def pulled_to(x):
        return {"constraints": "pulled side", "scalars": [[x, *points[i][1:]] for i in pulled]}

    stages = []
    for quarter in range(1, 5):
        edit = pulled_to(LENGTH * (1 + quarter / 4)) | {"ramp": True}
        stages.append({"name": "pulled by %d %%" % (25 * quarter), "solves": PULL_STEPS, "edits": [edit]})
    stages.append({"name": "held", "solves": HOLD_STEPS})
    stages.append({"name": "eased", "solves": PULL_STEPS, "edits": [pulled_to(EASED) | {"ramp": True}]})
    stages.append({"name": "at rest", "solves": HOLD_STEPS})
    model = {
        "name": "box",
        "mesh": "meshes/fig07.obj",
        "constraints": [
            {"name": "faces", "type": "Rigid", "indices": "faceVertices", "weights": [200], "scalars": [targets]},
            {
                "name": "fixed side",
                "type": "Closeness",
                "indices": [[int(i)] for i in fixed],
                "weights": [10000],
                "scalars": points[fixed].tolist(),
            },
            {
                "name": "pulled side",
                "type": "Closeness",
                "indices": [[int(i)] for i in pulled],
                "weights": [10000],
                "scalars": points[pulled].tolist(),
            },
        ],
        "settings": {
            "mode": "live",
            "iterations": 10,
            "mass": 1,
            "damping": 1,
            "time_step": 0.1,
            "gravity": [0, 0, 0],
            "dynamic": True,
        },
        "stages": stages,
    }
    return {"figure": NUMBER, "title": TITLE, "models": [model]}, {"meshes/fig07.obj": (points, faces)}


def matches(box, points):
    """Which target each face is nearest to, 0 to 2, and how far its farthest corner is from that."""
    targets = np.array(box.model["constraints"][0]["scalars"][0]).reshape(-1, 4, 3)
    return measure.nearest_shapes(targets, points[np.array(box.faces)])


def rings(box, points):
    """How many rings of faces around the box, of 12, are nearest to each target. The closed ends are left out."""
    is_end = np.array([np.ptp(box.points[face][:, 0]) == 0 for face in box.faces])
    return np.bincount(matches(box, points)[0][~is_end], minlength=3) / (4 * SIDE)


def measures(solved):
    box = solved["box"]
    half, held, rest = (box[stage] for stage in ("pulled by 50 %", "held", "at rest"))
    found = [Measure("rings with the short target, at the start", rings(box, box.points)[0], "of 12", least=12)]
    found += [
        Measure("rings with the %s target, pulled by 50 %%" % name, count, "of 12")
        for name, count in zip(WIDTHS, rings(box, half), strict=True)
    ]
    found += [Measure("targets in use at once, pulled by 50 %", (rings(box, half) > 0).sum(), "of 3", least=3)]
    found += [
        Measure("rings with the long target, held at 100 %", rings(box, held)[2], "of 12", least=9),
        Measure(
            "largest distance of a corner to its face's target, held at 100 %",
            matches(box, held)[1].max(),
            "short edges",
            most=0.05,
        ),
        Measure(
            "the same, eased to the length of the targets taken", matches(box, rest)[1].max(), "short edges", most=0.001
        ),
    ]
    return found


def picture(solved, path):
    box = solved["box"]
    shown = [("input", box.points)]
    shown += [(name, box[name]) for name in ("pulled by 50 %", "pulled by 75 %", "pulled by 100 %", "at rest")]
    panels = []
    for title, points in shown:
        which, distance = matches(box, points)
        colors = np.array([_rgb(list(COLORS.values())[k]) for k in which])
        title = {"at rest": "eased to %d" % EASED}.get(title, title)
        title += ": corners up to %.3f off the target of their face" % distance.max()
        panels.append(Panel(points, box.faces, title, face_colors=colors, floor=0, line_width=0.6))
    steps, shares = _history(box)

    def plot(axes):
        axes.stackplot(steps, shares.T, colors=list(COLORS.values()), linewidth=0)
        axes.set(xlim=(0, steps[-1]), ylim=(0, 12), xlabel="time step", ylabel="rings of faces")
        axes.set_yticks([0, 4, 8, 12])
        for at, name in (
            (4 * PULL_STEPS, "held"),
            (4 * PULL_STEPS + HOLD_STEPS, "eased"),
            (5 * PULL_STEPS + HOLD_STEPS, "at rest"),
        ):
            axes.axvline(at, color=EDGE, linewidth=0.6, linestyle=":")
            axes.text(at + 3, 11, name, fontsize=7.5, va="top", color="white")
        axes.legend(
            handles=[Patch(color=COLORS[name], label="%s: %g by 1" % (name, width)) for name, width in WIDTHS.items()],
            loc="lower center",
            bbox_to_anchor=(0.5, 1.0),
            ncols=3,
            fontsize=8,
            frameon=False,
        )

    page(path, [[panel] for panel in panels], Camera(-82, 20), width=8.0, plot=(1.5, plot))


def _history(box):
    frames = [box.points] + [frame for frames in box.frames.values() for frame in frames]
    steps = np.arange(0, len(frames), 2)
    return steps, np.array([rings(box, frames[step]) for step in steps])


def _rgb(color):
    return [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
