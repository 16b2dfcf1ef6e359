# SPDX-License-Identifier: MIT
"""Strokes as exact curves of FreeCAD's Part workbench."""

import Part
from FreeCAD import Vector

from .curves import circle_of_arc, cubics, elliptic_arc, principal_axes


def vector(p):
    """A FreeCAD vector of two or three coordinates."""
    return Vector(float(p[0]), float(p[1]), float(p[2]) if len(p) > 2 else 0.0)


def ellipse(centre, major, minor):
    """Part.Ellipse that runs from the major towards the minor semi-axis (vectors)."""
    return Part.Ellipse(vector(centre + major), vector(centre + minor), vector(centre))


def spline(controls):
    """One Part.BSplineCurve of cubics that go on from one another; n x 2 or n x 3 points."""
    pieces = len(cubics(controls))
    curve = Part.BSplineCurve()
    curve.buildFromPolesMultsKnots(
        [vector(p) for p in controls],
        [4] + [3] * (pieces - 1) + [4],
        [float(k) for k in range(pieces + 1)],
        False,
        3,
    )
    return curve


def edge(sketch, index):
    """The Part edge of a stroke, in millimetres."""
    kind, c = sketch.strokes[index].kind, sketch.controls(index)
    if kind == "circle":
        radius = float((c[1] @ c[1]) ** 0.5)
        return Part.Circle(vector(c[0]), vector(c[1]), radius).toShape()
    if kind == "ellipse":
        major, minor, _ = principal_axes(c[1], c[2])
        return ellipse(c[0], major, minor).toShape()
    if kind == "bezier":
        return spline(c).toShape()
    if kind == "arc" and circle_of_arc(*c) is not None:
        return Part.Arc(*(vector(p) for p in c)).toShape()
    if kind == "elliptic_arc":
        e = elliptic_arc(*c)
        if e is not None:
            major, minor, shift = principal_axes(e.p, e.q)
            ends = -e.half_angle - shift, e.half_angle - shift
            return Part.ArcOfEllipse(ellipse(e.centre, major, minor), *ends).toShape()
    return Part.LineSegment(vector(c[0]), vector(c[-1])).toShape()
