// Numbers with whiskers, or as bars, one below the other on one axis. Names stand above them where room is scarce.
import { lines } from "./letters.js";
import { html, svg } from "./svg.js";
import { brief, extent, ticks } from "./ticks.js";

const [RIGHT, BOTTOM, NARROW] = [16, 34, 560];
const LINE = 14; // of a name
const BARS = [0, 3, 2]; // colours of kinds; those of whiskers are apart from them
const swatch = (k) => svg("svg", { class: "sample small", viewBox: "0 0 16 12", "aria-hidden": "true" }, svg("rect", { class: `bar c${k}`, width: 16, height: 12 }));

/** Puts the rows into `figure`. Nothing moves. */
export function intervals(figure, part) {
  const rows = part.intervals;
  const kinds = [...new Set(rows.map((row) => row.kind))];
  const tone = ({ kind }) => part.hues[kind] ?? (part.bars ? BARS : [0, 1, 2])[kinds.indexOf(kind) % 3];
  if (kinds.length > 1) {
    figure.append(html("ul", "key", ...kinds.map((kind) => html("li", "", swatch(tone({ kind })), html("bdi", "", kind)))));
  }
  const frame = svg("svg", { role: "img", "aria-label": `${part.title}: ${rows.map((row) => words(row, part.unit)).join("; ")}` });
  const room = html("div", "plot", frame);
  figure.append(room);
  const [lower, upper] = extent([...rows.flatMap((r) => [r.value, r.lower, r.upper]), ...(part.bars ? [0] : [])], part.unit);

  function redraw() {
    const width = room.clientWidth;
    if (!width) return;
    const narrow = width < NARROW;
    const beside = Math.min(300, 0.42 * width); // of a name, at most
    const names = rows.map((row, k) => (narrow ? lines(words(row, ""), width - 16) : rows[k - 1]?.name === row.name ? [] : lines(row.name, beside)));
    const left = narrow ? 12 : 24 + Math.max(...names.flat().map((line) => line.width));
    const highs = names.map((own) => (narrow ? 28 + LINE * own.length : Math.max(28, 8 + LINE * own.length)));
    const tops = highs.map((_, k) => 6 + highs.slice(0, k).reduce((sum, high) => sum + high, 0));
    const bottom = tops.at(-1) + highs.at(-1);
    const x = (value) => left + ((value - lower) / (upper - lower)) * (width - left - RIGHT);
    frame.setAttribute("viewBox", `0 0 ${width} ${bottom + BOTTOM}`);
    frame.setAttribute("height", bottom + BOTTOM);
    frame.replaceChildren();
    for (const value of ticks(lower, upper, (width - left) / 80)) {
      frame.append(svg("line", { class: value === 0 ? "zero" : "grid", x1: x(value), x2: x(value), y1: 6, y2: bottom }));
      frame.append(svg("text", { class: "tick", x: x(value), y: bottom + 15, "text-anchor": "middle" }, brief(value)));
    }
    frame.append(svg("text", { class: "axis", x: 0.5 * (left + width - RIGHT), y: bottom + 30, "text-anchor": "middle" }, part.unit));
    rows.forEach((row, k) => {
      const y = narrow ? tops[k] + highs[k] - 13 : tops[k] + 0.5 * highs[k];
      names[k].forEach(({ text }, i) => {
        const place = narrow ? { x: 4, y: tops[k] + 14 + LINE * i } : { x: left - 12, y: y + 4 + LINE * (i - 0.5 * (names[k].length - 1)), "text-anchor": "end" };
        frame.append(svg("text", { class: "label", ...place }, text));
      });
      if (part.bars && row.value !== null) {
        const [from, to] = [x(Math.min(0, row.value)), x(Math.max(0, row.value))];
        frame.append(svg("rect", { class: `bar c${tone(row)}`, x: from, y: y - 6, width: to - from, height: 12 }));
      }
      if (row.lower !== null && row.upper !== null) {
        const [a, b] = [x(row.lower), x(row.upper)];
        frame.append(svg("path", { class: `line whisker ${part.bars ? "c4" : `c${tone(row)}`}`, d: `M${a} ${y - 5}V${y + 5}M${a} ${y}H${b}M${b} ${y - 5}V${y + 5}` }));
      }
      if (!part.bars && row.value !== null) frame.append(svg("circle", { class: `dot c${tone(row)}`, cx: x(row.value), cy: y, r: 5 }));
      frame.append(svg("title", {}, words(row, part.unit)));
    });
  }
  new ResizeObserver(redraw).observe(room);
  redraw();
  return () => {};
}

const words = ({ name, kind, value, lower, upper }, unit) =>
  `${name}${kind && `, ${kind}`}: ${brief(value)}${lower === null || upper === null ? "" : ` (${brief(lower)} … ${brief(upper)})`} ${unit}`.trim();
