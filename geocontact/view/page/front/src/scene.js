// Bodies over time: poses, colours, visibility, opacity, section plane. Draws only when something changed.
import { Color, Group, LessEqualDepth, Matrix4, Mesh, Scene, Vector3, Vector4, WebGLRenderer } from "three";
import { cameraFor } from "./camera.js";
import { geometryOf } from "./geometry.js";
import { linkageOf } from "./linkages.js";
import { materialOf, sharedUniforms, showQuantity } from "./material.js";
import { unpack } from "./unpack.js";

const INSIDES = ["#8a6d52", "#5b6b80", "#7a5a70", "#5f7a5a"];

/** The drawn scene, or an error where the browser cannot. */
export async function openScene(data, canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  const shared = sharedUniforms(data);
  const world = new Scene();
  world.background = new Color();
  const bodies = [];
  for (const [k, described] of data.bodies.entries()) {
    const maps = data.maps.map((map) => (map.body === k ? map.values : null));
    bodies.push(await bodyOf(described, maps, shared, data, INSIDES[k % INSIDES.length]));
    world.add(bodies[k].group);
  }
  const linkages = await Promise.all(data.linkages.map(linkageOf));
  for (const each of linkages) world.add(each.group);
  const moving = [...bodies, ...linkages];
  const reach = reachOf(bodies);
  for (const each of linkages) each.reach(reach);
  const view = cameraFor(data, canvas, reach, [...pointsOf(bodies), ...linkages.flatMap((each) => each.some())]);
  let waiting = 0;
  let shown = -1;
  const listeners = [];

  function draw() {
    waiting = 0;
    renderer.render(world, view.camera);
    for (const listen of listeners) listen();
  }
  const later = () => (waiting ||= requestAnimationFrame(draw));

  function fit() {
    const { clientWidth: width, clientHeight: height } = canvas.parentElement;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    shared.pixel.value = ratio;
    view.fit(width, height);
    draw();
  }
  /** Takes the colours that the page has now: of its scheme, or of paper. */
  function repaint() {
    const style = getComputedStyle(canvas);
    const colourOf = (name) => style.getPropertyValue(`--${name}`).trim();
    world.background.set(colourOf("scene"));
    for (const each of linkages) each.repaint(colourOf);
  }
  /** Paper is light in either scheme, with all that lies over the picture. */
  function onPaper(on) {
    canvas.closest(".scene").classList.toggle("paper", on);
    repaint();
    draw();
  }
  repaint();
  new ResizeObserver(fit).observe(canvas.parentElement);
  view.changed(later);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    repaint();
    later();
  });
  window.addEventListener("beforeprint", () => onPaper(true));
  window.addEventListener("afterprint", () => onPaper(false));
  canvas.addEventListener("webglcontextrestored", fit); // the renderer has put its programs and arrays back by then

  const scene = {
    view,
    canvas,
    bodies,
    /** Whether a point of the scene is cut away by the section plane. */
    cutAway: (point) => shared.sectioned.value && shared.section.value.x * point.x + shared.section.value.y * point.y + shared.section.value.z * point.z > shared.section.value.w,
    reach,
    draw,
    onPaper,
    /** Draws as many pixels across as wanted, where that is more than now; the function it returns undoes that. */
    enlarge(pixels) {
      const { clientWidth: width, clientHeight: height } = canvas.parentElement;
      const most = renderer.capabilities.maxTextureSize;
      const ratio = Math.min(Math.max(pixels / width, renderer.getPixelRatio()), most / Math.max(width, height));
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height, false);
      shared.pixel.value = ratio;
      draw();
      return fit;
    },
    drawn: (listen) => listeners.push(listen),
    show(frame) {
      if (frame === shown) return;
      shown = frame;
      for (const each of moving) each.show(frame);
      later();
    },
    setQuantity(quantity) {
      showQuantity(shared, quantity);
      for (const body of bodies) body.setMap(quantity.map, shown);
      later();
    },
    /** Which contour is bold: the first. */
    setThresholds(thresholds) {
      shared.thresholds.value = thresholds;
      later();
    },
    setVisible(k, visible) {
      moving[k].group.visible = visible;
      later();
    },
    setOpacity(k, opacity) {
      bodies[k].setOpacity(opacity);
      later();
    },
    /** Axis 0, 1, 2 or null for none; part 0 … 1 of the scene's extent; which side is cut away. */
    setSection(axis, part, flipped) {
      shared.sectioned.value = axis !== null;
      if (axis !== null) {
        const normal = [0, 0, 0];
        normal[axis] = flipped ? -1 : 1;
        const at = reach.lower.getComponent(axis) + part * (reach.upper.getComponent(axis) - reach.lower.getComponent(axis));
        shared.section.value.set(...normal, flipped ? -at : at);
      }
      later();
    },
  };
  fit();
  return scene;
}

