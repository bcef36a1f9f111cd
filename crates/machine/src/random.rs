//! Machines that nobody tuned on.

use core::f64::consts::TAU;

use acrobot::Params;
use acrobot::numpy::{Pcg64, uniform};

use crate::Hardware;

/// A random machine, and what its builder believes.
#[derive(Clone, Copy, Debug)]
pub struct Random {
    /// The machine as it is.
    pub hardware: Hardware,
    /// The parameters as they were measured.
    pub believed: Params,
    /// The motor's torque, divided by [`least_torque`].
    pub strength: f64,
    /// The time of a slice of planning, s.
    pub slice: f64,
    /// Zeros are within so many degrees.
    pub zero: f64,
}

/// The smallest torque with which a machine swings up, N m: half of gravity's largest torque on it,
/// so that 1.3 half turns of the elbow do the work, and enough to lift link 2.
#[must_use]
pub fn least_torque(params: &Params) -> f64 {
    let link2 = params.mass2 * params.center_of_mass2;
    let both = params.mass1 * params.center_of_mass1 + params.mass2 * params.length1 + link2;
    params.gravity * (0.5 * both).max(link2)
}

impl Random {
    /// Links of 0.12 to 0.6 m and of 0.1 to 3 kg, rotors, viscous friction, dry friction of up to
    /// 5 % of the motor, 1,024 to 16,384 counts, ticks of 1 to 4 ms, a lag of up to 3 ms. By the
    /// seed: a delay of 0, 5, 10 or 20 ms; zeros of 0, 0.5 or 1.5 degrees; in each second dozen a
    /// motor of 1.2 to 2 or of 2 to 4 times the smallest. Masses are believed within 5 %, frictions
    /// within 50 %, the torque within 15 %.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut rng = Pcg64::new(seed);
        let mut between = |least: f64, most: f64| uniform(&mut rng, least, most);
        let length1 = log(&mut between, 0.12, 0.6);
        let length2 = log(&mut between, 0.12, 0.6);
        let mass1 = log(&mut between, 0.1, 3.0);
        let mass2 = (mass1 * log(&mut between, 0.2, 5.0)).clamp(0.1, 3.0);
        let (center_of_mass1, center_of_mass2) =
            (length1 * between(0.4, 1.0), length2 * between(0.4, 1.0));
        let inertia1 = mass1 * length1 * length1 * between(0.02, 0.1);
        let inertia2 = mass2 * length2 * length2 * between(0.02, 0.1);
        let gear = one_of(&mut between, [1.0, 4.0, 6.0, 9.0, 20.0]);
        let about_joint = inertia2 + mass2 * center_of_mass2 * center_of_mass2;
        let rotor = about_joint * between(0.0, 0.2) / (gear * gear);
        let dt = one_of(&mut between, [0.001, 0.002, 0.0025, 0.004]);
        let links = Params {
            length1,
            length2,
            mass1,
            mass2,
            center_of_mass1,
            center_of_mass2,
            inertia1,
            inertia2,
            gravity: 9.81,
            dt,
            max_velocity1: f64::INFINITY,
            max_velocity2: f64::INFINITY,
            ..Params::DEFAULT
        };
        let is_weak = (seed / 12).is_multiple_of(2);
        let strength = if is_weak { between(1.2, 2.0) } else { between(2.0, 4.0) };
        let limit = strength * least_torque(&links);
        // Link 2 turns about as fast as this.
        let fast = libm::sqrt(9.81 / (length1 + length2)) * TAU;
        let params = Params {
            damping1: between(0.0, 0.02) * limit / fast,
            damping2: between(0.0, 0.02) * limit / fast,
            coulomb1: between(0.0, 0.05) * limit,
            coulomb2: between(0.0, 0.05) * limit,
            ..links
        };
        let counts = one_of(&mut between, [1024.0, 2000.0, 4096.0, 5000.0, 8192.0, 16384.0]) as i32;
        let degrees = [0.0, 0.5, 1.5][(seed / 4 % 3) as usize];
        let mut zero = || sign(&mut between) * between(0.5, 1.0) * degrees / 360.0 * TAU;
        let hardware = Hardware {
            params: params.with_rotor(rotor, gear),
            limit,
            counts: [counts; 2],
            zeros: [zero(), zero()],
            delay: [0.0, 0.005, 0.010, 0.020][(seed % 4) as usize],
            lag: between(0.0, 0.003),
            torque_factor: between(0.85, 1.15),
            torque_std: 0.005 * limit,
        };
        let believed = Params {
            mass1: mass1 * between(0.95, 1.05),
            mass2: mass2 * between(0.95, 1.05),
            inertia1: inertia1 * between(0.95, 1.05),
            inertia2: inertia2 * between(0.95, 1.05),
            damping1: params.damping1 * between(0.5, 1.5),
            damping2: params.damping2 * between(0.5, 1.5),
            coulomb1: params.coulomb1 * between(0.5, 1.5),
            coulomb2: params.coulomb2 * between(0.5, 1.5),
            ..params
        };
        let slice = one_of(&mut between, [0.01, 0.03]);
        let believed = believed.with_rotor(rotor, gear);
        Self { hardware, believed, strength, slice, zero: degrees }
    }
}

fn log(between: &mut impl FnMut(f64, f64) -> f64, least: f64, most: f64) -> f64 {
    libm::exp(between(libm::log(least), libm::log(most)))
}

fn one_of<const N: usize>(between: &mut impl FnMut(f64, f64) -> f64, of: [f64; N]) -> f64 {
    of[between(0.0, N as f64) as usize]
}

fn sign(between: &mut impl FnMut(f64, f64) -> f64) -> f64 {
    if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 }
}
