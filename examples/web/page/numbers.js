// The numbers and plots beside the picture.

import { CHARTS, number } from "./charts.js";
import { isUpright } from "./game.js";
import { minus } from "./plot.js";
import { DEFAULTS, isSame } from "./settings.js";

const $ = (id) => document.getElementById(id);

/** The least time between two updates while it plays, ms. */
const PERIOD = 30;

/** The best known mean return, of docs/optimum.md. */
const BEST = -58.69;

/** The same text again would need another layout. */
const write = (id, text) => $(id).textContent !== text && ($(id).textContent = text);

const verdict = ({ steps, end }) =>
  ({ goal: `Goal! ${steps} steps`, limit: "Out of time" })[end] ?? "";

/** The number and the label of the score: of growing pulls, of standing, or of the game. */
function scoreOf(game, { pulls, best }) {
  if (pulls) {
    const toBeat = best.held === undefined ? "" : `, to beat: ${best.held.toFixed(1)} s`;
    return [`${pulls.held.toFixed(1)} s`, `Held, pull ${pulls.count}${toBeat}`];
  }
  if (game.free) return [`${game.upright.toFixed(1)} s`, "Upright for"];
  const toBeat = best.return === undefined ? `best known: ${BEST}` : `to beat: ${best.return}`;
  const label = isSame(game.params, DEFAULTS) ? `Return, ${toBeat}` : "Return";
  return [game.return, label].map((text) => minus(String(text)));
}

function showNumbers({ game, rival, playing, scores }) {
  const [score, scoreLabel] = scoreOf(game, scores);
  const name = $("rival").selectedOptions[0].textContent;
  const texts = {
    "step": String(game.steps),
    "return": score,
    "steps-label": game.free ? "Steps" : "Steps (at most 500)",
    "return-label": scoreLabel,
    "pause": playing ? "Pause" : "Play",
    "verdict": verdict(game),
    "rival-label": `Grey: ${name}`,
    "rival-steps": isUpright(rival.acrobot.state) ? "upright" : verdict(rival) || `${rival.steps}`,
  };
  for (const [id, text] of Object.entries(texts)) write(id, text);
  const holds = game.free && ["planner", "regulator", "own"].includes($("policy").value);
  $("balance").hidden = holds;
  $("challenge").hidden = !holds || scores.pulls !== null;
  $("rival-score").hidden = $("rival").value === "";
  const [first, last] = game.span;
  Object.assign($("scrub"), { min: first, max: last, value: game.steps });
  const ago = `${number((last - game.steps) * game.params.dt, 1)} s ago`;
  write("ago", last === game.steps ? "now" : ago);
  $("scrub").ariaValueText = $("ago").textContent;
}

function showBits({ numbers }) {
  const bits = new Uint32Array(numbers.buffer);
  const rows = ["θ1", "θ2", "θ1′", "θ2′"].map((name, i) => {
    const value = `${number(numbers[i], 4)} ${i < 2 ? "rad" : "rad/s"}`;
    const code = `<code>${bits[i].toString(16).padStart(8, "0")}</code>`;
    return `<tr><th scope="row">${name}</th><td>${value}</td><td>${code}</td></tr>`;
  });
  $("state").innerHTML = rows.join("");
}

/**
 * Shows numbers and plots of what `get` returns, after calls of its `changed`, in frames: plots
 * take longer than all else, so while it plays each frame draws one at most.
 */
export function numbersOf(get) {
  /** How many plots do not show the last change. */
  let stale = CHARTS.length;
  let [updated, turn] = [0, 0];
  const changed = () => (stale = CHARTS.length);
  $("bits").ontoggle = changed;
  const frame = (now) => {
    const shown = get();
    const { game, playing } = shown;
    if (stale === 0 || (playing && now - updated < PERIOD)) return;
    updated = now;
    const count = playing ? 1 : CHARTS.length;
    stale -= Math.min(count, stale);
    for (let i = 0; i < count; i++) CHARTS[turn++ % CHARTS.length](game);
    showNumbers(shown);
    if (!playing || $("bits").open) showBits(game);
  };
  return { changed, frame };
}
