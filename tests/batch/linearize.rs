//! The derivatives of a step are those of its numbers, by lanes as alone.

use acrobot::arithmetic::{Arithmetic, Damped, Real, Reference};
use acrobot::batch::{SimdLevel, VecBatch};
use acrobot::control::model::StepModel;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Params, Portable, State};

const ZERO: StepModel = StepModel { a: [[0.0; 4]; 4], b: [0.0; 4] };

/// The parameters, the state and the torque of an acrobot.
type Case = (Params, State, f64);

/// Many velocities meet their bounds.
fn cases(count: usize) -> Vec<Case> {
    let mut rng = Pcg64::new(7);
    let mut draw = |low, high| uniform(&mut rng, low, high);
    (0..count)
        .map(|_| {
            let mut params = Params { dt: 0.1, ..Params::DEFAULT };
            let [links @ .., _, _, _, _, _, _, b1, b2, c1, c2, rotor] = params.numbers_mut();
            links.into_iter().for_each(|x| *x *= draw(0.5, 1.5));
            [b1, b2, c1, c2, rotor].into_iter().for_each(|x| *x = draw(0.01, 0.1));
            (params.max_velocity1, params.max_velocity2) = (3.0, 3.0);
            let state = State::from([0; 4].map(|_| draw(-4.0, 4.0)));
            (params, state, draw(-2.0, 2.0))
        })
        .collect()
}

fn batch<A: Arithmetic>(cases: &[Case]) -> VecBatch<A> {
    let mut batch = VecBatch::<A>::new(0, cases.len()).unwrap();
    batch.own_params().unwrap();
    for (index, (params, state, _)) in cases.iter().enumerate() {
        batch.set_params(index, params.cast()).unwrap();
        batch.set_state(index, state.cast()).unwrap();
    }
    batch
}

/// A and B, the derivatives by the parameters, and the states after the step.
type Results = (Vec<StepModel>, Vec<Params<[f64; 4]>>, Vec<[f64; 4]>);

fn results<A: Arithmetic<Scalar = f64>>(cases: &[Case]) -> Results {
    let mut batch = batch::<A>(cases);
    let torques: Vec<_> = cases.iter().map(|(_, _, torque)| *torque).collect();
    let mut models = vec![ZERO; cases.len()];
    let mut by_params = vec![Params::<f64>::DEFAULT.map(|_| [0.0; 4]); cases.len()];
    batch.linearize_step_into(&torques, &mut models, Some(&mut by_params)).unwrap();
    batch.step(&torques).unwrap();
    let next = (0..cases.len()).map(|index| batch.state(index).unwrap().into());
    (models, by_params, next.collect())
}

fn have_the_bits_of_one_alone<A: Arithmetic>() {
    let cases = cases(37);
    let mut batch = batch::<A>(&cases);
    let torques: Vec<_> = cases.iter().map(|(_, _, torque)| A::Scalar::from_f64(*torque)).collect();
    let zero = A::Scalar::ZERO;
    let mut models = vec![StepModel { a: [[zero; 4]; 4], b: [zero; 4] }; 37];
    let mut first = None;
    let mut clamped = 0;
    for level in [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512] {
        batch.set_simd_level(level);
        let mut by_params = vec![Params::<f64>::DEFAULT.map(|_| [zero; 4]); 37];
        batch.linearize_step_into(&torques, &mut models, Some(&mut by_params)).unwrap();
        assert_eq!(*first.get_or_insert(by_params.clone()), by_params);
        for (((params, state, _), torque), model) in cases.iter().zip(&torques).zip(&models) {
            let alone = Pendulum::<A>::new(params.cast(), state.cast()).unwrap();
            assert_eq!(alone.linearize_step(*torque).unwrap(), *model);
            clamped += usize::from(model.a[3] == [zero; 4]);
        }
    }
    assert!((9..90).contains(&clamped), "{clamped}");
}

#[test]
fn derivatives_by_lanes_have_the_bits_of_one_alone() {
    have_the_bits_of_one_alone::<Damped<Fast>>();
    have_the_bits_of_one_alone::<Damped<Portable>>();
    have_the_bits_of_one_alone::<Damped<Reference>>();
}

/// Also by dt and by the bounds of the velocities.
#[test]
fn derivatives_are_those_of_differences() {
    const H: f64 = 1e-6;
    let cases = cases(300);
    let (models, by_params, _) = results::<Damped<Portable>>(&cases);
    let difference = |change: &dyn Fn(&mut Case, f64)| {
        let [more, less] = [H, -H].map(|h| {
            let mut changed = cases.clone();
            changed.iter_mut().for_each(|case| change(case, h));
            results::<Damped<Portable>>(&changed).2
        });
        more.into_iter().zip(less).map(|(x, y)| {
            let [[x1, x2, x3, x4], [y1, y2, y3, y4]] = [x, y];
            [x1 - y1, x2 - y2, x3 - y3, x4 - y4].map(|x| x / (2.0 * H))
        })
    };
    let check = |name: &str, found: [f64; 4], expected: [f64; 4]| {
        for (x, y) in found.iter().zip(expected) {
            assert!((x - y).abs() < 1e-6 * y.abs().max(1.0), "{name}: {found:?}, {expected:?}");
        }
    };
    for place in 0..4 {
        let by_state = difference(&|(_, state, _), h| {
            let mut x: [f64; 4] = (*state).into();
            x[place] += h;
            *state = x.into();
        });
        for (model, expected) in models.iter().zip(by_state) {
            check("state", model.a.map(|row| row[place]), expected);
        }
    }
    for (model, expected) in models.iter().zip(difference(&|(_, _, torque), h| *torque += h)) {
        check("torque", model.b, expected);
    }
    let names = Params::<f64>::DEFAULT.numbers().map(|(name, _)| name);
    for (place, name) in names.into_iter().enumerate().filter(|(_, name)| *name != "torque_noise") {
        let by_number = difference(&|(params, ..), h| *params.numbers_mut()[place] += h);
        for (found, expected) in by_params.iter().zip(by_number) {
            check(name, found.numbers()[place].1, expected);
        }
    }
}

#[test]
fn bad_input_is_rejected() {
    let batch = VecBatch::<Portable>::new(0, 3).unwrap();
    let mut models = [ZERO; 3];
    let error = batch.linearize_step_into(&[0.0; 2], &mut models, None).unwrap_err();
    assert_eq!(error, Error::WrongLength { name: "torques", len: 2, expected: 3 });
    let error = batch.linearize_step_into(&[0.0; 3], &mut models[..2], None).unwrap_err();
    assert_eq!(error, Error::WrongLength { name: "models", len: 2, expected: 3 });
    let error = batch.linearize_step_into(&[0.0; 3], &mut models, Some(&mut [])).unwrap_err();
    assert_eq!(error, Error::WrongLength { name: "by_params", len: 0, expected: 3 });
    let error = batch.linearize_step_into(&[0.0, f64::NAN, 0.0], &mut models, None).unwrap_err();
    assert_eq!(error.to_string(), "torque must be a finite number of N m, got NaN");
    assert_eq!(models, [ZERO; 3]);
    let mut batch = batch;
    batch.set_state(2, State { dtheta1: 1e200, ..State::HANGING }).unwrap();
    let error = batch.linearize_step_into(&[0.0; 3], &mut models, None).unwrap_err();
    assert_eq!(error.name(), "a");
}
