// Compares every digest in Node. Exits with status 1 if one differs.
import { readFile } from "node:fs/promises";

const file = new URL("target/wasm32-unknown-unknown/release/acrobot_wasm_parity.wasm", import.meta.url);
const { instance } = await WebAssembly.instantiate(await readFile(file));
const { found, expected, batch_is_equal, training_is_equal } = instance.exports;

for (const [arithmetic, name] of ["reference", "portable", "fast", "micro"].entries()) {
  let equal = 0;
  for (let episode = 0; episode < 16; episode++) {
    if (found(arithmetic, episode) === expected(arithmetic, episode)) {
      equal++;
    } else {
      console.error(`${name} differs in episode ${episode}`);
      process.exitCode = 1;
    }
  }
  console.log(`${name}: ${equal} of 16 episodes are bit-identical`);
}
for (const [name, is_equal] of Object.entries({ batch: batch_is_equal, training: training_is_equal })) {
  if (is_equal()) {
    console.log(`${name}: bit-identical`);
  } else {
    console.error(`${name} differs`);
    process.exitCode = 1;
  }
}
