//! Slices of work: each improves the plan that the controller follows.

use core::iter::{once, repeat};

use super::controller::{Controller, Settings};
use super::delay::{Arithmetic, model};
use crate::control::plan::{Cost, Knot, Planner, Problem};
use crate::control::units::Units;
use crate::error::Error;
use crate::math::Real;
use crate::physics::{Params, State, saturate};

/// The part of the motor's torque that plans use. The rest corrects deviations.
const PLANNED: f32 = 0.9;
/// The iterations of a slice. They are few, so a plan must change gently: factors of the default
/// weights of the torque and of the time below.
const ITERATIONS: u32 = 4;
const GENTLE: [f32; 2] = [16.0, 2.5];
/// The largest velocities of plans: so many times 1/T, and √(F / I2) for link 2 with the inertia
/// I2, which also turns by at most so much in a decision, rad.
const FASTEST: f32 = 4.5;
const TURNED: f32 = 1.0;
/// What velocities cost, 1/T for 1/T². Without this a plan that holds waits, and corrects late.
const SLOW: f32 = 0.01;
/// What energy costs that is missing after a plan, 1/F², so that a plan which does not reach the
/// target pumps. And what link 2 costs that turns then, T²: its energy swings nothing up.
const ENERGY: f32 = 400.0;
const SPIN: f32 = 10.0;
/// Plans ignore dry friction below this part of the motor's torque.
const SMOOTH: f32 = 0.002;
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

/// A machine whose steps are decisions.
#[derive(Clone, Copy, Debug)]
struct Machine {
    params: Params<f32>,
    /// The largest torque that acts, N m.
    limit: f32,
}

/// What the main loop does. It needs 0.8 KB beside a plan of 44 bytes a decision, and several KB of
/// stack.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Replanner, Settings};
/// # let params = Params { dt: 0.01, ..Params::DEFAULT };
/// let (counts, delay) = ([4096, 4096], 0.0);
/// let settings = Settings { params, limit: 6.0, counts, delay, plan_timeout: 1.0 };
/// let mut controller = Controller::<100>::new(settings)?;
/// let mut replanner = Replanner::new(settings)?;
/// let mut torque = 0.0;
/// for _ in 0..9 {
///     torque = controller.tick([100, 0])?;
///     replanner.exchange(&mut controller);
///     replanner.work();
/// }
/// assert!(torque != 0.0); // N m: there is a plan
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Replanner<const N: usize> {
    /// The largest torque that is sent, N m.
    limit: f32,
    /// Ticks of a decision.
    ticks: f32,
    planner: Planner<Arithmetic>,
    /// The machine of the planner, and of the next one.
    machine: Machine,
    estimated: Machine,
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
    /// A setting is out of range, or the parameters have no regulator.
    pub fn new(settings: Settings) -> Result<Self, Error> {
        settings.check()?;
        let Settings { mut params, limit, .. } = settings;
        let ticks = settings.ticks() as f32;
        params.dt *= ticks;
        let machine = Machine { params, limit };
        let planner = planner(machine)?;
        Ok(Self {
            limit,
            ticks,
            planner,
            machine,
            estimated: machine,
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
                controller.planned = now;
            }
        }
        self.slices += 1;
        if self.slices == SLICES {
            self.slices = 0;
            let estimator = &controller.estimator;
            self.estimated.params = *estimator.params();
            self.estimated.params.dt *= self.ticks;
            self.estimated.limit = self.limit * estimator.torque_factor();
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
        let Machine { params, limit } = self.machine;
        let mut model = model(params, controller.state)?;
        let ahead = self.ahead as usize;
        for step in steps.clone().chain(repeat(held)).take(ahead) {
            model.step(saturate(step.follow(model.state()), limit))?;
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
                if let Ok(planner) = planner(self.estimated) {
                    (self.planner, self.machine) = (planner, self.estimated);
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

#[inline(never)] // saves flash
fn planner(Machine { mut params, limit }: Machine) -> Result<Planner<Arithmetic>, Error> {
    // Little dry friction lets no link stick: the regulator of a link that sticks would be wrong.
    for dry in [&mut params.coulomb1, &mut params.coulomb2] {
        if *dry < SMOOTH * limit {
            *dry = 0.0;
        }
    }
    let Units { time, force, .. } = Units::new(&params, limit);
    let [_, _, link2, _] = params.inertias();
    let fastest = force / f64::from(link2);
    params.max_velocity1 = FASTEST / time as f32;
    params.max_velocity2 = (FASTEST * Real::sqrt(fastest) as f32).min(TURNED / params.dt);
    let mut problem = Problem::swing_up(params, PLANNED * limit)?;
    let Cost { q, qf, torque, below, .. } = &mut problem.cost;
    let [torque_factor, below_factor] = GENTLE;
    *torque *= torque_factor;
    *below *= below_factor;
    let [.., row1, row2] = q;
    row1[2] = SLOW * time as f32;
    row2[3] = SLOW * time as f32;
    let [.., row] = qf;
    row[3] = SPIN * (time * time) as f32;
    let mut planner = Planner::new(&problem)?;
    planner.set_replanning(ENERGY / (force * force) as f32);
    Ok(planner)
}
