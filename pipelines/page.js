// SPDX-License-Identifier: MIT
// What pages share.
const $ = id => document.getElementById(id);
function add(parent, tag, text, cls) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (cls) e.className = cls;
  return parent.appendChild(e);
}
const show = x => typeof x !== 'number' ? String(x) :
    Number.isInteger(x)                 ? String(x) :
                                          String(+x.toPrecision(4));

// A 3D view of polylines: every chord is a quad of constant width on the screen.
// items: [{points: [x, y, z, ...]}], the object in [-0.5, 0.5], z up. look(item, id, chord) is the
// colour [r, g, b] of a chord in [0, 1], or null if it is not shown; picked(id) is called at a
// click on an item. Without WebGL2 there is nothing to see (ok: false).
function makeViewer(canvas, items, look, picked) {
  const yaw0 = -0.9, pitch0 = 0.5;
  let marked = -1, yaw = yaw0, pitch = pitch0, distance = 2.6, pan = [0, 0], queued = false;
  let program, count = 0, segments = [];
  const gl = canvas.getContext('webgl2', {antialias: true, premultipliedAlpha: false});
  if (!gl) return {ok: false, upload() {}, mark() {}};
  function upload() {
    segments = [];
    const flat = [];
    items.forEach((item, id) => {
      const p = item.points;
      for (let i = 0; i + 5 < p.length; i += 3) {
        const rgb = look(item, id, i / 3);
        if (!rgb) continue;
        flat.push(p[i], p[i + 1], p[i + 2], p[i + 3], p[i + 4], p[i + 5], ...rgb, id);
        segments.push([id, p.slice(i, i + 3), p.slice(i + 3, i + 6)]);
      }
    });
    count = segments.length;
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(flat), gl.STATIC_DRAW);
    redraw();
  }
  function camera() {  // world -> clip, column-major
    const cy = Math.cos(yaw), sy = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
    const x = [-sy, cy, 0], z = [cp * cy, cp * sy, sp], y = [-sp * cy, -sp * sy, cp];
    const f = 2.4, a = canvas.width / canvas.height, sx = f / Math.max(a, 1e-3) * Math.min(1, a),
          s = f * Math.min(1, a);
    const near = distance * 0.02, far = distance + 10, A = -(far + near) / (far - near),
          B = -2 * far * near / (far - near);
    const m = [];
    for (let i = 0; i < 3; ++i) m.push(sx * x[i], s * y[i], A * z[i], -z[i]);
    return [...m, sx * pan[0], s * pan[1], -A * distance + B, distance];
  }
  const clip =
      (m, p) => [0, 1, 2, 3].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
  function draw() {
    queued = false;
    const ratio = devicePixelRatio || 1, w = Math.round(canvas.clientWidth * ratio),
          h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== w || canvas.height !== h) {
      canvas.width = w;
      canvas.height = h;
    }
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const u = name => gl.getUniformLocation(program, name);
    gl.uniformMatrix4fv(u('m'), false, camera());
    gl.uniform2f(u('size'), w, h);
    gl.uniform1f(u('width'), 2.4 * ratio);
    gl.uniform1f(u('selected'), marked);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }
  function redraw() {
    if (!queued) {
      queued = true;
      requestAnimationFrame(draw);
    }
  }
  function at(px, py) {
    const m = camera(), w = canvas.clientWidth, h = canvas.clientHeight;
    const place = p => {
      const c = clip(m, p);
      return [(c[0] / c[3] + 1) * w / 2, (1 - c[1] / c[3]) * h / 2];
    };
    let best = 8, id = -1;
    for (const [item, p, q] of segments) {
      const a = place(p), b = place(q), dx = b[0] - a[0], dy = b[1] - a[1];
      const t = Math.max(
          0, Math.min(1, ((px - a[0]) * dx + (py - a[1]) * dy) / (dx * dx + dy * dy || 1)));
      const d = Math.hypot(a[0] + t * dx - px, a[1] + t * dy - py);
      if (d < best) {
        best = d;
        id = item;
      }
    }
    return id;
  }
  const shader = (type, text) => {
    const s = gl.createShader(type);
    gl.shaderSource(s, text);
    gl.compileShader(s);
    return s;
  };
  program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
    in vec3 a, b, rgb; in float id; uniform mat4 m; uniform vec2 size;
    uniform float width, selected; out vec3 c;
    void main() {
      vec4 p = m * vec4(a, 1.), q = m * vec4(b, 1.);
      float near = 1e-4;  // cut at the camera's plane
      if (p.w < near && q.w < near) { gl_Position = vec4(2., 2., 2., 1.); return; }
      if (p.w < near) p = mix(p, q, (near - p.w) / (q.w - p.w));
      else if (q.w < near) q = mix(q, p, (near - q.w) / (p.w - q.w));
      vec2 d = (q.xy / q.w - p.xy / p.w) * size; float l = length(d);
      d = l > 1e-6 ? d / l : vec2(1., 0.);
      bool on = id == selected; float w = on ? width * 2.2 : width;
      vec4 e = (gl_VertexID & 1) == 0 ? p : q;
      vec2 o = vec2(-d.y, d.x) * ((gl_VertexID & 2) == 0 ? -1. : 1.)
          + d * ((gl_VertexID & 1) == 0 ? -.5 : .5);
      e.xy += o * w / size * e.w;
      if (on) e.z -= .01 * e.w;
      gl_Position = e; c = on ? vec3(.92, .70, .03) : rgb;
    }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `#version 300 es
    precision mediump float; in vec3 c; out vec4 o; void main() { o = vec4(c, 1.); }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  [['a', 3, 0], ['b', 3, 12], ['rgb', 3, 24], ['id', 1, 36]].forEach(([name, n, offset]) => {
    const place = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, n, gl.FLOAT, false, 40, offset);
    gl.vertexAttribDivisor(place, 1);
  });
  const fingers = new Map();
  let moved = 0;
  const zoom = k => {
    distance = Math.max(0.05, Math.min(20, distance * k));
    redraw();
  };
  canvas.oncontextmenu = e => e.preventDefault();
  canvas.onpointerdown = e => {
    canvas.setPointerCapture(e.pointerId);
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    moved = 0;
  };
  canvas.onpointerup = canvas.onpointercancel = e => {
    fingers.delete(e.pointerId);
    if (e.type === 'pointerup' && moved < 4 && e.button === 0) {
      const id = at(e.offsetX, e.offsetY);
      if (id !== marked) picked(id);
    }
  };
  canvas.onpointermove = e => {
    const last = fingers.get(e.pointerId);
    if (!last) return;
    const dx = e.offsetX - last[0], dy = e.offsetY - last[1];
    moved += Math.hypot(dx, dy);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)[1];
      zoom(
          Math.hypot(last[0] - other[0], last[1] - other[1]) /
          Math.max(1, Math.hypot(e.offsetX - other[0], e.offsetY - other[1])));
    } else if (e.shiftKey || e.buttons & 2) {
      const s = distance / 2.4 * 2 / Math.min(canvas.clientWidth, canvas.clientHeight);
      pan = [pan[0] + dx * s, pan[1] - dy * s];
    } else {
      yaw -= dx * 0.008;
      pitch = Math.max(-1.57, Math.min(1.57, pitch + dy * 0.008));
    }
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    redraw();
  };
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    zoom(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.003));
  }, {passive: false});
  canvas.ondblclick = () => {
    [yaw, pitch, distance, pan] = [yaw0, pitch0, 2.6, [0, 0]];
    redraw();
  };
  new ResizeObserver(redraw).observe(canvas);
  upload();
  return {
    ok: true,
    upload,
    mark(id) {
      marked = id;
      redraw();
    }
  };
}
const viewerHelp = ok => ok ?
    'drag: turn, shift or right drag: move, wheel: zoom, click: pick, double click: reset' :
    'This browser has no WebGL2, so there is no 3D view.';
