//! Programs that users of the crate write, one per test.

#![cfg(test)]

use core::cell::RefCell;
use core::convert::Infallible;

use acrobot::arithmetic::Arithmetic;
use acrobot::batch::{Batch, Block, StepBuffers};
use acrobot::env::{Env, Space, make};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Lean, Pendulum};
use acrobot::trajectory::Trajectory;
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, State, TimeLimit};
use critical_section::Mutex;
use rand_core::TryRng;

/// In firmware an interrupt steps an acrobot in a static.
#[test]
fn an_interrupt_steps_a_static() {
    type Device = (TimeLimit<Acrobot<Fast>>, Trajectory<f32, 4>);
    static DEVICE: Mutex<RefCell<Device>> = Mutex::new(RefCell::new((
        TimeLimit::v1(Acrobot::hanging(Pcg64::new(42))),
        Trajectory::new(),
    )));

    fn interrupt() {
        critical_section::with(|cs| {
            let (acrobot, past) = &mut *DEVICE.borrow_ref_mut(cs);
            if past.step(acrobot, Action::Positive).done() {
                acrobot.reset();
            }
        });
    }

    for _ in 0..10 {
        interrupt();
    }
    critical_section::with(|cs| {
        let (acrobot, past) = &*DEVICE.borrow_ref(cs);
        assert_eq!((acrobot.elapsed(), past.len()), (10, 4));
    });
}

/// Here libm is the newest version that the crate allows. `Portable` calls its sines.
#[test]
fn the_newest_libm_has_the_sines_of_portables_recorded_bits() {
    let mut rng = Pcg64::new(0);
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for _ in 0..1_000_000 {
        let (sin, cos) = Portable::sin_cos(uniform(&mut rng, -100.0, 100.0));
        for y in [sin, cos] {
            digest = (digest ^ y.to_bits()).wrapping_mul(0x100_0000_01b3);
        }
    }
    assert_eq!(
        digest, 0xb387_b2f4_253a_40a4,
        "{digest:#018x}: see docs/determinism.md"
    );
}

/// A controller steps the pendulum alone, from a state that the compiler has checked.
#[test]
fn a_controller_steps_the_pendulum() {
    const PARAMS: Params<f32> = Params {
        dt: 0.05,
        ..Params::DEFAULT
    };
    const STATE: State<f32> = State {
        theta1: 1.5,
        ..State::HANGING
    };
    static RAISED: Pendulum<Fast> = match Pendulum::<Fast>::const_new(PARAMS, STATE) {
        Ok(pendulum) => pendulum,
        Err(_) => panic!("a parameter or the state is out of range"),
    };
    let mut pendulum = RAISED.clone();
    assert!(!pendulum.step(0.5).unwrap());
    assert!(pendulum.state().dtheta1 < 0.0);
}

/// An agent plays Gymnasium's environment.
#[test]
fn an_agent_plays_by_id() {
    let mut env = make("Acrobot-v1").unwrap();
    let mut rng = Pcg64::new(42);
    env.reset_with_seed(42);
    let mut total = 0.0;
    loop {
        let step = env.step(env.action_space().sample(&mut rng));
        total += step.reward;
        if step.done() {
            break;
        }
    }
    assert!(total >= -500.0);
}

/// A batch in borrowed memory takes torques.
#[test]
fn a_borrowed_batch_takes_torques() -> Result<(), Error> {
    let (mut blocks, mut generators) = ([Block::EMPTY; 1], [Pcg64::UNSEEDED; 3]);
    let mut batch = Batch::<Fast, _>::new(42, (&mut blocks[..], &mut generators[..]))?;
    let mut rewards = [0.0; 3];
    batch.step(
        &[-0.5, 0.0, 0.5],
        StepBuffers::new(&mut rewards, &mut [false; 3], &mut [false; 3]),
    )?;
    assert_eq!(rewards, [-1.0; 3]);
    Ok(())
}

/// A microcontroller's sine unit becomes an arithmetic.
#[test]
fn an_arithmetic_can_be_added() {
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    struct SineUnit;

    impl Arithmetic for SineUnit {
        const NAME: &'static str = "sine unit";
        type Scalar = f32;
        type Form = Lean;

        fn sin_cos(x: f32) -> (f32, f32) {
            (libm::sinf(x), libm::cosf(x))
        }
    }

    let (mut unit, mut fast) = (Acrobot::<SineUnit>::new(42), Acrobot::<Fast>::new(42));
    let (unit, fast) = (unit.step(Action::Positive), fast.step(Action::Positive));
    assert!((unit.observation.dtheta2() - fast.observation.dtheta2()).abs() < 1e-5);
}

/// A hardware generator draws the initial states.
#[test]
fn a_generator_can_be_added() {
    struct Hardware(u64);

    impl TryRng for Hardware {
        type Error = Infallible;

        fn try_next_u32(&mut self) -> Result<u32, Infallible> {
            Ok((self.try_next_u64()? >> 32) as u32)
        }

        fn try_next_u64(&mut self) -> Result<u64, Infallible> {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            Ok(self.0)
        }

        fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
            bytes.fill_with(|| self.0 as u8);
            Ok(())
        }
    }

    let mut acrobot = Acrobot::<Fast, _>::with_rng(Hardware(1));
    let first = acrobot.state();
    acrobot.reset();
    assert_ne!(acrobot.state(), first);
}
