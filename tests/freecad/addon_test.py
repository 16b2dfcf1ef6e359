# SPDX-License-Identifier: MIT
"""addon_test.py ADDON: what it does without FreeCAD: reading, faces, choice of constraints."""

import collections
import json
import math
import os
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

ADDON = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, ADDON)
import parts  # noqa: E402
from sketchsplat_workbench import curves, sketch_file  # noqa: E402
from sketchsplat_workbench.constrain import constrain  # noqa: E402
from sketchsplat_workbench.equations import Constraint, Equations  # noqa: E402
from sketchsplat_workbench.faces import planar_faces, select_loops  # noqa: E402
from sketchsplat_workbench.frames import face_plane, main_axes  # noqa: E402
from sketchsplat_workbench.profile import ORIGIN, build_profile  # noqa: E402


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = os.path.join(self.folder, "sketch.json")

    def read(self, drawing, **more):
        return sketch_file.read_sketch(drawing.write(self.path, **more))

    def constrained(self, drawing, **more):
        """All faces of a drawing, constrained; those of the most loops first."""
        sketch = self.read(drawing, **more)
        axes = main_axes(sketch)
        faces = sorted(planar_faces(sketch), key=lambda f: -len(f.holes))
        profiles = [build_profile(sketch, f, face_plane(sketch, f, axes)) for f in faces]
        return [constrain(p, sketch.regularities) for p in profiles]


class ReadingTest(FolderTest):
    def test_a_result_folder_is_its_sketch(self):
        parts.plate().write(self.path)
        sketch = sketch_file.read_sketch(self.folder)
        self.assertEqual(len(sketch.strokes), 14)
        self.assertEqual(sketch.strokes[0].support_views, 12)
        self.assertAlmostEqual(sketch.strokes[0].confidence, 0.9)

    def test_the_scale_of_the_file_makes_millimetres_of_lengths_and_sigmas(self):
        plain = self.read(parts.plate())
        scale = {"unit": "inch", "units_per_world": 2}
        scaled = self.read(parts.plate(), **{"scale": scale})
        self.assertAlmostEqual(scaled.mm_per_world, 50.8)
        self.assertAlmostEqual(scaled.extent(), 50.8 * plain.extent(), places=6)
        self.assertAlmostEqual(scaled.strokes[0].sigma, 50.8 * plain.strokes[0].sigma)

    def test_without_a_scale_the_unit_of_the_report_counts(self):
        with open(os.path.join(self.folder, "report.json"), "w", encoding="utf-8") as file:
            json.dump({"options": {"unit": "cm"}}, file)
        self.assertEqual(self.read(parts.plate()).mm_per_world, 10)

    def test_bad_files_are_one_line_that_says_what_was_expected(self):
        def broken(change):
            content = parts.plate().content()
            change(content)
            return json.dumps(content)

        bad = {
            "format_version 1": broken(lambda c: c.update(format_version=2)),
            "as nodes": broken(lambda c: c["nodes"].append([1, 2])),
            '"kind" of stroke 0': broken(lambda c: c["strokes"][0].update(kind="helix")),
            "handles in stroke 0": broken(lambda c: c["strokes"][0].update(handles=[[0, 0, 0]])),
            "indices of nodes in stroke 0": broken(lambda c: c["strokes"][0].update(nodes=[0, 99])),
            '"sigma" of stroke 0': broken(lambda c: c["strokes"][0].update(sigma="small")),
            "a sketch as JSON": "{",
            '"strokes"': broken(lambda c: c.pop("strokes")),
        }
        for expected, text in bad.items():
            with open(self.path, "w", encoding="utf-8") as file:
                file.write(text)
            with self.assertRaises(sketch_file.SketchFileError) as caught:
                sketch_file.read_sketch(self.path)
            self.assertIn(expected, str(caught.exception))
            self.assertEqual(str(caught.exception).count("\n"), 0)
        with self.assertRaises(sketch_file.SketchFileError):
            sketch_file.read_sketch(os.path.join(self.folder, "nothing"))


