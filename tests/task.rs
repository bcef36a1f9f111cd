//! A user's tasks run alone and in batches with equal bits, with rewards, ends, resets, parameters,
//! observations and data of their own.

use core::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped, Numbers, Real};
use acrobot::batch::VecBatch;

use acrobot::env::Env;
use acrobot::numpy::Pcg64;
use acrobot::physics::{Pendulum, saturate};
use acrobot::rand_core::Rng;
use acrobot::task::{AnyTask, Balance, Gymnasium, Pose, ResetBounds, Swingup, Task};
use acrobot::{Acrobot, Action, Fast, Params, State, TimeLimit};
use common::smooth::Smooth;
use common::twins::Twins;
use serde::de::DeserializeOwned;

/// Bring the tip near a point, m, with little effort, which ends the episode.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Reach {
    point: [f64; 2],
}

impl Reach {
    /// How far the tip is beyond 0.2 m from the point, m², with links of 1 m.
    #[inline(always)]
    fn beyond<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V {
        let number = |x| V::splat(Real::from_f64(x));
        let [(sin1, cos1), (sin2, cos2)] = pose.directions();
        let [x, y] = self.point.map(number);
        let [x, y] = [sin1 + sin2 - x, -cos1 - cos2 - y];
        x * x + y * y - number(0.04)
    }
}

impl Task for Reach {
    const NAME: &'static str = "reach";
    const DEFAULT: Self = Self { point: [0.9, 0.5] };
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(300).unwrap();

    const PARAMS: Params = Params { mass2: 1.5, ..Params::DEFAULT };

    type Observation = [f32; 5];
    type Memory = ();

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        let drawn = bounds.draw(rng);
        State { dtheta1: -drawn.dtheta1, ..drawn }
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 5] {
        let State { theta1, theta2, dtheta1, dtheta2 } = pose.state;
        [theta1, theta2, dtheta1, dtheta2, self.beyond::<A, V>(pose)]
    }

    fn observation_high(&self, _: &Params<f32>) -> [f32; 5] {
        [4.0, -4.0, 20.0, f32::INFINITY, f32::NAN]
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        V::splat(Real::ZERO).simd_gt(self.beyond::<A, V>(pose))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        let [_, [x, y]] = pose.positions(params);
        let cost = (x * x + y * y) * V::splat(Real::from_f64(0.1)) + torque * torque;
        let bonus = V::Single::select(terminated, V::Single::splat(100.0), V::Single::splat(0.0));
        bonus - cost.to_f32()
    }
}

#[test]
fn own_tasks_run_in_batches_with_equal_bits() {
    Twins::<Fast, 16, Reach>::at_every_level();
}

#[test]
fn own_tasks_are_environments() {
    let space = Acrobot::<Fast, Reach>::new(0).observation_space();
    assert_eq!(space.high(), [4.0, 4.0, 20.0, f32::MAX, f32::MAX]);
    assert!(space.contains(&space.sample(&mut Pcg64::new(0))));
}

#[test]
fn a_balanced_acrobot_is_upright_with_a_reward_of_1() {
    let mut acrobot = Acrobot::<Fast, Balance>::hanging(Pcg64::new(0));
    assert_eq!(acrobot.step(Action::Zero).reward, 0.0);
    assert_eq!(acrobot.params().torques, [-10.0, 0.0, 10.0]);
    let states = [0, 1, 2, 3].map(|seed| {
        assert!(acrobot.reset_with_seed(seed)[0] < -0.99);
        acrobot.state()
    });
    assert!(states.iter().all(|state| state.theta2.abs() <= 0.05));
    assert!(states.iter().any(|state| state.theta2 < 0.0));
    acrobot.set_state(State::UPRIGHT).unwrap();
    assert_eq!(acrobot.step(Action::Zero).reward, 1.0);
}

