// A drawing to scale: outlines, tracks with the point of the frame shown, named marks and lengths. Redrawn at its size.
import { path } from "./axes.js";
import { colour, dash, sample } from "./strokes.js";
import { html, svg } from "./svg.js";
import { brief, extent, ticks } from "./ticks.js";

const [LEFT, RIGHT, TOP, BOTTOM] = [44, 14, 8, 34];
const LOW = 70; // px: the name of the axis that goes up needs as much

/** Puts the plan into `figure`; returns what moves its points. */
export function plan(figure, part) {
  const { tracks, marks, lines, lengths } = part;
  const stroke = (k) => Math.max(tracks.length, ...tracks.map((t) => t.stroke + 1)) + k; // of a length
  const values = tracks.map(() => html("span", "value"));
  if (tracks.length + lengths.length) {
    const moving = tracks.map((t, k) => html("li", "", sample(t.stroke), html("bdi", "", t.name), values[k]));
    const fixed = lengths.map((l, k) => html("li", "", sample(stroke(k)), html("bdi", "", l.name), html("span", "value", l.told)));
    figure.append(html("ul", "key", ...fixed, ...moving));
  }
  const frame = svg("svg", { role: "img", "aria-label": `${part.title}: ${part.across} and ${part.up} in ${part.unit}` });
  const room = html("div", "plot", frame);
  figure.append(room);
  const all = (i) => [...lines.flatMap((l) => l[i]), ...tracks.flatMap((t) => (i ? t.y : t.x)), ...marks.map((m) => m.at[i]), ...lengths.flatMap((l) => l.ends.map((p) => p[i]))];
  const reach = [0, 1].map((i) => span(all(i), marks.length ? 0.1 : 0.04));
  let now = 0;
  let dots = [];
  let plot = null;

  function redraw() {
    const width = room.clientWidth;
    if (!width) return;
    const most = figure.classList.contains("lead") ? 0.5 * window.innerHeight : 320;
    const [wide, flat] = reach.map(([lower, upper]) => upper - lower);
    const scale = Math.min((width - LEFT - RIGHT) / wide, (most - TOP - BOTTOM) / flat);
    const high = Math.max(flat, LOW / scale);
    const top = reach[1][1] + 0.5 * (high - flat);
    const tall = TOP + BOTTOM + scale * high;
    const start = LEFT + 0.5 * (width - LEFT - RIGHT - scale * wide);
    plot = { x: (v) => start + (v - reach[0][0]) * scale, y: (v) => TOP + (top - v) * scale };
    frame.setAttribute("viewBox", `0 0 ${width} ${tall}`);
    frame.setAttribute("height", tall);
    frame.replaceChildren();
    const [left, right, bottom] = [start, start + scale * wide, TOP + scale * high];
    for (const value of ticks(...reach[0], (scale * wide) / 70)) {
      const at = plot.x(value);
      frame.append(svg("line", { class: "grid", x1: at, x2: at, y1: TOP, y2: bottom }));
      frame.append(svg("text", { class: "tick", x: at, y: bottom + 14, "text-anchor": "middle" }, brief(value)));
    }
    for (const value of ticks(top - high, top, (scale * high) / 50)) {
      const at = plot.y(value);
      frame.append(svg("line", { class: "grid", x1: left, x2: right, y1: at, y2: at }));
      frame.append(svg("text", { class: "tick", x: left - 6, y: at + 3.5, "text-anchor": "end" }, brief(value)));
    }
    frame.append(svg("text", { class: "axis", x: 0.5 * (left + right), y: tall - 4, "text-anchor": "middle" }, `${part.across} [${part.unit}]`));
    const aside = `rotate(-90 12 ${0.5 * (TOP + bottom)})`;
    frame.append(svg("text", { class: "axis", x: 12 + start - LEFT, y: 0.5 * (TOP + bottom), "text-anchor": "middle", transform: aside.replace("12", 12 + start - LEFT) }, `${part.up} [${part.unit}]`));
    const outline = lines.map(([xs, ys]) => path(plot, xs, ys)).join("");
    frame.append(svg("path", { class: "outline", d: outline }));
    tracks.forEach((t, k) => frame.append(svg("path", { class: `line ${colour(t.stroke)}`, d: path(plot, t.x, t.y), "stroke-dasharray": dash(t.stroke) })));
    lengths.forEach((l, k) => frame.append(...measured(l, stroke(k))));
    for (const { name, at } of marks) {
      frame.append(svg("circle", { class: "mark", cx: plot.x(at[0]), cy: plot.y(at[1]), r: 3.5 }));
      frame.append(svg("text", { class: "named", x: plot.x(at[0]) + 7, y: plot.y(at[1]) + 15 }, name));
    }
    dots = tracks.map((t) => svg("circle", { class: `dot ${colour(t.stroke)}`, r: 5 }));
    frame.append(...dots);
    move(now);
  }

  /** A length with its ends barred and its name beside its middle. */
  function measured({ name, ends }, k) {
    const [[x1, y1], [x2, y2]] = ends.map(([x, y]) => [plot.x(x), plot.y(y)]);
    const size = Math.hypot(x2 - x1, y2 - y1) || 1;
    const [u, v] = [(y1 - y2) / size, (x2 - x1) / size]; // across it
    const bar = (x, y) => `M${x - 5 * u} ${y - 5 * v}L${x + 5 * u} ${y + 5 * v}`;
    const side = (Math.abs(v) > Math.abs(u) ? v > 0 : u < 0) ? -1 : 1; // above level ones, right of steep ones
    const place = { x: 0.5 * (x1 + x2) + 13 * side * u, y: 0.5 * (y1 + y2) + 13 * side * v + 4 };
    return [
      svg("path", { class: `line ${colour(k)}`, d: `M${x1} ${y1}L${x2} ${y2}${bar(x1, y1)}${bar(x2, y2)}` }),
      svg("text", { class: "length", "text-anchor": "middle", ...place }, name),
    ];
  }

  function move(at) {
    now = at;
    tracks.forEach((t, k) => {
      const known = t.x[at] !== null && t.y[at] !== null;
      values[k].textContent = known ? (t.told?.[at] ?? `${brief(t.x[at])}, ${brief(t.y[at])}`) : "–";
      if (!dots[k]) return;
      dots[k].setAttribute("visibility", known ? "visible" : "hidden");
      if (!known) return;
      dots[k].setAttribute("cx", plot.x(t.x[at]));
      dots[k].setAttribute("cy", plot.y(t.y[at]));
    });
  }

  new ResizeObserver(redraw).observe(room);
  redraw();
  return move;
}

/** Ends of an axis with some room; not stretched to zero as those of curves are. */
function span(values, share) {
  const known = values.filter((value) => value !== null);
  if (!known.length) return extent([]);
  const [lower, upper] = [Math.min(...known), Math.max(...known)];
  const room = share * (upper - lower) || 1;
  return [lower - room, upper + room];
}
