//! The caller's memory: what is checked before a reference into it is made.

use core::{ptr, slice};

use crate::status::{Rejected, acrobot_status_t::*};

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
    // SAFETY: the header demands that the pointer is valid.
    Ok(unsafe { from.read() })
}

/// Where a result goes. No reference, because it may contain anything.
pub struct Out<T>(*mut T);

impl<T> Out<T> {
    /// Rejects a result that would overwrite the holder.
    pub unsafe fn new<H: Holder>(to: *mut T, holder: *const H) -> Result<Self, Rejected> {
        check(to)?;
        // SAFETY: as in the caller.
        check_apart(&[Span::new(to, 1), unsafe { H::span(holder)? }])?;
        Ok(Self(to))
    }

    /// For a result that the caller may not want.
    pub unsafe fn optional<H: Holder>(to: *mut T, holder: *const H) -> Result<Self, Rejected> {
        if to.is_null() {
            return Ok(Self(to));
        }
        // SAFETY: as in the caller.
        unsafe { Self::new(to, holder) }
    }

    pub fn write(self, value: T) {
        if !self.0.is_null() {
            // SAFETY: the header demands that the pointer is valid.
            unsafe { self.0.write(value) }
        }
    }
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

    /// Writes the value.
    unsafe fn init(this: *mut Self, value: Self::Value) -> Result<(), Rejected> {
        check(this)?;
        let tagged = Tagged {
            tag: Self::TAG,
            value,
        };
        // SAFETY: a holder is at least as large and as aligned as the tagged value, and belongs to the caller.
        unsafe { this.cast::<Tagged<Self>>().write(tagged) }
        Ok(())
    }

    /// The value, if the memory is initialized.
    unsafe fn value<'a>(this: *const Self) -> Result<&'a Self::Value, Rejected> {
        check(this)?;
        let tagged: *const Tagged<Self> = this.cast();
        // SAFETY: the tag says that `init` has written the value.
        unsafe {
            if (*tagged).tag != Self::TAG {
                return Err(ACROBOT_ERROR_NOT_INITIALIZED.into());
            }
            Ok(&(*tagged).value)
        }
    }

    /// As [`value`](Self::value), to change it.
    unsafe fn value_mut<'a>(this: *mut Self) -> Result<&'a mut Self::Value, Rejected> {
        // SAFETY: as in the caller.
        unsafe { Self::value(this)? };
        // SAFETY: checked in the line above.
        Ok(unsafe { &mut (*this.cast::<Tagged<Self>>()).value })
    }
}

/// What the memory of a holder contains.
#[repr(C)]
pub struct Tagged<T: Holder> {
    tag: u32,
    value: T::Value,
}

/// Does not compile if the holder is too small or not aligned enough on this target.
pub const fn fits<T: Holder>() {
    assert!(size_of::<Tagged<T>>() <= size_of::<T>());
    assert!(align_of::<Tagged<T>>() <= align_of::<T>());
}

/// The addresses of an argument, to find out whether arguments overlap.
#[derive(Clone, Copy)]
pub struct Span {
    start: usize,
    bytes: usize,
}

impl Span {
    /// No address: what an array that is not there overlaps.
    const NONE: Self = Self { start: 0, bytes: 0 };

    pub fn new<T>(start: *const T, count: usize) -> Self {
        Self {
            start: start.addr(),
            bytes: count.saturating_mul(size_of::<T>()),
        }
    }

    fn overlaps(self, other: Self) -> bool {
        let contains = |one: Self, start: usize| start.wrapping_sub(one.start) < one.bytes;
        contains(self, other.start) || contains(other, self.start)
    }
}

/// Rejects arguments that overlap.
pub fn check_apart(spans: &[Span]) -> Result<(), Rejected> {
    let mut rest = spans.iter();
    while let Some(span) = rest.next() {
        if rest.clone().any(|other| span.overlaps(*other)) {
            return Err(ACROBOT_ERROR_OVERLAP.into());
        }
    }
    Ok(())
}

/// An array of the caller.
#[derive(Clone, Copy)]
pub struct Array<T> {
    start: *mut T,
    count: usize,
}

impl<T> Array<T> {
    pub fn new(start: *mut T, count: usize) -> Result<Self, Rejected> {
        check(start)?;
        Ok(Self { start, count })
    }

    /// An array that the caller may omit.
    pub fn optional(start: *mut T, count: usize) -> Result<Option<Self>, Rejected> {
        if start.is_null() {
            return Ok(None);
        }
        Self::new(start, count).map(Some)
    }

    pub fn start(&self) -> *const T {
        self.start
    }

    pub fn span(&self) -> Span {
        Span::new(self.start, self.count)
    }

    pub fn span_of(array: &Option<Self>) -> Span {
        array.as_ref().map_or(Span::NONE, Self::span)
    }

    pub unsafe fn get<'a>(&self) -> &'a [T] {
        // SAFETY: the header demands that the array is valid.
        unsafe { slice::from_raw_parts(self.start, self.count) }
    }

    /// The caller has checked that no other array overlaps it.
    pub unsafe fn get_mut<'a>(&self) -> &'a mut [T] {
        // SAFETY: as above.
        unsafe { slice::from_raw_parts_mut(self.start, self.count) }
    }
}

impl Array<bool> {
    /// As [`get_mut`](Self::get_mut). All elements become false, because memory may contain bytes that no `bool` has.
    pub unsafe fn cleared<'a>(&self) -> &'a mut [bool] {
        // SAFETY: as above.
        unsafe {
            ptr::write_bytes(self.start, 0, self.count);
            self.get_mut()
        }
    }
}
