// An animated SVG of the last steps, in real time. A ring around the tip shows a pull.

/** The least time between two of its frames, s. */
const FRAME = 0.04;

export function animationOf(game) {
  const { length1, length2, dt } = game.params;
  const [, rows] = game.window;
  const every = Math.max(1, Math.round(FRAME / dt));
  const isFrame = (_, i) => i % every === 0;
  const animate = (element, name, values) => {
    const seconds = (values.length * every * dt).toFixed(2);
    return `<${element} attributeName="${name}" dur="${seconds}s" repeatCount="indefinite"
values="${values.join(";")}"`;
  };
  const rotation = (index) => {
    let angle = 0;
    // In degrees, clockwise, and without jumps at half a turn.
    const degrees = rows.filter(isFrame).map(({ numbers }) => {
      const next = numbers[index];
      angle += Math.asin(Math.sin((next - angle) / 2)) * 2;
      return (-angle * 180 / Math.PI).toFixed(1);
    });
    return `${animate("animateTransform", "transform", degrees)} type="rotate"/>`;
  };
  const pulls = rows.filter(isFrame).map(({ push }) => Number(push !== null));
  const [first, second] = [length1, length2].map((x) => (2 * x) / (length1 + length2));
  const link = (length) =>
    `<path d="M0 0v${length}" stroke="#0cc" stroke-width=".2"/><circle r=".1" fill="#cc0"/>`;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="400" viewBox="-2.2 -2.2 4.4 4.4">
<path d="M-2.2-2.2h4.4v4.4h-4.4z" fill="#fff"/>
<path d="M-2.2-1h4.4" stroke="#000" stroke-width=".01"/>
<g>${rotation(0)}${link(first)}
<g transform="translate(0 ${first})"><g>${rotation(1)}${link(second)}
<circle cy="${second}" r=".25" fill="none" stroke="#b25a00" stroke-width=".06">
${animate("animate", "opacity", pulls)} calcMode="discrete"/></circle>
</g></g></g>
</svg>
`;
}
