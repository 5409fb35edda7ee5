// An orthographic camera: no perspective, so that lengths in the picture can be measured.
import { OrthographicCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const MARGIN = 1.08;

/** Camera that turns about the middle of the scene, with presets. */
export function cameraFor(data, canvas, reach, points) {
  const up = new Vector3(...data.up).normalize();
  const presets = data.directions.map(([, vector]) => new Vector3(...vector).normalize());
  const opening = new Vector3(...data.view);
  const middle = reach.lower.clone().add(reach.upper).multiplyScalar(0.5);
  const distance = 4 * reach.upper.distanceTo(reach.lower) || 1;
  const camera = new OrthographicCamera(-1, 1, 1, -1, 0, 2 * distance);
  camera.up.copy(up);
  const controls = new OrbitControls(camera, canvas);
  controls.minZoom = 0.2;
  controls.maxZoom = 50;
  let [width, height] = [1, 1];

  let half = [1, 1];

  /** Look from a direction, everything in the picture. */
  function look(direction) {
    place(direction, middle);
    const axes = [new Vector3(), new Vector3(), new Vector3()];
    camera.matrixWorld.extractBasis(...axes);
    const centre = middle.clone();
    half = [0, 1].map((i) => {
      let [lower, upper] = [Infinity, -Infinity];
      for (const point of points) {
        const along = point.dot(axes[i]);
        lower = Math.min(lower, along);
        upper = Math.max(upper, along);
      }
      centre.addScaledVector(axes[i], 0.5 * (lower + upper) - middle.dot(axes[i]));
      return 0.5 * (upper - lower);
    });
    place(direction, centre);
    frame();
  }

  function place(direction, target) {
    camera.position.copy(target).addScaledVector(offPole(direction, up, presets), distance);
    controls.target.copy(target);
    camera.zoom = 1;
    controls.update();
    camera.updateMatrixWorld();
  }

  function frame() {
    const tall = MARGIN * Math.max(half[1], (half[0] * height) / width) || 1;
    Object.assign(camera, { top: tall, bottom: -tall, left: (-tall * width) / height, right: (tall * width) / height });
    camera.updateProjectionMatrix();
    controls.dispatchEvent({ type: "change" });
  }

  function turn(aside, upwards) {
    const away = camera.position.clone().sub(controls.target);
    const level = new Vector3(0, 1, 0);
    const round = camera.quaternion.clone().setFromUnitVectors(up, level);
    const angles = new Spherical().setFromVector3(away.applyQuaternion(round));
    angles.theta += aside;
    angles.phi = Math.min(Math.max(angles.phi + upwards, 0.001), Math.PI - 0.001);
    camera.position.setFromSpherical(angles).applyQuaternion(round.invert()).add(controls.target);
    controls.update();
  }

  return {
    camera,
    turn,
    look: (k) => look(presets[k]),
    reset: () => look(opening),
    changed: (listen) => controls.addEventListener("change", listen),
    fit(w, h) {
      const first = width === 1;
      [width, height] = [w, h];
      first ? look(opening) : frame();
    },
    zoom(factor) {
      camera.zoom = Math.min(Math.max(camera.zoom * factor, controls.minZoom), controls.maxZoom);
      camera.updateProjectionMatrix();
      controls.dispatchEvent({ type: "change" });
    },
    /** On which side of the target the reader stands along an axis 0, 1, 2. */
    towards: (axis) => camera.position.getComponent(axis) - controls.target.getComponent(axis),
    /** mm on the scene per pixel of the page. */
    pixelSize: () => (camera.top - camera.bottom) / camera.zoom / height,
  };
}

/** Along the pole the picture could be turned anyhow: the first preset across it is put on top. */
function offPole(direction, up, presets) {
  const unit = direction.clone().normalize();
  if (Math.abs(unit.dot(up)) < 0.9999) return unit;
  const top = presets.find((preset) => Math.abs(preset.dot(up)) < 0.5);
  return top ? unit.addScaledVector(top, -0.002 * Math.sign(unit.dot(up))).normalize() : unit;
}
