// Points and lines over time: a ball for each point, a rod for each line; what is not known is not drawn.
import { Color, CylinderGeometry, GLSL3, Group, InstancedMesh, Matrix4, Quaternion, RawShaderMaterial, SphereGeometry, Vector3 } from "three";
import { svg } from "./svg.js";
import { unpack } from "./unpack.js";

const MISSING = 65535;
const NOTHING = new Matrix4().makeScale(0, 0, 0);
const ALONG = new Vector3(0, 1, 0); // axis of three.js' cylinder

const VERTEX = `
precision highp float;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
in vec3 position, normal;
in mat4 instanceMatrix;
out vec3 seen;
void main() {
  seen = mat3(viewMatrix) * mat3(instanceMatrix) * normal;
  gl_Position = projectionMatrix * viewMatrix * modelMatrix * instanceMatrix * vec4(position, 1.0);
}`;

const FRAGMENT = `
precision highp float;
uniform vec3 tone;
in vec3 seen;
out vec4 shown;
void main() {
  shown = vec4(tone * (0.7 + 0.4 * max(dot(normalize(seen), normalize(vec3(0.35, 0.5, 0.8))), 0.0)), 1.0);
}`;

/** What is drawn of one linkage; `show(frame)` moves it, `some()` are points for the camera to fit. */
export async function linkageOf(described) {
  const { corner, size, lines, radius, width } = described;
  const words = await unpack(described.points);
  const [frames, row] = described.points.shape;
  const count = row / 3;
  const tone = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { tone: { value: new Color() } },
  });
  const balls = new InstancedMesh(new SphereGeometry(radius, 12, 8), tone, radius > 0 ? count : 0);
  const rods = new InstancedMesh(new CylinderGeometry(width / 2, width / 2, 1, 8), tone, lines.length);
  const group = new Group();
  group.add(balls, rods);
  for (const mesh of group.children) mesh.frustumCulled = false;

  /** Place of a point [mm] about the scene's middle, null where it is not known. */
  function at(frame, k, place = new Vector3()) {
    const from = Math.min(frame, frames - 1) * row + 3 * k;
    if (words[from] === MISSING) return null;
    return place.set(...corner.map((start, a) => start + (words[from + a] / 65535) * size[a]));
  }

  const [from, to, middle] = [new Vector3(), new Vector3(), new Vector3()];
  const [matrix, turn, scale] = [new Matrix4(), new Quaternion(), new Vector3()];
  function rod([a, b], frame) {
    if (!at(frame, a, from) || !at(frame, b, to)) return NOTHING;
    middle.addVectors(from, to).multiplyScalar(0.5);
    const length = to.sub(from).length();
    if (!length) return NOTHING;
    return matrix.compose(middle, turn.setFromUnitVectors(ALONG, to.divideScalar(length)), scale.set(1, length, 1));
  }

  return {
    group,
    /** Takes the colour that its tone has in the page's scheme. */
    repaint: (colourOf) => tone.uniforms.tone.value.set(colourOf(described.tone)),
    show(frame) {
      for (let k = 0; k < balls.count; k++) {
        const place = at(frame, k, from);
        balls.setMatrixAt(k, place ? matrix.makeTranslation(place) : NOTHING);
      }
      lines.forEach((line, k) => rods.setMatrixAt(k, rod(line, frame)));
      balls.instanceMatrix.needsUpdate = rods.instanceMatrix.needsUpdate = true;
    },
    /** Widens a box to hold all places. */
    reach({ lower, upper }) {
      lower.min(new Vector3(...corner));
      upper.max(new Vector3(...corner.map((start, a) => start + size[a])));
    },
    some() {
      const found = [];
      for (let frame = 0; frame < frames; frame += Math.max(1, Math.floor(frames / 20))) {
        for (let k = 0; k < count; k++) found.push(at(frame, k));
      }
      return found.filter((place) => place);
    },
  };
}

const [ROW, DOT, LETTER, BETWEEN] = [18, 16, 6.4, 18]; // of a legend, in pixels at its size of type

/** Legend of a scene of linkages alone: a dot and a name for each, in as many rows as the width asks for. */
export function names(place, scene) {
  const label = scene.linkages.map(({ name }) => name).join(", ");
  const bar = svg("svg", { role: "img", "aria-label": label });
  place.replaceChildren(bar);
  function fill() {
    const style = getComputedStyle(place);
    const room = place.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    if (!(room > 0)) return;
    let [x, row] = [0, 0];
    const drawn = scene.linkages.flatMap(({ name, tone }) => {
      const most = Math.max(1, Math.floor((room - DOT) / LETTER));
      const text = name.length > most ? `${name.slice(0, most - 1)}…` : name;
      const wide = DOT + LETTER * text.length;
      if (x && x + wide > room) [x, row] = [0, row + 1];
      const [at, y] = [x, ROW * row + ROW / 2 + 2];
      x += wide + BETWEEN;
      return [svg("circle", { class: `tone-${tone}`, cx: at + 6, cy: y, r: 5 }), svg("text", { class: "tick", x: at + DOT, y: y + 4 }, text)];
    });
    const tall = ROW * (row + 1) + 4;
    for (const [key, value] of Object.entries({ viewBox: `0 0 ${room} ${tall}`, width: room, height: tall })) bar.setAttribute(key, value);
    bar.replaceChildren(...drawn);
  }
  new ResizeObserver(fill).observe(place);
  fill();
}
