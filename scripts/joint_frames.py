#!/usr/bin/env python3
"""Draws the frames of joints as SVG: two bodies, the anchor frames a and b, and the axes that the joint leaves free.

    scripts/joint_frames.py [FOLDER]      writes one file a joint, by default to docs/reference/figures

Each joint is drawn with b a little away from its zero position, so that both frames show. The rows of the joints are
those of include/delassus/constraints/joints.
"""
import math
import sys
from pathlib import Path

COLOURS = {"x": "#d62728", "y": "#2ca02c", "z": "#1f55c4"}
FREE, INK = "#e67e00", "#333333"
WIDTH, HEIGHT, SCALE = 440, 300, 140


def turn(axis, angle):
    """The rotation matrix, by columns, of a turn about x, y or z."""
    c, s = math.cos(angle), math.sin(angle)
    return {"x": ((1, 0, 0), (0, c, s), (0, -s, c)), "y": ((c, 0, -s), (0, 1, 0), (s, 0, c)),
            "z": ((c, s, 0), (-s, c, 0), (0, 0, 1))}[axis]


def times(R, v):
    return tuple(sum(R[k][i] * v[k] for k in range(3)) for i in range(3))


def plus(a, b, s=1.0):
    return tuple(x + s * y for x, y in zip(a, b))


def flat(p):
    """The place on paper of a point: seen from (2, -3, 1.8), z up."""
    azimuth, height = math.radians(-58), math.radians(24)
    right = (-math.sin(azimuth), math.cos(azimuth), 0)
    up = (-math.cos(azimuth) * math.sin(height), -math.sin(azimuth) * math.sin(height), math.cos(height))
    return (WIDTH / 2 + SCALE * sum(a * b for a, b in zip(p, right)),
            HEIGHT / 2 + 15 - SCALE * sum(a * b for a, b in zip(p, up)))


