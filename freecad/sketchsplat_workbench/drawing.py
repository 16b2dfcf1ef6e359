# SPDX-License-Identifier: MIT
"""The strokes and the solid of a result as objects of a FreeCAD document, in groups."""

import math
import os

import FreeCAD
import Part

from . import sketch_file
from .part_curves import edge

GROUP = "Sketchsplat"  # of properties in the editor
# Group and colour (red, green, blue) by kind, as the STEP and DXF files have them.
KINDS = {
    "line": ("Lines", (0.15, 0.39, 0.92)),
    "arc": ("Arcs", (0.92, 0.35, 0.05)),
    "circle": ("Circles", (0.86, 0.15, 0.15)),
    "ellipse": ("Ellipses", (0.58, 0.2, 0.92)),
    "elliptic_arc": ("Ellipses", (0.86, 0.15, 0.6)),
    "bezier": ("Splines", (0.09, 0.64, 0.29)),
}
INFERRED = ("Inferred", (0.6, 0.6, 0.6))
LINE_WIDTH = 2.0


def draw_result(document, path, mm_per_world=None):
    """Draws a result folder or its sketch.json; returns the group that holds everything.

    `mm_per_world`: millimetres per world unit, None: what the files say. Raises SketchFileError.
    """
    path = sketch_file.sketch_path(path)
    sketch = sketch_file.read_sketch(path, mm_per_world)
    result = document.addObject("App::DocumentObjectGroup", "Result")
    result.Label = os.path.basename(os.path.dirname(os.path.abspath(path))) or "Result"
    result.addProperty("App::PropertyFileIncluded", "Source", GROUP, "A copy of sketch.json")
    result.addProperty("App::PropertyFloat", "MillimetresPerUnit", GROUP, "Scale of the file")
    result.Source = path
    result.MillimetresPerUnit = sketch.mm_per_world
    _draw_strokes(document, result, sketch)
    solid = sketch_file.solid_path(path)
    if solid is not None:
        _draw_solid(document, result, solid, sketch.mm_per_world / sketch_file.stated_scale(path))
    document.recompute()
    return result


def result_of(obj):
    """The group of draw_result that holds an object, or the object itself; None without one."""
    for candidate in [obj] + obj.InListRecursive:
        if candidate.isDerivedFrom("App::DocumentObjectGroup") and hasattr(candidate, "Source"):
            return candidate
    return None


def sketch_of(result):
    """The sketch from which a group was drawn, in millimetres; from the copy in the document."""
    return sketch_file.read_sketch(result.Source, result.MillimetresPerUnit)


def subgroup(document, result, label):
    """The group of that label in a result, made if it is missing."""
    for obj in result.Group:
        if obj.Label == label or obj.Label.rstrip("0123456789") == label:
            return obj
    group = document.addObject("App::DocumentObjectGroup", label)
    group.Label = label
    result.addObject(group)
    return group


def _draw_strokes(document, result, sketch):
    members = {}
    for i, stroke in enumerate(sketch.strokes):
        name, colour = INFERRED if stroke.inferred else KINDS[stroke.kind]
        obj = document.addObject("Part::Feature", f"{stroke.kind}_{i}")
        obj.Shape = edge(sketch, i)
        _add_evidence(obj, stroke, i)
        if FreeCAD.GuiUp:
            obj.ViewObject.LineColor = colour
            obj.ViewObject.PointColor = colour
            obj.ViewObject.LineWidth = LINE_WIDTH
            if stroke.inferred:
                obj.ViewObject.DrawStyle = "Dashed"
        members.setdefault(name, []).append(obj)
    for name, objects in sorted(members.items()):
        subgroup(document, result, name).addObjects(objects)


def _add_evidence(obj, stroke, index):
    """What the images say about a stroke, as read-only properties."""
    rows = [
        ("App::PropertyString", "Kind", stroke.kind, "Kind of curve"),
        ("App::PropertyInteger", "Stroke", index, "Its number in sketch.json"),
        ("App::PropertyInteger", "SupportViews", stroke.support_views, "Views that see it"),
        ("App::PropertyLength", "Sigma", stroke.sigma, "Standard deviation of its position"),
        ("App::PropertyFloat", "RmsPixels", stroke.rms_px, "Distance to the edges in the images"),
    ]
    if not math.isnan(stroke.confidence):
        text = "Probability that it is an edge of the object"
        rows.append(("App::PropertyFloat", "Confidence", stroke.confidence, text))
    for kind, name, value, text in rows:
        obj.addProperty(kind, name, GROUP, text)
        setattr(obj, name, value)
        obj.setEditorMode(name, 1)


def _draw_solid(document, result, path, scale):
    """`scale`: by which the lengths of the file are to be multiplied."""
    shape = Part.Shape()
    shape.read(path)
    if abs(scale - 1) > 1e-12:
        shape.scale(scale)
    obj = document.addObject("Part::Feature", "Solid")
    obj.Shape = shape
    subgroup(document, result, "Solids").addObject(obj)
    if FreeCAD.GuiUp:
        obj.ViewObject.Transparency = 60
