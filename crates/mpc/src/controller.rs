//! A tick: estimates the state from encoder counts, and follows a plan.

use core::f32::consts::TAU;

use acrobot::arithmetic::Damped;
use acrobot::control::{ControlError, Estimator, Knot, Noise};
use acrobot::physics::{Joints, saturate};
use acrobot::{Error, Fast, Params, State};

/// The arithmetic of the estimator and of plans.
pub(crate) type Arithmetic = Damped<Fast>;

/// The standard deviation of an angle, in counts, and of the torque, as a part of the largest. The
/// estimator changes the latter by what it sees.
const ANGLE: f32 = 0.29;
const TORQUE: f32 = 0.01;
/// The standard deviations of the parameters: of masses and inertias, as a part of them, and of
/// both frictions, as a part of the largest torque.
const DOUBT: f32 = 0.02;
const VISCOUS: f32 = 1.0 / 600.0;
const DRY: f32 = 1.0 / 60.0;

/// A machine, and its controller's times.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub(crate) params: Params<f32>,
    pub(crate) limit: f32,
    counts: [u16; 2],
    /// Ticks from a decision to the next: 5 by default, 10 ms if a tick has 2 ms.
    pub ticks: u32,
}

impl Settings {
    /// A machine with these parameters, whose `dt` is the time between two ticks, a motor's largest
    /// torque, N m, and the encoders' counts for a turn.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, or the torque is not above 0, or an encoder does not count.
    pub fn new(params: Params<f32>, limit: f32, counts: [u16; 2]) -> Result<Self, Error> {
        params.validate()?;
        let above_zero = |name, value: f32, unit| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => {
                let rule = "finite and above 0";
                Err(Error::OutOfRange { name, value: value.into(), unit, rule })
            }
        };
        above_zero("limit", limit, "N m")?;
        for count in counts {
            above_zero("counts", count.into(), "counts for a turn")?;
        }
        Ok(Self { params, limit, counts, ticks: 5 })
    }

    /// How wrong the parameters may be.
    fn deviations(&self) -> Params<f32> {
        let given = &self.params;
        let about_joint = |mass: f32, center: f32, inertia: f32| {
            let inertia = inertia + mass * (center * center);
            [DOUBT * mass, DOUBT * inertia]
        };
        let [mass1, inertia1] = about_joint(given.mass1, given.center_of_mass1, given.inertia1);
        let [mass2, inertia2] = about_joint(given.mass2, given.center_of_mass2, given.inertia2);
        let both = |deviation| Joints { joint1: deviation, joint2: deviation };
        Params {
            mass1,
            mass2,
            inertia1,
            inertia2,
            length1: 0.0,
            friction: both(VISCOUS * self.limit),
            coulomb: both(DRY * self.limit),
            rotor: 0.0,
            ..*given
        }
    }
}

/// What a timer's interrupt does. Plans have `N` decisions.
#[derive(Clone, Debug)]
pub struct Controller<const N: usize> {
    settings: Settings,
    pub(crate) estimator: Estimator<Arithmetic, 10>,
    /// The plan, what it costs, and its next step.
    pub(crate) plan: [Knot<f32>; N],
    pub(crate) cost: f32,
    pub(crate) next: usize,
    /// The step of the last decision, and the state then.
    pub(crate) last: Knot<f32>,
    pub(crate) state: State<f32>,
    pub(crate) decisions: u32,
    /// Ticks to the next decision.
    ticks: u32,
    torque: f32,
}

impl<const N: usize> Controller<N> {
    /// A controller without a plan: its torque is 0.
    ///
    /// # Errors
    ///
    /// The parameters have no estimator.
    pub fn new(settings: Settings) -> Result<Self, Error> {
        let counts = settings.counts[0].min(settings.counts[1]);
        let noise =
            Noise { angle: ANGLE * TAU / f32::from(counts), torque: TORQUE * settings.limit };
        let deviations = settings.deviations();
        Ok(Self {
            settings,
            estimator: Estimator::with_params(settings.params, deviations, noise)?,
            plan: [Knot::EMPTY; N],
            cost: f32::INFINITY,
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
    /// The estimate overflows. Switch the motor off.
    pub fn tick(&mut self, counts: [i32; 2]) -> Result<f32, ControlError> {
        let [count1, count2] = counts;
        let [turn1, turn2] = self.settings.counts.map(i32::from);
        let angle = |count: i32, turn: i32| (count % turn) as f32 / turn as f32 * TAU;
        self.estimator.measure([angle(count1, turn1), angle(count2, turn2)])?;
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
        self.estimator.step(self.torque)?;
        Ok(self.torque)
    }

    /// The estimated state.
    #[must_use]
    pub fn state(&self) -> State<f32> {
        self.estimator.state()
    }

    /// The estimated parameters.
    #[must_use]
    pub fn params(&self) -> &Params<f32> {
        self.estimator.params()
    }
}
