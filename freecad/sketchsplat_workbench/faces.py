# SPDX-License-Identifier: MIT
"""Faces that closed planar loops of strokes bound, as `sketchsplat export --faces` has them."""

from dataclasses import dataclass

import numpy as np

from .loops import Graph, is_inside, perimeter, polygons_cross
from .planes import TOLERANCE, Plane, PlaneFinder


@dataclass
class Face:
    """Loops are lists of (stroke, forward); the outer one runs counter-clockwise about normal."""

    plane: Plane
    outer: list
    holes: list

    def loops(self):
        return [self.outer] + self.holes


def planar_faces(sketch, tolerance=TOLERANCE):
    """All faces of a sketch; `tolerance`: as a fraction of its extent.

    A loop around nothing becomes a face, too, and a loop alone inside of a face is a hole in it.
    """
    tolerance *= sketch.extent()
    finder = PlaneFinder(sketch, tolerance)
    faces = []
    for plane, members in finder.find():
        faces += faces_in_plane(sketch, finder.polylines, members, plane, tolerance)
    faces = _without_doubles(faces)
    for face in faces:
        _turn_outward(face, finder.polylines)
    return faces


def faces_in_plane(sketch, polylines, members, plane, tolerance):
    """Faces of these strokes; without those that cross themselves or are thinner than that."""
    cycles = Graph(sketch, members, [plane.flat(polylines[m]) for m in members]).cycles()
    walks_with_inside = {c.walk for c in cycles if c.area > 0}
    # What lies around every part, by the clockwise walk along its outside.
    around = {}
    for c in cycles:
        if c.area <= 0 and c.walk not in walks_with_inside:
            around.setdefault(c.part, _container(cycles, c))

    def depth(part):
        count = 0
        while around.get(part) is not None:  # areas grow from part to part, so this ends
            part = cycles[around[part]].part
            count += 1
        return count

    faces = []
    for i, outer in enumerate(cycles):
        if outer.area <= 2 * tolerance * perimeter(outer.polygon) or depth(outer.part) % 2:
            continue
        holes = [
            c
            for c in cycles
            if c.area <= 0
            and (
                c.walk == outer.walk
                or (c.walk not in walks_with_inside and around.get(c.part) == i)
            )
        ]
        if _is_clean([outer] + holes):
            faces.append(Face(plane, outer.loop, [h.loop for h in holes]))
    return faces


def _container(cycles, inner):
    """Index of the smallest counter-clockwise cycle of another part around this one, or None."""
    best = None
    for i, c in enumerate(cycles):
        if c.part == inner.part or c.area <= 0:
            continue
        if best is not None and c.area >= cycles[best].area:
            continue
        n = len(inner.polygon)
        at = (0, n // 3, 2 * n // 3)
        middles = [(inner.polygon[k] + inner.polygon[(k + 1) % n]) / 2 for k in at]
        if sum(is_inside(m, c.polygon) for m in middles) >= 2:
            best = i
    return best


def _is_clean(cycles):
    return not any(
        polygons_cross(a.polygon, b.polygon) for i, a in enumerate(cycles) for b in cycles[i:]
    )


def _strokes(loop):
    return tuple(sorted(stroke for stroke, _ in loop))


def _without_doubles(faces):
    """Planes that differ by less than the tolerance need not see the same strokes."""
    holes = {_strokes(hole) for face in faces for hole in face.holes}
    out, seen = [], set()
    for face in sorted(faces, key=lambda f: -len(f.holes)):
        outer = _strokes(face.outer)
        if outer not in holes and outer not in seen:
            seen.add(outer)
            out.append(face)
    return out


def _turn_outward(face, polylines):
    """Turns the normal away from the middle of all strokes; loops that lie in it look along +."""
    middle = np.mean([p.mean(axis=0) for p in polylines], axis=0)
    size = max(np.ptp(np.vstack(polylines), axis=0).max(), 1e-300)
    side = (face.plane.origin - middle) @ face.plane.normal / size
    largest = face.plane.normal[np.argmax(np.abs(face.plane.normal))]
    if side < -1e-3 or (abs(side) <= 1e-3 and largest < 0):
        p = face.plane
        face.plane = Plane(p.origin, p.x, -p.y, -p.normal)
        for loop in face.loops():
            loop[:] = [(stroke, not forward) for stroke, forward in reversed(loop)]


def select_loops(faces, selected):
    """Faces and holes that selected strokes (indices) mean; without any, all faces.

    A stroke of an outer loop means the face with its holes, one of a hole the hole alone. Of the
    loops that a stroke is part of those count that hold most of the selected strokes.
    """
    if not selected:
        return list(faces)
    selected = set(selected)
    loops = [(f, k, set(_strokes(loop))) for f in faces for k, loop in enumerate(f.loops())]
    chosen = {}
    for stroke in sorted(selected):
        with_it = [x for x in loops if stroke in x[2]]
        most = max((len(x[2] & selected) for x in with_it), default=0)
        for face, k, strokes in with_it:
            if len(strokes & selected) == most:
                hole_alone = Face(face.plane, face.loops()[k], [])
                chosen.setdefault((id(face), k), face if k == 0 else hole_alone)
    return list(chosen.values())
