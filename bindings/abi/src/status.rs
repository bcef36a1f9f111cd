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

/// Why a call was rejected with ACROBOT_ERROR_OUT_OF_RANGE. acrobot_error_text has a text for each.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum acrobot_error_kind_t {
    ACROBOT_OUT_OF_RANGE = 0,
    /// An element of a matrix, a result, or what leads to it is not finite.
    ACROBOT_NOT_FINITE = 1,
    ACROBOT_NOT_SYMMETRIC = 2,
    ACROBOT_NOT_SEMIDEFINITE = 3,
    /// `value` is the first velocity that is not 0, or acceleration that is too large.
    ACROBOT_NOT_IN_EQUILIBRIUM = 4,
    /// The torque does not reach a motion that grows or persists.
    ACROBOT_NOT_STABILIZABLE = 5,
    /// The weights do not see a motion that persists.
    ACROBOT_NOT_DETECTABLE = 6,
    /// The error of a gain can be above 1e-9 of its largest element, or rounding breaks it.
    ACROBOT_ILL_CONDITIONED = 7,
    /// So many tries find no plan.
    ACROBOT_NO_PLAN = 8,
    /// The measured angles do not show a motion that grows or persists.
    ACROBOT_NOT_OBSERVABLE = 9,
    /// The noise does not excite a motion that persists.
    ACROBOT_NOT_EXCITED = 10,
}

use acrobot_error_kind_t::*;

/// Why a number is out of range, as UTF-8:
/// `printf("%s must be %s, got %g", error.name, error.rule, error.value)`.
#[repr(C)]
pub struct acrobot_error_t {
    pub value: f64,
    /// One of acrobot_error_kind_t.
    pub kind: c_int,
    /// `"dt"`
    pub name: [c_char; 24],
    /// `"s"`
    pub unit: [c_char; 16],
    /// `"finite and above 0 s"`
    pub rule: [c_char; 80],
}

/// Why a call was rejected; for ACROBOT_ERROR_OUT_OF_RANGE `name must be rule unit, got value`.
pub struct Rejected {
    status: acrobot_status_t,
    kind: acrobot_error_kind_t,
    name: &'static str,
    value: f64,
    unit: &'static str,
    rule: &'static str,
}

impl Rejected {
    pub fn number(name: &'static str, value: f64, unit: &'static str, rule: &'static str) -> Self {
        let (status, kind) = (ACROBOT_ERROR_OUT_OF_RANGE, ACROBOT_OUT_OF_RANGE);
        Self { status, kind, name, value, unit, rule }
    }

    /// Fills the caller's error if a number is out of range. Inlined, because a function without an
    /// error should not contain it.
    #[inline(always)]
    pub unsafe fn explain(&self, error: *mut acrobot_error_t) {
        if !error.is_null() && matches!(self.status, ACROBOT_ERROR_OUT_OF_RANGE) {
            error.write(self.explained());
        }
    }

    #[inline(never)] // saves flash
    fn explained(&self) -> acrobot_error_t {
        let space = if self.unit.is_empty() { "" } else { " " };
        acrobot_error_t {
            value: self.value,
            kind: self.kind as c_int,
            name: text([self.name, "", ""]),
            unit: text([self.unit, "", ""]),
            rule: text([self.rule, space, self.unit]),
        }
    }
}

impl From<acrobot_status_t> for Rejected {
    fn from(status: acrobot_status_t) -> Self {
        Self { status, ..Self::number("", 0.0, "", "") }
    }
}

