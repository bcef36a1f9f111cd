// The development server answers every request and continues to serve.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

const program = fileURLToPath(new URL("../serve.mjs", import.meta.url));
const main = readFileSync(new URL("../page/main.js", import.meta.url), "utf8");
let server, port;

before(async () => {
  // In another process, because a crash must not end the tests.
  server = spawn(process.execPath, [program, "0"], { stdio: ["ignore", "pipe", "inherit"] });
  const [line] = await once(server.stdout, "data");
  [, port] = /^http:\/\/localhost:(\d+)\/\n$/.exec(line);
});

after(() => server.kill());

/** The answer to a request that is sent as it stands. */
async function answer(request) {
  const socket = connect(port, "127.0.0.1");
  const chunks = [];
  socket.on("data", (chunk) => chunks.push(chunk));
  // If the server closes before it has read everything, the connection is reset, and its answer can be lost.
  let reset = false;
  socket.on("error", ({ code }) => (reset = code === "ECONNRESET" || code === "EPIPE"));
  socket.write(request);
  // Not `once`, which rejects on an error.
  await new Promise((resolve) => socket.on("close", resolve));
  const text = Buffer.concat(chunks).toString();
  const [head, ...body] = text.split("\r\n\r\n");
  return { status: text || !reset ? Number(head.split(" ")[1]) : "reset", head, body: body.join("\r\n\r\n") };
}

const ask = (path, method = "GET") => answer(`${method} ${path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n`);

async function stillServes() {
  const { status, head, body } = await ask("/main.js");
  assert.equal(status, 200);
  assert.match(head, /^content-type: text\/javascript$/im);
  assert.ok(body.includes(main));
}

test("files are served, for relative and absolute addresses", async () => {
  await stillServes();
  for (const path of ["/", "//", "/index.html?a=b#c", "/./x/../", "http://localhost/", "/%2e%2e/"]) {
    const { status, body } = await ask(path);
    assert.equal(status, 200, path);
    assert.match(body, /<title>/, path);
  }
});

test("every other address is answered with 400 or 404", async () => {
  const long = "n".repeat(256);
  for (const path of [
    "/main.js/", "/index.html/x", "/main.js/..%2f", `/${long}`, `/${long}/${long}.js`, "//[", "//%", "///[::1", "/\\[", "/\\\\%", "/%", "/%zz",
    "/%00", "/main.js%00", "/..%2f..%2f..%2fetc/passwd", "/..%5c..%5cserve.mjs", "/../serve.mjs", "/%2e%2e/serve.mjs", "/..;/serve.mjs", "/none",
    "/screenshots", "/none/", "http://[/", "http://", "*", ":99999/", "/%ff%fe", "/\xff", "/\x01",
  ]) {
    const { status, body } = await ask(path);
    assert.ok([400, 404].includes(status), `${status} for ${path}`);
    assert.ok(!body.includes("createServer") && !body.includes("root:"), path);
    await stillServes();
  }
});

test("HEAD has no body, and other methods are rejected", async () => {
  const { status, body } = await ask("/main.js", "HEAD");
  assert.deepEqual([status, body], [200, ""]);
  for (const method of ["POST", "PUT", "DELETE", "OPTIONS", "TRACE"]) {
    const { status, head } = await ask("/main.js", method);
    assert.equal(status, 405, method);
    assert.match(head, /^allow: GET, HEAD$/im);
  }
  const { status: posted } = await answer(`POST / HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\ncontent-length: 1000000\r\n\r\n${"x".repeat(1e6)}`);
  assert.ok([405, "reset"].includes(posted), `${posted}`);
  await stillServes();
});

test("bytes that are not HTTP are rejected", async () => {
  const { status } = await ask(`/${"x".repeat(100_000)}`);
  assert.ok([431, "reset"].includes(status), `${status}`);
  for (const request of ["\r\n\r\n\0", "GET\r\n\r\n", "\x16\x03\x01\x02\x00\x01\x00\x01", "GET / HTTP/9.9\r\n\r\n"]) {
    assert.equal((await answer(request)).status, 400, request);
  }
  await stillServes();
});

test("a client may disconnect at any time", async () => {
  for (let i = 0; i < 50; i++) {
    const socket = connect(port, "127.0.0.1");
    await once(socket, "connect");
    socket.on("error", () => {});
    const request = "GET /acrobot.wasm HTTP/1.1\r\nhost: localhost\r\n\r\n";
    if (i % 2) {
      socket.write(request.slice(0, i));
      socket.resetAndDestroy();
    } else {
      socket.write(request.repeat(20));
      socket.once("data", () => socket.resetAndDestroy());
      await new Promise((resolve) => socket.on("close", resolve));
    }
  }
  await stillServes();
});

test("a port that is taken or invalid is an error", async () => {
  const taken = createServer().listen(0, "127.0.0.1");
  await once(taken, "listening");
  for (const [argument, reason] of [
    [String(taken.address().port), /^error: cannot serve at port \d+: .*address already in use/],
    ["65536", /^error: port must be an integer from 0 to 65535, got "65536"\n$/],
    ["", /got ""/],
    ["1e3", /got "1e3"/],
  ]) {
    const { stderr, status } = await ended(spawn(process.execPath, [program, argument]));
    assert.match(stderr, reason);
    assert.equal(status, 2);
  }
  taken.close();
});

async function ended(child) {
  let stderr = "";
  child.stderr.on("data", (chunk) => (stderr += chunk));
  const [status] = await once(child, "close");
  return { stderr, status };
}
