// Numbers that are out of range are reported, and change nothing.

#include "check.h"

#define COUNT 3
#define WITH(mass1, gravity) \
    {1, 1, mass1, 1, .5f, .5f, 1, 1, gravity, .2f, 9, 9, {-1, 0, 1}, 0, 0, 0, 0, 0, 0, 0}
#define ONE_BY_ONE {{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}

typedef float matrix2_t[2][2];

static const acrobot_params_t GOOD = WITH(1, 9.8f), MASSLESS = WITH(0, 9.8f),
                              WEIGHTLESS = WITH(1, 0);
static const acrobot_state_t REST = {0, 0, 0, 0}, INFINITE = {INF, 0, 0, 0}, MOVING = {0, 0, 1, 0},
                             FASTEST = {0, 0, 0, 3e38f}, BACK = {0, 0, 0, -3e38f};
static const acrobot_weights_t ONES = {ONE_BY_ONE, 1}, ZEROS = {{{0}}, 1}, FREE = {ONE_BY_ONE, 0},
                               UNEVEN = {{{1, 2}, {0, 1}}, 1}, NEGATIVE = {{{-1}}, 1};
static const acrobot_covariances_t EVEN = {ONE_BY_ONE, {1, 1}}, SILENT = {{{0}}, {1, 1}},
                                   EXACT = {ONE_BY_ONE, {1, 0}};
static const acrobot_step_model_t GROWING = {{{0}, {0}, {0, 0, 2}}, {0}},
                                  LASTING = {{{1}}, {0}};
static const acrobot_sample_t STILL = {{0, 0}, {0, 0}};

#define params_rejects(message, set) \
    params = GOOD; \
    set; \
    expect_message(acrobot_set_params(acrobot, &params, &error), message);
#define state_rejects(message, set) \
    state = REST; \
    set; \
    expect_message(acrobot_set_state(acrobot, &state, &error), message);
#define torque_rejects(message, torque) \
    expect_message(acrobot_step_torque(acrobot, torque, &step, &error), message);
#define bounds_rejects(message, set) \
    set; \
    options.bounds = &bounds.low; \
    expect_message(acrobot_reset_with(acrobot, &options, NULL, &error), message);
