// Connects the page to an episode and to the panels.

import { Learner, bangBang, energyLaw, uprightEnergy } from "./acrobot-rs/policies.js";
import { Game } from "./game.js";
import { decodeRun, encodeRun } from "./link.js";
import { attempt, parametersPanel } from "./parameters.js";
import { color, minus, plot, rangeOf } from "./plot.js";
import { DEFAULTS, parseSeed } from "./settings.js";
import { drawStage } from "./stage.js";
import { trainingPanel } from "./training.js";

const $ = (id) => document.getElementById(id);

/** How long a policy's ended episode stays on the screen before the next begins, ms. */
const INTERVAL = 1500;

function start() {
  const [game, learner] = [new Game(42n, { ...DEFAULTS }), new Learner()];
  let learnt = learner;
  const POLICIES = {
    bang_bang: bangBang,
    energy_law: energyLaw,
    learnt: (acrobot) => learnt.act(acrobot),
    random: (acrobot) => acrobot.sample(),
  };
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const isTouch = matchMedia("(hover: none)").matches;
  const takeOver = `To take over, ${isTouch ? "touch a half of the picture" : "press ← or →"}.`;
  $("app").hidden = false;
  $("notice").hidden = true;

  let playing = !calm.matches;
  /** How much of the last step has been shown, s; dt before the first step. */
  let shown = game.params.dt;
  /** When the next episode begins; infinite if the user must begin it. */
  let nextAt = Infinity;
  /** The actions of a link. */
  let recorded = [];
  const held = { left: false, right: false };

  // ---- the episode

  const action = () => {
    const policy = $("policy").value;
    if (policy === "keys") return 1 + Number(held.right) - Number(held.left);
    if (policy === "link") return recorded[game.steps];
    return POLICIES[policy](game.acrobot);
  };

  const step = () => {
    try {
      const next = action();
      if (next === undefined) {
        return pause("The replay has ended. Press Restart, or an arrow and Play.");
      }
      game.step(next);
    } catch (error) {
      return pause(minus(error.message)); // With extreme physics an energy is infinite.
    }
    shown = 0;
    if (game.end === null) return;
    const result = `${game.end === "goal" ? "Goal" : "Out of time"} after ${game.steps} steps.`;
    const continues = playing && !["keys", "link"].includes($("policy").value);
    if (continues) nextAt = performance.now() + INTERVAL;
    say(`${result} ${continues ? "The next seed follows." : "Press Restart or Next seed."}`);
  };

  const begin = (seed, params = game.params) => {
    game.begin(seed, params);
    shown = params.dt;
    nextAt = Infinity;
    $("seed").value = seed;
    attempt($("seed"), $("seed-reason"), () => {});
    $("link-field").hidden = true;
    address();
    say(`Seed ${seed}.${playing ? ` ${player()}` : ""}`);
    changed();
  };
  /** Puts the run into the address, so that loading the page again begins it. */
  const address = (actions = $("policy").value === "link" ? recorded : []) =>
    history.replaceState(null, "", encodeRun({ ...game, actions }));

  const reset = () => {
    begin(game.seed);
    say(`Restarted from the initial state of seed ${game.seed}.`);
  };
  const next = () => begin(game.seed + 1n);

  const play = () => {
    playing = true;
    if (game.end !== null) reset();
    say(player());
    changed();
  };
  const pause = (message) => {
    playing = false;
    // The picture shows the last step, as the numbers do.
    shown = game.params.dt;
    nextAt = Infinity;
    say(message);
    changed();
  };
  const toggle = () => (playing ? pause("Paused.") : play());
  const single = () => {
    if (playing) pause("Paused.");
    if (game.end !== null) return say("The episode has ended. Press Restart or Next seed.");
    step();
    shown = game.params.dt;
    changed();
  };

  const say = (message) => ($("status").textContent = message);

  /** Who applies the torque, as a sentence. */
  const player = () => {
    const { value, selectedOptions: [{ textContent: policy }] } = $("policy");
    return { keys: "You play.", link: "The replay runs." }[value] ?? `${policy} plays. ${takeOver}`;
  };

  const choose = (policy) => {
    $("policy").value = policy;
    if (policy !== "keys" && game.end !== null) begin(game.seed);
    address();
    if (playing) say(player());
    else if (policy === "keys") say("You play. Press Play.");
    changed();
  };

  // ---- what the page shows

  const number = (value, digits = 2) => {
    if (!Number.isFinite(value)) return "too large";
    return minus(Math.abs(value) < 1e6 ? value.toFixed(digits) : value.toPrecision(4));
  };
  /** Draws a plot of columns, and a caption with their last values and `more` HTML. */
  const show = (id, title, names, unit, columns, options, more = "") => {
    const colors = [color("--accent"), color("--second")];
    const series = columns.map((values, i) => ({ values, color: colors[i] }));
    plot($(id), { series, end: Math.max(game.steps, 50), unit: "steps", ...options });
    const last = columns.map((column, i) => {
      const text = `${names[i]} ${number(column.at(-1))} ${unit}`;
      return `<span class="${["first", "second"][i]}">${text}</span>`;
    });
    $(`${id}-caption`).innerHTML = `<span>${title}</span>${last.join("")}${more}`;
  };

  const plots = () => {
    const columns = [0, 1, 2, 3, 4, 5].map((index) => game.column(index));
    const [energy, heights] = columns.slice(4);
    const [angles, velocities] = [columns.slice(0, 2), columns.slice(2, 4)];
    const standing = uprightEnergy(game.acrobot.params);
    const more = `<span class="hint">upright: ${number(standing)} J</span>
      <span>tip height ${number(heights.at(-1))} m</span>`;
    const range = rangeOf([...energy, standing, -standing]);
    const marks = [[standing, color("--muted")]];
    show("energy", "Energy", [""], "J", [energy], { range, marks }, more);
    const turn = { range: [-Math.PI, Math.PI], period: 2 * Math.PI };
    show("angles", "Angles", ["θ1", "θ2"], "rad", angles, turn);
    const fastest = 1.06 * Math.max(2, ...velocities.flat().map(Math.abs));
    const bounds = { range: [-fastest, fastest] };
    show("velocities", "Velocities", ["θ1′", "θ2′"], "rad/s", velocities, bounds);
  };

  let dirty = true;
  /** Requests an update of everything except the picture, which each frame draws. */
  const changed = () => (dirty = true);

  const update = () => {
    dirty = false;
    $("step").textContent = game.steps;
    $("return").textContent = minus(String(game.return));
    $("pause").textContent = playing ? "Pause" : "Play";
    const verdicts = { goal: `Goal! ${game.steps} steps`, limit: "Out of time" };
    $("verdict").textContent = verdicts[game.end] ?? "";
    const bits = new Uint32Array(game.numbers.buffer);
    const rows = ["θ1", "θ2", "θ1′", "θ2′"].map((name, i) => {
      const value = `${number(game.numbers[i], 4)} ${i < 2 ? "rad" : "rad/s"}`;
      const code = `<code>${bits[i].toString(16).padStart(8, "0")}</code>`;
      return `<tr><th scope="row">${name}</th><td>${value}</td><td>${code}</td></tr>`;
    });
    $("state").innerHTML = rows.join("");
    plots();
  };

  let last = performance.now();
  const frame = (now) => {
    requestAnimationFrame(frame);
    // A page in the background gets no frames. Afterwards it does not catch up.
    const elapsed = Math.min(Math.max(now - last, 0), 100) / 1000;
    last = now;
    const { dt } = game.params;
    if (playing && game.end === null) {
      shown += elapsed * Number($("pace").value);
      // The limit of steps ends this loop even if dt is tiny.
      while (shown >= dt && playing && game.end === null) {
        const over = shown - dt;
        step();
        shown = playing ? over : dt;
        changed();
      }
    } else {
      shown = Math.min(shown + elapsed * Number($("pace").value), dt);
    }
    if (now >= nextAt && playing) {
      const { hidden } = $("link-field");
      next();
      $("link-field").hidden = hidden;
    }
    drawStage(game, calm.matches ? 1 : Math.min(shown / dt, 1));
    if (dirty) update();
  };

  // ---- keys and buttons

  const hold = (side, on) => {
    held[side] = on;
    $(side).classList.toggle("held", on);
    if (on && $("policy").value !== "keys") choose("keys");
  };
  const keys = { " ": toggle, s: single, r: reset, n: next };
  const sides = { ArrowLeft: "left", ArrowRight: "right" };
  document.addEventListener("keydown", (event) => {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const field = target.closest("input, select");
    if (field) {
      const leaves = field.matches("select") ? key in sides : ["Enter", "Escape"].includes(key);
      if (leaves) field.blur();
      if (!(leaves && key in sides)) return;
    }
    // The space bar presses the focused button.
    if (key === " " && target.closest("button, summary, a")) return;
    if (key in sides) hold(sides[key], true);
    else if (!event.repeat && key.toLowerCase() in keys) keys[key.toLowerCase()]();
    else return;
    event.preventDefault();
  });
  document.addEventListener("keyup", ({ key }) => key in sides && hold(sides[key], false));
  // If the key is released in another window, this one gets no event.
  addEventListener("blur", () => ["left", "right"].forEach((side) => hold(side, false)));
  /** Holds the side that a pointer's event chooses while that pointer is down. */
  const holdBy = (element, sideOf) => {
    const pointers = new Map();
    element.addEventListener("pointerdown", (event) => {
      const side = sideOf(event);
      if (side === null) return;
      element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, side);
      hold(side, true);
    });
    element.addEventListener("lostpointercapture", ({ pointerId }) => {
      const side = pointers.get(pointerId);
      pointers.delete(pointerId);
      if (![...pointers.values()].includes(side)) hold(side, false);
    });
    element.addEventListener("contextmenu", (event) => event.preventDefault());
  };
  // A mouse's click only focuses the picture.
  holdBy($("stage"), ({ pointerType, offsetX }) => {
    if (pointerType === "mouse") return null;
    return offsetX < $("stage").clientWidth / 2 ? "left" : "right";
  });
  for (const side of ["left", "right"]) {
    const button = $(side);
    holdBy(button, () => side);
    for (const [type, on] of [["keydown", true], ["keyup", false]]) {
      button.addEventListener(type, ({ key }) => [" ", "Enter"].includes(key) && hold(side, on));
    }
    button.addEventListener("blur", () => hold(side, false));
  }
  const buttons = { pause: toggle, single, reset, next };
  for (const [id, act] of Object.entries(buttons)) $(id).onclick = act;
  $("policy").onchange = ({ target }) => choose(target.value);
  // After a click. Who uses the keyboard may go on with ↑ and ↓.
  const leaves = ({ target }) => target.matches("select:not(:focus-visible)") && target.blur();
  $("app").addEventListener("change", leaves);

  // ---- settings

  $("seed").value = game.seed;
  $("seed").oninput = ({ target }) => {
    const { value } = target;
    attempt(target, $("seed-reason"), () => begin(parseSeed(value)));
    target.value = value;
  };

  const showParams = parametersPanel(
    () => game.params,
    (params) => {
      begin(game.seed, params);
      const restarts = "The episode restarts, because the physics has changed.";
      say(playing ? `${restarts} ${player()}` : restarts);
    },
  );

  // ---- links, files, and the panels

  const open = (hash) => {
    if (hash.length <= 1) return;
    try {
      const run = decodeRun(hash);
      begin(run.seed, run.params);
      showParams();
      recorded = run.actions;
      const { length } = recorded;
      document.querySelector("[value=link]").disabled = length === 0;
      choose(length > 0 ? "link" : "bang_bang");
      if (length > 0) say(`Replay of a link: ${length} steps of seed ${run.seed}.`);
    } catch (error) {
      address();
      say(`The link is invalid: ${minus(error.message)}`);
      $("status").scrollIntoView({ block: "nearest" });
    }
  };
  addEventListener("hashchange", () => open(location.hash));
  $("share").onclick = async () => {
    address(game.actions);
    const { href } = location;
    $("link").value = href;
    $("link-field").hidden = false;
    $("link").select();
    const content = `seed, physics and ${game.steps} actions`;
    const shown = (text) => ($("link-field").firstElementChild.textContent = text);
    try {
      await navigator.clipboard.writeText(href);
      shown(`Copied: a link with ${content}`);
    } catch {
      shown(`The browser does not allow copying. Copy this link with ${content}`);
    }
  };

  const training = trainingPanel(learner, {
    ready(policy) {
      learnt = policy;
      const option = document.querySelector("[value=learnt]");
      option.disabled = false;
      option.textContent = "Learnt";
    },
    drive() {
      choose("learnt");
      begin(game.seed);
      if (!playing) play();
    },
  });

  for (const query of ["(prefers-color-scheme: dark)", "(prefers-reduced-motion: reduce)"]) {
    matchMedia(query).addEventListener("change", () => {
      training.draw();
      changed();
    });
  }
  new ResizeObserver(changed).observe($("energy"));

  const { hash } = location;
  showParams();
  choose("bang_bang");
  if (!playing) say(`Press Play to watch Bang-bang. ${takeOver}`);
  open(hash);
  requestAnimationFrame(frame);
}

try {
  start();
} catch (error) {
  $("app").hidden = true;
  $("notice").hidden = false;
  $("notice").textContent = `The page could not start: ${error.message}.`;
}
