//! Actions as text.

use acrobot::Action;

/// White space in Python but not in Rust.
const VERTICAL_TAB: u8 = 0x0b;

/// The actions of an input, or an error with the first other byte.
pub fn parse(input: &[u8]) -> Result<Vec<Action>, String> {
    let bytes = input
        .iter()
        .zip(1..)
        .filter(|(byte, _)| !(byte.is_ascii_whitespace() || **byte == VERTICAL_TAB));
    bytes
        .map(|(&byte, position)| {
            let action = Action::try_from(byte.wrapping_sub(b'0'));
            action.map_err(|_| {
                let found = byte.escape_ascii();
                format!("the input must be actions (0, 1 and 2) and white space, got '{found}' as byte {position}")
            })
        })
        .collect()
}