/// As docs/tasks.md says.
#[test]
fn a_regulator_stays_upright_from_100_initial_states() {
    let params = Balance::PARAMS.cast();
    let upright = Pendulum::<Fast>::new(params, State::UPRIGHT).unwrap();
    let weights = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f32::from(u8::from(i == j))));
    let lqr = upright.regulator(0.0, &weights, 1.0).unwrap();
    for seed in 0..100 {
        let mut acrobot = Acrobot::<Fast, Balance>::new(seed);
        for _ in 0..500 {
            let torque = lqr.torque(acrobot.state().deviation_from(State::UPRIGHT));
            acrobot.step_torque(saturate(torque, 10.0)).unwrap();
        }
        let x = acrobot.state().deviation_from(State::UPRIGHT);
        assert!(x.iter().all(|x| x.abs() < 1e-3), "{seed}: {x:?}");
    }
}

/// An acrobot and a batch hang at the point that they are given.
#[test]
fn a_task_has_data() {
    let mut acrobot = Acrobot::<Fast, Reach>::new(1);
    let mut batch = VecBatch::<Fast, Reach>::new(1, 20).unwrap();
    let [.., beyond] = acrobot.observation();
    assert!((6.0..8.0).contains(&beyond), "{beyond}");
    assert!(!acrobot.step(Action::Zero).terminated);
    assert_eq!(batch.step(&[Action::Zero; 20]).unwrap().terminated, [false; 20]);
    let hanging = Reach { point: [0.0, -2.0] };
    acrobot.set_task(hanging);
    batch.set_task(hanging);
    assert_eq!((*acrobot.task(), *batch.task()), (hanging, hanging));
    let step = acrobot.step(Action::Zero);
    assert!(step.terminated && step.reward > 99.0, "{step:?}");
    assert!(batch.observations().iter().all(|[.., beyond]| *beyond < 0.0));
    assert_eq!(batch.step(&[Action::Zero; 20]).unwrap().terminated, [true; 20]);
    // Snapshots have them.
    let bytes = postcard::to_stdvec(&(&acrobot, &batch)).unwrap();
    type Both = (Acrobot<Fast, Reach>, VecBatch<Fast, Reach>);
    let (loaded, loaded_batch): Both = postcard::from_bytes(&bytes).unwrap();
    assert_eq!((*loaded.task(), *loaded_batch.task()), (hanging, hanging));
    assert!(postcard::from_bytes::<Acrobot<Fast>>(&bytes).is_err());
}

#[test]
fn tasks_that_remember_run_in_batches_with_equal_bits() {
    Twins::<Fast, 16, Smooth>::at_every_level();
}

