// Curves over time with a cursor, and the strip that shows how much the threshold matters.
import { axes, band, path } from "./axes.js";
import { html, svg } from "./svg.js";
import { brief, course, extent } from "./ticks.js";

// colours of Okabe and Ito (darker or lighter for contrast); the first eight curves differ without them, forty with
const COLOURS = 5;
const DASHES = ["", "7 3", "2 3", "9 3 2 3", "16 4", "1 7", "9 3 2 3 2 3", "16 4 5 4"];
const colour = (k) => `c${k % COLOURS}`;
const dash = (k) => DASHES[k % DASHES.length];

/** Line sample for a legend: the same class as the line. */
const sample = (k) =>
  svg("svg", { class: "sample", viewBox: "0 0 40 8", "aria-hidden": "true" }, svg("path", { class: `line ${colour(k)}`, d: "M1 4H39", "stroke-dasharray": dash(k) }));

/** Panel of curves; `go(frame)` is called when the reader points at one. Returns what moves the cursor. */
export function curves(figure, part, time, timeLabel, go) {
  const all = part.curves.flatMap((c) => [...c.values, ...(c.lower ?? []), ...(c.upper ?? [])]);
  const values = part.curves.map(() => html("span", "value"));
  figure.append(
    html("ul", "key", ...part.curves.map((c, k) => html("li", "", sample(k), html("bdi", "", c.name), values[k]))),
  );
  let now = 0;
  let plot = null;
  axes(figure, {
    x: course(time),
    y: extent(all, part.unit),
    xLabel: timeLabel,
    label: `${part.title}: ${part.curves.map((c) => describe(c, part.unit)).join("; ")}`,
    paint(p) {
      plot = p;
      part.curves.forEach((c, k) => {
        if (c.lower && c.upper) p.frame.append(svg("path", { class: `band ${colour(k)}`, d: band(p, time, c.lower, c.upper) }));
      });
      part.curves.forEach((c, k) =>
        p.frame.append(svg("path", { class: `line ${colour(k)}`, d: path(p, time, c.values), "stroke-dasharray": dash(k) })),
      );
      p.cursor = svg("line", { class: "cursor", y1: p.top, y2: p.bottom });
      p.dots = part.curves.map((_, k) => svg("circle", { class: `dot ${colour(k)}`, r: 4 }));
      p.frame.append(p.cursor, ...p.dots);
      move(now);
    },
  });

  function move(frame) {
    now = frame;
    part.curves.forEach((c, k) => (values[k].textContent = brief(c.values[frame])));
    if (!plot?.cursor) return;
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
  plot.frame.addEventListener("pointermove", (event) => event.buttons && point(event));
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
  const { thresholds, values, current } = part;
  const column = (k) => values.map((row) => row[k]).filter((value) => value !== null);
  const ends = (pick) => thresholds.map((_, k) => (column(k).length ? pick(...column(k)) : null));
  const [lower, upper] = [ends(Math.min), ends(Math.max)];
  const value = html("span", "value");
  figure.append(html("p", "chosen", `chosen: ${brief(current)} mm `, value, html("span", "faint", "shaded: all frames")));
  let now = 0;
  let plot = null;
  axes(figure, {
    x: [Math.min(0, thresholds[0]), thresholds.at(-1)],
    y: extent([...lower, ...upper, 0], part.unit),
    xLabel: "threshold [mm]",
    height: 150,
    label: `${part.title}: ${part.unit} against the threshold in mm; chosen ${current} mm`,
    paint(p) {
      plot = p;
      p.frame.append(svg("path", { class: "band c0", d: band(p, thresholds, lower, upper) }));
      const at = p.x(current);
      p.frame.append(svg("line", { class: "chosen", x1: at, x2: at, y1: p.top, y2: p.bottom }));
      p.line = svg("path", { class: "line c0" });
      p.dots = thresholds.map(() => svg("circle", { class: "dot c0", r: 3 }));
      p.frame.append(p.line, ...p.dots);
      move(now);
    },
  });

  function move(frame) {
    now = frame;
    const row = values[frame];
    const chosen = thresholds.findIndex((threshold) => Math.abs(threshold - current) <= 1e-6 * Math.abs(current));
    value.textContent = chosen < 0 ? "" : `${brief(row[chosen])} ${part.unit}`;
    if (!plot?.line) return;
    plot.line.setAttribute("d", path(plot, thresholds, row));
    plot.dots.forEach((dot, k) => {
      dot.setAttribute("visibility", row[k] === null ? "hidden" : "visible");
      if (row[k] === null) return;
      dot.setAttribute("cx", plot.x(thresholds[k]));
      dot.setAttribute("cy", plot.y(row[k]));
    });
  }
  return move;
}
