// Time: play, slider, steps, speed, and the keys for them. One cursor; everything else listens.
import { brief } from "./ticks.js";

const element = (id) => document.getElementById(id);

/** The cursor: `go(frame)` moves it, `listen(f)` is called with every frame it comes to. */
export function cursor(data) {
  const last = data.time.length - 1;
  const slider = element("slider");
  const listeners = [];
  let frame = -1;
  const unit = /\[(.*)\]/.exec(data.timeLabel)?.[1] ?? "";
  const name = data.timeLabel.replace(/\s*\[.*\]/, "");
  const number = (k) => data.numbers?.[k] ?? k + 1; // in the whole motion, of which the page may hold a part
  const here = (k) => `${brief(data.time[k], 6)} ${unit}`.trim();
  const words = (k) => `${name} ${here(k)}${data.plays ? `, frame ${number(k)} of ${data.total}` : ""}`;

  function go(wanted) {
    const next = Math.min(Math.max(Math.round(wanted), 0), last);
    if (next === frame) return;
    frame = next;
    if (slider) {
      slider.value = frame;
      slider.setAttribute("aria-valuetext", words(frame));
      element("now").textContent = `${here(frame)} · frame ${number(frame)}/${data.total}`;
    }
    for (const place of document.querySelectorAll(".readout .now")) place.textContent = here(frame);
    for (const listen of listeners) listen(frame);
  }
  slider?.addEventListener("input", () => go(Number(slider.value)));
  return { go, words, last, listen: (f) => listeners.push(f), frame: () => frame };
}

const STILL = { toggle: () => {}, pause: () => {}, playing: () => false };

/** Play and pause; one loop takes the chosen time whatever the number of frames. Some pages have nothing that runs. */
export function player(time) {
  const button = element("play");
  if (!button) {
    time.listen(() => say(time, 500));
    return STILL;
  }
  let started = null;
  function tick(now) {
    if (started === null) return;
    const loop = 1000 * Number(element("speed").value);
    const part = ((now - started.at) / loop + started.part) % 1;
    time.go(Math.floor(part * (time.last + 1)));
    requestAnimationFrame(tick);
  }
  function toggle() {
    const playing = started === null && time.last > 0;
    started = playing ? { at: performance.now(), part: (time.frame() + 0.5) / (time.last + 1) } : null;
    button.setAttribute("aria-label", playing ? "Pause" : "Play");
    button.classList.toggle("on", playing);
    if (playing) requestAnimationFrame(tick);
    else say(time, 0);
  }
  function pause() {
    if (started !== null) toggle();
  }
  element("speed").addEventListener("change", () => {
    if (started !== null) started = { at: performance.now(), part: (time.frame() + 0.5) / (time.last + 1) };
  });
  for (const kind of ["pointerdown", "input"]) element("slider").addEventListener(kind, pause);
  button.addEventListener("click", toggle);
  for (const [id, step] of [["back", -1], ["forth", 1]]) {
    element(id).addEventListener("click", () => {
      pause();
      time.go(time.frame() + step);
    });
  }
  const playing = () => started !== null;
  time.listen(() => playing() || say(time, 500));
  return { toggle, pause, playing };
}

let waiting = 0;
/** Tells a screen reader where the cursor stands once it rests there. */
function say(time, delay) {
  clearTimeout(waiting);
  const place = element("said");
  if (place) waiting = setTimeout(() => (place.textContent = time.words(time.frame())), delay);
}

/** Keys of the whole page; what has the focus keeps its own. */
export function keys(time, play, scene) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const on = event.target instanceof Element ? event.target : document.body;
    const presses = on.closest("button, summary, select, a, input[type=checkbox]");
    const slides = on.closest("select, input[type=range]");
    const act = action(event, presses, slides, time, play, scene);
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function action({ key, shiftKey }, presses, slides, time, play, scene) {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[key];
  const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
  if (key === " " && !presses && play !== STILL) return play.toggle;
  if (step && !shiftKey && !slides) {
    return () => {
      play.pause();
      time.go(time.frame() + step);
    };
  }
  if (!scene) return null;
  if (turns && shiftKey && !slides) return () => scene.view.turn(turns[0] * 0.12, turns[1] * 0.12);
  if (/^[1-9]$/.test(key) && Number(key) <= scene.presets && !on(slides)) return () => scene.view.look(Number(key) - 1);
  return { r: scene.view.reset, R: scene.view.reset, "+": () => scene.view.zoom(1.2), "=": () => scene.view.zoom(1.2), "-": () => scene.view.zoom(1 / 1.2) }[key];
}

const on = (slides) => slides?.tagName === "SELECT"; // typing picks an option there
