//! A tick: estimates the state from encoder counts, and follows a plan.

use core::f32::consts::TAU;

use super::delay::{Arithmetic, Delay, model};
use crate::control::estimate::{KalmanFilter, Noise, ParameterStd, USUAL};
use crate::control::plan::Knot;
use crate::control::units::Units;
use crate::error::{Error, Range};
use crate::math::matrix::check_finite;
use crate::physics::{Params, Pendulum, State, saturate, wrap};

/// Standard deviations: of an angle, in counts, and of the torque, as a part of the largest.
const ANGLE: f32 = 0.29;
const TORQUE: f32 = 0.01;
/// Standard deviations of masses and inertias, as a part of them, and of frictions, as a part of
/// the torque.
const DOUBT: f32 = 0.02;
const VISCOUS: f32 = 1.0 / 600.0;
const DRY: f32 = 1.0 / 60.0;
/// Standard deviations of the encoders' zeros, rad, and of the torque's factor.
const ZERO: f32 = 0.0175;
const FACTOR: f32 = 0.1;
/// Pushes cause fewer misses.
const MISSES: f32 = 8.0;
/// So many misses is a radian that a joint turns while the other one's encoder does not count: the
/// estimator alone believes in a link that sticks, and in a torque that makes it.
const STILL: f32 = 4.0;
/// Decisions in the machine's time T, so that a plan of 100 is 4.5 T long.
const DECISIONS: f32 = 22.0;

/// A machine.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Settings};
/// let params = Params { dt: 0.002, ..Params::DEFAULT }; // 500 ticks a second
/// let (counts, delay) = ([4096, 4096], 0.0);
/// let settings = Settings { params, limit: 6.0, counts, delay, plan_timeout: 1.0 };
/// assert!(Controller::<100>::new(settings).is_ok());
/// let without_motor = Settings { limit: 0.0, ..settings };
/// let error = Controller::<100>::new(without_motor).unwrap_err();
/// assert_eq!(error.to_string(), "limit must be finite and above 0 N m, got 0");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Its parameters, whose `dt` is the time from a tick to the next.
    pub params: Params<f32>,
    /// The motor's largest torque, N m.
    pub limit: f32,
    /// The counts of each encoder for a turn.
    pub counts: [i32; 2],
    /// The time from a torque that [`Controller::tick`] returns until it acts, s, with the time
    /// constant of the motor: 0 if it acts at once.
    pub delay: f32,
    /// The torque is 0 while the plan is older than this, s: infinite for never. A slice of
    /// planning makes it older, so 0.3 s is short.
    pub plan_timeout: f32,
}

/// What a [`Controller`] knows beside the state and the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report {
    /// What the encoders are estimated to say where the angles are 0, rad.
    pub zeros: [f32; 2],
    /// The torque that is estimated to act, divided by the one that is sent.
    pub torque_factor: f32,
    /// How many of the last hundred ticks have angles that no motion of the machine explains: a few
    /// after a push. And 4 for each radian that a joint has turned since the other one's encoder
    /// counted.
    pub misses: f32,
    /// The time since the last plan, s. It is 0 before the first one.
    pub plan_age: f32,
}

impl Settings {
    /// How wrong the parameters may be.
    fn doubt(&self) -> ParameterStd<f32> {
        let Params { mass1, mass2, .. } = self.params;
        let [link1, _, link2, _] = self.params.inertias();
        let [viscous, coulomb] = [VISCOUS * self.limit, DRY * self.limit];
        ParameterStd {
            mass1: DOUBT * mass1,
            mass2: DOUBT * mass2,
            inertia1: DOUBT * link1,
            inertia2: DOUBT * link2,
            damping1: viscous,
            damping2: viscous,
            coulomb1: coulomb,
            coulomb2: coulomb,
            zero1: ZERO,
            zero2: ZERO,
            torque_factor: FACTOR,
            ..ParameterStd::default()
        }
    }

    /// Checks all settings. Returns the machine, and the torques on their way: none.
    pub(super) fn check(&self) -> Result<(Pendulum<Arithmetic>, Delay), Error> {
        let [counts1, counts2] = self.counts.map(f64::from);
        let model = model(self.params, State::HANGING)?;
        for (name, value, unit) in [
            ("limit", self.limit.into(), "N m"),
            ("counts", counts1, "for a turn"),
            ("counts", counts2, "for a turn"),
        ] {
            Range::AboveZero.check(name, value, unit)?;
        }
        let (name, value) = ("plan_timeout", self.plan_timeout);
        if value.is_nan() || value <= 0.0 {
            let (value, unit) = (value.into(), "s");
            return Err(Error::OutOfRange { name, value, unit, rule: "above 0" });
        }
        Ok((model, Delay::new(self.delay, self.params.dt, self.ticks())?))
    }

    /// Ticks from a decision to the next.
    pub(super) fn ticks(&self) -> u32 {
        let Units { time, .. } = Units::new(&self.params, self.limit);
        ((time as f32 / DECISIONS / self.params.dt + 0.5) as u32).max(1)
    }
}

