// Draws line plots at the display's resolution: over the steps of an episode, or over the episodes
// of a training.

const MARGIN = { left: 40, right: 8, top: 8, bottom: 22 };

/** The labelled angles, rad. */
const RIGHT_ANGLES = [[-Math.PI, "−π"], [-Math.PI / 2, "−π/2"], [0, "0"], [Math.PI / 2, "π/2"], [Math.PI, "π"]];

/** A text whose negative numbers have the minus sign. */
export const minus = (text) => text.replace(/-(?=[\dI])/g, "−");

/** A colour of the style sheet, by the name of its custom property. */
export function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/**
 * Draws `series`, each with `values` and a `color`. The first value is at x = `start`. Each of
 * `marks` is a value, drawn as a dashed horizontal line, and `unit` is that of x. If there is a
 * `period`, as of an angle, a line leaves the plot at one edge and returns at the other.
 */
export function plot(canvas, { series, range, start = 0, end, unit, marks = [], period = Infinity }) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const scale = devicePixelRatio;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const context = canvas.getContext("2d");
  context.scale(scale, scale);

  const [low, high] = range;
  const x = (value) => MARGIN.left + ((value - start) / Math.max(end - start, 1)) * (width - MARGIN.left - MARGIN.right);
  const y = (value) => MARGIN.top + ((high - value) / (high - low)) * (height - MARGIN.top - MARGIN.bottom);
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
  for (const [tick, text] of period === Infinity ? ticks(low, high, 4).map((tick) => [tick, label(tick)]) : RIGHT_ANGLES) {
    context.fillText(text, MARGIN.left - 6, y(tick));
    line([[MARGIN.left, y(tick)], [width - MARGIN.right, y(tick)]], color("--grid"));
  }
  context.textBaseline = "alphabetic";
  context.textAlign = "center";
  // The last label has the unit. Fewer labels fit on a narrow screen.
  ticks(start, end, Math.min(Math.floor(width / 110), 5)).forEach((tick, i, { length }) => {
    const text = i + 1 < length ? label(tick) : `${label(tick)} ${unit}`;
    context.fillText(text, Math.min(x(tick), width - context.measureText(text).width / 2), height - 4);
  });
  for (const mark of marks) line([[MARGIN.left, y(mark)], [width - MARGIN.right, y(mark)]], color("--muted"), [4, 4]);

  context.beginPath();
  context.rect(MARGIN.left, MARGIN.top - 1, width - MARGIN.left, height - MARGIN.top - MARGIN.bottom + 2);
  context.clip();
  context.lineWidth = 1.5;
  context.lineJoin = "round";
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
}

/** At most about `count` round numbers from `low` to `high`, at equal distances. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((digit) => digit * power >= raw) * power;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

const label = (value) => minus(String(Number(value.toPrecision(3))));

/** The range of some values, made a little wider, so that it is never empty. */
export function rangeOf(values) {
  // Not `Math.min(...values)`: a call takes about 100,000 arguments, and a training can have a
  // million episodes.
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const room = (high - low || 1) * 0.06;
  return [low - room, high + room];
}
