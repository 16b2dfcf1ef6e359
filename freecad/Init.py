# SPDX-License-Identifier: MIT
import FreeCAD

FreeCAD.addImportType("sketchsplat result (*.json)", "sketchsplat_workbench.importer")
