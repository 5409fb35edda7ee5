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

/** Marks faces of the first body, whose file the window names, or what is within a threshold on each; null: nothing. */
export function marking(scene, port) {
  port.onmessage = ({ data }) => {
    for (const body of scene.bodies) body.mark(null);
    if (data?.within) data.within.forEach((levels, k) => scene.bodies[k]?.markWithin(bytes(levels)));
    else if (data) scene.bodies[0].mark({ ...data, faces: bits(bytes(data.faces), data.count) });
    window.__geocontact.marked = scene.bodies[0].marked;
    scene.draw();
  };
}

/** Bytes of a text in base64. */
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Bits of bytes, the first one lowest. */
const bits = (packed, count) => Uint8Array.from({ length: count }, (_, k) => (packed[k >> 3] >> (k & 7)) & 1);
