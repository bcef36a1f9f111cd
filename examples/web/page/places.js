// Places of the acrobot, m, as seen from the fixed joint: x to the right, y up.

/** The elbow and the tip. */
export function placesOf({ theta1, theta2 }, { length1, length2 }) {
  const both = theta1 + theta2;
  const elbow = [length1 * Math.sin(theta1), -length1 * Math.cos(theta1)];
  return [elbow, [elbow[0] + length2 * Math.sin(both), elbow[1] - length2 * Math.cos(both)]];
}

/** The point of the links that is closest to a place: its `link`, and the `part` of its length. */
export function nearest(state, params, [x, y]) {
  const [elbow, tip] = placesOf(state, params);
  const points = [[[0, 0], elbow], [elbow, tip]].map(([from, to], link) => {
    const [along, across] = [to[0] - from[0], to[1] - from[1]];
    const scalar = (x - from[0]) * along + (y - from[1]) * across;
    const part = Math.max(0, Math.min(1, scalar / (along ** 2 + across ** 2)));
    const distance = Math.hypot(x - from[0] - part * along, y - from[1] - part * across);
    return { link, part, distance };
  });
  return points[0].distance < points[1].distance ? points[0] : points[1];
}

/** Where a point of a link is. */
export function placeOf({ link, part }, state, params) {
  const [elbow, tip] = placesOf(state, params);
  const [from, to] = link === 0 ? [[0, 0], elbow] : [elbow, tip];
  return from.map((x, i) => x + part * (to[i] - x));
}
