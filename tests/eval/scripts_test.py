#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts_test.py EVAL: what eval/charts.py and eval/floors.py make of rows; charts only where
matplotlib is there."""
import csv
import importlib.util
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EVAL = sys.argv.pop(1)
sys.path.insert(0, EVAL)
import charts  # noqa: E402
import floors  # noqa: E402


class DropPoint(unittest.TestCase):
    def test_is_the_first_between_the_levels_around_it(self):
        self.assertEqual(charts.drop_point([0, 1, 2, 4, 8], [98, 98, 98, 88, 0], False), 3)
        self.assertEqual(charts.drop_point([0, 1, 2, 3], [90, 80, 90, 0], False), 0.5)
        self.assertEqual(charts.drop_point([0, 1, 2], [90, 100, 80], False), 1.75)
        self.assertAlmostEqual(charts.drop_point([50, 8, 2], [100, 100, 90], True), 4)
        self.assertAlmostEqual(charts.drop_point([0, 2], [100, 90], True), 1)

    def test_passes_over_levels_without_a_value_and_may_be_none(self):
        self.assertEqual(charts.drop_point([0, 1, 2, 3], [None, 90, None, 80], False), 2)
        self.assertIsNone(charts.drop_point([0, 1], [90, 85.1], False))
        self.assertIsNone(charts.drop_point([], [], False))


class PowerLaw(unittest.TestCase):
    def test_is_found_with_the_error_of_a_regression_on_logarithms(self):
        x = [1, 3, 10, 50]
        factor, exponent, error = charts.power_law(x, [0.25 * v ** 1.5 for v in x])
        self.assertAlmostEqual(factor, 0.25)
        self.assertAlmostEqual(exponent, 1.5)
        self.assertAlmostEqual(error, 0, places=6)
        # log y - log x = +d, -2d, +d at equal steps of log x: slope 1, residuals of 6 d^2.
        d, e = 0.1, math.e
        law = charts.power_law([1, e, e * e],
                               [math.exp(d), e * math.exp(-2 * d), e * e * math.exp(d)])
        self.assertAlmostEqual(law[1], 1)
        self.assertAlmostEqual(law[2], d * math.sqrt(6 / 2))

    def test_needs_two_places(self):
        self.assertIsNone(charts.power_law([2, 2, 0], [1, 3, 5]))
        self.assertIsNone(charts.power_law([1, 2], [1, 2])[2])


class Folder(unittest.TestCase):
    def made_of(self, axes, rows):
        """The files that the script makes, and limits.md and growth.md."""
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "rows.json"), "w", encoding="utf-8") as file:
                json.dump({"axes": axes, "rows": rows}, file)
            subprocess.run([sys.executable, os.path.join(EVAL, "charts.py"), folder], check=True,
                           stdout=subprocess.DEVNULL)
            tables = [pathlib.Path(folder, name) for name in ("limits.md", "growth.md")]
            return os.listdir(folder), [t.read_text("utf-8") if t.exists() else "" for t in tables]

    def row(self, axis, at, f5, total=1.0, result="x"):
        return {"scene": "box", "variant": "fast", "axis": axis, "at": at, "status": "0",
                "level": float(at or 0), "F5": f5, "F5_visible": f5, "fine_F1": f5, "views": 12.0,
                "total": total, "cpu_seconds": total, "peak_mb": 9.0, "result": result}

    def expect_charts(self, files, names):
        if importlib.util.find_spec("matplotlib"):
            for name in names:
                self.assertIn(name + ".svg", files)
                self.assertIn(name + ".png", files)

    def test_of_scenes_is_accuracy_beside_time(self):
        files, tables = self.made_of([], [self.row("", "", 90.0), self.row("", "", None)])
        self.assertEqual(tables, ["", ""])
        self.expect_charts(files, ["chart"])

    def test_of_axes_are_limits_and_growth(self):
        def axis(name, report, against=""):
            return {"name": name, "title": name, "log": False, "report": report, "against": against}
        files, (limits, growth) = self.made_of(
            [axis("blur", "drop"), axis("threads", "constant"), axis("size", "exponent", "level")],
            [self.row("blur", "0", 100.0), self.row("blur", "2", 90.0), self.row("blur", "3", None),
             self.row("threads", "1", 90.0), self.row("threads", "2", 89.0, result="y"),
             self.row("size", "1", 90.0), self.row("size", "10", 90.0, total=100.0)])
        self.assertIn("| blur | fast | 1 | 0 | 100.0 | 1 | 1 | 3 | - | - | - |", limits)
        self.assertIn("| threads | fast | 1 to 2 | 90.0 | 1 | no |", limits)
        self.assertIn("| size | fast | total | 1 to 10 | 2 | 2.00 | - | 1 |", growth)
        self.expect_charts(files, ["blur", "threads", "size"])


class Floors(unittest.TestCase):
    ROWS = [{"axis": "blur", "at": "1", "variant": "fast", "F5": 90.0, "solid_right": 1.0},
            {"axis": "blur", "at": "2", "variant": "fast", "F5": 80.0, "solid_refused": 1.0},
            {"axis": "noise", "at": "1", "variant": "fast", "F5": None, "solid_wrong": 1.0}]

    def measured(self, rows, metric):
        return floors.measured({"rows": rows, "metric": metric}, self.ROWS)

    def test_are_of_means_and_of_sums_of_solids_over_the_rows_that_they_name(self):
        self.assertEqual(self.measured("", "F5"), 85)
        self.assertEqual(self.measured("axis=bl*; at=2", "F5"), 80)
        self.assertTrue(math.isnan(self.measured("axis=noise", "F5")))
        self.assertEqual(self.measured("", "solid_right"), 1)
        self.assertEqual(self.measured("", "solid_right+solid_refused"), 2)

    def test_of_the_table_belong_to_suites_and_lie_below_what_was_measured(self):
        with open(floors.TABLE, encoding="utf-8") as file:
            for floor in csv.DictReader(file):
                suite = os.path.join(EVAL, "suites", floor["suite"] + ".yml")
                self.assertTrue(floor["suite"] in floors.SMALL or os.path.exists(suite), floor)
                if floor["measured"]:
                    self.assertLessEqual(float(floor["floor"]), float(floor["measured"]), floor)


if __name__ == "__main__":
    unittest.main()
