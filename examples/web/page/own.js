// The panel "Your own controller", and its worker. The code is in the blob that the worker starts
// with. So it has the page's content security policy: it needs no eval, and reaches no other site.

import { EXAMPLES } from "./examples.js";
import { watched } from "./loops.js";
import { minus } from "./plot.js";

/** After so long without an answer the worker is ended, ms. */
const LIMIT = 10_000;

const $ = (id) => document.getElementById(id);

/** The worker's script. The user's first line is its second one. */
const scriptOf = (code) => `const make = ({ ${NAMES} }) => {
${code}
;return typeof torque === "undefined" ? undefined : torque; };
const library = import("${new URL("own-worker.js", import.meta.url)}");
onmessage = ({ data }) => library.then(({ answer }) => answer(make, data));
`;
const NAMES = "$loop, UPRIGHT, params, energy, deviation, diagonal, linearize, regulator, plan, " +
  "planTorque";

/**
 * Calls `run` when the user wants the code to play, with whether it begins upright, `answered`
 * when a torque has come, `failed` with the reason for which there is none, and `chosen` with an
 * example.
 */
export function ownPanel({ run, answered, failed, chosen }) {
  let [worker, url, timer, code] = [null, "", 0, null];
  /** The last question, and the run in which it was asked. */
  let [id, asked, since] = [0, null, 0];
  let torque = null;

  const end = () => {
    clearTimeout(timer);
    worker?.terminate();
    URL.revokeObjectURL(url);
    worker = asked = torque = null;
    id++; // An answer that is on its way is obsolete.
  };
  const fail = (message, line) => {
    end();
    const text = code.split("\n")[line - 1]?.trim();
    const place = text === undefined ? "" : `Line ${line}, “${text}”: `;
    $("code-reason").textContent = minus(`${place}${message}.`);
    $("code").setAttribute("aria-invalid", "true");
    failed(`Your controller has stopped. ${$("code-reason").textContent}`);
  };
  const start = () => {
    $("code-reason").textContent = "";
    $("code").removeAttribute("aria-invalid");
    const script = new Blob([scriptOf(watched(code))], { type: "text/javascript" });
    url = URL.createObjectURL(script);
    worker = new Worker(url);
    worker.onmessage = ({ data }) => {
      if (data.id !== id) return;
      clearTimeout(timer);
      if (data.message !== undefined) return fail(data.message, data.line);
      torque = Number(data.torque);
      answered();
    };
    worker.onerror = (event) => {
      event.preventDefault();
      fail(event.message?.replace("Uncaught ", "") ?? "This is not JavaScript", event.lineno - 1);
    };
  };

  const own = {
    get code() {
      return code;
    },
    /** Shows the code of a link, which does not run. */
    show(text) {
      end();
      code = null;
      $("code").value = text;
      $("code-origin").hidden = false;
    },
    /** The torque at the game's state, N m, or null until the worker has answered. */
    torqueAt(game) {
      const { steps, levels } = game;
      if (asked?.steps === steps && asked.levels === levels) return torque;
      if (worker === null) start();
      // A new array of levels is a new run.
      const isNew = asked?.levels !== levels;
      if (isNew) since = steps;
      [asked, torque] = [{ steps, levels }, null];
      const { seen: state, acrobot: { params } } = game;
      const t = (steps - since) * params.dt;
      clearTimeout(timer);
      timer = setTimeout(fail, LIMIT, `there was no answer within ${LIMIT / 1000} s`);
      worker.postMessage({ id: ++id, params: isNew ? params : null, state, t });
      return null;
    },
  };

  $("example").append(...Object.keys(EXAMPLES).map((name) => new Option(name)));
  $("example").onchange = ({ target }) => {
    $("code").value = EXAMPLES[target.value].code;
    chosen(EXAMPLES[target.value]);
  };
  const take = (stands) => {
    end();
    code = $("code").value;
    $("code-origin").hidden = true;
    run(stands);
  };
  $("run").onclick = () => take(false);
  $("run-upright").onclick = () => take(true);
  $("code").onkeydown = (event) => event.key === "Enter" && event.ctrlKey && $("run").click();
  if ($("code").value === "") $("code").value = EXAMPLES["Swing up by energy"].code;
  return own;
}
