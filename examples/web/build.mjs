// Builds the page into dist/: its files, and those of the npm package.

import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

import "../../bindings/npm/build.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
cpSync("page", "dist", { recursive: true });
for (const file of ["index.js", "policies.js", "control.js"]) {
  cpSync(`../../bindings/npm/dist/${file}`, `dist/acrobot-rs/${file}`);
}

// Without this the browser finds a module only in one that imports it.
const found = new Set();
const find = (file) => {
  if (found.has(file)) return;
  found.add(file);
  const imports = readFileSync(`dist/${file}`, "utf8").matchAll(/from "\.\/(.*?)"/g);
  for (const [, imported] of imports) find(imported);
};
find("main.js");
const links = [...found].map((file) => `<link rel="modulepreload" href="${file}">`);
const page = readFileSync("dist/index.html", "utf8");
writeFileSync("dist/index.html", page.replace(/<!-- build.*-->/, links.join("\n")));
