"""Draws icon.png of every component: `python draw_icons.py`. Needs Pillow.

Drawn 16 times larger, then reduced. Blue is geometry, orange is what holds or drives it, grey is what was there before.
"""

import math
import os

from PIL import Image, ImageDraw

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE, SCALE = 24, 16
BLUE, ORANGE, GREY, PALE, RED, WHITE = "#1f5fa8", "#e8731a", "#8a8f98", "#cfe0f2", "#b2182b", "#ffffff"


class Icon(object):
    """Shapes in pixels of the finished icon."""

    def __init__(self):
        self.image = Image.new("RGBA", (SIZE * SCALE, SIZE * SCALE), (0, 0, 0, 0))
        self._draw = ImageDraw.Draw(self.image)

    def line(self, points, colour=BLUE, width=1.6):
        scaled = [(x * SCALE, y * SCALE) for x, y in points]
        self._draw.line(scaled, fill=colour, width=int(width * SCALE), joint="curve")
        for x, y in points:
            self.dot(x, y, width / 2.0, colour)

    def dot(self, x, y, radius=2.0, colour=BLUE):
        box = [(x - radius) * SCALE, (y - radius) * SCALE, (x + radius) * SCALE, (y + radius) * SCALE]
        self._draw.ellipse(box, fill=colour)

    def face(self, points, fill, outline=BLUE):
        self._draw.polygon([(x * SCALE, y * SCALE) for x, y in points], fill=fill)
        self.line(points + points[:1], outline, 1.3)

    def arc(self, x, y, radius, start, end, colour=BLUE, width=1.6):
        steps = [start + (end - start) * n / 40.0 for n in range(41)]
        self.line([(x + radius * math.cos(a), y + radius * math.sin(a)) for a in steps], colour, width)

    def arrow(self, start, end, colour=ORANGE, width=1.8, head=4.0):
        angle = math.atan2(end[1] - start[1], end[0] - start[0])
        base = (end[0] - 0.8 * head * math.cos(angle), end[1] - 0.8 * head * math.sin(angle))
        self.line([start, base], colour, width)
        side = [(end[0] - head * math.cos(angle + s), end[1] - head * math.sin(angle + s)) for s in (0.6, -0.6)]
        self._draw.polygon([(x * SCALE, y * SCALE) for x, y in [end] + side], fill=colour)

    def save(self, path):
        self.image.resize((SIZE, SIZE), Image.LANCZOS).save(path, optimize=True)


def mesh_indexer(icon):
    for x in (4, 12, 20):
        icon.line([(x, 4), (x, 20)], GREY, 1.2)
        icon.line([(4, x), (20, x)], GREY, 1.2)
    icon.face([(12, 4), (20, 4), (20, 12), (12, 12)], PALE)
    for x, y in ((12, 4), (20, 4), (20, 12), (12, 12)):
        icon.dot(x, y, 2.3, ORANGE)


def anchors_indexer(icon):
    icon.arc(12, 5, 3, 0, 2 * math.pi, ORANGE)
    icon.line([(12, 8), (12, 21)], ORANGE, 2)
    icon.line([(7.5, 11.5), (16.5, 11.5)], ORANGE, 1.8)
    icon.arc(12, 13, 8, 0.15 * math.pi, 0.85 * math.pi, BLUE, 2)


def constraint_signature(icon):
    icon.face([(5, 2), (15, 2), (19, 6), (19, 22), (5, 22)], WHITE)
    icon.face([(8, 9), (13, 11), (16, 7.5), (11, 5.5)], PALE)
    for y in (14.5, 18):
        icon.dot(8.5, y, 1.2, ORANGE)
        icon.line([(11.5, y), (16, y)], GREY, 1.3)


def settings_static(icon):
    slider(icon, 7, 15)
    slider(icon, 13, 8)
    icon.face([(5, 17.5), (9, 17.5), (9, 21.5), (5, 21.5)], BLUE)


def settings_live(icon):
    slider(icon, 7, 15)
    slider(icon, 13, 8)
    icon.face([(5, 17), (5, 22), (9.5, 19.5)], ORANGE, ORANGE)


