// SPDX-License-Identifier: MIT
// Faces of a solid under the curves of a viewer: triangles with a depth for each pixel, so that
// what is hidden is known, too. faces: [{points: [x, y, z, ...], triangles: [a, b, c, ...], color}],
// corners counter-clockwise seen from outside.
function makeSolid(faces) {
  const BIAS = .008;  // of the object: by so much an edge may lie behind the faces that it bounds
  const picture = document.createElement('canvas'), context = picture.getContext('2d');
  let width = 0, height = 0, depth = null, owner = null, image = null, ortho = false;
  const solid = {opacity: .6, marked: new Set(), render, paint, hides, faceAt};
  const at = (list, i) => [list[3 * i], list[3 * i + 1], list[3 * i + 2]];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  for (const face of faces) {  // of each corner the mean over its triangles: faces are smooth
    face.normals = new Float32Array(face.points.length);
    for (let t = 0; t < face.triangles.length; t += 3) {
      const [a, b, c] = face.triangles.slice(t, t + 3), p = at(face.points, a);
      const n = cross(minus(at(face.points, b), p), minus(at(face.points, c), p));
      for (const i of [a, b, c]) for (let k = 0; k < 3; ++k) face.normals[3 * i + k] += n[k];
    }
  }
  // Larger is nearer, and linear on the screen.
  const nearness = z => ortho ? 100 - z : 1 / z;
  // project(point): [x, y, depth] on the canvas [CSS px], light: unit vector towards it.
  function render(w, h, project, orthographic, light) {
    ortho = orthographic;
    if (w !== width || h !== height) {
      picture.width = width = w; picture.height = height = h;
      depth = new Float32Array(w * h); owner = new Int32Array(w * h);
      image = context.createImageData(w, h);
    }
    depth.fill(0); owner.fill(-1); image.data.fill(0);
    faces.forEach((face, id) => {
      const corners = [];
      for (let i = 0; i < face.points.length / 3; ++i) {
        const n = at(face.normals, i), e = project(at(face.points, i));
        const lit = Math.abs(n[0] * light[0] + n[1] * light[1] + n[2] * light[2]) / (Math.hypot(...n) || 1);
        corners.push([e[0], e[1], e[2] > 1e-3 ? nearness(e[2]) : NaN, .45 + .55 * lit]);
      }
      const color = solid.marked.has(id) ? [.96, .77, .2] : face.color;
      for (let t = 0; t < face.triangles.length; t += 3)
        fill(corners[face.triangles[t]], corners[face.triangles[t + 1]], corners[face.triangles[t + 2]], color, id);
    });
    context.putImageData(image, 0, 0);
  }
  function fill(a, b, c, color, id) {
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (!Number.isFinite(area + a[2] + b[2] + c[2]) || Math.abs(area) < 1e-9) return;
    const top = Math.max(0, Math.ceil(Math.min(a[1], b[1], c[1]))), bottom = Math.min(height - 1, Math.floor(Math.max(a[1], b[1], c[1])));
    const left = Math.max(0, Math.ceil(Math.min(a[0], b[0], c[0]))), right = Math.min(width - 1, Math.floor(Math.max(a[0], b[0], c[0])));
    for (let y = top; y <= bottom; ++y)
      for (let x = left; x <= right; ++x) {
        const v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
        const u = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
        if (v < -1e-6 || u < -1e-6 || v + u > 1 + 1e-6) continue;
        const i = y * width + x, near = a[2] + v * (b[2] - a[2]) + u * (c[2] - a[2]);
        if (near <= depth[i]) continue;
        depth[i] = near; owner[i] = id;
        const lit = 255 * (a[3] + v * (b[3] - a[3]) + u * (c[3] - a[3]));
        image.data[4 * i] = lit * color[0]; image.data[4 * i + 1] = lit * color[1];
        image.data[4 * i + 2] = lit * color[2]; image.data[4 * i + 3] = 255;
      }
  }
  function paint(onto) {
    onto.globalAlpha = solid.opacity;
    onto.drawImage(picture, 0, 0, width, height);
    onto.globalAlpha = 1;
  }
  // Is a point behind a face, and behind those about it?
  function hides(x, y, z) {
    const near = nearness(Math.max(1e-3, z - BIAS)), px = Math.round(x), py = Math.round(y);
    for (let v = py - 1; v <= py + 1; ++v)
      for (let u = px - 1; u <= px + 1; ++u)
        if (u < 0 || v < 0 || u >= width || v >= height || depth[v * width + u] <= near) return false;
    return true;
  }
  function faceAt(x, y) {
    const px = Math.round(x), py = Math.round(y);
    return solid.opacity > 0 && owner && px >= 0 && py >= 0 && px < width && py < height ? owner[py * width + px] : -1;
  }
  return solid;
}
