// Connects the panels to the episode. What a first visit does not need is loaded when its panel
// opens.

import { csvOf, download } from "./files.js";
import { levelOf } from "./game.js";
import { attempt } from "./parameters.js";
import { parseSeed } from "./settings.js";
import { connectShare } from "./share.js";

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
  $("animate").onclick = async () => {
    const { animationOf } = await import("./animation.js");
    download("acrobot.svg", [animationOf(game)], { type: "image/svg+xml" });
  };

  /** What panels have made, by their ids, which are names of modules. */
  const made = {};
  const onOpen = (id, make) => {
    const load = async () => {
      try {
        const module = await import(`./${id}.js`);
        made[id] ??= make(module);
      } catch ({ message }) {
        app.say(`The panel could not be loaded: ${message}.`);
      }
    };
    $(id).ontoggle = () => $(id).open && load();
    return load;
  };

  onOpen("training", ({ trainingPanel }) => trainingPanel({
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
  }));
  for (const query of ["(prefers-color-scheme: dark)", "(prefers-reduced-motion: reduce)"]) {
    matchMedia(query).addEventListener("change", () => {
      made.training?.draw();
      app.changed();
    });
  }
  new ResizeObserver(app.changed).observe($("energy"));

  /** Lets a policy play, from a state if there is one. */
  const starts = (policy, state) => {
    if (state) app.beginAt(state);
    app.choose(policy);
    app.play();
  };

  policies.own = (game) => levelOf(made.own.torqueAt(game), game.params.torque);
  const loadOwn = onOpen("own", ({ ownPanel }) => ownPanel({
    run(stands) {
      enable("own", "Your own controller");
      starts("own", stands && UPRIGHT);
    },
    answered: app.answered,
    failed: app.stick,
    chosen: ({ strong }) => strong && app.strengthen(),
  }));

  policies.regulator = (game) => made.regulator.act(game);
  onOpen("regulator", ({ regulatorPanel }) => {
    const play = (state) => starts("regulator", state);
    $("regulate").onclick = () => play();
    $("regulate-upright").onclick = () => play(UPRIGHT);
    enable("regulator", "Regulator");
    return regulatorPanel({ game, play, changed: app.changed });
  });

  return {
    frame: (now) => $("regulator").open && made.regulator?.frame(now),
    /** The user's code, if it has run. */
    get code() {
      return made.own?.code ?? undefined;
    },
    /** Whether a policy knows the torque of the next step. The own controller answers later. */
    isReady: (policy) => policy !== "own" || made.own.torqueAt(game) !== null,
    /** Shows the controller of a link, which begins only with a click. */
    async show(code) {
      document.querySelector("[value=own]").disabled = true;
      $("own").open = true;
      await loadOwn();
      made.own.show(code);
      app.say($("code-origin").textContent);
    },
  };
}
