//! The shortest loops that step an acrobot. They share no formula with the crate, so they do not change with it.

use std::array::from_fn;
use std::hint::black_box;

use acrobot::Action;
use acrobot::arithmetic::Real;

#[cfg(target_arch = "x86_64")]
pub use avx2::Lanes;

/// Other architectures have no AVX2.
#[cfg(not(target_arch = "x86_64"))]
#[derive(Debug)]
pub struct Lanes;

#[cfg(not(target_arch = "x86_64"))]
impl Lanes {
    pub fn new(_: bool) -> Option<Self> {
        None
    }

    pub fn run(&mut self) -> usize {
        0
    }
}

/// Gymnasium's order in f64, with `x * x` for its squares. It plays whole episodes of the same policy as the crate,
/// because the C library's sines branch on the quadrant: with a periodic torque the CPU predicts the branches,
/// and the loop takes a third less time.
#[expect(
    clippy::disallowed_methods,
    reason = "the yardstick uses the platform's sines"
)]
pub fn bare_f64(actions: &[Action]) {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let derivative = |[t1, t2, w1, w2]: [f64; 4], torque: f64| {
        let d1 = 0.25 + (1.0 + 0.25 + 2.0 * 0.5 * t2.cos()) + 2.0;
        let d2 = 0.25 + 0.5 * t2.cos() + 1.0;
        let phi2 = 0.5 * 9.8 * (t1 + t2 - FRAC_PI_2).cos();
        let phi1 = -0.5 * w2 * w2 * t2.sin() - w2 * w1 * t2.sin()
            + 1.5 * 9.8 * (t1 - FRAC_PI_2).cos()
            + phi2;
        let a2 =
            (torque + d2 / d1 * phi1 - 0.5 * w1 * w1 * t2.sin() - phi2) / (1.25 - d2 * d2 / d1);
        [w1, w2, -(d2 * a2 + phi1) / d1, a2]
    };
    let wrap = |mut x: f64| {
        while x > PI {
            x -= TAU;
        }
        while x < -PI {
            x += TAU;
        }
        x
    };
    const START: [f64; 4] = [0.1, 0.0, 0.0, 0.1];
    let (mut y, mut elapsed) = (START, 0);
    for &action in actions {
        let torque = f64::from(u8::from(action)) - 1.0;
        let next = rk4(y, 0.2, |y| derivative(y, torque));
        y = [
            wrap(next[0]),
            wrap(next[1]),
            next[2].clamp(-4.0 * PI, 4.0 * PI),
            next[3].clamp(-9.0 * PI, 9.0 * PI),
        ];
        let terminated = -y[0].cos() - (y[0] + y[1]).cos() > 1.0;
        black_box(y);
        elapsed += 1;
        if terminated || elapsed == 500 {
            (y, elapsed) = (START, 0);
        }
    }
}

/// The lean equations in f32 with polynomials, without episodes.
pub fn bare_f32(actions: &[Action]) {
    use std::f32::consts::{FRAC_2_PI, PI, TAU};
    let sin_cos = |x: f32| {
        let shifted = x * FRAC_2_PI + 12_582_912.0;
        let turns = shifted - 12_582_912.0;
        let r = (x - turns * f32::from_bits(0x3fc9_0fc0)) - turns * f32::from_bits(0x3655_110b);
        let z = r * r;
        let sin = r + r * z * (-0.166_666_5 + z * (0.008_332_0 + z * -0.000_195_0));
        let cos = 1.0 + z * (-0.499_999 + z * (0.041_656_3 + z * -0.001_359_8));
        let quadrant = shifted.to_bits();
        let (sin, cos) = if quadrant & 1 == 0 {
            (sin, cos)
        } else {
            (cos, sin)
        };
        let flip = |x: f32, sign: u32| f32::from_bits(x.to_bits() ^ ((sign & 2) << 30));
        (flip(sin, quadrant), flip(cos, quadrant + 1))
    };
    let acceleration = |[t1, t2, w1, w2]: [f32; 4], torque: f32| {
        let ((s1, c1), (s2, c2)) = (sin_cos(t1), sin_cos(t2));
        let (c, s) = (0.5 * c2, 0.5 * s2);
        let f1 = torque + 14.7 * s1 - s * (w1 + w2) * (w1 + w2);
        let f2 = torque - 4.9 * (s1 * c2 + c1 * s2) - s * (w1 * w1);
        let inverse = 1.0 / (2.5625 + s * s);
        let common = 1.25 * f1 + c * f2;
        [
            w1,
            w2,
            -common * inverse,
            (common + 2.25 * f2 + c * f1) * inverse,
        ]
    };
    let wrap = |x: f32| x - ((x * (1.0 / TAU) + 12_582_912.0) - 12_582_912.0) * TAU;
    let mut y = [0.1_f32, 0.0, 0.0, 0.1];
    for &action in actions {
        let torque = f32::from(u8::from(action)) - 1.0;
        let next = rk4(y, 0.2, |y| acceleration(y, torque));
        y = [
            wrap(next[0]),
            wrap(next[1]),
            next[2].clamp(-4.0 * PI, 4.0 * PI),
            next[3].clamp(-9.0 * PI, 9.0 * PI),
        ];
        black_box(y);
    }
}

