// Builds ../bundle from src: one script, one style sheet, three.js' licence, and a record with hashes of all of it.
import { createHash } from "node:crypto";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const sha256 = (path) => createHash("sha256").update(readFileSync(here(path))).digest("hex");
const version = (name) => JSON.parse(readFileSync(here(`node_modules/${name}/package.json`), "utf8")).version;
const licence = readFileSync(here("node_modules/three/LICENSE"), "utf8").trimEnd();

mkdirSync(here("../bundle"), { recursive: true });
const { warnings } = await build({
  absWorkingDir: here("."),
  entryPoints: ["src/main.js", "src/style.css"],
  entryNames: "[name]",
  outdir: here("../bundle"),
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome103", "firefox113", "safari16.4"], // the first with DecompressionStream or close to it
  charset: "utf8",
  legalComments: "none", // the licence stands at the script's head, so that every page that is passed on holds it
  banner: { js: `/*! three.js ${version("three")}, MIT licence:\n\n${licence}\n*/` },
});
if (warnings.length) process.exit(1);
const script = readFileSync(here("../bundle/main.js"), "utf8").trimEnd();
writeFileSync(here("../bundle/page.js"), script);
writeFileSync(here("../bundle/style.css"), readFileSync(here("../bundle/style.css"), "utf8").trimEnd());
rmSync(here("../bundle/main.js"));
copyFileSync(here("node_modules/three/LICENSE"), here("../bundle/THREE-LICENSE"));

const sources = ["build.mjs", "package.json", "package-lock.json", ...readdirSync(here("src")).map((f) => `src/${f}`)];
const lines = (names, at) => names.sort().map((name) => `"${name}" = "${sha256(at + name)}"`);
writeFileSync(
  here("../bundle/bundle.toml"),
  [
    "# Written by front/build.mjs; do not edit.",
    `three = "${version("three")}"`,
    'licence = "MIT"',
    `esbuild = "${version("esbuild")}"`,
    "",
    "[built]",
    ...lines(["page.js", "style.css", "THREE-LICENSE"], "../bundle/"),
    "",
    "[sources]",
    ...lines(sources, "./"),
    "",
  ].join("\n"),
);