#define draw_rejects(message, kind, mean, std, low, high) \
    { \
        const acrobot_draw_t draw = {ACROBOT_DRAW_##kind, low, high, mean, std}; \
        draws.mass2 = draw; \
        expect_message(acrobot_draw_params(acrobot, &draws, &error), message); \
    }
#define action_rejects(message, action) \
    REJECTED(UNKNOWN_ACTION, acrobot_step(acrobot, action, &step));

static void of_an_acrobot(void)
{
    acrobot_t one, before, *acrobot = &one;
    acrobot_step_t step;
    acrobot_state_t state;
    acrobot_params_t params = GOOD;
    static acrobot_draws_t draws;
    acrobot_reset_options_t options = {NULL, 0, NULL};
    struct {
        double low, high;
    } bounds;
    ACCEPTED(acrobot_init(acrobot, 42));
    before = one;
    // The calls that all languages reject, from tests/data/rejections.jsonl.
#include "rejections.h"
    // The lowest byte of 256 is an action.
    REJECTED(UNKNOWN_ACTION, acrobot_step(acrobot, 256, &step));
    params_rejects("dynamics must be 0 (book) or 1 (NIPS), got 256", params.dynamics = 256);
    expect_message(acrobot_set_max_steps(acrobot, 0, &error),
                   "max_steps must be above 0 steps, got ");
    draws.gravity.kind = 4;
    expect_message(acrobot_draw_params(acrobot, &draws, &error), "kind must be from 0 to 3, got ");
    CHECK(error.value == 4);
    CHECK(same(&one, &before, sizeof one));
}

#define MAKE(size, count) acrobot_batch_init(memory, size, count, 0, true, 42, &none)
static void of_a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_OWN_SIZE(COUNT)];
    static uint8_t before[sizeof memory];
    static const uint64_t SEEDS[COUNT] = {7, 8, 9};
    acrobot_batch_t *batch, *none;
    acrobot_state_t state;
    acrobot_observation_t rows[COUNT];
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], mask[COUNT] = {true, true, true};
    uint8_t actions[COUNT] = {0, 1, 3}, odd = 2;
    const acrobot_batch_results_t all = {rewards, terminated, truncated, rows, NULL};
    acrobot_batch_results_t results = all;
    acrobot_params_t params = GOOD;
    for (size_t count = 1; count < 100; count++) {
        CHECK(acrobot_batch_size(count, false) == ACROBOT_BATCH_SIZE(count));
        CHECK(acrobot_batch_size(count, true) == ACROBOT_BATCH_OWN_SIZE(count));
    }
    // Too many for the products to be ints.
    CHECK(acrobot_batch_size(30000000, false) == ACROBOT_BATCH_SIZE(30000000));
    CHECK(acrobot_batch_size(SIZE_MAX, true) == SIZE_MAX);
    ACCEPTED(acrobot_batch_init(memory, sizeof memory, COUNT, 0, true, 42, &batch));
    __builtin_memcpy(before, memory, sizeof before);
    REJECTED(OUT_OF_RANGE, acrobot_batch_init(memory, sizeof memory, COUNT, 3, true, 42, &none));
    REJECTED(MISALIGNED, acrobot_batch_init(memory + 32, sizeof memory, 1, 0, true, 42, &none));
    REJECTED(BUFFER_TOO_SMALL, MAKE(sizeof memory - 1, COUNT));
    REJECTED(BUFFER_TOO_SMALL, MAKE(sizeof memory, SIZE_MAX));
    REJECTED(WRONG_COUNT, MAKE(sizeof memory, 0));
    REJECTED(UNKNOWN_ACTION, acrobot_batch_step(batch, actions, &all, COUNT));
    actions[2] = 2;
    REJECTED(WRONG_COUNT, acrobot_batch_step(batch, actions, &all, COUNT - 1));
    REJECTED(NULL, acrobot_batch_step(batch, actions, NULL, COUNT));
    results.final_observations = rows;
    REJECTED(OVERLAP, acrobot_batch_step(batch, actions, &results, COUNT));
    results = all;
    results.truncated = (bool *)actions;
    REJECTED(OVERLAP, acrobot_batch_step(batch, actions, &results, COUNT));
    results = all;
    results.terminated = (bool *)(void *)&results;
    REJECTED(OVERLAP, acrobot_batch_step(batch, actions, &results, COUNT));
    CHECK(results.rewards == rewards);
    REJECTED(WRONG_COUNT, acrobot_batch_observe(batch, rows, COUNT + 1));
    REJECTED(WRONG_COUNT, acrobot_batch_reset_masked(batch, mask, COUNT - 1, NULL, NULL));
    __builtin_memcpy(&mask[2], &odd, 1);
    REJECTED(OUT_OF_RANGE, acrobot_batch_reset_masked(batch, mask, COUNT, NULL, NULL));
    REJECTED(WRONG_COUNT, acrobot_batch_reset_with_seeds(batch, SEEDS, COUNT + 1));
    REJECTED(OUT_OF_RANGE, acrobot_batch_set_autoreset(batch, 256, NULL));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_state(batch, COUNT, &state));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_set_state(batch, COUNT, &REST, NULL));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_params(batch, COUNT, &params));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_set_params(batch, COUNT, &params, NULL));
    CHECK(same(memory, before, sizeof memory));
}

