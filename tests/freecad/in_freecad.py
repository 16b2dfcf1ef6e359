# SPDX-License-Identifier: MIT
"""What the add-on does in FreeCAD, without a window. Run by addon_test.sh with freecadcmd.

SKETCHSPLAT_TESTS: this folder; SKETCHSPLAT_FOLDER: a folder to write into; SKETCHSPLAT_RESULT: a
result of the program, if there is one.
"""

import math
import os
import sys
import traceback
import unittest

import FreeCAD
import Part

sys.path.insert(0, os.environ["SKETCHSPLAT_TESTS"])
import parts  # noqa: E402
from sketchsplat_workbench import drawing, importer, sketcher  # noqa: E402

FOLDER = os.environ["SKETCHSPLAT_FOLDER"]
RESULT = os.environ.get("SKETCHSPLAT_RESULT")
IMPORTER = "sketchsplat_workbench.importer"


class DocumentTest(unittest.TestCase):
    def tearDown(self):
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)

    def write(self, name, part, **more):
        folder = os.path.join(FOLDER, name)
        os.makedirs(folder, exist_ok=True)
        part.write(os.path.join(folder, "sketch.json"), **more)
        return folder

    def opened(self, name, part, **more):
        """(document, group of the result)"""
        folder = self.write(name, part, **more)
        document = importer.open(os.path.join(folder, "sketch.json"))
        return document, document.getObjectsByLabel(name)[0]

    def sketches(self, name, part, selected=(), **more):
        document, result = self.opened(name, part, **more)
        group = drawing.subgroup(document, result, "Sketches")
        made = sketcher.make_sketches(document, drawing.sketch_of(result), selected, group)
        self.assertEqual([o.Name for o in group.Group], [r.object.Name for r in made])
        return document, sorted(made, key=lambda r: -len(r.object.Shape.Wires))

    def assert_solved(self, result):
        """FreeCAD agrees: no conflict, nothing redundant, nothing free."""
        obj = result.object
        self.assertEqual(obj.solve(), 0, result.summary())
        self.assertEqual(result.freedom, 0, result.summary())
        self.assertTrue(obj.FullyConstrained, result.summary())
        for name in ("Conflicting", "Redundant", "PartiallyRedundant", "Malformed"):
            self.assertFalse(getattr(obj, name + "Constraints", []), name)  # FreeCAD 0.21
        self.assertFalse(obj.OpenVertices)

    def area(self, obj):
        return Part.makeFace(obj.Shape.Wires, "Part::FaceMakerBullseye").Area


