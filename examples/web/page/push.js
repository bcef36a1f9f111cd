// A spring with a damper pulls a point of the acrobot. In a step it changes both velocities by
// M(θ)⁻¹ Jᵀ F dt, for the mass matrix M and the point's Jacobian J. The force F is that after the
// step, so that the spring is stable with any dt.

/** The spring, N/m, and its damper, N s/m. */
const [STIFFNESS, DAMPING] = [60, 8];

/** The elbow and the tip, m, as seen from the fixed joint. */
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

/** Where a point of a link is, m. */
export function placeOf({ link, part }, state, params) {
  const [elbow, tip] = placesOf(state, params);
  const [from, to] = link === 0 ? [[0, 0], elbow] : [elbow, tip];
  return from.map((x, i) => x + part * (to[i] - x));
}

/** The change of both velocities, rad/s, by a spring from a point to a target, both in m. */
export function pull(point, target, state, params) {
  const [elbow] = placesOf(state, params);
  const place = placeOf(point, state, params);
  // The point's velocity is J θ̇. A turn moves a place at [x, y] from its joint by [−y, x].
  const second = point.link === 0 ? [0, 0] : [elbow[1] - place[1], place[0] - elbow[0]];
  const columns = [[-place[1], place[0]], second];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const { dtheta1, dtheta2 } = state;
  const velocity = [0, 1].map((i) => columns[0][i] * dtheta1 + columns[1][i] * dtheta2);
  const { dt } = params;
  const force = [0, 1].map((i) => {
    const stretched = target[i] - place[i] - dt * velocity[i];
    return STIFFNESS * stretched - DAMPING * velocity[i];
  });
  const resistance = dt * (DAMPING + dt * STIFFNESS);
  const [[a, b], [, d]] = massMatrix(state, params).map((row, i) =>
    row.map((inertia, j) => inertia + resistance * dot(columns[i], columns[j])),
  );
  const [impulse1, impulse2] = columns.map((column) => dt * dot(column, force));
  const determinant = a * d - b * b;
  return [(d * impulse1 - b * impulse2) / determinant, (a * impulse2 - b * impulse1) / determinant];
}

function massMatrix({ theta2 }, params) {
  const { mass1, mass2, length1, centerOfMass1, centerOfMass2, inertia1, inertia2 } = params;
  const second = mass2 * centerOfMass2 ** 2 + inertia2;
  const both = second + mass2 * length1 * centerOfMass2 * Math.cos(theta2);
  const first = mass1 * centerOfMass1 ** 2 + inertia1 + mass2 * length1 ** 2;
  return [[first - second + 2 * both, both], [both, second]];
}
