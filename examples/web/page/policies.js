// Policies that need no training. Each returns the action for a game.

export const POLICIES = {
  random: () => Math.floor(3 * Math.random()),

  /** Torque against θ̇1. */
  bang_bang: ({ state }) => (state.dtheta1 > 0 ? 0 : 2),

  /**
   * The torque −(E↑ − E) θ̇1, rounded to an action. E↑ is the energy of standing upright. The torque
   * adds energy below E↑ and removes energy above it.
   */
  energy_law({ state, numbers, standing }) {
    const missing = standing - numbers[4];
    return 1 + Math.max(-1, Math.min(1, Math.round(-missing * state.dtheta1)));
  },
};
