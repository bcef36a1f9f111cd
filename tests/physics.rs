//! The equations of motion are right: both forms agree with each other and with Lagrange's
//! equations.

use acrobot::arithmetic::{Arithmetic, Damped, Form, Reference};
use acrobot::batch::VecBatch;
use acrobot::env::{AcrobotEnv, RenderMode};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::{Dynamics, ParamsRange, Pendulum, Viscous};
use acrobot::{Acrobot, Fast, Observation, Params, Portable, State, TimeLimit};

/// `Portable`'s scalar and sines with Gymnasium's form of the equations, where `Portable` has the
/// lean one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct GymnasiumF64;

impl Arithmetic for GymnasiumF64 {
    const NAME: &'static str = "gymnasium f64";
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    fn sin_cos(x: f64) -> (f64, f64) {
        Portable::sin_cos(x)
    }
}

/// Random parameters, states and torques.
fn random_cases() -> impl Iterator<Item = (Params, State, f64)> {
    let mut rng = Pcg64::new(1);
    let mut draw = move |low, high| uniform(&mut rng, low, high);
    (0..10_000).map(move |_| {
        let params = Params {
            length1: draw(0.2, 3.0),
            length2: draw(0.2, 3.0),
            mass1: draw(0.2, 5.0),
            mass2: draw(0.2, 5.0),
            center_of_mass1: draw(0.0, 2.0),
            center_of_mass2: draw(0.0, 2.0),
            inertia1: draw(0.1, 3.0),
            inertia2: draw(0.1, 3.0),
            gravity: draw(-20.0, 20.0),
            ..Params::DEFAULT
        };
        params.validate().unwrap();
        let state =
            State::from([draw(-4.0, 4.0), draw(-4.0, 4.0), draw(-12.0, 12.0), draw(-28.0, 28.0)]);
        (params, state, draw(-5.0, 5.0))
    })
}

/// The largest |x − y|, relative to the largest number of both.
fn relative(x: [f64; 2], y: [f64; 2]) -> f64 {
    let scale = x.into_iter().chain(y).fold(1.0, |scale: f64, z| scale.max(z.abs()));
    (x[0] - y[0]).abs().max((x[1] - y[1]).abs()) / scale
}

fn accelerations<A: Arithmetic<Scalar = f64>>(
    params: &Params,
    state: &State,
    torque: f64,
) -> [f64; 2] {
    let pendulum = Pendulum::<A>::new(*params, *state).unwrap();
    let [_, _, ddtheta1, ddtheta2] = pendulum.derivative(torque);
    [ddtheta1, ddtheta2]
}

/// Hundreds of roundings of terms that are up to a thousand times the result.
const ROUNDING: f64 = 1e-11;

/// A number with its derivatives in two directions and the mixed second derivative: automatic
/// differentiation for the Lagrangian below, which uses none of the crate's equations.
#[derive(Clone, Copy)]
struct HyperDual([f64; 4]);

impl HyperDual {
    fn constant(x: f64) -> Self {
        Self([x, 0.0, 0.0, 0.0])
    }

    /// f of this number, from the value and the first two derivatives of f.
    fn map(self, f: f64, first: f64, second: f64) -> Self {
        let [_, a, b, ab] = self.0;
        Self([f, first * a, first * b, first * ab + second * a * b])
    }

    fn sin(self) -> Self {
        let (sin, cos) = Portable::sin_cos(self.0[0]);
        self.map(sin, cos, -sin)
    }

    fn cos(self) -> Self {
        let (sin, cos) = Portable::sin_cos(self.0[0]);
        self.map(cos, -sin, -cos)
    }
}

impl std::ops::Add for HyperDual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl std::ops::Mul for HyperDual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([x, xa, xb, xab], [y, ya, yb, yab]) = (self.0, other.0);
        Self([x * y, xa * y + x * ya, xb * y + x * yb, xab * y + xa * yb + xb * ya + x * yab])
    }
}

