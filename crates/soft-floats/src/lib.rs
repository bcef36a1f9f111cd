#![doc = include_str!("../README.md")]
#![no_std]

#[cfg(all(
    target_os = "none",
    any(all(target_arch = "arm", target_abi = "eabi"), target_arch = "riscv32")
))]
mod symbols;

const SIGN: u32 = 1 << 31;
const INFINITY: u32 = 0x7f80_0000;
const NAN: u32 = 0x7fc0_0000;

/// a + b, all three as bits.
#[inline(always)]
#[must_use]
pub fn add(a: u32, b: u32) -> u32 {
    if a << 1 < b << 1 { add_ordered(b, a) } else { add_ordered(a, b) }
}

/// a − b, all three as bits.
#[inline(always)]
#[must_use]
pub fn sub(a: u32, b: u32) -> u32 {
    add(a, b ^ SIGN)
}

/// a + b for |a| ≥ |b|.
#[inline(always)]
fn add_ordered(a: u32, b: u32) -> u32 {
    let distance = exponent(a) - exponent(b);
    if distance > 25 {
        // |b| is less than a quarter of a's last place.
        return a;
    }
    if exponent(b) == 0 || exponent(a) == 255 {
        return add_rare(a, b);
    }
    // Below the last place are seven bits. The shift cuts off bits only beyond these, and they
    // decide only about ties.
    let (x, y) = (mantissa(a), mantissa(b) >> distance);
    let mut replaced = x >> 7;
    let mut sum;
    if (a ^ b) & SIGN == 0 {
        sum = x + y;
        if sum & SIGN != 0 {
            sum += 0x80;
            let is_tie = sum << 24 == 0;
            if is_tie || exponent(a) == 254 {
                return add_rare(a, b);
            }
            return (a >> 23 << 23) + (sum >> 8);
        }
    } else {
        sum = x - y;
        if sum >> 30 == 0 {
            if sum >> 29 == 0 || exponent(a) == 1 {
                return pack(a, exponent(a) as i32, sum);
            }
            sum <<= 1;
            replaced += 1 << 23;
        }
    }
    sum += 0x40;
    let mut rounded = sum >> 7;
    let is_tie = sum << 25 == 0;
    if is_tie {
        if distance > 7 {
            return add_rare(a, b);
        }
        rounded &= !1;
    }
    // a's exponent stays, unless the mantissa carries into it.
    a - replaced + rounded
}

/// [`add_ordered`] for any numbers.
#[cold]
#[inline(never)]
fn add_rare(a: u32, b: u32) -> u32 {
    if exponent(a) == 255 {
        let is_nan = a << 9 != 0 || exponent(b) == 255 && a != b;
        return if is_nan { NAN } else { a };
    }
    let ((exponent_a, x), (exponent_b, y)) = (unpack(a), unpack(b));
    let y = shift_right(y, exponent_a - exponent_b);
    let sum = if (a ^ b) & SIGN == 0 { x + y } else { x - y };
    if sum == 0 {
        return a & b & SIGN;
    }
    pack(a, exponent_a, sum)
}

/// a × b, all three as bits.
#[inline(always)]
#[must_use]
pub fn mul(a: u32, b: u32) -> u32 {
    let (exponent_a, exponent_b) = (exponent(a), exponent(b));
    if exponent_a == 0 || exponent_b == 0 || exponent_a == 255 || exponent_b == 255 {
        return mul_rare(a, b);
    }
    // Only at a tie the lower bits decide.
    let (high, _) = product(a, b);
    let (exponent, rounded);
    if high & SIGN == 0 {
        let high = high + 0x40;
        let is_tie = high << 25 == 0;
        if is_tie {
            return mul_rare(a, b);
        }
        exponent = (exponent_a + exponent_b).wrapping_sub(128);
        rounded = high >> 7;
    } else {
        let high = high + 0x80;
        let is_tie = high << 24 == 0;
        if is_tie {
            return mul_rare(a, b);
        }
        exponent = (exponent_a + exponent_b).wrapping_sub(127);
        rounded = high >> 8;
    }
    if exponent >= 254 {
        return mul_rare(a, b);
    }
    // The leading bit of the mantissa adds 1 to the exponent.
    ((a ^ b) & SIGN) + (exponent << 23) + rounded
}

