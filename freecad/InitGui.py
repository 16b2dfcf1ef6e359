# SPDX-License-Identifier: MIT
import FreeCADGui


class SketchsplatWorkbench(FreeCADGui.Workbench):
    """Curves that sketchsplat found in images, and sketches of them."""

    MenuText = "sketchsplat"
    ToolTip = "Curves of CAD objects from images, and constrained sketches of them"

    def __init__(self):
        import os

        import sketchsplat_workbench

        folder = os.path.dirname(os.path.dirname(sketchsplat_workbench.__file__))
        self.__class__.Icon = os.path.join(folder, "resources", "icon.svg")

    def Initialize(self):
        from sketchsplat_workbench import commands

        names = commands.register()
        self.appendToolbar("sketchsplat", names)
        self.appendMenu("sketchsplat", names)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(SketchsplatWorkbench())
