//! A snapshot resumes to the same bits, and one that is not valid is refused.

use acrobot::{Acrobot, Action, LimitedStep, Params, Portable, TimeLimit};

/// An acrobot in the middle of an episode with noise, and its generator between two halves.
fn busy() -> TimeLimit<Acrobot<Portable>> {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(u64::MAX));
    let inner = acrobot.inner_mut();
    inner
        .set_params(Params {
            torque_noise: 0.1,
            mass2: 1.5,
            ..Params::DEFAULT
        })
        .unwrap();
    Action::sample(inner.rng_mut());
    for _ in 0..10 {
        acrobot.step(Action::Positive);
    }
    acrobot
}

fn run(acrobot: &mut TimeLimit<Acrobot<Portable>>) -> Vec<LimitedStep> {
    (0..100)
        .map(|_| {
            let action = Action::sample(acrobot.inner_mut().rng_mut());
            acrobot.step(action)
        })
        .collect()
}

#[test]
fn snapshots_resume_to_the_same_bits() {
    let mut original = busy();
    let json = serde_json::to_string(&original).unwrap();
    let bytes = postcard::to_stdvec(&original).unwrap();
    let mut resumed = [
        original.clone(),
        serde_json::from_str(&json).unwrap(),
        postcard::from_bytes(&bytes).unwrap(),
    ];
    let expected = run(&mut original);
    for resumed in &mut resumed {
        assert_eq!(run(resumed), expected);
        assert_eq!(*resumed, original);
    }
}

#[test]
fn snapshots_that_are_not_valid_are_refused() {
    let text = serde_json::to_string(&busy()).unwrap();
    assert!(serde_json::from_str::<TimeLimit<Acrobot<Portable>>>(&text).is_ok());

    let refuse = |from: &str, to: &str, reason: &str| {
        assert!(text.contains(from), "{from} in {text}");
        let broken = text.replacen(from, to, 1);
        let error = serde_json::from_str::<TimeLimit<Acrobot<Portable>>>(&broken)
            .unwrap_err()
            .to_string();
        assert!(error.contains(reason), "{error}");
    };
    refuse("\"mass2\":1.5", "\"mass2\":-1.5", "mass2 is -1.5 kg");
    refuse("\"limit\":500", "\"limit\":0", "nonzero");
    refuse("\"dynamics\":\"Book\"", "\"dynamics\":\"Film\"", "Film");
    let start = text.find("\"increment\":").unwrap() + "\"increment\":".len();
    let increment: u128 = text[start..].split(',').next().unwrap().parse().unwrap();
    let (odd, even) = (increment.to_string(), (increment - 1).to_string());
    refuse(&odd, &even, "allowed is an odd number");

    // JSON has no NaN; a binary format has.
    let acrobot = Acrobot::<Portable>::new(0);
    let state = postcard::to_stdvec(&acrobot.state()).unwrap();
    let mut bytes = postcard::to_stdvec(&acrobot).unwrap();
    let at = bytes
        .windows(state.len())
        .position(|window| window == state)
        .unwrap();
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(postcard::from_bytes::<Acrobot<Portable>>(&bytes).is_err());
}
