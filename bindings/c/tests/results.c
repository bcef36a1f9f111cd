// Calls and their results, which Rust has written: tests/data/results.jsonl.

#include "check.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define KNOTS 80
#define ACROBOTS 5
#define SAMPLES 500

// What a board with 64 KB has room for once.
static union {
    acrobot_knot_t knots[2][KNOTS];
    acrobot_sample_t samples[SAMPLES];
} shared;

// The results of the call that have not been compared yet.
static const double *expected, *expected_end;
static const char *called;

static void begin(const char *call, const double *result, size_t count)
{
    called = call;
    expected = result;
    expected_end = result + count;
}

static void end(void)
{
    if (expected != expected_end) {
        print(called);
        print(": not the result of Rust\n");
        failures++;
    }
}

static void compare(double found)
{
    // After the first difference `end` finds that some are left.
    if (expected != NULL && expected < expected_end && *expected == found) {
        expected++;
    } else {
        expected = NULL;
    }
}

static void compare_floats(const void *found, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        float number;
        __builtin_memcpy(&number, (const float *)found + i, sizeof number);
        compare((double)number);
    }
}

#define COMPARE(value) compare_floats(&(value), sizeof(value) / 4)
// All numbers, without the dynamics.
#define COMPARE_PARAMS(params) compare_floats(&(params), 21)

static void to_floats(void *to, const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const float number = (float)numbers[i];
        __builtin_memcpy((float *)to + i, &number, sizeof number);
    }
}

static acrobot_params_t machine(const double *numbers)
{
    acrobot_params_t params;
    params.dynamics = ACROBOT_DYNAMICS_BOOK;
    to_floats(&params, numbers, 21);
    return params;
}

static acrobot_state_t state_of(const double *numbers)
{
    acrobot_state_t state;
    to_floats(&state, numbers, 4);
    return state;
}

static void to_draws(void *to, const double *rows, size_t count)
{
    acrobot_draw_t *draw = (acrobot_draw_t *)to;
    for (size_t i = 0; i < count; i++) {
        draw[i].kind = (int)rows[5 * i];
        to_floats(&draw[i].low, rows + 5 * i + 1, 4);
    }
}

static const acrobot_draws_t *draws_of(const double *rows)
{
    static acrobot_draws_t draws;
    to_draws(&draws, rows, 21);
    return &draws;
}

static const acrobot_reset_options_t *seeded(const double *seed, size_t words)
{
    static uint32_t of_seed[4];
    static acrobot_reset_options_t options;
    for (size_t i = 0; i < words; i++) {
        of_seed[i] = (uint32_t)seed[i];
    }
    options.seed = of_seed;
    options.seed_words = words;
    return &options;
}

#ifdef ACROBOT_HAS_SNAPSHOTS
static void compare_snapshot(const uint8_t *bytes, size_t length, const double *snapshot)
{
    for (size_t i = 0; i < length; i++) {
        CHECK(bytes[i] == (uint8_t)snapshot[i]);
    }
}
#define SNAPSHOT(save, holder) \
    uint8_t bytes[COUNT(snapshot)]; \
    size_t length; \
    ACCEPTED(save(holder, bytes, sizeof bytes, &length)); \
    CHECK(length == sizeof bytes); \
    compare_snapshot(bytes, length, snapshot)
#else
#define SNAPSHOT(save, holder) (void)snapshot
#endif

#define episode() \
    acrobot_t acrobot; \
    acrobot_params_t params; \
    acrobot_step_t step; \
    ACCEPTED(acrobot_init_task(&acrobot, (int)task, 0, NULL)); \
    ACCEPTED(acrobot_reset_with(&acrobot, seeded(seed, COUNT(seed)), NULL, NULL)); \
    ACCEPTED(acrobot_draw_params(&acrobot, draws_of(draws), NULL)); \
    ACCEPTED(acrobot_params(&acrobot, &params)); \
    COMPARE_PARAMS(params); \
    for (size_t i = 0; i < COUNT(torques); i++) { \
        ACCEPTED(acrobot_step_torque(&acrobot, (float)torques[i], &step, NULL)); \
        COMPARE(step.observation); \
        COMPARE(step.reward); \
    } \
    SNAPSHOT(acrobot_save, &acrobot)

