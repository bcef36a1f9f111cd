// The panels of the machine and its faults: a choice of equations, and a slider and a field for
// each parameter. The field shows why a value is rejected.

import { minus } from "./plot.js";
import { FAULTY, IDEAL, MACHINES, PARAMETERS, machineOf, parseNumber, textOf } from "./settings.js";

const $ = (id) => document.getElementById(id);

/** Calls `set`. If it throws, marks the field as invalid and shows the reason. */
export function attempt(field, reason, set) {
  try {
    set();
    field.removeAttribute("aria-invalid");
    reason.textContent = "";
  } catch (error) {
    field.setAttribute("aria-invalid", "true");
    reason.textContent = minus(error.message);
  }
}

/** `get` returns parameters, `take` takes them or throws. Returns a function that shows them. */
export function parametersPanel(get, take) {
  const showMachine = () => ($("machine").value = machineOf(get()));
  const set = (params) => {
    take(params);
    showMachine();
  };
  const fields = PARAMETERS.map(({ place, name, label, unit, start, end, step, hint }) => {
    const field = document.createElement("div");
    field.className = "field parameter";
    const described = `aria-describedby="${name}-hint ${name}-reason"`;
    const range = `type="range" min="${start}" max="${end}" step="${step}"`;
    field.innerHTML = `
      <label for="${name}">${label}</label>
      <input ${range} aria-label="${label}, ${unit}" ${described}>
      <input id="${name}" inputmode="decimal" autocomplete="off" ${described}>
      <span class="hint">${unit}</span>
      <p id="${name}-reason" class="reason" role="alert"></p>
      <p id="${name}-hint" class="hint">${hint}</p>`;
    $(place).append(field);
    const [slider, text] = field.querySelectorAll("input");
    const reason = field.querySelector(".reason");
    const change = () => {
      const value = parseNumber(text.value);
      const isNew = !Object.is(value, get()[name]);
      attempt(text, reason, () => isNew && set({ ...get(), [name]: value }));
    };
    slider.oninput = () => {
      text.value = slider.value;
      change();
    };
    // So that ← and → are the torque again.
    slider.onpointerup = () => slider.blur();
    text.oninput = () => {
      if (Number.isFinite(parseNumber(text.value))) slider.value = text.value;
      change();
    };
    return () => {
      slider.value = text.value = textOf(get()[name]);
      attempt(text, reason, () => {});
    };
  });
  const show = () => {
    showMachine();
    $("dynamics").value = get().dynamics;
    $("estimate").checked = get().estimate === 1;
    fields.forEach((show) => show());
  };
  $("dynamics").onchange = ({ target }) => set({ ...get(), dynamics: target.value });
  $("machine").append(...Object.keys(MACHINES).map((name) => new Option(name)));
  $("machine").onchange = ({ target }) => {
    set({ ...get(), ...MACHINES[target.value] });
    show();
  };
  $("estimate").onchange = ({ target }) => set({ ...get(), estimate: Number(target.checked) });
  for (const [id, values] of Object.entries({ faulty: FAULTY, ideal: IDEAL })) {
    $(id).onclick = () => {
      set({ ...get(), ...values });
      show();
    };
  }
  return show;
}
