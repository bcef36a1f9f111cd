// Misuse is reported, and a call that is rejected changes nothing. misuse.awk finds the functions
// and their arguments in the header. These are zeros, except those that `main` sets.

#include "check.h"

#define COUNT 3
#define SIZE ACROBOT_BATCH_OWN_SIZE(COUNT)
#define SLOTS 9

typedef ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) uint8_t memory_t[SIZE];

// The most that an argument has, except the memory of a batch.
#ifdef ACROBOT_HAS_SNAPSHOTS
#define WIDTH SIZE
static size_t saved;
#else
#define WIDTH 512
#endif

// MADE, HOLDER: what an `_init` makes, and then is used. STRUCT: of the pointers that follow.
enum role { NONE, MADE, HOLDER, STRUCT, INPUT, NUMBER, OUTPUT };
struct argument {
    const char *name;
    enum role role;
    size_t size, align;
    bool is_apart, is_optional;
    void *good;
};
struct function {
    const char *name;
    acrobot_status_t (*call)(void **pointers);
    int init; // in TABLE, or below 0
    struct argument arguments[SLOTS];
};
#define MARGIN 192
#define MOST (SIZE > sizeof(acrobot_controller_t) ? SIZE : sizeof(acrobot_controller_t))
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t arena[MARGIN + MOST + MARGIN];
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t other[MOST], ones[WIDTH];
// The alignment of the largest is enough.
ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t outputs[SLOTS][(WIDTH + 63) / 64 * 64];
static uint8_t before[MOST];
static const uint8_t ZEROS[MOST] = {0};
static uint8_t *const held = arena + MARGIN;
static size_t size_of_held;
// The arguments of a call.
static void *pointers[SLOTS];
static const struct function *tested;

