// Buttons and sliders of the picture: views, bodies, section plane, PNG, video.
import { films, savePicture, saveVideo } from "./picture.js";
import { named } from "./save.js";

const element = (id) => document.getElementById(id);
const each = (name, act) => document.querySelectorAll(`[data-${name}]`).forEach((e) => act(e, Number(e.dataset[name])));

export function tools(scene, overlays, caption, time, play, title) {
  each("view", (button, k) => button.addEventListener("click", () => scene.view.look(k)));
  each("show", (box, k) => box.addEventListener("change", () => scene.setVisible(k, box.checked)));
  each("opacity", (slider, k) => slider.addEventListener("input", () => scene.setOpacity(k, Number(slider.value))));
  element("reset").addEventListener("click", scene.view.reset);
  element("png").addEventListener("click", () => savePicture(scene, overlays(), caption(), named(title)));
  const film = element("film");
  if (film && films()) {
    film.hidden = false;
    film.addEventListener("click", () => filmed(film, scene, overlays, caption, time, play, title));
  }

  if (element("cut")) sections(scene);
  element("more").open = !window.matchMedia("(max-width: 860px)").matches;
  element("tools").hidden = false;
  element("tools").addEventListener("focusin", ({ target }) => {
    // browsers leave what is seen in part where it is; the row of views is wider than a phone
    if (target.matches(":focus-visible")) target.scrollIntoView({ block: "nearest", inline: "nearest" });
  });
}

/** Records a video; the button says how far it is. */
async function filmed(button, scene, overlays, caption, time, play, title) {
  const words = button.textContent;
  button.disabled = true;
  play.pause();
  try {
    const at = (part) => (button.textContent = `recording ${Math.round(100 * part)} %`);
    await saveVideo(scene, overlays(), caption, time, Number(element("speed").value), named(title), at);
  } finally {
    button.textContent = words;
    button.disabled = false;
  }
}

function sections(scene) {
  const [axis, at, other] = ["cut", "cut-at", "cut-flip"].map(element);
  let flipped = false;
  const cut = () => {
    at.disabled = other.disabled = axis.value === "";
    scene.setSection(axis.value === "" ? null : Number(axis.value), Number(at.value), flipped);
  };
  axis.addEventListener("input", () => {
    flipped = axis.value !== "" && scene.view.towards(Number(axis.value)) < 0; // the near half is cut away
    cut();
  });
  at.addEventListener("input", cut);
  other.addEventListener("click", () => {
    flipped = !flipped;
    cut();
  });
}