/// What a timer's interrupt does. Plans have `N` decisions.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Settings};
/// let params = Params { dt: 0.002, ..Params::DEFAULT }; // 500 ticks a second
/// let (counts, delay) = ([4096, 4096], 0.0);
/// let settings = Settings { params, limit: 6.0, counts, delay, plan_timeout: 1.0 };
/// let mut controller = Controller::<100>::new(settings)?;
/// let torque = controller.tick([512, 0])?; // N m
/// assert_eq!(torque, 0.0); // there is no plan yet
/// assert!((controller.state().theta1 - 0.785).abs() < 1e-3); // rad: an eighth of a turn
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Controller<const N: usize> {
    settings: Settings,
    pub(super) estimator: KalmanFilter<Arithmetic, USUAL>,
    /// The plan, and its next step.
    pub(super) plan: [Knot<f32>; N],
    pub(super) next: usize,
    /// The step of the last decision, and the state then.
    pub(super) last: Knot<f32>,
    pub(super) state: State<f32>,
    pub(super) decisions: u32,
    /// The decision in which the plan came.
    pub(super) planned: u32,
    /// Ticks of a decision, and those since the last one.
    ticks: u32,
    tick: u32,
    torque: f32,
    delay: Delay,
    /// Both counts when each encoder last counted.
    counted: Option<[[i32; 2]; 2]>,
    misses: f32,
}

impl<const N: usize> Controller<N> {
    /// A controller without a plan: its torque is 0.
    ///
    /// # Errors
    ///
    /// A setting is out of range.
    pub fn new(settings: Settings) -> Result<Self, Error> {
        let (model, delay) = settings.check()?;
        let [counts1, counts2] = settings.counts;
        let angle = ANGLE * TAU / counts1.min(counts2) as f32;
        let noise = Noise { angle_std: angle, torque_std: TORQUE * settings.limit };
        Ok(Self {
            settings,
            estimator: KalmanFilter::with_std(model, settings.doubt(), noise)?,
            plan: [Knot::EMPTY; N],
            next: 0,
            last: Knot::EMPTY,
            state: State::HANGING,
            decisions: 0,
            planned: 0,
            ticks: settings.ticks(),
            tick: 0,
            torque: 0.0,
            delay,
            counted: None,
            misses: 0.0,
        })
    }

    /// The torque from now to the next tick, N m, from what both encoders count.
    ///
    /// # Errors
    ///
    /// The estimate or the torque is not finite, or an encoder is dead, stuck or slips: no motion
    /// of the machine explains what they count. Switch the motor off.
    pub fn tick(&mut self, counts: [i32; 2]) -> Result<f32, Error> {
        let [count1, count2] = counts;
        let [turn1, turn2] = self.settings.counts;
        let angle =
            |count: i32, turn: i32| count.checked_rem(turn).unwrap_or(0) as f32 / turn as f32 * TAU;
        self.estimator.correct([angle(count1, turn1), angle(count2, turn2)])?;
        let [at1, at2] = self.counted.get_or_insert([counts; 2]);
        if at1[0] != count1 {
            *at1 = counts;
        }
        if at2[1] != count2 {
            *at2 = counts;
        }
        // Counts may begin again after a turn.
        let turned1 = wrap(angle(count1.wrapping_sub(at2[0]), turn1)).abs();
        let turned2 = wrap(angle(count2.wrapping_sub(at1[1]), turn2)).abs();
        self.misses = self.estimator.misses() + STILL * turned1.max(turned2);
        if self.misses > MISSES {
            let (name, value, unit) = ("misses", self.misses.into(), "of the last hundred ticks");
            return Err(Error::OutOfRange { name, value, unit, rule: "at most 8" });
        }
        if self.tick == 0 {
            self.decide()?;
        }
        self.estimator.predict(self.delay.acting(self.tick))?;
        self.tick = (self.tick + 1) % self.ticks.max(1);
        Ok(self.torque)
    }

    fn decide(&mut self) -> Result<(), Error> {
        self.decisions = self.decisions.wrapping_add(1);
        let estimator = &self.estimator;
        let (params, factor) = (estimator.params(), estimator.torque_factor());
        self.state = self.delay.predict(params, factor, estimator.state())?;
        // After the plan its last gain holds.
        if let Some(knot) = self.plan.get(self.next) {
            self.last = *knot;
            self.next += 1;
        }
        let torque = saturate(self.last.follow(self.state) / factor, self.settings.limit);
        check_finite("torque", &[torque])?;
        let is_late = self.report().plan_age > self.settings.plan_timeout;
        self.torque = if is_late { 0.0 } else { torque };
        self.delay.send(self.torque);
        Ok(())
    }

    /// What the controller knows beside the state and the parameters.
    #[must_use]
    pub fn report(&self) -> Report {
        let decisions = match self.planned {
            0 => 0,
            planned => self.decisions.wrapping_sub(planned),
        };
        Report {
            zeros: self.estimator.zeros(),
            torque_factor: self.estimator.torque_factor(),
            misses: self.misses,
            plan_age: decisions as f32 * self.ticks as f32 * self.settings.params.dt,
        }
    }

    /// The estimated state.
    #[must_use]
    pub fn state(&self) -> State<f32> {
        self.estimator.state()
    }

    /// The estimated parameters. While the machine stands, they rest.
    #[must_use]
    pub fn params(&self) -> &Params<f32> {
        self.estimator.params()
    }
}
