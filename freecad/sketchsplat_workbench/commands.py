# SPDX-License-Identifier: MIT
"""Commands of the workbench."""

import os

import FreeCAD
import FreeCADGui
from PySide import QtGui

from . import importer, sketch_file
from .drawing import result_of, sketch_of, subgroup
from .sketcher import make_sketches

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def icon(name):
    return os.path.join(FOLDER, "resources", name)


class OpenResult:
    """Asks for a result folder and for its scale, and draws it into the active document."""

    def GetResources(self):
        return {
            "Pixmap": icon("icon.svg"),
            "MenuText": "Open result...",
            "ToolTip": "Draw the curves of a result folder, and its solid if there is one",
        }

    def IsActive(self):
        return True

    def Activated(self):
        window = FreeCADGui.getMainWindow()
        folder = QtGui.QFileDialog.getExistingDirectory(window, "Folder of a result")
        if not folder:
            return
        try:
            stated = sketch_file.stated_scale(sketch_file.sketch_path(folder))
        except sketch_file.SketchFileError as e:
            FreeCAD.Console.PrintError(f"{e}\n")
            return
        text = "Millimetres per unit of the scene:"
        scale, wanted = QtGui.QInputDialog.getDouble(
            window, "Scale", text, stated, 1e-9, 1e9, 6
        )
        if not wanted:
            return
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument()
        importer.insert(folder, document.Name, scale)


class MakeSketches:
    """Sketches of the loops that selected curves mean; of all planar faces of a result without."""

    def GetResources(self):
        return {
            "Pixmap": icon("sketch.svg"),
            "MenuText": "Make sketches",
            "ToolTip": "Constrained sketches of planar loops: of selected curves, or of all faces",
        }

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None

    def Activated(self):
        document = FreeCAD.ActiveDocument
        result, strokes = self._wanted(document)
        if result is None:
            FreeCAD.Console.PrintError("Select curves of a result, or its group\n")
            return
        document.openTransaction("Make sketches")
        try:
            group = subgroup(document, result, "Sketches")
            results = make_sketches(document, sketch_of(result), strokes, group)
        except Exception:
            document.abortTransaction()
            raise
        document.commitTransaction()
        for r in results:
            FreeCAD.Console.PrintMessage(r.summary() + "\n")
        if not results:
            FreeCAD.Console.PrintWarning("No closed planar loop runs through these curves\n")

    def _wanted(self, document):
        """(group of a result, selected strokes); a document's only result needs no selection."""
        selection = FreeCADGui.Selection.getSelection()
        results = [r for r in map(result_of, selection or document.Objects) if r is not None]
        if len({r.Name for r in results}) != 1:
            return None, []
        strokes = [o.Stroke for o in selection if hasattr(o, "Stroke")]
        return results[0], strokes


COMMANDS = {"Sketchsplat_Open": OpenResult, "Sketchsplat_Sketches": MakeSketches}


def register():
    """Makes the commands known to FreeCAD; returns their names."""
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command())
    return list(COMMANDS)
