//! Gains equal SciPy's and those of 200 digits. Weights and models without a regulator are errors.

use std::array::from_fn;

use acrobot::arithmetic::Real;
use acrobot::control::model::StepModel;
use acrobot::control::regulator::{Lqr, dlqr};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, Portable, State};
use common::{lines, numbers, text_of};

use crate::{cast, relative, vector};

pub fn matrix(elements: &[f64]) -> [[f64; 4]; 4] {
    elements.as_chunks().0.try_into().unwrap()
}

pub fn diagonal(x: [f64; 4]) -> [[f64; 4]; 4] {
    from_fn(|i| from_fn(|j| if i == j { x[i] } else { 0.0 }))
}

pub const IDENTITY: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The regulator of A, B, Q and R, as a line of the recording has them.
fn regulate<S: Real>(x: &[f64]) -> Lqr<S> {
    let [a, q] = [&x[..16], &x[20..36]].map(|m| matrix(m).map(cast));
    let b = cast(vector(&x[16..20]));
    dlqr(&StepModel { a, b }, &q, S::from_f64(x[36])).unwrap()
}

#[test]
fn gains_equal_scipys() {
    /// The errors of the gain and of the cost to go.
    fn errors<S: Real>(x: &[f64]) -> [f64; 2] {
        let Lqr { gain, cost_to_go } = regulate::<S>(&x[2..39]);
        let columns: [[S; 4]; 4] = from_fn(|j| cost_to_go.map(|row| row[j]));
        assert_eq!(cost_to_go, columns, "not symmetric");
        [relative(&gain, &x[39..43]), relative(cost_to_go.as_flattened(), &x[43..])]
    }
    let text = text_of("tests/data/control.txt");
    let count = lines(&text, "lqr").count();
    assert_eq!(count, 32, "rows `lqr` in tests/data/control.txt: edit this count");
    for x in lines(&text, "lqr").map(numbers) {
        let (double, single) = (errors::<f64>(&x), errors::<f32>(&x));
        assert!(double.into_iter().all(|error| error < 1e-11), "{double:?}");
        // The elements of A are rounded to 6e-8, and those that matter are about dt.
        let limit = if x[1] < 0.01 { 5e-3 } else { 1e-3 };
        assert!(single.into_iter().all(|error| error < limit), "{single:?}");
    }
}

/// All numbers are exact in both scalars, so only the gain is rounded.
#[test]
fn gains_are_exact_over_many_decades() {
    fn check<S: Real>(limit: f64) {
        let text = text_of("tests/data/control.txt");
        let mut count = 0;
        for line in lines(&text, "model") {
            let (_, given) = line.split_once(' ').unwrap();
            let mut x = numbers(given);
            // Short texts of `f32`.
            x[..37].iter_mut().for_each(|x| *x = f64::from(*x as f32));
            let error = relative(&regulate::<S>(&x).gain, &x[37..]);
            assert!(error < limit, "{error:e} {line}");
            count += 1;
        }
        assert_eq!(count, 340, "models in tests/data/control.txt: edit this count");
    }
    check::<f64>(1e-13);
    check::<f32>(1e-7);
}

/// By hand or with 200 digits.
#[test]
fn gains_of_special_models_are_exact() {
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    // The smallest number of `b` belongs to a row of zeros, so the other gains must not depend on
    // it.
    let small = |effect| {
        let a = [[1.0, 0.0, 0.1, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0; 4]];
        let gain = [0.9317451415095747, 0.0, 1.3650971698084902, 1.2719226556575325];
        (a, [0.005, 0.0, 0.1, effect], diagonal([1.0, 0.0, 0.0, 0.0]), gain)
    };
    for (a, b, q, expected) in [
        small(1e-16),
        small(1e-300),
        // The doubling divides by a pivot that is small unless rows are exchanged.
        (
            [[1e4, 0.0, 0.01, 0.0], [0.0; 4], [1e4, 0.0, 0.0, 0.0], [0.0; 4]],
            [0.0, 0.0, 100.0, 0.0],
            IDENTITY,
            [100_000_099.009_999, 0.0, 99.99999900999901, 0.0],
        ),
        // Without weights the cheapest gain mirrors 1.1 in the unit circle: 1.1 − k = 1 / 1.1.
        (diagonal([1.1, 0.5, 0.4, 0.3]), all, none, [1.1 - 1.0 / 1.1, 0.0, 0.0, 0.0]),
        // Elements below 1, whose powers grow as 1.2.
        ([[0.3; 4]; 4], all, none, [(1.2 - 1.0 / 1.2) / 4.0; 4]),
        (diagonal([0.5; 4]), all, none, [0.0; 4]),
        (diagonal([0.5; 4]), [0.0; 4], IDENTITY, [0.0; 4]),
        (none, all, IDENTITY, [0.0; 4]),
    ] {
        let found = dlqr(&StepModel { a, b }, &q, 1.0).unwrap().gain;
        assert!(found == expected || relative(&found, &expected) < 1e-14, "{found:?}");
    }
}

