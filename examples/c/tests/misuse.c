// Misuse is reported, and a call that is rejected changes nothing.

#include "check.h"

#define COUNT 3

// Also compares the bytes between fields, which nothing writes; tests/valgrind.supp excuses that in this function alone.
__attribute__((noinline)) static bool same(const void *left, const void *right, size_t size)
{
    const uint8_t *a = (const uint8_t *)left, *b = (const uint8_t *)right;
    for (size_t i = 0; i < size; i++) {
        if (a[i] != b[i]) {
            return false;
        }
    }
    return true;
}

static bool same_text(const char *left, const char *right)
{
    while (*left != 0 && *left == *right) {
        left++;
        right++;
    }
    return *left == *right;
}

static void copy(void *to, const void *from, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        ((uint8_t *)to)[i] = ((const uint8_t *)from)[i];
    }
}

static float infinity(void)
{
    volatile float large = 3e38f;
    return large * large;
}

// Calls each function that takes an acrobot.
static void expect_of_acrobot(acrobot_t *acrobot, acrobot_status_t status)
{
    acrobot_observation_t observation;
    acrobot_step_t step;
    acrobot_state_t state = {0, 0, 0, 0};
    acrobot_params_t params = {1, 1, 1, 1, .5f, .5f, 1, 1, 9.8f, .2f, 1, 1, {-1, 0, 1}, 0, ACROBOT_DYNAMICS_BOOK};
    float number;
    uint32_t steps;
    CHECK(acrobot_reset(acrobot, &observation) == status);
    CHECK(acrobot_reset_with_seed(acrobot, 42, &observation) == status);
    CHECK(acrobot_reset_within(acrobot, -.2, .2, &observation, NULL) == status);
    CHECK(acrobot_step(acrobot, ACROBOT_ACTION_ZERO, &step) == status);
    CHECK(acrobot_step_torque(acrobot, .5f, &step, NULL) == status);
    CHECK(acrobot_observe(acrobot, &observation) == status);
    CHECK(acrobot_elapsed(acrobot, &steps) == status);
    CHECK(acrobot_state(acrobot, &state) == status);
    CHECK(acrobot_set_state(acrobot, &state, NULL) == status);
    CHECK(acrobot_set_params(acrobot, &params, NULL) == status);
    CHECK(acrobot_params(acrobot, &params) == status);
    CHECK(acrobot_energy(acrobot, &number) == status);
    CHECK(acrobot_tip_height(acrobot, &number) == status);
}

static void expect_of_batch(acrobot_batch_t *batch, acrobot_status_t status)
{
    uint8_t actions[COUNT] = {0, 1, 2};
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], mask[COUNT] = {true, false, true};
    const acrobot_batch_results_t results = {rewards, terminated, truncated, NULL, NULL};
    acrobot_observation_t observations[COUNT];
    acrobot_state_t state = {0, 0, 0, 0};
    acrobot_params_t params = {1, 1, 1, 1, .5f, .5f, 1, 1, 9.8f, .2f, 1, 1, {-1, 0, 1}, 0, ACROBOT_DYNAMICS_BOOK};
    size_t count;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == status);
    CHECK(acrobot_batch_observe(batch, observations, COUNT) == status);
    CHECK(acrobot_batch_count(batch, &count) == status);
    CHECK(acrobot_batch_reset(batch) == status);
    CHECK(acrobot_batch_reset_with_seed(batch, 42) == status);
    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT) == status);
    CHECK(acrobot_batch_set_autoreset(batch, ACROBOT_AUTORESET_DISABLED, NULL) == status);
    CHECK(acrobot_batch_state(batch, 0, &state) == status);
    CHECK(acrobot_batch_set_state(batch, 0, &state, NULL) == status);
    CHECK(acrobot_batch_set_params(batch, &params, NULL) == status);
    CHECK(acrobot_batch_params(batch, &params) == status);
}

// One address past an aligned one.
static void *misaligned(void *memory)
{
    return (uint8_t *)memory + 1;
}

