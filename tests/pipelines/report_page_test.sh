#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# report_page_test.sh BINARY FOLDER: report.html in a browser without a screen: curves are drawn where
# the viewer says, over the photographs where the edges are; one is picked in the view and in the
# table; kinds are hidden, distances measured, keys understood; faces of the solid hide what is behind
# them, and are picked. Exit status 77, with a word, without Chromium.
set -euo pipefail
binary=$1 folder=$2
fail() { echo "failed: $*" >&2; exit 1; }
for browser in chromium chromium-browser google-chrome ""; do
  [ -n "$browser" ] && command -v "$browser" >/dev/null && break
done
[ -n "$browser" ] || { echo "skipped: no Chromium here"; exit 77; }

rm -rf "$folder"
mkdir -p "$folder"
"$binary" synthesize box-hole --views 16 --resolution 240 --outputs none --quiet --out "$folder/scene" >/dev/null
"$binary" reconstruct "$folder/scene" --quiet --out "$folder/result" >/dev/null
page=$folder/result/report.html
[ "$(stat -c %s "$page")" -le 3000000 ] || fail "at most 3 MB: $(stat -c %s "$page")"

sed 's|</body>||; s|</html>||' "$page" >"$folder/try.html"
cat >>"$folder/try.html" <<'PAGE'
<script>
const said = [];
onerror = message => said.push('error: ' + message);
const check = (what, ok) => said.push(`${ok ? 'ok' : 'NOT'}: ${what}`);
const canvas = $('view');
canvas.setPointerCapture = () => {};  // these fingers are none of a screen's
function click(x, y) {
  canvas.onpointerdown({pointerId: 1, offsetX: x, offsetY: y});
  canvas.onpointerup({type: 'pointerup', pointerId: 1, button: 0, offsetX: x, offsetY: y});
}
const press = (key, more) => canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true, ...more}));
// Pixels of about this colour in a canvas, in a square about a place [CSS px] or everywhere.
function pixels(surface, color, x, y, radius) {
  const ratio = devicePixelRatio, box = x === undefined ? [0, 0, surface.width, surface.height] :
    [(x - radius) * ratio, (y - radius) * ratio, 2 * radius * ratio, 2 * radius * ratio].map(Math.round);
  const bytes = surface.getContext('2d').getImageData(...box).data;
  let n = 0;
  for (let i = 0; i < bytes.length; i += 4)
    n += bytes[i + 3] > 200 && color.every((c, k) => Math.abs(255 * c - bytes[i + k]) < 40);
  return n;
}
const middleOf = c => c.points.length > 6 ? c.points.slice(3 * Math.floor(c.points.length / 6)).slice(0, 3) :
  [0, 1, 2].map(k => (c.points[k] + c.points[3 + k]) / 2);
$('opacity').value = 0; $('opacity').oninput();  // edges first
const circle = curves.findIndex(c => c.kind === 'circle'), line = curves.findIndex(c => c.kind === 'line');
check('a box with a hole has lines and circles', circle >= 0 && line >= 0);
check('it says so first', /curves: .*lines.*circle.*They fill .* (mm|units)/.test($('summary').textContent));
check('and how sure it is', /Sure \(90 % and more\): \d+ of \d+/.test($('summary').textContent));

viewer.draw();
const at = viewer.place(middleOf(curves[circle]));
check('a circle is drawn in the colour of circles where it is', pixels(canvas, kindColor.circle, at[0], at[1], 4) > 3);
click(...at);
check('a click picks what is there', selected >= 0 && $('info').textContent.includes('#' + curves[selected].curve));
viewer.draw();
check('what is picked is drawn in another colour', pixels(canvas, [.92, .7, .03], at[0], at[1], 4) > 3);
check('its row is marked', rows[selected].classList.contains('on') && rows[selected].cells[0].textContent === String(curves[selected].curve));
press('Escape');
check('Escape lets go', selected === -1 && $('info').textContent === '');
rows[line].onclick();
check('a row picks its curve', selected === line && /line, length [\d.e-]+ (mm|units)/.test($('info').textContent));
press('n');
check('n goes on to the next', selected === (line + 1) % curves.length);
press('f');
const box = [0, 1, 2].map(k => curves[selected].points.filter((v, i) => i % 3 === k)).map(v => (Math.min(...v) + Math.max(...v)) / 2);
const centre = viewer.place(box);
check('f moves it into the middle of the view', Math.hypot(centre[0] - canvas.clientWidth / 2, centre[1] - canvas.clientHeight / 2) < 1);
press('r');
click(1, 1);
check('a click beside all curves lets go', selected === -1);

