#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gives every verb files that are damaged at random, and says where the program neither did its
work nor refused it in one line.

The readers have targets of their own (../../run fuzz); this is about what comes after them: a file
that can be read may still hold what a fit, a mesher or a search for loops never returns from.

  tests/fuzz/damaged_verbs.py --binary build/pipelines/sketchsplat --work DIR [--runs 500]

Exit status 1 if something was found; the files are in WORK/findings then.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys

PARTS = ["box-hole", "spline-plate", "elbow"]
NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
WORDS = ["0", "-1", "2", "100", "1e-9", "1e9", "1e12", "1e99", "-1e99", "1e308", "1e-320", "null"]
STEP_WORDS = WORDS + ["NaN", "$", "*", "#1", "#7", "#99999999", "''", "()", ".T."]
KINDS = re.compile('"(line|arc|circle|ellipse|elliptic_arc|bezier)"')
GOOD = {0, 3, 4, 7}  # done, refused, too little, not all in


def replaced(text, match, by):
    return text[:match.start()] + by + text[match.end():]


def damaged_json(text, rng):
    for _ in range(rng.randint(1, 3)):
        numbers = list(NUMBER.finditer(text))
        kinds = list(KINDS.finditer(text))
        what = rng.randrange(4)
        if what == 0 and kinds:
            text = replaced(text, rng.choice(kinds), rng.choice(kinds).group())
        elif what == 1:
            text = replaced(text, rng.choice(numbers), rng.choice(numbers).group())
        else:
            text = replaced(text, rng.choice(numbers), rng.choice(WORDS))
    return text


def damaged_step(text, rng):
    for _ in range(rng.randint(1, 3)):
        at = rng.randrange(len(text))
        what = rng.randrange(5)
        if what == 0:
            text = text[:at] + text[at + rng.randint(1, 40):]
        elif what == 1:
            text = text[:at] + rng.choice(STEP_WORDS) + text[at:]
        elif what == 2:
            numbers = list(re.finditer(r"(?<![#\d])-?\d+\.\d*(?:E[-+]?\d+)?", text))
            text = replaced(text, rng.choice(numbers), rng.choice(STEP_WORDS))
        elif what == 3:
            names = list(re.finditer(r"#\d+", text))
            text = replaced(text, rng.choice(names), rng.choice(names).group())
        else:
            lines = text.split("\n")
            lines[rng.randrange(len(lines))] = rng.choice(lines)
            text = "\n".join(lines)
    return text


class Verbs:
    def __init__(self, binary, work):
        self.binary, self.work = binary, work
        for part in PARTS:
            if os.path.exists(self.result(part) + "/sketch.json"):
                continue
            for arguments in (["synthesize", part, "--views", "24", "--resolution", "300", "--out",
                               self.scene(part)],
                              ["reconstruct", self.scene(part), "--overlays", "0", "--out",
                               self.result(part)]):
                subprocess.run([binary, "-q"] + arguments, check=True, stdout=subprocess.DEVNULL)

    def scene(self, part):
        return f"{self.work}/scenes/{part}"

    def result(self, part):
        return f"{self.work}/results/{part}"

    def trial(self, rng):
        """A damaged file, and the arguments of a verb that reads it."""
        part = rng.choice(PARTS)
        scene, result, out = self.scene(part), self.result(part), self.work + "/out"
        true_sketch, true_step = (scene + "/groundtruth/" + n for n in ("sketch.json", "part.step"))
        inspect = ["inspect", "--tolerance", "0.001", "--scale", "1", "--overlays", "0", "--out",
                   out + "/inspection"]
        sketch = rng.choice([result + "/sketch.json", true_sketch])
        made = out + "/given/sketch.json"
        kind = rng.choice(["step", "step", "nominal", "measured", "export", "export", "predicted",
                           "truth", "like", "scene"])
        if kind == "step":
            made = out + "/given/part.step"
            return kind, true_step, made, inspect + [result, "--nominal", made]
        if kind == "nominal":
            return kind, sketch, made, inspect + [result, "--nominal", made]
        if kind == "measured":
            return kind, sketch, made, inspect + [out + "/given", "--nominal", true_sketch]
        if kind == "predicted":
            return kind, sketch, made, ["evaluate", "--pred", made, "--gt", scene]
        if kind == "truth":
            return kind, true_sketch, made, ["evaluate", "--pred", result, "--gt", made]
        if kind == "like":
            return kind, sketch, made, ["reconstruct", scene, "--like", made, "--overlays", "0",
                                        "--out", out + "/like"]
        if kind == "scene":
            shutil.copytree(scene, out + "/scene", dirs_exist_ok=True)
            return kind, scene + "/meta_data.json", out + "/scene/meta_data.json", [
                "reconstruct", out + "/scene", "--overlays", "0", "--preset", "fast", "--out",
                out + "/of_scene"]
        ending = rng.choice(["step", "step --faces", "obj", "dxf", "glb", "ply"])
        return kind, sketch, made, ["export", out + "/given", "-o", out + "/file." +
                                    ending.split()[0]] + ending.split()[1:]

    def run(self, rng, seconds):
        """(kind, file, what is wrong) of one trial; nothing is wrong if that is empty."""
        kind, source, made, arguments = self.trial(rng)
        os.makedirs(os.path.dirname(made), exist_ok=True)
        with open(source) as file:
            text = file.read()
        with open(made, "w") as file:
            file.write((damaged_step if kind == "step" else damaged_json)(text, rng))
        try:
            done = subprocess.run([self.binary, "-q"] + arguments, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE, timeout=seconds)
        except subprocess.TimeoutExpired:
            return kind, made, arguments, f"not done after {seconds} s"
        lines = done.stderr.decode(errors="replace").strip().split("\n")
        if done.returncode not in GOOD:
            return kind, made, arguments, f"status {done.returncode}: {lines[-1]}"
        if done.returncode == 3 and len(lines) != 1:
            return kind, made, arguments, f"{len(lines)} lines instead of one: {lines[0]}"
        return kind, made, arguments, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=60, help="that a verb may take")
    arguments = parser.parse_args()
    verbs = Verbs(os.path.abspath(arguments.binary), os.path.abspath(arguments.work))
    counts, found = {}, 0
    for run in range(arguments.runs):
        rng = random.Random(f"{arguments.seed} {run}")
        kind, made, command, wrong = verbs.run(rng, arguments.seconds)
        counts[kind] = counts.get(kind, 0) + 1
        if not wrong:
            continue
        found += 1
        place = f"{verbs.work}/findings/{run}_{kind}_{os.path.basename(made)}"
        os.makedirs(os.path.dirname(place), exist_ok=True)
        shutil.copy(made, place)
        print(f"{place}: {wrong}\n  {' '.join(command)}", flush=True)
    print(", ".join(f"{n} of {kind}" for kind, n in sorted(counts.items())) + f": {found} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
