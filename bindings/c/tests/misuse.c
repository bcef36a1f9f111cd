// Misuse is reported, and a call that is rejected changes nothing.

#include "check.h"

#define COUNT 3
#define INFINITE __builtin_inff()

static const acrobot_state_t REST = {0, 0, 0, 0}, FAR = {INFINITE, 0, 0, 0};
static const acrobot_params_t PARAMS = {
    1, 1, 1, 1, .5f, .5f, 1, 1, 9.8f, .2f, 1, 1, {-1, 0, 1}, 0, ACROBOT_DYNAMICS_BOOK,
};
static const acrobot_params_t NO_MASS = {
    1, 1, 0, 1, .5f, .5f, 1, 1, 9.8f, .2f, 1, 1, {-1, 0, 1}, 0, ACROBOT_DYNAMICS_BOOK,
};
static const acrobot_state_t WEIGHTS = {1, 1, 1, 1}, NEGATIVE = {1, -2, 1, 1}, ZERO = {0, 0, 0, 0};
static const acrobot_state_t UPRIGHT = {3.1415927f, 0, 0, 0}, NO_EQUILIBRIA[] = {
    {3.1f, 0, 0, 0}, {1.5f, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, .001f, 0}, {3.1415927f, 0, 0, -1},
};
static const bool MASK[COUNT] = {true, false, true};

typedef acrobot_observation_t observations_t[COUNT];
typedef float rewards_t[COUNT];

static acrobot_status_t step_batch(acrobot_batch_t *batch, void *rewards)
{
    const uint8_t actions[COUNT] = {0, 1, 2};
    bool terminated[COUNT], truncated[COUNT];
    const acrobot_batch_results_t results = {(float *)rewards, terminated, truncated, NULL, NULL};
    return acrobot_batch_step(batch, actions, &results, COUNT);
}

// What holds the value that a function uses.
enum { ALONE, ACTIONS, BATCH };
static const size_t SIZES[] = {ACROBOT_SIZE, ACROBOT_ACTION_SPACE_SIZE, ACROBOT_BATCH_SIZE(COUNT)};
enum { NEEDED, OPTIONAL, NONE };
enum { OK = ACROBOT_OK, OUT_OF_RANGE = ACROBOT_ERROR_OUT_OF_RANGE };

// Every pointer through which a function writes a result or an error, whether it may be null, and
// the status. NONE: the function has no such pointer.
#define CALLS(CALL) \
    CALL(ALONE, acrobot_observation_t, OPTIONAL, OK, acrobot_reset(acrobot, out)) \
    CALL(ALONE, acrobot_observation_t, OPTIONAL, OK, acrobot_reset_with_seed(acrobot, 7, out)) \
    CALL(ALONE, acrobot_observation_t, OPTIONAL, OK, acrobot_reset_within(acrobot, -1, 1, out, NULL)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OK, acrobot_reset_within(acrobot, -1, 1, NULL, out)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_reset_within(acrobot, 1, -1, NULL, out)) \
    CALL(ALONE, acrobot_step_t, NEEDED, OK, acrobot_step(acrobot, 2, out)) \
    CALL(ALONE, acrobot_step_t, NEEDED, OK, acrobot_step_torque(acrobot, 1, out, NULL)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_step_torque(acrobot, INFINITE, &step, out)) \
    CALL(ALONE, acrobot_observation_t, NEEDED, OK, acrobot_observe(acrobot, out)) \
    CALL(ALONE, uint32_t, NEEDED, OK, acrobot_elapsed(acrobot, out)) \
    CALL(ALONE, acrobot_state_t, NEEDED, OK, acrobot_state(acrobot, out)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_set_state(acrobot, &FAR, out)) \
    CALL(ALONE, acrobot_params_t, NEEDED, OK, acrobot_params(acrobot, out)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_set_params(acrobot, &NO_MASS, out)) \
    CALL(ALONE, float, NEEDED, OK, acrobot_energy(acrobot, out)) \
    CALL(ALONE, float, NEEDED, OK, acrobot_tip_height(acrobot, out)) \
    CALL(ALONE, acrobot_state_t, NEEDED, OK, acrobot_deviation(acrobot, &REST, out)) \
    CALL(ALONE, acrobot_state_t, NEEDED, OK, acrobot_lqr(acrobot, &REST, &WEIGHTS, 1, out, NULL)) \
    CALL(ALONE, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_lqr(acrobot, &FAR, &WEIGHTS, 1, &gain, out)) \
    CALL(ACTIONS, uint8_t, NEEDED, OK, acrobot_action_space_sample(action_space, out)) \
    CALL(BATCH, void *, NONE, OK, (void)out, acrobot_batch_reset(batch)) \
    CALL(BATCH, void *, NONE, OK, (void)out, acrobot_batch_reset_with_seed(batch, 42)) \
    CALL(BATCH, void *, NONE, OK, (void)out, acrobot_batch_reset_masked(batch, MASK, COUNT)) \
    CALL(BATCH, rewards_t, NEEDED, OK, step_batch(batch, out)) \
    CALL(BATCH, observations_t, NEEDED, OK, acrobot_batch_observe(batch, (acrobot_observation_t *)out, COUNT)) \
    CALL(BATCH, size_t, NEEDED, OK, acrobot_batch_count(batch, out)) \
    CALL(BATCH, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_batch_set_autoreset(batch, 3, out)) \
    CALL(BATCH, acrobot_state_t, NEEDED, OK, acrobot_batch_state(batch, 0, out)) \
    CALL(BATCH, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_batch_set_state(batch, 0, &FAR, out)) \
    CALL(BATCH, acrobot_params_t, NEEDED, OK, acrobot_batch_params(batch, out)) \
    CALL(BATCH, acrobot_error_t, OPTIONAL, OUT_OF_RANGE, acrobot_batch_set_params(batch, &NO_MASS, out))

