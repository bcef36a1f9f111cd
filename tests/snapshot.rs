//! A snapshot resumes to the same bits, also one of an older release, and one that is not valid or of
//! something else is refused with the reason.

mod common;

use std::fmt::Debug;

use acrobot::{
    Acrobot, Action, Arithmetic, Batch, Block, Fast, LimitedStep, Member, Observations, Output,
    Params, Pcg64, Portable, Real, TimeLimit,
};
use common::Digest;
use serde::Serialize;
use serde::de::DeserializeOwned;

type Limited = TimeLimit<Acrobot<Portable>>;

/// An acrobot in the middle of an episode with noise, and its generator between two halves.
fn busy() -> Limited {
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

fn run(acrobot: &mut Limited) -> Vec<LimitedStep> {
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
    assert!(serde_json::from_str::<Limited>(&text).is_ok());

    let refuse = |from: &str, to: &str, reason: &str| {
        assert!(text.contains(from), "{from} in {text}");
        let broken = text.replacen(from, to, 1);
        let error = serde_json::from_str::<Limited>(&broken)
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
    let half = text.find(",\"half\":").unwrap();
    let half = &text[half..half + text[half..].find('}').unwrap()];
    refuse(half, "", "missing field `half`");

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
    let mut member = member();
    member.state.theta2 = f32::INFINITY;
    let bytes = postcard::to_stdvec(&member).unwrap();
    assert!(postcard::from_bytes::<Member>(&bytes).is_err());
}

/// One of a batch, in the middle of an episode.
fn member() -> Member {
    let mut batch = batch_of_one();
    let mut member = batch.member(0).unwrap();
    member.rng = Pcg64::new(7);
    Action::sample(&mut member.rng);
    (member.elapsed, member.ended) = (499, false);
    batch.set_member(0, member).unwrap();
    batch.member(0).unwrap()
}

fn batch_of_one() -> Batch<Fast, [Block; 1], [Pcg64; 1]> {
    Batch::new(42, [Block::EMPTY], [Pcg64::UNSEEDED]).unwrap()
}

/// 100 steps of an acrobot, and its reset.
fn play<A: Arithmetic>(mut acrobot: Acrobot<A>) -> u64 {
    let mut digest = Digest::new();
    let mut add = |acrobot: &Acrobot<A>| {
        for x in <[A::Scalar; 4]>::from(acrobot.state()) {
            digest.add(x.to_f64().to_bits());
        }
    };
    for _ in 0..100 {
        let action = Action::sample(acrobot.rng_mut());
        acrobot.step(action);
        add(&acrobot);
    }
    acrobot.reset();
    add(&acrobot);
    digest.0
}

/// Likewise through the end of an episode.
fn play_member(member: Member) -> u64 {
    let mut batch = batch_of_one();
    batch.set_member(0, member).unwrap();
    let mut digest = Digest::new();
    for _ in 0..100 {
        let mut rows = [[0.0; 6]];
        let output = Output {
            rewards: &mut [0.0],
            terminated: &mut [false],
            truncated: &mut [false],
            observations: Observations::Rows(&mut rows),
            final_observations: Observations::None,
        };
        batch.step(&[2_u8], output).unwrap();
        rows.as_flattened()
            .iter()
            .for_each(|x| digest.add(x.to_bits().into()));
    }
    digest.0
}

fn to_hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn from_hex(text: &str) -> Vec<u8> {
    let pairs = text.as_bytes().chunks(2);
    let byte = |pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    pairs.map(byte).collect()
}

/// Three lines: as JSON, as postcard, and what it plays; and from those of the file, what these play.
fn stored<T>(original: T, lines: &mut std::str::Lines<'_>, play: fn(T) -> u64) -> String
where
    T: Serialize + DeserializeOwned + PartialEq + Debug,
{
    let [json, hex, played] = [(); 3].map(|()| lines.next().unwrap_or_default());
    // Miri takes minutes to play; what it reads is compared all the same.
    let play = |value| match cfg!(miri) {
        true => played.to_owned(),
        false => format!("{:016x}", play(value)),
    };
    if !json.is_empty() {
        let from_json: T = serde_json::from_str(json).unwrap();
        let from_bytes: T = postcard::from_bytes(&from_hex(hex)).unwrap();
        assert_eq!(from_json, original);
        assert_eq!(from_bytes, original);
        assert_eq!(play(from_json), played);
        assert_eq!(play(from_bytes), played);
    }
    let json = serde_json::to_string(&original).unwrap();
    let hex = to_hex(&postcard::to_stdvec(&original).unwrap());
    format!("{json}\n{hex}\n{}\n", play(original))
}

/// What is stored differently is of another version, and has a file of its own.
#[test]
fn snapshots_of_version_1_stay_readable() {
    let file = include_str!("data/snapshots_1.txt");
    let mut lines = file.lines();
    let found = [
        stored(busy(), &mut lines, |limited| play(limited.inner().clone())),
        stored(Acrobot::<Fast>::new(3), &mut lines, play),
        stored(member(), &mut lines, play_member),
    ];
    common::assert_snapshot("snapshots_1.txt", file, &found.concat());
}

/// With what a text has in place of another, if it is refused.
fn refusal<T: DeserializeOwned + Debug>(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} in {text}");
    let changed = text.replacen(from, to, 1);
    let error = serde_json::from_str::<T>(&changed).unwrap_err();
    error.to_string()
}

#[test]
fn snapshots_of_something_else_are_refused_by_their_header() {
    let header = r#""snapshot":{"of":"acrobot","version":1,"scalar":"f64"},"#;
    let text = serde_json::to_string(&busy()).unwrap();
    let refused = |from, to| refusal::<Limited>(&text, from, to);
    let first = |reason: String| reason.split(" at line").next().unwrap().to_owned();
    assert_eq!(
        first(refused("\"version\":1", "\"version\":2")),
        "the snapshot is of \"acrobot\", version 2, in f64; allowed is \"acrobot\", version 1, in f64"
    );
    assert_eq!(
        first(refused("f64", "f32")),
        "the snapshot is of \"acrobot\", version 1, in f32; allowed is \"acrobot\", version 1, in f64"
    );
    assert_eq!(
        first(refused(header, "")),
        "missing field `snapshot`; allowed is a snapshot of version 1"
    );
    assert!(refused("\"acrobot\"", "\"batch member\"").contains("is of \"batch member\""));
    let unknown = "\"an environment of another kind\"";
    assert!(refused("\"acrobot\"", unknown).contains("allowed is a snapshot of version 1"));
    // Before anything else is read.
    let newer = header.replace('1', "2") + "\"params\":{}";
    assert!(refused(&(header.to_owned() + "\"params\":{"), &newer).contains("version 2"));
    assert!(
        refusal::<Member>(&serde_json::to_string(&member()).unwrap(), "f32", "f64").contains(
            "is of \"batch member\", version 1, in f64; allowed is \"batch member\", version 1, in f32"
        )
    );
}

/// Bytes have no names: what of them can be read as something else is refused all the same.
#[test]
fn bytes_of_something_else_are_refused() {
    fn acrobot<A: Arithmetic<Scalar: Serialize>>() -> Vec<u8> {
        postcard::to_stdvec(&Acrobot::<A>::new(1)).unwrap()
    }
    /// As stored before there were versions.
    fn unversioned<A: Arithmetic<Scalar: Serialize>>() -> Vec<u8> {
        let acrobot = Acrobot::<A>::new(1);
        postcard::to_stdvec(&(acrobot.params(), acrobot.state(), acrobot.rng())).unwrap()
    }
    fn reads<T: DeserializeOwned>(all: &[Vec<u8>]) -> Vec<bool> {
        all.iter()
            .map(|bytes| postcard::from_bytes::<T>(bytes).is_ok())
            .collect()
    }

    let mut newer = acrobot::<Portable>();
    let version = newer.iter().position(|&byte| byte == 1).unwrap();
    newer[version] = 2;
    let wide = Member {
        state: member().state.cast::<f64>(),
        elapsed: 0,
        ended: false,
        rng: Pcg64::new(0),
    };
    let all = [
        acrobot::<Portable>(),
        acrobot::<Fast>(),
        postcard::to_stdvec(&member()).unwrap(),
        postcard::to_stdvec(&wide).unwrap(),
        newer,
        unversioned::<Portable>(),
        unversioned::<Fast>(),
        postcard::to_stdvec(&(wide.state, 0, false, &wide.rng)).unwrap(),
    ];
    let only = |number: usize| (0..all.len()).map(|i| i == number).collect::<Vec<_>>();
    assert_eq!(reads::<Acrobot<Portable>>(&all), only(0));
    assert_eq!(reads::<Acrobot<Fast>>(&all), only(1));
    assert_eq!(reads::<Member<f32>>(&all), only(2));
    assert_eq!(reads::<Member<f64>>(&all), only(3));

    // What had no version began with the length of link 1, m, or with θ1, rad: none so large.
    for bytes in &all[..4] {
        assert!(f64::from_le_bytes(bytes[..8].try_into().unwrap()) > 1e200);
        assert!(f32::from_le_bytes(bytes[..4].try_into().unwrap()) > 1e30);
    }
}