#[test]
fn the_unit_of_the_weights_changes_no_digit() {
    let model = StepModel { a: diagonal([0.5, 0.4, 0.3, 0.2]), b: [1.0; 4] };
    let of = |unit: f64| dlqr(&model, &IDENTITY.map(|row| row.map(|x| x * unit)), unit);
    let gain = of(1.0).unwrap().gain;
    for exponent in [-1000, -1, 1, 1023] {
        assert_eq!(of(2.0_f64.powi(exponent)).unwrap().gain, gain);
    }
}

/// Rounded to `f32`, the exact gain of a motion that grows by 1e9 a step no longer stops it.
#[test]
fn a_gain_that_rounding_makes_useless_is_an_error() {
    fn found<S: Real>() -> Result<(), Error> {
        let a = diagonal([1e9, 0.5, 0.4, 0.3]).map(cast::<S, 4>);
        let b = cast([0.3, 0.0, 0.0, 0.0]);
        let q = IDENTITY.map(cast);
        dlqr(&StepModel { a, b }, &q, S::from_f64(1.0)).map(drop)
    }
    assert_eq!(found::<f64>(), Ok(()));
    let error = f64::from(f32::EPSILON);
    assert_eq!(found::<f32>(), Err(Error::IllConditioned { error }));
}

/// Motions that grow by nearly the same factor need large gains, whose rounding matters. Costs far
/// below that of the torque would underflow.
#[test]
fn a_gain_that_rounding_spoils_is_an_error() {
    let growing = |factor| diagonal([2.0, factor, 0.5, 0.4]);
    let found = |a, weight| {
        let model = StepModel { a, b: [1.0; 4] };
        match dlqr(&model, &diagonal([weight; 4]), 1.0) {
            Ok(_) => 0.0,
            Err(Error::IllConditioned { error }) => error,
            Err(other) => panic!("{other}"),
        }
    };
    assert_eq!(found(growing(2.00005), 1.0), 0.0);
    assert!((1e-9..1e-7).contains(&found(growing(2.00002), 1.0)));
    assert_eq!(found(growing(3.0), 1e-249), 0.0);
    assert_eq!(found(growing(3.0), 1e-251), 1.0);
}

pub fn upright() -> StepModel {
    Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT).unwrap().linearize_step(0.0).unwrap()
}