// Rejected with this kind and name, and without a change of the result.
#define FAILS(kind_of, name_of, type, function, ...) \
    do { \
        type value, before, *out = &value; \
        __builtin_memset(&value, 7, sizeof value); \
        __builtin_memset(&before, 7, sizeof value); \
        REJECTED(OUT_OF_RANGE, acrobot_##function(__VA_ARGS__, out, &error)); \
        CHECK(error.kind == ACROBOT_##kind_of && same_text(error.name, name_of)); \
        CHECK(same(&value, &before, sizeof value)); \
    } while (0)

static void of_models(void)
{
    static const acrobot_knot_t NO_TORQUE = {{0, 0, 0, 0}, 0, {0, 0, 0, 0}, {0, 0}};
    acrobot_linear_model_t linear_model;
    acrobot_step_model_t step_model;
    acrobot_problem_t problem;
    acrobot_planner_t planner;
    acrobot_feedback_t feedback;
    acrobot_regression_t regression;
    acrobot_fit_t fit;
    acrobot_knot_t knot = NO_TORQUE;
    acrobot_sample_t sample = STILL;
    acrobot_state_t gain;
    ACCEPTED(acrobot_linearize(&GOOD, &REST, 0, &linear_model, NULL));
    ACCEPTED(acrobot_linearize_step(&GOOD, &REST, 0, &step_model, NULL));
    ACCEPTED(acrobot_problem_init(&problem, &GOOD, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, &feedback));
    ACCEPTED(acrobot_regression_init(&regression));
    ACCEPTED(acrobot_regression_fit(&regression, &fit));
    CHECK(fit.rank_deficiency == 10);
    FAILS(OUT_OF_RANGE, "task", acrobot_params_t, task_params, 3);
    FAILS(OUT_OF_RANGE, "dtheta2", acrobot_state_t, deviation_from, &FASTEST, &BACK);
    FAILS(OUT_OF_RANGE, "mass1", acrobot_rates_t, derivative, &MASSLESS, &REST, 0);
    FAILS(OUT_OF_RANGE, "torque", acrobot_rates_t, derivative, &GOOD, &REST, NAN);
    FAILS(NOT_FINITE, "rates", acrobot_rates_t, derivative, &GOOD, &FASTEST, 0);
    FAILS(OUT_OF_RANGE, "theta1", matrix2_t, mass_matrix, &GOOD, &INFINITE);
    FAILS(OUT_OF_RANGE, "ddtheta2", acrobot_forces_t, inverse_dynamics, &GOOD, &REST, 0, INF);
    FAILS(OUT_OF_RANGE, "torque", acrobot_linear_model_t, linearize, &GOOD, &REST, INF);
    FAILS(NOT_FINITE, "a", acrobot_step_model_t, linearize_step, &GOOD, &FASTEST, 0);
    FAILS(NOT_IN_EQUILIBRIUM, "target", acrobot_lqr_t, regulator, &GOOD, &MOVING, 0, &ONES);
    FAILS(NOT_IN_EQUILIBRIUM, "target", acrobot_lqr_t, regulator, &GOOD, &REST, 1, &ONES);
    FAILS(OUT_OF_RANGE, "r", acrobot_lqr_t, regulator, &GOOD, &REST, 0, &FREE);
    FAILS(NOT_SYMMETRIC, "q", acrobot_lqr_t, lqr, &linear_model, &UNEVEN);
    FAILS(NOT_SEMIDEFINITE, "q", acrobot_lqr_t, dlqr, &step_model, &NEGATIVE);
    // Without gravity the acrobot can turn forever, and the motor does not change that. Without
    // weights and friction it may swing.
    FAILS(NOT_STABILIZABLE, "gain", acrobot_lqr_t, regulator, &WEIGHTLESS, &REST, 0, &ONES);
    FAILS(NOT_DETECTABLE, "gain", acrobot_lqr_t, lqr, &linear_model, &ZEROS);
    CHECK(same_text(acrobot_error_text(error.kind),
                    "q must weight each motion that persists, but does not weight one"));
    CHECK(same_text(error.rule, "finite; target, dt, gravity, weights or noise allow none"));
    FAILS(OUT_OF_RANGE, "s", acrobot_lqe_t, dlqe, &step_model, &EXACT);
    // No angle shows a velocity.
    FAILS(NOT_OBSERVABLE, "gain", acrobot_lqe_t, dlqe, &GROWING, &EVEN);
    CHECK(same_text(acrobot_error_text(error.kind),
                    "the measured angles must show each motion that grows or persists, but do not "
                    "show one"));
    FAILS(NOT_EXCITED, "gain", acrobot_lqe_t, dlqe, &LASTING, &SILENT);
    CHECK(same_text(acrobot_error_text(error.kind),
                    "w must excite each motion that persists, but does not excite one"));
    REJECTED(OVERLAP, acrobot_tvlqr(&step_model, &ONES, &step_model.a, &gain, 1, &error));
    // NaN and infinite torques.
    FAILS(OUT_OF_RANGE, "theta1", float, plan_torque, &knot, 1, &feedback, 0, &INFINITE);
    knot.torque = NAN;
    FAILS(NOT_FINITE, "torque", float, plan_torque, &knot, 1, &feedback, 0, &REST);
    knot = NO_TORQUE;
    knot.gain.dtheta2 = 1e38f;
    FAILS(NOT_FINITE, "torque", float, plan_torque, &knot, 1, &feedback, 0, &FASTEST);
    // A recording at rest determines nothing.
    FAILS(OUT_OF_RANGE, "mass11", acrobot_params_t, fit_params, &fit, &GOOD);
    CHECK(same_text(error.rule,
                    "determined by recordings in which both links move long enough, in kg m²"));
    FAILS(OUT_OF_RANGE, "mass11", acrobot_params_t, identify, &STILL, 1, &GOOD);
    sample.torques[1] = (double)NAN;
    FAILS(NOT_FINITE, "torques", acrobot_params_t, identify, &sample, 1, &GOOD);
}

static void of_controllers(void)
{
    static const acrobot_noise_t QUIET = {.001f, .01f}, SILENCE = {.001f, 0};
    static const acrobot_settings_t TURNLESS = {WITH(1, 9.8f), 6, {4096, 0}, 5};
    static const acrobot_parameter_std_t STD = {0, 0, 0, 0, 0, 0, 0, 0, 0, -1};
    static acrobot_controller_t controller;
    acrobot_planner_t planner, before;
    acrobot_problem_t problem;
    acrobot_knot_t plan = {REST, 0, REST, {0, 0}}, followed = plan, better;
    acrobot_parameter_estimator_t parameters;
    acrobot_params_t unbounded = GOOD;
    acrobot_estimator_t estimator;
    acrobot_regression_t regression;
    acrobot_state_t state;
    size_t length;
    float cost;
    expect_message(acrobot_problem_init(&problem, &GOOD, 1, INF, &error),
                   "theta2 must be a finite number of rad, got ");
    ACCEPTED(acrobot_problem_init(&problem, &GOOD, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    __builtin_memcpy(&before, &planner, sizeof before);
    problem.cost.power = -1;
    expect_message(acrobot_planner_init(&planner, &problem, &error),
                   "power must be finite and at least 0 per J, got ");
    CHECK(same(&planner, &before, sizeof before));
    expect_message(acrobot_planner_plan(&planner, &REST, 2, 4, &better, 1, &length, &error),
                   "tries must be enough to find a plan, got ");
    CHECK(same_text(acrobot_error_text(error.kind), "no plan ends upright"));
    REJECTED(OVERLAP, acrobot_planner_improve(&planner, &REST, 2, &plan, &plan, 1, &cost, NULL));
    // The plan that a machine follows stays, also from a state that is too extreme.
    expect_message(acrobot_planner_improve(&planner, &FASTEST, 2, &plan, &better, 1, &cost, &error),
                   "cost must be finite in each element, got ");
    CHECK(same(&plan, &followed, sizeof plan));
    plan.torque = INF;
    expect_message(acrobot_planner_improve(&planner, &REST, 2, &plan, &better, 1, &cost, &error),
                   "torque must be finite in each element, got ");

    expect_message(acrobot_estimator_init(&estimator, &GOOD, &SILENCE, &error),
                   "torque_std must be finite and above 0 N m, got ");
    expect_message(acrobot_parameter_estimator_init(&parameters, &GOOD, &STD, &QUIET, &error),
                   "rotor must be finite and at least 0 kg m², got ");
    // Until a step in which a joint turns too far.
    unbounded.max_velocity1 = INF;
    ACCEPTED(acrobot_estimator_init(&estimator, &unbounded, &QUIET, NULL));
    ACCEPTED(acrobot_estimator_correct(&estimator, 0, 0, NULL));
    expect_message(acrobot_estimator_predict(&estimator, 1e6f, &error),
                   "dtheta1 must be at most half a turn in a step, in rad/s, got ");
    ACCEPTED(acrobot_estimator_state_std(&estimator, &state));
    CHECK(state.theta1 == INF);
    ACCEPTED(acrobot_regression_init(&regression));
    expect_message(acrobot_regression_add(&regression, &STILL, 1, 1, 1, 1, 0, &error),
                   "window must be finite and above 0 samples, got ");
    expect_message(acrobot_controller_init(&controller, &TURNLESS, &error),
                   "counts must be finite and above 0 for a turn, got ");
}

int main(void)
{
    of_an_acrobot();
    of_a_batch();
    of_models();
    of_controllers();
    CHECK(same_text(acrobot_status_text(ACROBOT_OK), "no error"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP), "two arguments overlap"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_SHARED_PARAMS + 1), "unknown status"));
    CHECK(same_text(acrobot_error_text(-1), "unknown kind"));
    CHECK(same_text(acrobot_error_text(ACROBOT_NOT_EXCITED + 1), "unknown kind"));
    return report("rejections");
}
