// Files that the page makes.

const COLUMNS = "theta1_rad,theta2_rad,dtheta1_rad_per_s,dtheta2_rad_per_s,energy_J,tip_height_m";

/** The last minute of a game. A torque is the one that led to the state. */
export function csvOf(game) {
  let time = game.span[0] * game.params.dt;
  const lines = game.rows.map(({ numbers, params }, i) => {
    if (i > 0) time += params.dt;
    return `${[time.toFixed(6), ...numbers].join()}\n`;
  });
  return `time_s,${COLUMNS},torque_Nm\n${lines.join("")}`;
}

/** Saves the parts of a file under a name. */
export function download(name, parts, options) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(parts, options));
  link.download = name;
  link.click();
  // Later, because the browser may still be reading it.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
