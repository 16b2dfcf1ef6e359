# SPDX-License-Identifier: MIT
"""Opens results of sketchsplat in FreeCAD and turns their planar loops into constrained sketches.

Modules without FreeCAD (numpy alone): sketch_file, curves, planes, loops, faces, frames, profile,
equations, relations, constrain. With FreeCAD: part_curves, drawing, sketcher, importer, commands.
"""
