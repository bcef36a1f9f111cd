//! Arithmetics: the types that determine every bit of a result.
//!
//! An [`Arithmetic`] names a scalar, a sine and cosine, and a [`Form`] of the equations of motion. It is a type
//! parameter and not a feature flag, because Cargo unifies features: a flag that changes results would change them for
//! every crate in the build. The guide says [which to choose](crate::guide::numbers#arithmetics).
//!
//! For a hardware sine unit, implement [`Arithmetic`]:
//!
//! ```
//! use acrobot::arithmetic::Arithmetic;
//! use acrobot::physics::Lean;
//! use acrobot::{Acrobot, Action};
//!
//! /// Sines from the microcontroller's table.
//! #[derive(Clone, Copy, Debug, Default, PartialEq)]
//! struct Table;
//!
//! impl Arithmetic for Table {
//!     const NAME: &'static str = "table";
//!     type Scalar = f32;
//!     type Form = Lean;
//!     fn sin_cos(x: f32) -> (f32, f32) {
//! #       fn look_up(x: f32) -> f32 { libm::sinf(x) }
//!         (look_up(x), look_up(x + core::f32::consts::FRAC_PI_2))
//!     }
//! }
//!
//! let step = Acrobot::<Table>::new(42).step(Action::Positive);
//! assert_eq!(step.reward, -1.0);
//! ```

use core::marker::PhantomData;

use crate::error::Error;
#[cfg(feature = "std")]
use crate::math::sines::platform;
use crate::math::sines::{self, correctly_rounded, polynomial, table};
use crate::physics::{
    Gymnasium, GymnasiumConstants, Lean, LeanConstants, Model, Params, Pendulum, State, Task,
    Viscous,
};

pub use crate::math::{Numbers, Real};
pub use crate::physics::equations::{Arithmetic, Form};

/// `f64`, correctly rounded sines and cosines, and Gymnasium's expressions: the same bits on every target, defined by
/// mathematics and not by a library.
///
/// For each x one `f64` is nearest to sin x. This arithmetic returns it, as any other correctly rounded sine does.
/// 99.75 % of its steps are [bit-identical to Gymnasium's](crate::guide::parity#bit-identical-steps), about as many as
/// between Gymnasium on two CPUs. `src/math/sines/correctly_rounded.rs` explains the method.
///
/// ```
/// use acrobot::arithmetic::{Arithmetic, Reference};
///
/// let (sin, cos) = Reference::sin_cos(1.0);
/// assert_eq!([sin, cos].map(f64::to_bits), [0x3fea_ed54_8f09_0cee, 0x3fe1_4a28_0fb5_068c]);
/// // A large x needs more than 53 bits of π.
/// assert_eq!(Reference::sin_cos(f64::MAX).0, 0.004961954789184062);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reference;

impl Arithmetic for Reference {
    const NAME: &'static str = "reference";
    type Scalar = f64;
    type Form = Gymnasium;

    /// Sine and cosine, correctly rounded. NaN for infinity and NaN.
    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        correctly_rounded::sin_cos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        correctly_rounded::cos(x)
    }
}

/// `f64`, the C library's `sin`, `cos` and `pow`, and Gymnasium's order: bit-identical to Gymnasium if NumPy calls the
/// same library, as on Linux with glibc and a CPU with FMA. Without FMA glibc rounds a few sines differently.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Host;

#[cfg(feature = "std")]
impl Arithmetic for Host {
    const NAME: &'static str = "host";
    type Scalar = f64;
    type Form = Gymnasium;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        platform::sin_cos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        platform::cos(x)
    }

    #[inline(always)]
    fn square(x: f64) -> f64 {
        platform::square(x)
    }
}

/// `f64`, sines from the crate `libm`, and the lean form: the fastest `f64` with the same bits on every target.
///
/// A release of `libm` could round its sines differently and so change the bits. [Fix its
/// version](crate::guide::determinism#limits), or use [`Reference`], which depends on no library.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Portable;

impl Arithmetic for Portable {
    const NAME: &'static str = "portable";
    type Scalar = f64;
    type Form = Lean;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        libm::cos(x)
    }
}

/// `f32`, polynomial sines, and the lean form: the same bits on every target, with or without an FPU. For
/// single-precision FPUs, WASM and batches with SIMD.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fast;

impl Arithmetic for Fast {
    const NAME: &'static str = "fast";
    type Scalar = f32;
    type Form = Lean;

    /// Sine and cosine with an error of at most 1.2e-7 (two units in the last place of 1) for |x| ≤ 64 rad. The largest
    /// error over all these `f32` is 1.17e-7 (`cargo test --release --test trigonometry`). For larger angles the error
    /// is that of an angle in `f32`, 1.2e-7 |x|. Angles beyond ±2¹⁹ rad are clamped to ±2¹⁹ rad.
    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        polynomial::sin_cos(sines::clamp(x))
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f32>>(x: V) -> (V, V) {
        polynomial::sin_cos(x)
    }
}

/// `f32`, a table of sixteen sines for half a turn, and the lean form: a sixth fewer instructions than [`Fast`] on a
/// Cortex-M4, and about seven times its error for |x| ≤ π.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Micro;

impl Arithmetic for Micro {
    const NAME: &'static str = "micro";
    type Scalar = f32;
    type Form = Lean;

    /// Sine and cosine with an error of at most 8e-7 for |x| ≤ π, and 4e-6 for |x| ≤ 64 rad
    /// (`cargo test --release --test trigonometry`). For larger angles the error is 2e-7 |x|.
    /// Angles beyond ±2¹⁹ rad are clamped to ±2¹⁹ rad.
    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        table::sin_cos(sines::clamp(x))
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f32>>(x: V) -> (V, V) {
        x.zip3(x, x, |x, _, _| table::sin_cos(x))
    }
}