/// Kinetic minus potential energy, from the positions and velocities of the two centres of mass.
fn lagrangian(p: &Params, [theta1, theta2, dtheta1, dtheta2]: [HyperDual; 4]) -> HyperDual {
    let number = HyperDual::constant;
    let (absolute, turning) = (theta1 + theta2, dtheta1 + dtheta2);
    // Velocities of the centres of mass, horizontal and vertical.
    let speed1 = number(p.center_of_mass1) * dtheta1;
    let across = number(p.length1) * theta1.cos() * dtheta1
        + number(p.center_of_mass2) * absolute.cos() * turning;
    let up = number(p.length1) * theta1.sin() * dtheta1
        + number(p.center_of_mass2) * absolute.sin() * turning;
    let twice_kinetic = number(p.mass1) * speed1 * speed1
        + number(p.mass2) * (across * across + up * up)
        + number(p.inertia1) * dtheta1 * dtheta1
        + number(p.inertia2) * turning * turning;
    let height1 = number(-p.center_of_mass1) * theta1.cos();
    let height2 = number(-p.length1) * theta1.cos() + number(-p.center_of_mass2) * absolute.cos();
    let potential = number(p.gravity) * (number(p.mass1) * height1 + number(p.mass2) * height2);
    number(0.5) * twice_kinetic + number(-1.0) * potential
}

/// The Lagrangian's value, its derivatives along the i-th and the j-th of (θ1, θ2, θ̇1, θ̇2), and
/// the second derivative along both.
fn differentiate(p: &Params, y: [f64; 4], i: usize, j: usize) -> [f64; 4] {
    let along = |k, axis| f64::from(u8::from(k == axis));
    lagrangian(p, std::array::from_fn(|k| HyperDual([y[k], along(k, i), along(k, j), 0.0]))).0
}

/// Lagrange's equations: d/dt ∂L/∂θ̇ − ∂L/∂θ = (0, torque), that is
/// (∂²L/∂θ̇∂θ̇) θ̈ = (0, torque) + ∂L/∂θ − (∂²L/∂θ̇∂θ) θ̇.
#[test]
fn the_books_equations_equal_lagranges() {
    for (params, state, torque) in random_cases() {
        let y = <[f64; 4]>::from(state);
        let mixed = |i, j| differentiate(&params, y, i, j)[3];
        let force = |i: usize| {
            [0.0, torque][i] + differentiate(&params, y, i, i)[1]
                - mixed(i + 2, 0) * y[2]
                - mixed(i + 2, 1) * y[3]
        };
        let mass = [[mixed(2, 2), mixed(2, 3)], [mixed(3, 2), mixed(3, 3)]];
        let determinant = mass[0][0] * mass[1][1] - mass[0][1] * mass[1][0];
        let expected = [
            (mass[1][1] * force(0) - mass[0][1] * force(1)) / determinant,
            (mass[0][0] * force(1) - mass[1][0] * force(0)) / determinant,
        ];
        for (name, found) in [
            ("Gymnasium's", accelerations::<GymnasiumF64>(&params, &state, torque)),
            ("lean", accelerations::<Portable>(&params, &state, torque)),
        ] {
            let error = relative(found, expected);
            assert!(error <= ROUNDING, "{name}: {error:e}: {params:?} {state:?}");
        }

        let pendulum = Pendulum::<Portable>::new(params, state).unwrap();
        let ours = pendulum.mass_matrix();
        assert!(relative(ours[0], mass[0]).max(relative(ours[1], mass[1])) <= ROUNDING);
        // The energy is θ̇ ∂L/∂θ̇ − L.
        let [value, momentum1, momentum2, _] = differentiate(&params, y, 2, 3);
        let expected = momentum1 * y[2] + momentum2 * y[3] - value;
        assert!(relative([pendulum.energy(), 0.0], [expected, 0.0]) <= ROUNDING);
    }
}

