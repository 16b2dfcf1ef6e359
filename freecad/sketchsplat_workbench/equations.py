# SPDX-License-Identifier: MIT
"""Constraints as equations of a profile's unknowns, and their least-squares adjustment.

Residuals are lengths in millimetres. Kinds, their references and values:

  inner           (element,)        what holds an arc together: its ends lie on it; no constraint
  held            (element,)        ends of a spline stay where they are
  coincident      point, point      also of centres
  horizontal      line; or two points that shall be level; vertical likewise
  parallel, perpendicular           two lines
  equal           two lines (length), or two arcs or circles (radius)
  tangent         two ends of elements in one point
  symmetric       point, point, middle
  radius, major, minor              one element, value [mm] (semi-axes)
  distance        line, value [mm]; distance_x, distance_y: from point to point, value [mm]
  angle           line, or major axis of an ellipse, against x; value [rad]
"""

import math
from dataclasses import dataclass

import numpy as np

from .profile import BEGIN, CENTRE, CURVE, END, ORIGIN

STEP = 1e-6  # of numeric derivatives, as a fraction of the profile's size
CONVERGED = 1e-10  # residuals, as a fraction of it
MOST_STEPS = 25


@dataclass(frozen=True)
class Constraint:
    """`refs`: (element, position) each; `stated`: the file says so."""

    kind: str
    refs: tuple
    value: float = None
    stated: bool = False