/// The torque that acts is half of the agent's.
#[test]
fn a_task_remembers_and_is_saved() {
    let mut acrobot = Acrobot::<Fast, Smooth>::new(1);
    let [.., goal] = acrobot.observation();
    let rewards = [2, 2, -2, 0].map(|torque| acrobot.step_torque(torque as f32).unwrap().reward);
    assert_eq!(rewards, [-1.0, 0.0, -4.0, -1.0]);
    let [.., moved] = acrobot.observation();
    assert!((moved - goal - 0.004).abs() < 1e-6);
    let (torques, remembered) = *acrobot.memory();
    assert_eq!((torques, remembered), ([-1.0, 0.0], moved));
    // The goal is drawn by resets only.
    acrobot.set_state(State::HANGING).unwrap();
    assert_eq!(*acrobot.memory(), ([0.0, 0.0], moved));
    acrobot.reset();
    assert_ne!(acrobot.memory().1, moved);

    let text = serde_json::to_string(&acrobot).unwrap();
    assert!(text.contains(r#","memory":[0.0,0.0,"#), "{text}");
    assert_eq!(serde_json::from_str::<Acrobot<Fast, Smooth>>(&text).unwrap(), acrobot);
    let error = serde_json::from_str::<Acrobot<Fast, Smooth>>(&text.replace("[0.0,0.0,", "[0.0,"));
    let error = error.unwrap_err().to_string();
    assert!(error.contains("invalid length 2, expected the 3 numbers that the task"), "{error}");
    let (without, _) = text.split_once(",\"memory\"").unwrap();
    let error = serde_json::from_str::<Acrobot<Fast, Smooth>>(&format!("{without}}}")).unwrap_err();
    assert!(error.to_string().starts_with("memory must be finite"), "{error}");
    let rejected = acrobot.set_memory(([0.0, f32::NAN], 0.5)).unwrap_err();
    assert_eq!(rejected.to_string(), "memory must be finite in each element, got NaN");

    let mut batch = VecBatch::<Fast, Smooth>::new(3, 5).unwrap();
    batch.step(&[2_u8; 5]).unwrap();
    let bytes = postcard::to_stdvec(&batch).unwrap();
    let mut loaded: VecBatch<Fast, Smooth> = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(loaded.step(&[0_u8; 5]).unwrap(), batch.step(&[0_u8; 5]).unwrap());
}

/// A constant that `AnyTask` does not forward would show here.
#[test]
fn a_task_chosen_at_run_time_is_the_task_itself() {
    fn check<T: Task<Observation = [f32; 6]> + serde::Serialize + DeserializeOwned>(task: AnyTask) {
        type Any = Acrobot<Damped<Fast>, AnyTask>;
        let mut one = TimeLimit::with_task_limit(Acrobot::<Damped<Fast>, T>::new(7));
        let mut any = TimeLimit::with_task_limit(Any::with_task(7, task).unwrap());
        let mut batch = VecBatch::<Damped<Fast>, T>::new(7, 20).unwrap();
        let mut any_batch = VecBatch::<Damped<Fast>, AnyTask>::with_task(7, task, 20).unwrap();
        let high = T::DEFAULT.observation_high(&one.params().cast());
        assert_eq!(task.observation_high(&any.params().cast()), high);
        for step in 0..1010 {
            let torque = if step % 90 < 45 { 2.0 } else { -2.0 };
            let steps = (one.step_torque(torque), any.step_torque(torque));
            assert_eq!(steps.0, steps.1, "{task:?}, {step}");
            if steps.0.is_ok_and(|step| step.is_done()) {
                assert_eq!(one.reset(), any.reset());
            }
            let results = batch.step(&[torque; 20]).unwrap();
            assert_eq!(results, any_batch.step(&[torque; 20]).unwrap());
        }
        let bytes = postcard::to_stdvec(&(&one, &batch)).unwrap();
        assert_eq!(bytes, postcard::to_stdvec(&(&any, &any_batch)).unwrap());
        type Both<T> = (TimeLimit<Acrobot<Damped<Fast>, T>>, VecBatch<Damped<Fast>, T>);
        let (loaded, loaded_batch): Both<AnyTask> = postcard::from_bytes(&bytes).unwrap();
        assert_eq!((*loaded.task(), *loaded_batch.task()), (task, task));
        assert!(postcard::from_bytes::<Both<T>>(&bytes).is_ok());
    }
    check::<Gymnasium>(AnyTask::Gymnasium);
    check::<Swingup>(AnyTask::Swingup);
    check::<Balance>(AnyTask::Balance);
    // The arithmetic has no friction.
    assert!(Acrobot::<Fast, AnyTask>::with_task(1, AnyTask::Swingup).is_err());
}

/// In a `const`, with the task's parameters. The tasks of the crate take no room.
#[test]
fn constants_have_the_tasks_parameters() {
    const HANGING: Acrobot<Fast, Balance, ()> = Acrobot::hanging(());
    assert_eq!(*HANGING.params(), Balance::PARAMS.cast());
    assert_eq!(size_of::<Acrobot<Fast, Balance>>(), size_of::<Acrobot<Fast>>());
    let text = serde_json::to_string(&Acrobot::<Fast, Balance>::new(1)).unwrap();
    assert!(text.contains(r#""task":"balance""#), "{text}");
    assert!(serde_json::from_str::<Acrobot<Fast>>(&text).is_err());
    assert!(serde_json::from_str::<Acrobot<Fast, Balance>>(&text).is_ok());
}
