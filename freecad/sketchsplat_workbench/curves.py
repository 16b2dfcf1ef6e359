# SPDX-License-Identifier: MIT
"""Centres, radii and points of strokes. Lengths in millimetres, angles in radians."""

import math
from dataclasses import dataclass

import numpy as np

STRAIGHT = 1e-9  # sagitta of an arc that is a line, as a fraction of half its chord
PIECES = 32  # of the polyline along a bent stroke


@dataclass
class Circle:
    """An arc or a circle; the stroke runs counter-clockwise about `normal` by `angle`."""

    centre: np.ndarray
    normal: np.ndarray  # unit
    radius: float
    angle: float


@dataclass
class EllipticArc:
    """centre + cos(psi) p + sin(psi) q, psi from -half_angle to half_angle."""

    centre: np.ndarray
    p: np.ndarray
    q: np.ndarray
    half_angle: float


def circle_of_arc(begin, apex, end):
    """The circle of an arc; None if it is straight."""
    middle = (begin + end) / 2
    chord = end - begin
    length = float(np.linalg.norm(chord))
    if length == 0:
        return None
    along = chord / length
    rise = apex - middle
    rise = rise - along * along.dot(rise)
    sagitta = float(np.linalg.norm(rise))
    half = length / 2
    if not sagitta > STRAIGHT * half:
        return None
    up = rise / sagitta
    radius = (half**2 + sagitta**2) / (2 * sagitta)
    centre = middle + up * (sagitta - radius)
    return Circle(centre, np.cross(up, along), radius, 4 * math.atan2(sagitta, half))


def elliptic_arc(begin, apex, quarter, end):
    """The ellipse of an elliptic arc, as sketches/curve.h defines it; None if it is straight."""
    middle, half, rise = (begin + end) / 2, (end - begin) / 2, apex - (begin + end) / 2
    rise2 = rise.dot(rise)
    if not rise2 > STRAIGHT**2 * half.dot(half):
        return None
    least, most = 0.005, 0.9  # between these tan^2(a / 4) is 3 - 4 g itself
    tan2 = 3 - 4 * (quarter - middle).dot(rise) / rise2
    if tan2 < least:
        tan2 = least * math.exp(-min((least - tan2) / least, 12))
    elif tan2 > most:
        tan2 = 1 - (1 - most) * math.exp(-min((tan2 - most) / (1 - most), 4))
    a = 4 * math.atan(math.sqrt(tan2))
    p = rise / (2 * math.sin(a / 2) ** 2)
    return EllipticArc(middle - math.cos(a) * p, p, half / math.sin(a), a)


def principal_axes(u, v):
    """(major, minor, shift) of centre + cos t u + sin t v.

    cos(s) u + sin(s) v = cos(s - shift) major + sin(s - shift) minor; |major| >= |minor|.
    """
    shift = 0.5 * math.atan2(2 * u.dot(v), u.dot(u) - v.dot(v))
    c, s = math.cos(shift), math.sin(shift)
    return c * u + s * v, c * v - s * u, shift


def cubics(controls):
    """The 4 x 3 control points of each cubic of a bezier stroke."""
    return [controls[k : k + 4] for k in range(0, len(controls) - 1, 3)]


def _basis(normal):
    """Two unit vectors that complete a unit normal to a right-handed frame."""
    x = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    x /= np.linalg.norm(x)
    return x, np.cross(normal, x)


def polyline(sketch, index):
    """n x 3 points along a stroke from begin to end, both included; of a line its ends."""
    kind, c = sketch.strokes[index].kind, sketch.controls(index)
    t = np.linspace(0, 1, PIECES + 1)[:, None]
    if kind == "circle":
        radius = np.linalg.norm(c[1])
        x, y = _basis(c[1] / radius)
        return c[0] + radius * (np.cos(2 * np.pi * t) * x + np.sin(2 * np.pi * t) * y)
    if kind == "ellipse":
        return c[0] + np.cos(2 * np.pi * t) * c[1] + np.sin(2 * np.pi * t) * c[2]
    if kind == "bezier":
        pieces = [
            (1 - t) ** 3 * b[0] + 3 * t * (1 - t) ** 2 * b[1] + 3 * t * t * (1 - t) * b[2]
            + t**3 * b[3]
            for b in cubics(c)
        ]
        return np.vstack([pieces[0][:1]] + [p[1:] for p in pieces])
    if kind == "arc":
        circle = circle_of_arc(*c)
        if circle is not None:
            x = c[0] - circle.centre
            y = np.cross(circle.normal, x)
            return circle.centre + np.cos(circle.angle * t) * x + np.sin(circle.angle * t) * y
    if kind == "elliptic_arc":
        e = elliptic_arc(*c)
        if e is not None:
            psi = (2 * t - 1) * e.half_angle
            return e.centre + np.cos(psi) * e.p + np.sin(psi) * e.q
    return np.vstack([c[0], c[-1]])
