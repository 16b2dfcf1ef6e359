#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What siblings are worth: `reconstruct` with `--like` and without, from few pictures and many.

Of each family (a built-in part whose parameters are drawn anew for every seed), the siblings are
reconstructed from 24 views of 400 x 400 px each. One more, left out, is reconstructed from 50, 10,
5 and 3 views, cold and like its siblings; and like the siblings of another family, which must not
change it. Printed: F5 and the F of strokes as in `evaluate`, seconds of CPU, and whether the
siblings were followed. Scenes and results that are there already are used again.

  eval/family_table.py --binary build/pipelines/sketchsplat --work DIR [--siblings 5]
"""

import argparse
import json
import os
import resource
import subprocess
import sys

FAMILIES = {
    "plate": ["plate-holes"],
    "flange": ["flange", "--param", "holes=5"],
    "bracket": ["l-bracket"],
    "slot": ["slot-block"],
    "shaft": ["stepped-shaft"],
}
PICTURES = "--resolution 400 --object-size 0.7 --noise 3 --outputs none -q".split()


def run(arguments, allowed=(0,)):
    """Seconds of CPU that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in allowed:
        sys.exit(" ".join(arguments) + "\n" + done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Table:
    def __init__(self, arguments):
        self.binary, self.work = arguments.binary, arguments.work

    def scene(self, family, seed, views):
        folder = f"{self.work}/scenes/{family}.{seed}.{views}"
        if not os.path.exists(folder + "/meta_data.json"):
            part = FAMILIES[family]
            run([self.binary, "synthesize"] + part + ["--seed", str(seed), "--views", str(views),
                                                      "--out", folder] + PICTURES)
        return folder

    def result(self, scene, name, like=()):
        """The folder of a result; without a sketch if there were too few views."""
        folder = f"{self.work}/results/{os.path.basename(scene)}.{name}"
        if not os.path.exists(folder + "/done"):
            options = [o for path in like for o in ("--like", path)]
            seconds = run([self.binary, "reconstruct", scene, "--out", folder, "-q", "--overlays",
                           "0"] + options, (0, 4))
            os.makedirs(folder, exist_ok=True)
            with open(folder + "/done", "w") as file:
                file.write(f"{seconds:.2f}\n")
        return folder

    @staticmethod
    def seconds(folder):
        with open(folder + "/done") as file:
            return float(file.read())

    def numbers(self, scene, folder):
        """F5, F of strokes, seconds, followed."""
        if not os.path.exists(folder + "/sketch.json"):
            return {"f5": 0.0, "strokes": 0.0, "seconds": self.seconds(folder), "followed": 0}
        path = folder + "/numbers.json"
        run([self.binary, "evaluate", "--pred", folder, "--gt", scene, "--json", path, "-q"])
        with open(path) as file:
            numbers = json.load(file)
        with open(folder + "/report.json") as file:
            report = json.load(file)
        return {"f5": numbers["F5"], "strokes": numbers["structure"]["f"],
                "seconds": self.seconds(folder),
                "followed": report["counts"].get("family_followed", 0)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--siblings", type=int, default=5)
    parser.add_argument("--families", nargs="*", default=list(FAMILIES))
    parser.add_argument("--views", type=int, nargs="*", default=[50, 10, 5, 3])
    arguments = parser.parse_args()
    table = Table(arguments)
    siblings = {}
    for family in arguments.families:
        scenes = [table.scene(family, seed, 24) for seed in range(2, 2 + arguments.siblings)]
        siblings[family] = [table.result(s, "cold") + "/sketch.json" for s in scenes]
    names = arguments.families
    print("| part | views | F5 cold | F5 like siblings | F5 like another family | strokes cold | "
          "strokes like siblings | s cold | s like siblings | s like another family |")
    print("|" + "---|" * 10)
    for k, family in enumerate(names):
        other = names[(k + 1) % len(names)]
        for views in arguments.views:
            scene = table.scene(family, 1, views)
            cold, warm, foreign = [
                table.numbers(scene, table.result(scene, name, like))
                for name, like in (("cold", ()), ("warm", siblings[family]),
                                   ("foreign", siblings[other]))]
            note = "" if warm["followed"] else " (not followed)"
            taken = " (followed)" if foreign["followed"] else ""
            print(f"| {family} | {views} | {cold['f5']:.1f} | {warm['f5']:.1f}{note} | "
                  f"{foreign['f5']:.1f}{taken} | {cold['strokes']:.1f} | {warm['strokes']:.1f} | "
                  f"{cold['seconds']:.1f} | {warm['seconds']:.1f} | {foreign['seconds']:.1f} |",
                  flush=True)


if __name__ == "__main__":
    main()
