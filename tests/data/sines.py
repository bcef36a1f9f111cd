"""Derives the constants of src/math/sines/correctly_rounded, bounds the errors of its two fast
paths, and records MPFR's correctly rounded sines and cosines in sines.txt in its folder, of 21
million arguments in two minutes. Fails if the source has other constants or an error exceeds its
margin.

The method is explained in the source, term by term in the order of the functions here.
"""

import sys
from fractions import Fraction
from pathlib import Path

import gmpy2
import mpmath as mp
import numpy as np

HERE = Path(__file__).parent
SOURCES = HERE.parents[1] / "src/math/sines/correctly_rounded"
MASK = 2**64 - 1
CHUNKS, CHUNK = 12, 250_000
MULTIPLIER = 0x9E3779B97F4A7C15
mp.mp.prec = 1600
PI = mp.pi


def check(file, constants):
    source = (SOURCES / file).read_text().replace("_", "")
    if missing := [constant for constant in constants if f"0x{constant:016x}" not in source]:
        sys.exit(f"{file} has no {', '.join(f'0x{constant:016x}' for constant in missing)}")


def words(x, n):
    """The first n words after the point."""
    whole = int(mp.floor(x * mp.mpf(2) ** (64 * n)))
    return [whole >> 64 * (n - 1 - i) & MASK for i in range(n)]


def bits(x):
    return int(np.float64(x).view(np.uint64))


# wide.rs

check("wide.rs", words(2 / PI, 21) + words(PI / 4, 3))

# integer.rs


def sine(w):
    u = PI / 4 * mp.sqrt(w)
    return mp.sin(u) / mp.sqrt(w)


def cosine(w):
    u = PI / 4 * mp.sqrt(w)
    return (1 - mp.cos(u)) / w


SINE_SERIES = [(-1) ** k * (PI / 4) ** (2 * k + 1) / mp.factorial(2 * k + 1) for k in range(24)]
COSINE_SERIES = [(-1) ** k * (PI / 4) ** (2 * k + 2) / mp.factorial(2 * k + 2) for k in range(24)]
# Bits after the point of each coefficient.
PLACES = [64, 67, 71, 76, 76, 76, 68, 68]


def fit(f):
    """Near minimax: interpolates at Chebyshev's nodes. Each coefficient is rounded in turn, the one
    of the highest power first, and the others are fitted again to compensate."""
    fixed = [mp.mpf(0)] * 8
    for last in reversed(range(8)):
        n = last + 1
        nodes = [(1 + mp.cos(PI * (2 * i + 1) / (2 * n))) / 2 for i in range(n)]
        rest = [f(w) - sum(fixed[k] * w**k for k in range(n, 8)) for w in nodes]
        solved = mp.lu_solve(mp.matrix([[w**k for k in range(n)] for w in nodes]), mp.matrix(rest))
        fixed[last] = mp.nint(solved[last] * mp.mpf(2) ** PLACES[last]) / mp.mpf(2) ** PLACES[last]
    # The roundings of the evaluation are more often up than down.
    fixed[0] -= mp.mpf(2) ** -64
    return fixed


def approximation(fixed, series):
    """The least and the greatest difference of the polynomial from the function over 0 <= w <= 1,
    in units of 2^-64."""
    difference = [(fixed[k] if k < 8 else 0) - c for k, c in enumerate(series)]
    slope = [k * c for k, c in enumerate(difference)][1:]
    curvature = sum(k * k * abs(c) for k, c in enumerate(difference))
    cells = 4096
    low, high = mp.inf, -mp.inf
    for i in range(cells):
        w = mp.mpf(2 * i + 1) / (2 * cells)
        middle = mp.polyval(difference[::-1], w)
        reach = abs(mp.polyval(slope[::-1], w)) / (2 * cells) + curvature / (8 * cells**2)
        low, high = min(low, middle - reach), max(high, middle + reach)
    return mp.iv.mpf([low, high]) * 2**64


def between(low, high):
    return mp.iv.mpf([low, high])


