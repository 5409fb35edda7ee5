// Landmarks: points that the reader picks on a surface, with names, in the numbers of its mesh file; saved as a table.
import { Matrix4, Vector3 } from "three";
import { quoted, save } from "./save.js";
import { html, svg } from "./svg.js";

const element = (id) => document.getElementById(id);
const STILL = 5; // px; a pointer that moves farther has turned the picture
const STEP = 8; // px; of the cross by a key
const DIGITS = 7; // of coordinates as shown; saved are twelve

/** Picking on the bodies that have the numbers of their files. */
export function picking(scene, host) {
  const { canvas, view } = scene;
  const bodies = scene.bodies.filter((body) => body.source);
  const marks = []; // { body, name, corners, weights, at, row, column }
  const history = [];
  let on = false;
  let moving = null; // place in the list of the landmark that the next click moves
  let cross = null; // px from the middle of the picture; null without the keyboard

  const toPicture = () => canvas.scrollIntoView({ block: "nearest" }); // on a phone it may be a screen above the button
  const remember = () => history.push(marks.map((mark) => ({ ...mark })));
  for (const body of bodies) marks.push(...body.source.landmarks.map((each) => ({ body, ...each, ...facing(body, each) })));
  element("pick-mat").checked ||= marks.some(({ row, column }) => row || column);
  const say = (words) => (element("pick-said").textContent = words);

  /** Nearest point of a body under a place of the picture, in pixels from its upper left corner. */
  function under(x, y) {
    const { width, height } = canvas.getBoundingClientRect();
    const from = new Vector3((2 * x) / width - 1, 1 - (2 * y) / height, -1).unproject(view.camera);
    const along = view.camera.getWorldDirection(new Vector3());
    let best = null;
    for (const body of bodies) {
      if (!body.group.visible) continue;
      const found = hit(body, from, along, scene.cutAway);
      if (found && (!best || found.way < best.way)) best = found;
    }
    return best;
  }

  function set(x, y) {
    const found = under(x, y);
    if (!found) return say("no surface there");
    const { body, face, point } = found;
    let { weights } = found;
    if (element("pick-at").value === "vertex") weights = nearestCorner(body, face, point);
    remember();
    const kept = moving === null ? { name: unused(), row: "", column: "" } : marks[moving];
    const mark = { ...kept, body, corners: cornersOf(body, face), weights, face };
    mark.at = coordinates(mark);
    marks.splice(moving ?? marks.length, moving === null ? 0 : 1, mark);
    moving = null;
    list();
    say(`${mark.name} at ${words(mark)}${bodies.length > 1 ? `, on ${body.source.file}` : ""}`);
  }

  const unused = () => {
    let k = marks.length + 1;
    while (marks.some(({ name }) => name === `L${k}`)) k++;
    return `L${k}`;
  };
  const words = ({ at, body }) => ["x", "y", "z"].map((axis, k) => `${axis} ${brief(at[k])}`).join(", ") + ` ${body.source.unit}`;

  function undo() {
    if (!history.length) return;
    marks.splice(0, marks.length, ...history.pop());
    moving = null;
    list();
    say(`undone, ${marks.length} landmark${marks.length === 1 ? "" : "s"}`);
  }

  /** The table, and what may be pressed. */
  function list() {
    const mat = element("pick-mat").checked;
    const table = element("pick-list");
    table.hidden = !marks.length;
    table.classList.toggle("with-mat", mat);
    table.classList.toggle("with-meshes", bodies.length > 1);
    const units = new Set(marks.map(({ body }) => body.source.unit));
    [...table.tHead.rows[0].cells].slice(1, 4).forEach((cell, k) => (cell.textContent = `${"xyz"[k]}${units.size === 1 ? ` [${[...units][0]}]` : ""}`));
    table.tBodies[0].replaceChildren(...marks.map((mark, k) => row(mark, k)));
    element("pick-undo").disabled = !history.length;
    check();
    draw();
  }

  function row(mark, k) {
    const field = (key, label, width) => {
      const input = html("input", key);
      Object.assign(input, { value: mark[key], size: width, autocomplete: "off" });
      input.setAttribute("aria-label", label);
      let before = mark[key];
      input.addEventListener("input", () => {
        if (before !== null) remember();
        before = null; // one step of undo for what is typed in one go
        mark[key] = input.value.replaceAll("\u00a0", " ").trim();
        element("pick-undo").disabled = false;
        check();
        draw();
      });
      input.addEventListener("blur", () => (before = mark[key]));
      return html("td", key === "name" ? "" : "mat", input);
    };
    const gone = html("button", "", "delete");
    gone.type = "button";
    gone.setAttribute("aria-label", `delete ${mark.name}`);
    gone.addEventListener("click", () => {
      remember();
      marks.splice(k, 1);
      moving = null;
      list();
      say(`${mark.name} deleted`);
      (element("pick-list").tBodies[0].rows[Math.min(k, marks.length - 1)]?.querySelector("button") ?? element("pick")).focus();
    });
    const move = html("button", "", "move");
    move.type = "button";
    move.setAttribute("aria-label", `move ${mark.name}`);
    move.setAttribute("aria-pressed", String(moving === k));
    move.addEventListener("click", () => {
      moving = moving === k ? null : k;
      if (!on && moving !== null) toggle();
      list();
      element("pick-list").tBodies[0].rows[k].querySelector("[aria-pressed]").focus({ preventScroll: true });
      if (moving === null) return;
      say(`the next point is the new place of ${mark.name}`);
      toPicture();
    });
    const numbers = mark.at.map((value) => html("td", "number", brief(value).replace(/^-/, "−")));
    return html("tr", "", field("name", `name of landmark ${k + 1}`, 10), ...numbers, field("row", `row of ${mark.name}`, 4), field("column", `column of ${mark.name}`, 4), html("td", "mesh", mark.body.source.file), html("td", "", move), html("td", "", gone));
  }

  /** What keeps the landmarks from being saved, in words. */
  function check() {
    const names = marks.map(({ body, name }) => `${body.source.sha256} ${name}`);
    const twice = marks.find((_, k) => names.indexOf(names[k]) !== k);
    const bare = marks.find(({ name }) => !name || /[\p{C}:]|(?! )\p{Z}/u.test(name));
    const unplaced = element("pick-mat").checked && marks.find(({ row, column }) => [row, column].some((text) => !/^\d*\.?\d+$/.test(text)));
    const why = bare ? (bare.name ? `${bare.name}: a name is letters, digits, signs and spaces, without a colon.` : "A landmark has no name.") : twice ? `Two landmarks are named ${twice.name}.` : unplaced ? `${unplaced.name} needs a row and a column of the mat, such as 0 and 7.5.` : "";
    for (const id of ["pick-save", "pick-use"]) element(id).disabled = !marks.length || Boolean(why);
    element("pick-hint").textContent = why || (moving !== null ? `Click the new place of ${marks[moving].name}.` : on ? "Click the surface; drag still turns it." : "Press “pick points”, then click the surface. With keys: P, then arrows and Enter on the picture.");
    element("pick-hint").classList.toggle("warns", Boolean(why));
  }

  /** Rings and names over the picture, dashed where the face looks away; the cross of the keyboard. */
  function draw() {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const seen = view.camera.getWorldDirection(new Vector3());
    const drawn = marks.flatMap((mark) => {
      const { point, normal } = placed(mark);
      const away = normal.dot(seen) > 0 ? " away" : "";
      if (!mark.body.group.visible) return [];
      point.project(view.camera);
      const [x, y] = [((point.x + 1) / 2) * width, ((1 - point.y) / 2) * height];
      return [svg("circle", { class: `landmark${away}`, cx: x, cy: y, r: 5 }), svg("text", { class: "named", x: x + 8, y: y - 6 }, mark.name)];
    });
    if (on && cross && document.activeElement === canvas) {
      const [x, y] = [width / 2 + cross[0], height / 2 + cross[1]];
      drawn.push(svg("path", { class: "aim", d: `M${x - 14} ${y}H${x - 4}M${x + 4} ${y}H${x + 14}M${x} ${y - 14}V${y - 4}M${x} ${y + 4}V${y + 14}` }));
    }
    element("picked").replaceChildren(...drawn);
  }

  function toggle() {
    on = !on;
    element("pick").setAttribute("aria-pressed", String(on));
    canvas.classList.toggle("picks", on);
    if (on) toPicture();
    say(on ? "picking: click the surface, or arrows and Enter on the picture" : "not picking");
    if (!on && moving !== null) {
      moving = null;
      list();
    }
    check();
    draw();
  }

  function written(body) {
    const mat = element("pick-mat").checked;
    const { file, sha256, unit, frame } = body.source;
    const head = ["# landmarks picked by hand", `# mesh = ${file}`, `# mesh_sha256 = ${sha256}`, `# unit = ${unit}`, `# frame = ${frame}`];
    const columns = ["id", ...(mat ? ["row", "column"] : []), ...["x", "y", "z"].map((axis) => `${axis} [${unit}]`)];
    const rows = marks
      .filter((mark) => mark.body === body)
      .map(({ name, row, column, at }) => [quoted(name), ...(mat ? [row, column] : []), ...at.map((value) => String(Number(value.toPrecision(12))))]);
    return [...head, columns.join(","), ...rows.map((cells) => cells.join(","))].map((line) => `${line}\n`).join("");
  }

  let down = null;
  canvas.addEventListener("pointerdown", (event) => (down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null));
  canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
    if (!on || !down || Math.hypot(clientX - down[0], clientY - down[1]) > STILL) return;
    const { left, top } = canvas.getBoundingClientRect();
    cross = null;
    set(clientX - left, clientY - top);
  });
  canvas.addEventListener("keydown", (event) => {
    if (!on || event.shiftKey || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!step && event.key !== "Enter") return;
    event.preventDefault();
    cross ??= [0, 0];
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (step) cross = cross.map((at, k) => Math.min(Math.max(at + STEP * step[k], -[width, height][k] / 2), [width, height][k] / 2));
    else set(width / 2 + cross[0], height / 2 + cross[1]);
    draw();
  });
  canvas.addEventListener("focus", () => {
    if (canvas.matches(":focus-visible")) cross ??= [0, 0];
    draw();
  });
  canvas.addEventListener("blur", draw);
  element("pick-list").addEventListener("keydown", (event) => {
    if (!event.target.matches("input")) return;
    event.stopPropagation(); // letters of a name are no keys of the page
    if (event.key === "Enter" || event.key === "Escape") canvas.focus();
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || event.target.matches?.("select")) return;
    if (event.key === "p" || event.key === "P") toggle();
    if (event.key === "u" || event.key === "U") undo();
  });
  element("pick").addEventListener("click", toggle);
  element("pick-undo").addEventListener("click", undo);
  element("pick-mat").addEventListener("change", list);
  /** A table for each body that has landmarks. */
  const files = () =>
    bodies
      .filter((each) => marks.some((mark) => mark.body === each))
      .map((body) => {
        const name = body.source.file.replace(/\.[^.]*$/, "").replace(/[^\p{L}\p{N}._-]+/gu, "_");
        return { name: `${name}_landmarks.csv`, text: written(body), landmarks: marks.filter((mark) => mark.body === body).map((mark) => mark.name) };
      });
  element("pick-save").addEventListener("click", () => {
    for (const { name, text } of files()) save(new Blob([text], { type: "text/csv;charset=utf-8" }), name);
  });
  host.then((port) => {
    element("pick-use").hidden = false;
    element("pick-use").addEventListener("click", () => files().forEach((file) => port.postMessage(file)));
  });
  scene.drawn(draw);
  element("picking").hidden = false;
  list();
}

