#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# addon_test.sh python|freecad SOURCE FOLDER [BINARY]: the add-on for FreeCAD, without FreeCAD or in
# it, without a window. With BINARY also over a result of the program. Exit status 77, with a word,
# where Python with numpy or FreeCAD is missing. PYTHON in the environment is tried first.
set -euo pipefail
mode=$1 source=$2 folder=$3 binary=${4:-}
tests=$source/tests/freecad
export PYTHONDONTWRITEBYTECODE=1

first_of() {  # COMMANDS: the first that is there
  local name
  for name in "$@"; do command -v "$name" 2>/dev/null && return; done
}

if [ "$mode" = python ]; then
  for python in "${PYTHON:-}" /usr/bin/python3 python3; do
    [ -n "$python" ] && "$python" -c 'import numpy' 2>/dev/null || continue
    exec "$python" "$tests/addon_test.py" "$source/freecad"
  done
  echo "skipped: no Python with numpy here"
  exit 77
fi

freecad=$(first_of freecadcmd FreeCADCmd freecad.cmd) || true
[ -n "$freecad" ] || { echo "skipped: no FreeCAD here"; exit 77; }
rm -rf "$folder"
mkdir -p "$folder"
folder=$(readlink -f "$folder")
# Nothing of whoever runs this: the add-on is installed as docs/freecad.md says.
export HOME=$folder/home SKETCHSPLAT_TESTS=$tests SKETCHSPLAT_FOLDER=$folder/parts
unset XDG_DATA_HOME XDG_CONFIG_HOME XDG_CACHE_HOME
mkdir -p "$HOME" "$SKETCHSPLAT_FOLDER"
echo 'print("data:" + FreeCAD.getUserAppDataDir())' >"$folder/where.py"
data=$("$freecad" "$folder/where.py" </dev/null 2>/dev/null | sed -n 's/^data://p')
[ -n "$data" ] || { echo "failed: $freecad does not say where add-ons belong" >&2; exit 1; }
mkdir -p "$data/Mod"
ln -s "$source/freecad" "$data/Mod/sketchsplat"
if [ -n "$binary" ]; then
  "$binary" synthesize l-bracket --views 16 --resolution 320 --outputs none --quiet \
    --out "$folder/scene" >/dev/null
  "$binary" reconstruct "$folder/scene" --preset fast --overlays 0 --quiet \
    --out "$folder/result" >/dev/null
  export SKETCHSPLAT_RESULT=$folder/result
fi
exec "$freecad" "$tests/in_freecad.py" </dev/null
