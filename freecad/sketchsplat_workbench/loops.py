# SPDX-License-Identifier: MIT
"""Minimal cycles of strokes in one plane, as topology/planar_loops.cc walks them."""

import math
from dataclasses import dataclass

import numpy as np

REACH = 0.1  # of the shortest stroke at a node: how far along directions are compared


@dataclass
class Cycle:
    """A simple closed walk: `loop` of (stroke, forward) and the closed polygon of its points."""

    loop: list
    polygon: np.ndarray  # n x 2
    area: float  # positive if counter-clockwise
    part: int  # connected part of the graph
    walk: int  # walk of the graph that it was cut from


def signed_area(polygon):
    p = polygon - polygon[0]
    q = np.roll(p, -1, axis=0)
    return float(np.sum(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2)


def perimeter(polygon):
    return float(np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1).sum())


def is_inside(point, polygon):
    """By crossings of a ray to the right."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    spans = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    a, b = a[spans], b[spans]
    x = a[:, 0] + (point[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return int(np.sum(point[0] < x)) % 2 == 1


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def polygons_cross(p, q):
    """Whether a side of one crosses a side of the other between their ends."""
    a, b = p[:, None], np.roll(p, -1, axis=0)[:, None]
    c, d = q[None], np.roll(q, -1, axis=0)[None]
    first = _cross(b - a, c - a) * _cross(b - a, d - a)
    second = _cross(d - c, a - c) * _cross(d - c, b - c)
    return bool(((first < 0) & (second < 0)).any())


class Graph:
    """Strokes of a plane, walked both ways: half-edge 2 m is member m forward, 2 m + 1 backward.

    `lines`: n x 2 points along each member, from begin to end.
    """

    def __init__(self, sketch, members, lines):
        self.members = members
        self.lines = lines
        self._strokes = [sketch.strokes[m] for m in members]
        self._alive = [True] * len(members)

    def cycles(self):
        """Simple cycles of the graph without its bridges."""
        while True:
            self._drop_dangling()
            walks = self._walks()
            if not self._drop_bridges(walks):
                break
        parts = self._parts()
        out = []
        for w, walk in enumerate(walks):
            for simple in self._cut_at_repeated_nodes(walk):
                polygon = np.vstack([self._points(h)[:-1] for h in simple])
                loop = [(self.members[h // 2], h % 2 == 0) for h in simple]
                area = signed_area(polygon)
                out.append(Cycle(loop, polygon, area, parts[simple[0] // 2], w))
        return out

    def _tail(self, h):
        s = self._strokes[h // 2]
        return s.begin if h % 2 == 0 else s.end

    def _points(self, h):
        line = self.lines[h // 2]
        return line if h % 2 == 0 else line[::-1]

    def _open_half_edges(self):
        for h in range(2 * len(self.members)):
            if self._alive[h // 2] and not self._strokes[h // 2].closed:
                yield h

    def _drop_dangling(self):
        while True:
            degree = {}
            for h in self._open_half_edges():
                degree[self._tail(h)] = degree.get(self._tail(h), 0) + 1
            loose = {h // 2 for h in self._open_half_edges() if degree[self._tail(h)] < 2}
            if not loose:
                return
            for m in loose:
                self._alive[m] = False

    def _drop_bridges(self, walks):
        """A stroke whose two sides belong to one walk separates nothing."""
        walk_of = {h: w for w, walk in enumerate(walks) for h in walk}
        bridges = [
            m
            for m in range(len(self.members))
            if self._alive[m] and walk_of.get(2 * m) == walk_of.get(2 * m + 1)
        ]
        for m in bridges:
            self._alive[m] = False
        return bool(bridges)

    def _direction(self, h, reach):
        """Angle to the point so far along: equal tangents are told apart by their curvature."""
        points = self._points(h)
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        x, y = (np.interp(reach, along, points[:, k]) - points[0, k] for k in (0, 1))
        return math.atan2(y, x)

    def _walks(self):
        """Walks that keep their inside on the left: at each node on to the next one clockwise."""
        out_of = {}
        for h in self._open_half_edges():
            out_of.setdefault(self._tail(h), []).append(h)
        following = {}
        for half_edges in out_of.values():
            lengths = [
                np.linalg.norm(np.diff(self._points(h), axis=0), axis=1).sum() for h in half_edges
            ]
            reach = REACH * min(lengths)
            around = sorted((self._direction(h, reach), h) for h in half_edges)
            for i, (_, h) in enumerate(around):
                following[h ^ 1] = around[i - 1][1]
        walks, done = [], set()
        for first in range(2 * len(self.members)):
            if not self._alive[first // 2] or first in done:
                continue
            walk, h = [], first
            while h not in done:
                done.add(h)
                walk.append(h)
                h = following.get(h, h)
            walks.append(walk)
        return walks

    def _cut_at_repeated_nodes(self, walk):
        if self._strokes[walk[0] // 2].closed:
            return [walk]
        out, way = [], []
        for h in walk:
            way.append(h)
            head = self._tail(h ^ 1)
            start = next((i for i, other in enumerate(way) if self._tail(other) == head), None)
            if start is not None:
                out.append(way[start:])
                del way[start:]
        return out

    def _parts(self):
        """Number of the connected part of each member."""
        part, changed = list(range(len(self.members))), True
        of_node = {}
        while changed:  # labels sink to the smallest of their part
            changed = False
            for h in self._open_half_edges():
                low = min(part[h // 2], of_node.get(self._tail(h), part[h // 2]))
                changed |= low != part[h // 2] or of_node.get(self._tail(h)) != low
                part[h // 2] = of_node[self._tail(h)] = low
        return part