static void step_each(acrobot_batch_t *batch, const acrobot_reset_options_t *options,
                      const double *torques, size_t count)
{
    float rewards[ACROBOTS], inputs[ACROBOTS];
    bool terminated[ACROBOTS], truncated[ACROBOTS];
    acrobot_observation_t rows[ACROBOTS];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, rows, NULL};
    ACCEPTED(acrobot_batch_reset_with(batch, options, NULL));
    for (size_t i = 0; i < count; i += ACROBOTS) {
        to_floats(inputs, torques + i, ACROBOTS);
        ACCEPTED(acrobot_batch_step_torque(batch, inputs, &results, ACROBOTS));
        COMPARE(rewards);
        COMPARE(rows);
    }
}

// The snapshot of a library with instruments has these, too.
#ifdef ACROBOT_INSTRUMENTS
#define BATCH_SNAPSHOT(holder) (void)snapshot
#else
#define BATCH_SNAPSHOT(holder) SNAPSHOT(acrobot_batch_save, holder)
#endif
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_OWN_SIZE(ACROBOTS)];
#define batch() \
    acrobot_batch_t *holder; \
    CHECK(count == ACROBOTS); \
    ACCEPTED( \
        acrobot_batch_init(memory, sizeof memory, ACROBOTS, (int)task, true, 0, &holder)); \
    ACCEPTED(acrobot_batch_set_draws(holder, draws_of(draws), NULL)); \
    ACCEPTED(acrobot_batch_set_max_steps(holder, (uint32_t)max_steps, NULL)); \
    ACCEPTED(acrobot_batch_set_autoreset(holder, ACROBOT_AUTORESET_SAME_STEP, NULL)); \
    step_each(holder, seeded(seed, COUNT(seed)), torques, COUNT(torques)); \
    BATCH_SNAPSHOT(holder)

// The library has instruments or not.
#ifdef ACROBOT_INSTRUMENTS
#define instruments() \
    acrobot_batch_t *holder; \
    acrobot_instrument_draws_t how; \
    acrobot_instruments_t own = {0, 0, 0, 0, 0, 0, 0, 0, 0}; \
    CHECK(count == ACROBOTS); \
    to_draws(&how, draws, COUNT(draws) / 5); \
    ACCEPTED(acrobot_batch_init( \
        memory, sizeof memory, ACROBOTS, ACROBOT_TASK_BALANCE, false, 0, &holder)); \
    ACCEPTED(acrobot_batch_set_instrument_draws(holder, &how, NULL)); \
    for (size_t i = 0; i < ACROBOTS; i++) { \
        own.encoder_zero2 = (float)zeros[i]; \
        ACCEPTED(acrobot_batch_set_instruments(holder, i, &own, NULL)); \
    } \
    step_each(holder, seeded(seed, COUNT(seed)), torques, COUNT(torques)); \
    for (size_t i = 0; i < ACROBOTS; i++) { \
        ACCEPTED(acrobot_batch_instruments(holder, i, &own)); \
        COMPARE(own); \
    } \
    SNAPSHOT(acrobot_batch_save, holder)
#else
#define instruments() \
    (void)seed, (void)draws, (void)zeros, (void)count, (void)torques, (void)snapshot; \
    expected = expected_end
#endif

// A result of parameters and a state.
#define GET(type, function, ...) \
    const acrobot_params_t machine_ = machine(params); \
    const acrobot_state_t state_ = state_of(state); \
    type found; \
    ACCEPTED(function(&machine_, &state_, __VA_ARGS__, &found, NULL))
#define OF_MACHINE(...) \
    GET(__VA_ARGS__); \
    COMPARE(found)
#define derivative() OF_MACHINE(acrobot_rates_t, acrobot_derivative, (float)torque)
#define linearize() OF_MACHINE(acrobot_linear_model_t, acrobot_linearize, (float)torque)
#define linearize_step() OF_MACHINE(acrobot_step_model_t, acrobot_linearize_step, (float)torque)
#define inverse_dynamics() \
    GET(acrobot_forces_t, acrobot_inverse_dynamics, (float)accelerations[0], \
        (float)accelerations[1]); \
    (void)torque; \
    COMPARE(found.torques)
#define mass_matrix() \
    const acrobot_params_t machine_ = machine(params); \
    const acrobot_state_t state_ = state_of(state); \
    float found[2][2]; \
    (void)torque; \
    ACCEPTED(acrobot_mass_matrix(&machine_, &state_, &found, NULL)); \
    COMPARE(found)
#define deviation() \
    const acrobot_state_t state_ = state_of(state), target_ = state_of(target); \
    acrobot_state_t found; \
    (void)torque, (void)params; \
    ACCEPTED(acrobot_deviation_from(&state_, &target_, &found, NULL)); \
    COMPARE(found)
