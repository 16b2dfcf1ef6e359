#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits the coefficients of pipelines/survey/confidence.cc: which strokes are edges of the object.

Makes scenes of built-in parts under harmless and harmful conditions, reconstructs them, asks
`evaluate` which strokes are right (90 % of their length within 5 thousandths of a true edge), and
fits a logistic model to what report.json tells about every stroke. Every third part is held out:
the reliability table and the Brier score are of these alone. Scenes and results that are there
already are used again, so that a run may be stopped and started.

  eval/calibrate_confidence.py --binary build/pipelines/sketchsplat --work DIR [--scenes-only]
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys

import numpy as np

PARTS = """box box-hole plate-holes stepped-shaft l-bracket pocket-block box-fillet box-chamfer
slotted-sheet cut-cylinder hex-nut dome-plate flange tee tray bent-sheet fillet-block fillet-step
ridge-block countersunk-plate ellipse-plate boss-plate slot-disc knob elbow ball-stud cross-drilled
spline-plate wave-block freeform-pad""".split()

# Options of synthesize. Every part is seen under each of them.
CONDITIONS = {
    "plain": "--views 24 --noise 3",
    "textured": "--views 20 --noise 3 --style textured",
    "few": "--views 8 --noise 3",
    "glossy": "--views 14 --noise 6 --style glossy --rig upper",
    "poses": "--views 16 --noise 4 --style shadowed --pose-noise 0.6",
}


def run(arguments):
    return subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def make_scene(binary, folder, part, condition, seed):
    if os.path.exists(folder + "/meta_data.json"):
        return
    command = [binary, "synthesize", part, "--out", folder, "-q", "--outputs", "none",
               "--resolution", "320", "--seed", str(seed)]
    done = run(command + CONDITIONS[condition].split())
    if done.returncode != 0:
        sys.exit(done.stderr)


def strokes_of(binary, scene, result):
    """Rows of numbers of the strokes that were found, with "right"; none if nothing was found."""
    if not os.path.exists(result + "/strokes.csv"):
        done = run([binary, "reconstruct", scene, "--out", result, "-q", "--overlays", "0",
                    "--min-confidence", "0"])
        if done.returncode == 4:  # too little in the scene
            return []
        if done.returncode != 0:
            sys.exit(done.stderr)
        done = run([binary, "evaluate", "--pred", result, "--gt", scene, "--out", result])
        if done.returncode != 0:
            sys.exit(done.stderr)
    with open(result + "/report.json") as file:
        rows = json.load(file)["strokes"]
    with open(result + "/strokes.csv") as file:
        share = {row["stroke"]: float(row["share"]) for row in csv.DictReader(file)}
    for row in rows:
        row["right"] = share[str(int(row["curve"]))] >= 90
    return rows


def columns(row):
    """What the model may choose from: name -> number. confidence.cc computes the same."""
    log = math.log2
    return {
        "log_views": log(1 + row["views"]),
        "view_share": row["view_share"],
        "cover": row["cover"],
        "support": row["support"],
        "rms": min(row["rms_px"], 1),
        "bias": min(row["bias_px"], 0.5),
        "still": row["still"],
        "log_scatter": log(min(max(row["scatter"], 0.25), 4)),
        "log_width": log(min(max(row["width"], 0.5), 2)),
        "log_contrast": log(min(max(row["contrast"], 0.03125), 4)),
        "outline": row["outline"],
        "log_length": log(min(max(row["length_px"], 1), 256)),
        "joined": row["joined"],
        "log_sigma": log(min(max(row["sigma"], 2.0 ** -5), 32)),
        "determined": row["determined"],
    }


def fit(x, y, weight, ridge=1.0):
    """Logistic regression by Newton's method; x with its constant in the last column."""
    held = ridge * np.eye(x.shape[1])
    held[-1, -1] = 1e-6
    w = np.zeros(x.shape[1])
    for _ in range(60):
        p = 1 / (1 + np.exp(-x @ w))
        step = np.linalg.solve((x.T * (weight * p * (1 - p))) @ x + held,
                               x.T @ (weight * (y - p)) - held @ w)
        w += step
        if np.abs(step).max() < 1e-9:
            break
    return w


def log_loss(p, y, weight):
    p = np.clip(p, 1e-6, 1 - 1e-6)
    return -np.average(y * np.log(p) + (1 - y) * np.log(1 - p), weights=weight)


def predict(x, w):
    return 1 / (1 + np.exp(-x @ w))


def with_constant(x):
    return np.hstack([x, np.ones((len(x), 1))])


