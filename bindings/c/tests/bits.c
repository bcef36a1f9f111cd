// C gets the same bits as Rust.

#include <float.h>

#include "check.h"
#include "digest.h"

#define COUNT 20

// From tests/bits/src/episodes.rs: FAST, the second of BALANCE, and the first two of BATCHES.
static const uint64_t FAST = UINT64_C(0x273b096c8e81c01c);
static const uint64_t BALANCE = UINT64_C(0x3c5d97b5d2a0597e);
static const uint64_t BATCH = UINT64_C(0xeae8bc44fb2bab5e), TINY = UINT64_C(0xcc78d47481084cf5);

// The states of Rust's digests are doubles. Only finite numbers come here.
static void add_seen(uint64_t *digest, const acrobot_t *acrobot,
                     const acrobot_observation_t *observation)
{
    acrobot_state_t state;
    ACCEPTED(acrobot_state(acrobot, &state));
    const double numbers[4] = {state.theta1, state.theta2, state.dtheta1, state.dtheta2};
    for (int i = 0; i < 4; i++) {
        uint64_t bits;
        __builtin_memcpy(&bits, &numbers[i], sizeof bits);
        add(digest, bits);
    }
    add_floats(digest, observation, 6);
}

// As integers, because a program linked with -ffast-math compares subnormal numbers as 0.
static uint8_t against(float dtheta1)
{
    int32_t bits;
    __builtin_memcpy(&bits, &dtheta1, sizeof bits);
    return bits > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
}

// Even episodes have random actions, odd ones torque against link 1's velocity.
static uint64_t episode(unsigned seed)
{
    uint64_t digest = OFFSET;
    acrobot_t acrobot;
    acrobot_action_space_t action_space;
    acrobot_step_t step;
    ACCEPTED(acrobot_init(&acrobot, seed));
    ACCEPTED(acrobot_action_space_init(&action_space, seed));
    ACCEPTED(acrobot_observe(&acrobot, &step.observation));
    add_seen(&digest, &acrobot, &step.observation);
    do {
        uint8_t action = against(step.observation.dtheta1);
        if (seed % 2 == 0) {
            ACCEPTED(acrobot_action_space_sample(&action_space, &action));
        }
        ACCEPTED(acrobot_step(&acrobot, action, &step));
        add_seen(&digest, &acrobot, &step.observation);
        add_floats(&digest, &step.reward, 1);
        add(&digest, (uint64_t)step.terminated << 1 | step.truncated);
    } while (!step.terminated && !step.truncated);
    ACCEPTED(acrobot_reset(&acrobot, &step.observation));
    add_seen(&digest, &acrobot, &step.observation);
    return digest;
}

// The task to stay upright, which no state ends.
static uint64_t balance(void)
{
    static const acrobot_state_t STARTS[] = {{3, .2f, 0, 0}, {.5f, 0, 0, 0}};
    uint64_t digest = OFFSET;
    for (int i = 0; i < 2; i++) {
        acrobot_t acrobot;
        acrobot_state_t state;
        acrobot_step_t step;
        ACCEPTED(acrobot_init_task(&acrobot, ACROBOT_TASK_BALANCE, 0, NULL));
        ACCEPTED(acrobot_state(&acrobot, &state));
        // That of Rust's `Acrobot::<Fast, Balance>::new(0)`.
        CHECK(state.theta1 == 3.155289f && state.theta2 == -.02302133f);
        for (int j = 0; j < 40; j++) {
            ACCEPTED(acrobot_reset(&acrobot, NULL));
            ACCEPTED(acrobot_state(&acrobot, &state));
            CHECK(state.theta1 > 3.09f && state.theta1 < 3.193f && state.dtheta1 < .0501f);
        }
        ACCEPTED(acrobot_set_state(&acrobot, &STARTS[i], NULL));
        for (int j = 0; j < 100; j++) {
            ACCEPTED(acrobot_state(&acrobot, &state));
            ACCEPTED(acrobot_step(&acrobot, against(state.dtheta1), &step));
            CHECK(!step.terminated);
            add_seen(&digest, &acrobot, &step.observation);
            add_floats(&digest, &step.reward, 1);
        }
    }
    return digest;
}

