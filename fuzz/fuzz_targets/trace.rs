//! Texts: the actions that the example `trace` reads, seeds, and names of environments.

#![no_main]

use acrobot::env::{Error, make};
use acrobot::numpy::SeedSequence;
use libfuzzer_sys::fuzz_target;

#[path = "../../examples/trace/actions.rs"]
mod actions;

fuzz_target!(|bytes: &[u8]| {
    check_actions(bytes);
    if let Ok(text) = str::from_utf8(bytes) {
        check_seed(text);
        check_name(text);
    }
});

fn check_actions(bytes: &[u8]) {
    let is_action = |byte: &u8| (b'0'..=b'2').contains(byte);
    let is_white = |byte: &u8| (b'\t'..=b'\r').contains(byte) || *byte == b' ';
    let unknown = bytes
        .iter()
        .position(|byte| !is_action(byte) && !is_white(byte));
    match (actions::parse(bytes), unknown) {
        (Ok(actions), None) => {
            let expected = bytes
                .iter()
                .copied()
                .filter(is_action)
                .map(|byte| byte - b'0');
            assert!(actions.into_iter().map(u8::from).eq(expected));
        }
        (Err(reason), Some(index)) => {
            assert!(
                reason.ends_with(&format!(" as byte {}", index + 1)),
                "{reason}"
            );
        }
        (actions, unknown) => panic!("{actions:?}, {unknown:?}"),
    }
}

fn check_seed(text: &str) {
    let parsed = text.parse::<SeedSequence>();
    let (len, limit) = (text.len(), 4300);
    if len > limit {
        assert_eq!(parsed, Err(acrobot::Error::SeedTooLong { len, limit }));
        return;
    }
    let Some(index) = text.chars().position(|c| !c.is_ascii_digit()) else {
        assert_eq!(parsed.is_ok(), !text.is_empty());
        if let (Ok(seed), Ok(number)) = (&parsed, text.parse::<u128>()) {
            let words = [0, 32, 64, 96].map(|shift| (number >> shift) as u32);
            assert_eq!(*seed, SeedSequence::from_words(&words));
        }
        if let Ok(seed) = parsed
            && len <= limit - 2
        {
            assert_eq!(format!("00{text}").parse(), Ok(seed));
        }
        return;
    };
    let found = text.chars().nth(index);
    let position = index + 1;
    assert_eq!(
        parsed,
        Err(acrobot::Error::MalformedSeed { found, position })
    );
}

fn check_name(text: &str) {
    match make(text) {
        Ok(_) => assert!(matches!(text, "Acrobot-v0" | "Acrobot-v1")),
        // A long name is cut.
        Err(Error::UnknownId(id)) => assert!(
            id == text
                || id
                    .strip_suffix('…')
                    .is_some_and(|start| text.starts_with(start)),
            "{id}"
        ),
        Err(other) => panic!("{other}"),
    }
}
