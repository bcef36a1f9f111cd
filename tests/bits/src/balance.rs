//! A user's task.

use core::f64::consts::PI;
use core::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Numbers, Real};
use acrobot::numpy::Pcg64;
use acrobot::rand_core::Rng;
use acrobot::task::{Gymnasium, ResetBounds, Seen, Task};
use acrobot::{Acrobot, Fast, Params, State, TimeLimit};

use crate::episodes::add_seen;
use crate::{Digest, against};

/// Stay upright. The reward is 1 less the errors of the angles, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance;

impl Task for Balance {
    const NAME: &'static str = "balance";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(200).unwrap();
    const PARAMS: Params =
        Params { length1: 0.7, center_of_mass1: 0.3, dt: 0.05, ..Params::DEFAULT };

    type Observation = [f32; 6];

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        let drawn = bounds.draw(rng);
        State { theta1: drawn.theta1 + core::f32::consts::PI, ..drawn }
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, seen: &Seen<V>) -> [V; 6] {
        Gymnasium.observe::<A, V>(seen)
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        seen: &Seen<V>,
        _: &Params<V>,
        _: V,
        _: V::Mask,
    ) -> V::Single {
        let number = |x| V::splat(Real::from_f64(x));
        let abs = |x: V| x.map(|x| if x < Real::ZERO { -x } else { x });
        let error = number(PI) - abs(seen.state.theta1) + abs(seen.state.theta2);
        (number(1.0) - error).to_f32()
    }
}

/// Every bit of an episode and of the next initial state.
pub fn digest() -> u64 {
    let mut digest = Digest::default();
    let mut acrobot = TimeLimit::of(Acrobot::<Fast, Balance, Pcg64>::new(42));
    loop {
        let step = acrobot.step(against(acrobot.state().dtheta1));
        add_seen(&mut digest, acrobot.inner(), step.observation);
        digest.add(step.reward.to_bits().into());
        if step.done() {
            let first = acrobot.reset();
            add_seen(&mut digest, acrobot.inner(), first);
            return digest.0;
        }
    }
}

pub const DIGEST: u64 = 0x9f8f_91dc_6724_8089;
