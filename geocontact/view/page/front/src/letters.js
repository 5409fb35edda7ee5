// Widths of letters, and words in lines that fit: SVG does not break lines.

let pen = null;

/** Width in px of a text of 12 px in the page's letters. */
function width(text) {
  if (!pen) {
    pen = document.createElement("canvas").getContext("2d");
    pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  }
  return pen.measureText(text).width;
}

/** Lines of at most `room` px, each with its width: broken at spaces, and within a word that is too long after . or _ */
export function lines(text, room) {
  const found = [];
  for (const part of text.split(/(?<= )/).flatMap((word) => (width(word) > room ? word.split(/(?<=[._])/) : [word]))) {
    if (found.length && width(found.at(-1) + part.trimEnd()) <= room) found[found.length - 1] += part;
    else found.push(part);
  }
  return found.map((line) => ({ text: line.trimEnd(), width: width(line.trimEnd()) }));
}
