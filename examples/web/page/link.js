// A run in an address, after the #: seed, parameters that differ from Gymnasium's, and inputs:
// either the actions of a whole episode, as the program `trace` takes them, or torques and pushes
// from a state on.

import { FULL } from "./game.js";
import { DEFAULTS, LIMIT, PARAMETERS, parseNumber, parseSeed, textOf } from "./settings.js";

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The digits of a torque's level, and of the step and both numbers of a push. */
const [LEVEL, PUSH] = [[2], [2, 3, 3]];

/** Writes rows of integers in base 64, each with a number of digits. 0 is in the middle. */
const pack = (rows, sizes) =>
  rows.flat().flatMap((integer, i) => {
    const size = sizes[i % sizes.length];
    const digit = (_, power) => DIGITS[Math.floor(offset(integer, size) / 64 ** power) % 64];
    return Array.from({ length: size }, digit);
  }).join("");

const offset = (integer, size) => integer + 64 ** size / 2;

/** The rows in a text. Throws an `Error` if it has others than digits, or too many or few. */
function unpack(name, text, sizes) {
  const length = sizes.reduce((sum, size) => sum + size);
  if (!/^[\w-]*$/.test(text) || text.length % length > 0 || text.length > LIMIT * length) {
    const rule = `${name} must be at most ${LIMIT} times ${length} digits in base 64`;
    throw new Error(`${rule}, got ${JSON.stringify(text)}`);
  }
  let from = 0;
  const read = (size) => {
    const digits = Array.from(text.slice(from, (from += size)), (digit) => DIGITS.indexOf(digit));
    return digits.reduce((sum, digit, i) => sum + digit * 64 ** i, -offset(0, size));
  };
  return Array.from({ length: text.length / length }, () => sizes.map(read));
}

/** The actions 0, 1 and 2 of a run that has only these, or null. */
export function actionsOf({ start, levels, pushes }) {
  const isAction = (level) => level === 0 || Math.abs(level) === FULL;
  const isPushed = pushes.some((push) => push !== null);
  if (start !== null || isPushed || !levels.every(isAction)) return null;
  return levels.map((level) => 1 + level / FULL);
}

export function encodeRun(run) {
  const { seed, params, start, levels, pushes, policy } = run;
  const fields = new URLSearchParams({ seed });
  for (const [name, value] of Object.entries(params)) {
    if (value !== DEFAULTS[name]) fields.set(name, textOf(value));
  }
  if (policy === "planner") fields.set("policy", policy);
  const actions = actionsOf(run);
  if (levels.length > 0 && actions !== null) fields.set("actions", actions.join(""));
  if (actions === null) {
    if (start !== null) fields.set("state", STATE.map((name) => textOf(start[name])).join(" "));
    fields.set("torques", pack(levels.map((level) => [level]), LEVEL));
    const pushed = pushes.flatMap((push, step) => (push === null ? [] : [[step, ...push]]));
    if (pushed.length > 0) fields.set("pushes", pack(pushed, PUSH));
  }
  return `#${fields}`;
}

/** The run in an address, with unchecked parameters. Throws an `Error` with the reason. */
export function decodeRun(hash) {
  const fields = new URLSearchParams(hash.slice(1));
  const names = ["seed", "dynamics", "policy", "actions", "state", "torques", "pushes"];
  const known = [...names, ...PARAMETERS.map(({ name }) => name)];
  const unknown = [...fields.keys()].find((name) => !known.includes(name));
  if (unknown !== undefined) {
    const rule = `names in the link must be ${known.join(", ")}`;
    throw new Error(`${rule}, got ${JSON.stringify(unknown)}`);
  }
  const params = { ...DEFAULTS };
  for (const { name } of PARAMETERS) {
    if (fields.has(name)) params[name] = parseNumber(fields.get(name));
  }
  if (fields.has("dynamics")) params.dynamics = fields.get("dynamics");
  const policy = fields.get("policy") ?? undefined;
  if (policy !== undefined && policy !== "planner") {
    throw new Error(`policy in the link must be planner, got ${JSON.stringify(policy)}`);
  }
  const seed = parseSeed(fields.get("seed") ?? "42");
  return { seed, params, policy, start: startOf(fields), ...inputsOf(fields) };
}

function startOf(fields) {
  if (!fields.has("state")) return null;
  const text = fields.get("state");
  const numbers = text.split(" ").map(parseNumber);
  if (numbers.length !== 4 || !numbers.every((number) => Number.isFinite(Math.fround(number)))) {
    throw new Error(`state must be four finite numbers, got ${JSON.stringify(text)}`);
  }
  return Object.fromEntries(STATE.map((name, i) => [name, numbers[i]]));
}

function inputsOf(fields) {
  const actions = fields.get("actions") ?? "";
  if (!/^[012]*$/.test(actions) || actions.length > LIMIT) {
    const rule = `actions must be at most ${LIMIT} of 0, 1 and 2`;
    throw new Error(`${rule}, got ${JSON.stringify(actions)}`);
  }
  const packed = unpack("torques", fields.get("torques") ?? "", LEVEL).flat();
  const levels = packed.length > 0 ? packed : Array.from(actions, (action) => FULL * (action - 1));
  const pushes = levels.map(() => null);
  for (const [step, ...push] of unpack("pushes", fields.get("pushes") ?? "", PUSH)) {
    if (!(step in pushes)) {
      throw new Error(`steps of pushes must be from 0 to ${levels.length - 1}, got ${step}`);
    }
    pushes[step] = push;
  }
  return { levels, pushes };
}
