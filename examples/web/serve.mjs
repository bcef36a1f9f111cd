// A static server for dist/: `npm run serve`, or `npm run serve -- 8000` for that port.

import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

const TYPES = {
  ".css": "text/css",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};

/** A server on this machine's own address. Port 0 takes any free port. */
export function serve(port) {
  const server = createServer(({ url }, response) => {
    const path = normalize(new URL(url, "http://localhost").pathname);
    const file = join(import.meta.dirname, "dist", path.endsWith("/") ? `${path}index.html` : path);
    if (!statSync(file, { throwIfNoEntry: false })?.isFile()) {
      response.writeHead(404).end("not found");
      return;
    }
    response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" });
    createReadStream(file).pipe(response);
  });
  return new Promise((resolve, reject) => {
    server.on("error", reject);
    server.listen(port, "127.0.0.1", () => resolve(server));
  });
}

if (process.argv[1] === import.meta.filename) {
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
