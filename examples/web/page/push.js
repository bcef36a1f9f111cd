// A spring with a damper pulls a point of the acrobot. In a step it changes both velocities by
// M(θ)⁻¹ Jᵀ F dt, for the mass matrix M and the point's Jacobian J. The force F is that after the
// step, so that the spring is stable with any dt.

import { massMatrix } from "./acrobot-rs/control.js";
import { placeOf, placesOf } from "./places.js";

/** The spring, N/m, and its damper, N s/m. */
const [STIFFNESS, DAMPING] = [60, 8];

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
