# SPDX-License-Identifier: MIT
"""Planes that hold strokes which meet, as topology/planar_faces.cc finds them."""

from dataclasses import dataclass

import numpy as np

from .curves import polyline

TOLERANCE = 1e-3  # distance of a stroke from its plane, as a fraction of the extent
LEAST_WIDTH = 10  # tolerances: across less, a first plane has no known normal


@dataclass
class Plane:
    """A point and a right-handed orthonormal frame."""

    origin: np.ndarray
    x: np.ndarray
    y: np.ndarray
    normal: np.ndarray

    def flat(self, points):
        """n x 2 coordinates of n x 3 points."""
        return (points - self.origin) @ np.column_stack([self.x, self.y])

    def height(self, points):
        """Signed distances of n x 3 points."""
        return (points - self.origin) @ self.normal


def _moments(points, centre):
    """Weight, sum and sum of squares of the points of a polyline, by length."""
    p = points - centre
    length = np.linalg.norm(np.diff(p, axis=0), axis=1)
    weight = np.zeros(len(p))
    weight[:-1] += length / 2
    weight[1:] += length / 2
    return weight.sum(), weight @ p, (p * weight[:, None]).T @ p


class PlaneFinder:
    """Planes grow from strokes that meet, and from bent strokes, over their neighbours.

    `tolerance`: largest distance of a stroke from its plane, millimetres.
    """

    def __init__(self, sketch, tolerance):
        self.sketch = sketch
        self.tolerance = tolerance
        count = len(sketch.strokes)
        self.polylines = [polyline(sketch, i) for i in range(count)]
        self._centre = self.polylines[0][0] if count else np.zeros(3)
        self._moments = [_moments(p, self._centre) for p in self.polylines]
        at = {}
        for i, s in enumerate(sketch.strokes):
            for node in () if s.closed else (s.begin, s.end):
                at.setdefault(node, set()).add(i)
        self._neighbours = [set() for _ in range(count)]
        for strokes in at.values():
            for i in strokes:
                self._neighbours[i] |= strokes - {i}

    def find(self):
        """List of (Plane, ascending list of strokes in it); no set of strokes twice."""
        planes, seen, covered = [], set(), set()
        for seed in self._seeds():
            if (seed[0], seed[-1]) in covered:
                continue
            grown = self._grow(seed)
            if grown is None:
                continue
            members = grown[1]
            covered.update((a, b) for a in members for b in members)
            if tuple(members) not in seen:
                seen.add(tuple(members))
                planes.append(grown)
        return planes

    def _seeds(self):
        for a, s in enumerate(self.sketch.strokes):
            if s.kind != "line":
                yield [a]
            for b in sorted(self._neighbours[a]):
                if a < b:
                    yield [a, b]

    def _fit(self, members):
        weight = sum(self._moments[i][0] for i in members)
        if not weight > 0:
            return None
        mean = sum(self._moments[i][1] for i in members) / weight
        square = sum(self._moments[i][2] for i in members) / weight - np.outer(mean, mean)
        vectors = np.linalg.eigh(square)[1]
        normal, x = vectors[:, 0], vectors[:, 2]
        plane = Plane(self._centre + mean, x, np.cross(normal, x), normal)
        return plane if all(self._holds(plane, i) for i in members) else None

    def _holds(self, plane, stroke):
        return np.abs(plane.height(self.polylines[stroke])).max() <= self.tolerance

    def _grow(self, seed):
        members = list(seed)
        plane = self._fit(members)
        if plane is None:
            return None
        across = np.concatenate([(self.polylines[i] - plane.origin) @ plane.y for i in members])
        if np.ptp(across) < LEAST_WIDTH * self.tolerance:
            return None
        tried = set(members)
        for member in members:  # grows meanwhile
            for following in sorted(self._neighbours[member] - tried):
                tried.add(following)
                wider = self._fit(members + [following])
                if wider is not None:
                    plane = wider
                    members.append(following)
        count = len(self.sketch.strokes)
        return plane, [i for i in range(count) if self._holds(plane, i)]
