// What the page can set: the seed and the parameters.

/** The most steps of an episode, and of a link. */
export const LIMIT = 500;

/** Name, label, unit, Gymnasium's value, the slider's end and step, a hint, and its start. */
export const PARAMETERS = [
  ["dt", "Time step dt", "s", 0.2, 0.5, 0.01],
  ["torque", "Largest torque of the motor", "N m", 1, 10, 0.1, "", 0],
  ["mass1", "Mass of link 1", "kg", 1, 4, 0.05],
  ["mass2", "Mass of link 2", "kg", 1, 4, 0.05],
  ["length1", "Length of link 1", "m", 1, 3, 0.05, "Its centre of mass stays."],
  ["length2", "Length of link 2", "m", 1, 3, 0.05, "Changes only the picture and the tip height."],
  ["gravity", "Gravity", "m/s²", 9.8, 25, 0.1, "", 0],
].map(([name, label, unit, value, end, step, hint = "", start = step]) => {
  return { name, label, unit, value, end, step, hint, start };
});

export const DEFAULTS = {
  dynamics: "book",
  ...Object.fromEntries(PARAMETERS.map(({ name, value }) => [name, value])),
};

/** A motor and a time step with which holding upright is easy to watch. */
export const BALANCE = { ...DEFAULTS, dt: 0.02, torque: 5 };

/** The seed in a text. Throws an `Error` with the reason if the text is not a seed. */
export function parseSeed(text) {
  const digits = text.trim();
  if (/^[0-9]{1,600}$/.test(digits)) return BigInt(digits);
  throw new Error(`seed must have from 1 to 600 decimal digits, got ${JSON.stringify(digits)}`);
}

/** A number as text, which has the sign of a zero. */
export const textOf = (number) => (Object.is(number, -0) ? "-0" : String(number));

/** The number in a text, or NaN if the text is not a number. */
export function parseNumber(text) {
  return text.trim() === "" ? NaN : Number(text);
}