class Equations:
    """Residuals and derivatives of constraints on one profile."""

    def __init__(self, profile):
        self.profile = profile
        points = profile.unknowns()[: 2 * profile.num_points]
        self.size = max(float(np.ptp(points)) if len(points) else 0.0, 1e-300)
        scalars = profile.unknowns()[2 * profile.num_points :]
        self.size = max([self.size] + [abs(s) for s in scalars])

    def residual(self, constraint, x):
        """Array of the constraint's residuals at the unknowns x."""
        return np.atleast_1d(getattr(self, "_" + constraint.kind)(constraint, x))

    def rows(self, constraint, x):
        """(residual, Jacobian) by central differences."""
        slots = sorted({s for ref in constraint.refs for s in self._slots(ref)})
        residual = self.residual(constraint, x)
        jacobian = np.zeros((len(residual), len(x)))
        step = STEP * self.size
        y = x.copy()
        for s in slots:
            y[s] = x[s] + step
            ahead = self.residual(constraint, y)
            y[s] = x[s] - step
            jacobian[:, s] = (ahead - self.residual(constraint, y)) / (2 * step)
            y[s] = x[s]
        return residual, jacobian

    def _slots(self, ref):
        if ref == ORIGIN:
            return []
        if ref[1] == CURVE:
            return self.profile.slots(ref[0])
        if len(self.profile.elements[ref[0]].scalars) and ref[1] != CENTRE:
            return self.profile.slots(ref[0])  # tangents depend on the centre, too
        e = self.profile.elements[ref[0]]
        if e.kind == "line":
            return self.profile.slots(ref[0])
        p = self.profile.point_of(ref)
        return [2 * p, 2 * p + 1]

    # What elements are at x.

    def point(self, ref, x):
        if ref == ORIGIN:
            return np.zeros(2)
        p = self.profile.point_of(ref)
        return x[2 * p : 2 * p + 2]

    def scalar(self, element, k, x):
        return x[2 * self.profile.num_points + self.profile.elements[element].scalars[k]]

    def chord(self, element, x):
        return self.point((element, END), x) - self.point((element, BEGIN), x)

    def length(self, element, x):
        return math.hypot(*self.chord(element, x))

    def major(self, element, x):
        return np.array([self.scalar(element, 0, x), self.scalar(element, 1, x)])

    def direction(self, element, x):
        """Of a line, or of the major axis of an ellipse; not of unit length."""
        if self.profile.elements[element].kind == "line":
            return self.chord(element, x)
        return self.major(element, x)

    def normal(self, ref, x):
        """Unit normal of an element at one of its ends."""
        element, kind = ref[0], self.profile.elements[ref[0]].kind
        if kind == "line":
            d = self.chord(element, x)
            n = np.array([-d[1], d[0]])
        else:
            n = self.point(ref, x) - self.point((element, CENTRE), x)
            if kind == "elliptic_arc":
                a = self.major(element, x)
                a2, b2 = a.dot(a), self.scalar(element, 2, x) ** 2
                along = a * (n.dot(a) / a2)
                n = along / a2 + (n - along) / b2
        return n / max(math.hypot(*n), 1e-300)

    # Kinds.

    def _inner(self, c, x):
        element = c.refs[0][0]
        centre = self.point((element, CENTRE), x)
        out = []
        for position in (BEGIN, END):
            d = self.point((element, position), x) - centre
            if self.profile.elements[element].kind == "arc":
                out.append(math.hypot(*d) - self.scalar(element, 0, x))
            else:
                a, b = self.major(element, x), self.scalar(element, 2, x)
                length = math.hypot(*a)
                u, v = d.dot(a) / length**2, (a[0] * d[1] - a[1] * d[0]) / length / b
                out.append((math.hypot(u, v) - 1) * min(length, b))
        return np.array(out)

    def _held(self, c, x):
        e = self.profile.elements[c.refs[0][0]]
        ends = [(e.begin, 0)] if e.begin == e.end else [(e.begin, 0), (e.end, -1)]
        return np.concatenate([x[2 * p : 2 * p + 2] - e.poles[k] for p, k in ends])

    def _coincident(self, c, x):
        return self.point(c.refs[0], x) - self.point(c.refs[1], x)

    def _difference(self, c, x):
        if len(c.refs) == 1:
            return self.chord(c.refs[0][0], x)
        return self.point(c.refs[1], x) - self.point(c.refs[0], x)

    def _horizontal(self, c, x):
        return self._difference(c, x)[1]

    def _vertical(self, c, x):
        return self._difference(c, x)[0]

    def _pair(self, c, x):
        """Unit directions of two lines, and the length that turns their angle into millimetres."""
        a, b = (self.chord(ref[0], x) for ref in c.refs)
        la, lb = max(math.hypot(*a), 1e-300), max(math.hypot(*b), 1e-300)
        return a / la, b / lb, min(la, lb)

    def _parallel(self, c, x):
        a, b, length = self._pair(c, x)
        return (a[0] * b[1] - a[1] * b[0]) * length

    def _perpendicular(self, c, x):
        a, b, length = self._pair(c, x)
        return a.dot(b) * length

    def _equal(self, c, x):
        i, k = c.refs[0][0], c.refs[1][0]
        if self.profile.elements[i].kind == "line":
            return self.length(i, x) - self.length(k, x)
        return self.scalar(i, 0, x) - self.scalar(k, 0, x)

    def _tangent(self, c, x):
        a, b = (self.normal(ref, x) for ref in c.refs)
        # Tangents of short strokes turn about four times as far as chords of their length.
        length = min(self.length(ref[0], x) for ref in c.refs) / 4
        return (a[0] * b[1] - a[1] * b[0]) * length

    def _symmetric(self, c, x):
        return (self.point(c.refs[0], x) + self.point(c.refs[1], x)) / 2 - self.point(c.refs[2], x)

    def _radius(self, c, x):
        return self.scalar(c.refs[0][0], 0, x) - c.value

    def _major(self, c, x):
        return math.hypot(*self.major(c.refs[0][0], x)) - c.value

    def _minor(self, c, x):
        return self.scalar(c.refs[0][0], 2, x) - c.value

    def _distance(self, c, x):
        return self.length(c.refs[0][0], x) - c.value

    def _distance_x(self, c, x):
        return self._difference(c, x)[0] - c.value

    def _distance_y(self, c, x):
        return self._difference(c, x)[1] - c.value

    def _angle(self, c, x):
        d = self.direction(c.refs[0][0], x)
        return d[1] * math.cos(c.value) - d[0] * math.sin(c.value)


def adjusted(equations, constraints, start, measured, sigmas):
    """The unknowns nearest to the measured ones, in standard deviations, that obey constraints.

    Gauss-Newton steps from `start`. None if they do not get there.
    """
    x = start.copy()
    limit = CONVERGED * equations.size
    for _ in range(MOST_STEPS):
        rows = [equations.rows(c, x) for c in constraints]
        r = np.concatenate([row[0] for row in rows])
        j = np.vstack([row[1] for row in rows]) * sigmas
        back = (measured - x) / sigmas
        step = back - np.linalg.lstsq(j, r + j @ back, rcond=1e-9)[0]
        x = x + step * sigmas
        if not np.isfinite(x).all():
            return None
        worst = max(np.abs(equations.residual(c, x)).max() for c in constraints)
        if worst <= limit and np.abs(step * sigmas).max() <= 1e3 * limit:
            return x
    return None
