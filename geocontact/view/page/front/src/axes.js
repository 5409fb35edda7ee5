// A plot area with axes and a cursor line, redrawn at the size it has.
import { html, svg } from "./svg.js";
import { brief, powers, ticks } from "./ticks.js";

const RIGHT = 12;
const TOP = 8;
const BOTTOM = 34;

/** Puts a chart into `figure`; `paint(plot)` fills it whenever its size changes. Hidden ones are drawn when they show. */
export function axes(figure, { x, y, xLabel, height, label, paint, beside = null, log = false }) {
  const frame = svg("svg", { role: "img", "aria-label": label });
  const room = html("div", "plot", frame);
  figure.append(room);
  const plot = { frame };
  const levels = log ? powers(...y) : ticks(...y, 4);
  const high = log ? Math.log10 : (value) => value;
  const [low, top] = y.map(high);
  const other = beside ? ticks(y[0] * beside.factor, y[1] * beside.factor, 4) : [];
  const right = beside ? 14 + 6.6 * Math.max(beside.unit.length, ...other.map((value) => brief(value).length)) : RIGHT;
  const left = 18 + 6.6 * Math.max(...levels.map((value) => brief(value).length));

  function redraw() {
    const width = room.clientWidth;
    if (!width) return;
    const tall = height();
    frame.setAttribute("viewBox", `0 0 ${width} ${tall}`);
    frame.setAttribute("height", tall);
    frame.replaceChildren();
    plot.x = (value) => left + ((value - x[0]) / (x[1] - x[0] || 1)) * (width - left - right);
    plot.y = (value) => tall - BOTTOM - ((high(value) - low) / (top - low || 1)) * (tall - TOP - BOTTOM);
    plot.at = (pixel) => x[0] + ((pixel - left) / (width - left - right)) * (x[1] - x[0]);
    plot.top = TOP;
    plot.bottom = tall - BOTTOM;
    plot.left = left;
    plot.right = width - right;
    for (const value of levels) {
      const at = plot.y(value);
      frame.append(svg("line", { class: value === 0 ? "zero" : "grid", x1: left, x2: width - right, y1: at, y2: at }));
      frame.append(svg("text", { class: "tick", x: left - 6, y: at + 3.5, "text-anchor": "end" }, brief(value)));
    }
    for (const value of other) {
      const at = plot.y(value / beside.factor);
      frame.append(svg("line", { class: "grid", x1: width - right, x2: width - right + 4, y1: at, y2: at }));
      frame.append(svg("text", { class: "tick", x: width - right + 7, y: at + 3.5 }, brief(value)));
    }
    if (beside) frame.append(svg("text", { class: "axis", x: width, y: tall - 4, "text-anchor": "end" }, beside.unit));
    for (const value of ticks(...x, width / 62)) {
      const at = plot.x(value);
      frame.append(svg("line", { class: "grid", x1: at, x2: at, y1: plot.bottom, y2: plot.bottom + 4 }));
      frame.append(svg("text", { class: "tick", x: at, y: plot.bottom + 15, "text-anchor": "middle" }, brief(value)));
    }
    frame.append(svg("text", { class: "axis", x: (left + width - right) / 2, y: tall - 4, "text-anchor": "middle" }, xLabel));
    paint(plot);
  }
  new ResizeObserver(redraw).observe(room);
  redraw();
  return plot;
}

/** Path through points; null is a gap. A point between two gaps becomes a dot. */
export function path(plot, xs, ys) {
  let text = "";
  ys = ys.map((y) => (y !== null && Number.isFinite(plot.y(y)) ? y : null));
  for (let k = 0; k < xs.length; k++) {
    if (ys[k] === null) continue;
    const at = `${plot.x(xs[k]).toFixed(1)} ${plot.y(ys[k]).toFixed(1)}`;
    const alone = (k === 0 || ys[k - 1] === null) && (k === xs.length - 1 || ys[k + 1] === null);
    text += k === 0 || ys[k - 1] === null ? `M${at}` : `L${at}`;
    if (alone) text += "h0.01";
  }
  return text;
}

/** Closed area between two curves, one piece per gapless run. */
export function band(plot, xs, lower, upper) {
  let text = "";
  let run = [];
  const close = () => {
    if (run.length > 1) {
      const up = run.map((k) => `${plot.x(xs[k]).toFixed(1)} ${plot.y(upper[k]).toFixed(1)}`);
      const down = run.reverse().map((k) => `${plot.x(xs[k]).toFixed(1)} ${plot.y(lower[k]).toFixed(1)}`);
      text += `M${[...up, ...down].join("L")}Z`;
    }
    run = [];
  };
  const shown = (value) => value !== null && Number.isFinite(plot.y(value));
  for (let k = 0; k < xs.length; k++) shown(lower[k]) && shown(upper[k]) ? run.push(k) : close();
  close();
  return text;
}
