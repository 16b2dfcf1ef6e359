# SPDX-License-Identifier: MIT
"""Chooses constraints of a profile that depend on none of the others and agree with measurement."""

import math
from dataclasses import dataclass, field

import numpy as np

from .equations import CONVERGED, Constraint, Equations, adjusted
from .profile import BEGIN, CENTRE, CURVE, END, ORIGIN
from .relations import Relations

INDEPENDENT = 1e-4  # least share of a normalized row that others do not span
MOST_MOVE = 5.0  # standard deviations that relations may move what was measured
DIMENSIONS = ("radius", "major", "minor", "distance", "distance_x", "distance_y", "angle")


@dataclass
class Constrained:
    """A profile, unknowns that obey all constraints exactly, and what was left out."""

    profile: object
    unknowns: np.ndarray
    constraints: list = field(default_factory=list)
    contradicted: list = field(default_factory=list)  # plausible alone, but not with the others
    freedom: int = 0  # degrees of freedom that are left
    largest_move: float = 0.0  # of what was measured, millimetres

    @property
    def relations(self):
        return [c for c in self.constraints if c.kind not in DIMENSIONS]

    @property
    def dimensions(self):
        return [c for c in self.constraints if c.kind in DIMENSIONS]


class System:
    """Grows by constraints that are independent and can be met near to what was measured."""

    def __init__(self, profile):
        self.equations = Equations(profile)
        self.measured = profile.unknowns()
        self.sigmas = profile.sigmas()
        self.x = self.measured.copy()
        self.accepted = []
        self._span = np.zeros((0, len(self.x)))  # orthonormal rows
        for i, e in enumerate(profile.elements):
            kind = {"arc": "inner", "elliptic_arc": "inner", "spline": "held"}.get(e.kind)
            if kind:
                self._take(Constraint(kind, ((i, CURVE),)))

    @property
    def rank(self):
        return len(self._span)

    def is_independent(self, constraint):
        """Whether each of its equations says something new."""
        j = self._scaled_rows(constraint, self.x)
        rest = j - (j @ self._span.T) @ self._span
        return bool(np.linalg.svd(rest, compute_uv=False).min() > INDEPENDENT)

    def offer(self, constraint):
        """"taken", "follows" from the others, or "contradicted" by them or by measurement."""
        if not self.is_independent(constraint):
            return "follows"
        worst = np.abs(self.equations.residual(constraint, self.x)).max()
        if worst <= CONVERGED * self.equations.size:
            self._take(constraint)
            return "taken"
        wanted = self.accepted + [constraint]
        x = adjusted(self.equations, wanted, self.x, self.measured, self.sigmas)
        if x is None or np.abs((x - self.measured) / self.sigmas).max() > MOST_MOVE:
            return "contradicted"
        rows = np.vstack([self._scaled_rows(c, x) for c in wanted])
        span = _orthonormal(rows)
        if len(span) < len(rows):  # met in a singular position only
            return "contradicted"
        self.x, self.accepted, self._span = x, wanted, span
        return "taken"

    def _take(self, constraint):
        self.accepted.append(constraint)
        j = self._scaled_rows(constraint, self.x)
        rest = j - (j @ self._span.T) @ self._span
        self._span = np.vstack([self._span, _orthonormal(rest)])

    def _scaled_rows(self, constraint, x):
        j = self.equations.rows(constraint, x)[1] * self.sigmas
        return j / np.maximum(np.linalg.norm(j, axis=1, keepdims=True), 1e-300)


def _orthonormal(rows):
    """Orthonormal rows that span what these do."""
    _, values, v = np.linalg.svd(rows, full_matrices=False)
    return v[values > INDEPENDENT / 10]


def constrain(profile, regularities=()):
    """Relations first, then dimensions with measured values until nothing can move.

    `regularities`: of the sketch, (kind, frozenset of strokes) each.
    """
    system = System(profile)
    inner = len(system.accepted)
    contradicted = []
    for c in Relations(system.equations, regularities).candidates():
        if system.offer(c) == "contradicted":
            contradicted.append(c)
    for kind, refs in _dimensions(system):
        c = _measured(system, kind, refs)
        if c is not None:
            system.offer(c)
    return Constrained(
        profile,
        system.x,
        system.accepted[inner:],
        contradicted,
        len(system.x) - system.rank,
        _largest_move(system),
    )


def _largest_move(system):
    """Of ends and of centres of closed curves, millimetres; those of arcs are known less well."""
    profile = system.equations.profile
    moved = (system.x - system.measured)[: 2 * profile.num_points].reshape(-1, 2)
    seen = {p for e in profile.elements for p in (e.begin, e.end)}
    seen |= {e.centre for e in profile.elements if e.begin < 0}
    return max((float(np.linalg.norm(moved[p])) for p in seen if p >= 0), default=0.0)


def _dimensions(system):
    """(kind, references) of what people measure, in the order in which they look for it."""
    elements = system.equations.profile.elements

    def refs_of(kinds):
        return [(i, CURVE) for i, e in enumerate(elements) if e.kind in kinds]

    for ref in refs_of(("circle", "arc")):
        yield "radius", (ref,)
    for ref in refs_of(("ellipse", "elliptic_arc")):
        yield "major", (ref,)
        yield "minor", (ref,)
    lines = refs_of(("line",))
    for ref in sorted(lines, key=lambda r: -system.equations.length(r[0], system.x)):
        yield "distance", (ref,)
    for ref in lines + refs_of(("ellipse", "elliptic_arc")):
        yield "angle", (ref,)
    centres = [(i, CENTRE) for i, e in enumerate(elements) if e.centre >= 0]
    corners = [(i, p) for i, e in enumerate(elements) if e.begin >= 0 for p in (BEGIN, END)]
    for ref in centres + corners:
        yield "distance_x", (ORIGIN, ref)
        yield "distance_y", (ORIGIN, ref)


def _measured(system, kind, refs):
    """The dimension with the value that it has now; None if that is no dimension.

    Lines along an axis are measured along it, and distances are positive.
    """
    e, x = system.equations, system.x
    if kind == "angle":
        d = e.direction(refs[0][0], x)
        return Constraint(kind, refs, math.atan2(d[1], d[0]))
    if kind == "distance":
        i = refs[0][0]
        flat = [abs(d) <= 1e-9 * e.length(i, x) for d in e.chord(i, x)]
        if any(flat):
            kind, refs = "distance_y" if flat[0] else "distance_x", ((i, BEGIN), (i, END))
    value = float(e.residual(Constraint(kind, refs, 0.0), x)[0])
    if value < 0:
        refs, value = refs[::-1], -value
    if value <= 1e-7 * e.size:
        return None
    return Constraint(kind, refs, value)
