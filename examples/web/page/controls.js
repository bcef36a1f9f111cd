// Keys, mouse and fingers: who holds a torque, and who pulls the acrobot.

import { nearest } from "./places.js";
import { placeAt } from "./stage.js";

/** Where keys pull the tip to, as seen from it, m. */
const PUSHES = {
  ArrowLeft: [-0.3, 0], ArrowRight: [0.3, 0], ArrowUp: [0, 0.3], ArrowDown: [0, -0.3],
};
const SIDES = { ArrowLeft: "left", ArrowRight: "right" };

const $ = (id) => document.getElementById(id);

/**
 * Calls a function of `keys` by its key, `hold` with a side and whether its torque is held, and
 * `grip` with what pulls, or null: a `point` of a link, and the target, as the place `at` in the
 * picture or as the `offset` from the point.
 */
export function connectControls({ keys, hold, grip, acrobot }) {
  let pushes = false;
  const push = (key) => {
    if (key === null && !pushes) return;
    pushes = key !== null;
    grip(key && { point: { link: 1, part: 1 }, offset: PUSHES[key] });
  };
  document.addEventListener("keydown", (event) => {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (target.id === "plane" && key in PUSHES) return;
    const field = target.closest("input, select, textarea");
    if (field) {
      const ends = field.matches("textarea") ? ["Escape"] : ["Enter", "Escape"];
      const leaves = field.matches("select") ? key in SIDES : ends.includes(key);
      if (leaves) field.blur();
      if (!(leaves && key in SIDES)) return;
    }
    // The space bar presses the focused button.
    if (key === " " && target.closest("button, summary, a")) return;
    if (event.shiftKey && key in PUSHES) push(key);
    else if (key in SIDES) hold(SIDES[key], true);
    else if (!event.repeat && key.toLowerCase() in keys) keys[key.toLowerCase()]();
    else return;
    event.preventDefault();
  });
  document.addEventListener("keyup", ({ key }) => {
    if (key in SIDES) hold(SIDES[key], false);
    if (key in PUSHES || key === "Shift") push(null);
  });
  // If the key is released in another window, this one gets no event.
  addEventListener("blur", () => {
    for (const side of ["left", "right"]) hold(side, false);
    push(null);
  });

  for (const side of ["left", "right"]) {
    const button = $(side);
    button.addEventListener("pointerdown", ({ pointerId }) => {
      button.setPointerCapture(pointerId);
      hold(side, true);
    });
    for (const type of ["lostpointercapture", "blur"]) {
      button.addEventListener(type, () => hold(side, false));
    }
    for (const [type, on] of [["keydown", true], ["keyup", false]]) {
      button.addEventListener(type, ({ key }) => [" ", "Enter"].includes(key) && hold(side, on));
    }
  }

  const stage = $("stage");
  const placeIn = ({ clientX, clientY }) => {
    const { left, top } = stage.getBoundingClientRect();
    return [clientX - left, clientY - top];
  };
  /** The pointer that pulls, and the point it pulls. */
  let pulling = null;
  let point;
  stage.addEventListener("pointerdown", (event) => {
    if (pulling !== null || event.button !== 0) return;
    const { state, params } = acrobot;
    point = nearest(state, params, placeAt(...placeIn(event), params));
    pulling = event.pointerId;
    stage.setPointerCapture(pulling);
    grip({ point, at: placeIn(event) });
  });
  stage.addEventListener("pointermove", (event) => {
    if (event.pointerId === pulling) grip({ point, at: placeIn(event) });
  });
  stage.addEventListener("lostpointercapture", ({ pointerId }) => {
    if (pointerId !== pulling) return;
    pulling = null;
    grip(null);
  });
  for (const id of ["stage", "left", "right"]) {
    $(id).addEventListener("contextmenu", (event) => event.preventDefault());
  }
}
