#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# index_page_test.sh BINARY FOLDER: the page of a batch, in a browser without a screen: failures
# stand first, a click sorts, a word searches. Exit status 77, with a word, without Chromium.
set -euo pipefail
binary=$1 folder=$2
fail() { echo "failed: $*" >&2; exit 1; }
for browser in chromium chromium-browser google-chrome ""; do
  [ -n "$browser" ] && command -v "$browser" >/dev/null && break
done
[ -n "$browser" ] || { echo "skipped: no Chromium here"; exit 77; }

rm -rf "$folder"
mkdir -p "$folder/scenes/m-broken <b>"
echo '{' >"$folder/scenes/m-broken <b>/meta_data.json"
for i in 1 2; do
  "$binary" synthesize "$([ "$i" = 1 ] && echo box || echo l-bracket)" --views 12 --resolution 160 \
    --outputs none --quiet --seed "$i" --out "$folder/scenes/s$i" >/dev/null
done
"$binary" batch "$folder/scenes" --preset fast -q --out "$folder/results" >/dev/null 2>&1 || [ $? = 6 ]

# What the page shows after somebody has done something with it, as one line of text a row.
after() {  # SCRIPT
  local page=$folder/results/try.html
  sed 's|</body>||; s|</html>||' "$folder/results/index.html" >"$page"
  cat >>"$page" <<PAGE
<script>
const heading = text => [...document.querySelectorAll('th button')].find(b => b.textContent === text);
$1
document.body.textContent = [...document.querySelectorAll('#body tr')].filter(r => !r.hidden)
  .map(r => 'row: ' + [...r.cells].map(c => c.textContent).join('|')).join('\n');
</script></body></html>
PAGE
  "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/browser" --dump-dom \
    "file://$page" 2>/dev/null | grep -o 'row: .*' | sed 's/<.*//'
}
first() { after "$1" | head -n 1; }

[[ $(first "") == "row: m-broken "*"a JSON file"*" log|"* ]] || fail "failures first: $(first "")"
[ "$(after "" | wc -l)" = 3 ] || fail "three rows"
[ "$(after "" | grep -c 'row: s[12]|done|12|')" = 2 ] || fail "rows: $(after "")"
curves() { after "$1" | grep '|done|' | cut -d'|' -f4; }
[ "$(curves "" | sort -u | wc -l)" = 2 ] || fail "two parts of different numbers of curves expected"
curves "heading('curves').click()" | sort -n -c || fail "sorted by curves"
curves "heading('curves').click(); heading('curves').click()" | sort -n -r -c || fail "and back"
[[ $(after "heading('curves').click()" | tail -n 1) == *"row: m-broken "* ]] || fail "no number: at the end"
[ "$(after "document.getElementById('search').value = 'S2'; document.getElementById('search').oninput()" | wc -l)" = 1 ] ||
  fail "searched"
echo passed
