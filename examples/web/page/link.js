// A run in an address, after the #: seed, parameters that differ from Gymnasium's, and actions.

import { DEFAULTS, LIMIT, PARAMETERS, parseNumber, parseSeed, textOf } from "./settings.js";

/** Fills the last byte, which has room for four actions. No action has this number. */
const PADDING = 3;

/** Actions as base64url, two bits each and the first in the highest. */
function encodeActions(actions) {
  let binary = "";
  for (let i = 0; i < actions.length; i += 4) {
    const [a, b = PADDING, c = PADDING, d = PADDING] = actions.slice(i, i + 4);
    binary += String.fromCharCode((a << 6) | (b << 4) | (c << 2) | d);
  }
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export function decodeActions(text) {
  const check = (isValid, rule, got) => {
    if (!isValid) throw new Error(`${rule}, got ${got}`);
  };
  const wrong = text.search(/[^A-Za-z0-9_-]/);
  const character = `'${text[wrong]}' as character ${wrong + 1}`;
  check(wrong < 0, "actions must be letters, digits, - and _", character);
  const rule = "actions must not have 1 character more than a multiple of 4";
  check(text.length % 4 !== 1, rule, `${text.length} characters`);
  const binary = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  const four = (byte) => [6, 4, 2, 0].map((shift) => (byte.charCodeAt(0) >> shift) & 3);
  const actions = Array.from(binary, four).flat();
  while (actions.at(-1) === PADDING) actions.pop();
  const unknown = actions.indexOf(PADDING);
  check(unknown < 0, `action ${unknown + 1} must be 0, 1 or 2`, 3);
  check(actions.length <= LIMIT, `actions must be at most ${LIMIT}`, actions.length);
  return actions;
}

export function encodeRun({ seed, params, actions }) {
  const fields = new URLSearchParams({ seed });
  for (const [name, value] of Object.entries(params)) {
    if (value !== DEFAULTS[name]) fields.set(name, textOf(value));
  }
  if (actions.length > 0) fields.set("actions", encodeActions(actions));
  return `#${fields}`;
}

/** The run in an address, with unchecked parameters. Throws an `Error` with the reason. */
export function decodeRun(hash) {
  const fields = new URLSearchParams(hash.slice(1));
  const known = ["seed", "dynamics", "actions", ...PARAMETERS.map(({ name }) => name)];
  const unknown = [...fields.keys()].find((name) => !known.includes(name));
  if (unknown !== undefined) {
    throw new Error(`names in the link must be ${known.join(", ")}, got "${unknown}"`);
  }
  const params = { ...DEFAULTS };
  for (const { name, unit } of PARAMETERS) {
    const text = fields.get(name);
    if (text === null) continue;
    params[name] = parseNumber(text);
    const rule = `${name} must be a finite number of ${unit}`;
    if (!Number.isFinite(params[name])) throw new Error(`${rule}, got ${text || "an empty text"}`);
  }
  if (fields.has("dynamics")) params.dynamics = fields.get("dynamics");
  const actions = decodeActions(fields.get("actions") ?? "");
  return { seed: parseSeed(fields.get("seed") ?? "42"), params, actions };
}
