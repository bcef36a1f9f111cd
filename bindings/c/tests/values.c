// Each value goes where its name says, also where results.c does not show it, and subnormal numbers
// stay in programs that flush them.

#include <float.h>

#include "check.h"

#define COUNT 2
#define KNOTS 80

static bool near(float value, float expected)
{
    return value - expected < 1e-5f && expected - value < 1e-5f;
}

static const acrobot_state_t HANGING = {0, 0, 0, 0}, MOVING = {.1f, -.2f, .3f, -.4f};
// Each number is another one.
static const acrobot_params_t PARAMS = {
    1.1f, 1.2f, 1.3f, 1.4f, .5f, .6f, .7f, .8f, 9.1f, .05f, 12, 13, {-2, .1f, 3}, 0,
    .01f, .02f, .03f, .04f, .05f, ACROBOT_DYNAMICS_NIPS,
};

static void an_acrobot(void)
{
    acrobot_t acrobot, twin;
    acrobot_state_t state;
    acrobot_params_t params;
    acrobot_step_t step, twin_step;
    float number;
    uint32_t steps;
    static const double bounds[] = {.5, .5};
    const acrobot_reset_options_t options = {NULL, 0, bounds};
    ACCEPTED(acrobot_init(&acrobot, 42));
    ACCEPTED(acrobot_set_state(&acrobot, &HANGING, NULL));
    ACCEPTED(acrobot_tip_height(&acrobot, &number));
    CHECK(near(number, -2));

    ACCEPTED(acrobot_set_state(&acrobot, &MOVING, NULL));
    ACCEPTED(acrobot_state(&acrobot, &state));
    CHECK(same(&state, &MOVING, sizeof state));
    ACCEPTED(acrobot_set_params(&acrobot, &PARAMS, NULL));
    ACCEPTED(acrobot_params(&acrobot, &params));
    CHECK(same(&params, &PARAMS, sizeof params));
    // A copy, with the torque of an action.
    twin = acrobot;
    ACCEPTED(acrobot_step(&acrobot, ACROBOT_ACTION_ZERO, &step));
    ACCEPTED(acrobot_step_torque(&twin, PARAMS.torques[1], &twin_step, NULL));
    CHECK(same(&step.observation, &twin_step.observation, sizeof step.observation));

    ACCEPTED(acrobot_reset_with(&acrobot, &options, NULL, NULL));
    ACCEPTED(acrobot_state(&acrobot, &state));
    CHECK(state.theta1 == .5f && state.dtheta2 == .5f);
    ACCEPTED(acrobot_elapsed_steps(&acrobot, &steps));
    CHECK(steps == 0);
    ACCEPTED(acrobot_set_max_steps(&acrobot, 2, NULL));
    for (steps = 1; steps <= 2; steps++) {
        ACCEPTED(acrobot_step(&acrobot, ACROBOT_ACTION_ZERO, &step));
        CHECK(step.truncated == (steps == 2));
    }
}

