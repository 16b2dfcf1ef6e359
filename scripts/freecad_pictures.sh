#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# freecad_pictures.sh [BINARY]: the pictures of docs/freecad.md, by FreeCAD on a screen that nobody
# sees. Needs FreeCAD and xvfb-run (Debian: freecad, freecad-python3, xvfb, xauth).
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
binary=$(readlink -f "${1:-build/pipelines/sketchsplat}")
for tool in "$binary" freecad freecadcmd xvfb-run; do
  command -v "$tool" >/dev/null || { echo "freecad_pictures.sh: $tool is missing" >&2; exit 1; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$binary" synthesize plate-holes --extent 80 --seed 3 --outputs none --quiet \
  --out "$folder/scene" >/dev/null
"$binary" reconstruct "$folder/scene" --overlays 0 --quiet --out "$folder/plate" >/dev/null

# Settings of its own, with the add-on in them and without the start page.
export HOME=$folder/home PYTHONDONTWRITEBYTECODE=1
unset XDG_DATA_HOME XDG_CONFIG_HOME XDG_CACHE_HOME
mkdir -p "$HOME"
cat >"$folder/settings.py" <<'PYTHON'
FreeCAD.ParamGet("User parameter:BaseApp/Preferences/General").SetString(
    "AutoloadModule", "SketchsplatWorkbench")
FreeCAD.saveParameter()
print("data:" + FreeCAD.getUserAppDataDir())
PYTHON
data=$(freecadcmd "$folder/settings.py" </dev/null 2>/dev/null | sed -n 's/^data://p')
mkdir -p "$data/Mod"
ln -s "$PWD/freecad" "$data/Mod/sketchsplat"
export SKETCHSPLAT_RESULT=$folder/plate SKETCHSPLAT_PICTURES=$PWD/docs
export LIBGL_ALWAYS_SOFTWARE=1 QTWEBENGINE_DISABLE_SANDBOX=1
timeout 120 xvfb-run -a -s "-screen 0 1100x680x24" freecad "$PWD/scripts/freecad_pictures.py"
ls -l docs/freecad_*.png
