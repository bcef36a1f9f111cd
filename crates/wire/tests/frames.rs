//! A frame has its message, or an error: no damage goes unnoticed, and a message after it arrives.
//! docs/real.md says how long frames are.

use acrobot::Params;
use acrobot::control::mpc::Settings;
use wire::{Command, Decoder, Error, LONGEST, Load, Message, VERSION, encode};

const SAMPLE: Message = Message::Sample { tick: 4999, counts: [-3000, 30_000], torque: -1.5 };

fn frame(message: &impl serde::Serialize) -> Vec<u8> {
    encode(message, &mut [0; LONGEST]).to_vec()
}

fn decode<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Vec<Result<T, Error>> {
    let mut decoder = Decoder::new();
    bytes.iter().filter_map(|&byte| decoder.push(byte)).collect()
}

#[test]
fn messages_arrive() {
    let params = Params { max_velocity1: f64::INFINITY, ..Params::SWINGUP }.cast();
    let settings =
        Settings { params, limit: 6.0, counts: [i32::MAX; 2], delay: 0.01, plan_timeout: 1.0 };
    let control = Command::Control { settings, zeros: [i32::MIN; 2], played: None };
    let load = Load { slowest: u32::MAX, slices: u32::MAX, slice_ticks: 86, ram: 32_160 };
    let estimate = Message::Estimate { state: [1.0; 4], misses: 0.5, plan_age: 0.1, load };
    let received = decode::<Command>(&frame(&control));
    assert_eq!(format!("{received:?}"), format!("[Ok({control:?})]"));
    assert_eq!(decode(&[frame(&SAMPLE), frame(&estimate)].concat()), [Ok(SAMPLE), Ok(estimate)]);
    let lengths = [frame(&SAMPLE).len(), frame(&estimate).len(), frame(&control).len()];
    assert_eq!(lengths, [17, 44, 124]);
    // Bytes of 10 bits.
    assert_eq!([115_200, 1_000_000].map(|baud| baud / 10 / lengths[0]), [677, 5882]);
}

#[test]
fn damage_is_noticed() {
    let whole = frame(&SAMPLE);
    for i in 0..whole.len() {
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[i] ^= 1 << bit;
            let found = decode::<Message>(&[bytes, whole.clone()].concat());
            assert!(found.iter().filter(|found| found.is_ok()).all(|found| *found == Ok(SAMPLE)));
            assert!(found.contains(&Err(Error::Damaged)), "{i} {bit} {found:?}");
        }
        let mut shorter = whole.clone();
        shorter.remove(i);
        assert!(decode::<Message>(&shorter).iter().all(|found| *found == Err(Error::Damaged)));
    }
    let noise = [vec![7; 3 * LONGEST], vec![0], whole].concat();
    assert_eq!(decode(&noise), [Err(Error::Damaged), Ok(SAMPLE)]);
}

#[test]
fn another_version_is_named() {
    // By hand: version, message, CRC, then COBS, which only replaces zeros.
    let body = [VERSION + 1, 1];
    let crc = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740).checksum(&body);
    let mut bytes = [5, 0, 0, 0, 0, 0];
    bytes[1..3].copy_from_slice(&body);
    bytes[3..5].copy_from_slice(&crc.to_le_bytes());
    assert_eq!(decode::<Message>(&bytes), [Err(Error::Version(VERSION + 1))]);
}
