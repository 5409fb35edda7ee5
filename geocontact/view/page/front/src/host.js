// A page in a frame of the window: the window hands over a port, through which it marks faces and takes landmarks.
// Nothing is sent before a button is pressed, and nothing to a page that hands over no port.

/** The port of the window that this page is shown in; a promise that a page by itself never keeps. */
export function hosted() {
  return new Promise((found) => {
    if (window.parent === window) return;
    window.addEventListener("message", ({ source, data, ports }) => {
      if (source === window.parent && data === "geocontact" && ports[0]) found(ports[0]);
    });
  });
}

/** Marks the faces that the window names on the first body, whose file it is. */
export function marking(scene, port) {
  port.onmessage = ({ data }) => {
    const body = scene.bodies[0];
    body.mark(data && { ...data, faces: bits(data.faces, data.count) });
    window.__geocontact.marked = body.marked;
    scene.draw();
  };
}

/** Bits of a text in base64, the first one lowest. */
function bits(text, count) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return Uint8Array.from({ length: count }, (_, k) => (bytes[k >> 3] >> (k & 7)) & 1);
}