/// M (θ̈ of the paper − θ̈ of the book) = (0, m2 l1 lc2 θ̇1² sin θ2).
#[test]
fn the_papers_equations_lack_one_term() {
    fn check<A: Arithmetic<Scalar = f64>>(params: Params, state: State, torque: f64) {
        let of = |dynamics| accelerations::<A>(&Params { dynamics, ..params }, &state, torque);
        let (book, nips) = (of(Dynamics::Book), of(Dynamics::Nips));
        let term = params.mass2
            * params.length1
            * params.center_of_mass2
            * state.dtheta1
            * state.dtheta1
            * A::sin_cos(state.theta2).0;
        let pendulum = Pendulum::<A>::new(params, state).unwrap();
        let [book, nips] = [book, nips].map(|accelerations| torques(&pendulum, accelerations));
        let error = relative(nips, [book[0], book[1] + term]);
        assert!(error <= ROUNDING, "{error:e}: {params:?} {state:?}");
    }
    for (params, state, torque) in random_cases() {
        check::<Portable>(params, state, torque);
        check::<GymnasiumF64>(params, state, torque);
    }
}

/// M θ̈.
fn torques<A: Arithmetic<Scalar = f64>>(pendulum: &Pendulum<A>, [a, b]: [f64; 2]) -> [f64; 2] {
    pendulum.mass_matrix().map(|[m1, m2]| m1 * a + m2 * b)
}

/// M (θ̈ with friction − θ̈ without) = −(b1 θ̇1, b2 θ̇2), in both forms of the equations.
#[test]
fn friction_resists_the_velocity_of_each_joint() {
    fn check<A: Arithmetic<Scalar = f64>>((params, state, torque): (Params, State, f64)) {
        let without = accelerations::<A>(&params, &state, torque);
        let friction = Viscous { joint1: 0.3, joint2: 0.7 };
        let params = Params { friction, ..params };
        let with = accelerations::<Damped<A>>(&params, &state, torque);
        let pendulum = Pendulum::<Damped<A>>::new(params, state).unwrap();
        let [with, without] = [with, without].map(|x| torques(&pendulum, x));
        let resistance = [0.3 * state.dtheta1, 0.7 * state.dtheta2];
        let expected = [without[0] - resistance[0], without[1] - resistance[1]];
        let error = relative(with, expected);
        assert!(error <= ROUNDING, "{error:e}: {params:?} {state:?}");
    }
    for (params, state, torque) in random_cases() {
        for dynamics in [Dynamics::Book, Dynamics::Nips] {
            let case = (Params { dynamics, ..params }, state, torque);
            check::<Portable>(case);
            check::<Reference>(case);
            check::<GymnasiumF64>(case);
        }
    }
}

#[test]
fn an_arithmetic_without_friction_rejects_it() {
    let rule = "friction.joint2 must be 0 in an arithmetic without friction, in N m s/rad, got 0.5";
    let friction = Viscous { joint1: -0.0, joint2: 0.5 };
    let (with, without) = (Params { friction, ..Params::DEFAULT }, Params::DEFAULT);
    let range = ParamsRange::new(without, with).unwrap();
    let mut pendulum = Pendulum::<Portable>::hanging();
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(0));
    let mut batch = VecBatch::<Portable>::with_own_params(SeedSequence::new(0), 2).unwrap();
    let mut shared = VecBatch::<Portable>::new(SeedSequence::new(0), 2).unwrap();
    let mut member = batch.member(0).unwrap();
    member.params = with;
    let before =
        (pendulum.clone(), acrobot.clone(), batch.member(1), batch.params_range().copied());
    for result in [
        Pendulum::<Portable>::new(with, State::HANGING).map(drop),
        with.pendulum::<Portable>(State::HANGING).map(drop),
        pendulum.set_params(with),
        Acrobot::<Reference>::with_params(0, with).map(drop),
        acrobot.set_params(with),
        acrobot.inner_mut().set_params(with),
        shared.set_params(with),
        batch.set_params(with),
        batch.set_params_of(1, with),
        batch.set_member(1, member),
        batch.set_params_range(Some(range)),
        AcrobotEnv::<Fast, Observation>::new(with, RenderMode::None).map(drop),
    ] {
        assert_eq!(result.unwrap_err().to_string(), rule);
    }
    let after = (pendulum, acrobot, batch.member(1), batch.params_range().copied());
    assert_eq!(after, before);
}
