// Connects the page to an episode and to the panels.

import { bangBang, energyLaw } from "./acrobot-rs/policies.js";
import { Scores } from "./challenge.js";
import { connectControls } from "./controls.js";
import { FULL, Game, UNITS } from "./game.js";
import { actionsOf, decodeRun, encodeRun } from "./link.js";
import { numbersOf } from "./numbers.js";
import { connectPanels } from "./panels.js";
import { attempt, parametersPanel } from "./parameters.js";
import { placesOf } from "./places.js";
import { minus } from "./plot.js";
import { BALANCE, DEFAULTS, LIMIT, isSame, machineOf } from "./settings.js";
import { drawRival, drawStage, placeAt } from "./stage.js";

const $ = (id) => document.getElementById(id);

/** How long a policy's ended episode stays on the screen before the next begins, ms. */
const INTERVAL = 1500;

function start() {
  const game = new Game(42n, { ...DEFAULTS });
  /** The acrobot to compare with. */
  const rival = new Game(42n, { ...DEFAULTS });
  /** The module of the planner and of pulls, once it has been loaded, and each game's planner. */
  let control = null;
  const planners = new Map();
  const held = { left: false, right: false };
  /** What pulls: a `point` of a link, and where to, in the picture or as seen from the point. */
  let grip = null;
  /** What pulls now: the user, or growing pulls. */
  const pulling = () => scores.grip ?? grip;
  const full = (act) => ({ acrobot }) => FULL * (act(acrobot) - 1);
  /** The motor's level by each policy, for a game. */
  const policies = {
    keys: () => FULL * (Number(held.right) - Number(held.left)),
    bang_bang: full(bangBang),
    energy_law: full(energyLaw),
    random: full((acrobot) => acrobot.sample()),
    planner: (game) => planners.get(game)?.act(game, pulling() !== null) ?? 0,
  };
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const isTouch = matchMedia("(hover: none)").matches;
  const takeOver = `To take over, press ${isTouch ? "◀ or ▶" : "← or →"}.`;
  $("first").remove();

  let playing = !calm.matches;
  /** How much of the last step has been shown, s; dt before the first step. */
  let shown = game.params.dt;
  /** When the next episode begins; infinite if the user must begin it. */
  let nextAt = Infinity;
  /** The run of a link. */
  let recorded = null;
  const scores = new Scores();
  /** The steps before the user took over. */
  let before = 0;
  /** Whether it is paused because who plays cannot play with these parameters. */
  let stuck = false;

  // ---- the episode

  /** Where the grip pulls to, m. */
  const target = () => {
    const { at, offset } = pulling();
    if (at) return placeAt(...at, game.params);
    return placesOf(game.acrobot.state, game.params)[1].map((x, i) => x + offset[i]);
  };
  const push = () => {
    if (pulling() === null || control === null) return null;
    const { state, params } = game.acrobot;
    const change = control.pull(pulling().point, target(), state, params);
    const units = change.map((x) => Math.round(UNITS * x) || 0);
    return units.some((unit) => unit !== 0) ? units : null;
  };

  const step = () => {
    scores.aim(game);
    try {
      const index = game.steps;
      const policy = $("policy").value;
      const replays = policy === "link";
      if (replays && index === recorded.levels.length) {
        if (recorded.policy) return choose(recorded.policy);
        return pause("The replay has ended. Press Restart, or an arrow and Play.");
      }
      const pushed = replays ? recorded.pushes[index] : push();
      if (replays) game.step(recorded.levels[index], pushed);
      else game.send(policies[policy](game), pushed);
      const other = $("rival").value;
      if (other !== "") rival.send(policies[other](rival), pushed);
    } catch (error) {
      return stick(minus(error.message)); // With extreme physics an energy is infinite.
    }
    shown = 0;
    const fallen = scores.step(game);
    if (fallen !== null) say(fallen);
    if (game.end === null) return;
    const own = before > 0 ? `, ${game.steps - before} of them yours` : "";
    const end = game.end === "goal" ? "Goal" : "Out of time";
    const result = `${end} after ${game.steps} steps${own}.`;
    const continues = playing && !["keys", "link"].includes($("policy").value);
    if (continues) nextAt = performance.now() + INTERVAL;
    say(`${result} ${continues ? "The next seed follows." : "Press Restart or Next seed."}`);
  };

  /** Whether who plays goes on at the goal. An own controller plays Gymnasium's game, too. */
  const isFree = (params = game.params) =>
    ["planner", "regulator"].includes($("policy").value) ||
    ($("policy").value === "own" && !isSame(params, DEFAULTS));

  /** Begins an episode, or a link's run from the state where it begins. */
  const begin = (seed, params = game.params, run = replayed()) => {
    game.begin(seed, params, run?.start);
    game.free = isFree(params) || (run !== null && actionsOf(run) === null);
    rival.begin(seed, params, run?.start);
    rival.free = ["planner", "regulator"].includes($("rival").value);
    before = 0;
    scores.begin();
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
  const address = (run = replayed() ?? { start: null, levels: [], pushes: [] }) => {
    const { seed, params } = game;
    const policy = run === recorded ? recorded.policy : $("policy").value;
    const controller = policy === "own" ? panels.code : undefined;
    const more = { seed, params, policy, controller, scores: scores.all };
    history.replaceState(null, "", encodeRun({ ...run, ...more }));
  };
  const replayed = () => ($("policy").value === "link" ? recorded : null);

  /** Changes the parameters at once, except where another episode must begin. */
  const setPhysics = (params) => {
    if (game.steps === 0 || game.end !== null || replayed()) begin(game.seed, params);
    else {
      for (const each of [game, rival]) each.change(params);
      if (isFree()) game.release();
      shown = params.dt;
      changed();
    }
    scores.change();
    address();
    if (stuck) play();
  };

  const reset = () => {
    begin(game.seed);
    say(`Restarted from the initial state of seed ${game.seed}.`);
  };
  const next = () => begin(game.seed + 1n);

  /** Both games go on from what is shown. */
  const goOn = () => [game, rival].forEach((each) => each.cut());
  const play = () => {
    if (playing) return;
    goOn();
    [playing, stuck] = [true, false];
    if (game.end !== null) reset();
    say(player());
    changed();
  };
  const pause = (message) => {
    playing = stuck = false;
    // The picture shows the last step, as the numbers do.
    shown = game.params.dt;
    nextAt = Infinity;
    say(message);
    changed();
  };
  /** Pauses until the parameters change. */
  const stick = (message) => {
    pause(message);
    stuck = true;
  };
  const toggle = () => (playing ? pause("Paused.") : play());
  /** Whether the button for one step waits for it. */
  let waits = false;
  const single = () => {
    if (playing) pause("Paused.");
    if (game.end !== null) return say("The episode has ended. Press Restart or Next seed.");
    goOn();
    waits = !panels.isReady($("policy").value);
    if (waits) return;
    step();
    shown = game.params.dt;
    changed();
  };

  /** What the page says, and what the planner adds. */
  let [said, thought] = ["", ""];
  const say = (message, more = thought) => {
    [said, thought] = [message, more];
    $("status").textContent = `${message} ${more}`.trim();
  };

  /** Who applies the torque, as a sentence. */
  const player = () => {
    const { value, selectedOptions: [{ textContent: policy }] } = $("policy");
    if (value === "planner") {
      const { torque, dt } = game.params;
      return `Planner plays with ${torque} N m, every ${dt} s. Pull the acrobot.`;
    }
    const own = before > 0 ? " on. For an episode of your own, press Restart" : "";
    const others = { keys: `You play${own}.`, link: "The replay runs." };
    return others[value] ?? `${policy} plays. ${takeOver}`;
  };

  const choose = (policy) => {
    const takesOver = policy === "keys" && $("policy").value !== "keys";
    before = takesOver ? game.steps : 0;
    $("policy").value = policy;
    if (isFree()) {
      game.release();
      nextAt = Infinity;
    } else if (policy === "link") begin(recorded.seed, recorded.params);
    else if (policy !== "keys" && game.end !== null) begin(game.seed);
    $("policy-hint").textContent = $("policy").selectedOptions[0].dataset.hint;
    showParams();
    address();
    if (playing) say(player());
    else if (policy === "keys") say("You play. Press Play.");
    changed();
  };

  // ---- what the page shows

  const { changed, frame: showNumbers } = numbersOf(() => ({ game, rival, playing, scores }));

  /** Takes the steps that are due. */
  const advance = () => {
    // With a tiny dt a frame shows fewer steps than it should.
    for (let i = 0; playing && game.end === null && shown >= game.params.dt && i < LIMIT; i++) {
      if (!panels.isReady($("policy").value)) return;
      const over = i + 1 < LIMIT ? shown - game.params.dt : 0;
      step();
      shown = playing ? over : game.params.dt;
      changed();
    }
  };

  let last = performance.now();
  const frame = (now) => {
    requestAnimationFrame(frame);
    // A page in the background gets no frames. Afterwards it does not catch up.
    const elapsed = Math.min(Math.max(now - last, 0), 100) / 1000;
    last = now;
    const { dt } = game.params;
    const more = elapsed * Number($("pace").value);
    if (playing && game.end === null) {
      // Not more than a picture's worth, if the own controller has not answered.
      shown = Math.min(shown, dt) + more;
      advance();
    } else shown = Math.min(shown + more, dt);
    if (now >= nextAt && playing) {
      const { hidden } = $("link-field");
      next();
      $("link-field").hidden = hidden;
    }
    const planner = $("policy").value === "planner" && planners.get(game);
    const pulled = pulling() && { point: pulling().point, target: target() };
    const part = calm.matches ? 1 : Math.min(shown / dt, 1);
    const path = game.steps === game.span[1] && planner?.path;
    const ghost = $("imperfect").open ? game.instruments?.ghostOf(game) : null;
    drawStage(game, part, path || [], pulled, ghost);
    drawRival($("rival").value === "" ? null : rival, part);
    // Last, because the size of a canvas is only known after the layout.
    showNumbers(now);
    panels.frame(now);
    const thinks = planner?.thinks ? "Planning…" : planner?.message ?? "";
    if (thinks !== thought) say(said, thinks);
  };

  // ---- keys and buttons

  const hold = (side, on) => {
    held[side] = on;
    $(side).classList.toggle("held", on);
    if (on && $("policy").value !== "keys") choose("keys");
  };
  connectControls({
    keys: { " ": toggle, s: single, r: reset, n: next },
    hold,
    grip(pulled) {
      grip = pulled;
      scores.begin();
      // A replay has its own pushes.
      if (grip !== null && $("policy").value === "link") choose("keys");
    },
    acrobot: game.acrobot,
  });
  const buttons = { pause: toggle, single, reset, next };
  for (const [id, act] of Object.entries(buttons)) $(id).onclick = act;
  /** With Gymnasium's 1 N m a swing-up takes at least 10 s, and a touch is enough for a fall. */
  const strengthen = () => {
    if (machineOf(game.params) !== "Gymnasium") return;
    setPhysics({ ...game.params, ...BALANCE });
    showParams();
    say(`The machine is now ${machineOf(game.params)}. ${playing ? player() : ""}`);
  };
  const select = (policy) => {
    choose(policy);
    if (policy === "planner") strengthen();
  };
  $("policy").onchange = ({ target }) => select(target.value);
  $("balance").onclick = () => {
    select("planner");
    play();
  };
  // After a click. Who uses the keyboard may go on with ↑ and ↓.
  const left = ":is(select, [type=checkbox]):not(:focus-visible)";
  const leaves = ({ target }) => target.matches(left) && target.blur();
  $("app").addEventListener("change", leaves);

  // ---- settings

  const showParams = parametersPanel(
    () => game.params,
    (params) => {
      setPhysics(params);
      say(`The machine has changed. ${playing ? player() : ""}`.trim());
    },
  );

  // ---- links, files, and the panels

  const panels = connectPanels({
    game, rival, policies, scores, changed, begin, choose, play, stick, say, address,
    strengthen,
    /** Shows the state after one of the last steps. */
    seek(step) {
      if (playing) pause("Paused. Play goes on from what is shown.");
      for (const each of [game, rival]) each.seek(step);
      scores.begin();
      showParams();
      shown = game.params.dt;
      changed();
    },
    answered: () => (waits ? single() : advance()),
    beginAt(start) {
      begin(game.seed, game.params, { start, levels: [], pushes: [] });
      game.release();
      if (!playing) say("Press Play.");
    },
  });

  const open = (hash) => {
    if (hash.length <= 1) return;
    try {
      const run = decodeRun(hash);
      scores.best = { ...run.scores };
      begin(run.seed, run.params, run);
      recorded = run;
      const { length } = run.levels;
      document.querySelector("[value=link]").disabled = length === 0;
      const { controller } = run;
      choose(length > 0 ? "link" : run.policy ?? (controller ? "keys" : "bang_bang"));
      if (length > 0) say(`Replay of a link: ${length} steps of seed ${run.seed}.`);
      if (controller === undefined) return;
      if (length === 0) pause("");
      panels.show(controller);
    } catch (error) {
      address();
      say(`The link is invalid: ${minus(error.message)}`);
      $("status").scrollIntoView({ block: "nearest" });
    }
  };
  addEventListener("hashchange", () => open(location.hash));

  const { hash } = location;
  showParams();
  choose("bang_bang");
  if (!playing) say(`Press Play to watch Bang-bang. ${takeOver}`);
  open(hash);
  requestAnimationFrame(frame);

  // The page begins without it, because it is large.
  import("./planner.js").then((module) => {
    control = module;
    for (const each of [game, rival]) {
      planners.set(each, new control.PlannerPolicy());
      each.instruments = new control.Instruments();
    }
    $("balance").disabled = false;
  }, ({ message }) => say(`The planner could not be loaded: ${message}.`));
}

try {
  start();
} catch (error) {
  $("status").role = "alert";
  $("status").textContent = `The page could not start: ${error.message}.`;
}
