#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures accuracy and compares it with tests/floors.csv: fails below a floor.

    floors.py BINARY --out DIR [--all] [--only SUITE...] [--threads N] [--write]

Without --all or --only: the suites floors and small, three published scenes if they are beside the
sources (../shared/data), and whether 1, 2 and 7 threads write the same bytes. --all: the large
suites, too, hours of two cores. What was measured with the same program before is not run again.

A row of the table: the suite (eval/suites/SUITE.yml, or abc-nef, or threads), the labels of the
rows that count (axis=..., at=..., variant=..., with * for anything; empty: all rows), the metric
(a number of rows.json: its mean; a number of solids, or a sum of such: their sum), what was
measured when the floor was set (large suites: as docs/ have it), and the floor; both are empty if
nobody has measured it. --write measures and sets both anew, at the same distance.
"""
import argparse
import csv
import fnmatch
import json
import math
import os
import subprocess
import sys
import time

from same_bytes import differing_files

SOURCES = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TABLE = os.path.join(SOURCES, "tests", "floors.csv")
PUBLISHED = os.path.join(SOURCES, "..", "shared", "data", "abc-nef")
SCENES = ["00000952", "00004605", "00004926"]
SMALL = ["floors", "small", "abc-nef", "threads"]
NAMES = ["suite", "rows", "metric", "measured", "floor"]


def bench_rows(suite, arguments):
    """Rows of a suite; None if what it needs is not here."""
    out = os.path.join(arguments.out, suite)
    command = [arguments.binary, "bench", "--out", out, "--quiet", "--threads",
               str(arguments.threads)]
    if suite == "abc-nef":
        scenes = [os.path.join(PUBLISHED, scene) for scene in SCENES]
        if not all(os.path.isdir(scene) for scene in scenes):
            return None
        command += scenes + ["--presets", "balanced"]
    else:
        command += ["--suite", os.path.join(SOURCES, "eval", "suites", suite + ".yml"),
                    "--scene-folder", os.path.join(arguments.out, "scenes")]
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    with open(os.path.join(out, "rows.json"), encoding="utf-8") as file:
        return json.load(file)["rows"]


def thread_rows(arguments):
    """A row for each of two scenes: same_bytes is 100 if 1, 2 and 7 threads write the same."""
    rows = []
    for part, style in (("hex-nut", "plain"), ("flange", "photo")):
        out = os.path.join(arguments.out, "threads")
        scene = os.path.join(out, "scenes", part)
        if not os.path.exists(scene):
            subprocess.run([arguments.binary, "synthesize", part, "--style", style, "--views", "12",
                            "--resolution", "400", "--noise", "2", "--outputs", "none", "--quiet",
                            "--out", scene], stdout=subprocess.DEVNULL, check=True)
        differing, _ = differing_files([arguments.binary], [1, 2, 7], scene, out)
        rows.append({"scene": part, "same_bytes": 0 if differing else 100})
    return rows


def measured(floor, rows):
    """The metric of a floor over those rows that it is of; NaN if there are none."""
    labels = [label.split("=", 1) for label in floor["rows"].split("; ") if label]
    chosen = [row for row in rows
              if all(fnmatch.fnmatchcase(row.get(name, ""), glob) for name, glob in labels)]
    metrics = floor["metric"].split("+")
    numbers = [sum(row.get(name) or 0 for name in metrics) for row in chosen
               if any(row.get(name) is not None for name in metrics)]
    if not numbers:
        return math.nan
    return sum(numbers) if metrics[0].startswith("solid_") else sum(numbers) / len(numbers)


def check(suite, floors, arguments):
    """Measures a suite and prints its floors. Returns how many are missed."""
    began = time.monotonic()
    rows = thread_rows(arguments) if suite == "threads" else bench_rows(suite, arguments)
    if rows is None:
        print(f"{suite}: left out, no scenes in {os.path.normpath(PUBLISHED)}")
        return 0
    print(f"{suite}: {len(rows)} rows, {time.monotonic() - began:.0f} s", flush=True)
    missed = 0
    for floor in floors:
        now = measured(floor, rows)
        if arguments.write:
            distance = float(floor["measured"] or 1) - float(floor["floor"] or 0)
            floor.update(measured=f"{now:.2f}", floor=f"{now - distance:.2f}")
        below = floor["floor"] != "" and not now >= float(floor["floor"]) and not arguments.write
        missed += below
        print(f"  {floor['rows'] or 'all':42} {floor['metric']:28} {now:7.2f}  "
              f"was {floor['measured']:>6}  floor {floor['floor']:>6}{'  BELOW' if below else ''}")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--out", required=True)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    with open(TABLE, encoding="utf-8") as file:
        floors = list(csv.DictReader(file))
    suites = list(dict.fromkeys(floor["suite"] for floor in floors))
    if not set(arguments.only) <= set(suites):
        parser.error("--only: expected some of " + ", ".join(suites))
    missed = 0
    for suite in arguments.only or (suites if arguments.all else SMALL):
        missed += check(suite, [f for f in floors if f["suite"] == suite], arguments)
        if arguments.write:
            with open(TABLE + ".part", "w", encoding="utf-8") as file:
                table = csv.DictWriter(file, NAMES, lineterminator="\n")
                table.writeheader()
                table.writerows(floors)
            os.replace(TABLE + ".part", TABLE)
    print(f"{missed} below their floors" if missed else "all floors hold")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
