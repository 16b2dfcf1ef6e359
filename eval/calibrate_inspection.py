#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits SigmaOptions of eval/inspect/sigma_model.h and says how far the probabilities of `inspect`
can be relied on.

Makes scenes of the built-in parts (24 views of 400 x 400 px) with exact poses and with poses that
err as those that a tracker finds in photographs, and reconstructs them. Of the parts drawn by the
seeds of --fit-seeds it takes how far every curve is from the truth, and fits the numbers so that it
surprises least (--fit; written to WORK/calibration.json). Then it asks of the other seeds, by
tenths of what is stated,

 - known: how often what was measured lies within the tolerance of the truth;
 - within: every second edge of the truth is moved by up to three tolerances, and that is taken as
   nominal. How often is the truth, inspected by the same program, within tolerance, of the edges of
   which the result says so with that probability?

Scenes and results that are there already are used again: a run may be stopped and started.

  eval/calibrate_inspection.py --binary build/pipelines/sketchsplat --work DIR [--fit]
"""

import argparse
import concurrent.futures
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

VIEWS = "--views 24 --resolution 400 --object-size 0.7 --noise 3 --outputs none".split()
CONDITIONS = {"exact poses": [], "poses off by 0.2 px": ["--pose-noise", "0.2"],
              "poses off by 0.5 px": ["--pose-noise", "0.5"]}
TOLERANCES = [0.0002, 0.0005, 0.001]  # of the longest side, which is 1


def run(arguments, allowed=(0,)):
    done = subprocess.run(arguments, env={**os.environ, "OMP_NUM_THREADS": "1"},
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
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


def pieces_of(scene, binary):
    """How far every edge is off at some places, and what was known about it."""
    scene.inspect(binary, scene.result, scene.truth, "pieces", 0.001, ["--pieces"])
    with open(scene.inspections + "/pieces/inspection_pieces.json") as file:
        pieces = [p for p in json.load(file)["pieces"] if p["presence"] == "found"]
    return [p for p in pieces if len(p["deviation"]) == 2 * PLACES and p["sigma"] > 0]


PLACES = 5  # of a piece
NORMAL = np.random.default_rng(1).standard_normal((400, 2 * PLACES))  # draws of its errors
REACHES = np.array([0.1, 0.2, 0.35, 0.5, 0.75, 1, 1.5, 2.5]) / 1000
FLOOR_PX = 0.003
SIZES = np.array([0.15, 0.25, 0.4, 0.63, 1, 1.6, 2.5, 4, 6.3])  # kErrorSizes
KINDS = ["straight", "closed", "arc", "free"]  # of_kind() of sigma_model.h
KIND_OF = {"line": 0, "circle": 1, "ellipse": 1, "arc": 2, "elliptic_arc": 3, "bezier": 3}
SEEN = 2  # errors of a kind that were met of each size already
LEAST_GAIN = 2e-5  # of the mean log probability of an event

# SigmaOptions, where the fit starts, without the shares of sizes.
START = {"place_px": 0.0008, "curvature_px2": 0.2, "curvature_sigma_px2": 0.5,
         "dark_side_px": 0.03, "straight_form_px": 0.25, "form_px": 0.14,
         "straight_factor": 0.1, "straight_power": 1, "straight_place": 0.6, "straight_views": 0.3,
         "closed_factor": 0.6, "closed_power": 1, "closed_place": 0.3, "closed_views": 0.05,
         "arc_factor": 0.5, "arc_power": 0.3, "arc_place": 0.1, "arc_views": 0.06,
         "free_factor": 1, "free_power": 0.3, "free_place": 0.1, "free_views": 0.06}


def form_errors():
    """Covariance of form_errors() of sigma_model.cc along any axis: places x places, doubled."""
    u = np.arange(PLACES) / (PLACES - 1)
    columns = np.full((PLACES, 5), 0.5)
    for k in range(4):
        columns[:, k] = np.cos((k + 1) * np.pi * u) / 2
    return (columns @ columns.T).repeat(2, axis=0).repeat(2, axis=1)


FORM = form_errors()


def arrays_of(pieces):
    n = 2 * PLACES
    of = lambda key: np.array([p[key] for p in pieces], float)
    shift = of("shift").reshape(-1, n, 3)
    return {"kind": np.array([KIND_OF[p["kind"]] for p in pieces]), "simpler": of("simpler"),
            "deviation": of("deviation"), "covariance": of("covariance").reshape(-1, n, n),
            "shift": shift @ shift.transpose(0, 2, 1), "bend": of("bend"),
            "footprint": of("footprint"), "sigma": of("sigma"),
            "bias": of("bias_px"), "views": of("view_bias_px")}


def by_size(p, x):
    """pieces x reaches x sizes: that the largest error is within a reach if errors have a size."""
    of_kind = lambda name: np.array([p[f"{kind}_{name}"] for kind in KINDS])[x["kind"]]
    px2 = x["footprint"] ** 2
    ratio = np.maximum(x["bias"], 0.004) * x["footprint"] / x["sigma"]
    own = (of_kind("factor") * ratio ** of_kind("power")) ** 2
    place = px2 * ((of_kind("place") * x["bias"]) ** 2 + (of_kind("views") * x["views"]) ** 2 +
                   p["place_px"] ** 2)
    bend = p["curvature_sigma_px2"] * x["bend"]
    of_place = np.linalg.norm(x["bend"].reshape(-1, PLACES, 2), axis=2).repeat(2, axis=1)
    inwards = np.divide(x["bend"], of_place, out=np.zeros_like(x["bend"]), where=of_place > 0)
    dark = p["dark_side_px"] * x["footprint"][:, None] * inwards
    form = np.where(x["kind"] == 0, p["straight_form_px"], p["form_px"]) * x["simpler"]
    v = (own[:, None, None] * x["covariance"] + place[:, None, None] * x["shift"] +
         bend[:, :, None] * bend[:, None, :] + dark[:, :, None] * dark[:, None, :] +
         (form ** 2 * px2)[:, None, None] * FORM * x["shift"] +
         (FLOOR_PX ** 2 * px2)[:, None, None] * np.eye(2 * PLACES))
    draws = NORMAL @ np.linalg.cholesky(v).transpose(0, 2, 1)
    largest = np.sort(np.sqrt((draws[:, :, ::2] ** 2 + draws[:, :, 1::2] ** 2).max(axis=2)))
    within = REACHES[:, None] / SIZES
    return np.array([np.searchsorted(row, within, side="right") / len(row) for row in largest])


def happened(p, x):
    """pieces x reaches: is the largest error within a reach?"""
    off = x["deviation"] - p["curvature_px2"] * x["bend"]
    return np.hypot(off[:, ::2], off[:, 1::2]).max(axis=1)[:, None] <= REACHES


def shares_of(events):
    """kinds x sizes: the likeliest shares, by the EM algorithm."""
    shares = np.full((len(KINDS), len(SIZES)), 1 / len(SIZES))
    for kind in range(len(KINDS)):
        chances = np.concatenate([
            np.where(there[k == kind][:, :, None], chance[k == kind], 1 - chance[k == kind])
            .reshape(-1, len(SIZES)) for chance, there, k in events])
        chances = np.clip(chances, 1e-4, 1)
        for _ in range(80):
            of_each = chances * shares[kind]
            counts = (of_each / of_each.sum(axis=1, keepdims=True)).sum(axis=0) + SEEN
            shares[kind] = counts / counts.sum()
    return shares


def score(p, sets):
    """Mean log probability of what is the case, the conditions count alike; the shares of sizes."""
    events = [(by_size(p, x), happened(p, x), x["kind"]) for x in sets]
    shares = shares_of(events)
    means = []
    for chance, there, kind in events:
        stated = np.clip((chance * shares[kind][:, None, :]).sum(axis=2), 0.003, 0.997)
        means.append(np.where(there, np.log(stated), np.log(1 - stated)).mean())
    return np.mean(means), shares


def fit(sets):
    """Each parameter in turn, in steps that get smaller."""
    best, value = dict(START), score(START, sets)[0]
    for step in [1.6, 1.25, 1.1]:
        for _ in range(5):
            before = value
            for name in START:
                for factor in (step, 1 / step):
                    trial = {**best, name: best[name] * factor}
                    there = score(trial, sets)[0]
                    if there > value + LEAST_GAIN:
                        best, value = trial, there
            if value == before:
                break
    value, shares = score(best, sets)
    for kind, row in zip(KINDS, shares):
        for k, share in enumerate(row):
            best[f"{kind}_share_{k}"] = share
    return best, value


def move(point, shift):
    return [p + s for p, s in zip(point, shift)]


def moved_truth(truth, edges, tolerance, seed, path):
    """The truth with every second edge moved as a whole, by up to three tolerances."""
    draw = random.Random(seed)
    with open(truth) as file:
        sketch = json.load(file)
    nodes, strokes = [], []
    for edge in edges:
        shift = np.array([draw.gauss(0, 1) for _ in range(3)])
        shift *= draw.choice([0, 3]) * tolerance * draw.random() / np.linalg.norm(shift)
        new = {}
        for stroke in [sketch["strokes"][c] for c in edge["curves"]]:
            for node in stroke["nodes"]:
                if node not in new:
                    new[node] = len(nodes)
                    nodes.append(move(sketch["nodes"][node], shift))
            closed = stroke["kind"] in ("circle", "ellipse")  # all but the first handle are vectors
            handles = [h if closed and k > 0 else move(h, shift)
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
    for tolerance in TOLERANCES:
        for k in range(draws):
            nominal = f"{scene.inspections}/nominal/sketch.json"
            moved_truth(scene.truth, edges, tolerance,
                        f"{scene.part} {scene.seed} {tolerance} {k}", nominal)
            stated = scene.inspect(binary, scene.result, nominal, "stated", tolerance, options)
            true = scene.inspect(binary, scene.truth, nominal, "true", tolerance)
            for s, t in zip(stated["edges"], true["edges"]):
                if s["presence"] == "found" and t["presence"] == "found":
                    rows.append((tolerance, s["probability"], t["largest"] <= tolerance))
    return rows


def reliability(title, rows):
    """Prints a table by tenths, and the worst difference among tenths of 50 edges and more."""
    if not rows:
        return
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


def of_each(scenes, ask):
    """ask(scene) of all, a process of one thread per core."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(ask, scenes))


