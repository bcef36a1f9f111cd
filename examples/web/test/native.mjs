// Native results, from the programs of examples/desktop.

import { spawnSync } from "node:child_process";

const root = new URL("../../..", import.meta.url);

/** The actions of several tests. */
export const ACTIONS = [2, 2, 2, 0, 0, 1, 2, 2, 0, 0, 0, 1, 1, 2, 0, 2, 2, 2, 0, 0, 0];

/** The bits of numbers in single precision. */
export const bits = (numbers) => {
  const words = [...new Uint32Array(Float32Array.from(numbers).buffer)];
  return words.map((word) => word.toString(16).padStart(8, "0"));
};

function program(name, args) {
  const command = ["run", "--quiet", "--locked", "-p", "desktop", "--bin", name, "--", ...args];
  const result = spawnSync("cargo", command, { cwd: root, encoding: "utf8" });
  if (result.error) throw result.error;
  return result;
}

/**
 * The bits of θ1, θ2, θ̇1 and θ̇2 in single precision, of the initial state and after each action.
 */
export function trace(seed, actions, ...args) {
  const { status, stdout, stderr } = program("trace", ["--seed", seed, ...args, actions.join("")]);
  if (status !== 0) throw new Error(stderr);
  return stdout.trim().split("\n").map((line) => line.split(" "));
}

/** Runs `swing_up` with `args`. Returns its standard error if it failed, otherwise null. */
export function swingUp(...args) {
  const { status, stderr } = program("swing_up", ["--quiet", ...args]);
  return status === 0 ? null : stderr.trim();
}
