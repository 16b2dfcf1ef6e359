#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits SigmaOptions of eval/inspect/sigma_model.h and says how far the probabilities of `inspect`
can be relied on.

Makes scenes of the built-in parts (24 views of 400 x 400 px) with exact poses and with poses that
err as those that a tracker finds in photographs, and reconstructs them. Of two parts of three, with
the first and the last kind of poses, it takes how far every place of every curve is from the truth,
and fits the numbers by maximum likelihood (--fit; written to WORK/calibration.json). Then it asks,
by tenths of what is stated,

 - known: how often what was measured lies within the tolerance of the truth;
 - within: every edge of the truth is moved and bent at random, evenly over more than the tolerance
   and three standard deviations, and taken as nominal. How often is the truth, inspected by the same
   program, within tolerance, of the edges of which the result says so with that probability?

Scenes and results that are there already are used again: a run may be stopped and started.

  eval/calibrate_inspection.py --binary build/pipelines/sketchsplat --work DIR [--fit]
"""

import argparse
import csv
import json
import os
import random
import subprocess
import sys

import numpy as np

PARTS = """box box-hole plate-holes stepped-shaft l-bracket pocket-block box-fillet box-chamfer
slotted-sheet cut-cylinder frustum hex-nut dome-plate flange tee u-channel rib-plate slot-block tray
bent-sheet fillet-block fillet-step ridge-block crease-disc countersunk-plate oblique-hole
ellipse-plate boss-plate corner-block slot-disc knob keyed-hub elbow groove-shaft ball-stud
dished-cap cross-drilled spline-plate wave-block loft-grip swept-rail freeform-pad
ridge-cylinder""".split()
FITTED = [k % 3 != 2 for k in range(len(PARTS))]

VIEWS = "--views 24 --resolution 400 --object-size 0.7 --noise 3 --outputs none".split()
CONDITIONS = {"exact poses": [], "poses off by 0.2 px": ["--pose-noise", "0.2"],
              "poses off by 0.5 px": ["--pose-noise", "0.5"]}
FITTED_CONDITIONS = ["exact poses", "poses off by 0.5 px"]
TOLERANCES = [0.0002, 0.0005, 0.001]  # of the longest side, which is 1


def run(arguments, allowed=(0,)):
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in allowed:
        sys.exit(" ".join(arguments) + "\n" + done.stderr)
    return done.returncode


class Scene:
    def __init__(self, work, part, condition, seed):
        name = f"{part}.{condition.replace(' ', '-')}.{seed}"
        self.part, self.condition, self.seed = part, condition, seed
        self.scene, self.result = f"{work}/scenes/{name}", f"{work}/results/{name}"
        self.truth = self.scene + "/groundtruth/sketch.json"
        self.inspections = f"{work}/inspections/{name}"

    def make(self, binary):
        if not os.path.exists(self.scene + "/meta_data.json"):
            run([binary, "synthesize", self.part, "--out", self.scene, "-q", "--seed",
                 str(self.seed)] + VIEWS + CONDITIONS[self.condition])
        if not os.path.exists(self.result + "/sketch.json"):
            run([binary, "reconstruct", self.scene, "--out", self.result, "-q", "--overlays", "0"],
                (0, 4))
        return os.path.exists(self.result + "/sketch.json")

    def inspect(self, binary, measured, nominal, name, tolerance, options=()):
        """inspection.json of a sketch against a nominal part, best fit."""
        out = f"{self.inspections}/{name}"
        run([binary, "inspect", measured, "--nominal", nominal, "--tolerance", str(tolerance),
             "--scale", "1", "--overlays", "0", "-q", "--out", out] + list(options), (0, 7))
        with open(out + "/inspection.json") as file:
            return json.load(file)


def places_of(scene, binary):
    """How far every place is off, and what was known about it: a row of numbers a place."""
    scene.inspect(binary, scene.result, scene.truth, "places", 0.001, ["--places"])
    rows, counts = [], {}
    with open(scene.inspections + "/places/inspection_places.csv") as file:
        for row in csv.DictReader(file):
            if row["presence"] != "found":
                continue
            counts[row["edge"]] = counts.get(row["edge"], 0) + 1
            rows.append((row["edge"], [float(row["kind"] == "line")] + [float(row[c]) for c in (
                "u", "v", "var_u", "cov_uv", "var_v", "bend_u", "bend_v", "footprint", "sigma",
                "bias_px", "view_bias_px")]))
    return [[1 / counts[edge]] + values for edge, values in rows]  # an edge counts once


# SigmaOptions, where the fit starts.
START = {"straight_factor": 0.6, "straight_power": 0.6, "curved_factor": 0.8, "curved_power": 0.6,
         "place_px": 0.003, "place_of_views": 0.2, "curvature_px2": 1.0, "tail_share": 0.1,
         "straight_tail": 3, "curved_tail": 3}


def log_likelihood(p, x):
    """Mean over edges of the log density of a place, as SigmaModel states it."""
    weight, line, u, v, var_u, cov, var_v, bend_u, bend_v, footprint, sigma, bias, views = x.T
    of_kind = lambda name: np.where(line > 0, p["straight_" + name], p["curved_" + name])
    ratio = np.maximum(bias, 0.004) * footprint / sigma
    factor2 = (of_kind("factor") * ratio ** of_kind("power")) ** 2
    place2 = footprint ** 2 * (p["place_px"] ** 2 + (p["place_of_views"] * views) ** 2)
    bend2 = p["curvature_px2"] ** 2
    a = factor2 * var_u + place2 + bend2 * bend_u ** 2
    b = factor2 * cov + bend2 * bend_u * bend_v
    c = factor2 * var_v + place2 + bend2 * bend_v ** 2
    det = a * c - b * b
    q = (c * u ** 2 - 2 * b * u * v + a * v ** 2) / det
    wide2 = of_kind("tail") ** 2
    narrow = np.log1p(-p["tail_share"]) - 0.5 * q - 0.5 * np.log(det)
    wide = np.log(p["tail_share"]) - 0.5 * q / wide2 - 0.5 * np.log(det) - np.log(wide2)
    return np.sum(weight * np.logaddexp(narrow, wide)) / np.sum(weight)


def fit(sets):
    """Each parameter in turn, in steps that get smaller; the conditions count alike."""
    likelihood = lambda p: np.mean([log_likelihood(p, x) for x in sets])
    best, value = dict(START), -np.inf
    for step in [1.6, 1.25, 1.1, 1.04, 1.015]:
        improved = True
        while improved:
            improved = False
            for name in START:
                for factor in (step, 1 / step):
                    trial = {**best, name: best[name] * factor}
                    usable = trial["tail_share"] < 0.5 and min(
                        trial["straight_tail"], trial["curved_tail"]) >= 1
                    there = likelihood(trial) if usable else -np.inf
                    if there > value + 1e-6:
                        best, value, improved = trial, there, True
    return best, value


def move(point, shift):
    return [p + s for p, s in zip(point, shift)]


def small_move(draw, kind, size, reach):
    """Matrix and shift of a random move: about `reach` at most within `size` of the middle. Kinds
    stay what they are: circles may turn and grow, the others deform."""
    even = lambda n: np.array([draw.uniform(-1, 1) for _ in range(n)])
    matrix = even(9).reshape(3, 3)
    if kind in ("circle", "arc"):
        matrix = (matrix - matrix.T) / 2 + draw.uniform(-1, 1) * np.eye(3)
    return np.eye(3) + matrix * reach / size, even(3) * reach


def moved_truth(truth, edges, reaches, seed, path):
    """The truth with every edge moved by itself, by up to its reach."""
    draw = random.Random(seed)
    with open(truth) as file:
        sketch = json.load(file)
    nodes, strokes = [], []
    for edge, reach in zip(edges, reaches):
        of_edge = [sketch["strokes"][c] for c in edge["curves"]]
        points = np.array([p for s in of_edge for p in
                           [sketch["nodes"][n] for n in s["nodes"]] + s["handles"][:1]])
        size = max(np.ptp(points, axis=0).max() / 2, edge["length"] / 7)
        matrix, shift = small_move(draw, edge["kind"], size, reach)
        place = lambda p: list(matrix @ (p - points.mean(axis=0)) + points.mean(axis=0) + shift)
        new = {}
        for stroke in of_edge:
            for node in stroke["nodes"]:
                if node not in new:
                    new[node] = len(nodes)
                    nodes.append(place(np.array(sketch["nodes"][node])))
            closed = stroke["kind"] in ("circle", "ellipse")  # all but the first handle are vectors
            handles = [list(matrix @ np.array(h)) if closed and k > 0 else place(np.array(h))
                       for k, h in enumerate(stroke["handles"])]
            strokes.append({"kind": stroke["kind"], "nodes": [new[n] for n in stroke["nodes"]],
                            "handles": handles})
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        json.dump({"format_version": 1, "nodes": nodes, "strokes": strokes}, file)


def known_edges(scene, binary, options):
    """(tolerance, P stated, is it so): what was measured lies within tolerance of what is there."""
    rows = []
    for tolerance in TOLERANCES:
        for e in scene.inspect(binary, scene.result, scene.truth, "known", tolerance,
                               options)["edges"]:
            if e["presence"] == "found":
                rows.append((tolerance, e["known"], e["largest"] <= tolerance))
    return rows


def judged_edges(scene, binary, options, draws):
    """(tolerance, P stated, is it so): what is there lies within tolerance of nominal."""
    rows = []
    edges = scene.inspect(binary, scene.truth, scene.truth, "truth", 0.001)["edges"]
    measured = scene.inspect(binary, scene.result, scene.truth, "known", 0.001, options)["edges"]
    sigmas = [np.hypot(e["sigma"] or 0, e["systematic"] or 0) for e in measured]
    for tolerance in TOLERANCES:
        for k in range(draws):
            nominal = f"{scene.inspections}/nominal/sketch.json"
            moved_truth(scene.truth, edges, [tolerance + 3 * s for s in sigmas],
                        f"{scene.part} {scene.seed} {tolerance} {k}", nominal)
            align = ["--align", "as-given"]  # a fit of parts that are off all over says little
            stated = scene.inspect(binary, scene.result, nominal, "stated", tolerance,
                                   options + align)
            true = scene.inspect(binary, scene.truth, nominal, "true", tolerance, align)
            for s, t in zip(stated["edges"], true["edges"]):
                if s["presence"] == "found" and t["presence"] == "found":
                    rows.append((tolerance, s["probability"], t["largest"] <= tolerance))
    return rows


def reliability(title, rows):
    """Prints a table by tenths; returns the worst difference among tenths of 50 edges and more."""
    p = np.array([r[1] for r in rows])
    y = np.array([r[2] for r in rows], float)
    print(f"\n{title}: {len(rows)} edges, {100 * y.mean():.1f} % within tolerance, "
          f"Brier {np.mean((p - y) ** 2):.4f} (base rate alone {np.mean((y.mean() - y) ** 2):.4f})")
    print("  P stated    edges  mean P  within  difference")
    worst = 0
    for k in range(10):
        at = (p >= k / 10) & ((p < (k + 1) / 10) | (k == 9))
        if not at.any():
            continue
        difference = y[at].mean() - p[at].mean()
        print(f"  {k / 10:.1f}-{(k + 1) / 10:.1f}  {at.sum():8d}  {p[at].mean():6.3f}  "
              f"{y[at].mean():6.3f}  {difference:+.3f}")
        if at.sum() >= 50:
            worst = max(worst, abs(difference))
    print(f"  largest difference of a tenth with 50 edges and more: {worst:.3f}")
    return worst


def report(condition, scenes, fitted, binary, options, draws):
    of = [s for s in scenes if s.condition == condition]
    for name, ask in [("known", lambda s: known_edges(s, binary, options)),
                      ("within", lambda s: judged_edges(s, binary, options, draws))]:
        rows = {s: ask(s) for s in of}
        everything = [r for s in of for r in rows[s]]
        for tolerance in TOLERANCES:
            reliability(f"{name}, {condition}, tolerance {1000 * tolerance:g} thousandths",
                        [r for r in everything if r[0] == tolerance])
        reliability(f"{name}, {condition}, all", everything)
        held = [r for s in of if s.part not in fitted for r in rows[s]]
        if held:
            reliability(f"{name}, {condition}, parts that were not fitted", held)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes, results and inspections")
    parser.add_argument("--seeds", type=int, default=1, help="of each part")
    parser.add_argument("--draws", type=int, default=2, help="of moved nominal parts")
    parser.add_argument("--parts", nargs="*", default=PARTS)
    parser.add_argument("--fit", action="store_true", help="fit, and use what was fitted")
    parser.add_argument("--scenes-only", action="store_true")
    arguments = parser.parse_args()
    binary = arguments.binary
    scenes = [Scene(arguments.work, part, condition, seed + 1) for condition in CONDITIONS
              for seed in range(arguments.seeds) for part in arguments.parts]
    scenes = [s for s in scenes if s.make(binary)]
    if arguments.scenes_only:
        return
    fitted = {part for part, use in zip(PARTS, FITTED) if use}
    options = []
    if arguments.fit:
        sets = [np.array([row for s in scenes if s.condition == condition and s.part in fitted
                          for row in places_of(s, binary)]) for condition in FITTED_CONDITIONS]
        best, value = fit(sets)
        print(f"log likelihood a place {value:.4f}: " +
              ", ".join(f"{n} {v:.3g}" for n, v in best.items()))
        path = arguments.work + "/calibration.json"
        with open(path, "w") as file:
            json.dump({n: float(f"{v:.3g}") for n, v in best.items()}, file, indent=1)
        options = ["--calibration", path]
    for condition in CONDITIONS:
        report(condition, scenes, fitted, binary, options, arguments.draws)


if __name__ == "__main__":
    main()