class Picture:
    def __init__(self, title):
        self.lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
                      f'height="{HEIGHT}" font-family="sans-serif" font-size="13">', f"<title>{title}</title>", "<defs>"]
        for name, colour in [*COLOURS.items(), ("free", FREE), ("ink", INK)]:
            self.lines.append(f'<marker id="{name}" viewBox="0 0 8 8" refX="6.5" refY="4" markerWidth="5" markerHeight="5" '
                              f'orient="auto-start-reverse"><path d="M0 0.6 L8 4 L0 7.4 z" fill="{colour}"/></marker>')
        self.lines += ["</defs>", f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']

    def path(self, points, colour, width=2.0, end=None, start=None, dash=None):
        d = "M" + " L".join(f"{x:.1f} {y:.1f}" for x, y in map(flat, points))
        marks = (f' marker-end="url(#{end})"' if end else "") + (f' marker-start="url(#{start})"' if start else "")
        self.lines.append(f'<path d="{d}" fill="none" stroke="{colour}" stroke-width="{width}"{marks}'
                          + (f' stroke-dasharray="{dash}"' if dash else "") + "/>")

    def text(self, p, words, colour=INK, shift=(0, 0), anchor="middle"):
        x, y = flat(p)
        base, _, low = words.partition("_")
        low = f'<tspan font-size="9" dy="3">{low}</tspan>' if low else ""
        self.lines.append(f'<text x="{x + shift[0]:.1f}" y="{y + shift[1] + 4:.1f}" fill="{colour}" text-anchor="{anchor}" '
                          f'stroke="white" stroke-width="3" paint-order="stroke">{base}{low}</text>')

    def box(self, centre, half, R, fill, name):
        """The three faces that the eye sees."""
        corner = lambda s: plus(centre, times(R, tuple(h * k for h, k in zip(half, s))))
        eye = (2.0, -3.0, 1.8)
        for axis in range(3):
            side = 1 if sum(a * b for a, b in zip(R[axis], eye)) > 0 else -1
            i, j = (axis + 1) % 3, (axis + 2) % 3
            points = []
            for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                s = [0, 0, 0]
                s[axis], s[i], s[j] = side, u, v
                points.append(flat(corner(s)))
            d = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            self.lines.append(f'<polygon points="{d}" fill="{fill}" fill-opacity="0.55" stroke="#888" stroke-width="0.8"/>')
        self.text(centre, name, "#555")

    def frame(self, origin, R, which, length=0.62, width=2.2, shift=0.0):
        dash = None if which == "a" else "5 2.5"
        for k, axis in enumerate("xyz"):
            tip = plus(origin, R[k], length)
            self.path([origin, tip], COLOURS[axis], width, end=axis, dash=dash)
            self.text(plus(origin, R[k], length + 0.14 + shift), f"{which}_{axis}", COLOURS[axis])

    def arc(self, centre, R, axis, radius=0.3, first=-0.9, last=2.6, at=0.0):
        """A positive turn about an axis of the frame R, drawn at a height above the frame's origin."""
        k = "xyz".index(axis)
        i, j = (k + 1) % 3, (k + 2) % 3
        points = []
        for n in range(41):
            t = first + (last - first) * n / 40
            p = plus(plus(plus(centre, R[k], at), R[i], radius * math.cos(t)), R[j], radius * math.sin(t))
            points.append(p)
        self.path(points, FREE, 2.6, end="free")

    def arrow(self, a, b, both=True):
        self.path([a, b], FREE, 2.6, end="free", start="free" if both else None)

    def write(self, path):
        path.write_text("\n".join([*self.lines, "</svg>", ""]), encoding="utf-8")


I3 = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
GREY, BLUE = "#c8c8c8", "#a9cbe8"


def below_and_above(title, R, lift=0.0):
    """Body a under the joint, b over it, turned and lifted; both anchors on the joint's axis."""
    p = Picture(title)
    b = (0, 0, lift)
    p.box((-0.75, 0, -0.45), (0.42, 0.3, 0.22), I3, GREY, "a")
    p.path([(-0.5, 0, -0.25), (0, 0, 0)], "#999", 3)
    out = plus(b, times(R, (0.85, 0, 0.5)))
    p.path([b, plus(b, times(R, (0.6, 0, 0.32)))], "#7aa7cf", 3)
    p.box(out, (0.36, 0.26, 0.2), R, BLUE, "b")
    return p, b


def draw(folder):
    folder.mkdir(parents=True, exist_ok=True)

    p, o = below_and_above("BallJoint: b turns about every axis", tuple(times(turn("z", 0.45), c) for c in turn("x", 0.5)))
    R = tuple(times(turn("z", 0.45), c) for c in turn("x", 0.5))
    p.frame(o, I3, "a")
    p.frame(o, R, "b", 0.45)
    for axis in "xyz":
        p.arc(o, I3, axis, 0.12, -0.8, 2.6, 0.53)
    p.write(folder / "ball_joint.svg")

    R = turn("z", 0.6)
    p, o = below_and_above("Hinge: b turns about z", R)
    p.frame(o, I3, "a", 0.75)
    p.frame(o, R, "b", 0.55)
    p.arc(o, I3, "z", 0.2, -0.9, 2.8, 0.42)
    p.arc(o, I3, "z", 0.4, 0.02, 0.58)
    p.text(plus(o, (0.48 * math.cos(0.3), 0.48 * math.sin(0.3), 0)), "θ", FREE)
    p.write(folder / "hinge.svg")

    p = Picture("Slider: b moves along z")
    b = (0, 0, 0.5)
    p.box((-0.75, 0, -0.55), (0.42, 0.3, 0.22), I3, GREY, "a")
    p.path([(-0.5, 0, -0.35), (0, 0, -0.3)], "#999", 3)
    p.path([b, (0.5, 0, 0.5)], "#7aa7cf", 3)
    p.box((0.85, 0, 0.6), (0.36, 0.26, 0.2), I3, BLUE, "b")
    p.frame((0, 0, -0.3), I3, "a", 0.5)
    p.frame(b, I3, "b", 0.45)
    p.arrow((-0.28, 0, -0.3), (-0.28, 0, 0.5), both=False)
    p.text((-0.38, 0, 0.1), "s", FREE)
    p.write(folder / "slider.svg")

    R = turn("z", 0.6)
    p = Picture("Cylindrical: b moves along z and turns about it")
    p.box((-0.75, 0, -0.55), (0.42, 0.3, 0.22), I3, GREY, "a")
    p.path([(-0.5, 0, -0.35), (0, 0, -0.3)], "#999", 3)
    out = plus(b, times(R, (0.85, 0, 0.1)))
    p.path([b, plus(b, times(R, (0.5, 0, 0)))], "#7aa7cf", 3)
    p.box(out, (0.36, 0.26, 0.2), R, BLUE, "b")
    p.frame((0, 0, -0.3), I3, "a", 0.5)
    p.frame(b, R, "b", 0.45)
    p.arrow((-0.28, 0, -0.3), (-0.28, 0, 0.5), both=False)
    p.text((-0.38, 0, 0.1), "s", FREE)
    p.arc(b, I3, "z", 0.17, -0.9, 2.8, 0.25)
    p.text((-0.22, 0, 0.88), "θ", FREE)
    p.write(folder / "cylindrical.svg")

    R = tuple(times(turn("x", 0.45), c) for c in turn("y", 0.4))  # b_y stays across a_x
    p, o = below_and_above("Universal: b turns about a_x and b_y", R)
    p.frame(o, I3, "a", 0.75)
    p.frame(o, R, "b", 0.62)
    p.arc(o, I3, "x", 0.13, -0.6, 2.8, 0.5)
    p.arc(o, R, "y", 0.13, -0.6, 2.8, 0.4)
    p.write(folder / "universal.svg")

    p = Picture("Weld: nothing is free")
    p.box((-0.55, 0, 0), (0.5, 0.3, 0.22), I3, GREY, "a")
    p.box((0.5, 0, 0), (0.5, 0.3, 0.22), I3, BLUE, "b")
    p.frame((0, 0, 0.24), I3, "a", 0.7)
    p.frame((0, 0, 0.24), I3, "b", 0.38, 3.4, -0.02)
    p.write(folder / "weld.svg")

    p = Picture("DistanceJoint: the points keep their distance")
    a, b = (-0.55, 0, 0.1), (0.75, 0, 0.35)
    p.box((-1.0, 0, -0.1), (0.42, 0.3, 0.22), I3, GREY, "a")
    p.box((1.12, 0, 0.5), (0.36, 0.26, 0.2), turn("y", 0.3), BLUE, "b")
    p.path([a, b], INK, 1.6, dash="2 3")
    d = tuple(x - y for x, y in zip(a, b))
    size = math.sqrt(sum(x * x for x in d))
    e = tuple(x / size for x in d)
    p.path([plus(b, e, 0.25), plus(b, e, 0.75)], INK, 2.2, end="ink")
    for point, word in ((a, "x_a"), (b, "x_b")):
        x, y = flat(point)
        p.lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{INK}"/>')
        p.text(point, word, INK, (0, -14))
    p.text(plus(b, e, 0.5), "e", INK, (0, -13))
    p.text(plus(b, e, 0.95), "L", INK, (0, 15))
    p.write(folder / "distance_joint.svg")

    p = Picture("Limit and Motor: the turn of b_x against a_x about a_z")
    o, low, high, now = (0, 0, -0.15), -0.6, 1.3, 0.5
    radius = lambda t, r=0.8: plus(plus(o, (1, 0, 0), r * math.cos(t)), (0, 1, 0), r * math.sin(t))
    p.path([radius(low + (high - low) * n / 40) for n in range(41)], "#999", 1.4, dash="3 3")
    for t, word in ((low, "lower"), (high, "upper")):
        p.path([o, radius(t, 1.0)], INK, 1.8)
        p.text(radius(t, 1.2), word)
    p.box((-0.75, 0, -0.6), (0.42, 0.3, 0.22), I3, GREY, "a")
    p.path([(-0.5, 0, -0.4), o], "#999", 3)
    p.box(radius(now, 1.15), (0.3, 0.2, 0.12), turn("z", now), BLUE, "b")
    p.frame(o, I3, "a", 0.7)
    p.path([o, radius(now, 0.72)], COLOURS["x"], 2.2, end="x", dash="5 2.5")
    p.text(radius(now, 0.62), "b_x", COLOURS["x"], (0, -13))
    p.path([radius(now * n / 20, 0.45) for n in range(21)], FREE, 2.6, end="free")
    p.text(radius(now / 2, 0.53), "q", FREE)
    p.arc(o, I3, "z", 0.17, -0.9, 2.8, 0.45)
    p.text(plus(o, (-0.25, 0, 0.45)), "speed > 0", FREE, (-4, 0), "end")
    p.write(folder / "limit_motor.svg")


if __name__ == "__main__":
    here = Path(__file__).resolve().parent.parent
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else here / "docs/reference/figures")
