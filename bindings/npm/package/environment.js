// What acrobots and batches share.

import { call, elements, empty, indexOf, readChanges } from "./kept.js";
import { STRUCTS, TASKS } from "./layout.js";
import { checked, invalid, positive, randomSeed, seedWords } from "./wasm.js";

const { acrobot_draw_t: DRAW, acrobot_params_t: { dynamics, ...DRAWN } } = STRUCTS;

/** The kinds of draws in the order of acrobot.h, with the fields of their numbers. */
const DRAWS = {
  fixed: [],
  uniform: ["low", "high"],
  logUniform: ["low", "high"],
  normal: ["mean", "std", "low", "high"],
};

export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";
export const isAction = (action) => action === 0 || action === 1 || action === 2;
/** The action of an acrobot whose last torque was another, or that was reset. */
export const NONE = 3;

/** A checked copy of the options, of which a batch has more. */
export function readOptions(options, names = []) {
  const all = [...names, "seed", "params", "maxSteps", "task", "draws"];
  const given = checked("options", options, all);
  const { seed = randomSeed(), params = {}, maxSteps, task = TASKS[0], draws } = given;
  seedWords(seed);
  if (maxSteps !== undefined) positive("maxSteps", maxSteps);
  const checks = { task: indexOf("task", TASKS, task), params: readChanges(params) };
  return { ...given, ...checks, seed, draws: draws === undefined ? undefined : readDraws(draws) };
}

/** The caller's numbers of draws, by the fields of a struct, and the words of theirs. */
export function readDraws(draws, what = "draws", struct = DRAWN) {
  const given = checked(what, draws, Object.keys(struct));
  const words = new Float32Array(5 * empty(struct).length);
  const kinds = new Int32Array(words.buffer);
  for (const [name, value] of Object.entries(given)) {
    const [at, count] = struct[name];
    const all = count === 1 ? [value] : elements(name, value, count, () => true);
    given[name] = all.flatMap((each, i) => {
      const [kind, numbers] = readDraw(count === 1 ? name : `${name}[${i}]`, each);
      const from = 5 * (at + i);
      kinds[from] = Object.keys(DRAWS).indexOf(kind);
      DRAWS[kind].forEach((field, j) => (words[from + DRAW[field][0]] = numbers[j]));
      return numbers;
    });
  }
  return { given, words };
}

/** The kind of a draw and its numbers. */
function readDraw(name, draw) {
  const object = Array.isArray(draw) ? { uniform: draw } : draw;
  const given = typeof draw === "string" ? [[draw, []]] : Object.entries(object ?? {});
  const [[kind, array] = []] = given;
  if (!Object.hasOwn(DRAWS, kind) || given.length > 1) {
    const forms = "[low, high], { logUniform: [low, high] }, { normal: [mean, std, low, high] }";
    throw invalid(`${name} must be drawn by ${forms} or "fixed"`, draw, []);
  }
  return [kind, elements(name, array, DRAWS[kind].length)];
}

/** Draws random actions, of a seed or as before. */
export function sample(space, seed, name, actions, ...count) {
  if (seed !== undefined) {
    const words = Uint32Array.from(seedWords(seed));
    call({}, "acrobot_action_space_init_with", space, words, words.length);
  }
  call({}, name, space, actions, ...count);
  return actions;
}

/** The bytes that a function has written. */
export function save(name, kept, size) {
  const [bytes, length] = [new Uint8Array(size), new Uint32Array(1)];
  call({}, name, kept, bytes, size, length);
  return bytes.slice(0, length[0]);
}
