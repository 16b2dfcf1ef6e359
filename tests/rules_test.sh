#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# rules_test.sh SOURCE BUILD [RULE]: what holds of every file of the repository. Rules: licences,
# packages, cgal, style_sheet, words, commands, columns, folders, loops, names.
set -uo pipefail
build=$(readlink -f "$2")
cd "$1"
failed=0
fail() { echo "failed: $*" >&2; failed=1; }

# Files that people write, without data that programs compare with.
sources() {  # PATTERNS
  find . -type d \( -name '.git' -o -name 'build*' -o -name 'out*' -o -path ./tests/golden \) -prune \
    -o -type f "$@" -print
}

licences() {
  grep -q '^MIT License' LICENSE || fail "LICENSE is not the MIT licence"
  local file
  while read -r file; do
    head -n 3 "$file" | grep -q 'SPDX-License-Identifier: MIT' ||
      fail "$file: expected SPDX-License-Identifier: MIT in its first lines"
  done < <(sources \( -name '*.cc' -o -name '*.h' -o -name '*.py' -o -name '*.sh' -o -name '*.cmake' \
    -o -name CMakeLists.txt -o -name '*.yml' -o -name '*.html' -o -name '*.css' -o -name '*.js' \
    -o -name '*.in' -o -path ./run -o -path ./.ci/run -o -name Containerfile -o -name '.clang-*' \))
}

packages() {  # every package that ./run installs, and every library that CMake looks for
  local name
  for name in $(sed -n '/^packages=(/,/^)/{s/#.*//;s/packages=(//;s/)//;p}' run); do
    grep -q "\`$name\`" docs/licences.md || fail "docs/licences.md does not name the package $name"
  done
}

cgal() {  # no header of CGAL under the GPL takes part in a build
  local header count=0
  while read -r header; do
    count=$((count + 1))
    ! grep -q 'SPDX-License-Identifier: GPL' "$header" || fail "$header is under the GPL"
  done < <(ninja -C "$build" -t deps | grep -o '/[^ ]*/include/CGAL/[^ ]*' | sort -u)
  [ $count -gt 0 ] || fail "the build has read no header of CGAL"
}

style_sheet() {  # a formatter of C++ makes of color-scheme: what no browser knows
  ! grep -nE '[a-z] - [a-z]| : |[0-9] %' pipelines/pages/page.css || fail "pipelines/pages/page.css is no CSS"
}

words() {  # README.md is short, and what it and docs/ link to exists
  [ "$(wc -l <README.md)" -le 100 ] || fail "README.md has more than 100 lines"
  [ "$(tr -d '|' <README.md | wc -w)" -le 1000 ] || fail "README.md has more than 1000 words"
  local page link
  for page in README.md docs/*.md; do
    while read -r link; do
      case $link in http*) continue ;; esac
      [ -e "$(dirname "$page")/${link%%#*}" ] || fail "$page links to $link, which is not there"
    done < <(grep -o '](\([^)]*\))' "$page" | sed 's/](\(.*\))/\1/')
  done
}

commands() {  # the first block of README.md has the two commands of a fresh machine, and CI runs the second
  local block
  block=$(awk '/^```/ { inside++; next } inside == 1' README.md)
  local command
  for command in demo test; do
    grep -q "^\./run $command\b" <<<"$block" || fail "the first block of README.md lacks ./run $command"
    [[ $(./run help 2>&1) == *"./run $command "* ]] || fail "./run does not know $command"
  done
  grep -q '/run" test' .ci/run || fail ".ci/run does not call ./run test"
}

columns() {  # as .clang-format has it; texts of JSON may be longer
  local line
  while read -r line; do fail "more than 100 columns: $line"; done < <(
    sources \( -name '*.cc' -o -name '*.h' -o -name '*.py' \) |
      LC_ALL=C.UTF-8 xargs grep -nE '^.{101,}' | grep -v 'R"(' | cut -c1-80)
}

folders() {  # code reads headers of its own folder, and of folders that its target links
  local line
  while read -r line; do fail "$line"; done < <(
    find datasets sketches raster topology edges eval pipelines \( -name '*.cc' -o -name '*.h' \) \
      -exec grep -Ho '^#include ".*/' {} + | sed 's/:#include "/ /' |
      awk '
        function reach(from, to, i, n, next_one) {  # by links, through any number of others
          if (seen[to]++) return
          below[from, to] = 1
          n = split(links[to], next_one)
          for (i = 1; i <= n; i++) {
            if (next_one[i] == from) print "a cycle: " from " -> ... -> " to " -> " from
            reach(from, next_one[i])
          }
        }
        FNR == NR {
          target[$1] = $2
          for (i = 3; i <= NF; i++) links[$2] = links[$2] " " $i
          next
        }
        FNR == 1 { for (f in target) { split("", seen); reach(target[f], target[f]) } }
        {
          folder = header = $0
          sub("/[^/]* .*", "", folder)
          sub(".* ", "", header)
          sub("/$", "", header)
          if (!(folder in target)) print folder " belongs to no target"
          else if (header in target && !((target[folder], target[header]) in below))
            print $1 " reads a header of " header ", which " target[folder] " does not link"
        }' "$build/generated/folders" -)
}

loops() {  # an exception that leaves a parallel region of OpenMP ends the program
  local line
  while read -r line; do fail "$line: expected parallel_for of datasets/types/parallel.h"; done < <(
    sources \( -name '*.cc' -o -name '*.h' \) | grep -v '^./datasets/types/parallel.h$' |
      xargs grep -n '#pragma omp parallel')
}

names() {  # a linker takes either of two types of one name for both (one-definition rule)
  local name
  while read -r name; do fail "$name is defined in two headers"; done < <(
    sources -name '*.h' | xargs awk '
      /^namespace .*\{/ { space = $2 }
      /^(struct|class) [A-Z]/ && !/;$/ { print space "::" $2 }' | sort | uniq -d)
}

for rule in ${3:-licences packages cgal style_sheet words commands columns folders loops names}; do $rule; done
[ $failed = 0 ] && echo passed
exit $failed