class CurvesTest(FolderTest):
    def test_an_elliptic_arc_is_the_ellipse_that_it_was_made_of(self):
        sketch = self.read(parts.quarter_ellipse())
        e = curves.elliptic_arc(*sketch.controls(2))
        major, minor, _ = curves.principal_axes(e.p, e.q)
        self.assertAlmostEqual(np.linalg.norm(major), 30, places=9)
        self.assertAlmostEqual(np.linalg.norm(minor), 20, places=9)
        self.assertAlmostEqual(e.half_angle, math.pi / 4, places=9)

    def test_polylines_run_from_end_to_end(self):
        for drawing in (parts.ellipse_in_wave(), parts.quarter_ellipse(), parts.slotted_sheet()):
            sketch = self.read(drawing)
            for i, s in enumerate(sketch.strokes):
                line = curves.polyline(sketch, i)
                ends = line[[0, 0]] if s.closed else sketch.nodes[[s.begin, s.end]]
                np.testing.assert_allclose(line[[0, -1]], ends, atol=1e-9)


class FacesTest(FolderTest):
    def test_a_plate_with_a_hole_has_six_faces_two_with_a_hole(self):
        faces = planar_faces(self.read(parts.plate(noise=0.01)))
        self.assertEqual(sorted(len(f.holes) for f in faces), [0, 0, 0, 0, 1, 1])

    def test_normals_look_away_from_the_part(self):
        sketch = self.read(parts.plate())
        middle = sketch.nodes.mean(axis=0)
        for f in planar_faces(sketch):
            self.assertGreater((f.plane.origin - middle) @ f.plane.normal, 0)

    def test_an_open_chain_bounds_nothing(self):
        d = parts.plate()
        del d.strokes[0]  # two of the six faces go with it, and a hole is a face of its own
        faces = planar_faces(self.read(d))
        self.assertEqual(sorted(len(f.outer) for f in faces), [1, 4, 4, 4, 4])

    def test_two_touching_rectangles_are_two_faces(self):
        d = parts.Drawing()
        n = [d.node(*p) for p in ((0, 0), (10, 0), (20, 0), (20, 8), (10, 8), (0, 8))]
        for a, b in zip(n, n[1:] + n[:1]):
            d.line(a, b)
        d.line(n[1], n[4])
        self.assertEqual([len(f.outer) for f in planar_faces(self.read(d))], [4, 4])

    def test_selected_strokes_mean_faces_or_holes(self):
        faces = planar_faces(self.read(parts.plate()))
        self.assertEqual(len(select_loops(faces, [])), 6)
        hole = select_loops(faces, [12])
        self.assertEqual([len(f.outer) for f in hole], [1])
        self.assertEqual(len(select_loops(faces, [0])), 2)  # an edge has a face on both sides
        bottom = select_loops(faces, [0, 1])
        self.assertEqual([(len(f.outer), len(f.holes)) for f in bottom], [(4, 1)])

    def test_parallel_faces_get_exactly_parallel_planes(self):
        sketch = self.read(parts.plate(noise=0.02))
        axes = main_axes(sketch)
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        for face in planar_faces(sketch):
            normal = face_plane(sketch, face, axes).normal
            self.assertAlmostEqual(np.abs(axes @ normal).max(), 1, places=12)


