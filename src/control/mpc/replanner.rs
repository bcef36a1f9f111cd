//! Slices of work: each improves the plan that the controller follows.

use core::iter::{once, repeat};

use super::controller::{Arithmetic, Controller, Settings};
use crate::control::plan::{Cost, Knot, Planner, Problem};
use crate::error::Error;
use crate::physics::{Params, Pendulum, State, saturate};

/// The part of the motor's torque that plans use. The rest corrects deviations.
const PLANNED: f32 = 0.9;
/// The iterations of a slice. They are few, so a plan must change gently: factors of the default
/// weights of the torque and of the time below.
const ITERATIONS: u32 = 4;
const GENTLE: [f32; 2] = [16.0, 2.5];
/// After so many slices, one takes the estimated parameters.
const SLICES: u32 = 20;

#[derive(Clone, Copy, Debug)]
enum Work {
    /// To compute what a deviation at a plan's end costs, for the estimated parameters.
    Model,
    /// To improve the plan.
    Plan,
    /// Done, and whether the plan is good.
    Done(bool),
    /// The same, until the plan's first decision is due.
    Due(bool),
}

/// What the main loop does. It needs 0.8 KB beside a plan of 44 bytes a decision, and several KB of
/// stack.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Replanner, Settings};
/// # let params = Params { dt: 0.01, ..Params::DEFAULT };
/// let settings = Settings { params, limit: 6.0, counts: [4096, 4096], ticks: 1 };
/// let mut controller = Controller::<100>::new(settings)?;
/// let mut replanner = Replanner::new(settings)?;
/// for slice in 0..9 {
///     assert_eq!(controller.tick([100, 0])? < 0.0, slice > 1); // N m, once there is a plan
///     replanner.exchange(&mut controller);
///     replanner.work();
/// }
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Replanner<const N: usize> {
    limit: f32,
    /// Ticks of a decision.
    ticks: f32,
    planner: Planner<Arithmetic>,
    /// The planner's parameters, and those for the next one.
    params: Params<f32>,
    estimated: Params<f32>,
    work: Work,
    slices: u32,
    /// The plan, its first state, and the decision with which it begins.
    plan: [Knot<f32>; N],
    start: State<f32>,
    begin: u32,
    /// The decision in which the work began, and how many later the plan begins.
    before: u32,
    ahead: u32,
}

impl<const N: usize> Replanner<N> {
    /// A replanner without a plan.
    ///
    /// # Errors
    ///
    /// The parameters have no regulator.
    pub fn new(settings: Settings) -> Result<Self, Error> {
        let ticks = settings.ticks as f32;
        let params = of_decisions(&settings.params, ticks);
        let planner = planner(params, settings.limit)?;
        Ok(Self {
            limit: settings.limit,
            ticks,
            planner,
            params,
            estimated: settings.params,
            work: Work::Model,
            slices: 0,
            plan: [Knot::EMPTY; N],
            start: State::HANGING,
            begin: 0,
            before: 0,
            ahead: 1,
        })
    }

    /// Gives the controller the plan, once its first decision is due, and takes the next work. No
    /// tick may come between, so this is short: it copies two plans, and simulates a few decisions.
    pub fn exchange(&mut self, controller: &mut Controller<N>) {
        let now = controller.decisions;
        if let Work::Done(is_good) = self.work {
            let took = now.wrapping_sub(self.before);
            self.ahead = (took + 1).max(self.ahead.saturating_sub(1)).min(N as u32 / 2);
            self.work = Work::Due(is_good);
        }
        if let Work::Due(is_good) = self.work {
            let late = now.wrapping_sub(self.begin).cast_signed();
            if late < 0 {
                return;
            }
            if is_good {
                controller.plan = self.plan;
                controller.next = late as usize;
            }
        }
        self.slices += 1;
        if self.slices == SLICES {
            self.slices = 0;
            self.estimated = *controller.params();
            self.work = Work::Model;
            return;
        }
        self.before = now;
        self.work = match self.look(controller) {
            Ok(()) => Work::Plan,
            Err(_) => Work::Done(false),
        };
    }

    /// Simulates what the controller does during the work, and copies the plan after that.
    fn look(&mut self, controller: &Controller<N>) -> Result<(), Error> {
        let rest = controller.plan.get(controller.next..).unwrap_or_default();
        // The first step is the one that it takes now, and after the plan it repeats the last.
        let steps = once(&controller.last).chain(rest);
        let held = rest.last().unwrap_or(&controller.last);
        let mut model = Pendulum::<Arithmetic>::new(self.params, controller.state)?;
        let ahead = self.ahead as usize;
        for step in steps.clone().chain(repeat(held)).take(ahead) {
            model.step(saturate(step.follow(model.state()), self.limit))?;
        }
        self.start = model.state();
        self.begin = self.before.wrapping_add(self.ahead).wrapping_sub(1);
        let steps = steps.skip(ahead).chain(repeat(&Knot::EMPTY));
        self.plan.iter_mut().zip(steps).for_each(|(place, step)| *place = *step);
        Ok(())
    }

    /// A slice: computes for some milliseconds to tens of them. Call it once after each
    /// [exchange](Self::exchange).
    pub fn work(&mut self) {
        match self.work {
            // Parameters that no plan can have keep the model before.
            Work::Model => {
                let params = of_decisions(&self.estimated, self.ticks);
                if let Ok(planner) = planner(params, self.limit) {
                    (self.planner, self.params) = (planner, params);
                }
            }
            Work::Plan => {
                let improved = self.planner.improve(self.start, ITERATIONS, &mut self.plan);
                self.work = Work::Done(improved.is_ok());
            }
            Work::Done(_) | Work::Due(_) => {}
        }
    }
}

/// Parameters whose steps are those of decisions.
fn of_decisions(params: &Params<f32>, ticks: f32) -> Params<f32> {
    Params { dt: params.dt * ticks, ..*params }
}

fn planner(params: Params<f32>, limit: f32) -> Result<Planner<Arithmetic>, Error> {
    let (limit, [torque, below]) = (PLANNED * limit, GENTLE);
    let mut problem = Problem::swing_up(params, limit)?;
    let Cost { torque: torque_weight, below: below_weight, .. } = &mut problem.cost;
    *torque_weight *= torque;
    *below_weight *= below;
    Planner::new(&problem)
}
