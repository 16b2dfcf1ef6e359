# SPDX-License-Identifier: MIT
"""Constrained profiles as sketches of FreeCAD's Sketcher."""

import math
from dataclasses import dataclass, field

import FreeCAD
import numpy as np
import Part
import Sketcher

from .constrain import constrain
from .equations import Equations
from .faces import planar_faces, select_loops
from .frames import face_plane, main_axes
from .part_curves import ellipse, spline, vector
from .profile import BEGIN, CENTRE, CURVE, END, build_profile

UP = FreeCAD.Vector(0, 0, 1)
OK = 0  # what SketchObject.solve() returns if nothing conflicts and nothing is redundant
GROUP = "Sketchsplat"  # of properties in the editor


@dataclass
class SketchResult:
    """A Sketcher sketch; `dropped`: constraints that FreeCAD found redundant or conflicting."""

    object: object
    freedom: int  # degrees of freedom that are left
    largest_move: float  # millimetres, from the measured places to the constrained ones
    relations: int
    dimensions: int
    dropped: list = field(default_factory=list)

    def summary(self):
        """One line for the report view."""
        text = (
            f"{self.object.Label}: {self.relations} relations, {self.dimensions} dimensions, "
            f"{self.freedom} degrees of freedom left, moved by {self.largest_move:.3g} mm at most"
        )
        if self.dropped:
            text += f", {len(self.dropped)} constraints dropped"
        return text


def make_sketches(document, sketch, selected=(), group=None):
    """A Sketcher sketch of each planar face that selected strokes mean; of all without any.

    Lengths in millimetres. Returns a list of SketchResult, empty if there is no closed planar loop.
    """
    axes = main_axes(sketch)
    results = []
    for face in select_loops(planar_faces(sketch), selected):
        profile = build_profile(sketch, face, face_plane(sketch, face, axes))
        constrained = constrain(profile, sketch.regularities)
        results.append(add_sketch(document, constrained, f"Face{len(results) + 1:02d}"))
        if group is not None:
            group.addObject(results[-1].object)
    document.recompute()
    return results


def add_sketch(document, constrained, name):
    """Adds a sketch that solves without complaints; recomputing is the caller's."""
    profile = constrained.profile
    obj = document.addObject("Sketcher::SketchObject", name)
    obj.Placement = placement(profile.plane)
    writer = _Writer(obj, constrained)
    writer.add_geometry()
    dropped = writer.add_constraints()
    result = SketchResult(
        obj,
        constrained.freedom,
        constrained.largest_move,
        len(constrained.relations),
        len(constrained.dimensions),
        dropped,
    )
    obj.addProperty("App::PropertyInteger", "DegreesOfFreedom", GROUP, "Left by the constraints")
    obj.addProperty("App::PropertyLength", "LargestMove", GROUP, "From the measured places")
    obj.addProperty("App::PropertyIntegerList", "Strokes", GROUP, "Of sketch.json, in order")
    obj.DegreesOfFreedom = result.freedom
    obj.LargestMove = result.largest_move
    obj.Strokes = [e.stroke for e in profile.elements]
    return result


def placement(plane):
    """The FreeCAD placement of a plane's frame."""
    rotation = FreeCAD.Rotation(*(vector(v) for v in (plane.x, plane.y, plane.normal)), "ZXY")
    return FreeCAD.Placement(vector(plane.origin), rotation)


