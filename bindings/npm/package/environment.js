// What acrobots and batches share.

import { draw } from "./draw.js";
import {
  DYNAMICS, Kept, STATE, accept, allocated, call, elements, indexOf, parameters, readSlots,
  writeSeed, writeSlots, writeState,
} from "./kept.js";
import {
  bytes, checked, copied, integers, invalid, isNumber, numbers, positive, randomSeed, wasm,
} from "./wasm.js";

export const TASKS = ["gymnasium", "swingup", "balance"];
export const AUTORESETS = ["NextStep", "SameStep", "Disabled"];
/** The kinds of draws in the order of the module, with the count of their numbers. */
const DRAWS = { fixed: 0, uniform: 2, logUniform: 2, normal: 4 };

export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";
export const isAction = (action) => action === 0 || action === 1 || action === 2;

export class Environment extends Kept {
  /** Makes a batch, or an acrobot, with the defaults of the options that only a batch has. */
  constructor(kind, options, defaults, names = []) {
    const all = [...names, "seed", "params", "maxSteps", "task", "draws"];
    const given = { ...defaults, ...checked("options", options, all) };
    const { count, seed = randomSeed(), params = {}, maxSteps, draws } = given;
    const { autoreset = AUTORESETS[0], ownParams = draws !== undefined, task = TASKS[0] } = given;
    positive("count", count);
    const limit = maxSteps === undefined ? 0 : positive("maxSteps", maxSteps);
    const mode = indexOf("autoreset", AUTORESETS, autoreset);
    if (typeof ownParams !== "boolean") {
      throw invalid("ownParams must be true or false", ownParams, []);
    }
    const settings = [limit, mode, ownParams, indexOf("task", TASKS, task)];
    const address = wasm().make(count, ...settings, kind === "acrobot");
    super(kind, allocated("acrobots", count, address));
    orFree(this, () => {
      changeParams(this, params);
      if (draws !== undefined) this.setDraws(draws);
      call(this, "reset", writeSeed(seed));
      call(this, "sample", writeSeed(randomSeed()));
    });
  }

  get params() {
    return readParams(this, 0);
  }

  setParams(changes) {
    changeParams(this, changes);
  }

  setDraws(draws) {
    const names = parameters().slice(0, -1);
    const given = readSlots("draws", draws, names);
    for (const [name, draw] of Object.entries(given)) given[name] = readDraw(name, draw);
    numbers().fill(0);
    for (const [name, row] of Object.entries(given)) numbers().set(row, 5 * names.indexOf(name));
    accept(call(this, "set_draws"), given);
  }

  snapshot() {
    const length = call(this, "save");
    if (length === 0) throw noMemory();
    const [at, allocated] = integers();
    const snapshot = bytes(at, length).slice();
    wasm().snapshot_free(at, allocated);
    return snapshot;
  }
}

/** Calls a function, and frees what is being made if that throws. */
function orFree(kept, make) {
  try {
    make();
  } catch (error) {
    kept.free();
    throw error;
  }
}

/** A draw as the module reads it: the index of its kind, and its numbers. */
function readDraw(name, draw) {
  const object = Array.isArray(draw) ? { uniform: draw } : draw;
  const given = typeof draw === "string" ? [[draw, []]] : Object.entries(object ?? {});
  const [[kind, array] = []] = given;
  const index = Object.keys(DRAWS).indexOf(kind);
  if (index < 0 || given.length > 1) {
    const forms = "[low, high], { logUniform: [low, high] }, { normal: [mean, std, low, high] }";
    throw invalid(`${name} must be drawn by ${forms} or "fixed"`, draw, []);
  }
  return [index, ...elements(name, array, DRAWS[kind], isNumber, "must be a number")];
}

/** The state of acrobot `index`. The words have more, as acrobot.js reads it. */
export function readState(kept, index) {
  call(kept, "read_one", index);
  return Object.freeze(Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]])));
}

export function drawOne(kept, index, context, options) {
  const params = readParams(kept, index);
  const state = readState(kept, index);
  draw(context, state, params, numbers()[6], options);
}

export function setState(kept, state, index) {
  const given = writeState(state);
  accept(call(kept, "set_state", index), given);
}

export function readParams(kept, index) {
  const names = parameters();
  call(kept, "params", index);
  const params = {};
  names.forEach((name, i) => {
    if (name.startsWith("torques")) (params.torques ??= []).push(numbers()[i]);
    else params[name] = numbers()[i];
  });
  Object.freeze(params.torques);
  return Object.freeze({ ...params, dynamics: DYNAMICS[params.dynamics] });
}

/** Of all acrobots, or of acrobot `index`. */
export function changeParams(kept, changes, index) {
  const names = parameters();
  const given = readSlots("params", changes, names);
  const mask = writeSlots(given, names);
  accept(call(kept, "set_params", mask, index !== undefined, index), given);
}

const noMemory = () =>
  new RangeError("WebAssembly's memory of at most 4 GiB has no room for the snapshot");

const REASONS = ["another checksum", "another class or version", "invalid contents"];

/** Loads a snapshot, or frees what is being made and throws. */
export function load(kept, snapshot) {
  orFree(kept, () => {
    const copy = copied("the snapshot", snapshot);
    const { length } = copy;
    const at = wasm().snapshot_new(length) >>> 0;
    if (at === 0) throw noMemory();
    bytes(at, length).set(copy);
    const rejected = call(kept, "load_snapshot", at, length);
    wasm().snapshot_free(at, length);
    if (rejected === 0) return;
    const rule = "the snapshot must be an undamaged one of the same class and version";
    throw new RangeError(`${rule}, got ${length} bytes with ${REASONS[rejected - 1]}`);
  });
}
