// The current picture as a PNG: what is seen, with legend, scale and caption, on white.

/** Draws view, legend, scale and caption onto a canvas of their own and hands it to the reader. */
export async function savePicture(scene, { legend, triad, scale }, caption, name) {
  scene.draw();
  const { width, height, clientWidth } = scene.canvas;
  const ratio = width / clientWidth;
  const below = (54 + 18 * caption.length) * ratio;
  const sheet = Object.assign(document.createElement("canvas"), { width, height: height + below });
  const pen = sheet.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, sheet.width, sheet.height);
  pen.drawImage(scene.canvas, 0, 0);
  const place = async (drawing, x, y) => {
    const box = drawing.getBoundingClientRect();
    pen.drawImage(await pictureOf(drawing, box), x, y, box.width * ratio, box.height * ratio);
  };
  await place(triad, width - triad.getBoundingClientRect().width * ratio, 0);
  await place(legend, 4 * ratio, height + 4 * ratio);
  pen.fillStyle = "#1b1f24";
  pen.font = `${13 * ratio}px sans-serif`;
  caption.forEach((line, k) => pen.fillText(line, 12 * ratio, height + (60 + 18 * k) * ratio, width - 24 * ratio));
  pen.fillText(scale.textContent.trim(), 14 * ratio, height - 20 * ratio);
  pen.fillRect(14 * ratio, height - 14 * ratio, scale.querySelector("i").getBoundingClientRect().width * ratio, 3 * ratio);
  const blob = await new Promise((done) => sheet.toBlob(done, "image/png"));
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
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