class OpenTest(DocumentTest):
    def test_file_open_knows_the_add_on(self):
        self.assertIn(IMPORTER, FreeCAD.getImportType("json"))
        folder = self.write("by_type", parts.plate())
        FreeCAD.loadFile(os.path.join(folder, "sketch.json"), "", IMPORTER)
        self.assertEqual(len(FreeCAD.ActiveDocument.findObjects("Part::Feature")), 14)

    def test_curves_are_exact_and_in_groups_by_type(self):
        _, result = self.opened("wave", parts.ellipse_in_wave())
        groups = {g.Label: g.Group for g in result.Group}
        self.assertEqual({k: len(v) for k, v in groups.items()},
                         {"Lines": 3, "Splines": 1, "Ellipses": 1})
        ellipse = groups["Ellipses"][0].Shape.Curve
        self.assertAlmostEqual(ellipse.MajorRadius, 12)
        self.assertAlmostEqual(ellipse.MinorRadius, 6)
        self.assertEqual(groups["Splines"][0].Shape.Curve.Degree, 3)

    def test_circles_and_arcs_of_ellipses_have_their_radii(self):
        _, result = self.opened("plate", parts.plate())
        circles = next(g.Group for g in result.Group if g.Label == "Circles")
        self.assertEqual([round(c.Shape.Curve.Radius, 9) for c in circles], [8, 8])
        _, result = self.opened("quarter", parts.quarter_ellipse())
        arc = next(g.Group[0] for g in result.Group if g.Label == "Ellipses").Shape
        self.assertAlmostEqual(arc.Curve.MajorRadius, 30, places=6)
        corners = [v.Point for v in arc.Vertexes]
        self.assertAlmostEqual(corners[0].distanceToPoint(corners[1]), math.hypot(30, 20), places=6)

    def test_evidence_is_in_properties_and_inferred_strokes_stand_apart(self):
        plate = parts.plate()
        plate.strokes[-1]["inferred"] = True
        _, result = self.opened("inferred", plate)
        groups = {g.Label: g.Group for g in result.Group}
        self.assertEqual(len(groups["Inferred"]), 1)
        line = groups["Lines"][0]
        self.assertAlmostEqual(line.Confidence, 0.9)
        self.assertEqual((line.SupportViews, line.Kind), (12, "line"))
        self.assertAlmostEqual(line.Sigma.Value, 1e-4)

    def test_the_solid_comes_along_at_the_scale_that_is_asked_for(self):
        folder = self.write("solid", parts.plate(), scale={"unit": "mm", "units_per_world": 2})
        Part.makeBox(2, 2, 2).exportStep(os.path.join(folder, "solid.step"))
        document = FreeCAD.newDocument()
        for scale, volume in ((None, 8), (4, 64)):
            result = importer.insert(folder, document.Name, scale)
            solids = next(g.Group for g in result.Group if g.Label.startswith("Solids"))
            self.assertAlmostEqual(solids[0].Shape.Volume, volume, places=6)

    def test_a_file_that_is_none_opens_nothing(self):
        path = os.path.join(FOLDER, "broken.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write("{}")
        self.assertIsNone(importer.open(path))
        self.assertFalse(FreeCAD.listDocuments())

    def test_a_saved_document_needs_no_result_folder_any_more(self):
        document, _ = self.opened("saved", parts.plate())
        path = os.path.join(FOLDER, "saved.FCStd")
        document.saveAs(path)
        FreeCAD.closeDocument(document.Name)
        os.remove(os.path.join(FOLDER, "saved", "sketch.json"))
        result = FreeCAD.openDocument(path).getObjectsByLabel("saved")[0]
        self.assertEqual(len(drawing.sketch_of(result).strokes), 14)


class SketchTest(DocumentTest):
    def test_faces_of_a_noisy_plate_are_solved_and_closed(self):
        _, made = self.sketches("noisy", parts.plate(noise=0.02))
        self.assertEqual(len(made), 6)
        for result in made:
            self.assert_solved(result)
            self.assertEqual(result.dropped, [])
        self.assertAlmostEqual(self.area(made[0].object), 80 * 50 - math.pi * 64, delta=5)

    def test_slots_ellipses_splines_and_hexagons_are_solved(self):
        areas = {
            "slotted_sheet": 60 * 40 - 20 * 10 - math.pi * 25,
            "hexagon": 1.5 * math.sqrt(3) * 400,
            "ellipse_in_wave": None,
            "quarter_ellipse": math.pi * 30 * 20 / 4,
        }
        for name, area in areas.items():
            _, made = self.sketches(name, getattr(parts, name)())
            self.assert_solved(made[0])
            if area is not None:
                self.assertAlmostEqual(self.area(made[0].object), area, delta=0.01)

    def test_sketches_lie_where_the_curves_are(self):
        _, made = self.sketches("place", parts.plate())
        _, result = self.opened("again", parts.plate())
        curves = Part.Compound([o.Shape for g in result.Group for o in g.Group])
        for r in made:
            for vertex in r.object.Shape.Vertexes:
                self.assertLess(curves.distToShape(vertex)[0], 1e-6)

    def test_a_selected_hole_is_a_sketch_of_its_own(self):
        _, made = self.sketches("hole", parts.plate(), selected=[13])
        self.assertEqual(len(made), 1)
        self.assertAlmostEqual(made[0].object.Shape.Length, 16 * math.pi, places=6)

    def test_open_curves_make_no_sketch(self):
        d = parts.Drawing()
        d.line(d.node(0, 0), d.node(10, 0))
        _, made = self.sketches("open", d)
        self.assertEqual(made, [])


class PartDesignTest(DocumentTest):
    def test_pad_and_pocket_follow_the_dimensions(self):
        document, made = self.sketches("pad", parts.plate(), selected=[0, 1])
        sheet = made[0].object
        sketch = drawing.sketch_of(document.getObjectsByLabel("pad")[0])
        top = sketcher.make_sketches(document, sketch, [4, 5])[0].object
        body = document.addObject("PartDesign::Body", "Body")
        body.addObject(sheet)
        pad = body.newObject("PartDesign::Pad", "Pad")
        pad.Profile = sheet
        pad.Length = 10
        pad.Reversed = True  # into the part: its faces look outward
        document.recompute()
        self.assertAlmostEqual(pad.Shape.Volume, (4000 - 64 * math.pi) * 10, places=3)
        self.assert_follows(document, sheet, pad, body, top)

    def assert_follows(self, document, sheet, pad, body, top):
        radius = next(i for i, c in enumerate(sheet.Constraints) if c.Type == "Radius")
        sheet.setDatum(radius, FreeCAD.Units.Quantity("5 mm"))
        document.recompute()
        self.assertEqual(sheet.solve(), 0)
        self.assertAlmostEqual(pad.Shape.Volume, (4000 - 25 * math.pi) * 10, places=3)
        body.addObject(top)
        pocket = body.newObject("PartDesign::Pocket", "Pocket")
        pocket.Profile = top  # the opposite face, without its hole of radius 8
        pocket.Length = 4
        document.recompute()
        left = (4000 - 25 * math.pi) * 10 - (4000 - 64 * math.pi) * 4
        self.assertAlmostEqual(pocket.Shape.Volume, left, places=3)


@unittest.skipUnless(RESULT, "no result of the program")
class ResultTest(DocumentTest):
    def test_all_faces_of_a_reconstruction_are_solved(self):
        document = FreeCAD.newDocument()
        result = importer.insert(RESULT, document.Name, 100)
        made = sketcher.make_sketches(document, drawing.sketch_of(result))
        self.assertGreater(len(made), 3)
        for r in made:
            self.assert_solved(r)


def main():
    """Ends the process: freecadcmd would ask for more, and tells no status."""
    status = 1
    try:
        suite = unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])
        outcome = unittest.TextTestRunner(stream=sys.stdout).run(suite)
        status = 0 if outcome.wasSuccessful() and outcome.testsRun > 0 else 1
    except Exception:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(status)


main()  # freecadcmd runs it under a name of its own
