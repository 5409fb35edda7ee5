// The picture as files: a PNG of print size, a video of one loop; with legend, scale and caption, on white.
import { save } from "./save.js";

const PRINT = 2400; // pixels across: 200 mm at 300 to the inch
const RATE = 30; // pictures in a second of video
const KINDS = ["video/mp4;codecs=avc1.42E028", "video/mp4", "video/webm;codecs=vp9", "video/webm"];

/** The current picture, `PRINT` pixels wide. */
export async function savePicture(scene, drawings, caption, name) {
  const small = scene.enlarge(PRINT);
  scene.onPaper(true);
  try {
    const { sheet, paint } = await sheetOf(scene, drawings, caption.length);
    paint(caption);
    save(await new Promise((done) => sheet.toBlob(done, "image/png")), `${name}.png`);
  } finally {
    scene.onPaper(false);
    small();
  }
}

/** Whether this browser can record a video. */
export const films = () => typeof MediaRecorder !== "undefined" && Boolean(kind());
const kind = () => KINDS.find((each) => MediaRecorder.isTypeSupported(each));

/** One loop of all frames as a video, as long as a loop lasts when it is played; `at` hears of the part that is done. */
export async function saveVideo(scene, drawings, caption, time, seconds, name, at) {
  const before = time.frame();
  scene.onPaper(true);
  const { sheet, paint } = await sheetOf(scene, drawings, caption().length);
  const recorder = new MediaRecorder(sheet.captureStream(RATE), { mimeType: kind(), videoBitsPerSecond: 8e6 });
  const parts = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const ended = new Promise((done) => recorder.addEventListener("stop", done));
  const next = () => new Promise(requestAnimationFrame); // a browser takes pictures of a canvas as it draws the page
  time.go(0);
  paint(caption());
  const begun = new Promise((done) => recorder.addEventListener("start", done));
  recorder.start();
  await begun;
  const start = await next();
  for (let part = 0; part < 1; part = ((await next()) - start) / (1000 * seconds)) {
    time.go(Math.floor(part * (time.last + 1)));
    scene.draw();
    paint(caption());
    at(part);
  }
  recorder.stop();
  await ended;
  scene.onPaper(false);
  time.go(before);
  save(new Blob(parts, { type: recorder.mimeType }), `${name}.${recorder.mimeType.includes("mp4") ? "mp4" : "webm"}`);
}

/** A canvas for view, legend, scale and caption; `paint(caption)` puts there what the view shows now. */
async function sheetOf(scene, { legend, triad, scale }, lines) {
  scene.draw();
  const { width, height, clientWidth } = scene.canvas;
  const ratio = width / clientWidth;
  const even = (size) => 2 * Math.ceil(size / 2); // what videos ask for
  const key = legend.getBoundingClientRect().height;
  const below = (16 + key + 18 * lines) * ratio;
  const sheet = Object.assign(document.createElement("canvas"), { width: even(width), height: even(height + below) });
  const pen = sheet.getContext("2d");
  const placed = async (drawing, x, y) => {
    const box = drawing.getBoundingClientRect();
    return [await pictureOf(drawing, box), x, y, box.width * ratio, box.height * ratio];
  };
  const right = width - triad.getBoundingClientRect().width * ratio;
  const over = [await placed(triad, right, 0), await placed(legend, 4 * ratio, height + 4 * ratio)];
  const bar = scale.querySelector("i").getBoundingClientRect().width;

  function paint(caption) {
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, sheet.width, sheet.height);
    pen.drawImage(scene.canvas, 0, 0);
    for (const each of over) pen.drawImage(...each);
    pen.fillStyle = "#1b1f24";
    pen.font = `${13 * ratio}px sans-serif`;
    caption.forEach((line, k) => pen.fillText(line, 12 * ratio, height + (22 + key + 18 * k) * ratio, width - 24 * ratio));
    pen.fillText(scale.textContent.trim(), 14 * ratio, height - 20 * ratio);
    pen.fillRect(14 * ratio, height - 14 * ratio, bar * ratio, 3 * ratio);
  }
  return { sheet, paint };
}

/** An SVG of the page as an image, with the styles it has there. */
async function pictureOf(drawing, box) {
  const copy = drawing.cloneNode(true);
  const [from, to] = [drawing, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  from.forEach((element, k) => {
    const style = getComputedStyle(element);
    for (const name of ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family", "font-weight", "text-anchor"]) {
      if (!(name === "fill" && style.fill.includes("url"))) to[k].setAttribute(name, style.getPropertyValue(name));
    }
  });
  copy.setAttribute("width", box.width);
  copy.setAttribute("height", box.height);
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  await image.decode();
  return image;
}