/// The classical Runge-Kutta step.
#[inline(always)]
fn rk4<S: Real>(y: [S; 4], dt: f64, derivative: impl Fn([S; 4]) -> [S; 4]) -> [S; 4] {
    let (two, h) = (S::from_f64(2.0), S::from_f64(dt / 2.0));
    let along = |h: S, k: [S; 4]| from_fn(|i| y[i] + h * k[i]);
    let k1 = derivative(y);
    let k2 = derivative(along(h, k1));
    let k3 = derivative(along(h, k2));
    let k4 = derivative(along(h + h, k3));
    let sixth = S::from_f64(dt / 6.0);
    from_fn(|i| y[i] + sixth * (k1[i] + two * k2[i] + two * k3[i] + k4[i]))
}

/// Handwritten AVX2 with eight lanes over 1,024 acrobots, without episodes and observations.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    #[derive(Debug)]
    pub struct Lanes {
        fma: bool,
        state: [[f32; 1024]; 4],
        torques: [f32; 1024],
    }

    impl Lanes {
        /// None if the machine does not have the instructions.
        pub fn new(fma: bool) -> Option<Self> {
            if !(is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")) {
                return None;
            }
            Some(Self {
                fma,
                state: [[0.05; 1024]; 4],
                torques: std::array::from_fn(|i| (i % 3) as f32 - 1.0),
            })
        }

        pub fn run(&mut self) -> usize {
            let [th1, th2, w1, w2] = &mut self.state;
            for _ in 0..2000 {
                // SAFETY: `new` detected AVX2 and FMA.
                unsafe {
                    if self.fma {
                        with_fma(th1, th2, w1, w2, &self.torques, 0.2);
                    } else {
                        without_fma(th1, th2, w1, w2, &self.torques, 0.2);
                    }
                }
            }
            2000 * 1024
        }
    }

    type V = __m256;
    macro_rules! make {
        ($name:ident, $features:literal, $madd:expr, $msub:expr) => {
            #[target_feature(enable = $features)]
            fn $name(
                th1: &mut [f32],
                th2: &mut [f32],
                w1: &mut [f32],
                w2: &mut [f32],
                torque: &[f32],
                dt: f32,
            ) {
                #[target_feature(enable = $features)]
                #[inline]
                fn c(x: f32) -> V {
                    _mm256_set1_ps(x)
                }
                #[target_feature(enable = $features)]
                #[inline]
                fn madd(a: V, b: V, z: V) -> V {
                    $madd(a, b, z)
                } // a*b+z
                #[target_feature(enable = $features)]
                #[inline]
                fn nmadd(a: V, b: V, z: V) -> V {
                    $msub(a, b, z)
                } // z-a*b
                #[target_feature(enable = $features)]
                #[inline]
                fn mul(a: V, b: V) -> V {
                    _mm256_mul_ps(a, b)
                }
                #[target_feature(enable = $features)]
                #[inline]
                fn add(a: V, b: V) -> V {
                    _mm256_add_ps(a, b)
                }
                #[target_feature(enable = $features)]
                #[inline]
                fn sub(a: V, b: V) -> V {
                    _mm256_sub_ps(a, b)
                }
                #[target_feature(enable = $features)]
                #[inline]
                fn sincos(x: V) -> (V, V) {
                    let magic = c(12582912.0);
                    let sh = madd(x, c(core::f32::consts::FRAC_2_PI), magic);
                    let m = sub(sh, magic);
                    let r = nmadd(m, c(f32::from_bits(0x3fc90fc0)), x);
                    let r = nmadd(m, c(f32::from_bits(0x3655110b)), r);
                    let z = mul(r, r);
                    let s = madd(
                        z,
                        c(f32::from_bits(0xb94c6e8b)),
                        c(f32::from_bits(0x3c0882df)),
                    );
                    let s = madd(z, s, c(f32::from_bits(0xbe2aaaa0)));
                    let s = madd(mul(r, z), s, r);
                    let k = madd(
                        z,
                        c(f32::from_bits(0xbab23c11)),
                        c(f32::from_bits(0x3d2a9fd5)),
                    );
                    let k = madd(z, k, c(f32::from_bits(0xbeffffdd)));
                    let k = madd(z, k, c(1.0));
                    let q = _mm256_castps_si256(sh);
                    let odd = _mm256_castsi256_ps(_mm256_slli_epi32(q, 31));
                    let two = _mm256_slli_epi32(q, 30);
                    let sign = _mm256_set1_epi32(i32::MIN);
                    let ss = _mm256_castsi256_ps(_mm256_and_si256(two, sign));
                    let cs = _mm256_castsi256_ps(_mm256_and_si256(
                        _mm256_xor_si256(two, _mm256_slli_epi32(q, 31)),
                        sign,
                    ));
                    (
                        _mm256_xor_ps(_mm256_blendv_ps(s, k, odd), ss),
                        _mm256_xor_ps(_mm256_blendv_ps(k, s, odd), cs),
                    )
                }
                #[target_feature(enable = $features)]
                #[inline]
                fn acc(t1: V, t2: V, v1: V, v2: V, tau: V) -> (V, V) {
                    let (s1, c1) = sincos(t1);
                    let (s2, c2) = sincos(t2);
                    let s12 = madd(s1, c2, mul(c1, s2));
                    let cc = mul(c(0.5), c2);
                    let cs = mul(c(0.5), s2);
                    let w = add(v1, v2);
                    let q = mul(v1, v1);
                    let f1 = nmadd(cs, mul(w, w), madd(c(14.7), s1, tau));
                    let f2 = nmadd(cs, q, nmadd(c(4.9), s12, tau));
                    let inv = _mm256_div_ps(c(1.0), madd(cs, cs, c(2.5625)));
                    let k = madd(c(1.25), f1, mul(cc, f2));
                    let a1 = mul(sub(c(0.0), k), inv);
                    let a2 = mul(madd(cc, f1, madd(c(2.25), f2, k)), inv);
                    (a1, a2)
                }
                let n = th1.len();
                let h = c(dt * 0.5);
                let d = c(dt);
                let six = c(dt / 6.0);
                let third = c(dt / 3.0);
                let tau2 = c(core::f32::consts::TAU);
                let itau = c(1.0 / core::f32::consts::TAU);
                let magic = c(12582912.0);
                let (b1, b2) = (
                    c(4.0 * core::f32::consts::PI),
                    c(9.0 * core::f32::consts::PI),
                );
                let mut i = 0;
                while i + 8 <= n {
                    unsafe {
                        let (t1, t2) = (
                            _mm256_loadu_ps(th1.as_ptr().add(i)),
                            _mm256_loadu_ps(th2.as_ptr().add(i)),
                        );
                        let (v1, v2) = (
                            _mm256_loadu_ps(w1.as_ptr().add(i)),
                            _mm256_loadu_ps(w2.as_ptr().add(i)),
                        );
                        let tau = _mm256_loadu_ps(torque.as_ptr().add(i));
                        let (a1, a2) = acc(t1, t2, v1, v2, tau);
                        let (u1, u2) = (madd(h, a1, v1), madd(h, a2, v2));
                        let (b1_, b2_) = acc(madd(h, v1, t1), madd(h, v2, t2), u1, u2, tau);
                        let (x1, x2) = (madd(h, b1_, v1), madd(h, b2_, v2));
                        let (c1_, c2_) = acc(madd(h, u1, t1), madd(h, u2, t2), x1, x2, tau);
                        let (y1, y2) = (madd(d, c1_, v1), madd(d, c2_, v2));
                        let (d1_, d2_) = acc(madd(d, x1, t1), madd(d, x2, t2), y1, y2, tau);
                        let fin = |t: V, k1: V, k2: V, k3: V, k4: V| {
                            madd(six, add(k1, k4), madd(third, add(k2, k3), t))
                        };
                        let t1 = fin(t1, v1, u1, x1, y1);
                        let t2 = fin(t2, v2, u2, x2, y2);
                        let v1 = fin(v1, a1, b1_, c1_, d1_);
                        let v2 = fin(v2, a2, b2_, c2_, d2_);
                        let wrap = |t: V| nmadd(sub(madd(t, itau, magic), magic), tau2, t);
                        let clip = |v: V, b: V| _mm256_max_ps(_mm256_min_ps(v, b), sub(c(0.0), b));
                        _mm256_storeu_ps(th1.as_mut_ptr().add(i), wrap(t1));
                        _mm256_storeu_ps(th2.as_mut_ptr().add(i), wrap(t2));
                        _mm256_storeu_ps(w1.as_mut_ptr().add(i), clip(v1, b1));
                        _mm256_storeu_ps(w2.as_mut_ptr().add(i), clip(v2, b2));
                    }
                    i += 8;
                }
            }
        };
    }
    make!(
        with_fma,
        "avx2,fma",
        |a, b, z| _mm256_fmadd_ps(a, b, z),
        |a, b, z| _mm256_fnmadd_ps(a, b, z)
    );
    make!(
        without_fma,
        "avx2",
        |a, b, z| _mm256_add_ps(_mm256_mul_ps(a, b), z),
        |a, b, z| _mm256_sub_ps(z, _mm256_mul_ps(a, b))
    );
}
