// Numbers that are out of range are reported, and change nothing.

#include "check.h"

#define COUNT 3
#define WITH(mass1, gravity) \
    {1, 1, mass1, 1, .5f, .5f, 1, 1, gravity, .2f, 9, 9, {-1, 0, 1}, 0, 0, 0, 0, 0, 0, 0}
#define ONE_BY_ONE {{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}

static const acrobot_params_t GOOD = WITH(1, 9.8f), WEIGHTLESS = WITH(1, 0);
static const acrobot_state_t REST = {0, 0, 0, 0}, MOVING = {0, 0, 1, 0}, FASTEST = {0, 0, 0, 3e38f},
                             BACK = {0, 0, 0, -3e38f};
static const acrobot_weights_t ONES = {ONE_BY_ONE, 1}, ZEROS = {{{0}}, 1}, FREE = {ONE_BY_ONE, 0},
                               UNEVEN = {{{1, 2}, {0, 1}}, 1}, NEGATIVE = {{{-1}}, 1};
static const acrobot_covariances_t EVEN = {ONE_BY_ONE, {1, 1}}, SILENT = {{{0}}, {1, 1}},
                                   EXACT = {ONE_BY_ONE, {1, 0}};
static const acrobot_step_model_t GROWING = {{{0}, {0}, {0, 0, 2}}, {0}},
                                  LASTING = {{{1}}, {0}};

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

#define MAKE(size, count) acrobot_batch_init(memory, size, count, 0, true, 42, &batch)

// What misuse.c does not try.
static void of_a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_OWN_SIZE(COUNT)];
    static uint8_t before[sizeof memory];
    acrobot_batch_t *batch;
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT];
    const uint8_t actions[COUNT] = {0, 1, 3};
    const acrobot_batch_results_t results = {rewards, terminated, truncated, NULL, NULL};
    for (size_t count = 1; count < 100; count++) {
        CHECK(acrobot_batch_size(count, false) == ACROBOT_BATCH_SIZE(count));
        CHECK(acrobot_batch_size(count, true) == ACROBOT_BATCH_OWN_SIZE(count));
    }
    // Too many for the products to be ints.
    CHECK(acrobot_batch_size(30000000, false) == ACROBOT_BATCH_SIZE(30000000));
    CHECK(acrobot_batch_size(SIZE_MAX, true) == SIZE_MAX);
    ACCEPTED(MAKE(sizeof memory, COUNT));
    __builtin_memcpy(before, memory, sizeof before);
    REJECTED(BUFFER_TOO_SMALL, MAKE(sizeof memory - 1, COUNT));
    REJECTED(WRONG_COUNT, MAKE(sizeof memory, 0));
    REJECTED(UNKNOWN_ACTION, acrobot_batch_step(batch, actions, &results, COUNT));
    REJECTED(OUT_OF_RANGE, acrobot_batch_set_autoreset(batch, 256, NULL));
    REJECTED(OUT_OF_RANGE, acrobot_batch_set_max_steps(batch, 0, NULL));
    CHECK(same(memory, before, sizeof memory));
}

// Each kind of error, as a regulator reports it.
static void of_each_kind(void)
{
#define NO_REGULATOR "gain must be finite; target, dt, gravity, weights or noise allow none, got "
#define SEMIDEFINITE "q must be symmetric and positive semidefinite, got "
    static const struct {
        int kind;
        const acrobot_params_t *params;
        const acrobot_state_t *target;
        const acrobot_weights_t *weights;
        const char *message;
    } ROWS[] = {
        {ACROBOT_OUT_OF_RANGE, &GOOD, &REST, &FREE,
         "r must be finite and above 0 per (N m)², got "},
        {ACROBOT_NOT_IN_EQUILIBRIUM, &GOOD, &MOVING, &ONES,
         "target must be in equilibrium: at rest, accelerating at most 0.25 % of a fall, got "},
        {ACROBOT_NOT_SYMMETRIC, &GOOD, &REST, &UNEVEN, SEMIDEFINITE},
        {ACROBOT_NOT_SEMIDEFINITE, &GOOD, &REST, &NEGATIVE, SEMIDEFINITE},
        // Without gravity the acrobot can turn forever, and the motor does not change that.
        {ACROBOT_NOT_STABILIZABLE, &WEIGHTLESS, &REST, &ONES, NO_REGULATOR},
    };
    acrobot_linear_model_t model;
    acrobot_lqr_t lqr;
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        expect_message(acrobot_regulator(
                           ROWS[i].params, ROWS[i].target, 0, ROWS[i].weights, &lqr, &error),
                       ROWS[i].message);
        CHECK(error.kind == ROWS[i].kind);
    }
    // Without weights and friction the acrobot may swing.
    ACCEPTED(acrobot_linearize(&GOOD, &REST, 0, &model, NULL));
    expect_message(acrobot_lqr(&model, &ZEROS, &lqr, &error), NO_REGULATOR);
    CHECK(error.kind == ACROBOT_NOT_DETECTABLE);
    CHECK(same_text(acrobot_error_text(error.kind),
                    "q must weight each motion that persists, but does not weight one"));
    acrobot_lqe_t lqe;
    acrobot_step_model_t step_model;
    ACCEPTED(acrobot_linearize_step(&GOOD, &REST, 0, &step_model, NULL));
    expect_message(acrobot_dlqe(&step_model, &EXACT, &lqe, &error),
                   "s must be finite and above 0 rad², got ");
    // No angle shows a velocity.
    expect_message(acrobot_dlqe(&GROWING, &EVEN, &lqe, &error), NO_REGULATOR);
    CHECK(error.kind == ACROBOT_NOT_OBSERVABLE);
    expect_message(acrobot_dlqe(&LASTING, &SILENT, &lqe, &error), NO_REGULATOR);
    CHECK(error.kind == ACROBOT_NOT_EXCITED);
}

// Finite numbers whose result is not.
static void of_overflows(void)
{
    static acrobot_feedback_t after;
    static acrobot_knot_t knot;
    acrobot_state_t deviation;
    acrobot_rates_t rates;
    acrobot_problem_t problem;
    acrobot_planner_t planner;
    size_t length;
    float torque;
    expect_message(acrobot_deviation_from(&FASTEST, &BACK, &deviation, &error),
                   "dtheta2 must be a finite number of rad/s, got ");
    expect_message(acrobot_derivative(&GOOD, &FASTEST, 0, &rates, &error),
                   "rates must be finite in each element, got ");
    CHECK(error.kind == ACROBOT_NOT_FINITE);
    knot.gain.dtheta2 = 1e38f;
    expect_message(acrobot_plan_torque(&knot, 1, &after, 0, &FASTEST, &torque, &error),
                   "torque must be finite in each element, got ");
    ACCEPTED(acrobot_problem_init(&problem, &GOOD, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    expect_message(acrobot_planner_plan(&planner, &REST, 2, 4, &knot, 1, &length, &error),
                   "tries must be enough to find a plan, got ");
    CHECK(error.kind == ACROBOT_NO_PLAN && error.value == 2);
}

int main(void)
{
    of_an_acrobot();
    of_a_batch();
    of_each_kind();
    of_overflows();
    CHECK(same_text(acrobot_status_text(ACROBOT_OK), "no error"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_OVERLAP), "two arguments overlap"));
    CHECK(same_text(acrobot_status_text(ACROBOT_ERROR_SHARED_PARAMS + 1), "unknown status"));
    CHECK(same_text(acrobot_error_text(-1), "unknown kind"));
    CHECK(same_text(acrobot_error_text(ACROBOT_NOT_EXCITED + 1), "unknown kind"));
    return report("rejections");
}
