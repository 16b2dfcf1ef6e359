# SPDX-License-Identifier: MIT
"""What File > Open and File > Import of FreeCAD call for a sketch.json."""

import os

import FreeCAD

from .drawing import draw_result
from .sketch_file import SketchFileError


def open(filename):  # the name is FreeCAD's
    """Opens a result in a document of its own; returns the document, None if it cannot be used."""
    folder = os.path.basename(os.path.dirname(os.path.abspath(filename)))
    document = FreeCAD.newDocument(folder or "Result")
    if insert(filename, document.Name) is None:
        FreeCAD.closeDocument(document.Name)
        return None
    return document


def insert(filename, docname, mm_per_world=None):
    """Adds a result to a document; returns its group, None if the file cannot be used.

    `mm_per_world`: millimetres per world unit, None: what the files say.
    """
    try:
        document = FreeCAD.getDocument(docname)
    except NameError:
        document = FreeCAD.newDocument(docname)
    document.openTransaction("Open a result of sketchsplat")
    try:
        result = draw_result(document, filename, mm_per_world)
    except SketchFileError as e:
        document.abortTransaction()
        FreeCAD.Console.PrintError(f"{e}\n")
        return None
    document.commitTransaction()
    if FreeCAD.GuiUp:
        import FreeCADGui

        if FreeCADGui.ActiveDocument is not None and FreeCADGui.ActiveDocument.ActiveView:
            FreeCADGui.SendMsgToActiveView("ViewFit")
    return result
