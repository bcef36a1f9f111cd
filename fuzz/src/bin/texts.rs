//! Texts in place of seeds and of names of environments.

#![no_main]

use acrobot::env::{Error, make};
use acrobot::numpy::SeedSequence;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(text) = str::from_utf8(bytes) {
        check_seed(text);
        check_name(text);
    }
});

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