/// An arithmetic of this crate with [viscous friction](Viscous) of the joints. Its parameters have a field `friction`,
/// which is 0 by default.
///
/// It needs memory and instructions for friction, which the arithmetic itself does not. `TASK` is 0, or that of
/// [`Swingup`] and [`SwingupSparse`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Damped<A, const TASK: u8 = 0>(PhantomData<A>);

/// dm_control's `acrobot-swingup` in an arithmetic of this crate: see [`Task::Swingup`], and [`Params::SWINGUP`] for its
/// parameters.
///
/// ```
/// use acrobot::arithmetic::{Arithmetic, Swingup};
/// use acrobot::{Acrobot, Fast, TimeLimit};
///
/// let swingup = Acrobot::<Swingup<Fast>>::new(42); // at rest, anywhere
/// let mut swingup = TimeLimit::new(swingup, Swingup::<Fast>::TASK.limit());
/// let step = swingup.step_torque(2.0)?; // N m; dm_control's action times 2
/// // Sines, then cosines of both links' angles from upright, then θ̇1 and θ̇2.
/// let [sin1, _, cos1, _, _, _] = step.observation.to_array();
/// assert!((sin1 * sin1 + cos1 * cos1 - 1.0).abs() < 1e-6);
/// assert!((0.0..=1.0).contains(&step.reward) && !step.terminated);
/// # Ok::<(), acrobot::Error>(())
/// ```
pub type Swingup<A> = Damped<A, 1>;

/// dm_control's `acrobot-swingup_sparse`: see [`Task::SwingupSparse`].
pub type SwingupSparse<A> = Damped<A, 2>;

macro_rules! damped {
    ($(
        $(#[$cfg:meta])?
        $arithmetic:ident, $scalar:ident, $form:ident, $constants:ident,
        [$damped:literal, $swingup:literal, $sparse:literal];
    )*) => {$(
        $(#[$cfg])?
        impl<const TASK: u8> Arithmetic for Damped<$arithmetic, TASK> {
            const NAME: &'static str = match Self::TASK {
                Task::Acrobot => $damped,
                Task::Swingup => $swingup,
                Task::SwingupSparse => $sparse,
            };
            type Scalar = $scalar;
            type Form = $form<Viscous<$scalar>>;
            const TASK: Task = match TASK {
                0 => Task::Acrobot,
                1 => Task::Swingup,
                2 => Task::SwingupSparse,
                _ => panic!("TASK must be 0, 1 or 2"),
            };
            const DEFAULT: Model<Self> = match Self::TASK {
                Task::Acrobot => Model::UNDAMPED,
                Task::Swingup | Task::SwingupSparse => {
                    let params = Params::<$scalar, Viscous<$scalar>>::SWINGUP;
                    let constants = $constants::<$scalar>::new(&params, [1.0, 0.25, 0.25]);
                    Model { params, constants }
                }
            };

            #[inline]
            fn sin_cos(x: $scalar) -> ($scalar, $scalar) {
                $arithmetic::sin_cos(x)
            }

            #[inline(always)]
            fn sin_cos_near<V: Numbers<$scalar>>(x: V) -> (V, V) {
                $arithmetic::sin_cos_near(x)
            }

            #[inline]
            fn cos(x: $scalar) -> $scalar {
                $arithmetic::cos(x)
            }

            #[inline(always)]
            fn square(x: $scalar) -> $scalar {
                $arithmetic::square(x)
            }
        }
    )*};
}

damped! {
    Reference, f64, Gymnasium, GymnasiumConstants, ["damped reference", "swing reference", "sparse reference"];
    #[cfg(feature = "std")]
    Host, f64, Gymnasium, GymnasiumConstants, ["damped host", "swing host", "sparse host"];
    Portable, f64, Lean, LeanConstants, ["damped portable", "swing portable", "sparse portable"];
    Fast, f32, Lean, LeanConstants, ["damped fast", "swing fast", "sparse fast"];
    Micro, f32, Lean, LeanConstants, ["damped micro", "swing micro", "sparse micro"];
}

// Not generic, because a `const fn` cannot calculate with a generic scalar. `Host` has none: it squares with the C library.
macro_rules! const_new {
    ($($arithmetic:ident, $scalar:ident, $constants:ident;)*) => {$(
        impl Pendulum<$arithmetic> {
            /// [`Pendulum::new`] in a `const`, so that a `static` needs no initialization.
            ///
            /// # Errors
            ///
            /// Those of [`Pendulum::new`].
            pub const fn const_new(
                params: Params<$scalar>,
                state: State<$scalar>,
            ) -> Result<Self, Error> {
                if let Err(error) = params.check() {
                    return Err(error);
                }
                if let Err(error) = state.check() {
                    return Err(error);
                }
                let (l1, lc1, lc2) =
                    (params.length1, params.center_of_mass1, params.center_of_mass2);
                let constants = $constants::<$scalar>::new(&params, [l1 * l1, lc1 * lc1, lc2 * lc2]);
                let State { theta1, theta2, dtheta1, dtheta2 } = state;
                let y = [theta1, theta2, dtheta1, dtheta2];
                Ok(Self::from_model(Model { params, constants }, y))
            }
        }
    )*};
}

const_new! {
    Reference, f64, GymnasiumConstants;
    Portable, f64, LeanConstants;
    Fast, f32, LeanConstants;
    Micro, f32, LeanConstants;
}
