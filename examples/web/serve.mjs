// A static server for dist/: `npm run serve`, or `npm run serve -- 8000` for port 8000.

import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { fileURLToPath } from "node:url";

const DIST = fileURLToPath(new URL("dist", import.meta.url));

const TYPES = {
  ".css": "text/css",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};

/** The file for an address, or undefined if the address is invalid. It is always in `folder`, because URL resolves every "..". */
function fileOf(address, folder) {
  try {
    // URL would read what follows two slashes as a host name.
    const { pathname } = new URL(address.replace(/^[/\\]+/, "/"), "http://localhost");
    return join(folder, pathname.endsWith("/") ? `${pathname}index.html` : pathname);
  } catch {
    return undefined;
  }
}

/** A server for a folder that only this machine can reach. Port 0 takes any free port. */
export function serve(port, folder = DIST) {
  const server = createServer(async ({ method, url }, response) => {
    const fail = (status, reason, headers) => response.writeHead(status, headers).end(reason);
    if (method !== "GET" && method !== "HEAD") return fail(405, "the method must be GET or HEAD", { allow: "GET, HEAD" });
    const file = fileOf(url, folder);
    if (!file) return fail(400, "the address must be a path");
    try {
      // Before the response begins, because this fails if the file is missing, is a folder or is being replaced by a build.
      const content = await readFile(file);
      response.setHeader("content-type", TYPES[extname(file)] ?? "application/octet-stream");
      response.end(content);
    } catch {
      fail(404, "not found");
    }
  });
  return new Promise((resolve, reject) => {
    server.on("error", reject);
    server.listen(port, "127.0.0.1", () => resolve(server));
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const text = process.argv[2] ?? "8080";
  const port = Number(text);
  if (!/^\d+$/.test(text) || port > 65535) {
    console.error(`error: port must be an integer from 0 to 65535, got "${text}"`);
    process.exit(2);
  }
  try {
    const server = await serve(port);
    console.log(`http://localhost:${server.address().port}/`);
  } catch (error) {
    console.error(`error: cannot serve at port ${port}: ${error.message}`);
    process.exit(2);
  }
}
