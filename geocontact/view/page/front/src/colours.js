// Distance and other quantities → colour, for the surface, the legend and the saved picture alike.

// viridis (van der Walt and Smith, CC0), near to far: lightness falls evenly, also for colour-blind eyes
const NEAR_TO_FAR = [
  "#fde725", "#b5de2b", "#6ece58", "#35b779", "#1f9e89", "#26828e", "#31688e", "#3e4989", "#482878", "#440154",
];
// what overlaps is told apart by hue, by lightness and by hatching
const SHALLOW_TO_DEEP = ["#ff9a3c", "#e8590c", "#b3261e", "#6a040f"];
// inferno (van der Walt and Smith, CC0), little to much, without its black: what has its zero at one end, such as pressure
const LITTLE_TO_MUCH = [
  "#fcffa4", "#f6d746", "#fca50a", "#f37819", "#dd513a", "#bc3754", "#932667", "#6a176e", "#420a68", "#160b39",
];
// RdYlBu (Brewer, Apache 2), below to above: what has its zero in the middle; colour-blind eyes see the two sides
const BELOW_TO_ABOVE = [
  "#313695", "#4575b4", "#74add1", "#abd9e9", "#e0f3f8", "#ffffbf", "#fee090", "#fdae61", "#f46d43", "#d73027", "#a50026",
];
export const BEYOND = "#c9cdd2";
export const PLAIN = "#b9bec6";
// faces that are named, and those of them on the other side of a plane
export const MARKED = "#3f83c8";
export const MARKED_LATERAL = "#e0862f";

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

function between(stops, part) {
  const at = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  const [from, to] = [rgb(stops[k]), rgb(stops[k + 1])];
  return from.map((c, i) => Math.round(c + (to[i] - c) * (at - k)));
}

/** sRGB triple 0 … 255 of a distance, colours spread over the span. */
export function colourOf(distance, [lower, upper]) {
  if (distance < 0 && lower < 0) return between(SHALLOW_TO_DEEP, distance / lower);
  const from = Math.max(lower, 0);
  return between(NEAR_TO_FAR, (distance - from) / (upper - from));
}

/** sRGB triple of a distance to either side, colours spread over the span. */
export const sideColour = (distance, [lower, upper]) => between(BELOW_TO_ABOVE, (distance - lower) / (upper - lower));

/** sRGB triple of an amount, colours spread from nothing to the upper end. */
export const amountColour = (amount, [, upper]) => between(LITTLE_TO_MUCH, amount / upper);

/** Colours of a quantity's span from lower to upper end, RGBA bytes. */
export function ramp({ span, colour }, count) {
  const bytes = new Uint8Array(4 * count);
  for (let i = 0; i < count; i++) {
    bytes.set([...colour(span[0] + ((span[1] - span[0]) * (i + 0.5)) / count, span), 255], 4 * i);
  }
  return bytes;
}

export const css = (triple) => `rgb(${triple.join(",")})`;
