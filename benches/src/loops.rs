//! The shortest loops that step an acrobot. They share no formula with the crate, so they do not
//! change with it.

use std::array::from_fn;
use std::hint::black_box;

use acrobot::Action;
use acrobot::arithmetic::Real;

/// Gymnasium's order in f64, with `x * x` for its squares. It plays whole episodes, because the C
/// library's sines branch on the quadrant: with a periodic torque the CPU would predict the
/// branches.
#[expect(clippy::disallowed_methods, reason = "the yardstick uses the platform's sines")]
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
        let next = rk4(y, 0.2, |a, b, c| a * b + c, |y| derivative(y, torque));
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
    let mut y = [0.1_f32, 0.0, 0.0, 0.1];
    for &action in actions {
        y = lean_step::<false>(y, f32::from(u8::from(action)) - 1.0);
        black_box(y);
    }
}

/// A step of `bare_f32` and of each lane, with or without FMA.
#[inline(always)]
fn lean_step<const FMA: bool>(y: [f32; 4], torque: f32) -> [f32; 4] {
    use std::f32::consts::{FRAC_2_PI, PI, TAU};
    /// Added and subtracted, it rounds to an integer.
    const ROUND: f32 = 12_582_912.0;

    // a * b + c and c - a * b
    let add = |a: f32, b: f32, c: f32| if FMA { a.mul_add(b, c) } else { a * b + c };
    let sub = |a: f32, b: f32, c: f32| if FMA { (-a).mul_add(b, c) } else { c - a * b };
    let sin_cos = |x: f32| {
        let shifted = add(x, FRAC_2_PI, ROUND);
        let turns = shifted - ROUND;
        let r = sub(turns, f32::from_bits(0x3fc9_0fc0), x);
        let r = sub(turns, f32::from_bits(0x3655_110b), r);
        let z = r * r;
        let sin = add(z, add(z, -0.000_195_0, 0.008_332_0), -0.166_666_5);
        let sin = add(r * z, sin, r);
        let cos = add(z, add(z, -0.001_359_8, 0.041_656_3), -0.499_999);
        let cos = add(z, cos, 1.0);
        let quadrant = shifted.to_bits();
        // The sign bit, by which AVX2 selects.
        let (sin, cos) = if (quadrant << 31).cast_signed() < 0 { (cos, sin) } else { (sin, cos) };
        let flip = |x: f32, sign: u32| f32::from_bits(x.to_bits() ^ ((sign & 2) << 30));
        (flip(sin, quadrant), flip(cos, quadrant.wrapping_add(1)))
    };
    let derivative = |[t1, t2, w1, w2]: [f32; 4]| {
        let ((s1, c1), (s2, c2)) = (sin_cos(t1), sin_cos(t2));
        let (c, s, w) = (0.5 * c2, 0.5 * s2, w1 + w2);
        let f1 = sub(s * w, w, add(14.7, s1, torque));
        let f2 = sub(s, w1 * w1, sub(4.9, add(s1, c2, c1 * s2), torque));
        let inverse = 1.0 / add(s, s, 2.5625);
        let common = add(1.25, f1, c * f2);
        let a2 = add(c, f1, add(2.25, f2, common)) * inverse;
        [w1, w2, -common * inverse, a2]
    };
    let wrap = |x: f32| sub(add(x, 1.0 / TAU, ROUND) - ROUND, TAU, x);
    let next = rk4(y, 0.2, add, derivative);
    [
        wrap(next[0]),
        wrap(next[1]),
        next[2].clamp(-4.0 * PI, 4.0 * PI),
        next[3].clamp(-9.0 * PI, 9.0 * PI),
    ]
}

/// The classical Runge-Kutta step. `add` is a * b + c.
#[inline(always)]
fn rk4<S: Real>(
    y: [S; 4],
    dt: f64,
    add: impl Fn(S, S, S) -> S,
    derivative: impl Fn([S; 4]) -> [S; 4],
) -> [S; 4] {
    let (two, h) = (S::from_f64(2.0), S::from_f64(dt / 2.0));
    let along = |h: S, k: [S; 4]| from_fn(|i| add(h, k[i], y[i]));
    let k1 = derivative(y);
    let k2 = derivative(along(h, k1));
    let k3 = derivative(along(h, k2));
    let k4 = derivative(along(h + h, k3));
    let sixth = S::from_f64(dt / 6.0);
    let sum = |i: usize| add(two, k3[i], add(two, k2[i], k1[i])) + k4[i];
    from_fn(|i| add(sixth, sum(i), y[i]))
}

/// Steps of 1,024 acrobots, without episodes and observations. The compiler makes loops over eight
/// lanes of AVX2.
#[derive(Debug)]
pub struct Lanes {
    fma: bool,
    state: [[f32; 1024]; 4],
    torques: [f32; 1024],
}

impl Lanes {
    /// None if the machine does not have the instructions.
    pub fn new(fma: bool) -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        let available = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        #[cfg(not(target_arch = "x86_64"))]
        let available = false;
        available.then(|| Self {
            fma,
            state: [[0.05; 1024]; 4],
            torques: from_fn(|i| (i % 3) as f32 - 1.0),
        })
    }

    pub fn run(&mut self) -> usize {
        for _ in 0..2000 {
            // SAFETY: `new` detected AVX2 and FMA.
            unsafe {
                if self.fma {
                    self.step_with_fma();
                } else {
                    self.step_without_fma();
                }
            }
        }
        2000 * 1024
    }

    #[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2,fma"))]
    unsafe fn step_with_fma(&mut self) {
        self.step::<true>();
    }

    #[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
    unsafe fn step_without_fma(&mut self) {
        self.step::<false>();
    }

    #[inline(always)]
    fn step<const FMA: bool>(&mut self) {
        for i in 0..1024 {
            let y = self.state.each_ref().map(|all| all[i]);
            let next = lean_step::<FMA>(y, self.torques[i]);
            for (all, x) in self.state.iter_mut().zip(next) {
                all[i] = x;
            }
        }
    }
}
