//! A tick: estimates the state from encoder counts, and follows a plan.

use core::f32::consts::TAU;

use crate::arithmetic::{Damped, Fast};
use crate::control::estimate::{Noise, ParameterEstimator, ParameterStd};
use crate::control::plan::Knot;
use crate::error::Error;
use crate::physics::{Params, State, saturate};

/// The arithmetic of the estimator and of plans.
pub(super) type Arithmetic = Damped<Fast>;

/// Standard deviations: of an angle, in counts, and of the torque, as a part of the largest.
const ANGLE: f32 = 0.29;
const TORQUE: f32 = 0.01;
/// Standard deviations of masses and inertias, as a part of them, and of frictions, as a part of
/// the torque.
const DOUBT: f32 = 0.02;
const VISCOUS: f32 = 1.0 / 600.0;
const DRY: f32 = 1.0 / 60.0;

/// A machine.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Settings};
/// let params = Params { dt: 0.002, ..Params::DEFAULT }; // 500 ticks a second
/// let settings = Settings { params, limit: 6.0, counts: [4096, 4096], ticks: 5 };
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
    /// Ticks from a decision to the next, such as 5 of 2 ms.
    pub ticks: u32,
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
            ..ParameterStd::default()
        }
    }
}

/// What a timer's interrupt does. Plans have `N` decisions.
///
/// ```
/// # use acrobot::Params;
/// # use acrobot::control::mpc::{Controller, Settings};
/// let params = Params { dt: 0.002, ..Params::DEFAULT }; // 500 ticks a second
/// let settings = Settings { params, limit: 6.0, counts: [4096, 4096], ticks: 5 };
/// let mut controller = Controller::<100>::new(settings)?;
/// let torque = controller.tick([512, 0])?; // N m
/// assert_eq!(torque, 0.0); // there is no plan yet
/// assert!((controller.state().theta1 - 0.785).abs() < 1e-3); // rad: an eighth of a turn
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Controller<const N: usize> {
    settings: Settings,
    pub(super) estimator: ParameterEstimator<Arithmetic>,
    /// The plan, and its next step.
    pub(super) plan: [Knot<f32>; N],
    pub(super) next: usize,
    /// The step of the last decision, and the state then.
    pub(super) last: Knot<f32>,
    pub(super) state: State<f32>,
    pub(super) decisions: u32,
    /// Ticks to the next decision.
    ticks: u32,
    torque: f32,
}

impl<const N: usize> Controller<N> {
    /// A controller without a plan: its torque is 0.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, or another setting is not above 0.
    pub fn new(settings: Settings) -> Result<Self, Error> {
        let [counts1, counts2] = settings.counts.map(f64::from);
        settings.params.validate()?;
        for (name, value, unit) in [
            ("limit", settings.limit.into(), "N m"),
            ("counts", counts1, "for a turn"),
            ("counts", counts2, "for a turn"),
            ("ticks", settings.ticks.into(), "for a decision"),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { name, value, unit, rule: "finite and above 0" });
            }
        }
        let angle = ANGLE * TAU / counts1.min(counts2) as f32;
        let noise = Noise { angle_std: angle, torque_std: TORQUE * settings.limit };
        Ok(Self {
            settings,
            estimator: ParameterEstimator::new(settings.params, settings.doubt(), noise)?,
            plan: [Knot::EMPTY; N],
            next: 0,
            last: Knot::EMPTY,
            state: State::HANGING,
            decisions: 0,
            ticks: 0,
            torque: 0.0,
        })
    }

    /// The torque from now to the next tick, N m, from what both encoders count.
    ///
    /// # Errors
    ///
    /// The estimate or the torque is not finite. Switch the motor off.
    pub fn tick(&mut self, counts: [i32; 2]) -> Result<f32, Error> {
        let [count1, count2] = counts;
        let [turn1, turn2] = self.settings.counts;
        let angle =
            |count: i32, turn: i32| count.checked_rem(turn).unwrap_or(0) as f32 / turn as f32 * TAU;
        self.estimator.correct([angle(count1, turn1), angle(count2, turn2)])?;
        if self.ticks == 0 {
            self.ticks = self.settings.ticks;
            self.decisions = self.decisions.wrapping_add(1);
            self.state = self.estimator.state();
            // After the plan its last gain holds.
            if let Some(knot) = self.plan.get(self.next) {
                self.last = *knot;
                self.next += 1;
            }
            self.torque = saturate(self.last.follow(self.state), self.settings.limit);
        }
        self.ticks = self.ticks.saturating_sub(1);
        self.estimator.predict(self.torque)?;
        Ok(self.torque)
    }

    /// The estimated state.
    #[must_use]
    pub fn state(&self) -> State<f32> {
        self.estimator.state()
    }

    /// The estimated parameters. While the machine stands, its masses drift, up to 8 %.
    #[must_use]
    pub fn params(&self) -> &Params<f32> {
        self.estimator.params()
    }
}