def evaluation(fixed):
    """The errors that the integers of `polynomial` make, in units of 2^-64."""
    w = between(0, 1)
    floor, high = between(0, 1), between(0, 3)
    c = [int(x * mp.mpf(2) ** place) for x, place in zip(map(abs, fixed), PLACES)]
    error = floor + between(0, mp.mpf(c[7]) / 2**32)
    error = floor + between(0, mp.mpf(c[6]) / 2**24) - w * error * 2**8
    for shift in [0, 0, 5, 4, 3]:
        error = (floor if shift else 0) + (high - w * error) / 2**shift
    return error


# The fraction is cut below its 64th bit, and its square is up to 3 too low.
SQUARE = between(-5, 0)
# The product with 2/π is up to 4 units of 2^-128 too low, shifted to the left by at most 7 and by
# at most 53 zeros.
REDUCTION = between(-(mp.mpf(2) ** (2 + 7 + 53 - 64)), 0)
LIMIT = 3

for name, f, series in [("sine", sine, SINE_SERIES), ("cosine", cosine, COSINE_SERIES)]:
    fixed = fit(f)
    check("integer.rs", [int(abs(c) * mp.mpf(2) ** place) for c, place in zip(fixed, PLACES)])
    terms = [approximation(fixed, series), evaluation(fixed)]
    if name == "sine":
        # Relative to a sine of at least sin(π/4), and with the mantissa's own last place.
        terms.append(SQUARE * between(SINE_SERIES[1], 0))
        total = sum(terms) / mp.sin(PI / 4) + REDUCTION * 2 + between(-1, 0)
    else:
        total = -(sum(terms) + SQUARE * between(0, COSINE_SERIES[0])) + between(-1, 0)
    print(name, *[mp.iv.nstr(term, 3) for term in [*terms, total]], "limit", LIMIT)
    if not (-LIMIT < total.a and total.b < LIMIT):
        sys.exit("the error exceeds the margin")

# float.rs


def cut(x, n):
    """The leading n bits of x."""
    mantissa, exponent = mp.frexp(x)
    return mp.floor(mantissa * 2**n) * mp.mpf(2) ** (exponent - n)


first = cut(PI / 128, 41)
second = cut(PI / 128 - first, 39)
check("float.rs", map(bits, [first, second, PI / 128 - first - second]))

ROUNDING = mp.mpf(2) ** -53
B = PI / 256 * (1 + mp.mpf(2) ** -40)


def half_place(x):
    """The largest error of rounding a number of at most x."""
    return mp.mpf(2) ** (mp.floor(mp.log(x, 2)) - 53) if x else mp.mpf(0)


# The least distance of an f64 from a multiple of π/2.
nearest = min(abs(mp.mpf(float(k * PI / 2)) - k * PI / 2) for k in range(1, 41))
if nearest < mp.mpf(2) ** -61:
    sys.exit("an argument is too near to a multiple of π/2")

worst = 0
for i in range(65):
    s, c = mp.sin(i * PI / 128), mp.cos(i * PI / 128)
    # For i = 0 the result is about b, so its relative error is also checked at a small b.
    for b in [B] if i else [B, B / 2**20]:
        result = s * mp.cos(b) - c * mp.sin(b) if i else mp.sin(b)
        cosine_rest, sine_rest = b**2 / 2, b**3 / 6
        cuts = 2 * b * mp.mpf(2) ** -26 + (mp.mpf(2) ** -26 if i else 0)
        small = s * cosine_rest + cuts + c * sine_rest
        errors = [
            s * (5 * ROUNDING * cosine_rest + b**8 / mp.factorial(8) + b * half_place(b)),
            c * (6 * ROUNDING * sine_rest + b**9 / mp.factorial(9) + 2 * ROUNDING * half_place(b)),
            4 * ROUNDING * (cuts + c * sine_rest),
            half_place(small),
            2 * half_place(small + half_place(s + b)),
        ]
        worst = max(worst, sum(errors) / abs(result))
print("float.rs: the relative error is at most 2 to the", mp.nstr(mp.log(worst, 2), 4), "of -62")
if worst * (1 + mp.mpf(2) ** -10) > mp.mpf(2) ** -62:
    sys.exit("the error exceeds the margin")

# sines.txt


def next_to_quarters(u):
    multiple = np.maximum(u >> 12 >> (u & 63) % 52, 1).astype(float) * (np.pi / 2)
    return (multiple.view(np.uint64) + (u >> 6 & 3) - 1).view(float)


def uniform(end):
    return lambda u: -end + 2 * end * ((u >> 11).astype(float) * 2.0**-53)


