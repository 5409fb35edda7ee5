// Files that the page makes itself: handed to the reader as downloads, without any network.

/** Hands a blob over as a file of that name. */
export function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A title as the name of a file: letters, digits and single underscores. */
export const named = (title) => title.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "_").replace(/^_+|_+$/g, "").slice(0, 60) || "geocontact";

/** Buttons of tables: each saves the table that it stands over as .csv, UTF-8, with a plain minus. */
export function tables() {
  for (const button of document.querySelectorAll("[data-csv]")) {
    button.hidden = false;
    button.addEventListener("click", () => {
      const rows = [...button.parentElement.querySelectorAll("tr")].map((row) => [...row.cells].map((cell) => quoted(cell.textContent.trim())).join(","));
      save(new Blob(["\ufeff", rows.join("\r\n"), "\r\n"], { type: "text/csv;charset=utf-8" }), `${named(button.dataset.csv)}.csv`);
    });
  }
}

export function quoted(text) {
  const plain = text.replace(/\u2212(?=[\d.])/g, "-").replaceAll("\u00a0", " ");
  return /[",\r\n]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
}
