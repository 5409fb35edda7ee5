// Curves over time with a cursor, and the strip that shows how much the threshold matters.
import { axes, band, path } from "./axes.js";
import { colour, dash, sample } from "./strokes.js";
import { html, svg } from "./svg.js";
import { brief, course, extent } from "./ticks.js";

/** Measured values are open marks in ink: circle, square, triangle. */
const MARKS = ["M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0", "M-3.5-3.5h7v7h-7z", "M0-4.5L4.2 3.2h-8.4z"];
const mark = (k, x, y) => svg("path", { class: "mark", d: MARKS[k % MARKS.length], transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });
const markSample = (k) => svg("svg", { class: "sample small", viewBox: "-8 -6 16 12", "aria-hidden": "true" }, mark(k, 0, 0));

/** Panel of curves; `go(frame)` is called when the reader points at one. Returns what moves the cursor. */
export function curves(figure, part, time, timeLabel, { go, plays }) {
  const own = part.curves.flatMap((c) => [...c.values, ...(c.lower ?? []), ...(c.upper ?? [])]);
  const all = [...own, ...part.points.flatMap((p) => p.values), ...part.limits.map((l) => l.value)];
  const values = part.curves.map(() => html("span", "value"));
  figure.append(
    html(
      "ul",
      "key",
      ...part.curves.map((c, k) => html("li", "", sample(c.stroke), html("bdi", "", c.name), values[k])),
      ...part.points.map((p, k) => html("li", "", markSample(k), html("bdi", "", p.name))),
    ),
  );
  let now = 0;
  const plot = axes(figure, {
    x: course([...time, ...part.points.flatMap((p) => p.time)], time),
    y: extent(all, part.unit),
    xLabel: timeLabel,
    beside: part.beside,
    height: figure.classList.contains("lead") ? () => Math.max(220, Math.min(340, 0.42 * window.innerHeight)) : () => 190,
    label: `${part.title}: ${part.curves.map((c) => describe(c, part.unit)).join("; ")}`,
    paint(p) {
      part.curves.forEach((c) => {
        if (c.lower && c.upper) p.frame.append(svg("path", { class: `band ${colour(c.stroke)}`, d: band(p, time, c.lower, c.upper) }));
      });
      part.curves.forEach((c) =>
        p.frame.append(svg("path", { class: `line ${colour(c.stroke)}`, d: path(p, time, c.values), "stroke-dasharray": dash(c.stroke) })),
      );
      for (const { name, value } of part.limits) {
        p.frame.append(svg("line", { class: "limit", x1: p.left, x2: p.right, y1: p.y(value), y2: p.y(value) }));
        p.frame.append(svg("text", { class: "tick limit", x: p.right - 4, y: p.y(value) - 5, "text-anchor": "end" }, name));
      }
      part.points.forEach(({ time: at, values: known }, k) => {
        known.forEach((value, i) => value !== null && p.frame.append(mark(k, p.x(at[i]), p.y(value))));
      });
      p.cursor = svg("line", { class: "cursor", y1: p.top, y2: p.bottom });
      p.dots = part.curves.map((c) => svg("circle", { class: `dot ${colour(c.stroke)}`, r: 4 }));
      p.frame.append(p.cursor, ...p.dots);
      place(p);
    },
  });

  function move(frame) {
    now = frame;
    part.curves.forEach((c, k) => (values[k].textContent = brief(c.values[frame])));
    place(plot);
  }

  function place(plot) {
    if (!plot.cursor) return; // not drawn yet
    const frame = now;
    const at = plot.x(time[frame]);
    plot.cursor.setAttribute("x1", at);
    plot.cursor.setAttribute("x2", at);
    part.curves.forEach((c, k) => {
      const value = c.values[frame];
      plot.dots[k].setAttribute("visibility", value === null ? "hidden" : "visible");
      if (value === null) return;
      plot.dots[k].setAttribute("cx", at);
      plot.dots[k].setAttribute("cy", plot.y(value));
    });
  }

  const point = (event) => go(nearest(time, plot.at(event.clientX - plot.frame.getBoundingClientRect().left)));
  plot.frame.classList.add("clickable");
  plot.frame.addEventListener("pointerdown", point);
  plot.frame.addEventListener("pointermove", (event) => (event.buttons || !plays) && point(event));
  return move;
}

function describe(curve, unit) {
  const known = curve.values.filter((value) => value !== null);
  return known.length ? `${curve.name} from ${brief(Math.min(...known))} to ${brief(Math.max(...known))} ${unit}` : curve.name;
}

function nearest(time, value) {
  let best = 0;
  for (let k = 1; k < time.length; k++) if (Math.abs(time[k] - value) < Math.abs(time[best] - value)) best = k;
  return best;
}

/** Strip over thresholds: envelope of all frames, this frame's line, the chosen threshold. */
export function strip(figure, part) {
  const { thresholds, values } = part;
  let { current } = part;
  const column = (k) => values.map((row) => row[k]).filter((value) => value !== null);
  const ends = (pick) => thresholds.map((_, k) => (column(k).length ? pick(...column(k)) : null));
  const [lower, upper] = [ends(Math.min), ends(Math.max)];
  const value = html("span", "value");
  const chosenName = html("span", "");
  figure.append(html("p", "chosen", "chosen: ", chosenName, " ", value, html("span", "faint", "shaded: all frames")));
  let now = 0;
  const plot = axes(figure, {
    x: [Math.min(0, thresholds[0]), thresholds.at(-1)],
    y: extent([...lower, ...upper, 0], part.unit),
    xLabel: "threshold [mm]",
    height: () => 150,
    label: `${part.title}: ${part.unit} against the threshold in mm`,
    paint(p) {
      p.frame.append(svg("path", { class: "band c0", d: band(p, thresholds, lower, upper) }));
      p.chosen = svg("line", { class: "chosen", y1: p.top, y2: p.bottom });
      p.frame.append(p.chosen);
      p.line = svg("path", { class: "line c0" });
      p.dots = thresholds.map(() => svg("circle", { class: "dot c0", r: 3 }));
      p.frame.append(p.line, ...p.dots);
      place(p);
    },
  });

  function move(frame) {
    now = frame;
    const row = values[frame];
    const chosen = thresholds.findIndex((threshold) => Math.abs(threshold - current) <= 1e-6 * Math.abs(current));
    chosenName.textContent = `${brief(current)} mm`;
    value.textContent = chosen < 0 ? "" : `${brief(row[chosen])} ${part.unit}`;
    place(plot);
  }

  function place(plot) {
    if (!plot.line) return; // not drawn yet
    const row = values[now];
    plot.chosen.setAttribute("x1", plot.x(current));
    plot.chosen.setAttribute("x2", plot.x(current));
    plot.line.setAttribute("d", path(plot, thresholds, row));
    plot.dots.forEach((dot, k) => {
      dot.setAttribute("visibility", row[k] === null ? "hidden" : "visible");
      if (row[k] === null) return;
      dot.setAttribute("cx", plot.x(thresholds[k]));
      dot.setAttribute("cy", plot.y(row[k]));
    });
  }
  move.choose = (threshold) => {
    current = threshold ?? part.current;
    move(now);
  };
  return move;
}