/** Face with these corners, whose order the page may have turned, and the weights in its order. */
function facing(body, { corners, weights }) {
  const { faces } = body.source;
  for (let face = 0; 3 * face < faces.length; face++) {
    const own = cornersOf(body, face);
    if (own.every((corner) => corners.includes(corner))) return { face, corners: own, weights: own.map((corner) => weights[corners.indexOf(corner)]) };
  }
  throw new Error("a landmark is on no face");
}

const cornersOf = (body, face) => [0, 1, 2].map((k) => body.source.faces[3 * face + k]);

const brief = (value) => String(Number(value.toPrecision(DIGITS)));

/** Where a ray meets a body first, in the scene: face, weights of its corners, way along the ray; null where nowhere. */
function hit(body, from, along, cutAway) {
  const inverse = new Matrix4().copy(body.group.matrix).invert();
  const [o, d] = [from.clone().applyMatrix4(inverse), along.clone().transformDirection(inverse)];
  const p = body.geometry.getAttribute("position").array;
  const place = new Vector3();
  let best = null;
  for (let i = 0; i < p.length; i += 9) {
    const [ux, uy, uz] = [p[i + 3] - p[i], p[i + 4] - p[i + 1], p[i + 5] - p[i + 2]];
    const [vx, vy, vz] = [p[i + 6] - p[i], p[i + 7] - p[i + 1], p[i + 8] - p[i + 2]];
    const [hx, hy, hz] = [d.y * vz - d.z * vy, d.z * vx - d.x * vz, d.x * vy - d.y * vx];
    const volume = ux * hx + uy * hy + uz * hz;
    if (volume === 0) continue;
    const [sx, sy, sz] = [o.x - p[i], o.y - p[i + 1], o.z - p[i + 2]];
    const b = (sx * hx + sy * hy + sz * hz) / volume;
    if (b < -1e-9 || b > 1 + 1e-9) continue;
    const [qx, qy, qz] = [sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux];
    const c = (d.x * qx + d.y * qy + d.z * qz) / volume;
    if (c < -1e-9 || b + c > 1 + 1e-9) continue;
    const way = (vx * qx + vy * qy + vz * qz) / volume;
    if (best && way >= best.way) continue;
    place.copy(o).addScaledVector(d, way);
    if (cutAway(place.clone().applyMatrix4(body.group.matrix))) continue;
    best = { body, face: i / 9, weights: [1 - b - c, b, c], way, point: place.clone() };
  }
  return best;
}

function nearestCorner(body, face, point) {
  const p = body.geometry.getAttribute("position").array;
  const ways = [0, 1, 2].map((k) => Math.hypot(...[0, 1, 2].map((a) => p[9 * face + 3 * k + a] - point.getComponent(a))));
  return ways.map((way, k) => Number(k === ways.indexOf(Math.min(...ways))));
}

/** Of a landmark in the numbers of the mesh file. */
function coordinates({ body, corners, weights }) {
  return [0, 1, 2].map((a) => corners.reduce((sum, corner, k) => sum + (weights[k] ? weights[k] * body.source.exact[3 * corner + a] : 0), 0));
}

/** Place in the scene as drawn, and the normal of its face. */
function placed({ body, face, weights }) {
  const p = body.geometry.getAttribute("position").array;
  const corner = (k) => new Vector3().fromArray(p, 9 * face + 3 * k);
  const [a, b, c] = [corner(0), corner(1), corner(2)];
  const point = new Vector3().addScaledVector(a, weights[0]).addScaledVector(b, weights[1]).addScaledVector(c, weights[2]);
  const normal = b.sub(a).cross(c.sub(a)).transformDirection(body.group.matrix);
  return { point: point.applyMatrix4(body.group.matrix), normal };
}
