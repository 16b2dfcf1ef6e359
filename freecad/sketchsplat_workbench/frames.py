# SPDX-License-Identifier: MIT
"""Where the sketch of a face lies: sketches of parallel faces get exactly parallel planes."""

import math

import numpy as np

from .curves import circle_of_arc, polyline
from .planes import TOLERANCE, Plane

SAME_DIRECTION = math.sin(math.radians(0.5))  # directions that differ by less are one


def _direction(sketch, index):
    """Unit direction of a line, normal of a circle or arc; None for others and for points."""
    c, kind = sketch.controls(index), sketch.strokes[index].kind
    if kind == "line":
        v = c[1] - c[0]
    elif kind == "circle":
        v = c[1]
    elif kind == "arc":
        circle = circle_of_arc(*c)
        v = np.zeros(3) if circle is None else circle.normal
    else:
        return None
    length = np.linalg.norm(v)
    return v / length if length > 0 else None


def _clusters(sketch):
    """[(weight, unit vector)] of what strokes run along, or turn about; most weight first."""
    rows = []
    for i in range(len(sketch.strokes)):
        d = _direction(sketch, i)
        if d is not None:
            length = np.linalg.norm(np.diff(polyline(sketch, i), axis=0), axis=1).sum()
            rows.append((length, d))
    rows.sort(key=lambda row: -row[0])
    clusters = []  # [first direction, sum]
    for length, d in rows:
        for c in clusters:
            if np.linalg.norm(np.cross(c[0], d)) < SAME_DIRECTION:
                c[1] += math.copysign(length, c[0].dot(d)) * d
                break
        else:
            clusters.append([d, length * d])
    out = [(float(np.linalg.norm(s)), s / np.linalg.norm(s)) for _, s in clusters]
    return sorted(out, key=lambda row: -row[0])


def main_axes(sketch):
    """Up to three exactly perpendicular unit vectors (k x 3) along which most strokes run."""
    clusters = _clusters(sketch)
    if not clusters:
        return np.zeros((0, 3))
    axes, weights = [], []
    for weight, d in clusters:
        if len(axes) < 3 and all(abs(d.dot(a)) < SAME_DIRECTION for a in axes):
            axes.append(d)
            weights.append(weight)
    if len(axes) == 2:
        axes.append(np.cross(axes[0], axes[1]))
        weights.append(min(weights))
    if len(axes) == 1:
        return np.array(axes)
    # The rotation nearest to them, by weight.
    u, _, v = np.linalg.svd(np.array(axes).T * np.array(weights))
    return (u @ v).T


def _snapped(vector, axes):
    """The axis that a unit vector means, with its sign; else the vector itself."""
    for axis in axes:
        if np.linalg.norm(np.cross(axis, vector)) < SAME_DIRECTION:
            return math.copysign(1, axis.dot(vector)) * axis
    return vector


def _along(sketch, face, normal, axes):
    """The direction of x in the plane of a face, not yet exactly in it."""
    strokes = [stroke for loop in face.loops() for stroke, _ in loop]
    lines = [i for i in strokes if sketch.strokes[i].kind == "line"]
    if lines:
        ends = [sketch.controls(i) for i in lines]
        longest = max(ends, key=lambda c: np.linalg.norm(c[1] - c[0]))
        direction = longest[1] - longest[0]
        return _snapped(direction / np.linalg.norm(direction), axes)
    centres = [sketch.controls(i)[0] for i in strokes if sketch.strokes[i].kind == "circle"]
    for centre in centres[1:]:
        if np.linalg.norm(centre - centres[0]) > 10 * TOLERANCE * sketch.extent():
            return centre - centres[0]
    for axis in axes:
        if abs(axis.dot(normal)) < 0.5:
            return axis
    return np.eye(3)[np.argmin(np.abs(normal))]


def face_plane(sketch, face, axes):
    """The plane of the sketch of a face, x along its longest line; its origin is not final.

    The normal is one of the object's main axes where all strokes stay within the tolerance.
    """
    points = np.vstack([polyline(sketch, i) for loop in face.loops() for i, _ in loop])
    origin, normal = face.plane.origin, face.plane.normal
    candidate = _snapped(normal, axes)
    height = (points - origin) @ candidate
    middle = (height.max() + height.min()) / 2
    if np.ptp(height) <= 2 * TOLERANCE * sketch.extent():
        normal = candidate
        origin = origin + middle * normal
    x = _along(sketch, face, normal, axes)
    x = x - normal * normal.dot(x)
    x /= np.linalg.norm(x)
    if x[np.argmax(np.abs(x))] < 0:
        x = -x
    return Plane(origin, x, np.cross(normal, x), normal)