async function bodyOf(described, maps, shared, data, inside) {
  const [steps, faces, poses, distance, exact, ...amounts] = await Promise.all(
    [described.positions, described.faces, described.poses, described.distance, described.source?.vertices, ...maps].map((block) => block && unpack(block)),
  );
  const geometry = geometryOf(steps, faces, described.size);
  const material = materialOf(shared, data, inside);
  const group = new Group();
  const depth = material.clone(); // drawn first where see-through, so that only the nearest layer is seen
  Object.assign(depth.uniforms, material.uniforms);
  Object.assign(depth, { colorWrite: false });
  const [before, surface] = [new Mesh(geometry, depth), new Mesh(geometry, material)];
  group.add(before, surface);
  for (const mesh of group.children) mesh.frustumCulled = false;
  group.matrixAutoUpdate = false;
  const vertices = steps.length / 3;
  const code = geometry.getAttribute("code");
  let map = null;

  function setOpacity(opacity) {
    const solid = opacity >= 0.99;
    material.uniforms.opacity.value = opacity;
    material.transparent = !solid;
    material.depthFunc = LessEqualDepth;
    material.needsUpdate = true;
    before.visible = !solid;
    depth.transparent = true; // after everything solid
    before.renderOrder = 1;
    surface.renderOrder = solid ? 0 : 2;
  }

  function show(frame) {
    matrixOf(poses, Math.min(frame, poses.length / 12 - 1), group.matrix);
    group.matrixWorldNeedsUpdate = true;
    colour(frame);
  }

  /** One code per corner: that of its vertex, or that of its face. */
  function colour(frame) {
    const codes = map === null ? distance : amounts[map];
    if (!codes || frame < 0) return;
    const from = (map === null ? vertices : faces.length / 3) * frame;
    for (let i = 0; i < faces.length; i++) code.array[i] = codes[from + (map === null ? faces[i] : Math.floor(i / 3))];
    code.needsUpdate = true;
  }

  /** Colour by a map on faces, or by distance (null); plain where this body has none. */
  function setMap(chosen, frame) {
    map = chosen;
    material.uniforms.coloured.value = Boolean(map === null ? distance : amounts[map]);
    colour(frame);
  }

  /** Colour faces that are named, those on the positive side of a plane (mm, in the frame of the file) apart (`scale`: mm of the unit of the file); null: none. */
  function mark(named) {
    const shown = named && named.count === faces.length / 3;
    const uniforms = material.uniforms;
    uniforms.marked.value = Boolean(shown);
    body.marked = shown ? named.faces.reduce((sum, each) => sum + each, 0) : 0;
    if (!shown) return;
    for (let i = 0; i < faces.length; i++) code.array[i] = named.faces[Math.floor(i / 3)] ? 1 : 255;
    code.needsUpdate = true;
    uniforms.divided.value = Boolean(named.medial);
    if (named.medial) uniforms.plane.value.copy(planeInScene(named.medial, named.scale, body));
  }
  /** Colour what is within a threshold: a level for each vertex, 128 where its distance is the threshold, less within. */
  function markWithin(levels) {
    const shown = levels.length === vertices;
    material.uniforms.marked.value = shown;
    body.marked = shown ? levels.reduce((sum, each) => sum + (each < 128), 0) : 0;
    for (let i = 0; shown && i < faces.length; i++) code.array[i] = levels[faces[i]];
    code.needsUpdate = true;
  }
  setOpacity(described.opacity);
  const source = described.source && { ...described.source, faces, exact };
  const body = { group, geometry, poses, setOpacity, setMap, show, mark, markWithin, marked: 0, source, size: described.size };
  return body;
}

/** A plane [n, d] of the frame of the mesh file in that of the scene, which does not turn it; both in mm. */
function planeInScene([x, y, z, offset], scale, { source, geometry, group }) {
  const normal = new Vector3(x, y, z);
  // the first corner of the first face, in both frames
  const scene = new Vector3().fromBufferAttribute(geometry.getAttribute("position"), 0).applyMatrix4(group.matrix);
  const file = new Vector3().fromArray(source.exact, 3 * source.faces[0]).multiplyScalar(scale);
  return new Vector4(x, y, z, offset + normal.dot(scene) - normal.dot(file));
}

function matrixOf(poses, k, matrix = new Matrix4()) {
  const p = poses.subarray(12 * k, 12 * k + 12);
  return matrix.set(p[0], p[1], p[2], p[9], p[3], p[4], p[5], p[10], p[6], p[7], p[8], p[11], 0, 0, 0, 1);
}

/** Box around all bodies in all frames (corners of their boxes), mm about the scene's middle. */
function reachOf(bodies) {
  const lower = new Vector3().setScalar(Infinity);
  const upper = new Vector3().setScalar(-Infinity);
  const matrix = new Matrix4();
  const point = new Vector3();
  for (const { poses, size } of bodies) {
    for (let k = 0; k < poses.length / 12; k++) {
      matrixOf(poses, k, matrix);
      for (let corner = 0; corner < 8; corner++) {
        point.set(...size.map((edge, a) => (corner & (1 << a) ? 0.5 : -0.5) * edge)).applyMatrix4(matrix);
        lower.min(point);
        upper.max(point);
      }
    }
  }
  return { lower, upper };
}

/** Some points of all bodies in some frames, for the camera to fit. */
function pointsOf(bodies) {
  const found = [];
  const matrix = new Matrix4();
  for (const { poses, geometry } of bodies) {
    const position = geometry.getAttribute("position");
    const frames = poses.length / 12;
    for (let k = 0; k < frames; k += Math.max(1, Math.floor(frames / 9))) {
      matrixOf(poses, k, matrix);
      for (let i = 0; i < position.count; i += Math.max(1, Math.floor(position.count / 1500))) {
        found.push(new Vector3().fromBufferAttribute(position, i).applyMatrix4(matrix));
      }
    }
  }
  return found;
}
