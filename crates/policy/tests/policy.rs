//! Policies from files: outputs against sums by hand, and files that must be rejected.

use acrobot::{Acrobot, Action, Fast, TimeLimit};
use policy::Policy;

const SEEN: [f32; 6] = [0.9, -0.4, 0.5, 0.8, -1.5, 3.0];

/// Its activation (0 none, 1 tanh, 2 ReLU), and for each unit the bias and then the weights.
type Layer<'a> = (u8, &'a [&'a [f32]]);

/// Two units with tanh, two with ReLU, and three outputs, of which a torque is the first.
const LAYERS: [Layer; 3] = [
    (
        1,
        &[
            &[-1.125, 1.125, 1.0, 0.875, 0.75, 0.625, 0.5],
            &[0.375, 0.25, 0.125, 0.0, -0.125, -0.25, -0.375],
        ],
    ),
    (2, &[&[0.5, 0.625, -0.75], &[-0.875, -1.0, 1.125]]),
    (0, &[&[1.0, 0.875, 0.75], &[0.625, 0.5, 0.375], &[0.25, 0.125, 0.0]]),
];

/// The file of layers, for actions or for a torque with this limit, N m.
fn file(layers: &[Layer], torque_limit: Option<f32>) -> Vec<u8> {
    let mut bytes = b"MLP1".to_vec();
    bytes.extend([layers.len() as u8, torque_limit.is_some().into(), 6, 0]);
    bytes.extend(torque_limit.unwrap_or(0.0).to_le_bytes());
    for (activation, units) in layers {
        bytes.extend([units.len() as u8, 0, *activation, 0]);
    }
    let numbers = layers.iter().flat_map(|(_, units)| units.iter().copied().flatten());
    bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
    sealed(bytes)
}

/// The file of [`LAYERS`] with a torque.
fn torque_file(limit: f32) -> Vec<u8> {
    let [first, second, (none, outputs)] = LAYERS;
    file(&[first, second, (none, &outputs[..1])], Some(limit))
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

/// The outputs of [`LAYERS`], in `f64`.
fn by_hand() -> Vec<f64> {
    LAYERS.iter().fold(SEEN.map(f64::from).to_vec(), |inputs, (activation, units)| {
        let unit = |numbers: &&[f32]| {
            let products = inputs.iter().zip(&numbers[1..]).map(|(x, &w)| x * f64::from(w));
            let sum = f64::from(numbers[0]) + products.sum::<f64>();
            [sum, sum.tanh(), sum.max(0.0)][usize::from(*activation)]
        };
        units.iter().map(unit).collect()
    })
}

#[test]
fn outputs_are_those_of_the_layers() {
    let file = file(&LAYERS, None);
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
    let wide = torque_file(100.0);
    let policy = Policy::<64>::new(&wide).unwrap();
    let [output, ..] = policy.outputs(&SEEN);
    assert_eq!(policy.torque(&SEEN), Some(output));
    let expected = if output < 0.0 { Action::Negative } else { Action::Positive };
    assert_eq!(policy.action(&SEEN), expected);
    let narrow = torque_file(0.01);
    let torque = Policy::<64>::new(&narrow).unwrap().torque(&SEEN);
    assert_eq!(torque, Some(0.01_f32.copysign(output)));
}

#[test]
fn other_files_are_rejected() {
    let good = file(&LAYERS, None);
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
        (torque_file(0.0), "finite"),
        (torque_file(f32::NAN), "finite"),
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
        let mut env = TimeLimit::of(Acrobot::<Fast>::new(seed));
        while !env.step(policy.action(&env.observation())).done() {}
        env.elapsed_steps()
    });
    assert_eq!(steps, [101, 88, 96, 72, 72]);
}

/// What `acrobot_rs.policy.write` writes: the test of Python's package has the same bytes.
const WRITTEN: &[u8] = b"MLP1\x01\x01\x06\0\0\0\0\x40\x01\0\0\0\0\0\0\0\xe6\xb1\x61\x7f\0\0\0\0\
    \xe6\xb1\x61\x7f\0\0\0\0\xe6\xb1\x61\xff\0\0\0\0\x5b\xab\x14\x98";

#[test]
fn sums_that_overflow_play_no_torque() {
    // A sum of it and itself is infinite.
    const HUGE: f32 = 3e38;
    const UP: &[f32] = &[0.0, HUGE, 0.0, HUGE, 0.0, -HUGE, 0.0];
    const DOWN: &[f32] = &[0.0, -HUGE, 0.0, -HUGE, 0.0, HUGE, 0.0];
    // The unit before changes the last score, which is otherwise the highest.
    const LAST: Layer = (0, &[&[0.0, 0.0], &[0.0, 0.0], &[0.5, 1.0]]);
    // Where UP is HUGE; infinite; infinite, but HUGE in another order; no number.
    let observations = [
        [0.5, 0.0, 0.5, 0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 1.0, 0.0],
        [1.0, 0.0, 1.0, 0.0, 2.0, 0.0],
    ];
    let torque = file(&[(0, &[UP])], Some(2.0));
    assert_eq!(torque, WRITTEN);
    for (file, actions, torques) in [
        (file(&[(0, &[&[0.0; 7], &[0.0; 7], UP])], None), [2, 1, 1, 1], [None; 4]),
        (file(&[(2, &[DOWN]), LAST], None), [2, 2, 2, 1], [None; 4]),
        (file(&[(1, &[DOWN]), LAST], None), [0, 0, 0, 1], [None; 4]),
        (torque, [2, 1, 1, 1], [2.0, 0.0, 0.0, 0.0].map(Some)),
    ] {
        let policy = Policy::<6>::new(&file).unwrap();
        assert_eq!(observations.map(|seen| u8::from(policy.action(&seen))), actions);
        assert_eq!(observations.map(|seen| policy.torque(&seen)), torques);
    }
}
