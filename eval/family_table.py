#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What siblings are worth: `reconstruct` with `--like` and without, from few pictures and many.

Of each family (a built-in part whose parameters are drawn anew for every seed), the siblings are
reconstructed from 24 views of 400 x 400 px each. One more, left out, is reconstructed from 50, 10,
5 and 3 views, cold and like its siblings; and like the siblings of another family, which must not
change it. Printed: F5 and the F of strokes as in `evaluate`, seconds of CPU, and whether the
siblings were followed; --chart draws them. Scenes and results that are there already are used
again.

  eval/family_table.py --binary build/pipelines/sketchsplat --work DIR [--chart docs/family.svg]
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
    "box": ["box"],
    "bored box": ["box-hole"],
}
FIVE = ["plate", "flange", "bracket", "slot", "shaft"]  # the others are near relatives
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


SERIES = [("cold", "#888", ""), ("warm", "#06c", ""), ("foreign", "#c60", "3 3")]
LABELS = {"cold": "cold", "warm": "like its siblings", "foreign": "like another family"}
PANEL, LEFT, TOP, GAP = (140, 110), 46, 46, 26  # px


def panel(rows, family, key, most, x0, y0):
    """Lines of one family: `key` of 0 to `most` over the number of views, as it is in the list."""
    width, height = PANEL
    of = [r for r in rows if r["family"] == family]
    x = [x0 + width * (k + 0.5) / len(of) for k in range(len(of))]
    out = [f'<rect x="{x0}" y="{y0}" width="{width}" height="{height}" fill="none" '
           'stroke="#ccc"/>']
    for name, colour, dashes in SERIES:
        y = [y0 + height * (1 - r[name][key] / most) for r in of]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2" '
                   f'stroke-dasharray="{dashes}"/>')
    out += [f'<text x="{a:.1f}" y="{y0 + height + 13}" text-anchor="middle">{r["views"]}</text>'
            for a, r in zip(x, of)]
    return out


def chart(rows):
    """SVG: F5 above, seconds below, a column for each family."""
    families = list(dict.fromkeys(r["family"] for r in rows))
    slowest = max(r[name]["seconds"] for r in rows for name, _, _ in SERIES)
    width = LEFT + len(families) * (PANEL[0] + GAP)
    height = TOP + 2 * (PANEL[1] + GAP) + 16
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
           'font-family="sans-serif" font-size="11">',
           f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for k, (name, colour, dashes) in enumerate(SERIES):
        x = LEFT + 150 * k
        out += [f'<line x1="{x}" y1="12" x2="{x + 22}" y2="12" stroke="{colour}" '
                f'stroke-width="2" stroke-dasharray="{dashes}"/>',
                f'<text x="{x + 28}" y="16">{LABELS[name]}</text>']
    for row, (key, most, title) in enumerate([("f5", 100, "F5"), ("seconds", slowest, "s of CPU")]):
        y = TOP + row * (PANEL[1] + GAP)
        out += [f'<text x="4" y="{y + PANEL[1] / 2}">{title.split(" ")[0]}</text>',
                f'<text x="{LEFT - 4}" y="{y + 9}" text-anchor="end">{most:.0f}</text>',
                f'<text x="{LEFT - 4}" y="{y + PANEL[1]}" text-anchor="end">0</text>']
        for k, family in enumerate(families):
            x = LEFT + k * (PANEL[0] + GAP)
            if row == 0:
                out.append(f'<text x="{x}" y="{y - 6}" font-weight="bold">{family}</text>')
            out += panel(rows, family, key, most, x, y)
    out.append(f'<text x="{LEFT}" y="{height - 4}">number of views</text></svg>')
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--siblings", type=int, default=5)
    parser.add_argument("--families", nargs="*", default=FIVE)
    parser.add_argument("--views", type=int, nargs="*", default=[50, 10, 5, 3])
    parser.add_argument("--chart", help="SVG file to write")
    arguments = parser.parse_args()
    rows = []
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
            rows.append({"family": family, "views": views, "cold": cold, "warm": warm,
                         "foreign": foreign})
            note = "" if warm["followed"] else " (not followed)"
            taken = " (followed)" if foreign["followed"] else ""
            print(f"| {family} | {views} | {cold['f5']:.1f} | {warm['f5']:.1f}{note} | "
                  f"{foreign['f5']:.1f}{taken} | {cold['strokes']:.1f} | {warm['strokes']:.1f} | "
                  f"{cold['seconds']:.1f} | {warm['seconds']:.1f} | {foreign['seconds']:.1f} |",
                  flush=True)
    if arguments.chart:
        with open(arguments.chart, "w") as file:
            file.write(chart(rows))


if __name__ == "__main__":
    main()
