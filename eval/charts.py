#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tables and charts of what `sketchsplat bench` measured, beside its rows.json.

    charts.py DIR

limits.md: per axis where F5 falls by 5, and what must not change results; growth.md: exponents of
time and memory; with matplotlib (package python3-matplotlib) chart.svg and .png: accuracy beside
time, and AXIS.svg and .png.
"""
import json
import math
import os
import sys

DROP = 5  # [per cent]
QUANTITIES = {"total": "time [s]", "cpu_seconds": "CPU time [s]", "peak_mb": "peak memory [MB]"}
# Means over 82 models of ABC-NEF, on GPUs: method, F5 [per cent], seconds per scene.
PUBLISHED = [("SketchSplat, 2DGS-SN", 91.3, 600), ("SketchSplat, DexiNed", 50.3, 600),
             ("EdgeGaussians, 2DGS-SN", 80.3, 300), ("EdgeGaussians, DexiNed", 45.2, 240),
             ("CurveGaussian, DexiNed", 73.7, 180), ("EMAP, DexiNed", 59.1, 9000),
             ("NEF, DexiNed", 10.8, 5400)]


def drop_point(levels, values, log):
    """Where values first fall by DROP below the first: interpolated between the levels around it,
    in the logarithm if log; None if they never do. Values of None are passed over."""
    points = [(level, value) for level, value in zip(levels, values) if value is not None]
    for (a, high), (b, low) in zip(points, points[1:]):
        limit = points[0][1] - DROP
        if low > limit:
            continue
        t = (high - limit) / (high - low)
        return a * (b / a) ** t if log and a > 0 and b > 0 else a + t * (b - a)
    return None


def power_law(x, y):
    """Factor, exponent and its standard error of y = factor * x^exponent, by least squares of the
    logarithms; None of less than two different x; the error None of less than three points."""
    points = [(math.log(a), math.log(b)) for a, b in zip(x, y) if a and b and a > 0 and b > 0]
    n = len(points)
    if len({u for u, _ in points}) < 2:
        return None
    mean_u, mean_v = (sum(p[i] for p in points) / n for i in (0, 1))
    uu = sum((u - mean_u) ** 2 for u, _ in points)
    slope = sum((u - mean_u) * (v - mean_v) for u, v in points) / uu
    rest = sum((v - mean_v - slope * (u - mean_u)) ** 2 for u, v in points)
    error = math.sqrt(rest / (n - 2) / uu) if n > 2 else None
    return math.exp(mean_v - slope * mean_u), slope, error


def numbers(rows, name):
    return [row[name] for row in rows if row.get(name) is not None]


def mean(values):
    return sum(values) / len(values) if values else None


def show(value, form=".1f"):
    return "-" if value is None else format(value, form)


def groups(rows, key):
    """Rows by the value of a key, in the order in which these come."""
    out = {}
    for row in rows:
        out.setdefault(row.get(key), []).append(row)
    return out


def markdown(heading, lines):
    table = [heading, ["---"] * len(heading)] + lines
    return "".join("| " + " | ".join(line) + " |\n" for line in table)


class Axis:
    """The rows of an axis and a variant, level by level."""

    def __init__(self, axis, variant, rows):
        self.axis, self.variant, self.rows = axis, variant, rows
        self.at = groups(rows, "at")
        self.levels = [level_rows[0].get("level") for level_rows in self.at.values()]

    def means(self, name):
        return [mean(numbers(rows, name)) for rows in self.at.values()]

    def drop(self, name):
        return drop_point(self.levels, self.means(name), self.axis["log"])

    def limit_line(self):
        ends = list(self.at)
        last = numbers(self.at[ends[-1]], "F5") or [None]
        drops = [self.drop(name) for name in ("F5", "F5_visible")]
        return [self.axis["title"], self.variant, str(max(map(len, self.at.values()))), ends[0],
                show(self.means("F5")[0]),
                *["not reached" if d is None else show(d, ".3g") for d in drops], ends[-1],
                show(mean(numbers(self.at[ends[-1]], "F5"))), show(min(last)), show(max(last))]

    def constant_line(self):
        parts = groups(self.rows, "scene").values()
        spread = max(max(f5) - min(f5) for f5 in (numbers(rows, "F5") or [0] for rows in parts))
        same = all(len({row.get("result") for row in rows}) == 1 for rows in parts)
        ends = list(self.at)
        return [self.axis["title"], self.variant, f"{ends[0]} to {ends[-1]}",
                show(self.means("F5")[0]), show(spread, ".2g"), "yes" if same else "no"]

    def growth(self, quantity):
        """x, y and the power law of the runs that ended well."""
        rows = [row for row in self.rows if row["status"] == "0"]
        x, y = ([row.get(name) for row in rows] for name in (self.axis["against"], quantity))
        return x, y, power_law(x, y)

    def growth_lines(self):
        for quantity in QUANTITIES:
            x, _, law = self.growth(quantity)
            if law:
                yield [self.axis["title"], self.variant, quantity, f"{min(x):.4g} to {max(x):.4g}",
                       str(len(x)), show(law[1], ".2f"), show(law[2], ".2f"), show(law[0], ".3g")]


def write_tables(axes, folder):
    """limits.md and growth.md, each if there is something to say."""
    tables = {"limits.md": [], "growth.md": []}
    drops = [a.limit_line() for a in axes if a.axis["report"] == "drop"]
    if drops:
        tables["limits.md"].append(markdown(
            ["what is varied", "variant", "parts", "harmless", "F5 there", "F5 falls by 5 at",
             "visible F5 by 5 at", "last", "F5 there (mean)", "worst part", "best part"], drops))
    constant = [a.constant_line() for a in axes if a.axis["report"] == "constant"]
    if constant:
        tables["limits.md"].append(markdown(
            ["what must not matter", "variant", "levels", "F5", "largest difference of F5",
             "same bytes"], constant))
    growth = [line for a in axes if a.axis["report"] == "exponent" for line in a.growth_lines()]
    if growth:
        tables["growth.md"].append(markdown(
            ["against", "variant", "quantity", "range", "runs", "exponent", "its error", "factor"],
            growth))
    for name, parts in tables.items():
        if parts:
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write("\n".join(parts))


def draw_accuracy(plt, rows):
    figure, plots = plt.subplots(1, 3, figsize=(15, 5))
    for plot, name, title in zip(plots, ("F5", "F5", "fine_F1"), (
            "F5 [%], with published methods", "F5 [%]", "F1 [%], densely sampled")):
        plot.set(title=title, xlabel="seconds per scene", xscale="log")
        for k, (variant, own) in enumerate(groups(rows, "variant").items()):
            points = [(row["total"], row[name]) for row in own if row.get(name) is not None]
            if not points:
                continue
            seconds, f = (mean(list(values)) for values in zip(*points))
            plot.plot(*zip(*points), ".", color=f"C{k % 10}")
            plot.plot(seconds, f, "o", color=f"C{k % 10}", markerfacecolor="none", markersize=10,
                      label=f"{variant}: mean {f:.1f}, {seconds:.2f} s")
    plots[2].legend(fontsize="small", loc="lower left")
    for method, f5, seconds in PUBLISHED:
        plots[0].plot(seconds, f5, "d", color="grey")
        plots[0].annotate(method, (seconds, f5), fontsize="small", ha="right")
    plots[0].set_ylim(0, 103)
    return figure


def draw_axis(plt, results):
    figure, (plot, time) = plt.subplots(2, 1, figsize=(7, 7), height_ratios=(3, 1), sharex=True)
    for k, axis in enumerate(results):
        if None in axis.levels:
            axis.levels = list(range(len(axis.levels)))
        shown = [i for i, f in enumerate(axis.means("F5")) if f is not None]
        levels = [axis.levels[i] for i in shown]
        parts = [numbers(list(axis.at.values())[i], "F5") for i in shown]
        plot.plot(levels, [mean(p) for p in parts], "o-", color=f"C{k}",
                  label=f"F5, {axis.variant}")
        plot.fill_between(levels, [min(p) for p in parts], [max(p) for p in parts], color=f"C{k}",
                          alpha=0.15)
        visible = axis.means("F5_visible")
        plot.plot(levels, [visible[i] for i in shown], "--", color=f"C{k}",
                  label=f"of what two views see, {axis.variant}")
        time.plot(axis.levels, axis.means("total"), "o-", color=f"C{k}")
        drop = axis.drop("F5")
        if drop is not None and axis.axis["report"] == "drop":
            plot.axvline(drop, color=f"C{k}", linestyle=":", label=f"{DROP} lower at {drop:.3g}")
    plot.set(title="F5: mean over the parts, band: worst and best", ylabel="F5 [%]", ylim=(0, 102))
    time.set(xlabel=results[0].axis["title"], ylabel="s per scene", ylim=(0, None))
    levels = results[0].levels
    if results[0].axis["log"] and min(levels) > 0:
        time.set_xscale("log")
        time.set_xticks(levels, [f"{level:g}" for level in levels])
        time.minorticks_off()
    if levels[0] > levels[-1]:
        time.invert_xaxis()
    plot.legend(fontsize="small")
    return figure


def draw_growth(plt, results):
    figure, plots = plt.subplots(1, len(QUANTITIES), figsize=(15, 5))
    for plot, (quantity, label) in zip(plots, QUANTITIES.items()):
        for k, axis in enumerate(results):
            x, y, law = axis.growth(quantity)
            plot.plot(x, y, ".", color=f"C{k}")
            if law:
                ends = [min(x), max(x)]
                plot.plot(ends, [law[0] * v ** law[1] for v in ends], color=f"C{k}",
                          label=f"{axis.variant}: exponent {law[1]:.2f} ± {show(law[2], '.2f')}")
        plot.set(xscale="log", yscale="log", xlabel=results[0].axis["title"], ylabel=label)
        plot.legend(fontsize="small")
    return figure


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    with open(os.path.join(folder, "rows.json"), encoding="utf-8") as file:
        data = json.load(file)
    of_axes = groups(data["rows"], "axis")
    axes = [Axis(axis, variant, rows) for axis in data["axes"]
            for variant, rows in groups(of_axes.get(axis["name"], []), "variant").items()]
    write_tables(axes, folder)
    try:
        import matplotlib
    except ImportError:
        print(f"no charts: install python3-matplotlib, then {' '.join(sys.argv)}")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
    charts = {} if axes else {"chart": draw_accuracy(plt, data["rows"])}
    for axis in data["axes"]:
        results = [result for result in axes if result.axis is axis]
        if results:
            draw = draw_growth if axis["report"] == "exponent" else draw_axis
            charts[axis["name"]] = draw(plt, results)
    for name, figure in charts.items():
        figure.tight_layout()
        for ending in (".svg", ".png"):
            figure.savefig(os.path.join(folder, name + ending))
        plt.close(figure)
    print(f"charts: {', '.join(charts)} (.svg, .png) in {folder}")


if __name__ == "__main__":
    main()
