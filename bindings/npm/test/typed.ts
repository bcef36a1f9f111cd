// Compiles with `tsc --strict`: valid uses have types, and others are errors.

import { Acrobot, Batch, moduleBytes, setModule } from "acrobot-rs";
import type { Action, BatchStep, Context, Options, Params, State, Step, Task } from "acrobot-rs";
import { Learner, bangBang, energyLaw, uprightEnergy } from "acrobot-rs/policies";

const changes: Options["params"] = { dt: 0.05, torques: [-2, 0, 2], dynamics: "nips" };
const options: Options = { seed: 42n, maxSteps: 200, params: changes };
using acrobot = new Acrobot(options);
const action: Action = acrobot.reset(7)[4]! > 0 ? 0 : 2;
const step: Step = acrobot.step(action);
const done: boolean = step.terminated || step.truncated;
const state: State = acrobot.state;
acrobot.state = { ...state, theta1: Math.PI };
const params: Readonly<Params> = acrobot.params;
acrobot.setParams({ gravity: params.gravity / 2 });
const bytes: Uint8Array = acrobot.snapshot();
const resumed: Acrobot = Acrobot.restore(bytes);
resumed.restore(bytes);
const steps: number[] = [acrobot.elapsedSteps, acrobot.maxSteps];
const numbers: number[] = [acrobot.energy, acrobot.tipHeight, ...steps];

using swingup = new Acrobot({ task: "swingup", draws: { mass2: [0.8, 1.2] } });
const task: Task = swingup.task;
numbers.push(swingup.stepTorque(-0.5).reward, acrobot.sample(42n));

const batch = new Batch({ ...options, count: 3, autoreset: "SameStep" });
const results: BatchStep = batch.step(Uint8Array.of(0, 1, 2));
batch.step([0, 1, 2]);
const finals: Float32Array | undefined = results.finalObservations;
const second: State = batch.stateOf(1);

const learner = new Learner({ episodes: 100, seed: 42n });
learner.load(learner.save());
const actions: Action[] = [bangBang(acrobot), energyLaw(acrobot), learner.act(acrobot)];
numbers.push(learner.train(), uprightEnergy(acrobot.params), batch.elapsedStepsOf(1));
batch.resetMasked(results.ended);
batch.resetMasked([true, false, true], 7);
batch.step(batch.sample());
batch.setStateOf(0, acrobot.state);
batch.setStates(batch.states);
batch.setDraws({
  friction1: [0, 0.1],
  torques: ["fixed", "fixed", { normal: [1, 0.1, 0.5, 1.5] }],
  inertia1: { logUniform: [0.5, 2] },
  inertia2: "asBefore",
});
batch.stepTorque(new Float32Array(3));
const copied: Batch = Batch.restore(batch.snapshot());
const mode: "NextStep" | "SameStep" | "Disabled" = copied.settings.autoreset;

setModule(new WebAssembly.Module(Uint8Array.from(moduleBytes())));

export const draws: ((context: Context) => void)[] = [(context) => batch.draw(context, 2)];
export function draw(page: CanvasRenderingContext2D, other: OffscreenCanvasRenderingContext2D) {
  acrobot.draw(page);
  acrobot.draw(other, { size: 100, colors: { link: "#08c" } });
}

// @ts-expect-error
acrobot.step(3);
// @ts-expect-error
acrobot.step("1");
// @ts-expect-error
acrobot.setDraws({ dynamics: ["book", "nips"] });
// @ts-expect-error
acrobot.setDraws({ mass1: [1, 2, 3] });
// @ts-expect-error
new Acrobot({ task: "swing-up" });
// @ts-expect-error
acrobot.state.theta1 = 1;
// @ts-expect-error
acrobot.params.torques[0] = 1;
// @ts-expect-error
copied.settings.count = 1;
// @ts-expect-error
new Acrobot({ sed: 1 });
// @ts-expect-error
acrobot.setParams({ mass: 1 });
// @ts-expect-error
acrobot.energy = 1;
// @ts-expect-error
setModule("acrobot.wasm");
// @ts-expect-error
acrobot.restore([1, 2]);
// @ts-expect-error
new Batch({ seed: 1 });
// @ts-expect-error
new Batch({ count: 1, autoreset: "nextStep" });
// @ts-expect-error
batch.draw(document.createElement("canvas"), 0);

export { actions, done, finals, mode, numbers, second, task };
