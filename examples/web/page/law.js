// The law of a regulator, and the poles that it makes.

/** θ1 from upright, rad, for an angle between ±π. */
export const leanOf = (theta1) => theta1 - (theta1 < 0 ? -Math.PI : Math.PI);

/** The torque −K x for the deviation x from upright, N m. */
export const torqueBy = ([k1, k2, k3, k4], { theta1, theta2, dtheta1, dtheta2 }) =>
  -(k1 * leanOf(theta1) + k2 * theta2 + k3 * dtheta1 + k4 * dtheta2);

const times = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
const over = ([a, b], [c, d]) => {
  const square = c * c + d * d;
  return [(a * c + b * d) / square, (b * c - a * d) / square];
};

/** The eigenvalues of a matrix, [real, imaginary]: the roots of its characteristic polynomial. */
export function eigenvalues(matrix) {
  const size = matrix.length;
  // Faddeev and LeVerrier.
  const coefficients = [1];
  let power = matrix.map((row) => row.map(() => 0));
  for (let k = 1; k <= size; k++) {
    const last = coefficients[k - 1];
    const sum = power.map((row, i) => row.map((value, j) => value + (i === j ? last : 0)));
    power = matrix.map((row) => sum.map((_, j) =>
      row.reduce((total, value, n) => total + value * sum[n][j], 0)));
    coefficients.push(-power.reduce((trace, row, i) => trace + row[i], 0) / k);
  }
  // Durand and Kerner.
  const valueAt = (z) =>
    coefficients.reduce((sum, each) => {
      const [a, b] = times(sum, z);
      return [a + each, b];
    }, [0, 0]);
  const roots = matrix.map((_, i) => [Math.cos(1 + i * 2), Math.sin(1 + i * 2)]);
  for (let round = 0; round < 200; round++) {
    roots.forEach((root, i) => {
      const others = roots.filter((_, j) => j !== i);
      const apart = others.map(([a, b]) => [root[0] - a, root[1] - b]).reduce(times, [1, 0]);
      const step = over(valueAt(root), apart);
      roots[i] = [root[0] - step[0], root[1] - step[1]];
    });
  }
  return roots;
}
