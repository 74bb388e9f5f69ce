"""Shaded pictures of meshes: orthographic projection, faces painted from far to near."""

import io
from dataclasses import dataclass, field

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb, to_rgba
from matplotlib.path import Path
from PIL import Image

SURFACE = "#dbe4ee"
EDGE = "#33414f"
SHADOW = "#e6e8ec"
ANCHOR = "#d1332e"

#: Bad is red, good is green; in between the lightness has its maximum, so that it can be read without the hues.
GOOD_TO_BAD = LinearSegmentedColormap.from_list("good to bad", ["#1b7f4b", "#8cc665", "#f8ecae", "#f0a05a", "#c22b2b"])
#: Compression red, tension blue.
STRAIN = LinearSegmentedColormap.from_list("strain", ["#b2182b", "#ef8a62", "#c9c9c9", "#67a9cf", "#2166ac"])
NEAR_TO_FAR = LinearSegmentedColormap.from_list("near to far", ["#2b6cb0", "#7ea6cf", "#a79fae", "#d9785f", "#b8212f"])

DPI = 130


@dataclass
class Camera:
    """Looks from `azimuth_deg` (from +x towards +y) and `elevation_deg` above the horizon towards the origin."""

    azimuth_deg: float = -60
    elevation_deg: float = 28

    def axes(self):
        """The unit vectors to the right, up and towards the eye."""
        azimuth, elevation = np.radians(self.azimuth_deg), np.radians(self.elevation_deg)
        eye = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        return right, np.cross(eye, right), eye

    def flat(self, points):
        right, up, _ = self.axes()
        points = np.asarray(points, dtype=float)
        return np.stack([points @ right, points @ up], axis=-1)

    def depth(self, points):
        return np.asarray(points, dtype=float) @ self.axes()[2]


@dataclass
class Panel:
    """One picture: a mesh, and what is drawn with it. Colours are anything that matplotlib takes, one or one for each
    face or edge."""

    points: np.ndarray
    faces: list
    title: str = ""
    face_colors: object = SURFACE
    has_faces: bool = True
    line_width: float = 0.5
    edges: object = (
        None  #: pairs of indices, drawn in `edge_colors` over the faces; None: the outlines of faces in grey
    )
    edge_colors: object = EDGE
    marks: object = None  #: points marked by dots
    lines: list = field(default_factory=list)  #: polylines over the mesh: (points, color, width)
    arrows: list = field(default_factory=list)  #: (from, to)
    floor: object = None  #: the height of the floor that a shadow falls on; None: no shadow
    camera: object = None  #: None: the page's


def colors_of(values, colormap, low, high):
    return colormap(Normalize(low, high, clip=True)(np.asarray(values, dtype=float)))


def shaded(points, faces, colors, camera):
    """The colours of faces in the light of a lamp over the viewer's left shoulder and of the sky; both sides of a face
    are lit."""
    right, up, eye = camera.axes()
    lamp = -0.55 * right + 0.75 * up + 0.65 * eye
    lamp = lamp / np.linalg.norm(lamp)
    normals = []
    for face in faces:
        corners = points[face] - points[face].mean(axis=0)
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        size = np.linalg.norm(normal)
        normal = normal / size if size > 0 else eye
        normals.append(normal if normal @ eye >= 0 else -normal)
    normals = np.array(normals)
    light = 0.60 + 0.34 * np.clip(normals @ lamp, 0, 1) + 0.12 * np.clip(normals @ eye, 0, 1)
    is_plain = isinstance(colors, str)
    if not is_plain:
        light = 0.55 + 0.45 * light  # colours that mean something stay near those of the legend
    rgb = np.array([to_rgb(colors)] * len(faces)) if is_plain else np.array(colors)[:, :3]
    return np.clip(rgb * light[:, None], 0, 1)


