// What results.c does not replay: resets and actions as Gymnasium's, a plan that a program follows,
// snapshots, and subnormal numbers, which stay in programs that flush them.

#include "check.h"

#define COUNT 2
#define KNOTS 80

static const acrobot_state_t HANGING = {0, 0, 0, 0};

static void resets(void)
{
    static const double bounds[] = {.5, .5};
    static const acrobot_reset_options_t bounded = {NULL, 0, bounds};
    acrobot_t acrobot;
    acrobot_observation_t first, again;
    acrobot_state_t state;
    ACCEPTED(acrobot_init(&acrobot, 42));
    ACCEPTED(acrobot_observe(&acrobot, &first));
    ACCEPTED(acrobot_reset_with_seed(&acrobot, 42, &again));
    CHECK(same(&first, &again, sizeof first));
    ACCEPTED(acrobot_reset(&acrobot, &again));
    CHECK(!same(&first, &again, sizeof first));
    ACCEPTED(acrobot_reset_with(&acrobot, &bounded, NULL, NULL));
    ACCEPTED(acrobot_state(&acrobot, &state));
    CHECK(state.theta1 == .5f && state.dtheta2 == .5f);
}

// Draws of a batch, its resets, and an acrobot alone with a seed of one.
static void a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_OWN_SIZE(COUNT)];
    static const uint64_t seeds[COUNT] = {7, UINT64_MAX};
    static const uint32_t seed[] = {42};
    static const acrobot_reset_options_t of_batch = {seed, 1, NULL};
    static acrobot_draws_t draws;
    const acrobot_draw_t mass2 = {ACROBOT_DRAW_UNIFORM, .8f, 1.2f, 0, 0};
    acrobot_batch_t *batch;
    acrobot_t alone;
    acrobot_observation_t row, rows[COUNT], before[COUNT];
    acrobot_params_t own;
    draws.mass2 = mass2;
    ACCEPTED(acrobot_batch_init(
        memory, sizeof memory, COUNT, ACROBOT_TASK_SWINGUP, true, 0, &batch));
    ACCEPTED(acrobot_batch_set_draws(batch, &draws, NULL));
    ACCEPTED(acrobot_batch_reset_with(batch, &of_batch, NULL));
    ACCEPTED(acrobot_batch_params(batch, 1, &own));
    CHECK(own.mass2 > .8f && own.mass2 < 1.2f && own.mass2 != 1 && own.damping1 == .05f);
    ACCEPTED(acrobot_batch_observe(batch, before, COUNT));
    ACCEPTED(acrobot_batch_reset(batch));
    ACCEPTED(acrobot_batch_observe(batch, rows, COUNT));
    CHECK(!same(rows, before, sizeof rows));
    ACCEPTED(acrobot_batch_reset_with_seeds(batch, seeds, COUNT));
    ACCEPTED(acrobot_batch_observe(batch, rows, COUNT));
    ACCEPTED(acrobot_init_task(&alone, ACROBOT_TASK_SWINGUP, 0, NULL));
    ACCEPTED(acrobot_reset_with_seed(&alone, seeds[1], &row));
    CHECK(same(&rows[1], &row, sizeof row));
#ifdef ACROBOT_HAS_SNAPSHOTS
    static uint8_t bytes[ACROBOT_SNAPSHOT_SIZE];
    acrobot_t copy;
    size_t length;
    ACCEPTED(acrobot_save(&alone, bytes, sizeof bytes, &length));
    ACCEPTED(acrobot_load(&copy, bytes, length));
    ACCEPTED(acrobot_observe(&copy, &row));
    CHECK(same(&rows[1], &row, sizeof row));
    REJECTED(BUFFER_TOO_SMALL, acrobot_save(&alone, bytes, length - 1, &length));
#endif
}

static void a_plan(void)
{
    static acrobot_knot_t knots[KNOTS];
    acrobot_t acrobot;
    acrobot_planner_t planner;
    acrobot_params_t params;
    acrobot_problem_t problem;
    acrobot_feedback_t after;
    acrobot_state_t state;
    acrobot_step_t step;
    size_t length;
    float height, torque;
    ACCEPTED(acrobot_task_params(ACROBOT_TASK_BALANCE, &params, NULL));
    CHECK(params.dt == .02f && params.torques[2] == 10 && params.mass1 == 1);
    params.dt = .05f;
    ACCEPTED(acrobot_init(&acrobot, 0));
    ACCEPTED(acrobot_set_params(&acrobot, &params, NULL));
    ACCEPTED(acrobot_set_state(&acrobot, &HANGING, NULL));
    ACCEPTED(acrobot_problem_init(&problem, &params, 7, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, &after));
    ACCEPTED(acrobot_planner_plan(&planner, &HANGING, 64, 0, knots, KNOTS, &length, NULL));
    ACCEPTED(acrobot_state(&acrobot, &state));
    for (size_t i = 0; i < length + 100; i++) {
        ACCEPTED(acrobot_plan_torque(knots, length, &after, i, &state, &torque, NULL));
        torque = torque > 10 ? 10 : torque < -10 ? -10 : torque;
        ACCEPTED(acrobot_step_torque(&acrobot, torque, &step, NULL));
        ACCEPTED(acrobot_state(&acrobot, &state));
    }
    ACCEPTED(acrobot_tip_height(&acrobot, &height));
    CHECK(height > 1.9f);
}

static void actions(void)
{
    // Gymnasium's MultiDiscrete([3] * 6) with the seed 42.
    static const uint8_t EXPECTED[] = {2, 1, 2, 2, 0, 2};
    acrobot_action_space_t action_space;
    uint8_t actions[6];
    ACCEPTED(acrobot_action_space_init(&action_space, 42));
    ACCEPTED(acrobot_action_space_sample_each(&action_space, actions, 6));
    CHECK(same(actions, EXPECTED, sizeof actions));
}

// The velocities after a step with a torque so small that they are subnormal. They are compared as
// integers, because a program linked with -ffast-math takes them for 0.
static void subnormal_numbers(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
    static const float TORQUES[COUNT] = {0, 1e-39f};
    static const int32_t EXPECTED[] = {-2147391814, 238746};
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT];
    acrobot_observation_t rows[COUNT];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, rows, NULL};
    acrobot_batch_t *batch;
    acrobot_t alone;
    acrobot_step_t step;
    ACCEPTED(acrobot_init(&alone, 0));
    ACCEPTED(acrobot_set_state(&alone, &HANGING, NULL));
    ACCEPTED(acrobot_step_torque(&alone, TORQUES[1], &step, NULL));
    CHECK(same(&step.observation.dtheta1, EXPECTED, sizeof EXPECTED));
    ACCEPTED(acrobot_batch_init(memory, sizeof memory, COUNT, 0, false, 0, &batch));
    ACCEPTED(acrobot_batch_set_state(batch, 1, &HANGING, NULL));
    ACCEPTED(acrobot_batch_step_torque(batch, TORQUES, &results, COUNT));
    CHECK(same(&rows[1].dtheta1, EXPECTED, sizeof EXPECTED));
}

int main(void)
{
    resets();
    a_batch();
    a_plan();
    actions();
    subnormal_numbers();
    return report("values");
}