// Its second acrobot does what one alone does, whose seed is a child of the batch's.
static void a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_OWN_SIZE(COUNT)];
    static const uint8_t actions[COUNT] = {ACROBOT_ACTION_POSITIVE, ACROBOT_ACTION_NEGATIVE};
    static const bool mask[COUNT] = {true, false};
    static const uint64_t seeds[COUNT] = {7, UINT64_MAX};
    static const uint32_t seed[] = {42}, child1[] = {42, 0, 0, 0, 1};
    static const acrobot_reset_options_t of_batch = {seed, 1, NULL}, of_child1 = {child1, 5, NULL};
    static const float torques[COUNT] = {1, -2};
    static acrobot_draws_t draws;
    const acrobot_draw_t mass2 = {ACROBOT_DRAW_UNIFORM, .8f, 1.2f, 0, 0};
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT], is_done;
    acrobot_observation_t rows[COUNT];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, rows, NULL};
    acrobot_batch_t *batch;
    acrobot_batch_settings_t settings;
    acrobot_t alone;
    acrobot_state_t state;
    acrobot_params_t params, own;
    acrobot_step_t step;
    uint32_t steps;
    int task;
    draws.mass2 = mass2;
    ACCEPTED(acrobot_batch_init(
        memory, sizeof memory, COUNT, ACROBOT_TASK_SWINGUP, true, 0, &batch));
    ACCEPTED(acrobot_batch_set_draws(batch, &draws, NULL));
    ACCEPTED(acrobot_batch_reset_with(batch, &of_batch, NULL));
    ACCEPTED(acrobot_init_task(&alone, ACROBOT_TASK_SWINGUP, 0, NULL));
    ACCEPTED(acrobot_reset_with(&alone, &of_child1, NULL, NULL));
    ACCEPTED(acrobot_draw_params(&alone, &draws, NULL));
    ACCEPTED(acrobot_params(&alone, &params));
    ACCEPTED(acrobot_batch_params(batch, 1, &own));
    CHECK(same(&own, &params, sizeof own) && own.mass2 != 1 && own.damping1 == .05f);
    ACCEPTED(acrobot_batch_step_torque(batch, torques, &results, COUNT));
    ACCEPTED(acrobot_step_torque(&alone, torques[1], &step, NULL));
    CHECK(same(&rows[1], &step.observation, sizeof rows[1]) && rewards[1] == step.reward);
    ACCEPTED(acrobot_batch_step(batch, actions, &results, COUNT));
    ACCEPTED(acrobot_step(&alone, actions[1], &step));
    CHECK(same(&rows[1], &step.observation, sizeof rows[1]));
    ACCEPTED(acrobot_batch_elapsed_steps(batch, 1, &steps));
    ACCEPTED(acrobot_batch_is_done(batch, 1, &is_done));
    CHECK(steps == 2 && !is_done);
    ACCEPTED(acrobot_task(&alone, &task));
    ACCEPTED(acrobot_max_steps(&alone, &steps));
    ACCEPTED(acrobot_batch_settings(batch, &settings));
    CHECK(task == ACROBOT_TASK_SWINGUP && steps == 1000 && settings.count == COUNT);
    CHECK(settings.task == task && settings.max_steps == 1000 && settings.own_params);

    ACCEPTED(acrobot_batch_reset_masked(batch, mask, COUNT, NULL, NULL));
    ACCEPTED(acrobot_batch_observe(batch, rows, COUNT));
    CHECK(same(&rows[1], &step.observation, sizeof rows[1]) && rows[0].dtheta2 == 0);
    ACCEPTED(acrobot_batch_reset(batch));
    ACCEPTED(acrobot_batch_observe(batch, rows, COUNT));
    CHECK(rows[1].dtheta2 == 0);
    ACCEPTED(acrobot_batch_reset_with_seeds(batch, seeds, COUNT));
    ACCEPTED(acrobot_batch_observe(batch, rows, COUNT));
    ACCEPTED(acrobot_reset_with_seed(&alone, seeds[1], &step.observation));
    CHECK(same(&rows[1], &step.observation, sizeof rows[1]));
    ACCEPTED(acrobot_batch_set_all_params(batch, &params, NULL));
    ACCEPTED(acrobot_batch_set_params(batch, 0, &PARAMS, NULL));
    ACCEPTED(acrobot_batch_params(batch, 0, &own));
    CHECK(same(&own, &PARAMS, sizeof own));
    ACCEPTED(acrobot_batch_params(batch, 1, &own));
    CHECK(same(&own, &params, sizeof own));
    ACCEPTED(acrobot_batch_set_state(batch, 1, &MOVING, NULL));
    ACCEPTED(acrobot_batch_state(batch, 1, &state));
    CHECK(same(&state, &MOVING, sizeof state));
#ifdef ACROBOT_HAS_SNAPSHOTS
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t copy[ACROBOT_BATCH_OWN_SIZE(COUNT)];
    static uint8_t bytes[1024];
    acrobot_observation_t copied_rows[COUNT];
    const acrobot_batch_results_t copied = {rewards, terminated, truncated, copied_rows, NULL};
    acrobot_batch_t *loaded;
    acrobot_step_t loaded_step;
    size_t length, count;
    bool own_params;
    CHECK(acrobot_batch_snapshot_size(COUNT) <= sizeof bytes);
    ACCEPTED(acrobot_batch_save(batch, bytes, sizeof bytes, &length));
    ACCEPTED(acrobot_batch_saved_count(bytes, length, &count, &own_params));
    CHECK(count == COUNT && own_params);
    ACCEPTED(acrobot_batch_load(copy, sizeof copy, bytes, length, &loaded));
    ACCEPTED(acrobot_batch_step_torque(batch, torques, &results, COUNT));
    ACCEPTED(acrobot_batch_step_torque(loaded, torques, &copied, COUNT));
    CHECK(same(rows, copied_rows, sizeof rows));
    CHECK(acrobot_load(&alone, bytes, length) == ACROBOT_ERROR_OTHER_SNAPSHOT);
    bytes[40] ^= 1;
    CHECK(acrobot_batch_load(copy, sizeof copy, bytes, length, &loaded) ==
          ACROBOT_ERROR_DAMAGED_SNAPSHOT);
    ACCEPTED(acrobot_save(&alone, bytes, ACROBOT_SNAPSHOT_SIZE, &length));
    CHECK(acrobot_save(&alone, bytes, length - 1, &length) == ACROBOT_ERROR_BUFFER_TOO_SMALL);
    ACCEPTED(acrobot_step_torque(&alone, 1, &step, NULL));
    ACCEPTED(acrobot_load(&alone, bytes, length));
    ACCEPTED(acrobot_step_torque(&alone, 1, &loaded_step, NULL));
    CHECK(same(&step.observation, &loaded_step.observation, sizeof step.observation));
