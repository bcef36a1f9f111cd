// Native results, from the repository's examples.

import { spawnSync } from "node:child_process";

// Not this folder, whose Cargo configuration builds for WebAssembly.
const root = new URL("../../..", import.meta.url);

/** The actions of several tests. */
export const ACTIONS = [2, 2, 2, 0, 0, 1, 2, 2, 0, 0, 0, 1, 1, 2, 0, 2, 2, 2, 0, 0, 0];

function example(name, args, input) {
  const command = ["run", "--quiet", "--locked", "--example", name, "--", ...args];
  const { status, stdout, stderr, error } = spawnSync("cargo", command, { cwd: root, input, encoding: "utf8" });
  if (error) throw error;
  return { status, stdout, stderr };
}

/** The bits of θ1, θ2, θ̇1 and θ̇2 in single precision, of the initial state and after each action. */
export function trace(seed, actions, ...args) {
  const { status, stdout, stderr } = example("trace", ["--arithmetic", "fast", "--seed", seed, ...args], actions.join(""));
  if (status !== 0) throw new Error(stderr);
  return stdout.trim().split("\n").map((line) =>
    line.split(" ").slice(0, 4).map((word) => {
      const view = new DataView(new ArrayBuffer(8));
      view.setBigUint64(0, BigInt(`0x${word}`));
      view.setFloat32(0, view.getFloat64(0));
      return view.getUint32(0).toString(16).padStart(8, "0");
    }),
  );
}

/** The reason for which `trace` rejects its arguments. */
export function rejection(...args) {
  return example("trace", ["--seed", "0", ...args], "").stderr.trim().replace(/^error: /, "");
}

/** Runs `swing_up` with `args`. Returns its standard error if it failed, otherwise null. */
export function swingUp(...args) {
  const { status, stderr } = example("swing_up", ["--quiet", ...args], "");
  return status === 0 ? null : stderr.trim();
}