#define ARGUMENT(role, name, type, count, is_apart, is_optional, good) \
    {#name, role, sizeof(type) * (count), __alignof__(type), is_apart, is_optional, good}
#include "misuse.h"
enum { FUNCTIONS = sizeof TABLE / sizeof TABLE[0] };

// Good arguments.
static void prepare(int function)
{
    tested = &TABLE[function];
    __builtin_memset(outputs, 0, sizeof outputs);
    for (int i = 0; i < SLOTS; i++) {
        pointers[i] = tested->arguments[i].good;
    }
}

// Initializes what a function uses.
static void hold(int init)
{
    size_of_held = 0;
    if (init >= 0) {
        prepare(init);
        size_of_held = tested->arguments[0].size;
        CHECK(tested->call(pointers) == ACROBOT_OK);
    }
    __builtin_memcpy(before, held, MOST);
}

// The status with another argument.
static void expect(int slot, void *pointer, int status)
{
    void *const good = pointers[slot];
    pointers[slot] = pointer;
    const int found = tested->call(pointers);
    pointers[slot] = good;
    if (found != status) {
        const char *parts[] = {
            tested->name, " with another ", tested->arguments[slot].name, " must return ",
            acrobot_status_text(status), ", not ", acrobot_status_text(found), "\n"};
        for (int i = 0; i < 8; i++) {
            print(parts[i]);
        }
        failures++;
    }
    CHECK(found == ACROBOT_OK || same(held, before, size_of_held));
    __builtin_memcpy(held, before, size_of_held);
}

static const struct {
    const char *function, *argument;
    int status;
} STATUSES[] = {
    // Ones: the recording is too short to be read, and the step is one of the plan.
    {"acrobot_prediction_error", "samples", ACROBOT_OK},
    {"acrobot_plan_torque", "after", ACROBOT_OK},
    {"", "action", ACROBOT_ERROR_UNKNOWN_ACTION},
    {"", "bytes", ACROBOT_ERROR_DAMAGED_SNAPSHOT},
    {"acrobot_batch_init", "count", ACROBOT_ERROR_BUFFER_TOO_SMALL},
    {"", "count", ACROBOT_ERROR_WRONG_COUNT},
    {"", "index", ACROBOT_ERROR_NO_SUCH_INDEX},
    {"", "controller", ACROBOT_ERROR_NOT_INITIALIZED},
    {"", "seed", ACROBOT_OK},
    // Good arguments: a recording at rest determines nothing, and the bytes are those of a batch.
    {"acrobot_fit_params", "", ACROBOT_ERROR_OUT_OF_RANGE},
    {"acrobot_identify", "", ACROBOT_ERROR_OUT_OF_RANGE},
    {"acrobot_calibrate", "", ACROBOT_ERROR_OUT_OF_RANGE},
    {"acrobot_load", "", ACROBOT_ERROR_OTHER_SNAPSHOT},
};

// The status if this argument is ones, or "" for good arguments.
static int status_of(const char *argument, int otherwise)
{
    for (size_t i = 0; i < sizeof STATUSES / sizeof STATUSES[0]; i++) {
        if (after(tested->name, STATUSES[i].function) != NULL &&
            after(argument, STATUSES[i].argument) != NULL) {
            return STATUSES[i].status;
        }
    }
    return otherwise;
}

// Zeros, what the `_init` of another type made, and a copy.
static void copies(int function, int status)
{
    const int init = tested->init;
    __builtin_memset(other, 0, MOST);
    expect(0, other, ACROBOT_ERROR_NOT_INITIALIZED);
    hold(init == 0 ? BATCH : 0);
    prepare(function);
    expect(0, held, ACROBOT_ERROR_NOT_INITIALIZED);
    hold(init);
    prepare(function);
    __builtin_memcpy(other, held, MOST);
    expect(0, other, tested->arguments[0].align == 64 ? ACROBOT_ERROR_MOVED : status);
}

// Tries each address in the arena: one in the held bytes is rejected.
static void sweep(int slot, int status)
{
    const struct argument *argument = &tested->arguments[slot];
    for (size_t at = 0; at + argument->size <= sizeof arena; at += argument->align) {
        const bool is_apart = at + argument->size <= MARGIN || at >= MARGIN + size_of_held;
        expect(slot, arena + at, is_apart ? status : ACROBOT_ERROR_OVERLAP);
    }
}

// A wrong number is reported, and no result is written.
static void wrong(int slot, int status)
{
    __builtin_memset(outputs, 0, sizeof outputs);
    expect(slot, ones, status);
    for (int i = 0; i < SLOTS && status == ACROBOT_ERROR_OUT_OF_RANGE; i++) {
        const struct argument *output = &tested->arguments[i];
        if (output->role == OUTPUT && same_text(output->name, "error")) {
            CHECK(((acrobot_error_t *)(void *)outputs[i])->rule[0] != 0);
        } else if (output->role == OUTPUT && !output->is_apart) {
            CHECK(same(outputs[i], ZEROS, output->size));
        }
    }
}

static void test(int function)
{
    hold(TABLE[function].init);
    prepare(function);
    const int status = status_of("", ACROBOT_OK);
    for (int slot = 0; slot < SLOTS; slot++) {
        const struct argument *argument = &tested->arguments[slot];
        if (argument->role == NUMBER || argument->role == INPUT) {
            wrong(slot, status_of(argument->name, ACROBOT_ERROR_OUT_OF_RANGE));
        }
        if (argument->role == NUMBER || argument->role == NONE) {
            continue;
        }
        expect(slot, pointers[slot], status);
        expect(slot, NULL, argument->is_optional ? status : ACROBOT_ERROR_NULL);
        if (argument->align > 1) {
            expect(slot, (uint8_t *)pointers[slot] + 1, ACROBOT_ERROR_MISALIGNED);
        }
        if (argument->role == HOLDER) {
            copies(function, status);
        } else if (argument->role == OUTPUT && size_of_held > 0) {
            sweep(slot, status);
        } else if (argument->role == INPUT && argument->is_apart && size_of_held > 0) {
            expect(slot, held, ACROBOT_ERROR_OVERLAP);
        }
        for (int i = 0; i < SLOTS; i++) {
            const struct argument *apart = &tested->arguments[i];
            if (i != slot && argument->is_apart && apart->is_apart && argument->role != STRUCT &&
                (argument->role == OUTPUT || apart->role == OUTPUT) &&
                argument->align <= apart->align) {
                expect(slot, pointers[i], ACROBOT_ERROR_OVERLAP);
            }
        }
    }
}

int main(void)
{
    acrobot_planner_t planner;
    acrobot_regression_t regression;
    const acrobot_weights_t weights = {{{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}, 1};
    const acrobot_noise_t noise = {.001f, .01f};
    __builtin_memset(ones, 0xFF, sizeof ones);
    // Where zeros are rejected.
    *a_float = .001f;
    *a_double = 1;
    *a_count = COUNT;
    *a_weights = weights;
    *a_noise = noise;
    a_covariances->s[0] = a_covariances->s[1] = 1;
    a_state->theta1 = 3.1415927f;
    ACCEPTED(acrobot_task_params(ACROBOT_TASK_GYMNASIUM, a_params, NULL));
    const acrobot_settings_t settings = {*a_params, 6, {4096, 1024}, 0, 1};
    *a_settings = settings;
    ACCEPTED(acrobot_linearize(a_params, a_state, 0, a_linear_model, NULL));
    for (int i = 0; i < COUNT; i++) {
        ACCEPTED(acrobot_linearize_step(a_params, a_state, 0, &a_step_model[i], NULL));
    }
    ACCEPTED(acrobot_problem_init(a_problem, a_params, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, a_problem, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, a_feedback));
    ACCEPTED(acrobot_regression_init(&regression));
    ACCEPTED(acrobot_regression_fit(&regression, a_fit));
    ACCEPTED(acrobot_controller_init(a_controller, a_settings, NULL));
#ifdef ACROBOT_HAS_SNAPSHOTS
    acrobot_batch_t *batch;
    ACCEPTED(acrobot_batch_init(held, SIZE, COUNT, 0, true, 1, &batch));
    ACCEPTED(acrobot_batch_save(batch, a_bytes, SIZE, &saved));
#endif
    for (int i = 0; i < FUNCTIONS; i++) {
        test(i);
    }
    return report("misuse");
}
