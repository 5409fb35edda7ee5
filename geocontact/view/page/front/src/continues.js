// Tables, drawings and rows of numbers that are wider or longer than their room say so.
import { html } from "./svg.js";

const WORDS = { across: "scroll sideways for more →", down: "scroll down for more ↓" };

/** A hint above everything that continues outside its room, for as long as it does. */
export function continues() {
  for (const room of document.querySelectorAll(".wide")) {
    const hint = html("p", "hint");
    room.before(hint);
    const look = () => {
      const across = room.scrollWidth > room.clientWidth + 1;
      const down = room.scrollHeight > room.clientHeight + 1;
      const words = [across && WORDS.across, down && WORDS.down].filter(Boolean).join(" · ");
      hint.textContent = words;
      hint.hidden = !words;
      room.classList.toggle("beyond", across && room.scrollLeft + room.clientWidth < room.scrollWidth - 1);
    };
    new ResizeObserver(look).observe(room);
    for (const inside of room.children) new ResizeObserver(look).observe(inside);
    room.addEventListener("scroll", look, { passive: true });
    look();
  }
}
