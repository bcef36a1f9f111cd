// Serves a folder, and launches Debian's Chromium without a window: for the tests of the package, and of the page in ../web.

/**
 * `chromium` is that of playwright-core and `context` that of esbuild: each of the two folders has its own copies. Without `chromium` it
 * only serves.
 */
export async function launch(chromium, context, servedir) {
  const server = await context({});
  const { port } = await server.serve({ servedir, host: "127.0.0.1", port: 0 });
  const browser = await chromium?.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // Chromium's sandbox does not work as root, as in CI.
    args: process.getuid?.() === 0 ? ["--no-sandbox"] : [],
  });
  const close = () => Promise.all([browser?.close(), server.dispose()]);
  return { browser, origin: `http://localhost:${port}/`, close };
}
