//! The environments that `make_with` makes, with any options and calls in any order.

#![no_main]

use acrobot::env::{
    ArithmeticKind, Display, DynEnv, Env, Error, Options, RenderMode, Rendering, Space, make_with,
};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ResetBounds;
use acrobot::{Action, ResetOptions};
use acrobot_fuzz::{number, params, state};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut u = Unstructured::new(bytes);
    let _ = sequence(&mut u);
});

fn sequence(u: &mut Unstructured<'_>) -> Result<()> {
    use ArithmeticKind::{Fast, Host, Micro, Portable, Reference};
    let options = Options {
        render_mode: match u.arbitrary()? {
            0_u8..=250 => RenderMode::Ansi,
            251 => RenderMode::RgbArray,
            252 => RenderMode::Human(Display::new(|frame| assert_eq!(frame.height(), 500))),
            _ => RenderMode::None,
        },
        arithmetic: *u.choose(&[Host, Reference, Portable, Fast, Micro])?,
        params: params(u)?,
    };
    let valid = options.params.validate().is_ok();
    let mut env = match make_with(u.choose(&["Acrobot-v0", "Acrobot-v1"])?, options.clone()) {
        Ok(env) => env,
        Err(error) => {
            assert!(matches!(error, Error::Invalid(_)), "{error}");
            // Valid parameters can be invalid as f32.
            assert!(
                !valid || matches!(options.arithmetic, Fast | Micro),
                "{error}"
            );
            return Ok(());
        }
    };
    assert!(valid);
    let mut rng = Pcg64::new(0);
    // In mode `Human` each call shows a frame of 250,000 pixels.
    let calls = match options.render_mode {
        RenderMode::Human(_) => 2,
        _ => 16,
    };
    for _ in 0..calls {
        if u.is_empty() {
            break;
        }
        match u.int_in_range(0..=6)? {
            0 => {
                let seed = u.arbitrary::<Option<[u32; 3]>>()?;
                let bounds = ResetBounds::new(number(u, -0.1)?, number(u, 0.1)?);
                let seed = seed.map(|words| SeedSequence::from_words(&words));
                let (observation, _) = env.reset_with(ResetOptions {
                    seed,
                    bounds: bounds.ok(),
                });
                let finite = observation.as_slice().iter().all(|x| x.is_finite());
                assert!(finite, "{observation:?}");
            }
            1 => {
                let before = env.unwrapped().params();
                let params = params(u)?;
                match env.unwrapped_mut().set_params(params) {
                    Ok(()) => assert!(params.validate().is_ok()),
                    Err(_) => assert_eq!(env.unwrapped().params(), before),
                }
            }
            2 => {
                let before = env.unwrapped().state();
                if env.unwrapped_mut().set_state(state(u)?).is_err() {
                    assert_eq!(env.unwrapped().state(), before);
                }
            }
            // Rendering takes most of the time and changes nothing, so it is last.
            3 => return show(&mut *env),
            4 => env.close(),
            _ => {
                let step = env.step(*u.choose(&Action::ALL)?);
                let space = env.observation_space();
                assert!(space.contains(&step.observation), "{step:?} {space:?}");
                let _ = space.sample(&mut rng);
            }
        }
    }
    Ok(())
}

fn show(env: &mut DynEnv) -> Result<()> {
    match env.render() {
        Ok(Rendering::Frame(frame)) => assert_eq!(frame.bytes().len(), 500 * 500 * 3),
        Ok(Rendering::Text(text)) => {
            assert_eq!(text.lines().count(), 21);
            assert!(!text.contains("NaN"), "{text}");
        }
        Ok(other) => assert_eq!(other, Rendering::Shown),
        Err(error) => assert_eq!(error, Error::NoRenderMode),
    }
    Ok(())
}
