// Shares and sizes as shades: strips of cells along axes, and a matrix of rows against columns. Colours are the page's.
import { html, svg } from "./svg.js";

const [ROW, HEAD, BOTTOM, LETTER, NARROW] = [26, 18, 36, 6.6, 560]; // HEAD: a name above its row, where room is scarce
const DARK = 0.55; // share from which a mark on a cell takes the colour of the card
const STEPS = [0, 0.25, 0.5, 0.75, 1];
const shade = (share) => (share === null ? "none" : Math.max(0, Math.min(1, share)).toFixed(3));

/** What the shades mean: five of them with their numbers. */
function scale(figure, part) {
  const swatches = STEPS.map((share) => html("li", "", svg("svg", { class: "sample small heat", viewBox: "0 0 16 12", "aria-hidden": "true" }, cell(share, 0, 0, 16, 12)), part.scale[STEPS.indexOf(share)]));
  figure.append(html("ul", "key", ...swatches));
}

function cell(share, x, y, width, height) {
  const own = share === null ? { class: "cell missing" } : { class: "cell", "fill-opacity": shade(share) };
  return svg("rect", { ...own, x, y, width, height });
}

/** Strips of equal cells, one block for each axis, a row in it for each name. Nothing moves. */
export function strips(figure, part) {
  scale(figure, part);
  const named = part.rows.length > 1;
  const room = html("div", "blocks");
  figure.append(room);
  for (const block of part.blocks) {
    const frame = svg("svg", { class: "heat", role: "img", "aria-label": `${part.title}, ${block.name}: ${told(part, block)}` });
    const place = html("div", block.wide ? "plot all" : "plot", frame);
    room.append(place);
    const redraw = () => strip(frame, place.clientWidth, part, block, named);
    new ResizeObserver(redraw).observe(place);
    redraw();
  }
  return () => {};
}

function strip(frame, width, part, block, named) {
  if (!width) return;
  const longest = Math.max(...part.rows.map((name) => name.length));
  const above = named && width < NARROW && block.edges.length > 12;
  const left = 10 + (named && !above ? Math.min(LETTER * longest + 8, 0.4 * width) : 0);
  const count = block.edges.length - 1;
  const high = above ? ROW + HEAD : ROW;
  const [step, bottom] = [(width - left - 14) / count, 4 + high * part.rows.length];
  frame.setAttribute("viewBox", `0 0 ${width} ${bottom + BOTTOM}`);
  frame.setAttribute("height", bottom + BOTTOM);
  frame.replaceChildren();
  part.rows.forEach((name, r) => {
    const y = 4 + high * (r + 1) - ROW;
    if (above) frame.append(svg("text", { class: "label", x: left, y: y - 4 }, cut(name, (width - 20) / LETTER)));
    else if (named) frame.append(svg("text", { class: "label", x: left - 8, y: y + 0.5 * ROW + 4, "text-anchor": "end" }, cut(name, (left - 12) / LETTER)));
    block.values[r].forEach((share, c) => {
      const drawn = cell(share, left + step * c, y + 1, step, ROW - 2);
      drawn.append(svg("title", {}, `${name}, ${block.edges[c]} … ${block.edges[c + 1]}: ${block.texts[r][c]}`));
      frame.append(drawn);
      const mark = block.marks[r][c];
      if (mark) frame.append(svg("text", { class: `sign${share > DARK ? " on" : ""}${step < 14 ? " small" : ""}`, x: left + step * (c + 0.5), y: y + 0.5 * ROW + 5, "text-anchor": "middle" }, mark));
    });
  });
  part.rows.forEach((_, r) => frame.append(svg("rect", { class: "rim", x: left, y: 4.5 + high * (r + 1) - ROW, width: step * count, height: ROW - 1 })));
  for (const c of apart(block.edges, step)) {
    const x = left + step * c;
    frame.append(svg("line", { class: "zero", x1: x, x2: x, y1: bottom, y2: bottom + 4 }));
    frame.append(svg("text", { class: "tick", x, y: bottom + 15, "text-anchor": c ? (c === count ? "end" : "middle") : "start" }, block.edges[c]));
  }
  const middle = 0.5 * LETTER * block.name.length > 0.5 * step * count + 14 ? 0.5 * width : left + 0.5 * step * count;
  frame.append(svg("text", { class: "axis", x: middle, y: bottom + 31, "text-anchor": "middle" }, block.name));
}

/** Places of the edges whose numbers fit beside each other: both ends, and every so manieth between them. */
export function apart(edges, step) {
  const count = edges.length - 1;
  const widest = LETTER * Math.max(...edges.map((text) => text.length)) + 10;
  const every = [1, 2, 4, 5, 10, 20].find((n) => count % n === 0 && n * step >= 1.5 * widest) ?? count;
  return edges.flatMap((_, c) => (c % every === 0 || c === count ? [c] : []));
}

const cut = (name, most) => (name.length > most ? `${name.slice(0, Math.max(1, Math.floor(most) - 1))}…` : name);
const told = (part, block) => part.rows.map((name, r) => `${name} ${block.texts[r].join(", ")}`).join("; ");

/** Rows against columns as a table that scrolls; names of the rows stay. Nothing moves. */
export function matrix(figure, part) {
  scale(figure, part);
  const head = part.columns.map((name) => html("th", "column", html("bdi", "", name)));
  const corner = html("th", "corner-cell", part.corner);
  const body = part.rows.map((name, r) => html("tr", "", row(name), ...part.values[r].map((share, c) => number(share, part.texts[r][c], `${name} × ${part.columns[c]}`))));
  const table = html("table", "matrix", html("thead", "", html("tr", "", corner, ...head)), html("tbody", "", ...body));
  for (const cell of head) cell.scope = "col";
  table.style.setProperty("--wide", `${part.columns.length > 16 ? 36 : part.columns.length > 8 ? 52 : 76}px`);
  const wide = html("div", "wide whole", table);
  for (const [name, value] of [["tabindex", 0], ["role", "region"], ["aria-label", part.title]]) wide.setAttribute(name, value);
  figure.append(wide);
  return () => {};
}

function row(name) {
  const found = html("th", "", html("bdi", "", name));
  found.scope = "row";
  return found;
}

function number(share, text, title) {
  const found = html("td", share === null ? "missing" : share > DARK ? "on" : "", text);
  if (share !== null) found.style.setProperty("--share", shade(share));
  found.title = `${title}: ${text}`;
  return found;
}
