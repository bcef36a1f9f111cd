// C's functions for control get the same bits as Rust's.

#include "check.h"
#include "digest.h"

// From tests/bits/src/control.rs, where the same calls are.
static const uint64_t MODELS = UINT64_C(0x10e59b3f0c44b049);
static const uint64_t ESTIMATES = UINT64_C(0xc759cd5ea10019c7);
static const uint64_t IDENTIFICATION = UINT64_C(0xd4d4b9147a722d51);
static const uint64_t MPC = UINT64_C(0xe8300a7e90be4113);

static const acrobot_settings_t SETTINGS = {
    {.2f, .3f, .5f, .6f, .2f, .25f, .01f, .02f, 9.8f, .005f, 50, 50, {-1, 0, 1}, 0,
     .001f, .002f, .01f, .02f, .003f, ACROBOT_DYNAMICS_BOOK},
    6, {4096, 4096}, 5,
};
#define PARAMS (SETTINGS.params)
static const acrobot_state_t MOVING = {.1f, -.2f, .3f, -.4f};
static const acrobot_weights_t WEIGHTS = {{{2, .5f}, {.5f, 1}, {0, 0, .1f}, {0, 0, 0, .1f}}, .5f};
#define SAMPLES 800

#define ADD(value) add_floats(&digest, &(value), sizeof(value) / 4)
// All numbers, without the dynamics.
#define ADD_PARAMS(params) add_floats(&digest, &(params), 21)

static acrobot_t machine;
static acrobot_state_t state;

static float torque_of(int tick)
{
    return tick % 50 < 25 ? .5f : -.4f;
}

static void begin(void)
{
    ACCEPTED(acrobot_init(&machine, 0));
    ACCEPTED(acrobot_set_params(&machine, &PARAMS, NULL));
    ACCEPTED(acrobot_set_state(&machine, &MOVING, NULL));
    state = MOVING;
}

static void take_step(float torque)
{
    acrobot_step_t step;
    ACCEPTED(acrobot_step_torque(&machine, torque, &step, NULL));
    ACCEPTED(acrobot_state(&machine, &state));
}

static uint64_t models(void)
{
    uint64_t digest = OFFSET;
    acrobot_rates_t rates;
    float mass_matrix[2][2], cost_to_go[4][4];
    acrobot_forces_t forces;
    acrobot_linear_model_t linear;
    acrobot_step_model_t models[3];
    acrobot_problem_t problem;
    acrobot_lqr_t lqr;
    acrobot_state_t gains[3];
    ACCEPTED(acrobot_derivative(&PARAMS, &MOVING, .5f, &rates, NULL));
    ACCEPTED(acrobot_mass_matrix(&PARAMS, &MOVING, &mass_matrix, NULL));
    ACCEPTED(acrobot_inverse_dynamics(&PARAMS, &MOVING, 1, -2, &forces, NULL));
    ACCEPTED(acrobot_linearize(&PARAMS, &MOVING, .5f, &linear, NULL));
    ACCEPTED(acrobot_linearize_step(&PARAMS, &MOVING, .5f, &models[0], NULL));
    ADD(rates);
    ADD(mass_matrix);
    ADD(forces);
    ADD(linear);
    ADD(models[0]);

    ACCEPTED(acrobot_problem_init(&problem, &PARAMS, SETTINGS.limit, 1, NULL));
    const acrobot_state_t *bent = &problem.target;
    ACCEPTED(acrobot_regulator(&PARAMS, bent, problem.torque, &WEIGHTS, &lqr, NULL));
    ADD(lqr);
    ACCEPTED(acrobot_linearize(&PARAMS, bent, problem.torque, &linear, NULL));
    ACCEPTED(acrobot_lqr(&linear, &WEIGHTS, &lqr, NULL));
    ADD(lqr);
    for (int i = 0; i < 3; i++) {
        ACCEPTED(acrobot_linearize_step(&PARAMS, bent, problem.torque, &models[i], NULL));
    }
    ACCEPTED(acrobot_dlqr(&models[0], &WEIGHTS, &lqr, NULL));
    ADD(lqr);
    __builtin_memcpy(cost_to_go, WEIGHTS.q, sizeof cost_to_go);
    ACCEPTED(acrobot_tvlqr(models, &WEIGHTS, &cost_to_go, gains, 3, NULL));
    ADD(cost_to_go);
    ADD(gains);
    return digest;
}

