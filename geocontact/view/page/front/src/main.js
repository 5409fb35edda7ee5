// Starts the page: cursor first, then what follows it. Without WebGL the curves, tables and words still work.
import { curves, strip } from "./charts.js";
import { continues } from "./continues.js";
import { cursor, keys, player } from "./controls.js";
import { matrix, strips } from "./heat.js";
import { hosted, marking } from "./host.js";
import { intervals } from "./intervals.js";
import { names } from "./linkages.js";
import { legend, scaleBar, triad } from "./overlays.js";
import { plan } from "./plan.js";
import { boldFirst, quantitiesOf } from "./quantities.js";
import { tables } from "./save.js";
import { picking } from "./pick.js";
import { openScene } from "./scene.js";
import { tools } from "./tools.js";

const element = (id) => document.getElementById(id);
const state = (window.__geocontact = { ready: false, frame: 0 });
const host = hosted(); // before the window can have said anything

function notice(text) {
  element("notice").textContent = text;
  element("notice").hidden = !text;
}

/** Shows what belongs to a choice in place of what belongs to the others. */
function show(choice) {
  for (const part of document.querySelectorAll("[data-choice]")) part.hidden = Number(part.dataset.choice) !== choice;
}

function readout(panel, part) {
  const cells = panel.querySelectorAll("td.value bdi");
  return (frame) => part.texts.forEach((texts, row) => (cells[row].textContent = texts[frame]));
}

async function picture(data, time, play) {
  const canvas = element("canvas");
  canvas.addEventListener("webglcontextlost", () => notice("The 3-D picture was lost (graphics driver). It comes back by itself; if not, reload the page."));
  canvas.addEventListener("webglcontextrestored", () => notice(""));
  const scene = await openScene(data.scene, canvas);
  scene.presets = data.scene.directions.length;
  const choices = quantitiesOf(data.scene);
  let chosen = choices[0];
  const colour = () => {
    chosen = choices[Number(element("colours")?.value ?? 0)];
    scene.setQuantity(chosen);
    const coloured = data.scene.maps.length || data.scene.bodies.some((body) => body.distance);
    element("legend").hidden = Boolean(data.scene.bodies.length && !coloured);
    if (data.scene.bodies.length) legend(element("legend"), data.scene, chosen);
    else names(element("legend"), data.scene);
  };
  element("colours")?.addEventListener("change", colour);
  colour();
  const overlays = [triad(element("triad"), data.scene, scene.view), scaleBar(element("scale"), scene.view)];
  for (const draw of overlays) scene.drawn(draw);
  const drawings = () => ({ legend: element("legend").firstChild, triad: element("triad").firstChild, scale: element("scale") });
  const meaning = () => (data.scene.bodies.length ? `${chosen.name} [${chosen.unit}], ` : "");
  tools(scene, drawings, () => [data.title, meaning() + time.words(time.frame())], time, play, data.title);
  time.listen(scene.show);
  if (element("picking")) picking(scene, host);
  host.then((port) => marking(scene, port));
  scene.choose = (threshold) => {
    const thresholds = boldFirst(data.scene.thresholds, threshold);
    choices.at(-1).thresholds = thresholds;
    scene.setThresholds(thresholds);
    colour();
  };
  return scene;
}

async function start() {
  const data = JSON.parse(element("page-data").textContent);
  const time = cursor(data);
  const play = player(time);
  const pointed = (frame) => {
    play.pause();
    time.go(frame);
  };
  const reading = { go: pointed, plays: data.plays };
  const makers = { curves: (f, p) => curves(f, p, data.time, data.timeLabel, reading), strip, plan, intervals, matrix, strips, readout };
  const parts = data.parts.filter((part) => element(part.id)).map((part) => makers[part.kind](element(part.id), part));
  for (const move of parts) time.listen(move);
  time.listen((frame) => (state.frame = frame));
  for (const id of ["timeline", "keys", "choose"]) if (element(id)) element(id).hidden = false;
  continues();
  tables();
  let scene = null;
  if (data.scene) {
    try {
      scene = await picture(data, time, play);
    } catch (problem) {
      element("scene").classList.add("absent");
      notice("No 3-D picture: this browser offers no WebGL 2. Curves, tables and words work.");
      state.problem = String(problem);
    }
  }
  element("choice")?.addEventListener("input", ({ target }) => {
    const choice = Number(target.value);
    show(choice);
    for (const one of [...parts, scene]) one?.choose?.(data.thresholds[choice]);
  });
  keys(time, play, scene);
  time.go(data.start);
  scene?.draw();
  state.ready = true;
  document.documentElement.dataset.ready = "true";
}

start().catch((problem) => {
  notice(`The page could not start: ${problem.message}. A newer browser may help; tables and words are complete.`);
  throw problem;
});
