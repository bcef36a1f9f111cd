// The panel "Train a policy": a worker, the learning curve, and files of weights.

import { Learner, Perceptron, bangBang } from "./acrobot-rs/policies.js";
import { download } from "./files.js";
import { FULL, Game } from "./game.js";
import { attempt } from "./parameters.js";
import { color, minus, plot, rangeOf } from "./plot.js";
import { DEFAULTS, isSame, parseNumber, parseSeed } from "./settings.js";

/** Gymnasium's threshold: a mean return of −100 over 100 episodes. */
const WINDOW = 100;
const THRESHOLD = -100;
/** The untrained policy's mean return. */
export const BASELINE = -84;
const EPISODES = 1_000_000;
/** The episodes of a comparison. */
const TRIES = 20n;

const $ = (id) => document.getElementById(id);

function parseEpisodes(text) {
  const episodes = parseNumber(text);
  if (Number.isInteger(episodes) && episodes >= 1 && episodes <= EPISODES) return episodes;
  throw new Error(`episodes must be an integer from 1 to ${EPISODES}, got ${JSON.stringify(text)}`);
}

/** The mean return of a policy with parameters. */
function meanReturn(policy, params) {
  let sum = 0;
  for (let seed = 0n; seed < TRIES; seed++) {
    const game = new Game(seed, params);
    while (game.end === null) game.step(FULL * (policy(game.acrobot) - 1));
    sum += game.return;
  }
  return sum / Number(TRIES);
}

/**
 * Calls `ready` with each learnt policy, `drive` when the user wants to watch it, and `say` with
 * the result of a training.
 */
export function trainingPanel({ ready, drive, game, say }) {
  const learner = new Learner();
  let worker = null;
  let weights = null;
  /** From the first whole window on. Means of fewer episodes would be a spike. */
  let means = [];
  /** The threshold, or null for another machine than Gymnasium's, and Bang-bang's mean return. */
  let lines = [THRESHOLD, BASELINE];

  const draw = () => {
    const [threshold, baseline] = lines;
    const range = rangeOf([...means, 2 * THRESHOLD, 0]);
    const series = [{ values: means, color: color("--accent") }];
    const end = WINDOW + Math.max(means.length - 1, WINDOW);
    const marks = [[baseline, color("--second")]];
    if (threshold !== null) marks.push([threshold, color("--muted")]);
    $("threshold").hidden = threshold === null;
    $("baseline").textContent = minus(String(Math.round(baseline)));
    plot($("curve"), { series, range, start: WINDOW, end, unit: "episodes", marks });
  };

  /** Loads weights or a perceptron for the learnt policy, or throws the reason. */
  const take = (bytes) => {
    const isPerceptron = String.fromCharCode(...bytes.subarray(0, 4)) === "MLP1";
    const policy = isPerceptron ? new Perceptron(bytes) : learner;
    if (!isPerceptron) learner.load(bytes);
    weights = bytes;
    $("save").disabled = $("drive").disabled = false;
    ready(({ acrobot }) => FULL * (policy.act(acrobot) - 1));
    return policy;
  };

  /** Shows how the learnt policy does on the machine that is set, and on Gymnasium's. */
  const compare = (policy) => {
    const [own, gymnasium] = [game.params, DEFAULTS].map((params) =>
      minus(meanReturn((acrobot) => policy.act(acrobot), params).toFixed(1)));
    const title = `Mean return of ${TRIES} episodes`;
    const text = `${title}: ${own} on the machine that is set, ${gymnasium} on Gymnasium's.`;
    $("elsewhere").textContent = text;
  };

  const stop = (message) => {
    worker?.terminate();
    worker = null;
    $("train").textContent = "Train";
    if (message) $("training-status").append(` · ${message}`);
    say(`Training: ${$("training-status").textContent}.`);
  };

  const train = () => {
    const read = (id, parse) => {
      let value = null;
      attempt($(id), $("training-reason"), () => (value = parse($(id).value)));
      return value;
    };
    const episodes = read("episodes", parseEpisodes);
    const seed = episodes && read("training-seed", parseSeed);
    if (seed === null) return;
    const { params } = game;
    if (params.friction !== 0) {
      const rule = "friction must be 0 N m s/rad to train";
      return ($("training-reason").textContent = `${rule}, got ${params.friction}`);
    }
    const isGymnasium = isSame(params, DEFAULTS);
    lines = isGymnasium ? [THRESHOLD, BASELINE] : [null, meanReturn(bangBang, params)];
    const returns = [];
    let sum = 0;
    means = [];
    worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    worker.onerror = ({ message }) => stop(`the training failed: ${message}`);
    worker.onmessage = ({ data }) => {
      for (const value of data.returns) {
        returns.push(value);
        sum += value - (returns[returns.length - 1 - WINDOW] ?? 0);
        if (returns.length >= WINDOW) means.push(sum / WINDOW);
      }
      take(data.weights);
      draw();
      const mean = sum / Math.min(returns.length, WINDOW);
      const passed = means.findIndex((mean) => mean >= THRESHOLD);
      const verdict = passed < 0 ? "below the threshold"
        : `above the threshold at episode ${passed + WINDOW}`;
      const text = [
        `${returns.length.toLocaleString("en")} of ${episodes.toLocaleString("en")} episodes`,
        `mean return ${minus(mean.toFixed(1))}`,
        ...(means.length === 0 ? [`the curve begins after ${WINDOW} episodes`] : []),
        ...(lines[0] === null ? [] : [verdict]),
      ].join(" · ");
      $("training-status").textContent = text;
      if (returns.length !== episodes) return;
      stop();
      compare(learner);
    };
    worker.postMessage({ seed, episodes, params: game.acrobot.params });
    $("train").textContent = "Stop";
    $("training-status").textContent = "Training…";
  };

  $("train").onclick = () => (worker ? stop("stopped") : train());
  $("drive").onclick = drive;
  $("save").onclick = () => download("weights.bin", [weights]);
  $("choose").onclick = () => $("load").click();
  $("load").onchange = async ({ target }) => {
    const [file] = target.files;
    // Otherwise choosing the same file again would cause no event.
    target.value = "";
    $("weights-reason").textContent = "";
    if (file === undefined) return;
    try {
      const bytes = new Uint8Array(await file.arrayBuffer());
      compare(take(bytes));
      $("training-status").textContent = `${file.name} is loaded.`;
      stop(); // The next report would replace these weights.
    } catch (error) {
      $("weights-reason").textContent = `${file.name}: ${error.message}`;
    }
  };
  new ResizeObserver(draw).observe($("curve"));
  return { draw };
}
