// What lies over the picture: colour legend, directions, scale bar.
import { Vector3 } from "three";
import { BEYOND, css } from "./colours.js";
import { html, svg } from "./svg.js";
import { brief, ticks } from "./ticks.js";

const [LEFT, WIDTH, HIGH] = [24, 234, 14];
const [BEYOND_AT, ROOM] = [304, 328];
const overlaps = (scene, of) => of.span[0] < 0 && !of.sides && scene.bodies.some((body) => body.distance && body.signed);

/** Colours of a quantity with ticks; bold marks are the thresholds, hatched is overlap, the box beside is beyond. */
export function legend(place, scene, of) {
  const [lower, upper] = of.span;
  const x = (value) => LEFT + ((value - lower) / (upper - lower)) * WIDTH;
  const bar = svg("svg", { viewBox: `0 0 ${ROOM} 38`, width: ROOM, height: 38, role: "img", "aria-label": label(scene, of) });
  const stripes = svg("pattern", { id: "hatch", width: 5, height: 5, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" });
  stripes.append(svg("rect", { width: 5, height: 1.6, fill: "#000", "fill-opacity": 0.55 }));
  bar.append(svg("defs", {}, stripes));
  const count = 125;
  for (let k = 0; k < count; k++) {
    const value = lower + ((upper - lower) * (k + 0.5)) / count;
    bar.append(svg("rect", { y: 4, height: HIGH, x: LEFT + (k * WIDTH) / count, width: WIDTH / count + 0.5, fill: css(of.colour(value, of.span)) }));
  }
  if (overlaps(scene, of)) bar.append(svg("rect", { y: 4, height: HIGH, x: LEFT, width: x(Math.min(0, upper)) - LEFT, fill: "url(#hatch)" }));
  const taken = [];
  const mark = (value, kind) => {
    const half = 2 + 3.3 * brief(value).length;
    if (taken.some(([other, its]) => Math.abs(other - x(value)) < Math.max(20, half + its))) return;
    taken.push([x(value), half]);
    bar.append(svg("text", { class: `tick ${kind}`, x: x(value), y: 33, "text-anchor": "middle" }, brief(value)));
  };
  for (const [k, threshold] of of.thresholds.entries()) {
    bar.append(svg("line", { class: k ? "minor" : "main", y1: 1, y2: 22, x1: x(threshold), x2: x(threshold) }));
    mark(threshold, "main");
  }
  for (const value of [lower, upper, ...ticks(lower, upper, 6)]) {
    bar.append(svg("line", { class: "grid", y1: 4 + HIGH, y2: 22, x1: x(value), x2: x(value) }));
    mark(value, "");
  }
  bar.append(svg("rect", { x: BEYOND_AT - 11, width: 22, y: 4, height: HIGH, fill: BEYOND }));
  bar.append(svg("text", { class: "tick", x: BEYOND_AT, y: 33, "text-anchor": "middle" }, grey(of)));
  const unsigned = without(scene, of).flatMap((name) => ["; ", html("bdi", "", name), `: ${UNSIGNED}`]);
  const words = of.map === null ? `; ${lines(of)}${overlaps(scene, of) ? ", hatched: overlap" : ""}` : "; flat on each face";
  place.replaceChildren(bar, html("p", "", html("bdi", "", of.name), " [", html("bdi", "", of.unit), `]${words}`, ...unsigned));
}

const grey = (of) => (of.map === null ? "beyond" : "none");
const lines = (of) => `line${of.thresholds.length > 1 ? "s" : ""}: ${of.thresholds.map((t) => brief(t)).join(", ")} ${of.unit}`;

const UNSIGNED = "distance without sign (other body open)";
const without = (scene, of) =>
  of.map === null ? scene.bodies.filter((body) => body.distance && !body.signed).map((body) => body.name) : [];

const label = (scene, of) =>
  [
    `Colours from ${brief(of.span[0])} to ${brief(of.span[1])} ${of.unit}`,
    ...(of.thresholds.length ? [lines(of)] : []),
    ...(overlaps(scene, of) ? ["hatched where bodies overlap"] : []),
    `grey: ${grey(of)}`,
    ...without(scene, of).map((name) => `${name}: ${UNSIGNED}`),
  ].join(", ");

/** Arrows of the named directions as seen now. */
export function triad(place, scene, view) {
  const frame = svg("svg", { viewBox: "-76 -46 152 92", width: 152, height: 92 });
  place.append(frame);
  const named = scene.directions.map(([name, vector]) => [name.replace(/\s*\(.*$/, ""), new Vector3(...vector).normalize()]);
  const shown = named.filter(([, v], k) => !named.slice(0, k).some(([, other]) => other.dot(v) < -0.9));
  return () => {
    frame.replaceChildren();
    const towards = new Vector3();
    const arrows = shown.map(([name, vector]) => [name, towards.clone().copy(vector).transformDirection(view.camera.matrixWorldInverse)]);
    for (const [name, seen] of arrows.sort((a, b) => a[1].z - b[1].z)) {
      const [x, y] = [seen.x * 26, -seen.y * 26];
      if (Math.hypot(x, y) < 7) continue; // towards the reader: the button says it better
      frame.append(svg("line", { class: seen.z < -0.2 ? "arrow away" : "arrow", x1: 0, y1: 0, x2: x, y2: y }));
      const anchor = x > 8 ? "start" : x < -8 ? "end" : "middle";
      frame.append(svg("text", { class: "tick", x: x * 1.15, y: y * 1.25 + 3.5, "text-anchor": anchor }, name));
    }
    frame.append(svg("circle", { class: "hub", r: 2.5 }));
  };
}

/** A bar of a round length; the camera has no perspective, so it holds everywhere in the picture. */
export function scaleBar(place, view) {
  const [text, bar] = place.children;
  return () => {
    const size = view.pixelSize();
    const length = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].findLast((mm) => mm / size < 110) ?? 0.1;
    bar.style.width = `${length / size}px`;
    text.textContent = `${length} mm`;
  };
}
