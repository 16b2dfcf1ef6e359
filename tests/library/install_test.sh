#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# install_test.sh SOURCE BUILD FOLDER: what is installed serves programs of others from wherever it
# is put: headers that compile alone, examples/ built by CMake, the Python module.
set -euo pipefail
source=$1 build=$2 folder=$3
fail() { echo "failed: $*" >&2; exit 1; }

rm -rf "$folder"
cmake --install "$build" --prefix "$folder/first" --component library >/dev/null
mv "$folder/first" "$folder/moved"
prefix=$folder/moved

eigen=$(sed -n 's/^Eigen3_DIR:PATH=//p' "$build/CMakeCache.txt")
for header in "$prefix"/include/sketchsplat/*.h; do
  "${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror -fsyntax-only -x c++ -I"$prefix/include" \
    -isystem /usr/include/eigen3 -isystem "$eigen/../../../include/eigen3" - \
    <<<"#include <sketchsplat/$(basename "$header")>" ||
    fail "$header does not compile alone"
done

for example in "$source"/examples/*.cc; do
  [ "$(wc -l <"$example")" -le 30 ] || fail "$example has more than 30 lines"
done
generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt")  # the one that is here
cmake -S "$source/examples" -B "$folder/examples" -G "$generator" -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$folder/examples" >/dev/null
linked=$(ldd "$folder/examples/from_folder")
[[ $linked == *"$prefix/lib/libsketchsplat"* ]] ||
  fail "the examples are not linked with what is installed"
nm -DC --defined-only "$prefix"/lib/libsketchsplat.so | grep -E 'StrokeJudge|OpenMP|CLI::App::parse' &&
  fail "the library shows what is inside"

"$folder/examples/from_images" >"$folder/square"
[ "$(grep -c '^line of length 1\|^line of length 0\.[789]\|^line of length 1\.' "$folder/square")" = 4 ] ||
  fail "a square is no four lines: $(cat "$folder/square")"
"$folder/examples/from_edges" >"$folder/circle"
grep -qE '^circle of radius 0\.(50|49)' "$folder/circle" || fail "no circle: $(cat "$folder/circle")"
"$build/pipelines/sketchsplat" synthesize box --views 12 --resolution 200 --outputs none --quiet \
  --out "$folder/scene" >/dev/null
"$folder/examples/from_folder" "$folder/scene" "$folder/box.step" >"$folder/box" 2>"$folder/stages"
grep -qE '^solid of volume 0\.[0-9]' "$folder/box" || fail "no solid, or no plug-in that knows: $(cat "$folder/box")"
[ -s "$folder/box.step" ] || fail "no STEP file"
grep -q '^detect$' "$folder/stages" || fail "no progress"
grep -qE '^F5 (100|9[0-9])' "$folder/box" || fail "a box is not found: $(cat "$folder/box")"

module=$(find "$prefix" -name 'sketchsplat*.so' -path '*packages*')
if [ -n "$module" ]; then
  PYTHONPATH=$(dirname "$module") SKETCHSPLAT_BINARY=$build/pipelines/sketchsplat \
    "${PYTHON:-python3}" "$source/tests/library/python_test.py" || fail "the Python module"
fi
echo passed
