//! Policies from files: outputs against sums by hand, and files that must be rejected.

use acrobot::{Acrobot, Action, Fast, TimeLimit};
use policy::Policy;

const SEEN: [f32; 6] = [0.9, -0.4, 0.5, 0.8, -1.5, 3.0];

/// Layers of two units with tanh and with ReLU, then the outputs.
fn file(torque_limit: Option<f32>) -> Vec<u8> {
    let outputs = if torque_limit.is_some() { 1 } else { 3 };
    let numbers: Vec<f32> = (0..2 * 7 + 2 * 3 + 3 * usize::from(outputs)).map(number).collect();
    written(torque_limit, &[[2, 1], [2, 2], [outputs, 0]], &numbers)
}

/// Layers of outputs and activations, and their numbers.
fn written(torque_limit: Option<f32>, layers: &[[u8; 2]], numbers: &[f32]) -> Vec<u8> {
    let mut bytes = b"MLP1".to_vec();
    bytes.extend([layers.len() as u8, torque_limit.is_some().into(), 6, 0]);
    bytes.extend(torque_limit.unwrap_or(0.0).to_le_bytes());
    bytes.extend(layers.iter().flat_map(|&[outputs, activation]| [outputs, 0, activation, 0]));
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    sealed(bytes)
}

fn number(i: usize) -> f32 {
    ((i * 37 % 19) as f32 - 9.0) / 8.0
}

fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes);
    bytes.extend(checksum.to_le_bytes());
    bytes
}

/// A file with other bytes from a position on, and their checksum.
fn changed(file: &[u8], at: usize, new: &[u8]) -> Vec<u8> {
    let mut bytes = file[..file.len() - 4].to_vec();
    bytes[at..][..new.len()].copy_from_slice(new);
    sealed(bytes)
}

/// The outputs of `file`, in `f64`.
fn by_hand() -> Vec<f64> {
    let mut next = 0;
    let mut layer = |inputs: &[f64], outputs: usize, activation: fn(f64) -> f64| -> Vec<f64> {
        (0..outputs)
            .map(|_| {
                let numbers: Vec<f64> =
                    (next..=next + inputs.len()).map(|i| number(i).into()).collect();
                next += 1 + inputs.len();
                let products = inputs.iter().zip(&numbers[1..]).map(|(x, w)| x * w);
                activation(numbers[0] + products.sum::<f64>())
            })
            .collect()
    };
    let first = layer(&SEEN.map(f64::from), 2, f64::tanh);
    let second = layer(&first, 2, |x| x.max(0.0));
    layer(&second, 3, |x| x)
}

#[test]
fn outputs_are_those_of_the_layers() {
    let file = file(None);
    let policy = Policy::<6>::new(&file).unwrap();
    let outputs = policy.outputs(&SEEN);
    for (output, expected) in outputs.into_iter().zip(by_hand()) {
        assert!((f64::from(output) - expected).abs() < 1e-6, "{output} {expected}");
    }
    let best = (0..3).max_by(|&i, &j| outputs[i].total_cmp(&outputs[j])).unwrap();
    assert_eq!(policy.action(&SEEN), Action::ALL[best]);
    assert_eq!(policy.torque(&SEEN), None);
}

#[test]
fn a_torque_is_within_its_limit() {
    let wide = file(Some(100.0));
    let policy = Policy::<64>::new(&wide).unwrap();
    let [output, ..] = policy.outputs(&SEEN);
    assert_eq!(policy.torque(&SEEN), Some(output));
    let expected = if output < 0.0 { Action::Negative } else { Action::Positive };
    assert_eq!(policy.action(&SEEN), expected);
    let narrow = file(Some(0.01));
    let torque = Policy::<64>::new(&narrow).unwrap().torque(&SEEN);
    assert_eq!(torque, Some(0.01_f32.copysign(output)));
}

#[test]
fn other_files_are_rejected() {
    let good = file(None);
    let mut damaged = good.clone();
    damaged[30] ^= 1;
    for (bytes, error) in [
        (changed(&good, 3, b"2"), "MLP1"),
        (vec![], "MLP1"),
        (good[..20].to_vec(), "length"),
        (changed(&good, 4, &[200]), "length"),
        (changed(&good, 4, &[2]), "length"),
        (changed(&good, 6, &[5]), "6 inputs"),
        (changed(&good, 12, &[0]), "1 to WIDTH outputs"),
        (changed(&good, 12, &[7]), "1 to WIDTH outputs"),
        (changed(&good, 14, &[3]), "activation"),
        (changed(&good, 5, &[1]), "6 inputs"),
        (changed(&good, 5, &[2]), "6 inputs"),
        (file(Some(0.0)), "finite"),
        (file(Some(f32::NAN)), "finite"),
        (changed(&good, 24, &f32::INFINITY.to_le_bytes()), "finite"),
        (damaged, "checksum"),
    ] {
        let message = Policy::<6>::new(&bytes).unwrap_err().message();
        assert!(message.contains(error), "{error}: {message}");
    }
    let message = Policy::<5>::new(&good).unwrap_err().message();
    assert!(message.contains("6 inputs"), "{message}");
}

/// As the npm package's test does with the same file.
#[test]
fn the_trained_policy_swings_up() {
    let policy = Policy::<64>::new(include_bytes!("../policy.bin")).unwrap();
    let steps = [1, 2, 3, 4, 5].map(|seed| {
        let mut env = TimeLimit::with_task_limit(Acrobot::<Fast>::new(seed));
        while !env.step(policy.action(&env.observation())).is_done() {}
        env.elapsed_steps()
    });
    assert_eq!(steps, [101, 88, 96, 72, 72]);
}

#[test]
fn sums_that_overflow_play_no_torque() {
    /// A sum of it and itself is infinite.
    const HUGE: f32 = 3e38;
    const UP: [f32; 7] = [0.0, HUGE, 0.0, HUGE, 0.0, -HUGE, 0.0];
    let down = UP.map(|x| 0.0 - x);
    // The unit changes the last of three scores, which is otherwise the highest.
    let after = [0.0, 0.0, 0.0, 0.0, 0.5, 1.0];
    let score = written(None, &[[3, 0]], [[0.0; 7], [0.0; 7], UP].as_flattened());
    let before =
        |activation| written(None, &[[1, activation], [3, 0]], &[&down[..], &after].concat());
    let torque = written(Some(2.0), &[[1, 0]], &UP);
    assert!(torque == include_bytes!("../torque.bin"), "the Python package writes this file");
    // What UP adds up to: HUGE; infinity; infinity, but HUGE in another order; no number.
    let seen = [
        [0.5, 0.0, 0.5, 0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 1.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 2.0, 0.0],
    ];
    for (name, file, actions, torques) in [
        ("score", score, [2, 1, 1, 1], [None; 4]),
        ("low ReLU", before(2), [2, 2, 2, 1], [None; 4]),
        ("low tanh", before(1), [0, 0, 0, 1], [None; 4]),
        ("torque", torque, [2, 1, 1, 1], [2.0, 0.0, 0.0, 0.0].map(Some)),
    ] {
        let policy = Policy::<6>::new(&file).unwrap();
        assert_eq!(seen.map(|x| u8::from(policy.action(&x))), actions, "{name}");
        assert_eq!(seen.map(|x| policy.torque(&x)), torques, "{name}");
    }
}
