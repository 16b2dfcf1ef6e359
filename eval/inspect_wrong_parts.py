#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Does `inspect` find what is wrong, and nothing else?

Of each of some plates with holes (`--param hole-shift=0.001 --param bore-error=2`: one hole moved
by a thousandth of the longest side, the bore 2 % too large), scenes of 50 pictures are made and
reconstructed; the plate without errors is the nominal part. A plate is right if the four circles of
the moved hole and of the bore are out and no other edge, and no dimension between others, is;
undecided is right for these. They are reconstructed without regularities, which
make of one hole in the wrong place four that are a little wrong. Scenes and results that are there
already are used again.

  eval/inspect_wrong_parts.py --binary build/pipelines/sketchsplat --work DIR [--seeds 30]
"""

import argparse
import json
import os
import subprocess
import sys
import time

import numpy as np

VIEWS = "--views 50 --noise 3 --outputs none -q".split()
WRONG = ["--param", "hole-shift=0.001", "--param", "bore-error=2"]


def run(arguments, allowed=(0,)):
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in allowed:
        sys.exit(" ".join(arguments) + "\n" + done.stderr)
    return done.returncode


def circles_of(path):
    with open(path) as file:
        strokes = json.load(file)["strokes"]
    return {k: (np.array(s["centre"]), s["radius"]) for k, s in enumerate(strokes)
            if s["kind"] == "circle"}


def wrong_edges(truth, made):
    """Numbers of the curves that the part as it was made has elsewhere than the nominal one."""
    nominal, there = circles_of(truth), circles_of(made)
    wrong = set()
    for k, (centre, radius) in nominal.items():
        nearest = min(there.values(), key=lambda c: np.linalg.norm(c[0] - centre))
        if np.linalg.norm(nearest[0] - centre) > 1e-6 or abs(nearest[1] - radius) > 1e-6:
            wrong.add(k)
    return wrong


def inspect_plate(binary, work, seed, resolution, tolerance):
    """Names of edges that are out and should not be, and that should be and are not; seconds."""
    nominal, scene, result = (f"{work}/{kind}/{seed}" for kind in ("nominal", "scenes", "results"))
    part = ["synthesize", "plate-holes", "--seed", str(seed), "--out"]
    if not os.path.exists(nominal + "/meta_data.json"):
        run([binary] + part + [nominal, "--views", "1", "--resolution", "16", "--outputs", "none",
                               "-q"])
    if not os.path.exists(scene + "/meta_data.json"):
        run([binary] + part + [scene, "--resolution", str(resolution)] + VIEWS + WRONG)
    if not os.path.exists(result + "/sketch.json"):
        run([binary, "reconstruct", scene, "--out", result, "-q", "--overlays", "0",
             "--without", "regularize"])
    truth = nominal + "/groundtruth/sketch.json"
    began = time.time()
    run([binary, "inspect", result, "--nominal", truth, "--tolerance", str(tolerance), "--scale",
         "1", "--overlays", "0", "-q"], (0, 7))
    seconds = time.time() - began
    with open(result + "/inspection.json") as file:
        inspection = json.load(file)
    wrong = {f"E{k + 1}" for k in wrong_edges(truth, scene + "/groundtruth/sketch.json")}
    false_alarms = [e["name"] for e in inspection["edges"]
                    if e["verdict"] == "out" and e["name"] not in wrong]
    false_alarms += [d["name"] for d in inspection["dimensions"]
                     if d["verdict"] == "out" and not wrong & set(d["of"])]
    missed = [e["name"] for e in inspection["edges"]
              if e["verdict"] != "out" and e["name"] in wrong]
    return false_alarms, missed, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--resolution", type=int, default=1600, help="of the pictures, px")
    parser.add_argument("--tolerance", type=float, default=0.0005, help="of the longest side")
    arguments = parser.parse_args()
    right, slowest = 0, 0
    for seed in range(1, arguments.seeds + 1):
        false_alarms, missed, seconds = inspect_plate(
            arguments.binary, arguments.work, seed, arguments.resolution, arguments.tolerance)
        slowest = max(slowest, seconds)
        right += not false_alarms and not missed
        if false_alarms or missed:
            print(f"seed {seed}: out but right: {' '.join(false_alarms) or 'none'}; "
                  f"wrong but not out: {' '.join(missed) or 'none'}")
    print(f"{right} of {arguments.seeds} plates: the moved hole and the wrong bore out, "
          "nothing else; "
          f"inspect took {slowest:.2f} s at most")
    return 0 if right >= 0.95 * arguments.seeds else 1


if __name__ == "__main__":
    sys.exit(main())
