# SPDX-License-Identifier: MIT
"""What elements of a profile have in common, as far as measurement tells: candidates in order.

A relation is plausible if its residuals are within three standard deviations, by the same equations
that impose it, or within nine if the file states it; and small in itself: strokes that are known
badly agree with everything.
"""

import itertools
import math

import numpy as np

from .equations import Constraint
from .profile import BEGIN, CENTRE, CURVE, END, ORIGIN, origin_of

DETECTED, STATED = 3.0, 9.0  # standard deviations
MOST_ANGLE = math.radians(2)  # between directions, if not stated
MOST_SHARE = 0.02  # of two lengths or radii by which they differ, if not stated
MOST_GAP = 10.0  # between points that shall be level or one, least sigmas, if not stated
NOMINAL = math.radians(15)  # angles that are multiples of it are meant so


class Relations:
    """Finds candidates for one profile. `regularities`: of the sketch, (kind, strokes) each."""

    def __init__(self, equations, regularities):
        self.equations = equations
        self.profile = equations.profile
        self.x = self.profile.unknowns()
        self.sigmas = self.profile.sigmas()
        self._stated = {}
        for kind, strokes in regularities:
            self._stated.setdefault(kind, []).append(strokes)

    def candidates(self):
        """Constraints, most important first; many follow from earlier ones."""
        found = self._topology() + self._directions() + self._radii() + self._lengths()
        return found + self._centres() + self._middles()

    def is_plausible(self, c):
        """Whether what was measured agrees with a constraint."""
        r, j = self.equations.rows(c, self.x)
        sigma = np.sqrt(((j * self.sigmas) ** 2).sum(axis=1))
        within = np.all(np.abs(r) <= (STATED if c.stated else DETECTED) * sigma)
        return bool(within and (c.stated or self._is_small(c, r)))

    def _is_small(self, c, r):
        e, lines = self.equations, [ref[0] for ref in c.refs if ref[1] == CURVE]
        if c.kind in ("horizontal", "vertical", "parallel", "perpendicular", "angle") and lines:
            length = min(math.hypot(*e.direction(i, self.x)) for i in lines)
            return abs(r[0]) <= math.sin(MOST_ANGLE) * length
        if c.kind == "tangent":
            length = min(e.length(ref[0], self.x) for ref in c.refs) / 4
            return abs(r[0]) <= math.sin(2 * MOST_ANGLE) * length
        if c.kind == "equal":
            i = c.refs[0][0]
            line = self.profile.elements[i].kind == "line"
            size = e.length(i, self.x) if line else e.scalar(i, 0, self.x)
            return abs(r[0]) <= MOST_SHARE * size
        # Points: those of short arcs are known badly.
        return bool(np.abs(r).max() <= MOST_GAP * self.profile.least_sigma)

    def _is_stated(self, kind, *elements):
        strokes = {self.profile.elements[i].stroke for i in elements}
        return any(strokes <= s for s in self._stated.get(kind, []))

    def _elements(self, *kinds):
        return [i for i, e in enumerate(self.profile.elements) if e.kind in kinds]

    def _plausible(self, found):
        """The plausible ones, those that the file states first."""
        return sorted((c for c in found if self.is_plausible(c)), key=lambda c: not c.stated)

    def _topology(self):
        """The origin, and tangents where two elements meet."""
        found = []
        if self.profile.point_of(origin_of(self.profile)) not in self.profile.fixed:
            found.append(Constraint("coincident", (origin_of(self.profile), ORIGIN)))
        ends = {}
        for i in self._elements("line", "arc", "elliptic_arc"):
            for position in (BEGIN, END):
                ends.setdefault(self.profile.point_of((i, position)), []).append((i, position))
        for refs in ends.values():
            if len(refs) == 2 and {self.profile.elements[r[0]].kind for r in refs} != {"line"}:
                stated = self._is_stated("tangent", refs[0][0], refs[1][0])
                found.append(Constraint("tangent", tuple(refs), stated=stated))
        return [c for c in found if c.kind == "coincident" or self.is_plausible(c)]

    def _directions(self):
        lines, found = self._elements("line"), []
        for i in lines:
            flat = abs(self.equations.chord(i, self.x)).argmax() == 0
            found.append(Constraint("horizontal" if flat else "vertical", ((i, CURVE),)))
        axes = self._plausible(found)
        along_axes = {c.refs[0][0] for c in axes}
        oblique = [i for i in lines if i not in along_axes]
        pairs = []
        for i, k in itertools.combinations(oblique, 2):
            for kind in ("parallel", "perpendicular"):
                stated = self._is_stated(kind, i, k) and (
                    kind == "parallel" or not self._is_stated("parallel", i, k)
                )
                c = Constraint(kind, ((i, CURVE), (k, CURVE)), stated=stated)
                if abs(self.equations.residual(c, self.x)[0]) < self._least_length(i, k) / 2:
                    pairs.append(c)
        turned = oblique + self._elements("ellipse", "elliptic_arc")
        angles = [self._nominal_angle(i) for i in turned]
        return axes + self._plausible(pairs) + self._plausible(angles)

    def _least_length(self, *lines):
        return min(self.equations.length(i, self.x) for i in lines)

    def _nominal_angle(self, i):
        d = self.equations.direction(i, self.x)
        return Constraint("angle", ((i, CURVE),), round(math.atan2(d[1], d[0]) / NOMINAL) * NOMINAL)

    def _radii(self):
        found = []
        for i, k in itertools.combinations(self._elements("arc", "circle"), 2):
            stated = self._is_stated("equal_radius", i, k)
            found.append(Constraint("equal", ((i, CURVE), (k, CURVE)), stated=stated))
        return self._plausible(found)

    def _lengths(self):
        found = [
            Constraint("equal", ((i, CURVE), (k, CURVE)))
            for i, k in itertools.combinations(self._elements("line"), 2)
        ]
        return self._plausible(found)

    def _centres(self):
        """Concentric, and centres level with one another or with the origin."""
        round_ones = self._elements("circle", "arc", "ellipse", "elliptic_arc")
        refs = [(i, CENTRE) for i in round_ones]
        concentric = [
            Constraint("coincident", (a, b), stated=self._is_stated("coaxial", a[0], b[0]))
            for a, b in itertools.combinations(refs, 2)
        ]
        level = [
            Constraint(kind, pair)
            for pair in itertools.combinations([ORIGIN] + refs, 2)
            for kind in ("horizontal", "vertical")
        ]
        at_origin = [Constraint("coincident", (a, ORIGIN)) for a in refs]
        return self._plausible(at_origin) + self._plausible(concentric) + self._plausible(level)

    def _middles(self):
        """A centre half-way between opposite corners of a rectangular outer loop."""
        outer = list(range(self.profile.num_outer))
        if len(outer) != 4 or any(self.profile.elements[i].kind != "line" for i in outer):
            return []
        first = {self.profile.point_of((outer[0], p)) for p in (BEGIN, END)}
        across = {self.profile.point_of((outer[2], p)): (outer[2], p) for p in (BEGIN, END)}
        side = {self.profile.point_of((outer[1], p)) for p in (BEGIN, END)}
        corner = next(
            (outer[0], p) for p in (BEGIN, END) if self.profile.point_of((outer[0], p)) not in side
        )
        opposite = [ref for point, ref in across.items() if point in side - first]
        centres = [(i, CENTRE) for i in self._elements("circle", "ellipse")]
        found = [Constraint("symmetric", (corner, o, c)) for o in opposite for c in centres]
        return self._plausible(found)