class ConstraintsTest(FolderTest):
    def kinds(self, constrained):
        return collections.Counter(c.kind for c in constrained.constraints)

    def assert_sound(self, constrained):
        """Nothing left to move, and all equations hold."""
        self.assertEqual(constrained.freedom, 0)
        equations = Equations(constrained.profile)
        for c in constrained.constraints:
            r = equations.residual(c, constrained.unknowns)
            self.assertLess(np.abs(r).max(), 1e-8, c)

    def test_a_plate_is_width_height_radius_and_place_of_its_hole(self):
        top = self.constrained(parts.plate())[0]
        self.assert_sound(top)
        self.assertEqual(self.kinds(top)["horizontal"], 2)
        self.assertEqual(self.kinds(top)["vertical"], 2)
        values = sorted(round(c.value, 6) for c in top.dimensions)
        # Its hole lies 25 from both long sides; 30 from one of the short ones, or 50.
        self.assertIn(values, ([8, 25, 30, 50, 80], [8, 25, 50, 50, 80]))

    def test_noise_within_sigma_changes_dimensions_and_no_relations(self):
        exact, noisy = (self.constrained(parts.plate(noise))[0] for noise in (0.0, 0.03))
        self.assert_sound(noisy)
        self.assertEqual(self.kinds(noisy), self.kinds(exact))
        self.assertGreater(noisy.largest_move, 0.001)
        self.assertLess(noisy.largest_move, 0.15)

    def test_a_side_that_leans_is_not_made_vertical(self):
        d = parts.Drawing()
        d.polygon([(0, 0), (80, 0), (81, 50), (0, 50)])
        found = self.constrained(d)[0]
        self.assert_sound(found)
        self.assertEqual((self.kinds(found)["horizontal"], self.kinds(found)["vertical"]), (2, 1))
        self.assertLess(found.largest_move, 1e-6)

    def test_arcs_of_a_slot_touch_its_lines_and_are_equal(self):
        for noise in (0.0, 0.01):
            sheet = self.constrained(parts.slotted_sheet(noise))[0]
            self.assert_sound(sheet)
            self.assertGreaterEqual(self.kinds(sheet)["tangent"], 3)
            self.assertEqual(self.kinds(sheet)["radius"], 1)
            radius = next(c.value for c in sheet.dimensions if c.kind == "radius")
            self.assertAlmostEqual(radius, 5, delta=0.001 + 5 * noise)

    def test_a_regular_hexagon_has_one_length(self):
        found = self.constrained(parts.hexagon())[0]
        self.assert_sound(found)
        lengths = [c for c in found.dimensions if c.kind.startswith("distance")]
        self.assertEqual([round(c.value, 6) for c in lengths], [20])
        angles = {round(math.degrees(c.value)) % 60 for c in found.dimensions if c.kind == "angle"}
        self.assertEqual(angles, {0})

    def test_splines_stay_and_ellipses_get_axes_and_an_angle(self):
        found = self.constrained(parts.ellipse_in_wave())[0]
        self.assert_sound(found)
        values = {c.kind: c.value for c in found.dimensions}
        self.assertAlmostEqual(values["major"], 12, places=6)
        self.assertAlmostEqual(values["minor"], 6, places=6)
        self.assertAlmostEqual(math.degrees(values["angle"]) % 30, 0, places=6)
        self.assertEqual(len(found.profile.fixed), 2)

    def test_an_elliptic_arc_holds_together(self):
        found = self.constrained(parts.quarter_ellipse())[0]
        self.assert_sound(found)
        self.assertIn("major", self.kinds(found))

    def test_what_the_file_states_counts_where_measurement_alone_would_not(self):
        def radii(**more):
            d = parts.Drawing()
            d.polygon([(0, 0), (80, 0), (80, 50), (0, 50)])
            d.circle((20, 25), 8.0)
            d.circle((60, 25), 8.17)
            return self.kinds(self.constrained(d, **more)[0])["radius"]

        stated = [{"kind": "equal_radius", "strokes": [4, 5]}]
        self.assertEqual((radii(), radii(regularities=stated)), (2, 1))

    def test_a_hole_in_the_middle_is_held_by_the_corners(self):
        d = parts.Drawing()
        d.polygon([(0, 0), (80, 0), (80, 50), (0, 50)])
        d.circle((40, 25), 8)
        found = self.constrained(d)[0]
        self.assert_sound(found)
        self.assertEqual(self.kinds(found)["symmetric"], 1)
        self.assertEqual(len(found.dimensions), 3)

    def test_derivatives_are_those_of_the_residuals(self):
        profile = self.constrained(parts.quarter_ellipse())[0].profile
        equations = Equations(profile)
        rng = np.random.default_rng(1)
        x = profile.unknowns() + 0.1 * rng.standard_normal(len(profile.unknowns()))
        # Which element is which differs between libraries of linear algebra.
        at = {e.stroke: i for i, e in enumerate(profile.elements)}
        wanted = [
            Constraint("inner", ((at[2], 0),)),
            Constraint("tangent", ((at[0], 1), (at[2], 1))),
            Constraint("perpendicular", ((at[0], 0), (at[1], 0))),
            Constraint("distance_x", (ORIGIN, (at[2], 3)), 1.0),
        ]
        for c in wanted:
            r, j = equations.rows(c, x)
            d = 1e-5 * rng.standard_normal(len(x))
            change = equations.residual(c, x + d) - r
            np.testing.assert_allclose(change, j @ d, atol=1e-7, err_msg=c.kind)


class AddonTest(unittest.TestCase):
    def test_package_xml_names_files_and_the_class_that_there_are(self):
        root = xml.etree.ElementTree.parse(os.path.join(ADDON, "package.xml")).getroot()
        names = {e.tag.split("}")[1]: (e.text or "").strip() for e in root.iter()}
        self.assertTrue(os.path.isfile(os.path.join(ADDON, names["icon"])))
        with open(os.path.join(ADDON, "InitGui.py"), encoding="utf-8") as file:
            self.assertIn(f"class {names['classname']}(", file.read())
        xml.etree.ElementTree.parse(os.path.join(ADDON, names["icon"]))


if __name__ == "__main__":
    unittest.main()
