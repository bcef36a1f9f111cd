//! The caller's memory: what is checked before a reference into it is made.

use core::ptr;

use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, acrobot_status_t::*, status};

/// Rejects a pointer that cannot point to a `T`.
pub fn check<T>(pointer: *const T) -> Result<(), Rejected> {
    if pointer.is_null() {
        Err(ACROBOT_ERROR_NULL.into())
    } else if !pointer.is_aligned() {
        Err(ACROBOT_ERROR_MISALIGNED.into())
    } else {
        Ok(())
    }
}

/// Reads an argument.
pub unsafe fn read<T: Copy>(from: *const T) -> Result<T, Rejected> {
    check(from)?;
    Ok(from.read())
}

/// A type of the header whose memory holds a Rust value.
pub trait Holder: Sized {
    type Value;

    /// Marks initialized memory.
    const TAG: u32;

    /// The memory that belongs to the value.
    unsafe fn span(this: *const Self) -> Result<Span, Rejected> {
        Ok(Span::new(this, 1))
    }

    /// Rejects a value that must not be at this address.
    fn check_address(_: &Self::Value, _: *const Self) -> Result<(), Rejected> {
        Ok(())
    }

    /// Writes the value.
    unsafe fn init(this: *mut Self, value: Self::Value) -> Result<(), Rejected> {
        check(this)?;
        // Does not compile if the holder is too small or not aligned enough on this target.
        const {
            assert!(size_of::<Tagged<Self>>() <= size_of::<Self>());
            assert!(align_of::<Tagged<Self>>() <= align_of::<Self>());
        }
        // Field by field, because a whole one would be on the stack first.
        let to = this.cast::<Tagged<Self>>();
        (&raw mut (*to).value).write(value);
        (&raw mut (*to).tag).write(Self::TAG);
        Ok(())
    }

    /// The value, if the memory is initialized.
    unsafe fn value<'a>(this: *const Self) -> Result<&'a Self::Value, Rejected> {
        check(this)?;
        let tagged: *const Tagged<Self> = this.cast();
        if (*tagged).tag != Self::TAG {
            return Err(ACROBOT_ERROR_NOT_INITIALIZED.into());
        }
        // The tag says that `init` has written the value.
        let value = &(*tagged).value;
        Self::check_address(value, this)?;
        Ok(value)
    }

    /// As [`value`](Self::value), to change it.
    unsafe fn value_mut<'a>(this: *mut Self) -> Result<&'a mut Self::Value, Rejected> {
        Self::value(this)?;
        Ok(&mut (*this.cast::<Tagged<Self>>()).value)
    }
}

/// What the memory of a holder contains.
#[repr(C)]
pub struct Tagged<T: Holder> {
    tag: u32,
    value: T::Value,
}

/// Initializes a holder. Writes why a number was rejected, where not null.
pub unsafe fn init<H: Holder>(
    holder: *mut H,
    error: *mut acrobot_error_t,
    call: impl FnOnce() -> Result<H::Value, Rejected>,
) -> acrobot_status_t {
    status(|| {
        check_result(error, holder)?;
        // `?` would copy the value.
        match call() {
            Ok(value) => H::init(holder, value),
            Err(rejected) => {
                rejected.explain(error);
                Err(rejected)
            }
        }
    })
}

/// Changes a holder's value. Writes the result, or why a number was rejected, where not null.
pub unsafe fn change<H: Holder, T>(
    holder: *mut H,
    result: *mut T,
    error: *mut acrobot_error_t,
    call: impl FnOnce(&mut H::Value) -> Result<T, Rejected>,
) -> acrobot_status_t {
    status(|| {
        check_result(error, holder)?;
        check_result(result, holder)?;
        let value =
            H::value_mut(holder).and_then(call).inspect_err(|rejected| rejected.explain(error))?;
        if !result.is_null() {
            result.write(value);
        }
        Ok(())
    })
}

/// Writes something about a holder's value.
pub unsafe fn get<H: Holder, T>(
    holder: *const H,
    result: *mut T,
    call: impl FnOnce(&H::Value) -> Result<T, Rejected>,
) -> acrobot_status_t {
    status(|| {
        check(result)?;
        check_result(result, holder)?;
        result.write(call(H::value(holder)?)?);
        Ok(())
    })
}

/// The addresses of an argument, to find out whether arguments overlap.
pub struct Span {
    start: usize,
    bytes: usize,
}

impl Span {
    pub fn new<T>(start: *const T, count: usize) -> Self {
        Self { start: start.addr(), bytes: count.saturating_mul(size_of::<T>()) }
    }

    pub fn of<T>(array: *const [T]) -> Self {
        Self::new(array.cast::<T>(), array.len())
    }

    fn overlaps(&self, other: &Self) -> bool {
        let contains = |one: &Self, start: usize| start.wrapping_sub(one.start) < one.bytes;
        contains(self, other.start) || contains(other, self.start)
    }
}

/// Rejects arguments that overlap.
pub fn check_apart(spans: &[Span]) -> Result<(), Rejected> {
    let mut rest = spans.iter();
    while let Some(span) = rest.next() {
        if rest.clone().any(|other| span.overlaps(other)) {
            return Err(ACROBOT_ERROR_OVERLAP.into());
        }
    }
    Ok(())
}

/// An array of the caller. No reference, because it may contain anything.
pub fn array<T>(start: *mut T, count: usize) -> Result<*mut [T], Rejected> {
    check(start)?;
    Ok(ptr::slice_from_raw_parts_mut(start, count))
}

/// An array of the caller that is valid whatever it contains.
pub unsafe fn read_slice<'a, T: Copy>(start: *const T, count: usize) -> Result<&'a [T], Rejected> {
    Ok(&*array(start.cast_mut(), count)?)
}

/// Rejects a result or error that would overwrite the holder. The caller may omit it.
pub unsafe fn check_result<T, H: Holder>(to: *const T, holder: *const H) -> Result<(), Rejected> {
    if to.is_null() {
        return Ok(());
    }
    check(to)?;
    check_apart(&[Span::new(to, 1), H::span(holder)?])
}
