// Surface of one body for drawing: corners unshared, normals smooth except across creases.
import { BufferAttribute, BufferGeometry } from "three";

const CREASE = Math.cos((35 * Math.PI) / 180);

/** Geometry in mm about the centre of the body's box, with room for one distance code per corner. */
export function geometryOf(steps, faces, size) {
  const corners = new Float32Array(3 * faces.length);
  for (let i = 0; i < faces.length; i++) {
    for (let a = 0; a < 3; a++) corners[3 * i + a] = (steps[3 * faces[i] + a] / 65535 - 0.5) * size[a];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals(corners, faces, steps.length / 3), 3, true));
  geometry.setAttribute("code", new BufferAttribute(new Uint8Array(faces.length).fill(255), 1));
  geometry.computeBoundingSphere();
  return geometry;
}

/** Per corner: sum of the area vectors of the faces at its vertex that are not across a crease. */
function normals(corners, faces, vertices) {
  const count = faces.length / 3;
  const area = new Float32Array(3 * count);
  const length = new Float32Array(count);
  for (let f = 0; f < count; f++) {
    const p = 9 * f;
    const [ux, uy, uz] = [corners[p + 3] - corners[p], corners[p + 4] - corners[p + 1], corners[p + 5] - corners[p + 2]];
    const [vx, vy, vz] = [corners[p + 6] - corners[p], corners[p + 7] - corners[p + 1], corners[p + 8] - corners[p + 2]];
    area[3 * f] = uy * vz - uz * vy;
    area[3 * f + 1] = uz * vx - ux * vz;
    area[3 * f + 2] = ux * vy - uy * vx;
    length[f] = Math.hypot(area[3 * f], area[3 * f + 1], area[3 * f + 2]) || 1e-30;
  }
  const start = new Uint32Array(vertices + 1);
  for (const vertex of faces) start[vertex + 1]++;
  for (let i = 0; i < vertices; i++) start[i + 1] += start[i];
  const around = new Uint32Array(faces.length);
  const next = start.slice();
  for (let i = 0; i < faces.length; i++) around[next[faces[i]]++] = Math.floor(i / 3);

  const packed = new Int16Array(3 * faces.length);
  for (let i = 0; i < faces.length; i++) {
    const own = Math.floor(i / 3);
    let [x, y, z] = [0, 0, 0];
    for (let k = start[faces[i]]; k < start[faces[i] + 1]; k++) {
      const f = around[k];
      const dot = area[3 * own] * area[3 * f] + area[3 * own + 1] * area[3 * f + 1] + area[3 * own + 2] * area[3 * f + 2];
      if (f !== own && dot < CREASE * length[own] * length[f]) continue;
      x += area[3 * f];
      y += area[3 * f + 1];
      z += area[3 * f + 2];
    }
    const scale = 32767 / (Math.hypot(x, y, z) || 1);
    packed[3 * i] = Math.round(x * scale);
    packed[3 * i + 1] = Math.round(y * scale);
    packed[3 * i + 2] = Math.round(z * scale);
  }
  return packed;
}
