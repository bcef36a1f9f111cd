//! Snapshots: those that Rust makes of a `TimeLimit<Acrobot<_>>` and of a `VecBatch` with
//! postcard's `crc32` functions. The crate's code, for two types of each, would take 13 KB more
//! than these fields one by one.

use std::ptr;
use std::slice;

use acrobot::arithmetic::Arithmetic;
use acrobot::physics::Dynamics;
use acrobot::task::{Balance, Gymnasium, Swingup, Task};
use acrobot::{Fast, Params};
use postcard::ser_flavors::{Flavor, Slice};
use postcard::{Deserializer, Serializer, de_flavors};
use serde::{Deserialize, Serialize};

use memory::zeros;

/// Why JavaScript's snapshot is rejected, as JavaScript numbers it.
pub enum Rejected {
    Checksum = 1,
    /// Another type, version or task.
    Header,
    Contents,
}

/// What JavaScript gets: 0, or the reason.
pub fn code(loaded: Result<(), Rejected>) -> u32 {
    loaded.map_or_else(|rejected| rejected as u32, |()| 0)
}

/// Type, version, task and arithmetic.
type Header<'a> = (&'a str, u32, &'a str, &'a str);

/// As in the crate, whose snapshots the tests compare with.
fn header(of: &'static str, task: u32) -> Header<'static> {
    const VERSION: u32 = 6;
    let name = match task {
        0 => Gymnasium::NAME,
        1 => Swingup::NAME,
        _ => Balance::NAME,
    };
    (of, VERSION, name, Fast::NAME)
}

pub type Writer<'a> = Serializer<Slice<'a>>;
pub type Reader<'a> = Deserializer<'a, de_flavors::Slice<'a>>;

pub fn read<'a, T: Deserialize<'a>>(reader: &mut Reader<'a>) -> Option<T> {
    T::deserialize(reader).ok()
}

/// Reads a header. Returns its task.
pub fn read_header(reader: &mut Reader<'_>, of: &'static str) -> Result<u32, Rejected> {
    // Field by field: as a tuple it would take 2 KB more.
    let mut found = || Some((read(reader)?, read(reader)?, read(reader)?, read(reader)?));
    let found = found().ok_or(Rejected::Header)?;
    [0, 1, 2].into_iter().find(|task| found == header(of, *task)).ok_or(Rejected::Header)
}

pub fn write_header(of: &'static str, task: u32, writer: &mut Writer<'_>) -> postcard::Result<()> {
    let (of, version, task, arithmetic) = header(of, task);
    of.serialize(&mut *writer)?;
    version.serialize(&mut *writer)?;
    task.serialize(&mut *writer)?;
    arithmetic.serialize(&mut *writer)
}

/// Reads parameters or draws over others. Their own code would take 3 KB more.
pub fn read_params<'a, S: Copy + Deserialize<'a>>(
    reader: &mut Reader<'a>,
    mut params: Params<S>,
) -> Option<Params<S>> {
    let mut dynamics = Dynamics::Book;
    for (slot, number) in params.numbers_mut().into_iter().enumerate() {
        if slot == 16 {
            dynamics = read(reader)?;
        }
        *number = read(reader)?;
    }
    params.dynamics = dynamics;
    Some(params)
}

pub fn write_params<S: Copy + Serialize>(
    mut params: Params<S>,
    writer: &mut Writer<'_>,
) -> postcard::Result<()> {
    let dynamics = params.dynamics;
    for (slot, number) in params.numbers_mut().into_iter().enumerate() {
        if slot == 16 {
            dynamics.serialize(&mut *writer)?;
        }
        number.serialize(&mut *writer)?;
    }
    Ok(())
}

/// Allocates memory for a snapshot. Returns its address, or 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn snapshot_new(len: usize) -> *mut u8 {
    // SAFETY: a byte may be 0.
    let bytes: Option<Vec<u8>> = unsafe { zeros(len) };
    bytes.map_or(ptr::null_mut(), |bytes| bytes.leak().as_mut_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn snapshot_free(address: *mut u8, len: usize) {
    // SAFETY: JavaScript has the address from here, with the length.
    drop(unsafe { Vec::from_raw_parts(address, len, len) });
}

/// CRC-32 as in zlib.
fn checksum(bytes: &[u8]) -> [u8; 4] {
    let crc = bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            crc >> 1 ^ 0xedb8_8320 & (crc & 1_u32).wrapping_neg()
        })
    });
    (!crc).to_le_bytes()
}

/// Makes a snapshot of at most `limit` bytes. Returns its length, or 0 without memory. The address
/// and the length of its memory are in the words.
pub fn save(limit: usize, write: impl FnOnce(&mut Writer<'_>) -> postcard::Result<()>) -> usize {
    // SAFETY: a byte may be 0.
    let Some(mut bytes) = (unsafe { zeros(limit) }) else {
        return 0;
    };
    let mut writer = Serializer { output: Slice::new(&mut bytes) };
    let written = write(&mut writer).and_then(|()| writer.output.finalize());
    let len = written.map_or(0, |written| written.len());
    if let Some((content, rest)) = bytes.split_at_mut_checked(len)
        && let Some(to) = rest.first_chunk_mut()
    {
        *to = checksum(content);
    }
    memory::set(&[bytes.as_ptr().addr(), bytes.len()].map(|word| word as u32));
    bytes.leak();
    len + 4
}

/// A snapshot that JavaScript has written, without its checksum.
pub fn open<'a>(address: *const u8, len: usize) -> Result<Reader<'a>, Rejected> {
    // SAFETY: the memory is from here, and JavaScript frees it after the call.
    let snapshot = unsafe { slice::from_raw_parts(address, len) };
    match snapshot.split_last_chunk() {
        Some((content, crc)) if checksum(content) == *crc => Ok(Reader::from_bytes(content)),
        _ => Err(Rejected::Checksum),
    }
}
