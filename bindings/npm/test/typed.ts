// Compiles with `tsc --strict`: valid uses have types, and others are errors. The programs of the
// documentation have more uses.

import { Acrobot, Batch, moduleBytes, setModule } from "acrobot-rs";
import type { Action, BatchStep, Context, Options, Params, State, Step, Task } from "acrobot-rs";
import {
  Controller, ParameterEstimator, Planner, Regression, Replanner, SwingUp, dlqe, dlqr, fitParams,
  linearizeStep, planTorque,
} from "acrobot-rs/control";
import type { Plan } from "acrobot-rs/control";
import { Learner, energyLaw } from "acrobot-rs/policies";

const changes: Options["params"] = { dt: 0.05, torques: [-2, 0, 2], dynamics: "nips" };
const options: Options = { seed: 42n, maxSteps: 200, params: changes };
using acrobot = new Acrobot(options);
const step: Step = acrobot.step(acrobot.reset(7)[4]! > 0 ? 0 : 2);
const params: Readonly<Params> = acrobot.params;
const state: State = acrobot.state;
acrobot.state = { ...state, theta1: Math.PI };
const task: Task = acrobot.task;

const batch = new Batch({ ...options, count: 3, autoreset: "SameStep" });
const results: BatchStep = batch.step([0, 1, 2]);
const finals: Float32Array | undefined = results.finalObservations;
batch.resetMasked([true, false, true], 7);
batch.setDraws({ torques: ["fixed", "fixed", { normal: [1, 0.1, 0.5, 1.5] }] });
const mode: "NextStep" | "SameStep" | "Disabled" = batch.settings.autoreset;

const learner = new Learner({ episodes: 100, seed: 42n });
const actions: Action[] = [energyLaw(acrobot), learner.act(acrobot), acrobot.sample()];

using planner = new Planner(params, 2, { torqueChange: 1, angles: [0.1, 0] });
const plan: Plan | null = planner.plan(state, { steps: 500, seed: 7n });
const torque: number = plan ? planTorque(plan, 0, state) : new SwingUp(params, 2).torque(state);
const eye = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
const gain: Float32Array = dlqr(linearizeStep(state, 0, { dt: 0.05 }), eye, 1).gain;
const filter: Float32Array[] = dlqe(linearizeStep(state, 0, { dt: 0.05 }), eye, [1, 1]).gain;
const regression = new Regression();
regression.add({ angles: [0, 0], torques: [0] }, 0.05, 9.8, 2, 25);
const fitted: () => Readonly<Params> = () => fitParams(regression.fit(), params);
const noise = { angleStd: 0.001, torqueStd: 0.01 };
using estimator = new ParameterEstimator(params, { mass2: 0.1 }, noise);
const estimated: Readonly<State> = estimator.state;
const settings = { params, limit: 6, counts: [4096, 4096], ticks: 5 } as const;
const controller = new Controller(settings);
new Replanner(settings).exchange(controller);

setModule(new WebAssembly.Module(Uint8Array.from(moduleBytes())));

export const draws: ((context: Context) => void)[] = [(context) => batch.draw(context, 2)];
export function draw(page: CanvasRenderingContext2D, other: OffscreenCanvasRenderingContext2D) {
  acrobot.draw(page);
  acrobot.draw(other, { size: 100, colors: { link: "#08c" } });
}

// @ts-expect-error
acrobot.step(3);
// @ts-expect-error
acrobot.setDraws({ dynamics: ["book", "nips"] });
// @ts-expect-error
acrobot.params.torques[0] = 1;
// @ts-expect-error
batch.settings.count = 1;
// @ts-expect-error
new Acrobot({ sed: 1 });
// @ts-expect-error
new Batch({ seed: 1 });
// @ts-expect-error
planTorque(planner.plan(state, { steps: 500 }), 0, state);

export { actions, estimated, filter, finals, fitted, gain, mode, step, task, torque };
