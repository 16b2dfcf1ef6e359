# SPDX-License-Identifier: MIT
"""A face as plane geometry: elements over shared points, with unknowns and standard deviations."""

import math
from dataclasses import dataclass

import numpy as np

from .curves import circle_of_arc, elliptic_arc, principal_axes
from .planes import Plane

# Standard deviation of a point at the least, as a fraction of the sketch's extent: a third of the
# distance from a plane that is taken for nothing.
LEAST_SIGMA = 3e-4

CURVE, BEGIN, END, CENTRE = 0, 1, 2, 3  # positions on an element, as FreeCAD counts them
ORIGIN = (-1, BEGIN)  # FreeCAD's name of the sketch's origin


@dataclass
class Element:
    """line, arc, circle, ellipse, elliptic_arc or spline; bent ones run counter-clockwise.

    `begin`, `end`, `centre`: indices of points, -1 if there is none; of a closed spline begin is
    end. `scalars`: indices of the radius, or of the x and y of the major semi-axis and the length
    of the minor one. `poles`: n x 2 control points of a spline's cubics.
    """

    kind: str
    stroke: int
    begin: int = -1
    end: int = -1
    centre: int = -1
    scalars: tuple = ()
    poles: np.ndarray = None


class Profile:
    """Elements of one face. Unknowns: all points, x and y each, then all scalars; millimetres."""

    def __init__(self, plane, extent):
        self.plane = plane
        self.least_sigma = LEAST_SIGMA * extent
        self.elements = []
        self.fixed = set()  # points that splines hold
        self.num_outer = 0  # elements of the outer loop come first
        self._points, self._point_sigma = [], []
        self._scalars, self._scalar_sigma = [], []

    def add_point(self, place, sigma):
        self._points.append(np.asarray(place, dtype=float))
        self._point_sigma.append(max(sigma, self.least_sigma))
        return len(self._points) - 1

    def add_scalar(self, value, sigma):
        self._scalars.append(float(value))
        self._scalar_sigma.append(max(sigma, self.least_sigma))
        return len(self._scalars) - 1

    def surer(self, point, sigma):
        """A stroke that ends in it knows the point to sigma."""
        self._point_sigma[point] = max(min(self._point_sigma[point], sigma), self.least_sigma)

    def unknowns(self):
        return np.concatenate([np.ravel(self._points), self._scalars]).astype(float)

    def sigmas(self):
        return np.concatenate([np.repeat(self._point_sigma, 2), self._scalar_sigma])

    @property
    def num_points(self):
        return len(self._points)

    def point_of(self, ref):
        """Index of the point of a reference (element, position)."""
        e = self.elements[ref[0]]
        return {BEGIN: e.begin, END: e.end, CENTRE: e.centre}[ref[1]]

    def slots(self, index):
        """Positions in the unknowns of all that an element depends on."""
        e = self.elements[index]
        points = [p for p in (e.begin, e.end, e.centre) if p >= 0]
        scalars = [2 * self.num_points + s for s in e.scalars]
        return [2 * p + k for p in points for k in (0, 1)] + scalars

    def shift(self, offset):
        """Moves the origin of the plane by these two coordinates."""
        p = self.plane
        self.plane = Plane(p.origin + offset[0] * p.x + offset[1] * p.y, p.x, p.y, p.normal)
        self._points = [q - offset for q in self._points]
        for e in self.elements:
            if e.poles is not None:
                e.poles = e.poles - offset


def build_profile(sketch, face, plane):
    """The profile of a face in a plane, with its origin in a corner or centre of the outer loop."""
    profile = Profile(plane, sketch.extent())
    nodes = {}
    for loop in face.loops():
        for stroke, _ in loop:
            _add_stroke(profile, sketch, stroke, nodes)
        profile.num_outer = profile.num_outer or len(profile.elements)
    origin = origin_of(profile)
    profile.shift(profile.unknowns()[2 * profile.point_of(origin) :][:2].copy())
    return profile