def draw(axes, panel, camera):
    points, flat = panel.points, camera.flat(panel.points)
    if panel.floor is not None:
        shadow = camera.flat(_shadow(panel))
        axes.add_collection(
            PolyCollection(
                [shadow[f] for f in panel.faces], facecolors=SHADOW, edgecolors=SHADOW, linewidths=0.6, zorder=0
            )
        )
    depth = camera.depth(points)
    if panel.has_faces:
        axes.add_collection(_painted_faces(panel, flat, depth, camera))
    elif panel.edges is not None:
        edges = np.asarray(panel.edges)
        order = np.argsort(depth[edges].mean(axis=1))
        colors = _edge_colors(panel)[order]
        axes.add_collection(
            LineCollection(flat[edges[order]], colors=colors, linewidths=panel.line_width, capstyle="round", zorder=2)
        )
    for line, color, width in panel.lines:
        line = camera.flat(line)
        axes.plot(line[:, 0], line[:, 1], color=color, linewidth=width, zorder=3, solid_capstyle="round")
    for start, end in panel.arrows:
        start, end = camera.flat([start, end])
        axes.annotate(
            "",
            end,
            start,
            zorder=4,
            arrowprops={
                "arrowstyle": "-|>",
                "color": ANCHOR,
                "lw": 1.1,
                "shrinkA": 0,
                "shrinkB": 0,
                "mutation_scale": 9,
            },
        )
    if panel.marks is not None:
        at = camera.flat(panel.marks)
        alpha = [
            0.25 if panel.has_faces and _is_hidden(mark, panel, flat, depth, camera) else 1.0 for mark in panel.marks
        ]
        axes.scatter(at[:, 0], at[:, 1], s=16, color=ANCHOR, edgecolors="white", linewidths=0.6, alpha=alpha, zorder=5)


def _painted_faces(panel, flat, depth, camera):
    """The faces from far to near, each followed by its edges where these have colours of their own: nearer faces cover
    both."""
    colors = shaded(panel.points, panel.faces, panel.face_colors, camera)
    edges = {}
    if panel.edges is not None:
        edges = {frozenset(edge): color for edge, color in zip(panel.edges, _edge_colors(panel), strict=True)}
    has_outlines = panel.edges is None and panel.line_width > 0
    shapes, fills, strokes, widths = [], [], [], []
    for k in np.argsort([depth[face].mean() for face in panel.faces]):
        face = panel.faces[k]
        shapes.append(flat[face])
        fills.append((*colors[k], 1))
        strokes.append(to_rgba(EDGE) if has_outlines else (*colors[k], 1))
        widths.append(panel.line_width if has_outlines else 0.3)
        for start, end in zip(face, face[1:] + face[:1], strict=True):
            if frozenset((start, end)) in edges:
                shapes.append(flat[[start, end]])
                fills.append((0, 0, 0, 0))
                strokes.append(edges[frozenset((start, end))])
                widths.append(panel.line_width)
    return PolyCollection(
        shapes, facecolors=fills, edgecolors=strokes, linewidths=widths, joinstyle="round", capstyle="round", zorder=1
    )


def _is_hidden(mark, panel, flat, depth, camera):
    """Whether a face that the mark is no corner of lies between it and the eye."""
    at, mark_depth = camera.flat(mark), camera.depth(mark)
    for face in panel.faces:
        is_beyond = depth[face].mean() > mark_depth and np.abs(panel.points[face] - mark).max(axis=1).min() > 1e-9
        if is_beyond and Path(flat[face]).contains_point(at):
            return True
    return False


def _edge_colors(panel):
    colors = panel.edge_colors
    return np.array([to_rgba(colors)] * len(panel.edges)) if isinstance(colors, str) else np.asarray(colors)


def _shadow(panel):
    """Where the points throw their shadows: the sun stands a little aside, so that it shows."""
    ground = panel.points.copy()
    ground[:, :2] += (ground[:, 2:] - panel.floor) * np.array([0.25, 0.18])
    ground[:, 2] = panel.floor
    return ground