def slider(icon, y, knob):
    icon.line([(3, y), (21, y)], GREY, 1.5)
    icon.dot(knob, y, 2.8, BLUE)


def constraint_solver(icon):
    icon.face([(3, 18), (12, 14), (21, 19), (12, 22)], WHITE, GREY)
    icon.face([(3, 9), (12, 5), (21, 9), (12, 13)], PALE)
    icon.arrow((12, 20.5), (12, 10), ORANGE)


def live_solver(icon):
    icon.arc(12, 12, 9, -0.35 * math.pi, 1.25 * math.pi, BLUE, 2.2)
    icon.arrow((6.2, 4.6), (10.5, 2.6), BLUE, 2.2, 5)
    icon.face([(9.5, 7.5), (9.5, 16.5), (17, 12)], ORANGE, ORANGE)


def one_shot_solver(icon):
    icon.arc(12, 12, 9.5, 0, 2 * math.pi, BLUE, 2)
    icon.arc(12, 12, 5.2, 0, 2 * math.pi, BLUE, 1.5)
    icon.arrow((22, 2), (11.5, 12.5), ORANGE, 2.2, 5)


def force(icon):
    icon.line([(3, 8), (12, 15), (21, 8)], BLUE)
    for x, y in ((3, 8), (21, 8)):
        icon.dot(x, y, 2)
    icon.arrow((12, 2), (12, 13), ORANGE, 2.2, 5)
    icon.line([(6, 21), (18, 21)], GREY, 1.4)


def handles(icon):
    icon.line([(2, 20), (9, 17), (15, 9), (22, 20)], BLUE)
    icon.dot(9, 17, 1.8)
    icon.face([(11.5, 5.5), (18.5, 5.5), (18.5, 12.5), (11.5, 12.5)], ORANGE, ORANGE)
    icon.arrow((15, 5), (15, 0.5), RED, 1.6, 3.6)


def constraint_types(icon):
    icon.dot(4.5, 5, 2.5)
    icon.face([(2.2, 14), (4.5, 9.8), (6.8, 14)], BLUE)
    icon.face([(2.5, 17.5), (6.5, 17.5), (6.5, 21.5), (2.5, 21.5)], BLUE)
    for y in (5, 12, 19.5):
        icon.line([(10.5, y), (21, y)], GREY, 2)


def planarity(icon):
    icon.face([(2, 15), (9, 20), (13, 12), (7, 8)], "#d6efdf")
    icon.face([(9, 20), (17, 19.5), (19, 11), (13, 12)], "#fdcb5c")
    icon.face([(13, 12), (19, 11), (21, 3), (14, 4)], "#a50026")


def strain(icon):
    blue = "#2166ac"
    icon.line([(8, 7), (16, 7)], blue, 2.4)
    icon.arrow((8, 7), (1, 7), blue, 2.4, 6.5)
    icon.arrow((16, 7), (23, 7), blue, 2.4, 6.5)
    icon.arrow((1.5, 17.5), (10.5, 17.5), RED, 2.4, 6.5)
    icon.arrow((22.5, 17.5), (13.5, 17.5), RED, 2.4, 6.5)


ICONS = {
    "ShapeOpMeshIndexer": mesh_indexer,
    "ShapeOpAnchorsIndexer": anchors_indexer,
    "ShapeOpConstraintSignature": constraint_signature,
    "ShapeOpSettingsStatic": settings_static,
    "ShapeOpSettingsLive": settings_live,
    "ShapeOpConstraintSolver": constraint_solver,
    "ShapeOpLiveSolver": live_solver,
    "ShapeOpOneShotSolver": one_shot_solver,
    "ShapeOpForce": force,
    "ShapeOpHandles": handles,
    "ShapeOpConstraintTypes": constraint_types,
    "ShapeOpPlanarity": planarity,
    "ShapeOpStrain": strain,
}

if __name__ == "__main__":
    for name, draw in ICONS.items():
        icon = Icon()
        draw(icon)
        icon.save(os.path.join(HERE, name, "icon.png"))
