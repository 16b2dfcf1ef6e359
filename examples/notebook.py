#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""From a folder to curves and numbers, cell by cell: notebook.py SCENE [OUT.step]"""
# %% A scene: any folder that the program reads
import sys

import numpy as np

import sketchsplat

scene = sys.argv[1]

# %% Reconstruct, and say how far it is
sketch = sketchsplat.reconstruct_folder(
    scene, preset="fast", progress=lambda stage, done, total: done or print(stage))
print(sketch.ending, sketch.message, *sketch.warnings, sep="\n")

# %% The curves: kind, length, and how sure
for curve in sketch.curves:
    print(f"{curve.kind:13s} {curve.length:8.4f} {curve.confidence:5.2f} {curve.rms_px:6.3f} px")

# %% Points along them, N x 3, as arrays
points = np.concatenate([sketch.sample(i, 0.01) for i in range(len(sketch))])
print("from", points.min(axis=0), "to", points.max(axis=0))

# %% Against the truth, if there is one
try:
    print({name: round(x, 2) for name, x in sketchsplat.evaluate(sketch, scene).items()})
except RuntimeError as error:
    print(error)

# %% For a CAD program, 100 mm per unit
if len(sys.argv) > 2:
    sketch.write(sys.argv[2], scale=100)
