// Connects the panels to the episode. What a first visit does not need is loaded when its panel
// opens.

import { Learner } from "./acrobot-rs/policies.js";
import { animationOf } from "./animation.js";
import { csvOf, download } from "./files.js";
import { levelOf } from "./game.js";
import { attempt } from "./parameters.js";
import { parseSeed } from "./settings.js";
import { connectShare } from "./share.js";
import { trainingPanel } from "./training.js";

const $ = (id) => document.getElementById(id);

/** Nearly upright: without a torque it falls. */
const UPRIGHT = { theta1: Math.PI - 0.01, theta2: 0, dtheta1: 0, dtheta2: 0 };

/** Lets a policy be chosen, under its name. */
const enable = (policy, name) => {
  for (const option of document.querySelectorAll(`[value=${policy}]`)) {
    option.disabled = false;
    option.textContent = name;
  }
};

/** Connects the panels to the functions of main.js. */
export function connectPanels(app) {
  const { game, policies } = app;
  connectShare(app);
  $("scrub").oninput = ({ target }) => app.seek(Number(target.value));
  $("seed").value = game.seed;
  $("seed").oninput = ({ target }) => {
    const { value } = target;
    attempt(target, $("seed-reason"), () => app.begin(parseSeed(value)));
    target.value = value;
  };
  for (const option of $("policy").options) {
    if (!["keys", "link", "own"].includes(option.value)) $("rival").append(option.cloneNode(true));
  }
  $("rival").onchange = ({ target: { value } }) => {
    app.begin(game.seed);
    const name = $("rival").selectedOptions[0].textContent;
    if (value !== "") app.say(`${name} plays behind it, from the same seed, with the same pulls.`);
  };
  $("challenge").onclick = () => {
    app.scores.pull();
    app.play();
    app.say("Once it stands for 1 s, pulls begin, each one harder. How long does it hold?");
    app.changed();
  };
  $("csv").onclick = () => download("acrobot.csv", [csvOf(game)], { type: "text/csv" });
  $("animate").onclick = () =>
    download("acrobot.svg", [animationOf(game)], { type: "image/svg+xml" });

  const training = trainingPanel(new Learner(), {
    ...app,
    ready(policy) {
      policies.learnt = policy;
      enable("learnt", "Learnt");
    },
    drive() {
      app.choose("learnt");
      app.begin(game.seed);
      app.play();
    },
  });

  for (const query of ["(prefers-color-scheme: dark)", "(prefers-reduced-motion: reduce)"]) {
    matchMedia(query).addEventListener("change", () => {
      training.draw();
      app.changed();
    });
  }
  new ResizeObserver(app.changed).observe($("energy"));

  /** The user's controller, once its panel has been opened. */
  let own = null;
  const loadOwn = async () => {
    const { ownPanel } = await import("./own.js");
    own ??= ownPanel({
      run() {
        enable("own", "Your own controller");
        app.choose("own");
        app.play();
      },
      answered: app.answered,
      failed: app.stick,
      chosen: ({ strong }) => strong && app.strengthen(),
    });
    policies.own = (game) => levelOf(own.torqueAt(game), game.params.torque);
  };
  $("run-upright").onclick = () => {
    app.beginAt(UPRIGHT);
    $("run").click();
  };
  $("controller").ontoggle = () => $("controller").open && loadOwn();

  let regulator = null;
  const playRegulator = () => {
    app.choose("regulator");
    app.play();
  };
  const loadRegulator = async () => {
    const { regulatorPanel } = await import("./regulator.js");
    if (regulator !== null) return;
    const play = (state) => {
      app.beginAt(state);
      playRegulator();
    };
    regulator = regulatorPanel({ game, play, changed: app.changed });
    policies.regulator = regulator.act;
    enable("regulator", "Regulator");
  };
  $("regulate").onclick = () => regulator && playRegulator();
  $("regulate-upright").onclick = () => {
    app.beginAt(UPRIGHT);
    $("regulate").click();
  };
  $("regulator").ontoggle = () => $("regulator").open && loadRegulator();

  return {
    frame: (now) => $("regulator").open && regulator?.frame(now),
    /** The user's code, if it has run. */
    get code() {
      return own?.code ?? undefined;
    },
    /** Whether a policy knows the torque of the next step. The own controller answers later. */
    isReady: (policy) => policy !== "own" || own.torqueAt(game) !== null,
    /** Shows the controller of a link, which begins only with a click. */
    async show(code) {
      document.querySelector("[value=own]").disabled = true;
      $("controller").open = true;
      await loadOwn();
      own.show(code);
      app.say($("code-origin").textContent);
    },
  };
}
