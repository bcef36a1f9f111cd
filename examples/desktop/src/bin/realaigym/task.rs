//! RealAIGym's acrobot as a task, and its machines.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Numbers, Real};
use acrobot::rand_core::Rng;
use acrobot::task::{Pose, ResetBounds, Swingup, Task};
use acrobot::{Params, State};

use crate::score::Costs;

/// The largest torque, N m.
pub const LIMIT: f64 = 6.0;

/// design_C.1, of version 2 and ICRA 2025. RealAIGym has inertias about the joints.
pub const C1: Params = {
    let [mass1, mass2, lc1, lc2] =
        [0.5234602302310271, 0.6255677234174437, 0.2, 0.25569305436052964];
    Params {
        length1: 0.2,
        length2: 0.3,
        mass1,
        mass2,
        center_of_mass1: lc1,
        center_of_mass2: lc2,
        inertia1: 0.031887199591513114 - mass1 * lc1 * lc1,
        inertia2: 0.05086984812807257 - mass2 * lc2 * lc2,
        gravity: 9.81,
        dt: 0.002,
        max_velocity1: f64::INFINITY,
        max_velocity2: f64::INFINITY,
        torques: [-LIMIT, 0.0, LIMIT],
        ..Params::DEFAULT
    }
};

/// design_C.0, of version 1.
pub fn c0() -> Params {
    let (mass1, mass2) = (0.6416937799349799, 0.563935954099688);
    let params = Params { mass1, mass2, center_of_mass2: 0.3212669909674605, ..C1 };
    params.with_inertias_about_joints([0.02671076499939512, 0.053878129629650884])
}

/// The costs of the best published swing-ups of versions 2 and 1.
pub const HISTORY_SAC: Costs = [1.0, 8.0777, 1.9757, 2.0673, 1.80371, 0.0095468, 88.4966, 9.0];
pub const MC_PILCO: Costs = [1.098, 9.8082, 2.82, 1.2689, 2.26895, 0.056673, 242.436, 8.904];

/// Swing up and keep the tip above the line, at 0.9 of the acrobot's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealAiGym;

impl Task for RealAiGym {
    const NAME: &'static str = "realaigym";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(5000).unwrap();
    /// Any angles, as after a reset of ICRA 2025.
    const RESET_BOUNDS: ResetBounds = Swingup::RESET_BOUNDS;
    const PARAMS: Params = C1;

    /// θ1, θ2, θ̇1, θ̇2.
    type Observation = [f32; 4];
    type Memory = ();

    /// At rest.
    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        Swingup.draw(bounds, rng)
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 4] {
        pose.state.into()
    }

    /// 1 above the line.
    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        _: V,
        _: V::Mask,
    ) -> V::Single {
        let line = (params.length1 + params.length2) * V::splat(Real::from_f64(0.9));
        let [_, [_, height]] = pose.positions(params);
        V::Single::select(height.simd_gt(line), V::Single::splat(1.0), V::Single::splat(0.0))
    }
}
