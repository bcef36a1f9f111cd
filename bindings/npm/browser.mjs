// Serves a folder, and launches a browser without a window: for the tests of the package, and of
// the page in ../../examples/web. The browser is Debian's Chromium by Playwright, or, for the
// package, with `ENGINE=firefox` or `webkit` one by WebDriver.

import { context } from "esbuild";
import { chromium } from "playwright-core";

import * as webdriver from "./webdriver.mjs";

export async function launch(servedir) {
  const server = await context({});
  const { port } = await server.serve({ servedir, host: "127.0.0.1", port: 0 });
  const { ENGINE } = process.env;
  const browser = await (ENGINE ? webdriver.launch(ENGINE) : launchChromium());
  const close = () => Promise.all([browser.close(), server.dispose()]);
  return { browser, origin: `http://localhost:${port}/`, close };
}

const launchChromium = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // Chromium's sandbox does not work as root, as in CI.
    args: process.getuid?.() === 0 ? ["--no-sandbox"] : [],
  });
