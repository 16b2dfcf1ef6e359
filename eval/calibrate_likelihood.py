#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Estimates how wide views show edges and rounds: the table of pipelines/survey/round_judge.h.

Makes scenes of built-in parts with sharp and with rounded edges, reconstructs them without telling
rounds from edges (so that rounds are drawn, too), and asks `evaluate` which strokes are edges: 95 %
of their length within 5 thousandths of a true one; rounds are those strokes of rounded parts of
which no more than 5 % is. report.json tells in how many views each shows narrower than most edges,
as wide, wider and much wider. Every third part is held out, its likelihoods are printed.

The judge takes the views of one stroke for independent. They are not quite: as how large a share of
independent ones they count is printed, too. Scenes and results that are there already are used
again.

  eval/calibrate_likelihood.py --binary build/pipelines/sketchsplat --work DIR
"""

import argparse
import csv
import json
import os
import subprocess
import sys

import numpy as np

SHARP = """box-hole knob plate-holes stepped-shaft boss-plate hex-nut dome-plate flange ridge-block
keyed-hub box-chamfer cross-drilled""".split()
ROUNDED = "cast-bracket blend-step cast-flange taper-block".split()
ROUNDS = [0.06, 0.035, 0.02]  # of the longest side: 12, 7 and 4 pixels
CONDITIONS = {"plain": "--noise 0", "noise": "--noise 3", "even": "--even-light 0.7 --noise 2"}
CLASSES = ["views_narrow", "views_as_wide", "views_wide", "views_wider"]


def run(arguments):
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 4):  # 4: too little in the scene
        sys.exit(done.stderr)


def strokes_of(arguments, name, part, condition, more):
    """Share of each stroke that is an edge, and its numbers of views by class."""
    scene, result = f"{arguments.work}/scenes/{name}", f"{arguments.work}/results/{name}"
    if not os.path.exists(scene + "/meta_data.json"):
        run([arguments.binary, "synthesize", part, "--out", scene, "-q", "--outputs", "none",
             "--views", "24", "--resolution", "400", "--object-size", "0.5"] +
            CONDITIONS[condition].split() + more)
    if not os.path.exists(result + "/strokes.csv"):
        run([arguments.binary, "reconstruct", scene, "--out", result, "-q", "--overlays", "0",
             "--least-round", "1000000", "--min-confidence", "0",
             "--threads", str(arguments.threads)])
        if not os.path.exists(result + "/report.json"):
            return
        run([arguments.binary, "evaluate", "--pred", result, "--gt", scene, "--out", result])
    with open(result + "/report.json") as file:
        rows = json.load(file)["strokes"]
    with open(result + "/strokes.csv") as file:
        share = {row["stroke"]: float(row["share"]) for row in csv.DictReader(file)}
    for row in rows:
        yield share[str(int(row["curve"]))], [row[c] for c in CLASSES]


def shares_of(counts):
    pooled = counts.sum(0) + 0.5
    return pooled / pooled.sum()


def witnesses(counts, shares):
    """As how large a share of independent views those of one stroke count."""
    n = counts.sum(1)
    counts, n = counts[n > 1], n[n > 1, None]
    inflation = ((counts - n * shares) ** 2 / (n * shares)).sum(1).mean() / (len(shares) - 1)
    return min(1, 1 / inflation)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    scenes = [(part, c, []) for part in SHARP for c in CONDITIONS]
    scenes += [(part, c, ["--param", f"round={r}"])
               for part in ROUNDED for c in CONDITIONS for r in ROUNDS]
    rows = []  # is it an edge, is it held out, views by class
    for part, condition, more in scenes:
        name = ".".join([part, condition] + [m.replace("=", "") for m in more[1:]])
        held = (SHARP + ROUNDED).index(part) % 3 == 2
        for share, views in strokes_of(arguments, name, part, condition, more):
            if share >= 95 or (share <= 5 and part in ROUNDED):
                rows.append([share >= 95, held] + views)
    table = np.array(rows, float)
    edge, held, views = table[:, 0] == 1, table[:, 1] == 1, table[:, 2:]
    of_edges, of_rounds = shares_of(views[edge & ~held]), shares_of(views[~edge & ~held])
    count = witnesses(views[edge & ~held], of_edges)
    print(f"{edge.sum()} edges, {(~edge).sum()} rounds of {len(scenes)} scenes")
    for name, shares in [("edge_widths", of_edges), ("round_widths", of_rounds)]:
        print(f"  WidthShares {name} = {{{', '.join(f'{s:.3f}' for s in shares)}}};")
    print(f"views of one edge count as {count:.2f} of as many independent ones")
    nats = views @ np.log(of_rounds / of_edges)
    for name, at in [("edges", edge & held), ("rounds", ~edge & held)]:
        if at.any():
            quantiles = np.quantile(nats[at], [0.05, 0.25, 0.5, 0.75, 0.95])
            print(f"held out: {at.sum()} {name}, nats of a round at 5, 25, 50, 75, 95 %: " +
                  " ".join(f"{q:.1f}" for q in quantiles))


if __name__ == "__main__":
    main()
