# SPDX-License-Identifier: MIT
"""Takes the pictures of docs/freecad.md. Run by scripts/freecad_pictures.sh in FreeCAD.

SKETCHSPLAT_RESULT: a result folder; SKETCHSPLAT_PICTURES: the folder to write into.
"""

import os
import sys
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

RESULT = os.environ["SKETCHSPLAT_RESULT"]
PICTURES = os.environ["SKETCHSPLAT_PICTURES"]
SETTLE = 2000  # [ms] until everything is drawn
ZOOM = 3  # steps of the command until a sketch fills the window


def wait(milliseconds):
    loop = QtCore.QEventLoop()
    QtCore.QTimer.singleShot(milliseconds, loop.quit)
    loop.exec_()


def take(name):
    wait(SETTLE)
    picture = QtGui.QApplication.primaryScreen().grabWindow(0).toImage()
    few = QtCore.Qt.ThresholdDither | QtCore.Qt.AvoidDither
    path = os.path.join(PICTURES, name)
    if not picture.convertToFormat(QtGui.QImage.Format_Indexed8, few).save(path):
        raise OSError(f"{path}: expected a folder to write into")


def arrange():
    """The tree at the left, curves on white, nothing else."""
    window = FreeCADGui.getMainWindow()
    window.setGeometry(window.screen().geometry())
    for dock in window.findChildren(QtGui.QDockWidget):
        dock.setVisible(dock.objectName() == "Combo View")
    view = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/View")
    view.SetBool("Gradient", False)
    view.SetBool("Simple", True)
    view.SetInt("EditSketcherFontSize", 12)
    view.SetUnsigned("BackgroundColor", 0xFFFFFFFF)
    wait(SETTLE)


def picture_of_result(document):
    """The curves by type, and what the images say about one."""
    tree = FreeCADGui.getMainWindow().findChild(QtGui.QTreeWidget)
    tree.expandAll()
    circle = next(o for o in document.Objects if getattr(o, "Kind", "") == "circle")
    FreeCADGui.Selection.addSelection(circle)
    FreeCADGui.activeDocument().activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    take("freecad_result.png")
    FreeCADGui.Selection.clearSelection()


def picture_of_sketch(document):
    """A sketch of the face with most loops, with its constraints."""
    FreeCADGui.runCommand("Sketchsplat_Sketches")
    sketches = document.findObjects("Sketcher::SketchObject")
    for o in document.Objects:
        o.ViewObject.Visibility = False
    sketch = max(sketches, key=lambda s: len(s.Shape.Wires))
    for group in sketch.InListRecursive + [sketch]:
        group.ViewObject.Visibility = True
    for other in sketches:
        other.ViewObject.Visibility = other is sketch
    FreeCADGui.activeDocument().setEdit(sketch.Name)
    wait(SETTLE)
    FreeCADGui.SendMsgToActiveView("ViewFit")  # the axes, too
    for _ in range(ZOOM):
        FreeCADGui.runCommand("Std_ViewZoomIn")
    take("freecad_sketch.png")
    FreeCADGui.activeDocument().resetEdit()


def main():
    status = 1
    try:
        from sketchsplat_workbench import importer

        arrange()
        document = importer.open(os.path.join(RESULT, "sketch.json"))
        picture_of_result(document)
        picture_of_sketch(document)
        status = 0
    except Exception:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(status)


QtCore.QTimer.singleShot(SETTLE, main)
