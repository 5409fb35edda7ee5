// What the colours can mean: amounts on faces first, then the distance of vertices to the other body.
import { amountColour, colourOf, sideColour } from "./colours.js";

/** The thresholds with the chosen one first, which is drawn bold. */
export const boldFirst = (thresholds, chosen) =>
  chosen === null ? thresholds : [chosen, ...thresholds.filter((value) => Math.abs(value - chosen) > 1e-6 * Math.abs(chosen))];

/** Quantities in the order of the page's choice; `map` is the number of a map on faces, null for the distance. */
export function quantitiesOf(scene) {
  const distance = {
    map: null,
    name: scene.valueName,
    unit: "mm",
    span: scene.span,
    first: scene.first,
    step: scene.step,
    thresholds: scene.thresholds,
    sides: scene.sides,
    colour: scene.sides ? sideColour : colourOf,
  };
  const maps = scene.maps.map(({ name, unit, upper, step }, map) => ({
    map,
    name,
    unit,
    span: [0, upper],
    first: step,
    step,
    thresholds: [],
    sides: false,
    colour: amountColour,
  }));
  return [...maps, distance];
}