static void memory_of_an_acrobot(void)
{
    static acrobot_t acrobot, twin;
    acrobot_step_t step, twin_step;
    acrobot_action_space_t action_space;
    uint8_t action;

    CHECK(sizeof acrobot == ACROBOT_SIZE && sizeof action_space == ACROBOT_ACTION_SPACE_SIZE);
    // A static contains zeros.
    expect_of_acrobot(&acrobot, ACROBOT_ERROR_NOT_INITIALIZED);
    expect_of_acrobot(NULL, ACROBOT_ERROR_NULL);
    expect_of_acrobot((acrobot_t *)misaligned(&acrobot), ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_init(NULL, 42) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_init((acrobot_t *)misaligned(&acrobot), 42) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_init((acrobot_t *)(void *)((uint8_t *)&acrobot + ACROBOT_ALIGN / 2), 42) == ACROBOT_ERROR_MISALIGNED);

    // A second initialization begins from scratch; there is nothing to free.
    CHECK(acrobot_init(&acrobot, 1) == ACROBOT_OK);
    CHECK(acrobot_init(&acrobot, 42) == ACROBOT_OK);
    expect_of_acrobot(&acrobot, ACROBOT_OK);

    // A copy steps as the original does.
    CHECK(acrobot_init(&acrobot, 42) == ACROBOT_OK);
    twin = acrobot;
    CHECK(acrobot_step(&acrobot, 0, &step) == ACROBOT_OK);
    CHECK(acrobot_step(&twin, 0, &twin_step) == ACROBOT_OK);
    CHECK(same(&step.observation, &twin_step.observation, sizeof step.observation));

    // The memory of another type.
    CHECK(acrobot_action_space_init(&action_space, 42) == ACROBOT_OK);
    copy(&acrobot, &action_space, sizeof action_space);
    expect_of_acrobot(&acrobot, ACROBOT_ERROR_NOT_INITIALIZED);
    copy(&action_space, &twin, sizeof action_space);
    CHECK(acrobot_action_space_sample(&action_space, &action) == ACROBOT_ERROR_NOT_INITIALIZED);
    CHECK(acrobot_action_space_sample(NULL, &action) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_action_space_init(NULL, 42) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_action_space_init(&action_space, 42) == ACROBOT_OK);
    CHECK(acrobot_action_space_sample(&action_space, NULL) == ACROBOT_ERROR_NULL);
}

static bool names(const acrobot_error_t *error, const char *name, double value, const char *unit, const char *rule)
{
    return same_text(error->name, name) && error->value == value && same_text(error->unit, unit) &&
           same_text(error->rule, rule);
}

