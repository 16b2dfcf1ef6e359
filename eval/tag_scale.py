#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How well does one AprilTag tell the scale, and does the stated sigma say so?

Photographs of parts with a tag on the table (`synthesize --style photo`) are made for every seed,
and `reconstruct --dry-run --scale-by tag=...` measures the tag in them. The true edge is known:
written are the error of the scale and the stated standard deviation, both relative, of each seed,
and the RMS of the errors over that of the sigmas, which is 1 if these are honest.

  eval/tag_scale.py --binary build/pipelines/sketchsplat --work DIR [--seeds 30] [--views 50]
"""

import argparse
import json
import math
import os
import shutil
import subprocess
import sys

PARTS = ["l-bracket", "box-hole", "plate-holes", "flange"]
TAG_MM = 10


def run(arguments):
    done = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(" ".join(arguments) + "\n" + done.stderr)
    return done.stdout


def true_side(scene):
    with open(scene + "/scene.json") as file:
        corners = json.load(file)["tag"]["corners"]
    return sum(math.dist(corners[k], corners[(k + 1) % 4]) for k in range(4)) / 4


def measure(arguments, seed):
    scene = f"{arguments.work}/{seed}"
    shutil.rmtree(scene, ignore_errors=True)
    run([arguments.binary, "synthesize", PARTS[seed % len(PARTS)], "--out", scene,
         "--seed", str(seed), "--style", "photo", "--views", str(arguments.views),
         "--resolution", str(arguments.resolution),
         "--tag", str(seed), "--noise", "2", "--tag-size", str(arguments.tag_size),
         "--pose-error", str(arguments.pose_error), "--outputs", "none", "-q"])
    plan = json.loads(run([arguments.binary, "reconstruct", scene, "--out", scene + "/none",
                           "--scale-by", f"tag={TAG_MM}mm", "--dry-run", "--json", "-q"]))["scale"]
    error = plan["units_per_world"] * true_side(scene) / TAG_MM - 1
    tag = plan["tags"][0]
    print(f"seed {seed:3d}  {tag['views']:3d} views  scatter {tag['rms_px']:.3f} px  "
          f"error {100 * error:+.4f} %  sigma {100 * plan['sigma_relative']:.4f} %", flush=True)
    if not arguments.keep:
        shutil.rmtree(scene)
    return error, plan["sigma_relative"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", default="build/pipelines/sketchsplat")
    parser.add_argument("--work", required=True, help="folder for the scenes")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--views", type=int, default=50)
    parser.add_argument("--resolution", type=int, default=800, help="width [px]")
    parser.add_argument("--tag-size", type=float, default=0.2,
                        help="world units; the part is 1 long")
    parser.add_argument("--pose-error", type=float, default=0, help="RMS [px] of the cameras")
    parser.add_argument("--keep", action="store_true", help="the scenes")
    arguments = parser.parse_args()
    os.makedirs(arguments.work, exist_ok=True)
    seeds = range(arguments.first, arguments.first + arguments.seeds)
    results = [measure(arguments, seed) for seed in seeds]
    error, sigma = (math.sqrt(sum(r[k] ** 2 for r in results) / len(results)) for k in (0, 1))
    worst = max(abs(r[0]) for r in results)
    mean = sum(r[0] for r in results) / len(results)
    print(f"{len(results)} seeds: error RMS {100 * error:.4f} %, mean {100 * mean:+.4f} %, "
          f"worst {100 * worst:.4f} %; stated {100 * sigma:.4f} %; "
          f"RMS over stated {error / sigma:.2f}")


if __name__ == "__main__":
    main()
