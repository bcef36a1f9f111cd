// Compiles the test and the package to CommonJS, which Jest runs.
const { transformSync } = require("esbuild");

exports.process = (code) => ({ code: transformSync(code, { format: "cjs" }).code });
