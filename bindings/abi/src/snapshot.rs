//! Snapshots: what Rust's postcard writes of an acrobot or a batch, and a CRC-32 of it.

use core::ffi::c_void;

use acrobot::batch::Batch;
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use postcard::Deserializer;
use serde::Serialize;

use crate::batch::{HEADER, MEMORY, acrobot_batch_t, place};
use crate::memory::{Holder, Span, array, check, check_apart, read_slice};
use crate::single::acrobot_t;
use crate::status::{Rejected, acrobot_status_t, acrobot_status_t::*, status};
use crate::task::BatchTask;

/// Bytes of a snapshot of an acrobot, at most.
pub const ACROBOT_SNAPSHOT_SIZE: usize = 224;

const CHECKSUM: usize = 4;

const _: () =
    assert!(<acrobot_t as Holder>::Value::MAX_SNAPSHOT_SIZE + CHECKSUM <= ACROBOT_SNAPSHOT_SIZE);

fn checksum(bytes: &[u8]) -> [u8; CHECKSUM] {
    Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC).checksum(bytes).to_le_bytes()
}

/// Writes a snapshot of something in a holder.
unsafe fn save<H: Holder, T: Serialize>(
    holder: *const H,
    (bytes, size): (*mut u8, usize),
    length: *mut usize,
    value: impl FnOnce(&H::Value) -> &T,
) -> acrobot_status_t {
    status(|| {
        check(length)?;
        let bytes = array(bytes, size)?;
        check_apart(&[H::span(holder)?, Span::of(bytes), Span::new(length, 1)])?;
        let written = postcard::to_slice(value(H::value(holder)?), &mut *bytes);
        let len = written.map_err(|_| ACROBOT_ERROR_BUFFER_TOO_SMALL)?.len();
        let parts = (*bytes).split_at_mut_checked(len);
        let (content, rest) = parts.ok_or(ACROBOT_ERROR_BUFFER_TOO_SMALL)?;
        *rest.first_chunk_mut().ok_or(ACROBOT_ERROR_BUFFER_TOO_SMALL)? = checksum(content);
        length.write(len + CHECKSUM);
        Ok(())
    })
}

/// A snapshot without its checksum.
unsafe fn open<'a>(bytes: *const u8, length: usize) -> Result<&'a [u8], Rejected> {
    match read_slice(bytes, length)?.split_last_chunk() {
        Some((content, sum)) if checksum(content) == *sum => Ok(content),
        _ => Err(ACROBOT_ERROR_DAMAGED_SNAPSHOT.into()),
    }
}

fn other<E>(_: E) -> Rejected {
    ACROBOT_ERROR_OTHER_SNAPSHOT.into()
}

/// Writes a snapshot into `bytes`, which has `size` bytes: ACROBOT_SNAPSHOT_SIZE is enough. An
/// acrobot that loads it continues with the same bits, in any language.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_save(
    acrobot: *const acrobot_t,
    bytes: *mut u8,
    size: usize,
    length: *mut usize,
) -> acrobot_status_t {
    save(acrobot, (bytes, size), length, |value| value)
}

/// Makes an acrobot of a snapshot.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_load(
    acrobot: *mut acrobot_t,
    bytes: *const u8,
    length: usize,
) -> acrobot_status_t {
    status(|| {
        check(acrobot)?;
        check_apart(&[Span::new(acrobot, 1), Span::new(bytes, length)])?;
        let value = postcard::take_from_bytes(open(bytes, length)?).map_err(other)?;
        whole(value.1)?;
        Holder::init(acrobot, value.0)
    })
}

fn whole(rest: &[u8]) -> Result<(), Rejected> {
    if rest.is_empty() { Ok(()) } else { Err(other(())) }
}

/// Bytes of a snapshot of a batch of `count` acrobots, at most.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_batch_snapshot_size(count: usize) -> usize {
    count.saturating_mul(160 + MEMORY).saturating_add(HEADER)
}

/// As acrobot_save, for a batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_save(
    batch: *const acrobot_batch_t,
    bytes: *mut u8,
    size: usize,
    length: *mut usize,
) -> acrobot_status_t {
    save(batch, (bytes, size), length, |placed| &placed.batch)
}

/// The first fields of a batch's snapshot: the number of acrobots and one, type, version, names of
/// task and arithmetic, the task, bounds, limit of steps, when resets are, and whether parameters
/// are own.
type Beginning<'a> = (usize, &'a [u8], u32, &'a [u8], &'a [u8], BatchTask, [f64; 2], u32, u8, bool);

fn saved(content: &[u8]) -> Result<(usize, bool), Rejected> {
    let (beginning, _) = postcard::take_from_bytes::<Beginning<'_>>(content).map_err(other)?;
    let (elements, .., own_params) = beginning;
    // An acrobot has more than 89 bytes. A larger number could take all memory.
    let count = elements.checked_sub(1).filter(|count| *count <= content.len() / 89);
    Ok((count.ok_or(ACROBOT_ERROR_OTHER_SNAPSHOT)?, own_params))
}

/// The number of acrobots in a snapshot of a batch, and whether they have own parameters.
/// acrobot_batch_size of these is the memory that acrobot_batch_load needs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_saved_count(
    bytes: *const u8,
    length: usize,
    count: *mut usize,
    own_params: *mut bool,
) -> acrobot_status_t {
    status(|| {
        check(count)?;
        check(own_params)?;
        let (saved_count, saved_own_params) = saved(open(bytes, length)?)?;
        count.write(saved_count);
        own_params.write(saved_own_params);
        Ok(())
    })
}

/// Makes a batch of a snapshot in `memory`, which has `size` bytes. `batch` receives its address.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_load(
    memory: *mut c_void,
    size: usize,
    bytes: *const u8,
    length: usize,
    batch: *mut *mut acrobot_batch_t,
) -> acrobot_status_t {
    status(|| {
        check_apart(&[Span::new(memory.cast::<u8>(), size), Span::new(bytes, length)])?;
        let content = open(bytes, length)?;
        place(memory, size, saved(content)?, batch, |memory| {
            let mut reader = Deserializer::from_bytes(content);
            let batch = Batch::from_snapshot(memory, &mut reader).map_err(other)?;
            whole(reader.finalize().map_err(other)?)?;
            Ok(batch)
        })
    })
}