const before = viewer.place([.5, .5, .5]);
press('ArrowLeft');
const turned = viewer.place([.5, .5, .5]);
check('arrows turn', Math.hypot(before[0] - turned[0], before[1] - turned[1]) > 3);
press('r');
press('o');
const near = viewer.place([.3, -.3, 0]), far = viewer.place([-.3, .3, 0]), origin = viewer.place([0, 0, 0]);
check('without perspective what is far is as large as what is near',
  Math.abs(Math.hypot(near[0] - origin[0], near[1] - origin[1]) - Math.hypot(far[0] - origin[0], far[1] - origin[1])) < .01);
press('o');

press('m');
const ends = [curves[line].points.slice(0, 3), curves[line].points.slice(3, 6)];
ends.forEach(p => click(...viewer.place(p)));
check('the distance between the ends of a line is its length', (() => {
  const told = /distance ([\d.e-]+) (?:mm|units)/.exec($('info').textContent);
  return told && Math.abs(Number(told[1]) - curves[line].length) < .01 * curves[line].length;
})());
press('m');

const circles = [...document.querySelectorAll('#legend input')][data.kinds.filter(k => curves.some(c => c.kind === k.name)).findIndex(k => k.name === 'circle')];
viewer.draw();
const some = pixels(canvas, kindColor.circle);
circles.checked = false; circles.onchange(); viewer.draw();
check('a kind can be hidden', some > 20 && pixels(canvas, kindColor.circle) < some / 10);
circles.checked = true; circles.onchange();
press('c'); viewer.draw();
check('confidence colours what is sure green', pixels(canvas, [.08, .6, .3]) > 50);
press('c'); press('c');
check('every view is there', photos.length === 16 && $('frame').max === '15');
$('frame').value = 5; $('frame').oninput(); $('fade').value = 0; $('fade').oninput();
check('the slider shows another', $('caption').textContent.includes('6 of 16'));
const over = toPixel(photos[5], middleOf(curves[line]));
check('curves lie over the photograph where its camera sees them', over && pixels($('photo'), kindColor.line, over[0], over[1], 4) > 2);
$('photo').onclick({offsetX: over[0], offsetY: over[1]});
check('a click on the photograph picks, too', selected >= 0);
if ($('worries').querySelector('button')) {
  $('worries').querySelector('button').click();
  check('a worry shows its curves alone', worry && curves.some((c, i) => !shown(c, i)));
}
check('it says which solid the curves bound', /They bound a solid: .*planes; volume/.test($('summary').textContent));
press('r'); $('opacity').value = 1; $('opacity').oninput(); viewer.draw();
const onBody = [canvas.clientWidth / 2, canvas.clientHeight / 2 - 10];
check('the slider fills the solid', pixels(canvas, [.78, .8, .82], ...onBody, 30) > 500);
check('and hides what is behind it', curves.some((c, i) => c.points.length > 6 && pixels(canvas, kindColor.circle, ...viewer.place(c.points.slice(0, 3)), 3) === 0));
const holes = surfaces.findIndex(s => s.kind === 'cylinder');
faceRows['surface' + holes].onclick(); viewer.draw();
check('a row of the surfaces marks its face', solid.marked.has(holes) && /radius/.test($('info').textContent) && pixels(canvas, [.8, .64, .17]) > 30);
faceRows['dimension0'].onclick();
check('a row of the dimensions marks what it is taken of', solid.marked.size === new Set(dimensions[0].faces).size && / ± /.test($('info').textContent));
press('Escape');
check('Escape lets go of faces', solid.marked.size === 0);
check('a click on a face picks it', [[0, 0], [90, 40], [-90, 40], [0, 70]].some(([x, y]) => {  // some are on curves
  click(onBody[0] + x, onBody[1] + y);
  return solid.marked.size === 1;
}));
check('tables are folded away', [...document.querySelectorAll('details')].every(d => !d.open) && document.querySelectorAll('details').length >= 3);

// The photograph itself, and the edge in it, once it is decoded
photoImage.decode().then(() => {
  $('fade').value = 1; drawPhoto();
  const surface = $('photo'), bytes = surface.getContext('2d').getImageData(0, 0, surface.width, surface.height).data;
  const greys = new Set();
  for (let i = 0; i < bytes.length; i += 400) greys.add(bytes[i]);
  check('the photograph fades in', greys.size > 4);
}).catch(e => check('the photograph can be decoded: ' + e, false)).finally(() => { document.body.textContent = said.join('\n'); });
</script></body></html>
PAGE
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/browser" --window-size=1200,900 \
  --virtual-time-budget=5000 --dump-dom "file://$folder/try.html" 2>/dev/null |
  sed -n '/^<.*body>/,$p' | sed 's/<[^>]*>//g' >"$folder/said.txt"
grep -E '^(NOT|error)' "$folder/said.txt" >&2 && fail "see above"
[ "$(grep -c '^ok' "$folder/said.txt")" -ge 30 ] || { cat "$folder/said.txt" >&2; fail "a script that did not end"; }
echo "passed: $(grep -c '^ok' "$folder/said.txt") checks"
