// Firefox and WebKit by WebDriver, with those methods of Playwright that the package's tests use.
// Playwright itself drives only its own builds of these engines.

import { spawn } from "node:child_process";
import { setTimeout } from "node:timers/promises";

const PORT = 4444;
const ENGINES = {
  firefox: [
    "geckodriver",
    { "moz:firefoxOptions": { binary: "/usr/bin/firefox-esr" } },
  ],
  webkit: [
    "WebKitWebDriver",
    {
      "webkitgtk:browserOptions": {
        binary: "/usr/lib/x86_64-linux-gnu/webkit2gtk-4.1/MiniBrowser",
        args: ["--automation"],
      },
    },
  ],
};

async function command(method, path, body) {
  const url = `http://127.0.0.1:${PORT}/session${path}`;
  const headers = { "content-type": "application/json" };
  const response = await fetch(url, { method, headers, body: body && JSON.stringify(body) });
  const { value } = await response.json();
  if (!response.ok) throw new Error(value.message);
  return value;
}

/** Starts an engine, which has one page. */
export async function launch(engine) {
  const [program, alwaysMatch] = ENGINES[engine];
  const driver = spawn(program, [`--port=${PORT}`], { stdio: "ignore" });
  let session;
  for (let tries = 1; !session; tries++) {
    try {
      session = await command("POST", "", { capabilities: { alwaysMatch } });
    } catch (error) {
      if (tries === 20) throw error;
      await setTimeout(500); // until the driver listens
    }
  }
  const path = `/${session.sessionId}`;
  const evaluate = (code, argument) => {
    const script = `
      const done = arguments[1];
      Promise.resolve(arguments[0]).then(${code}).then(done, (error) => done(String(error)));`;
    return command("POST", `${path}/execute/async`, { script, args: [argument ?? null] });
  };
  const page = {
    goto: (url) => command("POST", `${path}/url`, { url }),
    evaluate,
    waitForFunction: async (code, argument) => {
      for (let tries = 0; !(await evaluate(code, argument)); tries++) {
        if (tries === 100) throw new Error(`never: ${code}`);
        await setTimeout(50);
      }
    },
  };
  const close = async () => {
    await command("DELETE", path);
    driver.kill();
  };
  return { newPage: () => page, close };
}