#define energy() \
    const acrobot_params_t machine_ = machine(params); \
    const acrobot_state_t state_ = state_of(state); \
    acrobot_t acrobot; \
    float found; \
    (void)torque; \
    ACCEPTED(acrobot_init(&acrobot, 0)); \
    ACCEPTED(acrobot_set_params(&acrobot, &machine_, NULL)); \
    ACCEPTED(acrobot_set_state(&acrobot, &state_, NULL)); \
    ACCEPTED(acrobot_energy(&acrobot, &found)); \
    COMPARE(found)

// Regulators, about an equilibrium.
static acrobot_weights_t weights_of(const double *q, const double *r)
{
    acrobot_weights_t weights;
    to_floats(weights.q, q, 16);
    weights.r = (float)*r;
    return weights;
}
#define regulator() \
    const acrobot_weights_t weights = weights_of(q, r); \
    OF_MACHINE(acrobot_lqr_t, acrobot_regulator, (float)torque, &weights)
#define OF_MODEL(type, linearize_, function) \
    const acrobot_weights_t weights = weights_of(q, r); \
    acrobot_lqr_t of_model; \
    GET(type, linearize_, (float)torque); \
    ACCEPTED(function(&found, &weights, &of_model, NULL)); \
    COMPARE(of_model)
#define lqr() OF_MODEL(acrobot_linear_model_t, acrobot_linearize, acrobot_lqr)
#define dlqr() OF_MODEL(acrobot_step_model_t, acrobot_linearize_step, acrobot_dlqr)
#define tvlqr() \
    const acrobot_weights_t weights = weights_of(q, r); \
    acrobot_state_t gains[3]; \
    float cost_to_go[4][4]; \
    GET(acrobot_step_model_t, acrobot_linearize_step, (float)torque); \
    const acrobot_step_model_t models[] = {found, found, found}; \
    to_floats(cost_to_go, q, 16); \
    ACCEPTED(acrobot_tvlqr(models, &weights, &cost_to_go, gains, 3, NULL)); \
    COMPARE(gains); \
    COMPARE(cost_to_go)

#define dlqe() \
    acrobot_covariances_t noise; \
    acrobot_lqe_t lqe; \
    to_floats(noise.w, w, 16); \
    to_floats(noise.s, s, 2); \
    GET(acrobot_step_model_t, acrobot_linearize_step, (float)torque); \
    ACCEPTED(acrobot_dlqe(&found, &noise, &lqe, NULL)); \
    COMPARE(lqe)

static void compare_knots(const acrobot_knot_t *knots, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        COMPARE(knots[i].state);
        COMPARE(knots[i].torque);
        COMPARE(knots[i].gain);
    }
}

#define plan() \
    static const acrobot_state_t HANGING = {0, 0, 0, 0}, UPRIGHT = {3.1415927f, 0, 0, 0}; \
    static const size_t STEPS[] = {0, 2, KNOTS}; \
    acrobot_knot_t *const knots = shared.knots[0], *const better = shared.knots[1]; \
    const acrobot_params_t machine_ = machine(params); \
    const acrobot_state_t start_ = state_of(start); \
    acrobot_problem_t problem; \
    acrobot_planner_t planner; \
    acrobot_feedback_t after; \
    float cost, torque; \
    size_t found; \
    CHECK(steps == KNOTS); \
    ACCEPTED(acrobot_problem_init(&problem, &machine_, (float)limit, (float)elbow, NULL)); \
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL)); \
    ACCEPTED(acrobot_planner_plan(&planner, &HANGING, (uint32_t)tries, (uint64_t)seed[0], knots, \
                                  KNOTS, &found, NULL)); \
    CHECK(found == (size_t)length); \
    compare_knots(knots, found); \
    ACCEPTED(acrobot_planner_improve(&planner, &start_, (uint32_t)iterations, knots, better, \
                                     found, &cost, NULL)); \
    COMPARE(cost); \
    compare_knots(better, found); \
    ACCEPTED(acrobot_planner_feedback(&planner, &after)); \
    for (size_t i = 0; i < 3; i++) { \
        const acrobot_state_t *state = i == 0 ? &start_ : &UPRIGHT; \
        ACCEPTED(acrobot_plan_torque(better, found, &after, STEPS[i], state, &torque, NULL)); \
        COMPARE(torque); \
    }

#define swing_up() \
    const acrobot_params_t machine_ = machine(params); \
    acrobot_swing_up_t holder; \
    float torque; \
    ACCEPTED(acrobot_swing_up_init(&holder, &machine_, (float)limit, NULL)); \
    for (size_t i = 0; i < COUNT(states); i += 4) { \
        const acrobot_state_t state = state_of(states + i); \
        ACCEPTED(acrobot_swing_up_torque(&holder, &state, &torque, NULL)); \
        COMPARE(torque); \
    }

