// Misuse is reported, and a call that is rejected changes nothing.

#include "check.h"

#define COUNT 3
#define WITH(mass1) \
    {1, 1, mass1, 1, .5f, .5f, 1, 1, 9.8f, .2f, 9, 9, {-1, 0, 1}, 0, 0, 0, 0, 0, 0, 0}

typedef acrobot_observation_t row_t;
typedef row_t rows_t[COUNT];
typedef float rewards_t[COUNT], matrix2_t[2][2], matrix4_t[4][4];

static const acrobot_params_t GOOD = WITH(1), MASSLESS = WITH(0);
static const acrobot_state_t REST = {0, 0, 0, 0}, UP = {3.14159f, 0, 0, 0}, FLUNG = {INF, 0, 0, 0};
static const acrobot_weights_t ONES = {{{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}, 1};
static const acrobot_covariances_t EVEN = {{{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}, {1, 1}};
static const acrobot_noise_t QUIET = {.001f, .01f};
static const acrobot_parameter_std_t DOUBT = {.1f, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const acrobot_settings_t RIGHT = {WITH(1), 6, {4096, 1024}, 5};
static const double LIMITS[] = {-1, 1, -1};
static const acrobot_reset_options_t WIDE = {NULL, 0, LIMITS}, SWAPPED = {NULL, 0, LIMITS + 1};
static const uint64_t SEEDED[COUNT] = {7, 8, 9};
static const uint8_t ACTED[COUNT] = {0, 1, 2};
static const bool MASKED[COUNT] = {true, false, true};
static const acrobot_sample_t STILL[COUNT] = {{{0, 0}, {0, 0}}};
static acrobot_knot_t rest[COUNT], improved[COUNT];
// By `main`.
static acrobot_draws_t reversed;
static acrobot_controller_t a_controller;
static acrobot_linear_model_t linear_model;
static acrobot_step_model_t step_model;
static acrobot_problem_t a_problem;
static acrobot_fit_t fit_of_nothing;
static acrobot_feedback_t feedback;

// Each argument that is no result: an array must not overlap the holder.
#define INPUTS \
    INPUT(acrobot_params_t, PARAMS, &GOOD, false) \
    INPUT(acrobot_params_t, NO_MASS, &MASSLESS, false) \
    INPUT(acrobot_state_t, STATE, &UP, false) \
    INPUT(acrobot_state_t, FAR, &FLUNG, false) \
    INPUT(acrobot_draws_t, REVERSED, &reversed, false) \
    INPUT(acrobot_weights_t, WEIGHTS, &ONES, false) \
    INPUT(acrobot_covariances_t, VARIANCES, &EVEN, false) \
    INPUT(acrobot_linear_model_t, MODEL, &linear_model, false) \
    INPUT(acrobot_step_model_t, STEPS, &step_model, true) \
    INPUT(acrobot_problem_t, PROBLEM, &a_problem, false) \
    INPUT(acrobot_knot_t, KNOTS, rest, true) \
    INPUT(acrobot_knot_t, NEXT, improved, true) \
    INPUT(acrobot_feedback_t, AFTER, &feedback, false) \
    INPUT(acrobot_noise_t, NOISE, &QUIET, false) \
    INPUT(acrobot_parameter_std_t, STD, &DOUBT, false) \
    INPUT(acrobot_fit_t, FIT, &fit_of_nothing, false) \
    INPUT(acrobot_sample_t, SAMPLES, STILL, true) \
    INPUT(acrobot_settings_t, SETTINGS, &RIGHT, false) \
    INPUT(acrobot_controller_t, CONTROLLED, &a_controller, true) \
    INPUT(uint32_t, WORDS, SEEDED, true) \
    INPUT(uint64_t, ALL_SEEDS, SEEDED, true) \
    INPUT(uint8_t, ACTIONS, ACTED, true) \
    INPUT(bool, MASK, MASKED, true)

// What holds the value that a function uses.
#define HOLDS \
    HOLDER(ALONE, acrobot_t, acrobot, ACROBOT_SIZE) \
    HOLDER(ACTION_SPACE, acrobot_action_space_t, action_space, ACROBOT_ACTION_SPACE_SIZE) \
    HOLDER(BATCH, acrobot_batch_t, batch, ACROBOT_BATCH_OWN_SIZE(COUNT)) \
    HOLDER(PLANNER, acrobot_planner_t, planner, ACROBOT_PLANNER_SIZE) \
    HOLDER(SWING_UP, acrobot_swing_up_t, swing_up, ACROBOT_SWING_UP_SIZE) \
    HOLDER(ESTIMATOR, acrobot_estimator_t, estimator, ACROBOT_ESTIMATOR_SIZE) \
    HOLDER(BOTH, acrobot_parameter_estimator_t, parameters, ACROBOT_PARAMETER_ESTIMATOR_SIZE) \
    HOLDER(REGRESSION, acrobot_regression_t, regression, ACROBOT_REGRESSION_SIZE) \
    HOLDER(CONTROLLER, acrobot_controller_t, controller, ACROBOT_CONTROLLER_SIZE) \
    HOLDER(REPLANNER, acrobot_replanner_t, replanner, ACROBOT_REPLANNER_SIZE)
#define HOLDER(holder, type, name, size) holder,
enum { HOLDS HOLDERS, NOTHING = HOLDERS };
#undef HOLDER
#define HOLDER(holder, type, name, size) size,
static const size_t SIZES[] = {HOLDS 0};
#undef HOLDER
enum { NEEDED, OPTIONAL, NONE };
enum { OK = ACROBOT_OK, RANGE = ACROBOT_ERROR_OUT_OF_RANGE };

// Every pointer through which a function writes a result or an error, whether it may be null, and
// the status. NONE: the function has no such pointer.
#define RESULT(holder, type, ...) CALL(holder, type, NEEDED, OK, __VA_ARGS__)
#define ERROR(holder, ...) CALL(holder, acrobot_error_t, OPTIONAL, RANGE, __VA_ARGS__)
#define RESET(...) CALL(ALONE, row_t, OPTIONAL, OK, __VA_ARGS__)
#define BEGIN(holder, ...) CALL(holder, void *, NONE, OK, __VA_ARGS__)
#define COMPUTE(type, ...) CALL(NOTHING, type, NEEDED, OK, __VA_ARGS__)
#define FAIL(type, ...) CALL(NOTHING, type, NEEDED, RANGE, __VA_ARGS__)
#define INIT(holder, ...) CALL(holder, acrobot_error_t, OPTIONAL, OK, __VA_ARGS__)
// The first ones initialize the holders, in the same order.
#define CALLS \
    BEGIN(ALONE, acrobot_init(acrobot, 42)) \
    BEGIN(ACTION_SPACE, acrobot_action_space_init(action_space, 42)) \
    RESULT(BATCH, acrobot_batch_t *, acrobot_batch_init(batch, SIZE, COUNT, 0, true, 42, out)) \
    INIT(PLANNER, acrobot_planner_init(planner, PROBLEM, out)) \
    INIT(SWING_UP, acrobot_swing_up_init(swing_up, PARAMS, 1, out)) \
    INIT(ESTIMATOR, acrobot_estimator_init(estimator, PARAMS, NOISE, out)) \
    INIT(BOTH, acrobot_parameter_estimator_init(parameters, PARAMS, STD, NOISE, out)) \
    BEGIN(REGRESSION, acrobot_regression_init(regression)) \
    INIT(CONTROLLER, acrobot_controller_init(controller, SETTINGS, out)) \
    INIT(REPLANNER, acrobot_replanner_init(replanner, SETTINGS, out)) \
    INIT(ALONE, acrobot_init_task(acrobot, 1, 42, out)) \
    BEGIN(ACTION_SPACE, acrobot_action_space_init_with(action_space, WORDS, 1)) \
    RESET(acrobot_reset(acrobot, out)) \
    RESET(acrobot_reset_with_seed(acrobot, 7, out)) \
    RESET(acrobot_reset_with(acrobot, &WIDE, out, NULL)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OK, acrobot_reset_with(acrobot, NULL, NULL, out)) \
    ERROR(ALONE, acrobot_reset_with(acrobot, &SWAPPED, NULL, out)) \
    RESULT(ALONE, acrobot_step_t, acrobot_step(acrobot, 2, out)) \
    RESULT(ALONE, acrobot_step_t, acrobot_step_torque(acrobot, 1, out, NULL)) \
    ERROR(ALONE, acrobot_step_torque(acrobot, INF, &step, out)) \
    RESULT(ALONE, row_t, acrobot_observe(acrobot, out)) \
    RESULT(ALONE, uint32_t, acrobot_elapsed_steps(acrobot, out)) \
    RESULT(ALONE, uint32_t, acrobot_max_steps(acrobot, out)) \
    RESULT(ALONE, int, acrobot_task(acrobot, out)) \
    ERROR(ALONE, acrobot_set_max_steps(acrobot, 0, out)) \
    RESULT(ALONE, acrobot_state_t, acrobot_state(acrobot, out)) \
    ERROR(ALONE, acrobot_set_state(acrobot, FAR, out)) \
    RESULT(ALONE, acrobot_params_t, acrobot_params(acrobot, out)) \
    ERROR(ALONE, acrobot_set_params(acrobot, NO_MASS, out)) \
    ERROR(ALONE, acrobot_draw_params(acrobot, REVERSED, out)) \
    RESULT(ALONE, float, acrobot_energy(acrobot, out)) \
    RESULT(ALONE, float, acrobot_tip_height(acrobot, out)) \
    RESULT(ACTION_SPACE, uint8_t, acrobot_action_space_sample(action_space, out)) \
    RESULT(ACTION_SPACE, uint8_t, acrobot_action_space_sample_each(action_space, out, 1)) \
    BEGIN(BATCH, acrobot_batch_reset(batch)) \
    BEGIN(BATCH, acrobot_batch_reset_with(batch, &WIDE, NULL)) \
    ERROR(BATCH, acrobot_batch_reset_with(batch, &SWAPPED, out)) \
    BEGIN(BATCH, acrobot_batch_reset_masked(batch, MASK, COUNT, NULL, NULL)) \
    ERROR(BATCH, acrobot_batch_reset_masked(batch, MASK, COUNT, &SWAPPED, out)) \
    BEGIN(BATCH, acrobot_batch_reset_with_seeds(batch, ALL_SEEDS, COUNT)) \
    RESULT(BATCH, rewards_t, acrobot_batch_step(batch, ACTIONS, &results, COUNT)) \
    RESULT(BATCH, rows_t, acrobot_batch_observe(batch, (row_t *)out, COUNT)) \
    RESULT(BATCH, acrobot_batch_settings_t, acrobot_batch_settings(batch, out)) \
    RESULT(BATCH, uint32_t, acrobot_batch_elapsed_steps(batch, 0, out)) \
    RESULT(BATCH, bool, acrobot_batch_is_done(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_draws(batch, REVERSED, out)) \
    ERROR(BATCH, acrobot_batch_set_autoreset(batch, 3, out)) \
    ERROR(BATCH, acrobot_batch_set_max_steps(batch, 0, out)) \
    RESULT(BATCH, acrobot_state_t, acrobot_batch_state(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_state(batch, 0, FAR, out)) \
    RESULT(BATCH, acrobot_params_t, acrobot_batch_params(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_all_params(batch, NO_MASS, out)) \
    ERROR(BATCH, acrobot_batch_set_params(batch, 0, NO_MASS, out)) \
    BEGIN(PLANNER, acrobot_planner_with_velocity_clamp(planner)) \
    RESULT(PLANNER, size_t, acrobot_planner_plan(planner, STATE, 1, 4, KNOTS, COUNT, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_plan(planner, FAR, 1, 4, KNOTS, COUNT, &length, out)) \
    RESULT(PLANNER, float, acrobot_planner_improve(planner, STATE, 1, KNOTS, NEXT, 2, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_improve(planner, FAR, 1, KNOTS, NEXT, 3, &torque, out)) \
    RESULT(PLANNER, acrobot_feedback_t, acrobot_planner_feedback(planner, out)) \
    RESULT(PLANNER, bool, acrobot_planner_holds_from(planner, STATE, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_holds_from(planner, FAR, &holds, out)) \
    RESULT(SWING_UP, float, acrobot_swing_up_torque(swing_up, STATE, out, NULL)) \
    ERROR(SWING_UP, acrobot_swing_up_torque(swing_up, FAR, &torque, out)) \
    ERROR(ESTIMATOR, acrobot_estimator_correct(estimator, INF, 0, out)) \
    ERROR(ESTIMATOR, acrobot_estimator_predict(estimator, INF, out)) \
    RESULT(ESTIMATOR, acrobot_state_t, acrobot_estimator_state(estimator, out)) \
    RESULT(ESTIMATOR, acrobot_state_t, acrobot_estimator_state_std(estimator, out)) \
    ERROR(BOTH, acrobot_parameter_estimator_correct(parameters, 0, INF, out)) \
    ERROR(BOTH, acrobot_parameter_estimator_predict(parameters, INF, out)) \
    RESULT(BOTH, acrobot_state_t, acrobot_parameter_estimator_state(parameters, out)) \
    RESULT(BOTH, acrobot_state_t, acrobot_parameter_estimator_state_std(parameters, out)) \
    RESULT(BOTH, acrobot_params_t, acrobot_parameter_estimator_params(parameters, out)) \
    ERROR(REGRESSION, acrobot_regression_add(regression, SAMPLES, COUNT, 0, 9.8, 1, 1, out)) \
    RESULT(REGRESSION, acrobot_fit_t, acrobot_regression_fit(regression, out)) \
    RESULT(CONTROLLER, float, acrobot_controller_tick(controller, 1, 2, out, NULL)) \
    RESULT(CONTROLLER, acrobot_state_t, acrobot_controller_state(controller, out)) \
    RESULT(CONTROLLER, acrobot_params_t, acrobot_controller_params(controller, out)) \
    BEGIN(REPLANNER, acrobot_replanner_exchange(replanner, CONTROLLED)) \
    BEGIN(REPLANNER, acrobot_replanner_work(replanner)) \
    COMPUTE(acrobot_params_t, acrobot_task_params(0, out, &error)) \
    COMPUTE(acrobot_state_t, acrobot_deviation_from(STATE, STATE, out, &error)) \
    COMPUTE(acrobot_rates_t, acrobot_derivative(PARAMS, STATE, 1, out, &error)) \
    COMPUTE(matrix2_t, acrobot_mass_matrix(PARAMS, STATE, out, &error)) \
    COMPUTE(acrobot_forces_t, acrobot_inverse_dynamics(PARAMS, STATE, 1, 2, out, &error)) \
    COMPUTE(acrobot_linear_model_t, acrobot_linearize(PARAMS, STATE, 1, out, &error)) \
    COMPUTE(acrobot_step_model_t, acrobot_linearize_step(PARAMS, STATE, 1, out, &error)) \
    COMPUTE(acrobot_lqr_t, acrobot_regulator(PARAMS, STATE, 0, WEIGHTS, out, &error)) \
    COMPUTE(acrobot_lqr_t, acrobot_lqr(MODEL, WEIGHTS, out, &error)) \
    COMPUTE(acrobot_lqr_t, acrobot_dlqr(STEPS, WEIGHTS, out, &error)) \
    COMPUTE(acrobot_lqe_t, acrobot_dlqe(STEPS, VARIANCES, out, &error)) \
    COMPUTE(matrix4_t, acrobot_tvlqr(STEPS, WEIGHTS, out, &gain, 1, &error)) \
    COMPUTE(acrobot_problem_t, acrobot_problem_init(out, PARAMS, 1, 0, &error)) \
    COMPUTE(float, acrobot_plan_torque(KNOTS, 1, AFTER, 0, STATE, out, &error)) \
    COMPUTE(double, acrobot_prediction_error(PARAMS, SAMPLES, 1, 1, out, &error)) \
    FAIL(acrobot_params_t, acrobot_fit_params(FIT, PARAMS, out, &error)) \
    FAIL(acrobot_params_t, acrobot_identify(SAMPLES, 1, PARAMS, out, &error))

struct call {
    int holder, optional, status;
    size_t size;
    const char *text;
};

static const struct call TABLE[] = {
#define CALL(holder, type, optional, status, ...) \
    {holder, optional, status, sizeof(type), #__VA_ARGS__},
    CALLS
#undef CALL
};
enum { ROWS = sizeof TABLE / sizeof TABLE[0] };

static const struct {
    const char *name;
    size_t size;
    bool is_array;
} NAMES[] = {
#define INPUT(type, name, value, is_array) {#name, sizeof(type), is_array},
    INPUTS
#undef INPUT
};
enum { INPUT_COUNT = sizeof NAMES / sizeof NAMES[0] };

#define MARGIN 192
#define SIZE ACROBOT_BATCH_OWN_SIZE(COUNT)
// The most that a holder has.
#define MOST ACROBOT_CONTROLLER_SIZE
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t arena[MARGIN + MOST + MARGIN];
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t other[MOST], spare[2 * MARGIN];
static const uint8_t ZERO[2 * MARGIN] = {0};
static uint8_t saved[MOST];
static uint8_t *const held = arena + MARGIN;

// Which input is wrong, and how.
enum { BY_NULL, BY_A_BYTE, BY_OVERLAP };
static int wrong = -1, how;

static void *input(int index, const void *pointer)
{
    if (index != wrong) {
        return (void *)pointer;
    }
    return how == BY_NULL ? NULL : how == BY_OVERLAP ? held : (uint8_t *)pointer + 1;
}

static acrobot_status_t call(int index, void *holder, void *pointer)
{
#define HOLDER(holder_, type, name, size) type *name = (type *)holder;
    HOLDS
#undef HOLDER
    int next = 0;
#define INPUT(type, name, value, is_array) type *name = (type *)input(next++, value);
    INPUTS
#undef INPUT
    acrobot_step_t step;
    acrobot_state_t gain;
    float torque;
    size_t length;
    bool holds, terminated[COUNT], truncated[COUNT];
    const acrobot_batch_results_t results = {(float *)pointer, terminated, truncated, NULL, NULL};
#define CALL(holder, type, optional, status, ...) \
    if (index-- == 0) { \
        type *out = (type *)pointer; \
        (void)out; \
        return __VA_ARGS__; \
    }
    CALLS
#undef CALL
    return ACROBOT_OK;
}

static void expect(int index, void *holder, void *out, int status)
{
    if ((int)call(index, holder, out) != status) {
        print(TABLE[index].text);
        print(" must return ");
        print(acrobot_status_text(status));
        print(wrong < 0 ? "" : " for ");
        print(wrong < 0 ? "" : NAMES[wrong].name);
        print("\n");
        failures++;
    }
}

static void *hold(int holder)
{
    if (holder != NOTHING) {
        expect(holder, held, spare, ACROBOT_OK);
    }
    __builtin_memcpy(saved, held, MOST);
    return held;
}

static bool contains(const char *text, const char *word)
{
    while (*text != 0 && after(text, word) == NULL) {
        text++;
    }
    return *text != 0;
}

static void holders(void)
{
    for (int i = 0; i < ROWS; i++) {
        const int holder = TABLE[i].holder;
        if (holder != NOTHING) {
            expect(i, NULL, spare, ACROBOT_ERROR_NULL);
            expect(i, held + 1, spare, ACROBOT_ERROR_MISALIGNED);
        }
        if (holder != NOTHING && !contains(TABLE[i].text, "_init")) {
            // `other` contains zeros.
            expect(i, other, spare, ACROBOT_ERROR_NOT_INITIALIZED);
            expect(i, hold((holder + 1) % HOLDERS), spare, ACROBOT_ERROR_NOT_INITIALIZED);
        }
        expect(i, hold(holder), spare, TABLE[i].status);
    }
    __builtin_memcpy(other, hold(BATCH), sizeof other);
    for (int i = HOLDERS; i < ROWS; i++) {
        if (TABLE[i].holder == BATCH) {
            expect(i, other, spare, ACROBOT_ERROR_MOVED);
        }
    }
    CHECK(same(other, saved, sizeof other));
}

static void inputs(void)
{
    for (int i = 0; i < ROWS; i++) {
        const struct call *row = &TABLE[i];
        hold(row->holder);
        __builtin_memset(spare, 0, sizeof spare);
        for (wrong = 0; wrong < INPUT_COUNT; wrong++) {
            if (!contains(row->text, NAMES[wrong].name)) {
                continue;
            }
            how = BY_NULL;
            expect(i, held, spare, ACROBOT_ERROR_NULL);
            how = BY_A_BYTE;
            if (NAMES[wrong].size > 1) {
                expect(i, held, spare, ACROBOT_ERROR_MISALIGNED);
            }
            how = BY_OVERLAP;
            if (NAMES[wrong].is_array && row->holder != NOTHING) {
                expect(i, held, spare, ACROBOT_ERROR_OVERLAP);
            }
        }
        wrong = -1;
        CHECK(same(held, saved, SIZES[row->holder]) && same(spare, ZERO, sizeof spare));
    }
}

// Tries each address in the arena: one in the held bytes must be rejected, and none of them change.
static void results(void)
{
    for (int i = 0; i < ROWS; i++) {
        const struct call *row = &TABLE[i];
        const size_t size = SIZES[row->holder], align = row->size < 8 ? row->size : 8;
        if (row->optional == NONE) {
            continue;
        }
        const int without = row->optional == OPTIONAL ? row->status : ACROBOT_ERROR_NULL;
        expect(i, hold(row->holder), NULL, without);
        __builtin_memcpy(held, saved, size);
        if (align > 1) {
            expect(i, held, spare + 1, ACROBOT_ERROR_MISALIGNED);
        }
        for (size_t at = 0; at + row->size <= sizeof arena && size > 0; at += align) {
            const bool is_apart = at + row->size <= MARGIN || at >= MARGIN + size;
            expect(i, held, arena + at, is_apart ? row->status : ACROBOT_ERROR_OVERLAP);
            CHECK((is_apart && row->status == ACROBOT_OK) || same(held, saved, size));
            __builtin_memcpy(held, saved, size);
        }
    }
}

int main(void)
{
    acrobot_regression_t nothing;
    acrobot_planner_t planner;
    reversed.length1.kind = ACROBOT_DRAW_UNIFORM;
    reversed.length1.low = 2;
    reversed.length1.high = 1;
    ACCEPTED(acrobot_controller_init(&a_controller, &RIGHT, NULL));
    ACCEPTED(acrobot_linearize(&GOOD, &REST, 0, &linear_model, NULL));
    ACCEPTED(acrobot_linearize_step(&GOOD, &REST, 0, &step_model, NULL));
    ACCEPTED(acrobot_problem_init(&a_problem, &GOOD, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &a_problem, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, &feedback));
    ACCEPTED(acrobot_regression_init(&nothing));
    ACCEPTED(acrobot_regression_fit(&nothing, &fit_of_nothing));
    holders();
    inputs();
    results();
    return report("misuse");
}