def origin_of(profile):
    """The reference of the point in which the origin shall lie."""
    outer = list(enumerate(profile.elements[: profile.num_outer]))
    if len(outer) == 1 and outer[0][1].centre >= 0:
        return (0, CENTRE)
    x = profile.unknowns()
    corners = [(i, position) for i, _ in outer for position in (BEGIN, END)]
    return min(corners, key=lambda r: x[2 * profile.point_of(r) :][:2].sum())


def _add_stroke(profile, sketch, index, nodes):
    s, plane = sketch.strokes[index], profile.plane
    controls = plane.flat(sketch.controls(index))
    ends = []
    for node in () if s.closed else (s.begin, s.end):
        if node not in nodes:
            nodes[node] = profile.add_point(plane.flat(sketch.nodes[node]), s.sigma)
        profile.surer(nodes[node], s.sigma)
        ends.append(nodes[node])
    add = {
        "circle": _add_circle,
        "ellipse": _add_ellipse,
        "arc": _add_arc,
        "elliptic_arc": _add_elliptic_arc,
        "bezier": _add_spline,
    }.get(s.kind, _add_line)
    element = add(profile, sketch, index, controls, ends)
    element.stroke = index
    profile.elements.append(element)


def _add_line(_profile, _sketch, index, _controls, ends):
    return Element("line", index, ends[0], ends[1])


def _add_circle(profile, sketch, index, controls, _ends):
    s = sketch.strokes[index]
    centre = profile.add_point(controls[0], s.sigma)
    radius = profile.add_scalar(np.linalg.norm(s.handles[1]), s.sigma)
    return Element("circle", index, centre=centre, scalars=(radius,))


def _axes_of(plane, u, v):
    """Major semi-axis (2) and length of the minor one of a projected ellipse."""
    u, v = (np.array([w.dot(plane.x), w.dot(plane.y)]) for w in (u, v))
    major, minor, _ = principal_axes(u, v)
    return major, float(np.linalg.norm(minor))


def _add_axes(profile, centre, u, v, sigma):
    major, minor = _axes_of(profile.plane, u, v)
    middle = profile.add_point(profile.plane.flat(centre), sigma)
    return middle, tuple(profile.add_scalar(value, sigma) for value in (*major, minor))


def _add_ellipse(profile, sketch, index, _controls, _ends):
    s = sketch.strokes[index]
    centre, axes = _add_axes(profile, *s.handles, s.sigma)
    return Element("ellipse", index, centre=centre, scalars=axes)


def _add_arc(profile, sketch, index, controls, ends):
    spatial = [np.append(c, 0.0) for c in controls]
    circle = circle_of_arc(*spatial)
    if circle is None:
        return _add_line(profile, sketch, index, controls, ends)
    if circle.normal[2] < 0:
        ends = ends[::-1]
    # What a short arc knows of its centre is less than what it knows of its points.
    sagitta = circle.radius * (1 - math.cos(min(circle.angle / 2, math.pi)))
    sigma = max(sketch.strokes[index].sigma, profile.least_sigma)
    sigma *= max(1.0, circle.radius / sagitta)
    centre = profile.add_point(circle.centre[:2], sigma)
    radius = profile.add_scalar(circle.radius, sigma)
    return Element("arc", index, ends[0], ends[1], centre, (radius,))


def _add_elliptic_arc(profile, sketch, index, controls, ends):
    e = elliptic_arc(*sketch.controls(index))
    if e is None:
        return _add_line(profile, sketch, index, controls, ends)
    if np.cross(e.p, e.q).dot(profile.plane.normal) < 0:
        ends = ends[::-1]
    sigma = max(sketch.strokes[index].sigma, profile.least_sigma)
    sigma *= max(1.0, 1 / (1 - math.cos(e.half_angle)))
    centre, axes = _add_axes(profile, e.centre, e.p, e.q, sigma)
    return Element("elliptic_arc", index, ends[0], ends[1], centre, axes)


def _add_spline(profile, _sketch, index, controls, ends):
    profile.fixed.update(ends)
    return Element("spline", index, ends[0], ends[1], poles=controls)