#define estimate() \
    const acrobot_params_t machine_ = machine(params); \
    const acrobot_noise_t noise = {(float)angle_std, (float)torque_std}; \
    const acrobot_parameter_std_t std = { \
        0, (float)mass2_std, 0, 0, 0, 0, 0, 0, (float)coulomb2_std, 0, (float)zero1_std, 0, \
        (float)torque_factor_std}; \
    acrobot_parameter_estimator_t filter; \
    acrobot_state_t state; \
    acrobot_params_t estimated; \
    float errors[3]; \
    ACCEPTED(acrobot_parameter_estimator_init(&filter, &machine_, &std, &noise, NULL)); \
    for (size_t i = 0; i < COUNT(torques); i++) { \
        ACCEPTED(acrobot_parameter_estimator_correct(&filter, (float)angles[2 * i], \
                                                     (float)angles[2 * i + 1], NULL)); \
        ACCEPTED(acrobot_parameter_estimator_predict(&filter, (float)torques[i], NULL)); \
    } \
    ACCEPTED(acrobot_parameter_estimator_state(&filter, &state)); \
    COMPARE(state); \
    ACCEPTED(acrobot_parameter_estimator_state_std(&filter, &state)); \
    COMPARE(state); \
    ACCEPTED(acrobot_parameter_estimator_params(&filter, &estimated)); \
    COMPARE_PARAMS(estimated); \
    ACCEPTED(acrobot_parameter_estimator_errors(&filter, &errors)); \
    COMPARE(errors)

#define ADD(samples, count) \
    ACCEPTED(acrobot_regression_add(&regression, samples, count, (double)drawn.dt, \
                                    (double)drawn.gravity, (size_t)half, (size_t)window, NULL))
#define identify() \
    acrobot_sample_t *const samples = shared.samples; \
    const acrobot_params_t drawn = machine(params); \
    const size_t count = (size_t)first; \
    acrobot_params_t found; \
    acrobot_regression_t regression; \
    acrobot_fit_t found_fit; \
    acrobot_calibration_t calibration; \
    (void)identified; \
    CHECK(COUNT(torques) == SAMPLES); \
    for (size_t i = 0; i < SAMPLES; i++) { \
        samples[i].angles[0] = angles[2 * i]; \
        samples[i].angles[1] = angles[2 * i + 1]; \
        samples[i].torques[0] = 0; \
        samples[i].torques[1] = torques[i]; \
    } \
    ACCEPTED(acrobot_identify(samples, SAMPLES, &drawn, &found, NULL)); \
    COMPARE_PARAMS(found); \
    ACCEPTED(acrobot_regression_init(&regression)); \
    ADD(samples, count); \
    ADD(samples + count, SAMPLES - count); \
    ACCEPTED(acrobot_regression_fit(&regression, &found_fit)); \
    CHECK(same(&found_fit, fit, sizeof fit) && found_fit.rank_deficiency == 0); \
    ACCEPTED(acrobot_fit_params(&found_fit, &drawn, &found, NULL)); \
    COMPARE_PARAMS(found); \
    ACCEPTED(acrobot_calibrate(samples, SAMPLES, &drawn, &calibration, NULL)); \
    CHECK(same(&calibration, calibrated, sizeof calibrated)); \
    COMPARE_PARAMS(calibration.params)

#define control() \
    const acrobot_settings_t settings = { \
        machine(params), (float)limit, {(int32_t)per_turn[0], (int32_t)per_turn[1]}, \
        (float)delay, (float)plan_timeout}; \
    static acrobot_controller_t controller; \
    static acrobot_replanner_t replanner; \
    acrobot_report_t report_; \
    float torque; \
    ACCEPTED(acrobot_controller_init(&controller, &settings, NULL)); \
    ACCEPTED(acrobot_replanner_init(&replanner, &settings, NULL)); \
    for (size_t i = 0; i < COUNT(counts) / 2; i++) { \
        ACCEPTED(acrobot_controller_tick(&controller, (int32_t)counts[2 * i], \
                                         (int32_t)counts[2 * i + 1], &torque, NULL)); \
        COMPARE(torque); \
        if (i % (size_t)every == 0) { \
            ACCEPTED(acrobot_replanner_exchange(&replanner, &controller)); \
            ACCEPTED(acrobot_replanner_work(&replanner)); \
        } \
    } \
    ACCEPTED(acrobot_controller_report(&controller, &report_)); \
    COMPARE(report_)

int main(void)
{
#include "results.h"
    return report("results");
}