class _Writer:
    """Elements become geometry of the same number; axes of ellipses come after them."""

    def __init__(self, obj, constrained):
        self.obj = obj
        self.constrained = constrained
        self.profile = constrained.profile
        self.x = constrained.unknowns
        self.equations = Equations(self.profile)
        self._axes = {}  # (element, "major" or "minor"): number of the line
        self._internal = []  # constraints that hold these lines

    def add_geometry(self):
        count = len(self.profile.elements)
        self.obj.addGeometry([self._curve(i) for i in range(count)], False)
        for i, e in enumerate(self.profile.elements):
            if e.kind in ("ellipse", "elliptic_arc"):
                self._add_axes(i)

    def add_constraints(self):
        """Returns those that had to be left out, as text."""
        wanted = self._internal + self._joints() + self._blocks()
        for c in self.constrained.constraints:
            wanted += self._constraints_of(c)
        self.obj.addConstraint(wanted)
        if self.obj.solve() == OK:
            return []
        # FreeCAD sees it otherwise: one by one, without those that it complains about.
        self.obj.deleteAllConstraints()
        dropped = []
        for c in wanted:
            number = self.obj.addConstraint(c)
            if self.obj.solve() != OK:
                dropped.append(f"{c.Type} of {c.First}, {c.Second}")
                self.obj.delConstraint(number)
        self.obj.solve()
        return dropped

    def _point(self, element, position):
        return self.equations.point((element, position), self.x)

    def _axes_of(self, i):
        major = self.equations.major(i, self.x)
        length, minor = math.hypot(*major), self.equations.scalar(i, 2, self.x)
        return major, np.array([-major[1], major[0]]) * (minor / length)

    def _curve(self, i):
        e = self.profile.elements[i]
        if e.kind == "line":
            return Part.LineSegment(vector(self._point(i, BEGIN)), vector(self._point(i, END)))
        if e.kind == "spline":
            return spline(e.poles)
        centre = self._point(i, CENTRE)
        if e.kind in ("circle", "arc"):
            whole = Part.Circle(vector(centre), UP, float(self.equations.scalar(i, 0, self.x)))
            axes = np.eye(2)
        else:
            axes = self._axes_of(i)
            whole = ellipse(centre, *axes)
        if e.kind in ("circle", "ellipse"):
            return whole
        angles = []
        for position in (BEGIN, END):
            d = self._point(i, position) - centre
            angles.append(math.atan2(*(d.dot(a) / a.dot(a) for a in (axes[1], axes[0]))))
        if angles[1] <= angles[0]:
            angles[1] += 2 * math.pi
        return (Part.ArcOfCircle if e.kind == "arc" else Part.ArcOfEllipse)(whole, *angles)

    def _add_axes(self, i):
        centre = self._point(i, CENTRE)
        for name, kind, axis in zip(("major", "minor"), ("Major", "Minor"), self._axes_of(i)):
            line = Part.LineSegment(vector(centre - axis), vector(centre + axis))
            self._axes[i, name] = self.obj.addGeometry(line, True)
            kind = f"InternalAlignment:Ellipse{kind}Diameter"
            self._internal.append(Sketcher.Constraint(kind, self._axes[i, name], i))

    def _joints(self):
        """Ends that meet: tangent where that was taken, else coincident."""
        tangent = {c.refs for c in self.constrained.constraints if c.kind == "tangent"}
        ends, out = {}, []
        for i, e in enumerate(self.profile.elements):
            for position in (BEGIN, END) if e.begin >= 0 else ():
                ends.setdefault(self.profile.point_of((i, position)), []).append((i, position))
        for refs in ends.values():
            for a, b in zip(refs, refs[1:]):
                if a[0] == b[0]:
                    continue  # a closed spline
                kind = "Tangent" if tangent & {(a, b), (b, a)} else "Coincident"
                out.append(Sketcher.Constraint(kind, *a, *b))
        return out

    def _blocks(self):
        """Splines stay as they were measured."""
        return [
            Sketcher.Constraint("Block", i)
            for i, e in enumerate(self.profile.elements)
            if e.kind == "spline"
        ]

    def _constraints_of(self, c):
        """The Sketcher's constraints of one of ours."""
        names = {
            "distance": "Distance",
            "distance_x": "DistanceX",
            "distance_y": "DistanceY",
            "angle": "Angle",
            "radius": "Radius",
        }
        refs = c.refs
        if c.kind == "tangent":
            return []  # with the joints
        if c.kind == "symmetric":
            return [Sketcher.Constraint("Symmetric", *refs[0], *refs[1], *refs[2])]
        if c.kind in ("major", "minor"):
            line = self._axes[refs[0][0], c.kind]
            return [Sketcher.Constraint("Distance", line, 2 * c.value)]
        if c.kind == "angle":
            line = self._axes.get((refs[0][0], "major"), refs[0][0])
            return [Sketcher.Constraint("Angle", line, c.value)]
        numbers = [r[0] for r in refs] if refs[0][1] == CURVE else [n for r in refs for n in r]
        values = [] if c.value is None else [c.value]
        return [Sketcher.Constraint(names.get(c.kind, c.kind.capitalize()), *numbers, *values)]