static uint64_t estimates(void)
{
    static const acrobot_noise_t NOISE = {1e-3f, .05f};
    static const acrobot_parameter_std_t STD = {0, .1f, 0, 0, 0, 0, 0, 0, .02f, 0};
    uint64_t digest = OFFSET;
    acrobot_estimator_t alone;
    acrobot_parameter_estimator_t both;
    acrobot_params_t params;
    acrobot_state_t std;
    begin();
    ACCEPTED(acrobot_estimator_init(&alone, &PARAMS, &NOISE, NULL));
    ACCEPTED(acrobot_parameter_estimator_init(&both, &PARAMS, &STD, &NOISE, NULL));
    ACCEPTED(acrobot_estimator_state_std(&alone, &std));
    CHECK(std.theta1 == __builtin_inff());
    for (int tick = 0; tick < 200; tick++) {
        const float torque = torque_of(tick);
        ACCEPTED(acrobot_estimator_correct(&alone, state.theta1, state.theta2, NULL));
        ACCEPTED(acrobot_estimator_predict(&alone, torque, NULL));
        ACCEPTED(acrobot_parameter_estimator_correct(&both, state.theta1, state.theta2, NULL));
        ACCEPTED(acrobot_parameter_estimator_predict(&both, torque + .1f, NULL));
        take_step(torque);
    }
    ACCEPTED(acrobot_estimator_state(&alone, &state));
    ACCEPTED(acrobot_estimator_state_std(&alone, &std));
    ADD(state);
    ADD(std);
    ACCEPTED(acrobot_parameter_estimator_state(&both, &state));
    ACCEPTED(acrobot_parameter_estimator_state_std(&both, &std));
    ACCEPTED(acrobot_parameter_estimator_params(&both, &params));
    ADD(state);
    ADD(std);
    ADD_PARAMS(params);
    return digest;
}

static void add_doubles(uint64_t *digest, const double *doubles, int count)
{
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        __builtin_memcpy(&bits, &doubles[i], sizeof bits);
        add(digest, bits);
    }
}

static uint64_t identification(void)
{
    static acrobot_sample_t samples[SAMPLES];
    uint64_t digest = OFFSET;
    acrobot_regression_t regression;
    acrobot_fit_t fit;
    acrobot_params_t params;
    double error;
    begin();
    for (int tick = 0; tick < SAMPLES; tick++) {
        const float torque = torque_of(tick / 3);
        const acrobot_sample_t sample = {{state.theta1, state.theta2}, {0, torque}};
        samples[tick] = sample;
        take_step(torque);
    }
    ACCEPTED(acrobot_regression_init(&regression));
    ACCEPTED(acrobot_regression_add(&regression, samples, SAMPLES, .005, 9.8, 2, 100, NULL));
    ACCEPTED(acrobot_regression_fit(&regression, &fit));
    add_doubles(&digest, fit.values, 10);
    add_doubles(&digest, fit.std_errors, 10);
    add_doubles(&digest, fit.weakest, 10);
    add(&digest, fit.rank_deficiency);
    ACCEPTED(acrobot_fit_params(&fit, &PARAMS, &params, NULL));
    ADD_PARAMS(params);
    ACCEPTED(acrobot_identify(samples, SAMPLES, &PARAMS, &params, NULL));
    ADD_PARAMS(params);
    ACCEPTED(acrobot_prediction_error(&PARAMS, samples, SAMPLES, 200, &error, NULL));
    add_doubles(&digest, &error, 1);
    return digest;
}

static uint64_t mpc(void)
{
    static acrobot_controller_t controller;
    static acrobot_replanner_t replanner;
    const float turn = 6.2831855f;
    uint64_t digest = OFFSET;
    acrobot_params_t params;
    float torque;
    begin();
    ACCEPTED(acrobot_controller_init(&controller, &SETTINGS, NULL));
    ACCEPTED(acrobot_replanner_init(&replanner, &SETTINGS, NULL));
    for (int tick = 0; tick < 200; tick++) {
        const int32_t count1 = (int32_t)(state.theta1 / turn * 4096);
        const int32_t count2 = (int32_t)(state.theta2 / turn * 4096);
        ACCEPTED(acrobot_controller_tick(&controller, count1, count2, &torque, NULL));
        ADD(torque);
        take_step(torque);
        if (tick % 20 == 0) {
            ACCEPTED(acrobot_replanner_exchange(&replanner, &controller));
            ACCEPTED(acrobot_replanner_work(&replanner));
        }
    }
    ACCEPTED(acrobot_controller_state(&controller, &state));
    ACCEPTED(acrobot_controller_params(&controller, &params));
    ADD(state);
    ADD_PARAMS(params);
    return digest;
}

int main(void)
{
    CHECK(models() == MODELS);
    CHECK(estimates() == ESTIMATES);
    CHECK(identification() == IDENTIFICATION);
    CHECK(mpc() == MPC);
    return report("control");
}
