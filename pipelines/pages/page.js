// SPDX-License-Identifier: MIT
// What pages share.
const $ = id => document.getElementById(id);
function add(parent, tag, text, cls) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (cls) e.className = cls;
  return parent.appendChild(e);
}
const show = x => x === null || x === undefined ? '' : typeof x !== 'number' ? String(x) : Number.isInteger(x) ? String(x) : String(+x.toPrecision(4));
// The first `texts` columns are texts, all others numbers. Returns the rows.
function addTable(parent, head, rows, texts, onRow) {
  const t = add(add(parent, 'div', undefined, 'scroll'), 'table'), h = add(add(t, 'thead'), 'tr'), body = add(t, 'tbody');
  head.forEach((x, i) => add(h, 'th', x, i < texts ? 't' : ''));
  return rows.map((row, r) => {
    const tr = add(body, 'tr');
    row.forEach((x, i) => add(tr, 'td', show(x), i < texts ? 't' : ''));
    if (onRow) { tr.className = 'pick'; tr.onclick = () => onRow(r); }
    return tr;
  });
}
const rgb = c => `rgb(${c.map(x => Math.round(255 * x)).join(',')})`;

// A 3D view of polylines, drawn on a plain canvas: what browsers without a graphics card have, too.
// items: [{points: [x, y, z, ...]}], the object in [-0.5, 0.5], z up. look(item, id, chord) is the
// colour [r, g, b] of a chord in [0, 1], or null if it is not shown; picked(id, point) is called at
// a click on an item (point: of the curve), picked(-1) beside all of them. `solid`, if any, is drawn
// between what it hides and what it does not (solid.js); a click on a face of it alone is
// picked(-1, null, face).
function makeViewer(canvas, items, look, picked, solid = null) {
  const START = {yaw: -0.9, pitch: 0.5, distance: 2.3, target: [0, 0, 0]};
  const FOCAL = 2.4, NEAR = 1e-3;
  let camera = structuredClone(START), marked = -1, orthographic = false, queued = false;
  let marks = [];            // points to show, the last two with a line between them
  const context = canvas.getContext('2d');

  // The viewer's axes: right, up, towards the viewer.
  function axes() {
    const cy = Math.cos(camera.yaw), sy = Math.sin(camera.yaw), cp = Math.cos(camera.pitch), sp = Math.sin(camera.pitch);
    return [[-sy, cy, 0], [-sp * cy, -sp * sy, cp], [cp * cy, cp * sy, sp]];
  }
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  // To [x, y, depth] in the viewer's frame, and from there to the canvas [CSS px].
  function eye(frame, p) {
    const q = [p[0] - camera.target[0], p[1] - camera.target[1], p[2] - camera.target[2]];
    return [dot(frame[0], q), dot(frame[1], q), camera.distance - dot(frame[2], q)];
  }
  function place(e) {
    const w = canvas.clientWidth, h = canvas.clientHeight, s = FOCAL / 2 * Math.min(w, h) / (orthographic ? camera.distance : e[2]);
    return [w / 2 + s * e[0], h / 2 - s * e[1]];
  }
  function clipped(a, b) {  // the part of a chord before the viewer, as two places; null if there is none
    if (!orthographic) {
      if (a[2] < NEAR && b[2] < NEAR) return null;
      const cut = (p, q) => p.map((v, i) => v + (q[i] - v) * (NEAR - p[2]) / (q[2] - p[2]));
      if (a[2] < NEAR) a = cut(a, b); else if (b[2] < NEAR) b = cut(b, a);
    }
    return [place(a), place(b)];
  }
  function eyes(frame, item) {
    const out = [];
    for (let i = 0; i + 2 < item.points.length; i += 3) out.push(eye(frame, item.points.slice(i, i + 3)));
    return out;
  }
  function drawItem(item, id, points) {
    context.lineWidth = id === marked ? 4.5 : 2;
    let color = null, last = null;
    for (let i = 0; i + 1 < points.length; ++i) {
      const wanted = look(item, id, i), chord = wanted && clipped(points[i], points[i + 1]);
      if (!chord) { last = null; continue; }
      const name = id === marked ? 'rgb(234,179,8)' : rgb(wanted);
      if (name !== color || !last || last[0] !== chord[0][0] || last[1] !== chord[0][1]) {
        if (name !== color && color !== null) { context.stroke(); context.beginPath(); }
        context.strokeStyle = color = name;
        context.moveTo(...chord[0]);
      }
      context.lineTo(...chord[1]);
      last = chord[1];
    }
    if (color !== null) context.stroke();
    context.beginPath();
  }
  // What no face hides, over the faces.
  function drawSeen(item, id, points) {
    context.lineWidth = id === marked ? 4.5 : 2;
    for (let i = 0; i + 1 < points.length; ++i) {
      const color = look(item, id, i), chord = color && clipped(points[i], points[i + 1]);
      if (!chord) continue;
      context.strokeStyle = id === marked ? 'rgb(234,179,8)' : rgb(color);
      const pieces = Math.max(1, Math.min(200, Math.ceil(Math.hypot(chord[1][0] - chord[0][0], chord[1][1] - chord[0][1]) / 5)));
      const along = t => points[i].map((v, k) => v + (points[i + 1][k] - v) * t);
      context.beginPath();
      for (let k = 0; k < pieces; ++k) {
        const middle = along((k + .5) / pieces), piece = clipped(along(k / pieces), along((k + 1) / pieces));
        if (!piece || solid.hides(...place(middle), middle[2])) continue;
        context.moveTo(...piece[0]); context.lineTo(...piece[1]);
      }
      context.stroke();
    }
  }
  function drawSolid(frame, order) {
    if (!solid || !(solid.opacity > 0)) return;
    const light = [0, 1, 2].map(k => frame[2][k] * .9 + frame[1][k] * .35 + frame[0][k] * .25);
    const project = p => { const e = eye(frame, p); return [...place(e), e[2]]; };
    solid.render(Math.max(1, Math.round(canvas.clientWidth)), Math.max(1, Math.round(canvas.clientHeight)), project, orthographic, light);
    solid.paint(context);
    for (const {item, id, points} of order) drawSeen(item, id, points);
  }
  function drawMarks(frame) {
    context.strokeStyle = context.fillStyle = 'rgb(220,38,38)';
    context.lineWidth = 1.5;
    const places = marks.map(p => place(eye(frame, p)));
    if (places.length === 2) { context.beginPath(); context.moveTo(...places[0]); context.lineTo(...places[1]); context.stroke(); }
    for (const p of places) { context.beginPath(); context.arc(p[0], p[1], 4, 0, 7); context.fill(); }
  }
  function draw() {
    queued = false;
    const ratio = devicePixelRatio || 1, w = Math.round(canvas.clientWidth * ratio), h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, w, h);
    context.lineCap = context.lineJoin = 'round';
    context.beginPath();
    const frame = axes();
    const order = items.map((item, id) => {
      const points = eyes(frame, item);
      return {item, id, points, depth: points.reduce((sum, p) => sum + p[2], 0) / (points.length || 1)};
    });
    order.sort((a, b) => (a.id === marked) - (b.id === marked) || b.depth - a.depth || a.id - b.id);
    for (const {item, id, points} of order) drawItem(item, id, points);
    drawSolid(frame, order);
    drawMarks(frame);
  }
  function redraw() {
    if (!queued) { queued = true; requestAnimationFrame(draw); }
  }

  // The item within 8 px, and the point of it.
  function at(px, py) {
    const frame = axes();
    let best = 8, found = {id: -1, point: null};
    items.forEach((item, id) => {
      const points = eyes(frame, item);
      for (let i = 0; i + 1 < points.length; ++i) {
        const chord = look(item, id, i) && clipped(points[i], points[i + 1]);
        if (!chord) continue;
        const [a, b] = chord, dx = b[0] - a[0], dy = b[1] - a[1];
        const t = Math.max(0, Math.min(1, ((px - a[0]) * dx + (py - a[1]) * dy) / (dx * dx + dy * dy || 1)));
        const d = Math.hypot(a[0] + t * dx - px, a[1] + t * dy - py);
        if (d >= best) continue;
        best = d;
        // ends are what people mean near an end; else the share of the chord as it is seen
        const near = Math.hypot(dx, dy) * Math.min(t, 1 - t) < 6 ? Math.round(t) : t;
        const p = item.points.slice(3 * i, 3 * i + 3), q = item.points.slice(3 * i + 3, 3 * i + 6);
        const za = orthographic ? 1 : points[i][2], zb = orthographic ? 1 : points[i + 1][2];
        const s = near * za / (zb + near * (za - zb) || 1);  // perspective
        found = {id, point: p.map((v, k) => v + (q[k] - v) * s)};
      }
    });
    return found;
  }

  const turn = (dx, dy) => {
    camera.yaw -= dx;
    camera.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, camera.pitch + dy));
    redraw();
  };
  const move = (dx, dy) => {  // [CSS px]
    const frame = axes(), s = camera.distance / (FOCAL / 2 * Math.min(canvas.clientWidth, canvas.clientHeight) || 1);
    camera.target = camera.target.map((v, k) => v - s * (dx * frame[0][k] - dy * frame[1][k]));
    redraw();
  };
  const zoom = k => { camera.distance = Math.max(0.01, Math.min(20, camera.distance * k)); redraw(); };
  const fingers = new Map();
  let moved = 0;
  canvas.tabIndex = 0;
  canvas.oncontextmenu = e => e.preventDefault();
  canvas.onpointerdown = e => {
    canvas.setPointerCapture(e.pointerId);
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    moved = 0;
  };
  canvas.onpointerup = canvas.onpointercancel = e => {
    fingers.delete(e.pointerId);
    if (e.type !== 'pointerup' || moved >= 4 || e.button !== 0) return;
    const {id, point} = at(e.offsetX, e.offsetY);
    picked(id, point, id < 0 && solid ? solid.faceAt(e.offsetX, e.offsetY) : -1);
  };
  canvas.onpointermove = e => {
    const last = fingers.get(e.pointerId);
    if (!last) return;
    const dx = e.offsetX - last[0], dy = e.offsetY - last[1];
    moved += Math.hypot(dx, dy);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)[1];
      zoom(Math.hypot(last[0] - other[0], last[1] - other[1]) / Math.max(1, Math.hypot(e.offsetX - other[0], e.offsetY - other[1])));
    } else if (e.shiftKey || e.buttons & 2) move(dx, dy);
    else turn(dx * 0.008, dy * 0.008);
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
  };
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    zoom(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.003));
  }, {passive: false});
  canvas.ondblclick = e => {
    const {id} = at(e.offsetX, e.offsetY);
    id < 0 ? viewer.reset() : viewer.focus(id);
  };
  canvas.addEventListener('keydown', e => {
    const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[e.key];
    if (steps) e.shiftKey ? move(-30 * steps[0], -30 * steps[1]) : turn(-0.1 * steps[0], -0.1 * steps[1]);
    else if (e.key === '+' || e.key === '=') zoom(0.85);
    else if (e.key === '-') zoom(1 / 0.85);
    else return;
    e.preventDefault();
  });
  new ResizeObserver(redraw).observe(canvas);

  const viewer = {
    ok: Boolean(context),
    upload: redraw,
    draw,
    mark(id) { marked = id; redraw(); },
    marks(points) { marks = points; redraw(); },
    orthographic(on) { orthographic = on; redraw(); },
    reset() { camera = structuredClone(START); redraw(); },
    look(yaw, pitch) { Object.assign(camera, {yaw, pitch}); redraw(); },
    // Turns about this item, which fills a good part of the view.
    focus(id) {
      const p = items[id].points, low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
      if (!p.length) return;
      p.forEach((v, i) => { low[i % 3] = Math.min(low[i % 3], v); high[i % 3] = Math.max(high[i % 3], v); });
      camera.target = low.map((v, k) => (v + high[k]) / 2);
      camera.distance = Math.max(0.05, 3 * Math.hypot(...low.map((v, k) => high[k] - v)));
      redraw();
    },
    // Where a point is on the canvas [CSS px].
    place: p => place(eye(axes(), p)),
  };
  redraw();
  return viewer;
}
const viewerHelp = ok => ok ?
    'drag or arrows: turn, shift or right drag: move, wheel or + -: zoom, click: pick, double click: zoom to a curve, or reset' :
    'This browser has no canvas, so there is no 3D view.';