// A finished episode's last observation stays in `finals` until the next one. With tiny torques all
// numbers are subnormal.
static uint64_t batch_of_twenty(bool tiny)
{
    static const acrobot_state_t HANGING = {0, 0, 0, 0};
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
    static acrobot_observation_t rows[COUNT], finals[COUNT];
    static float rewards[COUNT];
    static bool terminated[COUNT], truncated[COUNT];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, rows, finals};
    uint8_t actions[COUNT];
    acrobot_batch_t *batch;
    acrobot_params_t params;
    uint64_t digest = OFFSET;
    __builtin_memset(rows, 0, sizeof rows);
    __builtin_memset(finals, 0, sizeof finals);
    ACCEPTED(acrobot_batch_init(
        memory, sizeof memory, COUNT, ACROBOT_TASK_GYMNASIUM, false, 42, &batch));
    if (tiny) {
        ACCEPTED(acrobot_batch_params(batch, 0, &params));
        params.torques[0] = (float)(-(double)FLT_MIN / 100);
        params.torques[2] = (float)((double)FLT_MIN / 100);
        ACCEPTED(acrobot_batch_set_all_params(batch, &params, NULL));
    }
    for (int i = 0; i < COUNT && tiny; i++) {
        ACCEPTED(acrobot_batch_set_state(batch, (size_t)i, &HANGING, NULL));
    }
    ACCEPTED(acrobot_batch_set_autoreset(batch, ACROBOT_AUTORESET_SAME_STEP, NULL));
    for (int step = 0; step < 200; step++) {
        for (int i = 0; i < COUNT; i++) {
            actions[i] = against(rows[i].dtheta1);
        }
        ACCEPTED(acrobot_batch_step(batch, actions, &results, COUNT));
        add_floats(&digest, rows, 6 * COUNT);
        add_floats(&digest, finals, 6 * COUNT);
        add_floats(&digest, rewards, COUNT);
        for (int i = 0; i < COUNT; i++) {
            add(&digest, terminated[i]);
        }
    }
    return digest;
}

#if __STDC_HOSTED__ // the knots need 48 KB
#define KNOTS 1100

// From tests/bits/src/plan.rs.
static const uint64_t PLAN = UINT64_C(0x875c0dc9e0fb48ab);

// Plans from hanging at rest, and follows the plan.
static uint64_t plan(void)
{
    static const acrobot_state_t HANGING = {0, 0, 0, 0};
    static acrobot_knot_t knots[KNOTS];
    acrobot_planner_t planner;
    acrobot_problem_t problem;
    acrobot_feedback_t after;
    acrobot_t acrobot;
    acrobot_params_t params;
    acrobot_state_t state;
    acrobot_step_t step;
    float torque;
    size_t length;
    uint64_t digest = OFFSET;
    ACCEPTED(acrobot_init(&acrobot, 0));
    ACCEPTED(acrobot_params(&acrobot, &params));
    params.dt = .01f;
    ACCEPTED(acrobot_set_params(&acrobot, &params, NULL));
    add(&digest, 1);
    ACCEPTED(acrobot_problem_init(&problem, &params, 7, 0, NULL));
    ACCEPTED(acrobot_planner_init(&planner, &problem, NULL));
    ACCEPTED(acrobot_planner_feedback(&planner, &after));
    ACCEPTED(acrobot_planner_plan(&planner, &HANGING, 64, 0, knots, KNOTS, &length, NULL));
    ACCEPTED(acrobot_state(&acrobot, &state));
    for (size_t i = 0; i < length; i++) {
        ACCEPTED(acrobot_plan_torque(knots, length, &after, i, &state, &torque, NULL));
        torque = torque > 10 ? 10 : torque < -10 ? -10 : torque;
        ACCEPTED(acrobot_step_torque(&acrobot, torque, &step, NULL));
        ACCEPTED(acrobot_state(&acrobot, &state));
        add(&digest, 1);
        add_floats(&digest, &knots[i].state, 4);
        add_floats(&digest, &state, 4);
        add_floats(&digest, &knots[i].gain, 4);
        for (int j = 0; j < 4; j++) {
            add_floats(&digest, &knots[i].torque, 1);
        }
    }
    return digest;
}
#endif

int main(void)
{
    uint64_t digest = OFFSET;
    for (unsigned seed = 0; seed < 16; seed++) {
        add(&digest, episode(seed));
    }
    CHECK(digest == FAST);
    CHECK(balance() == BALANCE);
    CHECK(batch_of_twenty(false) == BATCH);
    CHECK(batch_of_twenty(true) == TINY);
#if __STDC_HOSTED__
    CHECK(plan() == PLAN);
#endif
    return report("bits");
}
