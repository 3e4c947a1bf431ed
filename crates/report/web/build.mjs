// Makes what pages carry: two scripts and a style sheet, with the hashes by which a page allows
// them, below templates/html. `node build.mjs --check` compares instead of writing.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";

const OUT = new URL("../../../templates/html/", import.meta.url);
const HERE = new URL("./", import.meta.url);

/** Version and licence of a library, as a comment: the licence asks for its text in every copy. */
async function notice(name) {
  const folder = new URL(`node_modules/${name}/`, HERE);
  const { version, license } = JSON.parse(await readFile(new URL("package.json", folder), "utf8"));
  const text = await readFile(new URL("LICENSE", folder), "utf8");
  return `/*! ${name} ${version}, ${license}\n${text.trim()}\n*/`;
}

async function bundle(entry, libraries) {
  const made = await build({
    absWorkingDir: new URL(".", HERE).pathname,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    legalComments: "none",
    charset: "ascii",
    // each line is read alone where versions are compared
    lineLimit: 2000,
  });
  const notices = await Promise.all(libraries.map(notice));
  return [...notices, made.outputFiles[0].text.trim()].join("\n") + "\n";
}

const files = {
  "page.js": await bundle("src/page.js", ["uplot"]),
  "scene.js": await bundle("src/scene.js", ["three"]),
  "page.css": await bundle("src/page.css", ["uplot"]),
};
const hashes = Object.entries(files).map(([name, text]) => {
  // an element ends there, whatever the script meant
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`${name} would end its element`);
  return [name, "sha256-" + createHash("sha256").update(text).digest("base64")];
});
files["hashes.json"] = JSON.stringify(Object.fromEntries(hashes), null, 2) + "\n";

let stale = 0;
for (const [name, text] of Object.entries(files)) {
  const path = new URL(name, OUT);
  if (process.argv.includes("--check")) {
    const kept = await readFile(path, "utf8").catch(() => "");
    if (kept !== text) {
      console.error(`templates/html/${name} is stale: npm run build`);
      stale = 1;
    }
  } else {
    await writeFile(path, text);
    console.log(`${name}: ${text.length} bytes`);
  }
}
process.exitCode = stale;
