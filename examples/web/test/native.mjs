// Native results, from the repository's examples.

import { spawnSync } from "node:child_process";

// Not this folder, whose Cargo configuration builds for WebAssembly.
const root = new URL("../../..", import.meta.url);

/** The actions of several tests. */
export const ACTIONS = [2, 2, 2, 0, 0, 1, 2, 2, 0, 0, 0, 1, 1, 2, 0, 2, 2, 2, 0, 0, 0];

/** The bits of numbers in single precision. */
export const bits = (numbers) =>
  Array.from(new Uint32Array(Float32Array.from(numbers).buffer), (word) => word.toString(16).padStart(8, "0"));

function example(name, args, input = "") {
  const command = ["run", "--quiet", "--locked", "--example", name, "--", ...args];
  const { status, stdout, stderr, error } = spawnSync("cargo", command, { cwd: root, input, encoding: "utf8" });
  if (error) throw error;
  return { status, stdout, stderr };
}

/** The bits of θ1, θ2, θ̇1 and θ̇2 in single precision, of the initial state and after each action. */
export function trace(seed, actions, ...args) {
  const { status, stdout, stderr } = example("trace", ["--arithmetic", "fast", "--seed", seed, ...args], actions.join(""));
  if (status !== 0) throw new Error(stderr);
  const number = (word) => Buffer.from(word, "hex").readDoubleBE();
  return stdout.trim().split("\n").map((line) => bits(line.split(" ").slice(0, 4).map(number)));
}

/** Runs `swing_up` with `args`. Returns its standard error if it failed, otherwise null. */
export function swingUp(...args) {
  const { status, stderr } = example("swing_up", ["--quiet", ...args]);
  return status === 0 ? null : stderr.trim();
}
