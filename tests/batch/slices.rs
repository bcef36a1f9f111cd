//! What a batch reads and writes: rejected input changes nothing.

use acrobot::batch::{Member, SimdLevel, StepBuffers, VecBatch};
use acrobot::task::Draws;
use acrobot::{Fast, Params, ResetOptions, State};
use common::twins::LEVELS;

// The memory of a `VecBatch`, because each other one takes seconds to compile.
type Small = VecBatch<Fast>;

fn small() -> Small {
    VecBatch::new(1, 3).unwrap()
}

#[test]
fn a_new_batch_has_the_widest_simd_level_of_the_machine() {
    let mut batch = small();
    let widest = LEVELS.into_iter().rfind(|level| level.is_available());
    assert_eq!(Some(batch.simd_level()), widest);
    batch.set_simd_level(SimdLevel::Baseline);
    assert_eq!(batch.simd_level(), SimdLevel::Baseline);
}

fn members(batch: &Small) -> Vec<Member<Fast>> {
    (0..3).map(|i| batch.member(i).unwrap()).collect()
}

/// The errors of all four kinds of step, which change neither the batch nor the buffers of these
/// lengths.
fn rejections(
    batch: &mut Small,
    actions: &[u8],
    torques: &[f32],
    lengths: [usize; 5],
) -> [String; 4] {
    let before = members(batch);
    let [rewards, terminated, truncated, rows, finals] = lengths;
    std::array::from_fn(|kind| {
        let mut rewards = vec![9.0; rewards];
        let mut ends = [terminated, truncated].map(|len| vec![true; len]);
        let mut rows = [rows, finals].map(|len| vec![[9.0; 6]; len]);
        let [terminated, truncated] = &mut ends;
        let [observations, finals] = &mut rows;
        let buffers = StepBuffers::new(&mut rewards, terminated, truncated)
            .with_observations(observations)
            .with_final_observations(finals);
        let result = match kind {
            0 => batch.step_into(actions, buffers),
            1 => batch.par_step_into(actions, buffers),
            2 => batch.step_into(torques, buffers),
            _ => batch.par_step_into(torques, buffers),
        };
        assert_eq!(members(batch), before);
        assert!(rewards.iter().all(|x| *x == 9.0));
        assert!(ends.concat().iter().all(|end| *end));
        assert!(rows.concat().iter().all(|row| *row == [9.0; 6]));
        result.unwrap_err().to_string()
    })
}

#[test]
fn rejected_steps_change_nothing() {
    let batch = &mut small();
    for (lengths, message) in [
        ([2, 3, 3, 3, 3], "rewards must have 3 elements, got 2"),
        ([3, 0, 3, 3, 3], "terminated must have 3 elements, got 0"),
        ([3, 3, 4, 3, 3], "truncated must have 3 elements, got 4"),
        ([3, 3, 3, 1, 3], "observations must have 3 elements, got 1"),
        ([3, 3, 3, 3, 4], "final_observations must have 3 elements, got 4"),
    ] {
        assert_eq!(rejections(batch, &[1; 3], &[0.0; 3], lengths), [message; 4]);
    }
    let actions = "actions must have 3 elements, got 2";
    let torques = "torques must have 3 elements, got 2";
    assert_eq!(rejections(batch, &[1; 2], &[0.0; 2], [3; 5]), [actions, actions, torques, torques]);
    let action = "action must be 0 (negative torque), 1 (none) or 2 (positive), got 3";
    for (number, name) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (f32::NEG_INFINITY, "-inf")] {
        let torque = format!("torque must be a finite number of N m, got {name}");
        assert_eq!(
            rejections(batch, &[0, 3, 1], &[0.0, 1.0, number], [3; 5]),
            [action, action, &torque, &torque]
        );
    }
}

#[test]
fn rejected_changes_change_nothing() {
    const NAN: State<f32> = State { theta1: 0.0, theta2: f32::NAN, dtheta1: 0.0, dtheta2: 0.0 };
    let mut batch = small();
    let before = members(&batch);
    let member = before[0].clone();
    let invalid = Member { state: NAN, ..member.clone() };
    let massless = Params { mass1: 0.0, ..Params::DEFAULT };
    let heavy = Params { mass1: 2.0, ..Params::DEFAULT };
    let other = Member { params: heavy, ..member.clone() };
    let shared = "a batch must have memory for the parameters of each acrobot";
    let mut rows = [[9.0; 6]; 4];
    let masked = |batch: &mut Small, mask: &[_]| batch.reset_masked(mask, ResetOptions::default());
    for (result, message) in [
        (masked(&mut batch, &[true; 4]), "mask must have 3 elements, got 4"),
        (batch.reset_to(&[State::default(); 2]), "states must have 3 elements, got 2"),
        (
            batch.reset_to(&[State::default(), State::default(), NAN]),
            "theta2 must be a finite number of rad, got NaN",
        ),
        // Lane 3 of the block holds no acrobot.
        (batch.set_state(3, State::default()), "member index must be below 3, got 3"),
        (batch.set_state(16, State::default()), "member index must be below 3, got 16"),
        (batch.set_state(1, NAN), "theta2 must be a finite number of rad, got NaN"),
        (batch.state(3).map(drop), "member index must be below 3, got 3"),
        (batch.params(3).map(drop), "member index must be below 3, got 3"),
        (batch.elapsed_steps(3).map(drop), "member index must be below 3, got 3"),
        (batch.is_done(3).map(drop), "member index must be below 3, got 3"),
        (batch.member(3).map(drop), "member index must be below 3, got 3"),
        (batch.set_member(3, member), "member index must be below 3, got 3"),
        (batch.set_member(1, invalid), "theta2 must be a finite number of rad, got NaN"),
        (batch.set_all_params(massless), "mass1 must be finite and above 0 kg, got 0"),
        (batch.set_params(3, Params::DEFAULT), "member index must be below 3, got 3"),
        (batch.set_params(0, heavy), shared),
        (batch.set_member(0, other), shared),
        (batch.set_draws(common::draws::<Fast>()), shared),
        (batch.observe(&mut rows), "observations must have 3 elements, got 4"),
    ] {
        assert_eq!(result.unwrap_err().to_string(), message);
    }
    assert_eq!(rows, [[9.0; 6]; 4]);
    assert_eq!(batch.draws(), &Draws::NONE);
    assert_eq!(members(&batch), before);
}