struct call {
    int holder, optional, status;
    size_t size;
    const char *text;
};

static const struct call TABLE[] = {
#define CALL(holder, type, optional, status, ...) {holder, optional, status, sizeof(type), #__VA_ARGS__},
    CALLS(CALL)
#undef CALL
};
enum { ROWS = sizeof TABLE / sizeof TABLE[0] };

static acrobot_status_t call(int index, void *holder, void *pointer)
{
    acrobot_t *acrobot = (acrobot_t *)holder;
    acrobot_action_space_t *action_space = (acrobot_action_space_t *)holder;
    acrobot_batch_t *batch = (acrobot_batch_t *)holder;
    acrobot_step_t step;
    acrobot_state_t gain;
#define CALL(holder, type, optional, status, ...) \
    if (index-- == 0) { \
        type *out = (type *)pointer; \
        return __VA_ARGS__; \
    }
    CALLS(CALL)
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
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t arena[MARGIN + ACROBOT_BATCH_SIZE(COUNT) + MARGIN];
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t other[ACROBOT_BATCH_SIZE(COUNT)], spare[MARGIN];
static uint8_t saved[ACROBOT_BATCH_SIZE(COUNT)];
static uint8_t *const held = arena + MARGIN;

static void *hold(int holder)
{
    void *memory = held;
    acrobot_batch_t *batch;
    CHECK(holder != ALONE || acrobot_init((acrobot_t *)memory, 42) == ACROBOT_OK);
    CHECK(holder != ACTIONS || acrobot_action_space_init((acrobot_action_space_t *)memory, 42) == ACROBOT_OK);
    CHECK(holder != BATCH || acrobot_batch_init(memory, sizeof saved, COUNT, 42, &batch) == ACROBOT_OK);
    __builtin_memcpy(saved, held, sizeof saved);
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
        expect(i, hold((holder + 1) % 3), spare, ACROBOT_ERROR_NOT_INITIALIZED);
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

// Tries each address in the arena. A pointer into the held bytes must be rejected, and none of them
// change.
static void pointers(void)
{
    for (int i = 0; i < ROWS; i++) {
        const struct call *row = &TABLE[i];
        const size_t size = SIZES[row->holder], align = row->size < 8 ? row->size : 8;
        if (row->optional == NONE) {
            continue;
        }
        expect(i, hold(row->holder), NULL, row->optional == OPTIONAL ? row->status : ACROBOT_ERROR_NULL);
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

static bool names(const acrobot_error_t *error, const char *name, double value, const char *unit, const char *rule)
{
    return same_text(error->name, name) && error->value == value && same_text(error->unit, unit) &&
           same_text(error->rule, rule);
}

// Each of these calls is rejected and leaves all bytes of the acrobot as they were.
static void arguments_of_an_acrobot(void)
{
    acrobot_t *acrobot = (acrobot_t *)hold(ALONE), twin = *acrobot, floating = *acrobot, heavy = *acrobot;
    acrobot_action_space_t action_space;
    acrobot_error_t error;
    acrobot_step_t step, twin_step;
    acrobot_state_t x;
    acrobot_params_t params = PARAMS;
    CHECK(sizeof twin == ACROBOT_SIZE && sizeof action_space == ACROBOT_ACTION_SPACE_SIZE);
    CHECK(acrobot_init(NULL, 42) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_init((acrobot_t *)(void *)(held + ACROBOT_ALIGN / 2), 42) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_action_space_init(NULL, 42) == ACROBOT_ERROR_NULL);

    for (int action = -1000; action <= 1000; action++) {
        CHECK((action >= 0 && action <= 2) || acrobot_step(acrobot, action, &step) == ACROBOT_ERROR_UNKNOWN_ACTION);
    }
    CHECK(acrobot_reset_within(acrobot, .2, -.1, NULL, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "low", .2, "rad and rad/s", "at most high in rad and rad/s"));
    CHECK(acrobot_set_state(acrobot, NULL, &error) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_set_state(acrobot, &FAR, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "theta1", INFINITE, "rad", "a finite number of rad"));
    CHECK(acrobot_set_params(acrobot, NULL, &error) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_set_params(acrobot, &NO_MASS, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "mass1", 0, "kg", "finite and above 0 kg"));
    for (params.dynamics = -255; params.dynamics <= 256; params.dynamics++) {
        if (params.dynamics != ACROBOT_DYNAMICS_BOOK && params.dynamics != ACROBOT_DYNAMICS_NIPS) {
            CHECK(acrobot_set_params(acrobot, &params, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
            CHECK(names(&error, "dynamics", params.dynamics, "", "0 (book) or 1 (NIPS)"));
        }
    }
    params = PARAMS;
    params.inertia2 = params.center_of_mass2 = 0;
    CHECK(acrobot_set_params(acrobot, &params, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "inertia2", 0, "kg m²", "(with the centre of mass on the joint) above 0 kg m²"));
    CHECK(acrobot_deviation(acrobot, NULL, &x) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_deviation(acrobot, &FAR, &x) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(acrobot_lqr(acrobot, NULL, &WEIGHTS, 1, &x, &error) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_lqr(acrobot, &REST, NULL, 1, &x, &error) == ACROBOT_ERROR_NULL);
    for (int i = 0; i < 5; i++) {
        CHECK(acrobot_lqr(acrobot, &NO_EQUILIBRIA[i], &WEIGHTS, 1, &x, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
        CHECK(same_text(error.name, "target") && same_text(error.rule, "in equilibrium without a torque"));
    }
    params = PARAMS;
    params.mass1 = 1000;
    CHECK(acrobot_set_params(&heavy, &params, NULL) == ACROBOT_OK);
    CHECK(acrobot_lqr(&heavy, &UPRIGHT, &WEIGHTS, 1, &x, NULL) == ACROBOT_OK);
    CHECK(acrobot_lqr(acrobot, &REST, &NEGATIVE, 1, &x, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "q.theta2", -2, "", "finite and at least 0"));
    // Without gravity and weights nothing brings the acrobot back.
    params = PARAMS;
    params.gravity = 0;
    CHECK(acrobot_set_params(&floating, &params, NULL) == ACROBOT_OK);
    CHECK(acrobot_lqr(&floating, &REST, &ZERO, 1, &x, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(same_text(error.name, "gain") && same_text(error.rule, "finite; target, dt, gravity and weights allow no regulator"));
    CHECK(acrobot_lqr(acrobot, &REST, &WEIGHTS, 0, &x, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "r", 0, "per (N m)²", "finite and above 0 per (N m)²"));
    CHECK(same(acrobot, saved, ACROBOT_SIZE));

    // A copy steps as the original does. What was rejected would have been noticed.
    CHECK(acrobot_step(acrobot, 0, &step) == ACROBOT_OK && acrobot_step(&twin, 0, &twin_step) == ACROBOT_OK);
    CHECK(same(&step.observation, &twin_step.observation, sizeof step.observation));
    CHECK(!same(acrobot, saved, ACROBOT_SIZE));
}

static void a_new_batch(void)
{
    acrobot_batch_t *batch;
    const size_t size = sizeof saved;
    for (size_t count = 1; count < 100; count++) {
        CHECK(acrobot_batch_size(count) == ACROBOT_BATCH_SIZE(count));
    }
    // Too many for the products to be ints.
    CHECK(acrobot_batch_size(30000000) == ACROBOT_BATCH_SIZE(30000000));
    CHECK(acrobot_batch_size(SIZE_MAX) == SIZE_MAX);
    hold(BATCH);
    CHECK(acrobot_batch_init(NULL, size, COUNT, 42, &batch) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_init(held, size, COUNT, 42, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_init(held + 32, size, 1, 42, &batch) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_batch_init(held, size - 1, COUNT, 42, &batch) == ACROBOT_ERROR_BUFFER_TOO_SMALL);
    CHECK(acrobot_batch_init(held, size, SIZE_MAX, 42, &batch) == ACROBOT_ERROR_BUFFER_TOO_SMALL);
    CHECK(acrobot_batch_init(held, size, 0, 42, &batch) == ACROBOT_ERROR_WRONG_COUNT);
    for (size_t at = MARGIN; at < MARGIN + size; at += sizeof batch) {
        acrobot_batch_t **out = (acrobot_batch_t **)(void *)(arena + at);
        CHECK(acrobot_batch_init(held, size, COUNT, 42, out) == ACROBOT_ERROR_OVERLAP);
    }
    CHECK(same(held, saved, size));
}

// Each of these calls is rejected and leaves all bytes of the batch as they were.
static void arguments_of_a_batch(void)
{
    acrobot_batch_t *batch = (acrobot_batch_t *)hold(BATCH);
    acrobot_state_t state;
    acrobot_observation_t observations[COUNT];
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], mask[COUNT] = {true, true, true};
    uint8_t actions[COUNT] = {0, 1, 3}, odd = 2;
    const acrobot_batch_results_t all = {rewards, terminated, truncated, observations, NULL};
    acrobot_batch_results_t results = all;
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT) == ACROBOT_ERROR_UNKNOWN_ACTION);
    actions[2] = 2;
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT - 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT + 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_step(batch, NULL, &all, COUNT) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_step(batch, actions, NULL, COUNT) == ACROBOT_ERROR_NULL);
    results.final_observations = observations;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.truncated = (bool *)actions;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.terminated = (bool *)(void *)&results;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    CHECK(results.rewards == rewards);
    CHECK(acrobot_batch_observe(batch, observations, COUNT + 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_reset_masked(batch, NULL, COUNT) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT - 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_reset_masked(batch, (const bool *)held, COUNT) == ACROBOT_ERROR_OVERLAP);
    __builtin_memcpy(&mask[2], &odd, 1);
    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(acrobot_batch_set_autoreset(batch, 256, NULL) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(acrobot_batch_state(batch, COUNT, &state) == ACROBOT_ERROR_NO_SUCH_INDEX);
    CHECK(acrobot_batch_set_state(batch, COUNT, &REST, NULL) == ACROBOT_ERROR_NO_SUCH_INDEX);
    CHECK(acrobot_batch_set_state(batch, 0, NULL, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_set_params(batch, NULL, NULL) == ACROBOT_ERROR_NULL);
    CHECK(same(batch, saved, sizeof saved));
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT) == ACROBOT_OK);
    CHECK(!same(batch, saved, sizeof saved));
}

int main(void)
{
    holders();
    pointers();
    arguments_of_an_acrobot();
    a_new_batch();
    arguments_of_a_batch();
    CHECK(same_text(acrobot_status_text(ACROBOT_OK), "no error"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP), "two arguments overlap"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP + 1), "unknown status"));
    return report("misuse");
}
