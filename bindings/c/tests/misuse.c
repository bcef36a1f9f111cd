// Misuse is reported, and a call that is rejected changes nothing.

#include "check.h"

#define COUNT 3

static const acrobot_state_t REST = {0, 0, 0, 0}, UP = {3.14159f, 0, 0, 0}, FAR = {INF, 0, 0, 0};
#define WITH_MASS1(mass1) \
    {1, 1, mass1, 1, .5f, .5f, 1, 1, 9.8f, .2f, 1, 1, {-1, 0, 1}, 0, 0, 0, 0, 0, 0, 0}
static const acrobot_params_t PARAMS = WITH_MASS1(1), NO_MASS = WITH_MASS1(0);
static acrobot_draws_t reversed; // by `main`
static acrobot_knot_t knots[COUNT], better[COUNT];
static const acrobot_sample_t SAMPLES[COUNT] = {{{0, 0}, {0, 0}}};
static const acrobot_noise_t NOISE = {.001f, .01f};
static const acrobot_parameter_std_t DOUBT = {.1f, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const acrobot_settings_t SETTINGS = {WITH_MASS1(1), 6, {4096, 1024}, 5};
static acrobot_controller_t a_controller; // by `main`
static const bool MASK[COUNT] = {true, false, true};
static const uint64_t SEEDS[COUNT] = {7, 8, 9};
static const double BOUNDS[] = {-1, 1, -1};
static const acrobot_reset_options_t WIDE = {NULL, 0, BOUNDS}, SWAPPED = {NULL, 0, BOUNDS + 1};

typedef acrobot_observation_t row_t;
typedef row_t rows_t[COUNT];
typedef float rewards_t[COUNT];

static acrobot_status_t step_batch(acrobot_batch_t *batch, void *rewards)
{
    const uint8_t actions[COUNT] = {0, 1, 2};
    bool terminated[COUNT], truncated[COUNT];
    const acrobot_batch_results_t results = {(float *)rewards, terminated, truncated, NULL, NULL};
    return acrobot_batch_step(batch, actions, &results, COUNT);
}

// What holds the value that a function uses.
enum {
    ALONE, ACTIONS, BATCH, PLANNER, SWING_UP, ESTIMATOR, PARAMETERS, REGRESSION, CONTROLLER,
    REPLANNER, HOLDERS
};
static const size_t SIZES[] = {
    ACROBOT_SIZE, ACROBOT_ACTION_SPACE_SIZE, ACROBOT_BATCH_OWN_SIZE(COUNT), ACROBOT_PLANNER_SIZE,
    ACROBOT_SWING_UP_SIZE, ACROBOT_ESTIMATOR_SIZE, ACROBOT_PARAMETER_ESTIMATOR_SIZE,
    ACROBOT_REGRESSION_SIZE, ACROBOT_CONTROLLER_SIZE, ACROBOT_REPLANNER_SIZE,
};
enum { NEEDED, OPTIONAL, NONE };
enum { OK = ACROBOT_OK, RANGE = ACROBOT_ERROR_OUT_OF_RANGE };

// Every pointer through which a function writes a result or an error, whether it may be null, and
// the status. NONE: the function has no such pointer.
#define RESULT(holder, type, ...) CALL(holder, type, NEEDED, OK, __VA_ARGS__)
#define ERROR(holder, ...) CALL(holder, acrobot_error_t, OPTIONAL, RANGE, __VA_ARGS__)
#define RESET(...) CALL(ALONE, row_t, OPTIONAL, OK, __VA_ARGS__)
#define BEGIN(holder, ...) CALL(holder, void *, NONE, OK, (void)out, __VA_ARGS__)
#define CALLS \
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
    ERROR(ALONE, acrobot_set_state(acrobot, &FAR, out)) \
    RESULT(ALONE, acrobot_params_t, acrobot_params(acrobot, out)) \
    ERROR(ALONE, acrobot_set_params(acrobot, &NO_MASS, out)) \
    ERROR(ALONE, acrobot_draw_params(acrobot, &reversed, out)) \
    RESULT(ALONE, float, acrobot_energy(acrobot, out)) \
    RESULT(ALONE, float, acrobot_tip_height(acrobot, out)) \
    RESULT(ACTIONS, uint8_t, acrobot_action_space_sample(action_space, out)) \
    RESULT(ACTIONS, uint8_t, acrobot_action_space_sample_each(action_space, out, 1)) \
    BEGIN(BATCH, acrobot_batch_reset(batch)) \
    BEGIN(BATCH, acrobot_batch_reset_with(batch, &WIDE, NULL)) \
    ERROR(BATCH, acrobot_batch_reset_with(batch, &SWAPPED, out)) \
    BEGIN(BATCH, acrobot_batch_reset_masked(batch, MASK, COUNT, NULL, NULL)) \
    ERROR(BATCH, acrobot_batch_reset_masked(batch, MASK, COUNT, &SWAPPED, out)) \
    BEGIN(BATCH, acrobot_batch_reset_with_seeds(batch, SEEDS, COUNT)) \
    RESULT(BATCH, rewards_t, step_batch(batch, out)) \
    RESULT(BATCH, rows_t, acrobot_batch_observe(batch, (row_t *)out, COUNT)) \
    RESULT(BATCH, acrobot_batch_settings_t, acrobot_batch_settings(batch, out)) \
    RESULT(BATCH, uint32_t, acrobot_batch_elapsed_steps(batch, 0, out)) \
    RESULT(BATCH, bool, acrobot_batch_is_done(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_draws(batch, &reversed, out)) \
    ERROR(BATCH, acrobot_batch_set_autoreset(batch, 3, out)) \
    ERROR(BATCH, acrobot_batch_set_max_steps(batch, 0, out)) \
    RESULT(BATCH, acrobot_state_t, acrobot_batch_state(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_state(batch, 0, &FAR, out)) \
    RESULT(BATCH, acrobot_params_t, acrobot_batch_params(batch, 0, out)) \
    ERROR(BATCH, acrobot_batch_set_all_params(batch, &NO_MASS, out)) \
    ERROR(BATCH, acrobot_batch_set_params(batch, 0, &NO_MASS, out)) \
    BEGIN(PLANNER, acrobot_planner_with_velocity_clamp(planner)) \
    RESULT(PLANNER, size_t, acrobot_planner_plan(planner, &UP, 1, 4, knots, COUNT, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_plan(planner, &FAR, 1, 4, knots, COUNT, &length, out)) \
    RESULT(PLANNER, float, acrobot_planner_improve(planner, &UP, 1, knots, better, 3, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_improve(planner, &FAR, 1, knots, better, 3, &torque, out)) \
    RESULT(PLANNER, acrobot_feedback_t, acrobot_planner_feedback(planner, out)) \
    RESULT(PLANNER, bool, acrobot_planner_holds_from(planner, &UP, out, NULL)) \
    ERROR(PLANNER, acrobot_planner_holds_from(planner, &FAR, &holds, out)) \
    RESULT(SWING_UP, float, acrobot_swing_up_torque(swing_up, &UP, out, NULL)) \
    ERROR(SWING_UP, acrobot_swing_up_torque(swing_up, &FAR, &torque, out)) \
    ERROR(ESTIMATOR, acrobot_estimator_correct(estimator, INF, 0, out)) \
    ERROR(ESTIMATOR, acrobot_estimator_predict(estimator, INF, out)) \
    RESULT(ESTIMATOR, acrobot_state_t, acrobot_estimator_state(estimator, out)) \
    RESULT(ESTIMATOR, acrobot_state_t, acrobot_estimator_state_std(estimator, out)) \
    ERROR(PARAMETERS, acrobot_parameter_estimator_correct(parameters, 0, INF, out)) \
    ERROR(PARAMETERS, acrobot_parameter_estimator_predict(parameters, INF, out)) \
    RESULT(PARAMETERS, acrobot_state_t, acrobot_parameter_estimator_state(parameters, out)) \
    RESULT(PARAMETERS, acrobot_state_t, acrobot_parameter_estimator_state_std(parameters, out)) \
    RESULT(PARAMETERS, acrobot_params_t, acrobot_parameter_estimator_params(parameters, out)) \
    ERROR(REGRESSION, acrobot_regression_add(regression, SAMPLES, COUNT, 0, 9.8, 1, 1, out)) \
    RESULT(REGRESSION, acrobot_fit_t, acrobot_regression_fit(regression, out)) \
    RESULT(CONTROLLER, float, acrobot_controller_tick(controller, 1, 2, out, NULL)) \
    RESULT(CONTROLLER, acrobot_state_t, acrobot_controller_state(controller, out)) \
    RESULT(CONTROLLER, acrobot_params_t, acrobot_controller_params(controller, out)) \
    BEGIN(REPLANNER, acrobot_replanner_exchange(replanner, &a_controller)) \
    BEGIN(REPLANNER, acrobot_replanner_work(replanner))

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

static acrobot_status_t call(int index, void *holder, void *pointer)
{
    acrobot_t *acrobot = (acrobot_t *)holder;
    acrobot_action_space_t *action_space = (acrobot_action_space_t *)holder;
    acrobot_batch_t *batch = (acrobot_batch_t *)holder;
    acrobot_planner_t *planner = (acrobot_planner_t *)holder;
    acrobot_swing_up_t *swing_up = (acrobot_swing_up_t *)holder;
    acrobot_estimator_t *estimator = (acrobot_estimator_t *)holder;
    acrobot_parameter_estimator_t *parameters = (acrobot_parameter_estimator_t *)holder;
    acrobot_regression_t *regression = (acrobot_regression_t *)holder;
    acrobot_controller_t *controller = (acrobot_controller_t *)holder;
    acrobot_replanner_t *replanner = (acrobot_replanner_t *)holder;
    acrobot_step_t step;
    float torque;
    size_t length;
    bool holds;
#define CALL(holder, type, optional, status, ...) \
    if (index-- == 0) { \
        type *out = (type *)pointer; \
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
        print("\n");
        failures++;
    }
}

#define MARGIN 192
#define SIZE ACROBOT_BATCH_OWN_SIZE(COUNT)
// The most that a holder has.
#define MOST ACROBOT_CONTROLLER_SIZE
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t arena[MARGIN + MOST + MARGIN];
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t other[MOST], spare[2 * MARGIN];
static uint8_t saved[MOST];
static uint8_t *const held = arena + MARGIN;

static void *hold(int holder)
{
    void *memory = held;
    acrobot_batch_t *batch;
    acrobot_problem_t problem;
    ACCEPTED(acrobot_problem_init(&problem, &PARAMS, 1, 0, NULL));
    switch (holder) {
    case ALONE: ACCEPTED(acrobot_init((acrobot_t *)memory, 42)); break;
    case ACTIONS:
        ACCEPTED(acrobot_action_space_init((acrobot_action_space_t *)memory, 42));
        break;
    case BATCH: ACCEPTED(acrobot_batch_init(memory, SIZE, COUNT, 0, true, 42, &batch)); break;
    case PLANNER:
        ACCEPTED(acrobot_planner_init((acrobot_planner_t *)memory, &problem, NULL));
        break;
    case SWING_UP:
        ACCEPTED(acrobot_swing_up_init((acrobot_swing_up_t *)memory, &PARAMS, 1, NULL));
        break;
    case ESTIMATOR:
        ACCEPTED(acrobot_estimator_init((acrobot_estimator_t *)memory, &PARAMS, &NOISE, NULL));
        break;
    case PARAMETERS:
        ACCEPTED(acrobot_parameter_estimator_init((acrobot_parameter_estimator_t *)memory, &PARAMS,
                                                  &DOUBT, &NOISE, NULL));
        break;
    case REGRESSION: ACCEPTED(acrobot_regression_init((acrobot_regression_t *)memory)); break;
    case CONTROLLER:
        ACCEPTED(acrobot_controller_init((acrobot_controller_t *)memory, &SETTINGS, NULL));
        break;
    default: ACCEPTED(acrobot_replanner_init((acrobot_replanner_t *)memory, &SETTINGS, NULL));
    }
    __builtin_memcpy(saved, held, MOST);
    return memory;
}

static void holders(void)
{
    for (int i = 0; i < ROWS; i++) {
        const int holder = TABLE[i].holder;
        expect(i, NULL, spare, ACROBOT_ERROR_NULL);
        expect(i, held + 1, spare, ACROBOT_ERROR_MISALIGNED);
        // `other` contains zeros.
        expect(i, other, spare, ACROBOT_ERROR_NOT_INITIALIZED);
        expect(i, hold((holder + 1) % HOLDERS), spare, ACROBOT_ERROR_NOT_INITIALIZED);
        expect(i, hold(holder), spare, TABLE[i].status);
    }
    __builtin_memcpy(other, hold(BATCH), sizeof other);
    for (int i = 0; i < ROWS; i++) {
        if (TABLE[i].holder == BATCH) {
            expect(i, other, spare, ACROBOT_ERROR_MOVED);
        }
    }
    CHECK(same(other, saved, sizeof other));
}

// Tries each address in the arena: one in the held bytes must be rejected, and none of them change.
static void pointers(void)
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
        for (size_t at = 0; at + row->size <= sizeof arena; at += align) {
            const bool is_apart = at + row->size <= MARGIN || at >= MARGIN + size;
            expect(i, held, arena + at, is_apart ? row->status : ACROBOT_ERROR_OVERLAP);
            CHECK((is_apart && row->status == ACROBOT_OK) || same(held, saved, size));
            __builtin_memcpy(held, saved, size);
        }
    }
}

#define params_rejects(message, set) \
    params = PARAMS; \
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

// Each of these calls is rejected and leaves all bytes of the acrobot as they were.
static void arguments_of_an_acrobot(void)
{
    acrobot_t *acrobot = (acrobot_t *)hold(ALONE);
    acrobot_step_t step;
    acrobot_state_t state;
    acrobot_params_t params = PARAMS;
    static acrobot_draws_t draws;
    acrobot_reset_options_t options = {NULL, 0, NULL};
    static const uint32_t SEED[] = {42};
    struct {
        double low, high;
    } bounds;
    // The calls that all languages reject, from tests/data/rejections.jsonl.
#include "rejections.h"
    REJECTED(NULL, acrobot_init(NULL, 42));
    REJECTED(MISALIGNED, acrobot_init((acrobot_t *)(void *)(held + ACROBOT_ALIGN / 2), 42));
    REJECTED(NULL, acrobot_action_space_init(NULL, 42));
    REJECTED(NULL, acrobot_action_space_init_with(NULL, SEED, 1));
    REJECTED(NULL, acrobot_action_space_init_with((acrobot_action_space_t *)spare, NULL, 1));
    REJECTED(OVERLAP, acrobot_action_space_init_with((acrobot_action_space_t *)held,
                                                     (const uint32_t *)held, 1));
    // The lowest byte of 256 is an action.
    REJECTED(UNKNOWN_ACTION, acrobot_step(acrobot, 256, &step));
    params_rejects("dynamics must be 0 (book) or 1 (NIPS), got 256", params.dynamics = 256);
    expect_message(acrobot_set_max_steps(acrobot, 0, &error),
                   "max_steps must be above 0 steps, got ");
    REJECTED(NULL, acrobot_set_state(acrobot, NULL, &error));
    REJECTED(NULL, acrobot_set_params(acrobot, NULL, &error));
    REJECTED(NULL, acrobot_draw_params(acrobot, NULL, &error));
    draws.gravity.kind = 4;
    expect_message(acrobot_draw_params(acrobot, &draws, &error), "kind must be from 0 to 3, got ");
    CHECK(error.value == 4);
    CHECK(same(acrobot, saved, ACROBOT_SIZE));
}

static void a_new_batch(void)
{
    acrobot_batch_t *batch;
    for (size_t count = 1; count < 100; count++) {
        CHECK(acrobot_batch_size(count, false) == ACROBOT_BATCH_SIZE(count));
        CHECK(acrobot_batch_size(count, true) == ACROBOT_BATCH_OWN_SIZE(count));
    }
    // Too many for the products to be ints.
    CHECK(acrobot_batch_size(30000000, false) == ACROBOT_BATCH_SIZE(30000000));
    CHECK(acrobot_batch_size(SIZE_MAX, true) == SIZE_MAX);
    hold(BATCH);
    REJECTED(OUT_OF_RANGE, acrobot_batch_init(held, SIZE, COUNT, 3, true, 42, &batch));
    REJECTED(NULL, acrobot_batch_init(NULL, SIZE, COUNT, 0, true, 42, &batch));
    REJECTED(NULL, acrobot_batch_init(held, SIZE, COUNT, 0, true, 42, NULL));
    REJECTED(MISALIGNED, acrobot_batch_init(held + 32, SIZE, 1, 0, true, 42, &batch));
    REJECTED(BUFFER_TOO_SMALL, acrobot_batch_init(held, SIZE - 1, COUNT, 0, true, 42, &batch));
    REJECTED(BUFFER_TOO_SMALL, acrobot_batch_init(held, SIZE, SIZE_MAX, 0, true, 42, &batch));
    REJECTED(WRONG_COUNT, acrobot_batch_init(held, SIZE, 0, 0, true, 42, &batch));
    for (size_t at = MARGIN; at < MARGIN + SIZE; at += sizeof batch) {
        acrobot_batch_t **out = (acrobot_batch_t **)(void *)(arena + at);
        REJECTED(OVERLAP, acrobot_batch_init(held, SIZE, COUNT, 0, true, 42, out));
    }
    CHECK(same(held, saved, SIZE));
}

// Each of these calls is rejected and leaves all bytes of the batch as they were.
static void arguments_of_a_batch(void)
{
    acrobot_batch_t *batch = (acrobot_batch_t *)hold(BATCH);
    acrobot_state_t state;
    row_t rows[COUNT];
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], mask[COUNT] = {true, true, true};
    uint8_t actions[COUNT] = {0, 1, 3}, odd = 2;
    const acrobot_batch_results_t all = {rewards, terminated, truncated, rows, NULL};
    acrobot_batch_results_t results = all;
    acrobot_params_t params = PARAMS;
    REJECTED(UNKNOWN_ACTION, acrobot_batch_step(batch, actions, &all, COUNT));
    actions[2] = 2;
    REJECTED(WRONG_COUNT, acrobot_batch_step(batch, actions, &all, COUNT - 1));
    REJECTED(NULL, acrobot_batch_step(batch, NULL, &all, COUNT));
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
    REJECTED(NULL, acrobot_batch_reset_masked(batch, NULL, COUNT, NULL, NULL));
    REJECTED(WRONG_COUNT, acrobot_batch_reset_masked(batch, mask, COUNT - 1, NULL, NULL));
    REJECTED(OVERLAP, acrobot_batch_reset_masked(batch, (const bool *)held, COUNT, NULL, NULL));
    __builtin_memcpy(&mask[2], &odd, 1);
    REJECTED(OUT_OF_RANGE, acrobot_batch_reset_masked(batch, mask, COUNT, NULL, NULL));
    REJECTED(NULL, acrobot_batch_reset_with_seeds(batch, NULL, COUNT));
    REJECTED(WRONG_COUNT, acrobot_batch_reset_with_seeds(batch, SEEDS, COUNT + 1));
    REJECTED(OVERLAP, acrobot_batch_reset_with_seeds(batch, (const uint64_t *)(void *)held, COUNT));
    REJECTED(OUT_OF_RANGE, acrobot_batch_set_autoreset(batch, 256, NULL));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_state(batch, COUNT, &state));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_set_state(batch, COUNT, &REST, NULL));
    REJECTED(NULL, acrobot_batch_set_state(batch, 0, NULL, NULL));
    REJECTED(NULL, acrobot_batch_set_all_params(batch, NULL, NULL));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_params(batch, COUNT, &params));
    REJECTED(NO_SUCH_INDEX, acrobot_batch_set_params(batch, COUNT, &params, NULL));
    CHECK(same(batch, saved, SIZE));
}

int main(void)
{
    reversed.length1.kind = ACROBOT_DRAW_UNIFORM;
    reversed.length1.low = 2;
    reversed.length1.high = 1;
    ACCEPTED(acrobot_controller_init(&a_controller, &SETTINGS, NULL));
    holders();
    pointers();
    arguments_of_an_acrobot();
    a_new_batch();
    arguments_of_a_batch();
    CHECK(same_text(acrobot_status_text(ACROBOT_OK), "no error"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP), "two arguments overlap"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_SHARED_PARAMS + 1), "unknown status"));
    return report("misuse");
}
