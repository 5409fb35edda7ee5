// Curves over time with a cursor, and the strip that shows how much the threshold matters.
import { axes, band, path } from "./axes.js";
import { colour, dash, sample } from "./strokes.js";
import { html, svg } from "./svg.js";
import { brief, course, decades, extent } from "./ticks.js";

/** Measured values are open marks in ink, unless they have a stroke: circle, square, triangle. */
const MARKS = ["M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0", "M-3.5-3.5h7v7h-7z", "M0-4.5L4.2 3.2h-8.4z"];
const MANY = 4; // curves, from which one of them may be picked by its name
const UNSEEN = 1e-4; // of the axis: less is printed as 0
const tone = (stroke) => (stroke === null ? "" : ` own ${colour(stroke)}`);
const mark = (k, stroke, x, y) =>
  svg("path", { class: `mark${tone(stroke)}`, d: MARKS[k % MARKS.length], transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });
const small = (...drawn) => svg("svg", { class: "sample small", viewBox: "-8 -6 16 12", "aria-hidden": "true" }, ...drawn);
const pointsSample = (p, k) => (p.joined ? sample(p.stroke ?? k) : small(mark(k, p.stroke, 0, 0)));
const spanSample = (span) => small(span.start === span.end ? svg("path", { class: "edge", d: "M0-6V6" }) : svg("rect", { class: "span", x: -8, y: -6, width: 16, height: 12 }));

/** Panel of curves; `go(frame)` is called when the reader points at one. Returns what moves the cursor. */
export function curves(figure, part, pageTime, pageLabel, { go, plays }) {
  const [time, timeLabel] = part.over ? [part.over.values, part.over.label] : [pageTime, pageLabel];
  const named = part.curves.filter((c) => !c.thin);
  const own = part.curves.flatMap((c) => [...c.values, ...(c.lower ?? []), ...(c.upper ?? [])]);
  const all = [...own, ...part.points.flatMap((p) => p.values), ...part.limits.map((l) => l.value)];
  const values = named.map(() => html("span", "value"));
  const entries = named.map((c, k) => html("li", "", sample(c.stroke), html("bdi", "", c.name), values[k]));
  const spans = part.spans.filter((span, k) => span.name && part.spans.findIndex((other) => other.name === span.name) === k);
  figure.append(
    html(
      "ul",
      "key",
      ...entries,
      ...part.points.flatMap((p, k) => (p.name ? [html("li", "", pointsSample(p, k), html("bdi", "", p.name))] : [])),
      ...spans.map((span) => html("li", "", spanSample(span), html("bdi", "", span.name))),
    ),
  );
  let [now, begun, shownAlone] = [0, false, null];
  const y = part.log ? decades(all) : extent(all, part.unit);
  const unseen = part.log ? 0 : UNSEEN * (y[1] - y[0]);
  const plot = axes(figure, {
    x: course([...time, ...part.points.flatMap((p) => p.time)], time),
    y,
    log: part.log,
    xLabel: timeLabel,
    beside: part.beside,
    height: figure.classList.contains("lead") ? () => Math.max(220, Math.min(340, 0.42 * window.innerHeight)) : () => 190,
    label: `${part.title}: ${[...named, ...part.points].map((c) => describe(c, part.unit)).join("; ")}`,
    paint(p) {
      part.spans.forEach(({ start, end }, k) => {
        const [from, to] = [p.x(start), p.x(end)].map((x) => Math.min(p.right, Math.max(p.left, x)));
        if (start === end) p.frame.append(svg("line", { class: "edge", x1: from, x2: from, y1: p.top, y2: p.bottom }));
        else p.frame.append(svg("rect", { class: `span${k % 2 ? " odd" : ""}`, x: Math.min(from, to), width: Math.abs(to - from), y: p.top, height: p.bottom - p.top }));
      });
      part.curves.forEach((c) => {
        if (c.lower && c.upper) p.frame.append(svg("path", { class: `band ${colour(c.stroke)}`, d: band(p, time, c.lower, c.upper) }));
      });
      p.lines = part.curves.map((c) => line(p, c.stroke, time, c.values, c.thin));
      p.frame.append(...p.lines);
      for (const { name, value } of part.limits) {
        p.frame.append(svg("line", { class: "limit", x1: p.left, x2: p.right, y1: p.y(value), y2: p.y(value) }));
        p.frame.append(svg("text", { class: "tick limit", x: p.right - 4, y: p.y(value) - 5, "text-anchor": "end" }, name));
      }
      part.points.forEach(({ time: at, values: known, stroke, joined }, k) => {
        if (joined) p.frame.append(line(p, stroke ?? k, at, known, false));
        else known.forEach((value, i) => value !== null && p.frame.append(mark(k, stroke, p.x(at[i]), p.y(value))));
      });
      if (!named.length) return;
      p.cursor = svg("line", { class: "cursor", y1: p.top, y2: p.bottom });
      p.dots = named.map((c) => svg("circle", { class: `dot ${colour(c.stroke)}`, r: 4 }));
      p.frame.append(p.cursor, ...p.dots);
      place(p);
      pick(p, shownAlone);
    },
  });
  if (entries.length >= MANY) pickable(entries, (k) => pick(plot, (shownAlone = k)));

  /** One of many curves stands out; the others step back. */
  function pick(p, k) {
    if (!p.lines) return; // not drawn yet
    part.curves.forEach((c, i) => p.lines[i].classList.toggle("back", k !== null && c !== named[k]));
    p.dots.forEach((dot, i) => dot.classList.toggle("back", k !== null && i !== k));
    if (k !== null) p.frame.insertBefore(p.lines[part.curves.indexOf(named[k])], p.cursor);
  }

  /** Rounding errors are nothing. */
  const shown = (value) => (value !== null && Math.abs(value) < unseen ? 0 : value);

  function move(frame) {
    now = frame;
    // nothing is known there: said of a place that the reader chose, not of the one where the page opens
    named.forEach((c, k) => (values[k].textContent = begun || c.values[frame] !== null ? brief(shown(c.values[frame])) : ""));
    begun = true;
    place(plot);
  }

  function place(plot) {
    if (!plot.cursor) return; // not drawn yet
    const frame = now;
    const at = plot.x(time[frame]);
    plot.cursor.setAttribute("x1", at);
    plot.cursor.setAttribute("x2", at);
    named.forEach((c, k) => {
      const value = c.values[frame];
      plot.dots[k].setAttribute("visibility", value === null ? "hidden" : "visible");
      if (value === null) return;
      plot.dots[k].setAttribute("cx", at);
      plot.dots[k].setAttribute("cy", plot.y(value));
    });
  }

  const reach = part.over ? move : go; // what runs along an axis of its own is read there alone
  const point = (event) => reach(nearest(time, plot.at(event.clientX - plot.frame.getBoundingClientRect().left)));
  if (named.length) {
    plot.frame.classList.add("clickable");
    plot.frame.addEventListener("pointerdown", point);
    plot.frame.addEventListener("pointermove", (event) => (event.buttons || part.over || !plays) && point(event));
  }
  if (!part.over) return move;
  move(peak(named.map((c) => c.values)));
  return () => {};
}

