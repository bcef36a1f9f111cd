// Launches Debian's Chromium without a window, by the `chromium` of playwright-core: examples/npm has another copy of it.

export const launch = (chromium) =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // Chromium's sandbox does not work as root, as in CI.
    args: process.getuid?.() === 0 ? ["--no-sandbox"] : [],
  });