/// [`mul`] for any numbers.
#[cold]
#[inline(never)]
fn mul_rare(a: u32, b: u32) -> u32 {
    let (sign, a, b) = ((a ^ b) & SIGN, a & !SIGN, b & !SIGN);
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    if large >= INFINITY {
        let is_nan = large > INFINITY || small == 0;
        return if is_nan { NAN } else { sign | INFINITY };
    }
    if small == 0 {
        return sign;
    }
    // If both are subnormal, the product is less than half of the smallest number anyway.
    let ((mut exponent, mut x), (exponent_large, _)) = (unpack(small), unpack(large));
    while x >> 30 == 0 {
        x <<= 1;
        exponent -= 1;
    }
    let (high, low) = product(x >> 7, large);
    let high = high | u32::from(low != 0);
    pack(sign, exponent + exponent_large - 127, high)
}

#[inline(always)]
fn exponent(x: u32) -> u32 {
    x << 1 >> 24
}

/// The mantissa of a normal number, with its leading bit in bit 30.
#[inline(always)]
fn mantissa(x: u32) -> u32 {
    (x << 8 | SIGN) >> 1
}

/// Exponent and mantissa of any finite number.
fn unpack(x: u32) -> (i32, u32) {
    match exponent(x) {
        0 => (1, x << 9 >> 2),
        exponent => (exponent as i32, mantissa(x)),
    }
}

/// The product of the mantissas of two normal numbers, 48 bits: the upper 32, and the lower 16 in
/// the upper half.
#[inline(always)]
fn product(a: u32, b: u32) -> (u32, u32) {
    const HAS_64_BIT_PRODUCT: bool = !cfg!(any(
        all(target_arch = "arm", not(target_has_atomic = "32")), // ARMv6-M
        all(target_arch = "riscv32", not(target_feature = "m")),
    ));
    if HAS_64_BIT_PRODUCT { wide_product(a, b) } else { narrow_product(a, b) }
}

#[inline(always)]
fn wide_product(a: u32, b: u32) -> (u32, u32) {
    let product = u64::from(a << 8 | SIGN) * u64::from(b << 8 | SIGN);
    ((product >> 32) as u32, product as u32)
}

#[inline(always)]
fn narrow_product(a: u32, b: u32) -> (u32, u32) {
    let upper = |x: u32| x >> 16 & 0xff | 0x80;
    let lower = |x: u32| x & 0xffff;
    let lowest = lower(a) * lower(b);
    let middle = upper(a) * lower(b) + lower(a) * upper(b);
    let high = ((upper(a) * upper(b)) << 16) + middle + (lowest >> 16);
    (high, lowest << 16)
}

/// x / 2^`distance`. The lowest bit is set if bits are cut off.
fn shift_right(x: u32, distance: i32) -> u32 {
    if distance > 31 {
        return u32::from(x != 0);
    }
    let shifted = x >> distance;
    shifted | u32::from(shifted << distance != x)
}

/// The number with this sign, exponent and mantissa, of which bit 30 counts 1, rounded. +0 if the
/// mantissa is 0.
#[inline(never)]
fn pack(sign: u32, mut exponent: i32, mut x: u32) -> u32 {
    let sign = sign & SIGN;
    if x == 0 {
        return 0;
    }
    if x & SIGN != 0 {
        x = shift_right(x, 1);
        exponent += 1;
    }
    while x >> 30 == 0 && exponent > 1 {
        x <<= 1;
        exponent -= 1;
    }
    if exponent < 1 {
        x = shift_right(x, 1 - exponent);
        exponent = 1;
    }
    if exponent > 254 {
        return sign | INFINITY;
    }
    let is_odd = x >> 7 & 1;
    let rounded = (x + 0x3f + is_odd) >> 7;
    sign + (((exponent - 1) as u32) << 23) + rounded
}

#[cfg(test)]
mod tests;
