// Misuse of control: bad arguments are reported, and change no result. misuse.c tries the results
// of what has memory of its own.

#include "check.h"

#define ONE_BY_ONE {{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}
#define PARAMS_WITH(mass1, gravity) \
    {1, 1, mass1, 1, .5f, .5f, 1, 1, gravity, .2f, 9, 9, {-1, 0, 1}, 0, 0, 0, 0, 0, 0, 0}

static const acrobot_params_t GOOD = PARAMS_WITH(1, 9.8f), NO_MASS = PARAMS_WITH(0, 9.8f),
                              WEIGHTLESS = PARAMS_WITH(1, 0);
static const acrobot_state_t REST = {0, 0, 0, 0}, FAR = {INF, 0, 0, 0}, MOVING = {0, 0, 1, 0},
                             FASTEST = {0, 0, 0, 3e38f}, BACK = {0, 0, 0, -3e38f};
static const acrobot_weights_t ONES = {ONE_BY_ONE, 1}, ZEROS = {{{0}}, 1}, FREE = {ONE_BY_ONE, 0},
                               UNEVEN = {{{1, 2}, {0, 1}}, 1}, NEGATIVE = {{{-1}}, 1};
static const acrobot_sample_t STILL = {{0, 0}, {0, 0}};

static acrobot_linear_model_t linear_model;
static acrobot_step_model_t step_model;
static acrobot_fit_t fit_of_nothing;
static acrobot_knot_t a_knot;
static acrobot_feedback_t a_feedback;
static acrobot_state_t gains[1];

typedef float matrix2_t[2][2], matrix4_t[4][4];

// Each function, with the names of its pointers: `out` is the result.
#define CALLS \
    CALL(acrobot_state_t, acrobot_deviation_from(state, state, out, &error)) \
    CALL(acrobot_rates_t, acrobot_derivative(params, state, 1, out, &error)) \
    CALL(matrix2_t, acrobot_mass_matrix(params, state, out, &error)) \
    CALL(acrobot_forces_t, acrobot_inverse_dynamics(params, state, 1, 2, out, &error)) \
    CALL(acrobot_linear_model_t, acrobot_linearize(params, state, 1, out, &error)) \
    CALL(acrobot_step_model_t, acrobot_linearize_step(params, state, 1, out, &error)) \
    CALL(acrobot_lqr_t, acrobot_regulator(params, state, 0, weights, out, &error)) \
    CALL(acrobot_lqr_t, acrobot_lqr(continuous, weights, out, &error)) \
    CALL(acrobot_lqr_t, acrobot_dlqr(steps, weights, out, &error)) \
    CALL(matrix4_t, acrobot_tvlqr(steps, weights, out, gains, 1, &error)) \
    CALL(acrobot_problem_t, acrobot_problem_init(out, params, 1, 0, &error)) \
    CALL(float, acrobot_plan_torque(knots, 1, after, 0, state, out, &error)) \
    CALL(double, acrobot_prediction_error(params, samples, 1, 1, out, &error))

// Which pointer is wrong. All calls have a result.
static const char *const NAMES[] = {"params", "state", "weights", "continuous", "steps",
                                    "knots",  "after", "samples", "out"};
enum { POINTERS = sizeof NAMES / sizeof NAMES[0] };

static const char *const TEXTS[] = {
#define CALL(type, ...) #__VA_ARGS__,
    CALLS
#undef CALL
};
enum { ROWS = sizeof TEXTS / sizeof TEXTS[0] };

static acrobot_status_t call(int row, int wrong, bool is_null, void *result)
{
#define POINTER(index, type, name, value) \
    const uint8_t *name##_bytes = (const uint8_t *)(value); \
    name##_bytes = wrong != index ? name##_bytes : is_null ? NULL : name##_bytes + 1; \
    const type *name = (const type *)(const void *)name##_bytes;
    POINTER(0, acrobot_params_t, params, &GOOD)
    POINTER(1, acrobot_state_t, state, &REST)
    POINTER(2, acrobot_weights_t, weights, &ONES)
    POINTER(3, acrobot_linear_model_t, continuous, &linear_model)
    POINTER(4, acrobot_step_model_t, steps, &step_model)
    POINTER(5, acrobot_knot_t, knots, &a_knot)
    POINTER(6, acrobot_feedback_t, after, &a_feedback)
    POINTER(7, acrobot_sample_t, samples, &STILL)
    uint8_t *out_bytes = (uint8_t *)result;
    out_bytes = wrong != 8 ? out_bytes : is_null ? NULL : out_bytes + 1;
#define CALL(type, ...) \
    if (row-- == 0) { \
        type *out = (type *)(void *)out_bytes; \
        return __VA_ARGS__; \
    }
    CALLS
#undef CALL
    return ACROBOT_OK;
}

