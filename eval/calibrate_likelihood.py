#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Estimates how wide views show edges and rounds: the tables of pipelines/survey/round_judge.h.

Makes scenes of built-in parts with sharp and with rounded edges, reconstructs them without telling
rounds from edges (so that rounds are drawn, too), and asks `evaluate` which strokes are edges: 95 %
of their length within 5 thousandths of a true one; rounds are those strokes of rounded parts of
which no more than 5 % is. report.json tells in how many views each shows narrower than most edges,
as wide, wider and much wider. The rates differ from stroke to stroke: the parameters of their
Dirichlet distributions are those of the highest likelihood. Every third part is held out, its
likelihood ratios are printed.

With --reliability, reconstructs scenes like those of the suites `faint` and `rounded` as usual
instead, and prints how reliable the confidence of strokes is: of those of each tenth, the share
that is right (90 % of the length within 5 thousandths), and the Brier score.

Scenes and results that are there already are used again.

  eval/calibrate_likelihood.py --binary build/pipelines/sketchsplat --work DIR [--reliability]
"""

import argparse
import csv
import json
import os
import subprocess
import sys

import numpy as np
from scipy.optimize import minimize
from scipy.special import gammaln

SHARP = """box-hole knob plate-holes stepped-shaft boss-plate hex-nut dome-plate flange ridge-block
keyed-hub box-chamfer cross-drilled""".split()
ROUNDED = "cast-bracket blend-step cast-flange taper-block".split()
ROUNDS = [0.06, 0.035, 0.02]  # of the longest side: 12, 7 and 4 pixels
CONDITIONS = {"plain": "--noise 0", "noise": "--noise 3", "even": "--even-light 0.7 --noise 2"}
FAINT = "countersunk-plate plate-holes pocket-block corner-block boss-plate pleat-block".split()
FAINT_CONDITIONS = {"faint": "--even-light 0.9 --noise 0.5", "noisy": "--even-light 0.9 --noise 3",
                    "fainter": "--even-light 0.97 --noise 0.5"}
CLASSES = ["views_narrow", "views_as_wide", "views_wide", "views_wider"]


def run(arguments):
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 4):  # 4: too little in the scene
        sys.exit(done.stderr)


def strokes_of(arguments, name, part, synthesize, reconstruct):
    """Share of each stroke that is an edge, and what report.json tells of it."""
    scene, result = f"{arguments.work}/scenes/{name}", f"{arguments.work}/results/{name}"
    if reconstruct:  # other than usual
        result += ".all"
    if not os.path.exists(scene + "/meta_data.json"):
        run([arguments.binary, "synthesize", part, "--out", scene, "-q", "--outputs", "none",
             "--views", "24", "--resolution", "400", "--object-size", "0.5"] + synthesize)
    if not os.path.exists(result + "/strokes.csv"):
        run([arguments.binary, "reconstruct", scene, "--out", result, "-q", "--overlays", "0",
             "--min-confidence", "0", "--threads", str(arguments.threads)] + reconstruct)
        if not os.path.exists(result + "/report.json"):
            return []
        run([arguments.binary, "evaluate", "--pred", result, "--gt", scene, "--out", result])
    with open(result + "/report.json") as file:
        rows = json.load(file)["strokes"]
    with open(result + "/strokes.csv") as file:
        share = {row["stroke"]: float(row["share"]) for row in csv.DictReader(file)}
    return [(share[str(int(row["curve"]))], row) for row in rows]


def log_likelihood(rates, counts):
    """Of each row of counts, Dirichlet-multinomial, but for what depends on the counts alone."""
    n = counts.sum(-1)
    return (gammaln(rates.sum()) - gammaln(rates.sum() + n) +
            (gammaln(rates + counts) - gammaln(rates)).sum(-1))


def rates_of(counts):
    """The likeliest ones; the logarithms have a wide normal prior."""
    def badness(logs):
        return 0.01 * (logs ** 2).sum() - log_likelihood(np.exp(logs), counts).sum()
    return np.exp(minimize(badness, np.zeros(counts.shape[1])).x)


def calibrate(arguments):
    sharp, rounded, rounds, conditions = SHARP, ROUNDED, ROUNDS, list(CONDITIONS)
    if arguments.quick:
        sharp, rounded, rounds, conditions = ["box-hole"], ["blend-step"], [0.06], ["plain"]
    scenes = [(part, c, []) for part in sharp for c in conditions]
    scenes += [(part, c, ["--param", f"round={r}"])
               for part in rounded for c in conditions for r in rounds]
    rows = []  # is it an edge, is it held out, views by class
    for part, condition, more in scenes:
        name = ".".join([part, condition] + [m.replace("=", "") for m in more[1:]])
        held = (sharp + rounded).index(part) % 3 == 2
        for share, row in strokes_of(arguments, name, part, CONDITIONS[condition].split() + more,
                                     ["--least-round", "1000000"]):
            if share >= 95 or (share <= 5 and part in rounded):
                rows.append([share >= 95, held] + [row[c] for c in CLASSES])
    table = np.array(rows, float)
    edge, held, views = table[:, 0] == 1, table[:, 1] == 1, table[:, 2:]
    print(f"{edge.sum()} edges, {(~edge).sum()} rounds of {len(scenes)} scenes")
    of_edges, of_rounds = rates_of(views[edge & ~held]), rates_of(views[~edge & ~held])
    for name, rates in [("edge_widths", of_edges), ("round_widths", of_rounds)]:
        print(f"  WidthRates {name} = {{{', '.join(f'{r:.2f}' for r in rates)}}};")
    nats = log_likelihood(of_rounds, views) - log_likelihood(of_edges, views)
    for name, at in [("edges", edge & held), ("rounds", ~edge & held)]:
        if at.any():
            quantiles = np.quantile(nats[at], [0.05, 0.25, 0.5, 0.75, 0.95])
            print(f"held out: {at.sum()} {name}, nats of a round at 5, 25, 50, 75, 95 %: " +
                  " ".join(f"{q:.1f}" for q in quantiles))


def reliability(arguments):
    parts, rounds = ROUNDED, ROUNDS
    if arguments.quick:
        parts, rounds = ["blend-step"], [0.06]
    scenes = [(part, c, ["--param", f"round={r}"])
              for part in parts for c in CONDITIONS for r in rounds]
    scenes += [(part, c, []) for part in FAINT for c in FAINT_CONDITIONS]
    if arguments.quick:
        scenes = scenes[:1]
    rows = []
    for part, condition, more in scenes:
        name = ".".join([part, condition] + [m.replace("=", "") for m in more[1:]])
        options = {**CONDITIONS, **FAINT_CONDITIONS}[condition].split()
        rows += [(share >= 90, row["confidence"])
                 for share, row in strokes_of(arguments, name, part, options + more, [])]
    right, stated = np.array(rows, float).T
    print(f"{len(right)} strokes of {len(scenes)} scenes, {100 * right.mean():.1f} % right, "
          f"Brier score {((right - stated) ** 2).mean():.3f}\n")
    print("| confidence | strokes | mean confidence | right |\n|---|---|---|---|")
    tenth, off = np.minimum((10 * stated).astype(int), 9), 0
    for k in np.unique(tenth):
        at = tenth == k
        off += at.mean() * abs(stated[at].mean() - right[at].mean())
        print(f"| {k / 10:.1f} to {(k + 1) / 10:.1f} | {at.sum()} | {stated[at].mean():.3f} | "
              f"{right[at].mean():.3f} |")
    print(f"\nmean difference of the two, weighted by strokes: {off:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--reliability", action="store_true", help="of the confidence, instead")
    parser.add_argument("--quick", action="store_true", help="a scene or two, to see that it runs")
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    (reliability if arguments.reliability else calibrate)(arguments)


if __name__ == "__main__":
    main()