#[test]
fn wrong_weights_are_rejected() {
    let message = |q, r| dlqr(&upright(), &q, r).unwrap_err().to_string();
    for (r, got) in [(0.0, "0"), (-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let expected = format!("r must be finite and above 0 per (N m)², got {got}");
        assert_eq!(message(IDENTITY, r), expected);
    }
    assert_eq!(
        message(diagonal([1.0, f64::NAN, 1.0, 1.0]), 1.0),
        "q must be finite in each element, got NaN"
    );
    let mut q = IDENTITY;
    q[1][3] = 0.5;
    assert_eq!(message(q, 1.0), "q must be symmetric, got 0.5 and 0 on both sides of the diagonal");
    q[3][1] = 0.5;
    assert!(dlqr(&upright(), &q, 1.0).is_ok());
    [q[1][3], q[3][1]] = [2.0, 2.0];
    let rule = "q must be positive semidefinite, got ";
    assert!(message(q, 1.0).starts_with(rule));
    assert!(message(diagonal([1.0, 1.0, -1e-3, 1.0]), 1.0).starts_with(rule));
    assert!(message(diagonal([-1.0; 4]), 1.0).starts_with(rule));

    // A tenth of a millionth is more than rounding in `f64`, and less in `f32`.
    [q[1][3], q[3][1]] = [0.5, 0.5 + 1e-7];
    assert!(message(q, 1.0).starts_with("q must be symmetric, got 0.5 and 0.5000001 on both"));
    let model = upright();
    let single = StepModel { a: model.a.map(cast::<f32, 4>), b: cast(model.b) };
    assert!(dlqr(&single, &q.map(cast), 1.0).is_ok());

    // Of rank 1, and so up to rounding.
    let row = [0.1, 0.7, -0.3, 0.9];
    assert!(dlqr(&upright(), &row.map(|x| row.map(|y| x * y)), 1.0).is_ok());
}

/// Weights of the outputs G x are G W Gᵀ, which most products round to a matrix that is not quite
/// symmetric. Both triangles give the same gain up to rounding.
#[test]
fn products_are_weights() {
    fn product<S: Real>(x: [[S; 4]; 4], y: [[S; 4]; 4]) -> [[S; 4]; 4] {
        let element = |i: usize, j: usize| (0..4).fold(S::ZERO, |sum, k| sum + x[i][k] * y[k][j]);
        from_fn(|i| from_fn(|j| element(i, j)))
    }
    fn check<S: Real>(limit: f64) {
        let mut rng = Pcg64::new(5);
        let mut skew = 0;
        for _ in 0..1000 {
            let mut number = |low| S::from_f64(uniform(&mut rng, low, 1.0));
            let g: [[S; 4]; 4] = from_fn(|_| from_fn(|_| number(-1.0)));
            let weights = from_fn(|i| from_fn(|j| if i == j { number(0.0) } else { S::ZERO }));
            let q = product(product(g, weights), from_fn(|i| from_fn(|j| g[j][i])));
            let transposed = from_fn(|i| from_fn(|j| q[j][i]));
            skew += u32::from(q != transposed);
            let StepModel { a, b } = upright();
            let model = StepModel { a: a.map(cast), b: cast(b) };
            let gain = |q| {
                let Lqr { gain, cost_to_go } = dlqr(&model, &q, S::from_f64(1.0)).unwrap();
                assert_eq!(cost_to_go, from_fn(|i| from_fn(|j| cost_to_go[j][i])));
                gain
            };
            let [found, other] = [gain(q), gain(transposed)];
            assert!(relative(&found, &other.map(S::to_f64)) <= limit);
        }
        assert!(skew > 500, "{skew}");
    }
    check::<f64>(1e-13);
    check::<f32>(1e-6);
}

#[test]
fn a_regulator_that_cannot_exist_is_an_error() {
    let growing = diagonal([1.1, 0.5, 0.4, 0.3]);
    let persistent = diagonal([1.0, 0.5, 0.4, 0.3]);
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    let not_first = [0.0, 1.0, 1.0, 1.0];
    let (stabilizable, detectable) = (Error::NotStabilizable, Error::NotDetectable);
    for (a, b, q, expected) in [
        (growing, not_first, IDENTITY, stabilizable),
        (persistent, not_first, IDENTITY, stabilizable),
        (growing, [0.0; 4], IDENTITY, stabilizable),
        (diagonal([1.1, 1.1, 0.5, 0.3]), all, IDENTITY, stabilizable),
        (persistent, all, none, detectable),
        (diagonal([1.0, 1.5, 0.5, 0.5]), all, diagonal([0.0, 1.0, 1.0, 1.0]), detectable),
        // Their powers leave the range in which `f64` adds exactly.
        (
            [
                [2.0, -0.0625, 16.0, -49152.0],
                [0.0, 1.0, 256.0, -786432.0],
                [0.0, 0.0, -1.0, 8192.0],
                [0.0, 0.0, -0.00048828125, 3.0],
            ],
            [128.0, 1024.0, 0.0, 0.0],
            diagonal([5000.0, 20.0, 200.0, 10.0]),
            stabilizable,
        ),
    ] {
        let error = dlqr(&StepModel { a, b }, &q, 1.0).unwrap_err();
        assert_eq!(error, expected, "{a:?} {b:?} {q:?}");
    }

    // A link on its centre of mass: gravity and the motor do not move link 1.
    let params =
        Params { center_of_mass1: 0.0, center_of_mass2: 0.0, gravity: 0.0, ..Params::DEFAULT };
    let pendulum = Pendulum::<Portable>::new(params, State::HANGING).unwrap();
    let model = pendulum.linearize_step(0.0).unwrap();
    let error = dlqr(&model, &IDENTITY, 1.0).unwrap_err();
    assert_eq!(error, Error::NotStabilizable);

    // What `f32` cannot hold has a name.
    let model = StepModel { a: growing.map(cast::<f32, 4>), b: [1e-30; 4] };
    let error = dlqr(&model, &IDENTITY.map(cast), 1.0).unwrap_err();
    assert_eq!(error.to_string(), "cost_to_go must be finite in each element, got inf");
}