#endif
}

static void controllers(void)
{
    static const acrobot_state_t UPRIGHT = {3.1415927f, 0, 0, 0}, LEANING = {3.1315927f, 0, 0, 0},
                                 FAST = {0, 0, 1, 0}, SLANTED = {3.1f, 0, 0, 0};
    // In units of the machine these are 1: T² is 4.5 kg m² by 24.6 N m.
    static const acrobot_weights_t WEIGHTS = {
        {{1}, {0, 1}, {0, 0, 4.5f / 24.6f}, {0, 0, 0, 4.5f / 24.6f}}, 1 / 25.f};
    static acrobot_knot_t knots[KNOTS];
    acrobot_knot_t knot = {HANGING, 2, HANGING, {0, 0}}, improved;
    acrobot_t acrobot;
    acrobot_planner_t planner;
    acrobot_swing_up_t swing_up;
    acrobot_params_t params;
    acrobot_problem_t problem;
    acrobot_feedback_t after;
    acrobot_lqr_t lqr;
    acrobot_state_t state;
    acrobot_step_t step;
    size_t length;
    float number, torque;
    bool holds;
    ACCEPTED(acrobot_init(&acrobot, 0));
    ACCEPTED(acrobot_params(&acrobot, &params));
    // The cost of 2 N m for 0.2 s, before the torque is improved: 0.1 / T by the square of 5 N m.
    ACCEPTED(acrobot_problem_init(&problem, &params, 5, 0, NULL));
    CHECK(near(problem.cost.torque, .0093524f) && problem.cost.height == 2);
    problem.cost.below = problem.cost.arrival = 0;
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    ACCEPTED(acrobot_planner_improve(&planner, &HANGING, 0, &knot, &improved, 1, &number, NULL));
    CHECK(near(number, .8f * problem.cost.torque));
    ACCEPTED(acrobot_planner_improve(&planner, &HANGING, 9, &improved, &knot, 1, &number, NULL));
    CHECK(near(number, 0) && near(knot.torque, 0));

    // After a plan, and without one, the regulator holds.
    ACCEPTED(acrobot_regulator(&params, &UPRIGHT, 0, &WEIGHTS, &lqr, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, &after));
    ACCEPTED(acrobot_plan_torque(&knot, 1, &after, 1, &LEANING, &torque, NULL));
    CHECK(near(torque, .01f * lqr.gain.theta1));
    ACCEPTED(acrobot_swing_up_init(&swing_up, &params, 5, NULL));
    ACCEPTED(acrobot_swing_up_torque(&swing_up, &LEANING, &number, NULL));
    CHECK(number == torque);
    ACCEPTED(acrobot_planner_holds_from(&planner, &LEANING, &holds, NULL));
    CHECK(holds);
    ACCEPTED(acrobot_planner_holds_from(&planner, &HANGING, &holds, NULL));
    CHECK(!holds);
    // Where link 2 would turn faster than its bound.
    params.dt = .02f;
    params.max_velocity2 = .5f;
    ACCEPTED(acrobot_problem_init(&problem, &params, 10, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    ACCEPTED(acrobot_planner_holds_from(&planner, &SLANTED, &holds, NULL));
    CHECK(!holds);
    ACCEPTED(acrobot_planner_with_velocity_clamp(&planner));
    ACCEPTED(acrobot_planner_holds_from(&planner, &SLANTED, &holds, NULL));
    CHECK(holds);
    // It follows a plan until it stands.
    ACCEPTED(acrobot_task_params(ACROBOT_TASK_GYMNASIUM, &params, NULL));
    params.dt = .05f;
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
    ACCEPTED(acrobot_tip_height(&acrobot, &number));
    CHECK(number > 1.9f);
    knot.gain.dtheta1 = 2;
    ACCEPTED(acrobot_plan_torque(&knot, 1, &after, 0, &FAST, &torque, NULL));
    CHECK(near(torque, knot.torque - 2));
    ACCEPTED(acrobot_task_params(ACROBOT_TASK_BALANCE, &params, NULL));
    CHECK(params.dt == .02f && params.torques[2] == 10 && params.mass1 == 1);

    // With a bent elbow the motor holds link 2.
    ACCEPTED(acrobot_problem_init(&problem, &params, 10, 1, NULL));
    CHECK(near(problem.target.theta1, 2.9082393f) && near(problem.torque, -3.3992471f));
}

static void actions(void)
{
    // Gymnasium's MultiDiscrete([3] * 6) with the seed 42.
    static const uint8_t EXPECTED[] = {2, 1, 2, 2, 0, 2};
    static const uint32_t SEED[] = {42};
    acrobot_action_space_t action_space, twin;
    uint8_t actions[6], action, twins;
    ACCEPTED(acrobot_action_space_init(&action_space, 42));
    ACCEPTED(acrobot_action_space_init_with(&twin, SEED, 1));
    ACCEPTED(acrobot_action_space_sample_each(&action_space, actions, 6));
    CHECK(same(actions, EXPECTED, sizeof actions));
    ACCEPTED(acrobot_action_space_sample_each(&twin, actions, 6));
    ACCEPTED(acrobot_action_space_sample(&action_space, &action));
    ACCEPTED(acrobot_action_space_sample(&twin, &twins));
    CHECK(same(actions, EXPECTED, sizeof actions) && action == twins);
}

// FNV-1a over 64-bit words.
#define OFFSET UINT64_C(0xcbf29ce484222325)

static inline void add(uint64_t *digest, uint64_t word)
{
    *digest = (*digest ^ word) * UINT64_C(0x100000001b3);
}

static inline void add_floats(uint64_t *digest, const void *floats, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        __builtin_memcpy(&bits, (const float *)floats + i, sizeof bits);
        add(digest, bits);
    }
}

#define TWENTY 20

// A batch with torques so small that all numbers are subnormal. The digest is the second of BATCHES
// in tests/bits/src/episodes.rs.
static void subnormal_numbers(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(TWENTY)];
    static acrobot_observation_t seen[2 * TWENTY];
    static float rewards[TWENTY];
    static bool terminated[TWENTY], truncated[TWENTY];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, seen, seen + TWENTY};
    uint8_t actions[TWENTY];
    acrobot_batch_t *batch;
    acrobot_params_t params;
    uint64_t digest = OFFSET;
    ACCEPTED(acrobot_batch_init(
        memory, sizeof memory, TWENTY, ACROBOT_TASK_GYMNASIUM, false, 42, &batch));
    ACCEPTED(acrobot_batch_params(batch, 0, &params));
    params.torques[0] = (float)(-(double)FLT_MIN / 100);
    params.torques[2] = (float)((double)FLT_MIN / 100);
    ACCEPTED(acrobot_batch_set_all_params(batch, &params, NULL));
    for (size_t i = 0; i < TWENTY; i++) {
        ACCEPTED(acrobot_batch_set_state(batch, i, &HANGING, NULL));
    }
    ACCEPTED(acrobot_batch_set_autoreset(batch, ACROBOT_AUTORESET_SAME_STEP, NULL));
    for (int step = 0; step < 200; step++) {
        for (int i = 0; i < TWENTY; i++) {
            // As an integer, because a program linked with -ffast-math compares these as 0.
            int32_t dtheta1;
            __builtin_memcpy(&dtheta1, &seen[i].dtheta1, sizeof dtheta1);
            actions[i] = dtheta1 > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
        }
        ACCEPTED(acrobot_batch_step(batch, actions, &results, TWENTY));
        add_floats(&digest, seen, 12 * TWENTY);
        add_floats(&digest, rewards, TWENTY);
        for (int i = 0; i < TWENTY; i++) {
            add(&digest, terminated[i]);
        }
    }
    CHECK(digest == UINT64_C(0xcc78d47481084cf5));
}

int main(void)
{
    an_acrobot();
    actions();
    a_batch();
    controllers();
    subnormal_numbers();
    return report("values");
}