def extent(panel, camera):
    shown = [camera.flat(panel.points)]
    if panel.floor is not None:
        shown.append(camera.flat(_shadow(panel)))
    shown += [camera.flat(line) for line, _, _ in panel.lines]
    shown += [camera.flat(np.array(arrow)) for arrow in panel.arrows]
    shown = np.concatenate(shown)
    return np.array([shown.min(axis=0), shown.max(axis=0)])


def page(path, rows, camera, legends=(), width=11.0, row_labels=(), is_one_scale=True, plot=None, margin=0.04):
    """Writes a page of panels in rows. With `is_one_scale` all have one window, so that sizes compare; otherwise
    each panel fills its place. `legends`: (colormap, low, high, label with unit), drawn below, side by side. `plot`:
    (height in inches, a function that draws into the axes it is given), below everything."""
    count = max(len(row) for row in rows)
    windows = {id(p): extent(p, p.camera or camera) for row in rows for p in row if p}
    if is_one_scale:
        low = np.min([w[0] for w in windows.values()], axis=0)
        high = np.max([w[1] for w in windows.values()], axis=0)
        windows = {key: np.array([low, high]) for key in windows}
    ratio = max((w[1] - w[0])[1] / (w[1] - w[0])[0] for w in windows.values())
    label_width = 0.32 if row_labels else 0.0
    panel_width = (width - label_width) / count
    panel_height, title_height = panel_width * ratio, 0.42
    legend_height = 0.62 if legends else 0.05
    if plot:
        legend_height += plot[0] + 0.9
    height = len(rows) * (panel_height + title_height) + legend_height
    figure = plt.figure(figsize=(width, height))
    for r, row in enumerate(rows):
        bottom = height - (r + 1) * (panel_height + title_height)
        if row_labels:
            figure.text(
                0.16 / width,
                (bottom + panel_height / 2) / height,
                row_labels[r],
                rotation=90,
                ha="center",
                va="center",
                fontsize=9,
            )
        for c, panel in enumerate(row):
            if panel is None:
                continue
            left = label_width + c * panel_width
            axes = figure.add_axes([left / width, bottom / height, panel_width / width, panel_height / height])
            axes.set_axis_off()
            draw(axes, panel, panel.camera or camera)
            _frame(axes, windows[id(panel)], ratio, margin)
            figure.text(
                (left + panel_width / 2) / width,
                (bottom + panel_height + 0.05) / height,
                panel.title,
                ha="center",
                va="bottom",
                fontsize=8.5,
                linespacing=1.25,
            )
    for k, (colormap, low, high, label) in enumerate(legends):
        place = width / len(legends)
        bar_width = min(3.6, 0.75 * place)
        bar = figure.add_axes(
            [(k * place + (place - bar_width) / 2) / width, 0.40 / height, bar_width / width, 0.11 / height]
        )
        drawn = figure.colorbar(ScalarMappable(Normalize(low, high), colormap), cax=bar, orientation="horizontal")
        drawn.set_label(label, fontsize=8, labelpad=2)
        drawn.ax.tick_params(labelsize=7.5, length=2, pad=1.5)
        drawn.outline.set_linewidth(0.4)
    if plot:
        axes = figure.add_axes([0.7 / width, 0.5 / height, (width - 1.0) / width, plot[0] / height])
        axes.tick_params(labelsize=7.5)
        axes.xaxis.label.set_size(8)
        axes.yaxis.label.set_size(8)
        plot[1](axes)
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=DPI, facecolor="white")
    plt.close(figure)
    # A palette of 256 colours takes a third of the room, and shows no difference.
    Image.open(drawn).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=4, dither=Image.Dither.NONE).save(
        path, optimize=True
    )


def _frame(axes, window, ratio, margin):
    """Centres a window in axes of the given height over width."""
    middle, size = window.mean(axis=0), (window[1] - window[0]) * (1 + 2 * margin)
    wide = max(size[0], size[1] / ratio)
    axes.set_xlim(middle[0] - wide / 2, middle[0] + wide / 2)
    axes.set_ylim(middle[1] - wide * ratio / 2, middle[1] + wide * ratio / 2)