def report(condition, scenes, binary, options, draws):
    """The tables of one condition; its rows by name."""
    out = {}
    of = [s for s in scenes if s.condition == condition]
    for name, ask in [("known", lambda s: known_edges(s, binary, options)),
                      ("within", lambda s: judged_edges(s, binary, options, draws))]:
        everything = [row for rows in of_each(of, ask) for row in rows]
        for tolerance in TOLERANCES:
            reliability(f"{name}, {condition}, tolerance {1000 * tolerance:g} thousandths",
                        [r for r in everything if r[0] == tolerance])
        reliability(f"{name}, {condition}, all", everything)
        out[name] = everything
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes, results and inspections")
    parser.add_argument("--seeds", type=int, nargs="*", default=[1], help="of the parts asked of")
    parser.add_argument("--fit-seeds", type=int, nargs="*", default=[11], help="of those fitted to")
    parser.add_argument("--draws", type=int, default=1, help="of moved nominal parts")
    parser.add_argument("--parts", nargs="*", default=PARTS)
    parser.add_argument("--conditions", nargs="*", default=list(CONDITIONS))
    parser.add_argument("--fit", action="store_true", help="fit, and use what was fitted")
    parser.add_argument("--scenes-only", action="store_true")
    arguments = parser.parse_args()
    binary = arguments.binary
    conditions = [c for c in CONDITIONS if c in arguments.conditions]

    def made(seeds):
        scenes = [Scene(arguments.work, part, condition, seed) for condition in conditions
                  for seed in seeds for part in arguments.parts]
        there = of_each(scenes, lambda scene: scene.make(binary))
        return [scene for scene, made in zip(scenes, there) if made]

    scenes, fitted = made(arguments.seeds), made(arguments.fit_seeds) if arguments.fit else []
    if arguments.scenes_only:
        return
    options = []
    if arguments.fit:
        sets = [arrays_of([piece for s in fitted if s.condition == condition
                           for piece in pieces_of(s, binary)]) for condition in conditions]
        best, value = fit(sets)
        print(f"log probability of an event {value:.4f}: " +
              ", ".join(f"{n} {v:.3g}" for n, v in best.items()))
        path = arguments.work + "/calibration.json"
        with open(path, "w") as file:
            json.dump({n: round(v, 4) for n, v in best.items()}, file, indent=1)
        options = ["--calibration", path]
    of_all = [report(condition, scenes, binary, options, arguments.draws)
              for condition in conditions]
    for name in ("known", "within"):
        reliability(f"{name}, all conditions", [row for of in of_all for row in of[name]])


if __name__ == "__main__":
    main()
