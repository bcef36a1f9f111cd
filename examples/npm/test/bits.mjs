/** The bits of a state, as `trace` returns them. */
export function bits({ state: { theta1, theta2, dtheta1, dtheta2 } }) {
  const words = new Uint32Array(Float32Array.of(theta1, theta2, dtheta1, dtheta2).buffer);
  return Array.from(words, (word) => word.toString(16).padStart(8, "0"));
}