def choose(x, y, weight, part, names, most):
    """Forward selection by the log loss over parts that were left out, five groups of parts."""
    groups = part % 5
    scale = x.std(axis=0) + 1e-12
    z = (x - x.mean(axis=0)) / scale

    def crossed(chosen):
        p = np.zeros(len(y))
        for g in range(5):
            train, test = groups != g, groups == g
            p[test] = predict(with_constant(z[test][:, chosen]),
                              fit(with_constant(z[train][:, chosen]), y[train], weight[train]))
        return log_loss(p, y, weight)

    chosen, best = [], log_loss(np.full(len(y), np.average(y, weights=weight)), y, weight)
    print(f"  log loss over left-out parts, base rate alone: {best:.4f}")
    while len(chosen) < most:
        losses = {k: crossed(chosen + [k]) for k in range(len(names)) if k not in chosen}
        k = min(losses, key=losses.get)
        if losses[k] > 0.99 * best:  # not worth a number
            break
        chosen.append(k)
        best = losses[k]
        print(f"  + {names[k]:13s} {best:.4f}")
    w = fit(with_constant(z[:, chosen]), y, weight)
    w[-1] -= np.sum(w[:-1] * x.mean(axis=0)[chosen] / scale[chosen])
    w[:-1] /= scale[chosen]
    return chosen, w


def report(title, p, y):
    print(f"\n{title}: {len(y)} strokes, {100 * y.mean():.1f} % right, "
          f"Brier {np.mean((p - y) ** 2):.4f} (base rate alone {np.mean((y.mean() - y) ** 2):.4f})")
    print("  confidence  strokes  mean confidence  right")
    edges = [0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0001]
    for low, high in zip(edges, edges[1:]):
        at = (p >= low) & (p < high)
        if at.any():
            print(f"  {low:4.2f}-{min(high, 1):4.2f}  {at.sum():7d}  {p[at].mean():15.3f}  "
                  f"{y[at].mean():5.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--most", type=int, default=5, help="features that the model may use")
    parser.add_argument("--scenes-only", action="store_true")
    arguments = parser.parse_args()
    rows, right, part, condition_of, stated = [], [], [], [], []
    for condition in CONDITIONS:
        for k, name in enumerate(PARTS):
            scene = f"{arguments.work}/scenes/{name}.{condition}"
            make_scene(arguments.binary, scene, name, condition, k + 1)
            if arguments.scenes_only:
                continue
            result = f"{arguments.work}/results/{name}.{condition}"
            for row in strokes_of(arguments.binary, scene, result):
                rows.append(columns(row))
                right.append(row["right"])
                stated.append(row.get("confidence", math.nan))
                part.append(k)
                condition_of.append(condition)
    if arguments.scenes_only:
        return
    names = list(rows[0])
    x = np.array([[row[n] for n in names] for row in rows])
    y, part = np.array(right, float), np.array(part)
    stated, condition_of = np.array(stated), np.array(condition_of)
    held = part % 3 == 2
    print(f"{len(y)} strokes of {len(PARTS)} parts under {len(CONDITIONS)} conditions, "
          f"{100 * y.mean():.1f} % right; parts held out: "
          + " ".join(p for k, p in enumerate(PARTS) if k % 3 == 2))
    for condition in CONDITIONS:
        at = condition_of == condition
        print(f"  {condition:9s} {at.sum():5d} strokes, {100 * y[at].mean():.1f} % right")
    # Prints are many strokes: every condition has the same weight.
    weight = np.zeros(len(y))
    for condition in CONDITIONS:
        at = condition_of == condition
        weight[at] = len(y) / (len(CONDITIONS) * at.sum())
    for title, usable in [("WITH MASKS", names),
                          ("WITHOUT MASKS", [n for n in names if n != "outline"])]:
        print(f"\n{title}")
        columns_of = [names.index(n) for n in usable]
        chosen, w = choose(x[~held][:, columns_of], y[~held], weight[~held], part[~held], usable,
                           arguments.most)
        p = predict(with_constant(x[:, columns_of][:, chosen]), w)
        report("held-out parts", p[held], y[held])
        for condition in CONDITIONS:
            at = held & (condition_of == condition)
            print(f"  {condition:9s} Brier {np.mean((p[at] - y[at]) ** 2):.4f} "
                  f"(base rate alone {np.mean((y[at].mean() - y[at]) ** 2):.4f})")
        print("  coefficients: " + ", ".join(f"{usable[k]} {value:.3f}"
                                             for k, value in zip(chosen, w)) +
              f", constant {w[-1]:.3f}")
    if np.isfinite(stated).all():
        report("\nSTATED by the program, held-out parts", stated[held], y[held])


if __name__ == "__main__":
    main()
