//! What functions return, and why a number was rejected.

use core::ffi::{CStr, c_char, c_int};

use acrobot::Error;

use crate::memory::{Holder, Out};

/// What a function returns. Unless it is ACROBOT_OK, no acrobot has changed.
#[repr(u8)]
#[derive(Clone, Copy)]
pub enum acrobot_status_t {
    /// The function has done its work.
    ACROBOT_OK = 0,
    /// A pointer is null that must not be null.
    ACROBOT_ERROR_NULL = 1,
    /// A pointer is not aligned as its type demands; memory for a batch by ACROBOT_BATCH_ALIGN.
    ACROBOT_ERROR_MISALIGNED = 2,
    /// The memory has fewer bytes than the batch needs.
    ACROBOT_ERROR_BUFFER_TOO_SMALL = 3,
    /// The memory was not initialized by the `_init` function of its type, or has been overwritten.
    ACROBOT_ERROR_NOT_INITIALIZED = 4,
    /// The memory of a batch was copied to another address.
    ACROBOT_ERROR_MOVED = 5,
    /// The action is not 0, 1 or 2.
    ACROBOT_ERROR_UNKNOWN_ACTION = 6,
    /// A number is outside its range, infinite or NaN. An acrobot_error_t names it.
    ACROBOT_ERROR_OUT_OF_RANGE = 7,
    /// The count is not that of the batch's acrobots, or a new batch would have none.
    ACROBOT_ERROR_WRONG_COUNT = 8,
    /// The index is not below the count.
    ACROBOT_ERROR_NO_SUCH_INDEX = 9,
    /// Two arguments overlap: arrays, or a result and the acrobot or batch.
    ACROBOT_ERROR_OVERLAP = 10,
}

use acrobot_status_t::*;

/// Why a number was rejected. Functions fill it if they return ACROBOT_ERROR_OUT_OF_RANGE. The texts are UTF-8 and end
/// with a zero byte. Print it by `printf("%s must be %s %s, got %g", error.name, error.rule, error.unit, error.value)`.
/// A misaligned pointer to it is rejected even if all numbers are valid.
#[repr(C)]
pub struct acrobot_error_t {
    /// The value that was rejected, in `unit`.
    pub value: f64,
    /// The field or argument: `"dt"`.
    pub name: [c_char; 24],
    /// Its SI unit: `"s"`.
    pub unit: [c_char; 16],
    /// The rule: `"finite and above 0"`.
    pub rule: [c_char; 48],
}

/// Why a call was rejected.
pub enum Rejected {
    Status(acrobot_status_t),
    /// `name must be rule unit, got value`.
    OutOfRange {
        name: &'static str,
        value: f64,
        unit: &'static str,
        rule: &'static str,
    },
}

impl From<acrobot_status_t> for Rejected {
    fn from(status: acrobot_status_t) -> Self {
        Self::Status(status)
    }
}

impl From<Error> for Rejected {
    fn from(error: Error) -> Self {
        match error {
            Error::OutOfRange {
                name,
                value,
                unit,
                rule,
            } => Self::OutOfRange {
                name,
                value,
                unit,
                rule,
            },
            Error::NoInertia { name, value } => Self::OutOfRange {
                name,
                value,
                unit: "kg m²",
                rule: "(with the centre of mass on the joint) above 0",
            },
            // Of reset bounds: a library for C draws no parameters.
            Error::ReversedRange { low, unit, .. } => Self::OutOfRange {
                name: "low",
                value: low,
                unit,
                rule: "at most high in",
            },
            Error::UnknownAction(_) => Self::Status(ACROBOT_ERROR_UNKNOWN_ACTION),
            Error::NoSuchIndex { .. } => Self::Status(ACROBOT_ERROR_NO_SUCH_INDEX),
            // EmptyBatch and WrongLength. No function here can cause the others.
            _ => Self::Status(ACROBOT_ERROR_WRONG_COUNT),
        }
    }
}

/// The status of a call.
pub fn status(call: impl FnOnce() -> Result<(), Rejected>) -> acrobot_status_t {
    match call() {
        Ok(()) => ACROBOT_OK,
        Err(Rejected::Status(status)) => status,
        Err(Rejected::OutOfRange { .. }) => ACROBOT_ERROR_OUT_OF_RANGE,
    }
}

/// As [`status`]. Fills `error`, unless it is null, if a number is out of range.
pub unsafe fn explained<H: Holder>(
    error: *mut acrobot_error_t,
    holder: *const H,
    call: impl FnOnce() -> Result<(), Rejected>,
) -> acrobot_status_t {
    status(|| {
        // SAFETY: as in the caller.
        let error = unsafe { Out::optional(error, holder)? };
        let result = call();
        if let Err(Rejected::OutOfRange {
            name,
            value,
            unit,
            rule,
        }) = result
        {
            error.write(acrobot_error_t {
                value,
                name: text(name),
                unit: text(unit),
                rule: text(rule),
            });
        }
        result
    })
}

/// A text that ends with a zero byte.
fn text<const N: usize>(text: &str) -> [c_char; N] {
    let mut to = [0; N];
    for (to, from) in to.iter_mut().take(N - 1).zip(text.bytes()) {
        *to = from as c_char;
    }
    to
}

/// The text of a status, in English. It is constant: do not free it. An unknown status has a text, too.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_status_text(status: c_int) -> *const c_char {
    const TEXTS: [&CStr; 11] = [
        c"no error",
        c"a pointer is null",
        c"a pointer is not aligned",
        c"the memory is too small",
        c"the memory is not initialized",
        c"the batch was moved",
        c"the action is not 0, 1 or 2",
        c"a number is out of range",
        c"the count is not that of the batch",
        c"there is no acrobot with this index",
        c"two arguments overlap",
    ];
    let index = usize::try_from(status).unwrap_or(usize::MAX);
    let text = TEXTS.get(index).copied();
    text.unwrap_or(c"unknown status").as_ptr()
}
