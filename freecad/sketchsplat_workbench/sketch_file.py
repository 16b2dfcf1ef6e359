# SPDX-License-Identifier: MIT
"""Reads sketch.json: strokes over shared nodes, what the images say about them, regularities."""

import json
import math
import os
from dataclasses import dataclass, field

import numpy as np

FORMAT_VERSION = 1
MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}
HANDLES = {"line": 0, "arc": 1, "circle": 2, "ellipse": 3, "bezier": 2, "elliptic_arc": 2}
CLOSED = ("circle", "ellipse")


class SketchFileError(ValueError):
    """The file cannot be used; the text is one line: path, what was expected, what was found."""

    def __init__(self, path, expected, found):
        super().__init__(f"{path}: expected {expected}, found {found}")


@dataclass
class Stroke:
    """A curve. `handles`: k x 3, millimetres; docs/formats.md says what they mean."""

    kind: str
    begin: int  # row of Sketch.nodes; -1 if closed
    end: int
    handles: np.ndarray
    confidence: float = math.nan  # probability that it is an edge; NaN: unknown
    support_views: int = 0
    rms_px: float = 0.0
    sigma: float = 0.0  # largest standard deviation of a point of it, millimetres
    inferred: bool = False  # no image shows it

    @property
    def closed(self):
        return self.kind in CLOSED


@dataclass
class Sketch:
    """All lengths in millimetres."""

    nodes: np.ndarray  # n x 3
    strokes: list
    regularities: list = field(default_factory=list)  # of (kind, frozenset of strokes)
    mm_per_world: float = 1.0

    def controls(self, index):
        """Control points (m x 3) of a stroke: begin, handles, end; handles alone if closed."""
        s = self.strokes[index]
        if s.closed:
            return s.handles
        return np.vstack([self.nodes[s.begin], s.handles, self.nodes[s.end]])

    def extent(self):
        """Longest side of the box around all control points, millimetres; 0 if there are none."""
        points = [self.controls(i) for i in range(len(self.strokes)) if not self.strokes[i].closed]
        for s in self.strokes:
            if s.closed:
                axes = s.handles[1:]
                reach = np.linalg.norm(axes, axis=1).max()
                points.append(np.vstack([s.handles[0] - reach, s.handles[0] + reach]))
        if not points:
            return 0.0
        return float(np.ptp(np.vstack(points), axis=0).max())


def sketch_path(path):
    """The sketch.json of a result folder, or the file itself. Raises SketchFileError."""
    if os.path.isdir(path):
        path = os.path.join(path, "sketch.json")
    if not os.path.isfile(path):
        raise SketchFileError(path, "a sketch.json or a folder that holds one", "none")
    return path


def solid_path(path):
    """The solid.step beside a sketch.json or in a result folder; None if there is none."""
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    solid = os.path.join(folder, "solid.step")
    return solid if os.path.isfile(solid) else None


def read_sketch(path, mm_per_world=None):
    """Reads a sketch.json or the one in a result folder.

    `mm_per_world`: millimetres per world unit; None: what the file says, else one. Raises
    SketchFileError where the file cannot be used.
    """
    path = sketch_path(path)
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
    except (OSError, ValueError) as e:
        raise SketchFileError(path, "a sketch as JSON", str(e)) from e
    if mm_per_world is None:
        mm_per_world = stated_scale(path, content)
    if not (math.isfinite(mm_per_world) and mm_per_world > 0):
        raise SketchFileError(path, "a scale above zero", mm_per_world)
    return _sketch_of(path, content, float(mm_per_world))


def stated_scale(path, content=None):
    """Millimetres per world unit in the CAD files beside a sketch.json (path of the file)."""
    if content is None:
        try:
            with open(path, encoding="utf-8") as file:
                content = json.load(file)
        except (OSError, ValueError) as e:
            raise SketchFileError(path, "a sketch as JSON", str(e)) from e
    try:
        scale = content["scale"]
        return float(scale["units_per_world"]) * MILLIMETRES[scale["unit"]]
    except (KeyError, TypeError, ValueError):
        pass
    try:  # no scale is known: a world unit is one of the unit that was asked for
        report = os.path.join(os.path.dirname(path), "report.json")
        with open(report, encoding="utf-8") as file:
            return MILLIMETRES[json.load(file)["options"]["unit"]]
    except (OSError, ValueError, KeyError, TypeError):
        return 1.0


def _sketch_of(path, content, scale):
    if not isinstance(content, dict) or content.get("format_version") != FORMAT_VERSION:
        found = content.get("format_version") if isinstance(content, dict) else "no object"
        raise SketchFileError(path, f"format_version {FORMAT_VERSION}", found)
    nodes = _points(path, content.get("nodes"), "nodes") * scale
    if not isinstance(content.get("strokes"), list):
        raise SketchFileError(path, 'an array as "strokes"', type(content.get("strokes")).__name__)
    strokes = [
        _stroke(path, s, f"stroke {i}", len(nodes), scale)
        for i, s in enumerate(content["strokes"])
    ]
    sketch = Sketch(nodes, strokes, mm_per_world=scale)
    sketch.regularities = _regularities(content.get("regularities"), len(strokes))
    return sketch


def _points(path, rows, where):
    try:
        points = np.array(rows, dtype=float).reshape(-1, 3) if rows else np.zeros((0, 3))
        if rows is None or len(points) != len(rows) or not np.isfinite(points).all():
            raise ValueError
    except (TypeError, ValueError):
        raise SketchFileError(path, f"three numbers a point as {where}", "something else") from None
    return points


def _stroke(path, j, where, num_nodes, scale):
    kind = j.get("kind") if isinstance(j, dict) else None
    if kind not in HANDLES:
        raise SketchFileError(path, f'one of {", ".join(HANDLES)} as "kind" of {where}', kind)
    handles = _points(path, j.get("handles"), f"handles of {where}") * scale
    several = kind == "bezier" and len(handles) % 3 == 2  # n cubics: 3 n - 1
    if not several and len(handles) != HANDLES[kind]:
        raise SketchFileError(path, f"{HANDLES[kind]} handles in {where}", len(handles))
    ends = j.get("nodes")
    right = [] if kind in CLOSED else [int, int]
    if not isinstance(ends, list) or [type(n) for n in ends] != right or any(
        not 0 <= n < num_nodes for n in ends
    ):
        raise SketchFileError(path, f"{len(right)} indices of nodes in {where}", ends)
    begin, end = ends or (-1, -1)
    stroke = Stroke(kind, begin, end, handles)
    stroke.confidence = _number(path, j, "confidence", math.nan, where)
    stroke.support_views = int(_number(path, j, "support_views", 0, where))
    stroke.rms_px = _number(path, j, "rms_px", 0, where)
    stroke.sigma = _number(path, j, "sigma", 0, where) * scale
    stroke.inferred = j.get("inferred") is True
    return stroke


def _number(path, j, key, absent, where):
    value = j.get(key, absent)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or math.isinf(value):
        raise SketchFileError(path, f'a number as "{key}" of {where}', value)
    return value


def _regularities(rows, num_strokes):
    """What can be understood of them; relations are looked for anyway."""
    out = []
    for r in rows if isinstance(rows, list) else []:
        if not isinstance(r, dict) or not isinstance(r.get("strokes"), list):
            continue
        strokes = frozenset(s for s in r["strokes"] if isinstance(s, int) and 0 <= s < num_strokes)
        out.append((str(r.get("kind")), strokes))
    return out
