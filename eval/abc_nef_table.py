#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The ABC-NEF table as papers print it, of one or more methods.

usage: abc_nef_table.py --gt SCENES [--binary sketchsplat] [--protocol emap] [--missing skip]
                        [--latex] NAME=RESULTS [NAME=RESULTS ...]

SCENES holds a folder per scene with its ground truth; RESULTS a result per scene, called like it
(folder, .json, .obj or .ply of any method that `sketchsplat evaluate` reads). Scenes without a
result count as zero unless --missing skip. Acc and Comp: thousandths of the object's longest side;
R, P, F at 5, 10 and 20 thousandths: per cent; all are means over the scenes.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

COLUMNS = [("Acc", "acc"), ("Comp", "comp")] + [
    (letter + at, letter + at) for at in ("5", "10", "20") for letter in "RPF"]


def evaluate(arguments, results):
    """Means over the scenes, and the counts of scenes and of missing results."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "evaluation.json")
        command = [arguments.binary, "evaluate", "--pred", results, "--gt", arguments.gt,
                   "--protocol", arguments.protocol, "--missing", arguments.missing, "--json",
                   path]
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL)
        except OSError as error:
            sys.exit("%s: %s (--binary says where the program is)" %
                     (arguments.binary, error.strerror))
        if done.returncode:
            sys.exit(done.returncode)
        with open(path) as file:
            numbers = json.load(file)
    if "mean" not in numbers:
        sys.exit("%s: expected a folder of scenes, found one scene" % arguments.gt)
    return numbers["mean"], len(numbers["scenes"]), numbers["missing"]


def cells(name, mean, scenes, missing):
    def text(key):
        return "-" if mean.get(key) is None else "%.1f" % mean[key]
    edges = (mean.get("lines") or 0) + (mean.get("curves") or 0)
    count = "%d" % scenes + (" (%d missing)" % missing if missing else "")
    return [name] + [text(key) for _, key in COLUMNS] + ["%.1f" % edges, count]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--gt", required=True)
    parser.add_argument("--binary", default="sketchsplat")
    parser.add_argument("--protocol", default="sketchsplat")
    parser.add_argument("--missing", default="zero", choices=("zero", "skip"))
    parser.add_argument("--latex", action="store_true")
    parser.add_argument("methods", nargs="+", metavar="NAME=RESULTS")
    arguments = parser.parse_args()
    rows = [["Method"] + [heading for heading, _ in COLUMNS] + ["#edges", "scenes"]]
    for method in arguments.methods:
        name, equals, results = method.partition("=")
        if not equals:
            parser.error("NAME=RESULTS expected, found " + method)
        rows.append(cells(name, *evaluate(arguments, results)))
    if arguments.latex:
        lines = [" & ".join(row).replace("_", r"\_").replace("#", r"\#") + r" \\" for row in rows]
        lines = [r"\begin{tabular}{l%s}" % ("r" * (len(rows[0]) - 1)), r"\toprule", lines[0],
                 r"\midrule"] + lines[1:] + [r"\bottomrule", r"\end{tabular}"]
    else:
        lines = ["| " + " | ".join(row) + " |" for row in rows]
        lines.insert(1, "|" + "---|" * len(rows[0]))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
