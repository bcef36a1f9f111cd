//! What functions return, and why a number was rejected.

use core::ffi::{c_char, c_int};

use acrobot::Error;

#[repr(C)]
pub enum acrobot_status_t {
    ACROBOT_OK = 0,
    /// A pointer is null that must not be.
    ACROBOT_ERROR_NULL = 1,
    /// A pointer is not aligned as its type demands; a batch needs ACROBOT_BATCH_ALIGN.
    ACROBOT_ERROR_MISALIGNED = 2,
    ACROBOT_ERROR_BUFFER_TOO_SMALL = 3,
    /// No `_init` function has initialized the memory, or it has been overwritten.
    ACROBOT_ERROR_NOT_INITIALIZED = 4,
    /// The batch was copied to another address.
    ACROBOT_ERROR_MOVED = 5,
    ACROBOT_ERROR_UNKNOWN_ACTION = 6,
    /// A number is outside its range, infinite or NaN. An argument `error` says which.
    ACROBOT_ERROR_OUT_OF_RANGE = 7,
    /// The count is 0, or not that of the batch.
    ACROBOT_ERROR_WRONG_COUNT = 8,
    ACROBOT_ERROR_NO_SUCH_INDEX = 9,
    /// Two arguments overlap: arrays, or a result and the acrobot or batch.
    ACROBOT_ERROR_OVERLAP = 10,
    /// A snapshot has another checksum.
    ACROBOT_ERROR_DAMAGED_SNAPSHOT = 11,
    /// A snapshot is of another type, version or arithmetic, or contains what a setter rejects.
    ACROBOT_ERROR_OTHER_SNAPSHOT = 12,
    /// The batch has no memory for parameters of each acrobot.
    ACROBOT_ERROR_SHARED_PARAMS = 13,
}

use acrobot_status_t::*;

/// Why a number is out of range, as UTF-8:
/// `printf("%s must be %s, got %g", error.name, error.rule, error.value)`.
#[repr(C)]
pub struct acrobot_error_t {
    pub value: f64,
    /// `"dt"`
    pub name: [c_char; 24],
    /// `"s"`
    pub unit: [c_char; 16],
    /// `"finite and above 0 s"`
    pub rule: [c_char; 64],
}

/// Why a call was rejected; for ACROBOT_ERROR_OUT_OF_RANGE `name must be rule unit, got value`.
pub struct Rejected {
    status: acrobot_status_t,
    name: &'static str,
    value: f64,
    unit: &'static str,
    rule: &'static str,
}

impl Rejected {
    pub fn number(name: &'static str, value: f64, unit: &'static str, rule: &'static str) -> Self {
        Self { status: ACROBOT_ERROR_OUT_OF_RANGE, name, value, unit, rule }
    }

    /// Fills the caller's error if a number is out of range. Inlined, because a function without an
    /// error should not contain it.
    #[inline(always)]
    pub unsafe fn explain(&self, error: *mut acrobot_error_t) {
        if !error.is_null() && matches!(self.status, ACROBOT_ERROR_OUT_OF_RANGE) {
            let space = if self.unit.is_empty() { "" } else { " " };
            let explained = acrobot_error_t {
                value: self.value,
                name: text([self.name, "", ""]),
                unit: text([self.unit, "", ""]),
                rule: text([self.rule, space, self.unit]),
            };
            error.write(explained);
        }
    }
}

impl From<acrobot_status_t> for Rejected {
    fn from(status: acrobot_status_t) -> Self {
        Self { status, ..Self::number("", 0.0, "", "") }
    }
}

impl From<Error> for Rejected {
    fn from(error: Error) -> Self {
        match error {
            Error::OutOfRange { name, value, unit, rule } => Self::number(name, value, unit, rule),
            Error::SharedParams => ACROBOT_ERROR_SHARED_PARAMS.into(),
            Error::UnknownAction(_) => ACROBOT_ERROR_UNKNOWN_ACTION.into(),
            Error::NoSuchIndex { .. } => ACROBOT_ERROR_NO_SUCH_INDEX.into(),
            Error::EmptyBatch | Error::WrongLength { .. } => ACROBOT_ERROR_WRONG_COUNT.into(),
            Error::NotFinite { name, value } => {
                Self::number(name, value, "", "finite in each element")
            }
            Error::NotInEquilibrium { rate, .. } => {
                let rule = "in equilibrium: at rest, accelerating at most 0.25 % of a fall";
                Self::number("target", rate, "", rule)
            }
            Error::NoPlan { tries } => {
                Self::number("tries", tries.into(), "", "enough to find a plan")
            }
            // Not another status: each firmware would contain its text.
            _ => {
                let rule = "finite; target, dt, gravity and weights allow no regulator";
                Self::number("gain", f64::NAN, "", rule)
            }
        }
    }
}

/// The status of a call.
pub fn status(call: impl FnOnce() -> Result<(), Rejected>) -> acrobot_status_t {
    // Behind `black_box` no operation on an argument moves before the change of the mode.
    #[cfg(target_feature = "sse")]
    let (_callers, call) = (crate::mode::Replaced::by_default(), core::hint::black_box(call));
    call().map_or_else(|rejected| rejected.status, |()| ACROBOT_OK)
}

/// Texts one after the other, and a zero byte.
fn text<const N: usize>(texts: [&str; 3]) -> [c_char; N] {
    let mut to = [0; N];
    let bytes = texts.into_iter().flat_map(str::bytes);
    for (to, from) in to.iter_mut().take(N - 1).zip(bytes) {
        *to = from as c_char;
    }
    to
}

/// The text of any status. It is constant: do not free it.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_status_text(status: c_int) -> *const c_char {
    let text = match status {
        0 => c"no error",
        1 => c"a pointer is null",
        2 => c"a pointer is not aligned",
        3 => c"the memory is too small",
        4 => c"the memory is not initialized",
        5 => c"the batch was moved",
        6 => c"the action is not 0, 1 or 2",
        7 => c"a number is out of range",
        8 => c"the count is 0 or not that of the batch",
        9 => c"there is no acrobot with this index",
        10 => c"two arguments overlap",
        11 => c"the snapshot is damaged",
        12 => c"the snapshot is of another type, version or arithmetic",
        13 => c"the batch has no own parameters",
        _ => c"unknown status",
    };
    text.as_ptr()
}