/** Names of curves that pick one: while pointed at, and until the next press once pressed. */
function pickable(entries, pick) {
  let pressed = null;
  const press = (k) => {
    pressed = pressed === k ? null : k;
    entries.forEach((entry, i) => entry.setAttribute("aria-pressed", i === pressed));
    pick(pressed);
  };
  entries.forEach((entry, k) => {
    entry.classList.add("pick");
    for (const [name, value] of [["role", "button"], ["tabindex", 0], ["aria-pressed", false]]) entry.setAttribute(name, value);
    entry.addEventListener("pointerenter", () => pick(k));
    entry.addEventListener("pointerleave", () => pick(pressed));
    entry.addEventListener("click", () => press(k));
    entry.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation(); // the space bar plays elsewhere
      press(k);
    });
  });
}

const line = (plot, stroke, xs, ys, thin) =>
  svg("path", { class: `line ${colour(stroke)}${thin ? " thin" : ""}`, d: path(plot, xs, ys), ...(thin ? {} : { "stroke-dasharray": dash(stroke) }) });

/** Where the first curve is farthest from zero, of the places where most curves are known. */
function peak(all) {
  const known = (k) => all.filter((values) => values[k] !== null).length;
  const most = Math.max(0, ...(all[0] ?? []).map((_, k) => known(k)));
  const size = (k) => (known(k) === most ? Math.abs(all[0][k] ?? 0) : -1);
  return (all[0] ?? []).reduce((best, _, k) => (size(k) > size(best) ? k : best), 0);
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
