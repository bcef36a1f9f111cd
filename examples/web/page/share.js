// The button "Copy link to this run".

import { actionsOf } from "./link.js";

const $ = (id) => document.getElementById(id);

/** Copies the page's address. `address` writes the run of `game` into it. */
export function connectShare({ game, address, say }) {
  $("share").onclick = async () => {
    address(game);
    const { href } = location;
    $("link").value = href;
    $("link-field").hidden = false;
    $("link").select();
    const inputs = actionsOf(game) === null ? "torques" : "actions";
    const content = `seed, physics and ${game.levels.length} ${inputs}`;
    const shown = (text) => {
      $("link-field").firstElementChild.textContent = text;
      say(`${text}.`);
    };
    try {
      await navigator.clipboard.writeText(href);
      shown(`Copied: a link with ${content}`);
    } catch {
      shown(`The browser does not allow copying. Copy this link with ${content}`);
    }
  };
}
