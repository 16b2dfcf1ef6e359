# SPDX-License-Identifier: MIT
"""Sketches made by hand, as the content of sketch.json."""

import json
import math

import numpy as np

TURN = np.array([[2, -2, 1], [1, 2, 2], [-2, -1, 2]]).T / 3.0  # a rotation that favours no axis


class Drawing:
    """Strokes over nodes that are turned and moved into space; noise has a fixed seed."""

    def __init__(self, rotation=TURN, offset=(3.0, -7.0, 11.0), noise=0.0):
        self.rotation, self.offset, self.noise = rotation, np.array(offset), noise
        self.random = np.random.default_rng(7)
        self.nodes, self.strokes = [], []

    def place(self, p):
        p = np.append(np.asarray(p, dtype=float), 0.0)[:3]
        noise = self.noise * self.random.standard_normal(3)
        return (self.rotation @ p + self.offset + noise).tolist()

    def node(self, *p):
        self.nodes.append(self.place(p))
        return len(self.nodes) - 1

    def add(self, kind, nodes, handles):
        sigma = max(self.noise, 1e-4)
        self.strokes.append(
            {"kind": kind, "nodes": nodes, "handles": handles, "sigma": sigma,
             "confidence": 0.9, "support_views": 12, "rms_px": 0.2}
        )
        return len(self.strokes) - 1

    def line(self, a, b):
        return self.add("line", [a, b], [])

    def polygon(self, points):
        nodes = [self.node(*p) for p in points]
        return [self.line(a, b) for a, b in zip(nodes, nodes[1:] + nodes[:1])]

    def arc(self, a, apex, b):
        return self.add("arc", [a, b], [self.place(apex)])

    def circle(self, centre, radius):
        axis = self.rotation @ np.array([0.0, 0.0, radius])
        return self.add("circle", [], [self.place(centre), axis.tolist()])

    def ellipse(self, centre, u, v):
        u, v = (self.rotation @ np.append(w, 0.0) for w in (u, v))
        return self.add("ellipse", [], [self.place(centre), u.tolist(), v.tolist()])

    def bezier(self, a, handles, b):
        return self.add("bezier", [a, b], [self.place(h) for h in handles])

    def content(self, **more):
        return {"format_version": 1, **more, "nodes": self.nodes, "strokes": self.strokes}

    def write(self, path, **more):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.content(**more), file)
        return str(path)


def plate(noise=0.0):
    """A plate of 80 x 50 x 10 with a hole of radius 8 at (30, 25) through it."""
    d = Drawing(noise=noise)
    corners = [(0, 0), (80, 0), (80, 50), (0, 50)]
    low, high = ([d.node(x, y, z) for x, y in corners] for z in (0, 10))
    for ring in (low, high):
        for k in range(4):
            d.line(ring[k], ring[(k + 1) % 4])
    for a, b in zip(low, high):
        d.line(a, b)
    for z in (0, 10):
        d.circle((30, 25, z), 8)
    return d


def slot(d, x, y, length, radius):
    """Two lines and two arcs that touch them; the middles of the arcs are so far apart."""
    n = [d.node(x + dx, y + dy) for dx in (0, length) for dy in (-radius, radius)]
    d.line(n[0], n[2])
    d.arc(n[2], (x + length + radius, y), n[3])
    d.line(n[3], n[1])
    d.arc(n[1], (x - radius, y), n[0])


def slotted_sheet(noise=0.0):
    """A rectangle of 60 x 40 with a slot of radius 5, 20 long, at (20, 15)."""
    d = Drawing(noise=noise)
    d.polygon([(0, 0), (60, 0), (60, 40), (0, 40)])
    slot(d, 20, 15, 20, 5)
    return d


def hexagon(side=20.0):
    d = Drawing()
    turns = [math.radians(60 * k) for k in range(6)]
    d.polygon([(side * math.cos(t), side * math.sin(t)) for t in turns])
    return d


def ellipse_in_wave():
    """Three straight sides and a wave of two cubics, around an ellipse turned by 30 degrees."""
    d = Drawing()
    a, b, c, e = (d.node(*p) for p in ((0, 0), (60, 0), (60, 40), (0, 40)))
    for ends in ((a, b), (b, c), (e, a)):
        d.line(*ends)
    d.bezier(c, [(50, 45), (40, 45), (30, 40), (20, 35), (10, 35)], e)
    t = math.radians(30)
    u, v = np.array([math.cos(t), math.sin(t)]), np.array([-math.sin(t), math.cos(t)])
    d.ellipse((30, 20), 12 * u, 6 * v)
    return d


def quarter_ellipse():
    """A quarter of an ellipse with semi-axes 30 and 20, and its two straight sides."""
    d = Drawing()
    o, a, b = d.node(0, 0), d.node(30, 0), d.node(0, 20)
    d.line(o, a)
    d.line(b, o)
    h = math.pi / 4
    middle = np.array([15.0, 10.0])
    rise = np.array([30 * math.cos(h), 20 * math.sin(h)]) - middle
    g = (3 - math.tan(h / 4) ** 2) / 4
    d.add("elliptic_arc", [a, b], [d.place(middle + rise), d.place(middle + g * rise)])
    return d
