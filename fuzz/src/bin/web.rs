//! Calls to the exports of the WebAssembly module, in any order with any numbers.
//!
//! The module is compiled for this machine. Its state is global, so each input resets it. Only the learners stay,
//! because the module can make them only once.

#![no_main]

use acrobot_web::memory::BUFFER;
use acrobot_web::{learner, picture, policies, simulation, speed};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    assert_eq!(simulation::set_params(0, 0.2, 1.0, 1.0, 1.0, 1.0, 9.8), 0);
    simulation::reset(0);
    picture::resize(0, 0);
    picture::paint(1, 2, 3, 4);
    BUFFER.borrow().fill(0);
    let mut u = Unstructured::new(bytes);
    let _ = sequence(&mut u);
});

fn sequence(u: &mut Unstructured<'_>) -> Result<()> {
    for _ in 0..32 {
        if u.is_empty() {
            break;
        }
        match u.int_in_range(0..=14)? {
            0 => write(u)?,
            1 => simulation::reset(u.arbitrary()?),
            2 => {
                let number = u.arbitrary()?;
                assert_eq!(simulation::step(number) == 4, number > 2);
            }
            3 => assert!(simulation::random() < 3),
            4 => set_params(u)?,
            // Wide pictures are rare, because they take long.
            5 if u.ratio(1, 16)? => picture::resize(u.arbitrary()?, u.int_in_range(0..=3)?),
            5 => picture::resize(u.int_in_range(0..=70)?, u.int_in_range(0..=70)?),
            6 => picture::paint(
                u.arbitrary()?,
                u.arbitrary()?,
                u.arbitrary()?,
                u.arbitrary()?,
            ),
            7 => {
                picture::draw(f32::from_bits(u.arbitrary()?));
            }
            8 => {
                picture::draw(u.int_in_range(0..=16)? as f32 / 16.0);
            }
            9 => assert!(policies::bang_bang() < 3 && policies::energy_law() < 3),
            10 => assert!(learner::learnt() < 3),
            11 => load(u)?,
            12 if u.ratio(1, 64)? => train(u)?,
            13 if u.ratio(1, 64)? => {
                speed::scalar_steps(u.int_in_range(0..=600)?);
                speed::batch_steps(u.int_in_range(0..=2)?);
            }
            _ => {
                simulation::step(u.int_in_range(0..=2)?);
            }
        }
        check_numbers();
    }
    Ok(())
}

/// Writes into the buffer, as JavaScript does between calls.
fn write(u: &mut Unstructured<'_>) -> Result<()> {
    let bytes: Vec<u8> = u.arbitrary()?;
    BUFFER.borrow()[..bytes.len()].copy_from_slice(&bytes);
    Ok(())
}

fn set_params(u: &mut Unstructured<'_>) -> Result<()> {
    let mut number = |usual: f64| acrobot_fuzz::number(u, usual).map(|x| x as f32);
    let (dt, gravity) = (number(0.2)?, number(9.8)?);
    let [mass1, mass2, length1, length2] = [number(1.0)?, number(1.0)?, number(1.0)?, number(1.0)?];
    let before = simulation::with(|simulation| *simulation.env.params());
    let len = simulation::set_params(u.arbitrary()?, dt, mass1, mass2, length1, length2, gravity);
    if len > 0 {
        let after = simulation::with(|simulation| *simulation.env.params());
        assert_eq!(before, after);
        let buffer = BUFFER.borrow();
        let text = str::from_utf8(&buffer[8..len]).expect("a name, a unit and a rule");
        assert_eq!(text.lines().count(), 3, "{text}");
    }
    Ok(())
}

fn load(u: &mut Unstructured<'_>) -> Result<()> {
    let len = learner::load(u.arbitrary()?);
    let buffer = BUFFER.borrow();
    assert!(str::from_utf8(&buffer[..len]).is_ok());
    Ok(())
}

/// The first call in a process begins a training. All others continue it.
fn train(u: &mut Unstructured<'_>) -> Result<()> {
    learner::begin_training(u.arbitrary()?, u.arbitrary()?);
    assert!((-500.0..=0.0).contains(&learner::train()));
    assert_eq!(
        learner::load(learner::save()),
        0,
        "saved weights are rejected"
    );
    Ok(())
}

fn check_numbers() {
    let address = simulation::numbers();
    // SAFETY: it points to a static that nothing else uses between two calls.
    let [theta1, theta2, dtheta1, dtheta2, ..] = unsafe { *address };
    simulation::with(|simulation| {
        let acrobot = simulation.env.inner();
        assert_eq!(
            [theta1, theta2, dtheta1, dtheta2],
            <[f32; 4]>::from(acrobot.state())
        );
        acrobot_fuzz::assert_settled(acrobot.state(), acrobot.params());
    });
}
