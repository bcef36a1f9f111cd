// A run in an address, after the #: seed, parameters that differ from Gymnasium's, and actions.

import { DEFAULTS, LIMIT, PARAMETERS, parseNumber, parseSeed, textOf } from "./settings.js";

export function encodeRun({ seed, params, actions }) {
  const fields = new URLSearchParams({ seed });
  for (const [name, value] of Object.entries(params)) {
    if (value !== DEFAULTS[name]) fields.set(name, textOf(value));
  }
  if (actions.length > 0) fields.set("actions", actions.join(""));
  return `#${fields}`;
}

/** The run in an address, with unchecked parameters. Throws an `Error` with the reason. */
export function decodeRun(hash) {
  const fields = new URLSearchParams(hash.slice(1));
  const known = ["seed", "dynamics", "actions", ...PARAMETERS.map(({ name }) => name)];
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
  const actions = fields.get("actions") ?? "";
  if (!/^[012]*$/.test(actions) || actions.length > LIMIT) {
    const rule = `actions must be at most ${LIMIT} of 0, 1 and 2`;
    throw new Error(`${rule}, got ${JSON.stringify(actions)}`);
  }
  const seed = parseSeed(fields.get("seed") ?? "42");
  return { seed, params, actions: Array.from(actions, Number) };
}
