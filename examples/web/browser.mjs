// Launches Debian's Chromium without a window.

import { chromium } from "playwright-core";

export const launch = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // Chromium's sandbox does not work as root, as in CI.
    args: process.getuid?.() === 0 ? ["--no-sandbox"] : [],
  });