MANTISSA, SIGN = 2**52 - 1, 2**63
FAMILIES = {
    "pi": uniform(np.pi),
    "64": uniform(64.0),
    "2^20": uniform(2.0**20),
    "tiny": lambda u: (u & MANTISSA | u & SIGN | (959 + (u >> 52 & 1023) % 45) << 52).view(float),
    "subnormal": lambda u: ((u & MANTISSA) >> (u >> 52 & 1023) % 52 | u & SIGN).view(float),
    "quarters": next_to_quarters,
    "any": lambda u: np.where(u >> 52 & 2047 != 2047, u, u & (MASK ^ 1 << 62)).view(float),
}
POWERS = np.full(2 * CHUNK, MULTIPLIER, dtype=np.uint64)
POWERS[0] = 1
POWERS = np.cumprod(POWERS)[::-1]


def rounded(x):
    """The nearest f64 to sin x and to cos x."""
    sin, cos = gmpy2.sin_cos(gmpy2.mpfr(x))
    return float(sin), float(cos)


def digest(x):
    values = np.fromiter((y for x in x.tolist() for y in rounded(x)), float, 2 * len(x))
    return int((values.view(np.uint64) * POWERS).sum(dtype=np.uint64))


def hard(x):
    """Whether 66 bits of sin x or cos x do not decide the rounding to f64."""
    with gmpy2.context(gmpy2.get_context(), precision=150):
        for y in gmpy2.sin_cos(gmpy2.mpfr(x)):
            _, mantissa = gmpy2.frexp(y)
            tail = abs(mantissa) * 2**53 % 1
            if abs(tail - 0.5) < 2.0**-13:
                return True
    return False


def nearest_to_quarters(exponent):
    """An m of 53 bits so that m 2^exponent is nearest to a multiple of π/2: continued fraction."""
    x = Fraction(int(2 / PI * mp.mpf(2) ** 1500), 2**1500) * Fraction(2) ** exponent % 1
    (p, q), (last_p, last_q) = (0, 1), (1, 0)
    while x:
        x = 1 / x
        term = int(x)
        x -= term
        (p, q), (last_p, last_q) = (term * p + last_p, term * q + last_q), (p, q)
        if q >= 2**53:
            break
    return -(-(2**52) // last_q) * last_q


def hard_cases():
    gmpy2.get_context().precision = 53
    random = FAMILIES["pi"](np.random.default_rng(0).integers(0, 2**64, 1_000_000, dtype=np.uint64))
    yield from filter(hard, random.tolist())
    for exponent in range(-52, 972):
        m = nearest_to_quarters(exponent)
        if m < 2**53:
            yield float(mp.ldexp(m, exponent))
    powers = [2.0**-1022, 2.0**-28, 2.0**-27, 2.0**-26, 2.0**-25, 0.5, 1.0, 64.0, 2.0**20]
    for x in [0.0, 5e-324, *powers, 1.7976931348623157e308]:
        yield from [x, -x, np.nextafter(x, 0), np.nextafter(x, 1)]
    # Multiples of π/4, where links hang, stand or are level, and of π/128, as float.rs has them.
    for k in range(1, 200):
        yield from [k * (np.pi / 4), -k * (np.pi / 4), k * (np.pi / 128)]


def record():
    # This context also rounds subnormal results correctly.
    gmpy2.set_context(gmpy2.ieee(64))
    lines = [
        f"# Correctly rounded by {gmpy2.mpfr_version()}. First digests of the sines and cosines of "
        "250,000 arguments, from",
        "# draws of default_rng(chunk); then hard cases: the bits of x, sin x and cos x.",
    ]
    for family, arguments in FAMILIES.items():
        for chunk in range(CHUNKS):
            draws = np.random.default_rng(chunk).integers(0, 2**64, CHUNK, dtype=np.uint64)
            lines.append(f"family {family} {chunk} {digest(arguments(draws)):016x}")
    cases = sorted(set(hard_cases()), key=lambda x: (abs(x), x))
    gmpy2.set_context(gmpy2.ieee(64))
    lines += [" ".join(f"{bits(y):016x}" for y in [x, *rounded(x)]) for x in cases]
    (HERE / "sines.txt").write_text("\n".join(lines) + "\n")


record()
