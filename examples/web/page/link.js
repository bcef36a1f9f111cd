// A run in an address, after the #: seed, parameters that differ from Gymnasium's, and inputs:
// either the actions of a whole episode, as the program `trace` takes them, or torques and pushes
// from a state on.

import { FULL } from "./game.js";
import { DEFAULTS, LIMIT, PARAMETERS, parseNumber, parseSeed, textOf } from "./settings.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** Who plays on after the inputs. */
const POLICIES = ["planner", "bang_bang", "energy_law", "random"];
/** The longest code of a controller. */
const CODE = 4000;
/** Scores to beat, with the least and the largest: the game's return, and seconds held. */
const SCORES = { return: [-LIMIT, 0], held: [0, 1e6] };
/** The largest push in its units. */
const PUSH = 2 ** 20;

/** The actions 0, 1 and 2 of a run that has only these, or null. */
export function actionsOf({ start, levels, pushes }) {
  const isAction = (level) => level === 0 || Math.abs(level) === FULL;
  const isPushed = pushes.some((push) => push !== null);
  if (start !== null || isPushed || !levels.every(isAction)) return null;
  return levels.map((level) => 1 + level / FULL);
}

export function encodeRun(run) {
  const { seed, params, start, levels, pushes, policy, controller, scores } = run;
  const fields = new URLSearchParams({ seed });
  for (const [name, value] of Object.entries(params)) {
    if (value !== DEFAULTS[name]) fields.set(name, textOf(value));
  }
  if (POLICIES.includes(policy)) fields.set("policy", policy);
  if (controller !== undefined) fields.set("controller", controller);
  for (const [name, score] of Object.entries(scores)) fields.set(name, textOf(score));
  const actions = actionsOf(run);
  const pushed = pushes.flatMap((push, step) => (push === null ? [] : [step, ...push]));
  const lists = {
    state: start === null ? [] : STATE.map((name) => textOf(start[name])),
    actions: actions === null || levels.length === 0 ? [] : [actions.join("")],
    torques: actions === null ? levels : [],
    pushes: pushed,
  };
  for (const [name, list] of Object.entries(lists)) {
    if (list.length > 0) fields.set(name, list.join("_"));
  }
  return `#${fields}`;
}

/** The run in an address, with unchecked parameters. Throws an `Error` with the reason. */
export function decodeRun(hash) {
  const fields = new URLSearchParams(hash.slice(1));
  const rejected = (rule, name) => {
    throw new Error(`${rule}, got ${JSON.stringify(name)}`);
  };
  const names = ["seed", "dynamics", "policy", "controller", "actions", "state",
    "torques", "pushes", ...Object.keys(SCORES)];
  const numbers = [...PARAMETERS.map(({ name }) => name), "estimate"];
  const known = [...names, ...numbers];
  const unknown = [...fields.keys()].find((name) => !known.includes(name));
  if (unknown !== undefined) rejected(`names in the link must be ${known.join(", ")}`, unknown);
  const params = { ...DEFAULTS };
  for (const name of numbers) {
    if (fields.has(name)) params[name] = parseNumber(fields.get(name));
  }
  if (fields.has("dynamics")) params.dynamics = fields.get("dynamics");
  const policy = fields.get("policy") ?? undefined;
  if (policy !== undefined && !POLICIES.includes(policy)) {
    rejected(`policy in the link must be ${POLICIES.join(", ")}`, policy);
  }
  const controller = fields.get("controller") ?? undefined;
  if (controller?.length > CODE) rejected(`controller must have at most ${CODE} characters`, "");
  const scores = {};
  for (const [name, [least, most]] of Object.entries(SCORES)) {
    if (!fields.has(name)) continue;
    scores[name] = parseNumber(fields.get(name));
    const isValid = scores[name] >= least && scores[name] <= most;
    if (!isValid) rejected(`${name} must be from ${least} to ${most}`, fields.get(name));
  }
  const seed = parseSeed(fields.get("seed") ?? "42");

  const actions = fields.get("actions") ?? "";
  if (!/^[012]*$/.test(actions) || actions.length > LIMIT) {
    rejected(`actions must be at most ${LIMIT} of 0, 1 and 2`, actions);
  }
  /** A list of numbers from the link, if each is valid. */
  const listOf = (name, rule, isValid) => {
    const list = fields.has(name) ? fields.get(name).split("_").map(parseNumber) : [];
    if (!list.every(isValid)) rejected(`${name} must be at most ${rule}`, fields.get(name));
    return list;
  };
  const integers = (name, largest, count) => {
    const isInteger = (number) => Number.isInteger(number) && !Object.is(number, -0);
    const isValid = (number, i) => isInteger(number) && Math.abs(number) <= largest && i < count;
    return listOf(name, `${count} integers up to ±${largest}`, isValid);
  };
  const torques = integers("torques", FULL, LIMIT);
  const levels = torques.length > 0 ? torques : Array.from(actions, (each) => FULL * (each - 1));
  const pushes = levels.map(() => null);
  const pushed = integers("pushes", PUSH, 3 * LIMIT);
  for (let i = 0; i < pushed.length; i += 3) {
    const [step, ...push] = pushed.slice(i, i + 3);
    if (!(step in pushes) || push.length < 2) rejected("pushes must be of steps", pushed);
    pushes[step] = push;
  }
  const isFinite32 = (number, i) => Number.isFinite(Math.fround(number)) && i < 4;
  const state = listOf("state", "4 finite numbers", isFinite32);
  if (state.length % 4 !== 0) rejected("state must be 4 numbers", state);
  const entries = state.map((number, i) => [STATE[i], number]);
  const start = entries.length === 0 ? null : Object.fromEntries(entries);
  return { seed, params, policy, controller, scores, start, levels, pushes };
}