impl From<Error> for Rejected {
    // In firmware a function has only the kinds that it needs; in WebAssembly all share one copy.
    #[cfg_attr(not(target_family = "wasm"), inline(always))]
    fn from(error: Error) -> Self {
        match error {
            Error::OutOfRange { name, value, unit, rule } => Self::number(name, value, unit, rule),
            Error::SharedParams => ACROBOT_ERROR_SHARED_PARAMS.into(),
            Error::UnknownAction(_) => ACROBOT_ERROR_UNKNOWN_ACTION.into(),
            Error::NoSuchIndex { .. } => ACROBOT_ERROR_NO_SUCH_INDEX.into(),
            Error::EmptyBatch | Error::WrongLength { .. } => ACROBOT_ERROR_WRONG_COUNT.into(),
            error => Self::of_kind(error),
        }
    }
}

impl Rejected {
    #[inline(never)] // saves flash
    fn of_kind(error: Error) -> Self {
        let of_kind =
            |kind, name, value, rule| Self { kind, ..Self::number(name, value, "", rule) };
        // Few rules, because each firmware contains their texts.
        let no_gain = |kind, value| {
            of_kind(kind, "gain", value, "finite; target, dt, gravity, weights or noise allow none")
        };
        let matrix =
            |kind, name, value| of_kind(kind, name, value, "symmetric and positive semidefinite");
        match error {
            Error::NotFinite { name, value } => {
                of_kind(ACROBOT_NOT_FINITE, name, value, "finite in each element")
            }
            Error::NotSymmetric { name, upper, .. } => matrix(ACROBOT_NOT_SYMMETRIC, name, upper),
            Error::NotSemidefinite { name, value } => matrix(ACROBOT_NOT_SEMIDEFINITE, name, value),
            Error::NotInEquilibrium { rate, .. } => {
                let rule = "in equilibrium: at rest, accelerating at most 0.25 % of a fall";
                of_kind(ACROBOT_NOT_IN_EQUILIBRIUM, "target", rate, rule)
            }
            Error::NoPlan { tries } => {
                of_kind(ACROBOT_NO_PLAN, "tries", tries.into(), "enough to find a plan")
            }
            Error::NotStabilizable => no_gain(ACROBOT_NOT_STABILIZABLE, f64::NAN),
            Error::NotDetectable => no_gain(ACROBOT_NOT_DETECTABLE, f64::NAN),
            Error::NotObservable => no_gain(ACROBOT_NOT_OBSERVABLE, f64::NAN),
            Error::NotExcited => no_gain(ACROBOT_NOT_EXCITED, f64::NAN),
            Error::IllConditioned { error } => no_gain(ACROBOT_ILL_CONDITIONED, error),
            _ => no_gain(ACROBOT_OUT_OF_RANGE, f64::NAN),
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

/// What Rust's `Error::message` says of the `kind` of an error. It is constant: do not free it.
// Other kinds than 0 are those of control.
#[cfg(feature = "control")]
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_error_text(kind: c_int) -> *const c_char {
    const X: f64 = 0.0;
    // In the order of acrobot_error_kind_t.
    static TEXTS: [[c_char; 88]; 11] = [
        constant(Error::OutOfRange { name: "", value: X, unit: "", rule: "" }),
        constant(Error::NotFinite { name: "", value: X }),
        constant(Error::NotSymmetric { name: "", upper: X, lower: X }),
        constant(Error::NotSemidefinite { name: "", value: X }),
        constant(Error::NotInEquilibrium { rate: X, largest: X }),
        constant(Error::NotStabilizable),
        constant(Error::NotDetectable),
        constant(Error::IllConditioned { error: X }),
        constant(Error::NoPlan { tries: 0 }),
        constant(Error::NotObservable),
        constant(Error::NotExcited),
    ];
    let index = usize::try_from(kind).unwrap_or(usize::MAX);
    TEXTS.get(index).map_or(c"unknown kind".as_ptr(), |text| text.as_ptr())
}

/// The message of an error, and zero bytes.
#[cfg(feature = "control")]
const fn constant(error: Error) -> [c_char; 88] {
    let (message, mut text, mut i) = (error.message().as_bytes(), [0; 88], 0);
    while i < message.len() {
        text[i] = message[i] as c_char;
        i += 1;
    }
    text
}