// Each of these calls is rejected and leaves all bytes of the acrobot as they were.
static void arguments_of_an_acrobot(void)
{
    acrobot_t acrobot, before;
    acrobot_error_t error;
    acrobot_step_t step;
    acrobot_state_t state;
    acrobot_params_t params, changed;
    CHECK(acrobot_init(&acrobot, 42) == ACROBOT_OK);
    CHECK(acrobot_params(&acrobot, &params) == ACROBOT_OK);
    CHECK(acrobot_state(&acrobot, &state) == ACROBOT_OK);
    copy(&before, &acrobot, sizeof acrobot);

    for (int action = -1000; action <= 1000; action++) {
        if (action < 0 || action > 2) {
            CHECK(acrobot_step(&acrobot, action, &step) == ACROBOT_ERROR_UNKNOWN_ACTION);
        }
    }
    CHECK(acrobot_step(&acrobot, 0, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_step(&acrobot, 0, (acrobot_step_t *)misaligned(&step)) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_step_torque(&acrobot, 0, NULL, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_step_torque(&acrobot, infinity(), &step, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "torque", infinity(), "N m", "a finite number of"));
    CHECK(acrobot_reset_within(&acrobot, .2, -.1, NULL, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "low", .2, "rad and rad/s", "at most high in"));
    CHECK(acrobot_observe(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_elapsed(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_energy(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_tip_height(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_state(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_set_state(&acrobot, NULL, &error) == ACROBOT_ERROR_NULL);
    state.dtheta2 = infinity();
    CHECK(acrobot_set_state(&acrobot, &state, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "dtheta2", infinity(), "rad/s", "a finite number of"));
    CHECK(acrobot_params(&acrobot, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_set_params(&acrobot, NULL, &error) == ACROBOT_ERROR_NULL);
    changed = params;
    changed.dt = 0;
    CHECK(acrobot_set_params(&acrobot, &changed, NULL) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(acrobot_set_params(&acrobot, &changed, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "dt", 0, "s", "finite and above 0"));
    changed = params;
    changed.dynamics = 2;
    CHECK(acrobot_set_params(&acrobot, &changed, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "dynamics", 2, "", "0 (book) or 1 (NIPS)"));
    for (int i = 0; i < 2; i++) {
        changed.dynamics = i == 0 ? 256 : -255;
        CHECK(acrobot_set_params(&acrobot, &changed, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
        CHECK(names(&error, "dynamics", i == 0 ? 256 : -255, "", "0 (book) or 1 (NIPS)"));
    }
    CHECK(acrobot_set_params(&acrobot, &changed, (acrobot_error_t *)misaligned(&error)) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_set_params(&acrobot, &params, (acrobot_error_t *)misaligned(&error)) == ACROBOT_ERROR_MISALIGNED);
    changed = params;
    changed.inertia2 = changed.center_of_mass2 = 0;
    CHECK(acrobot_set_params(&acrobot, &changed, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "inertia2", 0, "kg m²", "(with the centre of mass on the joint) above 0"));

    CHECK(same(&acrobot, &before, sizeof acrobot));
    // What was rejected would have been noticed here.
    CHECK(acrobot_step(&acrobot, 0, &step) == ACROBOT_OK);
    CHECK(!same(&acrobot, &before, sizeof acrobot));
}

static void a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t other[ACROBOT_BATCH_SIZE(COUNT)];
    acrobot_batch_t *batch = (acrobot_batch_t *)(void *)memory;
    acrobot_batch_t *moved = (acrobot_batch_t *)(void *)other;
    const size_t size = sizeof memory;

    for (size_t count = 1; count < 100; count++) {
        CHECK(acrobot_batch_size(count) == ACROBOT_BATCH_SIZE(count));
    }
    // Too many for the products to be ints.
    CHECK(acrobot_batch_size(30000000) == ACROBOT_BATCH_SIZE(30000000));
    CHECK(sizeof ACROBOT_BATCH_SIZE(COUNT) == sizeof size);
    CHECK(acrobot_batch_size(SIZE_MAX) == SIZE_MAX);
    expect_of_batch(batch, ACROBOT_ERROR_NOT_INITIALIZED);
    expect_of_batch(NULL, ACROBOT_ERROR_NULL);
    expect_of_batch((acrobot_batch_t *)misaligned(memory), ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_batch_init(NULL, size, COUNT, 42, &batch) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_init(memory, size, COUNT, 42, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_init(memory + 32, size, 1, 42, &batch) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_batch_init(memory, size - 1, COUNT, 42, &batch) == ACROBOT_ERROR_BUFFER_TOO_SMALL);
    CHECK(acrobot_batch_init(memory, size, SIZE_MAX, 42, &batch) == ACROBOT_ERROR_BUFFER_TOO_SMALL);
    CHECK(acrobot_batch_init(memory, size, 0, 42, &batch) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(same(memory, other, size));
    CHECK(acrobot_batch_init(memory, size, COUNT, 42, &batch) == ACROBOT_OK);
    expect_of_batch(batch, ACROBOT_OK);
    copy(other, memory, size);
    expect_of_batch(moved, ACROBOT_ERROR_MOVED);
    CHECK(same(other, memory, size));
}

// Each of these calls is rejected and leaves all bytes of the batch as they were.
static void arguments_of_a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
    static uint8_t before[ACROBOT_BATCH_SIZE(COUNT)];
    acrobot_batch_t *batch;
    acrobot_error_t error;
    acrobot_state_t state;
    acrobot_params_t params;
    acrobot_observation_t observations[COUNT];
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], mask[COUNT] = {true, true, true};
    uint8_t actions[COUNT] = {0, 1, 3}, odd = 2;
    const acrobot_batch_results_t all = {rewards, terminated, truncated, observations, NULL};
    acrobot_batch_results_t results = all;
    CHECK(acrobot_batch_init(memory, sizeof memory, COUNT, 42, &batch) == ACROBOT_OK);
    CHECK(acrobot_batch_state(batch, 0, &state) == ACROBOT_OK);
    CHECK(acrobot_batch_params(batch, &params) == ACROBOT_OK);
    copy(before, memory, sizeof memory);

    CHECK(acrobot_batch_step(batch, actions, &all, COUNT) == ACROBOT_ERROR_UNKNOWN_ACTION);
    actions[2] = 2;
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT - 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT + 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_step(batch, NULL, &all, COUNT) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_step(batch, actions, NULL, COUNT) == ACROBOT_ERROR_NULL);
    results.rewards = NULL;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_NULL);
    results.rewards = (float *)misaligned(rewards);
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_MISALIGNED);
    results.rewards = (float *)(void *)(memory + sizeof memory - 8);
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.terminated = truncated;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.final_observations = observations;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.truncated = (bool *)actions;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    results = all;
    results.terminated = (bool *)(void *)&results;
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_ERROR_OVERLAP);
    CHECK(results.rewards == rewards);
    CHECK(acrobot_batch_observe(batch, NULL, COUNT) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_observe(batch, observations, COUNT + 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_observe(batch, (acrobot_observation_t *)(void *)memory, COUNT) == ACROBOT_ERROR_OVERLAP);
    CHECK(acrobot_batch_count(batch, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_reset_masked(batch, NULL, COUNT) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT - 1) == ACROBOT_ERROR_WRONG_COUNT);
    CHECK(acrobot_batch_reset_masked(batch, (const bool *)memory, COUNT) == ACROBOT_ERROR_OVERLAP);
    copy(&mask[2], &odd, 1);
    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(acrobot_batch_set_autoreset(batch, 3, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "autoreset", 3, "", "0, 1 or 2"));
    CHECK(acrobot_batch_set_autoreset(batch, 256, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "autoreset", 256, "", "0, 1 or 2"));
    CHECK(acrobot_batch_set_autoreset(batch, 0, (acrobot_error_t *)misaligned(&error)) == ACROBOT_ERROR_MISALIGNED);
    CHECK(acrobot_batch_state(batch, COUNT, &state) == ACROBOT_ERROR_NO_SUCH_INDEX);
    CHECK(acrobot_batch_state(batch, SIZE_MAX, &state) == ACROBOT_ERROR_NO_SUCH_INDEX);
    CHECK(acrobot_batch_state(batch, 0, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_set_state(batch, COUNT, &state, NULL) == ACROBOT_ERROR_NO_SUCH_INDEX);
    CHECK(acrobot_batch_set_state(batch, 0, NULL, NULL) == ACROBOT_ERROR_NULL);
    state.theta1 = infinity();
    CHECK(acrobot_batch_set_state(batch, 0, &state, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "theta1", infinity(), "rad", "a finite number of"));
    CHECK(acrobot_batch_params(batch, NULL) == ACROBOT_ERROR_NULL);
    CHECK(acrobot_batch_set_params(batch, NULL, NULL) == ACROBOT_ERROR_NULL);
    params.mass1 = -1;
    CHECK(acrobot_batch_set_params(batch, &params, &error) == ACROBOT_ERROR_OUT_OF_RANGE);
    CHECK(names(&error, "mass1", -1, "kg", "finite and above 0"));

    CHECK(same(memory, before, sizeof memory));
    CHECK(acrobot_batch_step(batch, actions, &all, COUNT) == ACROBOT_OK);
    CHECK(!same(memory, before, sizeof memory));
}

#define MARGIN 192
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t arena[MARGIN + ACROBOT_BATCH_SIZE(COUNT) + MARGIN];
static uint8_t saved[ACROBOT_BATCH_SIZE(COUNT)];
static void *const held = arena + MARGIN;

// Makes a call with `out` at each address in the arena. If it overlaps the `size` bytes that are held, the call must be
// rejected and change none of them.
#define AT_EACH_ADDRESS(type, align, size, call, otherwise) \
    do { \
        copy(saved, held, size); \
        for (size_t at = 0; at + sizeof(type) <= sizeof arena; at += (align)) { \
            type *out = (type *)(void *)(arena + at); \
            if (at + sizeof(type) <= MARGIN || at >= MARGIN + (size)) { \
                CHECK((call) == (otherwise)); \
                copy(held, saved, size); \
            } else { \
                CHECK((call) == ACROBOT_ERROR_OVERLAP); \
                CHECK(same(held, saved, size)); \
            } \
        } \
    } while (0)

static void overlaps_of_an_acrobot(void)
{
    acrobot_t *acrobot = (acrobot_t *)held;
    acrobot_action_space_t *action_space = (acrobot_action_space_t *)held;
    const acrobot_state_t rest = {0, 0, 0, 0}, infinite = {infinity(), 0, 0, 0};
    acrobot_params_t params;
    acrobot_step_t step;
    CHECK(acrobot_init(acrobot, 42) == ACROBOT_OK);
    CHECK(acrobot_params(acrobot, &params) == ACROBOT_OK);
#define AT_EACH(type, align, call, otherwise) AT_EACH_ADDRESS(type, align, ACROBOT_SIZE, call, otherwise)
    AT_EACH(acrobot_observation_t, 4, acrobot_reset(acrobot, out), ACROBOT_OK);
    AT_EACH(acrobot_observation_t, 4, acrobot_reset_with_seed(acrobot, 7, out), ACROBOT_OK);
    AT_EACH(acrobot_observation_t, 4, acrobot_reset_within(acrobot, -1, 1, out, NULL), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_reset_within(acrobot, -1, 1, NULL, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_reset_within(acrobot, 1, -1, NULL, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(acrobot_step_t, 4, acrobot_step(acrobot, 2, out), ACROBOT_OK);
    AT_EACH(acrobot_step_t, 4, acrobot_step_torque(acrobot, 1, out, NULL), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_step_torque(acrobot, infinity(), &step, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(acrobot_observation_t, 4, acrobot_observe(acrobot, out), ACROBOT_OK);
    AT_EACH(uint32_t, 4, acrobot_elapsed(acrobot, out), ACROBOT_OK);
    AT_EACH(acrobot_state_t, 4, acrobot_state(acrobot, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_set_state(acrobot, &rest, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_set_state(acrobot, &infinite, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(acrobot_params_t, 4, acrobot_params(acrobot, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_set_params(acrobot, &params, out), ACROBOT_OK);
    params.dt = 0;
    AT_EACH(acrobot_error_t, 8, acrobot_set_params(acrobot, &params, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(float, 4, acrobot_energy(acrobot, out), ACROBOT_OK);
    AT_EACH(float, 4, acrobot_tip_height(acrobot, out), ACROBOT_OK);
    CHECK(acrobot_action_space_init(action_space, 42) == ACROBOT_OK);
    AT_EACH_ADDRESS(uint8_t, 1, ACROBOT_ACTION_SPACE_SIZE, acrobot_action_space_sample(action_space, out), ACROBOT_OK);
#undef AT_EACH
}

static void overlaps_of_a_batch(void)
{
    const size_t size = ACROBOT_BATCH_SIZE(COUNT);
    const acrobot_state_t infinite = {infinity(), 0, 0, 0};
    acrobot_params_t params;
    acrobot_batch_t *batch;
    typedef acrobot_observation_t observations_t[COUNT];
#define AT_EACH(type, align, call, otherwise) AT_EACH_ADDRESS(type, align, ACROBOT_BATCH_SIZE(COUNT), call, otherwise)
    AT_EACH(acrobot_batch_t *, 8, acrobot_batch_init(held, size, COUNT, 42, out), ACROBOT_OK);
    CHECK(acrobot_batch_init(held, size, COUNT, 42, &batch) == ACROBOT_OK);
    CHECK(acrobot_batch_params(batch, &params) == ACROBOT_OK);
    params.dt = 0;
    AT_EACH(observations_t, 4, acrobot_batch_observe(batch, *out, COUNT), ACROBOT_OK);
    AT_EACH(size_t, 8, acrobot_batch_count(batch, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_batch_set_autoreset(batch, 1, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_batch_set_autoreset(batch, 3, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(acrobot_state_t, 4, acrobot_batch_state(batch, 0, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_batch_set_state(batch, 0, &infinite, out), ACROBOT_ERROR_OUT_OF_RANGE);
    AT_EACH(acrobot_params_t, 4, acrobot_batch_params(batch, out), ACROBOT_OK);
    AT_EACH(acrobot_error_t, 8, acrobot_batch_set_params(batch, &params, out), ACROBOT_ERROR_OUT_OF_RANGE);
#undef AT_EACH
}

static void texts(void)
{
    CHECK(same_text(acrobot_status_text(ACROBOT_OK), "no error"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP), "two arguments overlap"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP + 1), "unknown status"));
    CHECK(same_text(acrobot_status_text(256), "unknown status"));
    CHECK(same_text(acrobot_status_text(-1), "unknown status"));
}

int main(void)
{
    memory_of_an_acrobot();
    arguments_of_an_acrobot();
    a_batch();
    arguments_of_a_batch();
    overlaps_of_an_acrobot();
    overlaps_of_a_batch();
    texts();
    return report("misuse");
}
