#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which parts become solids: makes each (default views), reconstructs and evaluates it.

    solid_table.py BINARY --out DIR [--seeds 1] [--parts box bracket.step ...] [--threads N]

Parts are built-in ones (without --parts all of them) or STEP files.

Prints a Markdown table: right (IoU at least 0.99), wrong, or refused and why. Scenes that are in
DIR already are used again.
"""
import argparse
import json
import os
import subprocess
import sys


def run(command):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def part_names(binary):
    """First words of the lines of the listing that are not indented."""
    listing = run([binary, "synthesize", "--list-parts"]).stdout
    return [line.split()[0] for line in listing.splitlines() if line and not line[0].isspace()]


def outcome(binary, part, seed, folder, threads):
    name = os.path.splitext(os.path.basename(part))[0] + f"-{seed}"
    scene, result = f"{folder}/scenes/{name}", f"{folder}/results/{name}"
    if not os.path.exists(f"{scene}/meta_data.json"):
        made = run([binary, "synthesize", part, "--seed", str(seed), "--out", scene, "--quiet"])
        if made.returncode:
            return {"verdict": "not made", "why": made.stderr.strip()}
    done = run([binary, "reconstruct", scene, "--out", result, "--quiet", "--overlays", "0",
                "--threads", str(threads)])
    if done.returncode:
        return {"verdict": "refused", "why": done.stderr.strip()}
    with open(f"{result}/report.json", encoding="utf-8") as file:
        report = json.load(file)
    seconds = {stage["name"]: stage["seconds"] for stage in report["stages"]}
    row = {"seconds": report["seconds"], "solid_seconds": seconds.get("close solid", 0)}
    if not report["solid"]["written"]:
        return {**row, "verdict": "refused", "why": report["solid"]["why"]}
    judged = json.loads(run([binary, "evaluate", "--pred", result, "--gt", scene, "--json"]).stdout)
    solid = judged["solid"]
    return {**row, **solid, "verdict": "right" if solid["iou"] >= 0.99 else "wrong", "why": ""}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary")
    parser.add_argument("--out", required=True)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--parts", nargs="*")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    counts = {}
    print("| part | outcome | IoU | faces F | largest distance | s, of which solid | why |")
    print("|---|---|---|---|---|---|---|")
    for part in arguments.parts or part_names(arguments.binary):
        for seed in range(1, arguments.seeds + 1):
            row = outcome(arguments.binary, part, seed, arguments.out, arguments.threads)
            counts[row["verdict"]] = counts.get(row["verdict"], 0) + 1
            iou = f"{row['iou']:.4f}" if "iou" in row else ""
            faces = f"{100 * row['face_f']:.0f}" if "iou" in row else ""
            far = f"{row['largest_distance']:.4f}" if "iou" in row else ""
            took = f"{row['seconds']:.1f}, {row['solid_seconds']:.2f}" if "seconds" in row else ""
            cells = [os.path.basename(part), row["verdict"], iou, faces, far, took, row["why"]]
            print("| " + " | ".join(cells) + " |", flush=True)
    print("\n" + ", ".join(f"{n} {verdict}" for verdict, n in sorted(counts.items())))
    return 0


if __name__ == "__main__":
    sys.exit(main())
