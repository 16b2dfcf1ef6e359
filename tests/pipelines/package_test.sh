#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# package_test.sh BUILD FOLDER: what is installed runs from wherever it is put, and loads what was
# installed with it, not what lies in the build folder.
set -euo pipefail
build=$1 folder=$2
fail() { echo "failed: $*" >&2; exit 1; }

rm -rf "$folder"
cmake --install "$build" --prefix "$folder/first" --component program >/dev/null
mv "$folder/first" "$folder/moved"
prefix=$folder/moved
for file in bin/sketchsplat lib/sketchsplat/sketchsplat_synthesis.so \
  lib/sketchsplat/sketchsplat_image_formats.so lib/sketchsplat/charts.py \
  share/doc/sketchsplat/copyright share/doc/sketchsplat/CHANGELOG.md \
  lib/sketchsplat/sketchsplat_brep.so share/sketchsplat/slurm/submit.sh \
  share/sketchsplat/freecad/InitGui.py share/sketchsplat/freecad/sketchsplat_workbench/importer.py; do
  [ -s "$prefix/$file" ] || fail "$file is not installed"
done

run() {  # PLUGIN ARGUMENTS: runs the program, which must load that one
  local plugin=$1
  shift
  LD_DEBUG=files LD_DEBUG_OUTPUT="$folder/loaded" "$prefix/bin/sketchsplat" "$@" --quiet >/dev/null
  [ -z "$plugin" ] || grep -qh "calling init: $prefix/bin/../lib/sketchsplat/$plugin" "$folder"/loaded.* ||
    fail "$1 did not load the $plugin that is installed"
  rm -f "$folder"/loaded.*
}
run sketchsplat_synthesis.so synthesize box --views 12 --resolution 160 --outputs none --out "$folder/scene"
run "" reconstruct "$folder/scene" --preset fast --out "$folder/result"
run "" bench "$folder/scene" --presets fast --out "$folder/bench"
run "" batch "$folder/scene" --preset fast --out "$folder/batch"
[ -s "$folder/batch/scene/sketch.step" ] || fail "no result"
run sketchsplat_brep.so reconstruct "$folder/scene" --preset fast --out "$folder/solid"
echo passed
