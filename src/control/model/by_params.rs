//! The derivatives of a step by the parameters.

use core::ops::{Add, Mul};

use super::partials::{MassMatrix, PARAMETERS, by_parameters, partials};
use crate::arithmetic::Arithmetic;
use crate::math::sealed::Sealed as _;
use crate::math::{Numbers, Real, SinCos, Zeros, lanes, pair, set_lanes};
use crate::physics::{Model, plus_scaled};

/// Derivatives by the parameters, in the order of [`by_parameters`], and by dt.
pub(crate) type Columns<V> = [[V; 4]; PARAMETERS + 1];

/// A stage of the Runge-Kutta step.
#[derive(Clone, Copy)]
struct Stage<V> {
    /// The rates of the state.
    k: [V; 4],
    /// The derivatives of the accelerations by the state, and by forces on the absolute angles.
    by_state: [[V; 2]; 4],
    by_force: [[V; 2]; 2],
    /// The derivatives of these forces by the parameters.
    forces: [[V; 2]; PARAMETERS],
}

/// The derivatives of a step that no bound clamps. A parameter acts on the rates of each stage, and
/// these on the state after the step. So the stages are computed forwards, and from the last one to
/// the first the derivatives of the step by their rates.
#[inline(always)]
pub(crate) fn by_params<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
    sin_cos: [SinCos<V>; 2],
    torque: V,
) -> Columns<V> {
    let zero = V::ZEROS;
    let model = *model;
    let (half, dt, sixth) = (model.constants.half_dt, model.params.dt, model.constants.sixth_dt);
    let third = sixth + sixth;
    let none = Stage {
        k: Zeros::ZEROS,
        by_state: Zeros::ZEROS,
        by_force: Zeros::ZEROS,
        forces: Zeros::ZEROS,
    };
    let mut stages = [none; 4];
    let mut k = [zero; 4];
    let mut sines = Some(sin_cos);
    for (stage, h) in stages.iter_mut().zip([zero, half, half, dt]) {
        let x = plus_scaled(y, h, k);
        let sin_cos = match sines.take() {
            Some(sin_cos) => sin_cos,
            None => [A::sin_cos_near(x[0]), A::sin_cos_near(x[1])],
        };
        // Code for one number, which LLVM vectorizes.
        for i in 0..V::LEN {
            let model = model.zip(&model, |x, _| x.lane(i));
            let (x, sin_cos) = (lanes(&x, i), [pair(&sin_cos[0], i), pair(&sin_cos[1], i)]);
            let (a, [by1, by2, by3, by4, _]) = partials::<A>(&model, x, sin_cos, torque.lane(i));
            let mass = MassMatrix::new::<A>(&model, sin_cos[1]);
            let (o, one) = (A::Scalar::ZERO, A::Scalar::ONE);
            set_lanes(&mut stage.k, i, [x[2], x[3], a[0], a[1]]);
            for (places, x) in stage.by_state.iter_mut().zip([by1, by2, by3, by4]) {
                set_lanes(places, i, x);
            }
            for (places, x) in stage.by_force.iter_mut().zip([[one, o], [o, one]]) {
                set_lanes(places, i, mass.solve(x));
            }
        }
        k = stage.k;
        stage.forces = by_parameters::<A, V>(&model, [x[2], x[3]], sin_cos, [k[2], k[3]]);
    }

    let mut columns = [[zero; 4]; PARAMETERS + 1];
    // By rows: the derivatives of the step by the rates of a stage, through the next stage.
    let mut through = [[zero; 4]; 4];
    let weights = [(sixth, zero), (third, half), (third, half), (sixth, dt)];
    for (stage, (weight, h)) in stages.iter().zip(weights).rev() {
        let [[t1, ..], [_, t2, ..], [_, _, t3, _], [.., t4]] = &mut through;
        (*t1, *t2, *t3, *t4) = (*t1 + weight, *t2 + weight, *t3 + weight, *t4 + weight);
        let Stage { k, by_state: [by1, by2, by3, by4], by_force: [by_alpha, by_beta], .. } = stage;
        for (r, row) in through.iter_mut().enumerate() {
            let [b1, b2, b3, b4] = *row;
            let own = [b3, b4];
            let (by_alpha, by_beta) = (inner(own, *by_alpha), inner(own, *by_beta));
            let [others @ .., by_dt] = &mut columns;
            for (column, forces) in others.iter_mut().zip(&stage.forces) {
                if let Some(x) = column.get_mut(r) {
                    *x = *x + inner([by_alpha, by_beta], *forces);
                }
            }
            if let Some(x) = by_dt.get_mut(r) {
                *x = *x + (b1 * k[0] + b2 * k[1] + inner(own, [k[2], k[3]]));
            }
            *row = [
                h * inner(own, *by1),
                h * inner(own, *by2),
                h * (b1 + inner(own, *by3)),
                h * (b2 + inner(own, *by4)),
            ];
        }
    }
    let [.., by_dt] = &mut columns;
    for x in by_dt {
        *x = *x / dt;
    }
    columns
}

#[inline(always)]
fn inner<V: Copy + Add<Output = V> + Mul<Output = V>>([x1, x2]: [V; 2], [y1, y2]: [V; 2]) -> V {
    x1 * y1 + x2 * y2
}
