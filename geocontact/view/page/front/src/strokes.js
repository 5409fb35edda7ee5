// How curves are told apart: by colour, and by dashes without it.
import { svg } from "./svg.js";

// colours of Okabe and Ito (darker or lighter for contrast); the first eight curves differ without them, forty with
const COLOURS = 5;
const DASHES = ["", "7 3", "2 3", "9 3 2 3", "16 4", "1 7", "9 3 2 3 2 3", "16 4 5 4"];
export const colour = (k) => `c${k % COLOURS}`;
export const dash = (k) => DASHES[k % DASHES.length];

/** Line sample for a legend: the same class as the line. */
export const sample = (k) =>
  svg("svg", { class: "sample", viewBox: "0 0 40 8", "aria-hidden": "true" }, svg("path", { class: `line ${colour(k)}`, d: "M1 4H39", "stroke-dasharray": dash(k) }));
