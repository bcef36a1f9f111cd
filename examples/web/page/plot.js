// Draws line plots at the display's resolution, over steps or episodes.

const MARGIN = { left: 40, right: 8, top: 8, bottom: 22 };

/** The labelled angles, rad. */
const RIGHT_ANGLES = ["−π", "−π/2", "0", "π/2", "π"].map((t, i) => [(i / 2 - 1) * Math.PI, t]);

/** A text whose negative numbers have the minus sign. */
export const minus = (text) => text.replace(/-(?=[\dI])/g, "−");

const colors = new Map();

/** A colour of the style, which takes long to find. */
export function color(name) {
  if (!colors.has(name)) {
    colors.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  }
  return colors.get(name);
}

const scheme = globalThis.matchMedia?.("(prefers-color-scheme: dark)");
scheme?.addEventListener("change", () => colors.clear());

/**
 * Clears a canvas, and draws axes from `start` to `end`, with a `unit` at the last label, and over
 * a range, with `labels` or else numbers. Returns its context, which draws only between them until
 * it is restored, what places values, and `line`, which draws one through places.
 */
export function axes(canvas, [start, end], unit, [low, high], labels) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const scale = devicePixelRatio;
  const size = [width, height].map((side) => Math.round(side * scale));
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const context = canvas.getContext("2d");
  context.save();
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);

  const { left, top } = MARGIN;
  const right = width - MARGIN.right;
  const inner = height - top - MARGIN.bottom;
  const x = (value) => left + ((value - start) / (end - start)) * (right - left);
  const y = (value) => top + ((high - value) / (high - low)) * inner;
  const line = (points, style, dashes = []) => {
    context.strokeStyle = style;
    context.setLineDash(dashes);
    context.beginPath();
    points.forEach(([x, y, apart]) => (apart ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
  };

  context.font = `11px ${getComputedStyle(canvas).fontFamily}`;
  context.fillStyle = color("--muted");
  context.textBaseline = "middle";
  context.textAlign = "right";
  const numbers = ticks(low, high, 4).map((tick) => [tick, label(tick)]);
  for (const [tick, text] of labels ?? numbers) {
    context.fillText(text, left - 6, y(tick));
    line([[left, y(tick)], [right, y(tick)]], color("--grid"));
  }
  context.textBaseline = "alphabetic";
  context.textAlign = "center";
  // The last label has the unit. Fewer labels fit on a narrow screen.
  ticks(start, end, Math.min(Math.floor(width / 110), 5)).forEach((tick, i, { length }) => {
    const text = i + 1 < length ? label(tick) : `${label(tick)} ${unit}`;
    const last = width - context.measureText(text).width / 2;
    context.fillText(text, Math.min(x(tick), last), height - 4);
  });
  context.beginPath();
  context.rect(left, top - 1, width - left, inner + 2);
  context.clip();
  context.lineJoin = "round";
  return { context, x, y, line };
}

/** The parts of both axes, from −1 to 1, at a place in a canvas. */
export function valuesAt({ clientWidth, clientHeight }, x, y) {
  const { left, right, top, bottom } = MARGIN;
  const across = (x - left) / (clientWidth - left - right);
  return [2 * across - 1, 1 - (2 * (y - top)) / (clientHeight - top - bottom)];
}

/**
 * Draws `series`, each with `values` and a `color`. The first value is at x = `start`. Each of
 * `marks` is a value and the color of its dashed horizontal line, `cursor` is the x of a vertical
 * one, if given, and `unit` is that of x. If there is a `period`, as of an angle, a line
 * leaves the plot at one edge and returns at the other.
 */
export function plot(canvas, options) {
  const { series, range, start = 0, end, unit, marks = [], cursor, period = Infinity } = options;
  const labels = period === Infinity ? undefined : RIGHT_ANGLES;
  const { context, x, y, line } = axes(canvas, [start, end], unit, range, labels);
  const across = [start, end].map(x);
  for (const [mark, color] of marks) line(across.map((at) => [at, y(mark)]), color, [4, 4]);
  if (cursor !== undefined) line(range.map((value) => [x(cursor), y(value)]), color("--text"));
  context.lineWidth = 1.5;
  for (const { values, color } of series) {
    const points = values.flatMap((value, i) => {
      const point = [x(start + i), y(value)];
      const before = values[i - 1];
      if (!(Math.abs(value - before) > period / 2)) return [point];
      const turn = Math.sign(value - before) * period;
      return [[point[0], y(value - turn)], [x(start + i - 1), y(before + turn), true], point];
    });
    line(points, color);
  }
  context.restore();
}

/**
 * At most about `count` round numbers from `low` to `high`, at equal distances. Without 2.5, a
 * range from −4.9 to 4.9 would have only 0.
 */
export function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].find((digit) => digit * power >= raw) * power;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

const label = (value) => minus(String(Number(value.toPrecision(3))));

/** The range of some values, made a little wider, so that it is never empty. */
export function rangeOf(values) {
  // Not `Math.min(...values)`: a call takes 100,000 arguments, a training a million episodes.
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const room = (high - low || 1) * 0.06;
  return [low - room, high + room];
}
