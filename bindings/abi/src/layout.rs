//! The layout that derive.py computes for JavaScript.

use core::mem::offset_of;

use crate::batch::*;
use crate::data::*;
use crate::estimate::*;
use crate::identify::*;
use crate::instruments::*;
use crate::model::*;
use crate::mpc::*;
use crate::plan::*;
use crate::regulator::*;
use crate::status::*;
use crate::task::*;

/// The offset of the last field, which those before it decide, and the size.
const fn has<T>(last: usize, expected: usize, size: usize) {
    assert!(last == expected && size_of::<T>() == size);
}

const _: () = {
    has::<acrobot_error_t>(offset_of!(acrobot_error_t, rule), 52, 136);
    has::<acrobot_observation_t>(offset_of!(acrobot_observation_t, dtheta2), 20, 24);
    has::<acrobot_reset_options_t>(offset_of!(acrobot_reset_options_t, bounds), 8, 12);
    has::<acrobot_step_t>(offset_of!(acrobot_step_t, truncated), 29, 32);
    has::<acrobot_state_t>(offset_of!(acrobot_state_t, dtheta2), 12, 16);
    has::<acrobot_params_t>(offset_of!(acrobot_params_t, dynamics), 84, 88);
    has::<acrobot_draw_t>(offset_of!(acrobot_draw_t, std), 16, 20);
    has::<acrobot_draws_t>(offset_of!(acrobot_draws_t, rotor), 400, 420);
    has::<acrobot_rates_t>(offset_of!(acrobot_rates_t, ddtheta2), 12, 16);
    has::<acrobot_forces_t>(offset_of!(acrobot_forces_t, elbow), 16, 24);
    has::<acrobot_linear_model_t>(offset_of!(acrobot_linear_model_t, b), 64, 80);
    has::<acrobot_step_model_t>(offset_of!(acrobot_step_model_t, b), 64, 80);
    has::<acrobot_weights_t>(offset_of!(acrobot_weights_t, r), 64, 68);
    has::<acrobot_lqr_t>(offset_of!(acrobot_lqr_t, cost_to_go), 16, 80);
    has::<acrobot_covariances_t>(offset_of!(acrobot_covariances_t, s), 64, 72);
    has::<acrobot_lqe_t>(offset_of!(acrobot_lqe_t, prior_covariance), 32, 96);
    has::<acrobot_cost_t>(offset_of!(acrobot_cost_t, arrival), 160, 164);
    has::<acrobot_problem_t>(offset_of!(acrobot_problem_t, cost), 112, 276);
    has::<acrobot_knot_t>(offset_of!(acrobot_knot_t, workspace), 36, 44);
    has::<acrobot_region_t>(offset_of!(acrobot_region_t, factor), 16, 80);
    has::<acrobot_feedback_t>(offset_of!(acrobot_feedback_t, reach), 180, 184);
    has::<acrobot_noise_t>(offset_of!(acrobot_noise_t, torque_std), 4, 8);
    has::<acrobot_parameter_std_t>(offset_of!(acrobot_parameter_std_t, torque_factor), 48, 52);
    has::<acrobot_sample_t>(offset_of!(acrobot_sample_t, torques), 16, 32);
    has::<acrobot_fit_t>(offset_of!(acrobot_fit_t, rank_deficiency), 240, 248);
    has::<acrobot_calibration_t>(offset_of!(acrobot_calibration_t, params), 288, 376);
    has::<acrobot_settings_t>(offset_of!(acrobot_settings_t, plan_timeout), 104, 108);
    has::<acrobot_report_t>(offset_of!(acrobot_report_t, plan_age), 16, 20);
    has::<acrobot_batch_results_t>(offset_of!(acrobot_batch_results_t, final_observations), 16, 20);
    has::<acrobot_batch_settings_t>(offset_of!(acrobot_batch_settings_t, max_steps), 16, 20);
    has::<acrobot_instrument_draws_t>(
        offset_of!(acrobot_instrument_draws_t, velocity_filter),
        160,
        180,
    );
    has::<acrobot_instruments_t>(offset_of!(acrobot_instruments_t, velocity_filter), 32, 36);
};
