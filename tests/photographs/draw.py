#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the scene in this folder by POV-Ray: a stepped block with a boss on a wooden table, under
lamps with soft shadows and light between its faces, as six JPEG pictures of 640 x 480 px with
masks, cameras (COLMAP's text files) and true edges.

    draw.py [FOLDER]    # needs Debian's povray; into this folder if none is given

What it writes is committed, so that one test of the whole method is of pictures that the program's
own renderer has not drawn. Lengths are millimetres.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

WIDTH, HEIGHT, FOCAL = 640, 480, 1000.0
VIEWS, DISTANCE, ELEVATION, FIRST = 6, 260.0, math.radians(38), math.radians(20)
TARGET = (0.0, 0.0, 14.0)
# The block: a base and a step upon it, and a boss upon the base.
BASE = ((-40, -25, 0), (40, 25, 18))
STEP = ((5, -25, 18), (40, 25, 40))
BOSS = (-18.0, 0.0, 11.0, 18.0, 30.0)  # axis (x, y), radius, from z, to z

SCENE = """
#version 3.7;
camera {{ perspective location <{location}> direction <{forward}> right <{right}> up <{up}> }}
#declare Part = union {{
  box {{ <{base0}>, <{base1}> }}
  box {{ <{step0}>, <{step1}> }}
  cylinder {{ <{bx}, {by}, {bz0}>, <{bx}, {by}, {bz1}>, {br} }}
}}
{content}
"""
PICTURE = """
global_settings { assumed_gamma 1.0 radiosity { count 80 error_bound 0.6 } }
background { color rgb 0.6 }
#declare Side = 60;
light_source { <-300, -260, 420> color rgb 0.75
  area_light <Side,0,0>, <0,Side,0>, 5, 5 adaptive 1 jitter }
light_source { <330, 180, 300> color rgb 0.35
  area_light <Side,0,0>, <0,Side,0>, 5, 5 adaptive 1 jitter }
object { Part pigment { rgb <0.55, 0.56, 0.58> }
  finish { diffuse 0.75 specular 0.15 roughness 0.03 }
  normal { granite 0.02 scale 4 } }
plane { z, -0.01 pigment { wood turbulence 0.05 scale 14 rotate x*87
    color_map { [0 rgb <0.62,0.45,0.28>] [0.7 rgb <0.55,0.38,0.22>] [1 rgb <0.48,0.32,0.18>] } }
  finish { diffuse 0.7 } }
"""
MASK = "object { Part pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1 } }"


def text(vector):
    return ", ".join(f"{x:.9f}" for x in vector)


def normalised(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def camera(view):
    """Rows of the rotation from world to camera (x right, y down, z forward), and the centre."""
    angle = FIRST + 2 * math.pi * view / VIEWS
    around = DISTANCE * math.cos(ELEVATION)
    height = DISTANCE * math.sin(ELEVATION)
    centre = [TARGET[0] + around * math.cos(angle), TARGET[1] + around * math.sin(angle),
              TARGET[2] + height]
    forward = normalised([t - c for t, c in zip(TARGET, centre)])
    right = normalised(cross(forward, [0, 0, 1]))
    return [right, cross(forward, right), forward], centre


def quaternion(r):
    """w x y z of a rotation matrix."""
    trace = r[0][0] + r[1][1] + r[2][2]
    candidates = [trace, r[0][0], r[1][1], r[2][2]]
    k = candidates.index(max(candidates))
    if k == 0:
        s = 2 * math.sqrt(1 + trace)
        return [s / 4, (r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s]
    i = k - 1
    j, m = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + r[i][i] - r[j][j] - r[m][m])
    q = [(r[m][j] - r[j][m]) / s, 0, 0, 0]
    q[1 + i], q[1 + j], q[1 + m] = s / 4, (r[j][i] + r[i][j]) / s, (r[m][i] + r[i][m]) / s
    return q


def draw(path, content, rotation, centre, kind):
    scene = SCENE.format(
        content=content, location=text(centre), forward=text(rotation[2]),
        right=text([x * WIDTH / FOCAL for x in rotation[0]]),
        up=text([-x * HEIGHT / FOCAL for x in rotation[1]]), base0=text(BASE[0]),
        base1=text(BASE[1]), step0=text(STEP[0]), step1=text(STEP[1]), bx=BOSS[0], by=BOSS[1],
        br=BOSS[2], bz0=BOSS[3], bz1=BOSS[4])
    with tempfile.NamedTemporaryFile("w", suffix=".pov") as file:
        file.write(scene)
        file.flush()
        subprocess.run(["povray", f"+I{file.name}", f"+O{path}", f"+W{WIDTH}", f"+H{HEIGHT}", kind,
                        "+A0.05", "+AM2", "+R3", "-D", "-V", "-GA"],
                       check=True, stderr=subprocess.DEVNULL)


def edges():
    """The true edges: what lies on the table has no edge where base and step share a face."""
    (x0, y0, z0), (x1, y1, z1) = BASE
    (s, _, _), (_, _, z2) = STEP
    lines = []
    side = [(x0, z0), (x1, z0), (x1, z2), (s, z2), (s, z1), (x0, z1)]  # the outline of both ends
    for (xa, za), (xb, zb) in zip(side, side[1:] + side[:1]):
        lines += [[[xa, y, za], [xb, y, zb]] for y in (y0, y1)]
    lines += [[[x, y0, z], [x, y1, z]] for x, z in side]
    curves = [{"type": "line", "closed": False, "points": line} for line in lines]
    cx, cy, radius, bottom, top = BOSS
    for z in (bottom, top):
        angles = [2 * math.pi * k / 256 for k in range(257)]
        curves.append({"type": "circle", "closed": True,
                       "points": [[cx + radius * math.cos(a), cy + radius * math.sin(a), z]
                                  for a in angles]})
    return curves


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name in ("images", "masks", "sparse/0"):
        os.makedirs(os.path.join(folder, name), exist_ok=True)
    images = []
    for view in range(VIEWS):
        rotation, centre = camera(view)
        name = f"{view}.jpg"
        draw(os.path.join(folder, "images", name), PICTURE, rotation, centre, "+FJ92")
        draw(os.path.join(folder, "masks", name + ".png"), MASK, rotation,
             centre, "+FNg")
        moved = [-sum(a * b for a, b in zip(row, centre)) for row in rotation]
        images.append(" ".join(str(x) for x in [view + 1, *quaternion(rotation), *moved, 1, name]))
    with open(os.path.join(folder, "sparse/0/cameras.txt"), "w") as file:
        file.write(f"1 PINHOLE {WIDTH} {HEIGHT} {FOCAL} {FOCAL} {WIDTH / 2} {HEIGHT / 2}\n")
    with open(os.path.join(folder, "sparse/0/images.txt"), "w") as file:
        file.write("".join(line + "\n\n" for line in images))
    with open(os.path.join(folder, "sparse/0/points3D.txt"), "w") as file:
        file.write("")
    with open(os.path.join(folder, "gt.json"), "w") as file:
        json.dump(edges(), file)


if __name__ == "__main__":
    main()