static bool contains(const char *text, const char *word)
{
    for (; *text != 0; text++) {
        int i = 0;
        while (word[i] != 0 && text[i] == word[i]) {
            i++;
        }
        if (word[i] == 0) {
            return true;
        }
    }
    return false;
}

static void wrong_pointers(void)
{
    static union {
        double aligned;
        uint8_t bytes[1024];
    } result, zeros;
    for (int row = 0; row < ROWS; row++) {
        for (int wrong = 0; wrong < POINTERS; wrong++) {
            if (!contains(TEXTS[row], NAMES[wrong])) {
                continue;
            }
            const acrobot_status_t null = call(row, wrong, true, &result);
            const acrobot_status_t misaligned = call(row, wrong, false, &result);
            if (null != ACROBOT_ERROR_NULL || misaligned != ACROBOT_ERROR_MISALIGNED) {
                print(TEXTS[row]);
                print(": ");
                print(NAMES[wrong]);
                print(" may be wrong\n");
                failures++;
            }
        }
        CHECK(same(&result, &zeros, sizeof result));
        ACCEPTED(call(row, POINTERS, true, &result));
        __builtin_memset(&result, 0, sizeof result);
    }
}

// Rejected with this kind and name, and without a change of `out`.
#define REJECTS(kind_of, name_of, type, ...) \
    do { \
        type value, before, *out = &value; \
        __builtin_memset(&value, 7, sizeof value); \
        __builtin_memset(&before, 7, sizeof value); \
        REJECTED(OUT_OF_RANGE, __VA_ARGS__); \
        CHECK(error.kind == ACROBOT_##kind_of && same_text(error.name, name_of)); \
        CHECK(same(&value, &before, sizeof value)); \
    } while (0)

static void wrong_numbers(void)
{
    acrobot_knot_t knot = a_knot;
    acrobot_sample_t sample = STILL;
    REJECTED(NULL, acrobot_task_params(0, NULL, &error));
    REJECTS(OUT_OF_RANGE, "task", acrobot_params_t, acrobot_task_params(3, out, &error));
    REJECTS(OUT_OF_RANGE, "dtheta2", acrobot_state_t,
            acrobot_deviation_from(&FASTEST, &BACK, out, &error));
    REJECTS(OUT_OF_RANGE, "mass1", acrobot_rates_t,
            acrobot_derivative(&NO_MASS, &REST, 0, out, &error));
    REJECTS(OUT_OF_RANGE, "torque", acrobot_rates_t,
            acrobot_derivative(&GOOD, &REST, NAN, out, &error));
    REJECTS(NOT_FINITE, "rates", acrobot_rates_t,
            acrobot_derivative(&GOOD, &FASTEST, 0, out, &error));
    REJECTS(OUT_OF_RANGE, "theta1", matrix2_t, acrobot_mass_matrix(&GOOD, &FAR, out, &error));
    REJECTS(OUT_OF_RANGE, "ddtheta2", acrobot_forces_t,
            acrobot_inverse_dynamics(&GOOD, &REST, 0, INF, out, &error));
    REJECTS(OUT_OF_RANGE, "torque", acrobot_linear_model_t,
            acrobot_linearize(&GOOD, &REST, INF, out, &error));
    REJECTS(NOT_FINITE, "a", acrobot_step_model_t,
            acrobot_linearize_step(&GOOD, &FASTEST, 0, out, &error));
    REJECTS(NOT_IN_EQUILIBRIUM, "target", acrobot_lqr_t,
            acrobot_regulator(&GOOD, &MOVING, 0, &ONES, out, &error));
    REJECTS(NOT_IN_EQUILIBRIUM, "target", acrobot_lqr_t,
            acrobot_regulator(&GOOD, &REST, 1, &ONES, out, &error));
    REJECTS(OUT_OF_RANGE, "r", acrobot_lqr_t,
            acrobot_regulator(&GOOD, &REST, 0, &FREE, out, &error));
    REJECTS(NOT_SYMMETRIC, "q", acrobot_lqr_t,
            acrobot_lqr(&linear_model, &UNEVEN, out, &error));
    REJECTS(NOT_SEMIDEFINITE, "q", acrobot_lqr_t,
            acrobot_dlqr(&step_model, &NEGATIVE, out, &error));
    // Without gravity the acrobot can turn forever, and the motor does not change that. Without
    // weights and friction it may swing.
    REJECTS(NOT_STABILIZABLE, "gain", acrobot_lqr_t,
            acrobot_regulator(&WEIGHTLESS, &REST, 0, &ONES, out, &error));
    REJECTS(NOT_DETECTABLE, "gain", acrobot_lqr_t,
            acrobot_lqr(&linear_model, &ZEROS, out, &error));
    CHECK(same_text(acrobot_error_text(error.kind),
                    "q must weight each motion that persists, but does not weight one"));
    CHECK(same_text(error.rule, "finite; target, dt, gravity and weights allow no regulator"));
    REJECTED(OVERLAP, acrobot_tvlqr(&step_model, &ONES, &step_model.a, gains, 1, &error));
    REJECTS(OUT_OF_RANGE, "r", matrix4_t,
            acrobot_tvlqr(&step_model, &FREE, out, gains, 1, &error));
    // NaN and infinite torques.
    REJECTS(OUT_OF_RANGE, "theta1", float,
            acrobot_plan_torque(&knot, 1, &a_feedback, 0, &FAR, out, &error));
    knot.torque = NAN;
    REJECTS(NOT_FINITE, "torque", float,
            acrobot_plan_torque(&knot, 1, &a_feedback, 0, &REST, out, &error));
    knot = a_knot;
    knot.gain.dtheta2 = 1e38f;
    REJECTS(NOT_FINITE, "torque", float,
            acrobot_plan_torque(&knot, 1, &a_feedback, 0, &FASTEST, out, &error));
    // A recording at rest determines nothing.
    REJECTS(OUT_OF_RANGE, "mass11", acrobot_params_t,
            acrobot_fit_params(&fit_of_nothing, &GOOD, out, &error));
    CHECK(same_text(error.rule,
                    "determined by recordings in which both links move long enough, in kg m²"));
    REJECTS(OUT_OF_RANGE, "mass11", acrobot_params_t,
            acrobot_identify(&STILL, 1, &GOOD, out, &error));
    sample.torques[1] = (double)NAN;
    REJECTS(NOT_FINITE, "torques", acrobot_params_t,
            acrobot_identify(&sample, 1, &GOOD, out, &error));
    CHECK(same_text(acrobot_error_text(-1), "unknown kind"));
    CHECK(same_text(acrobot_error_text(ACROBOT_NO_PLAN), "no plan ends upright"));
    CHECK(same_text(acrobot_error_text(ACROBOT_NO_PLAN + 1), "unknown kind"));
}

// Each of these calls is rejected, and leaves the memory as it was.
static void a_planner(void)
{
    acrobot_planner_t planner, before;
    acrobot_problem_t problem;
    acrobot_knot_t *const inside = (acrobot_knot_t *)(void *)&planner, better;
    acrobot_knot_t plan = a_knot;
    size_t length;
    float cost;
    bool holds;
    REJECTED(OUT_OF_RANGE, acrobot_problem_init(&problem, &GOOD, 0, 0, NULL));
    expect_message(acrobot_problem_init(&problem, &GOOD, 1, INF, &error),
                   "theta2 must be a finite number of rad, got ");
    ACCEPTED(acrobot_problem_init(&problem, &GOOD, 1, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    __builtin_memcpy(&before, &planner, sizeof before);
    REJECTED(NULL, acrobot_planner_init(NULL, &problem, NULL));
    REJECTED(NULL, acrobot_planner_init(&planner, NULL, NULL));
    REJECTED(OVERLAP,
             acrobot_planner_init(&planner, &problem, (acrobot_error_t *)(void *)&planner));
    problem.cost.power = -1;
    expect_message(acrobot_planner_init(&planner, &problem, &error),
                   "power must be finite and at least 0 per J, got ");
    REJECTED(NULL, acrobot_planner_plan(&planner, &REST, 2, 4, NULL, 1, &length, NULL));
    REJECTED(OVERLAP, acrobot_planner_plan(&planner, &REST, 2, 4, inside, 1, &length, NULL));
    CHECK(same(&planner, &before, sizeof planner));
    expect_message(acrobot_planner_plan(&planner, &REST, 2, 4, &better, 1, &length, &error),
                   "tries must be enough to find a plan, got ");
    REJECTED(OUT_OF_RANGE, acrobot_planner_holds_from(&planner, &FAR, &holds, NULL));

    REJECTED(NULL, acrobot_planner_improve(&planner, &REST, 2, NULL, &better, 1, &cost, NULL));
    REJECTED(NULL, acrobot_planner_improve(&planner, &REST, 2, &plan, NULL, 1, &cost, NULL));
    REJECTED(OVERLAP, acrobot_planner_improve(&planner, &REST, 2, &plan, &plan, 1, &cost, NULL));
    REJECTED(OVERLAP, acrobot_planner_improve(&planner, &REST, 2, &plan, inside, 1, &cost, NULL));
    REJECTED(OVERLAP, acrobot_planner_improve(&planner, &REST, 2, inside, &better, 1, &cost, NULL));
    // The plan that a machine follows stays, also from a state that is too extreme.
    expect_message(acrobot_planner_improve(&planner, &FASTEST, 2, &plan, &better, 1, &cost, &error),
                   "cost must be finite in each element, got ");
    CHECK(same(&plan, &a_knot, sizeof plan));
    plan.torque = INF;
    expect_message(acrobot_planner_improve(&planner, &REST, 2, &plan, &better, 1, &cost, &error),
                   "torque must be finite in each element, got ");
}

static void estimators(void)
{
    static const acrobot_noise_t NOISE = {.001f, .01f}, SILENCE = {.001f, 0};
    acrobot_parameter_std_t std = {.1f, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    acrobot_params_t params = GOOD;
    acrobot_estimator_t alone, before;
    acrobot_parameter_estimator_t both;
    acrobot_state_t state;
    ACCEPTED(acrobot_estimator_init(&alone, &GOOD, &NOISE, NULL));
    __builtin_memcpy(&before, &alone, sizeof before);
    REJECTED(NULL, acrobot_estimator_init(&alone, NULL, &NOISE, NULL));
    REJECTED(NULL, acrobot_estimator_init(&alone, &GOOD, NULL, NULL));
    expect_message(acrobot_estimator_init(&alone, &GOOD, &SILENCE, &error),
                   "torque_std must be finite and above 0 N m, got ");
    CHECK(same(&alone, &before, sizeof before));
    // Until a step in which a joint turns too far.
    params.max_velocity1 = INF;
    ACCEPTED(acrobot_estimator_init(&alone, &params, &NOISE, NULL));
    ACCEPTED(acrobot_estimator_correct(&alone, 0, 0, NULL));
    expect_message(acrobot_estimator_predict(&alone, 1e6f, &error),
                   "dtheta1 must be at most half a turn in a step, in rad/s, got ");
    ACCEPTED(acrobot_estimator_state_std(&alone, &state));
    CHECK(state.theta1 == INF);
    REJECTED(NULL, acrobot_parameter_estimator_init(&both, &GOOD, NULL, &NOISE, NULL));
    std.rotor = -1;
    REJECTED(OUT_OF_RANGE, acrobot_parameter_estimator_init(&both, &GOOD, &std, &NOISE, &error));
    CHECK(same_text(error.name, "rotor") && error.value == -1);
}

static void a_regression(void)
{
    acrobot_regression_t regression, before;
    const acrobot_sample_t *inside = (const acrobot_sample_t *)(void *)&regression;
    ACCEPTED(acrobot_regression_init(&regression));
    __builtin_memcpy(&before, &regression, sizeof before);
    REJECTED(NULL, acrobot_regression_init(NULL));
    REJECTED(NULL, acrobot_regression_add(&regression, NULL, 1, 1, 1, 1, 1, NULL));
    REJECTED(OVERLAP, acrobot_regression_add(&regression, inside, 1, 1, 1, 1, 1, NULL));
    expect_message(acrobot_regression_add(&regression, &STILL, 1, 1, 1, 1, 0, &error),
                   "window must be finite and above 0 samples, got ");
    CHECK(same(&regression, &before, sizeof before));
}

static void mpc(void)
{
    static acrobot_controller_t controller, before;
    static acrobot_replanner_t replanner;
    acrobot_settings_t settings = {PARAMS_WITH(1, 9.8f), 6, {4096, 1024}, 5};
    ACCEPTED(acrobot_controller_init(&controller, &settings, NULL));
    ACCEPTED(acrobot_replanner_init(&replanner, &settings, NULL));
    __builtin_memcpy(&before, &controller, sizeof before);
    REJECTED(NULL, acrobot_controller_init(&controller, NULL, NULL));
    REJECTED(NULL, acrobot_replanner_init(&replanner, NULL, NULL));
    REJECTED(NULL, acrobot_replanner_exchange(&replanner, NULL));
    REJECTED(OVERLAP,
             acrobot_replanner_exchange(&replanner, (acrobot_controller_t *)(void *)&replanner));
    settings.counts[1] = 0;
    expect_message(acrobot_controller_init(&controller, &settings, &error),
                   "counts must be finite and above 0 for a turn, got ");
    settings.limit = INF;
    REJECTED(OUT_OF_RANGE, acrobot_replanner_init(&replanner, &settings, NULL));
    CHECK(same(&controller, &before, sizeof before));
}

int main(void)
{
    acrobot_regression_t nothing;
    ACCEPTED(acrobot_linearize(&GOOD, &REST, 0, &linear_model, NULL));
    ACCEPTED(acrobot_linearize_step(&GOOD, &REST, 0, &step_model, NULL));
    ACCEPTED(acrobot_regression_init(&nothing));
    ACCEPTED(acrobot_regression_fit(&nothing, &fit_of_nothing));
    CHECK(fit_of_nothing.rank_deficiency == 10);
    wrong_pointers();
    wrong_numbers();
    a_planner();
    estimators();
    a_regression();
    mpc();
    return report("misuse of control");
}
