// Each value goes where its name says.

#include "check.h"

#define COUNT 2

static bool near(float value, float expected)
{
    return value - expected < 1e-5f && expected - value < 1e-5f;
}

static const acrobot_state_t HANGING = {0, 0, 0, 0}, MOVING = {.1f, -.2f, .3f, -.4f};
// Each number is another one.
static const acrobot_params_t PARAMS = {
    1.1f, 1.2f, 1.3f, 1.4f, .5f, .6f, .7f, .8f, 9.1f, .05f, 12, 13, {-2, .1f, 3}, 0, ACROBOT_DYNAMICS_NIPS,
};

static void an_acrobot(void)
{
    acrobot_t acrobot, twin;
    acrobot_state_t state;
    acrobot_params_t params;
    acrobot_step_t step, twin_step;
    acrobot_observation_t observation;
    float number;
    uint32_t steps;
    CHECK(acrobot_init(&acrobot, 42) == ACROBOT_OK);
    CHECK(acrobot_set_state(&acrobot, &HANGING, NULL) == ACROBOT_OK);
    // −m1 g lc1 − m2 g (l1 + lc2), with the default parameters.
    CHECK(acrobot_energy(&acrobot, &number) == ACROBOT_OK && near(number, -19.6f));
    CHECK(acrobot_tip_height(&acrobot, &number) == ACROBOT_OK && near(number, -2));

    CHECK(acrobot_set_state(&acrobot, &MOVING, NULL) == ACROBOT_OK);
    CHECK(acrobot_state(&acrobot, &state) == ACROBOT_OK && same(&state, &MOVING, sizeof state));
    CHECK(acrobot_observe(&acrobot, &observation) == ACROBOT_OK);
    CHECK(near(observation.cos_theta1, .9950042f) && near(observation.sin_theta1, .0998334f));
    CHECK(near(observation.cos_theta2, .9800666f) && near(observation.sin_theta2, -.1986693f));
    CHECK(observation.dtheta1 == MOVING.dtheta1 && observation.dtheta2 == MOVING.dtheta2);

    // The torque of an action.
    CHECK(acrobot_set_params(&acrobot, &PARAMS, NULL) == ACROBOT_OK);
    CHECK(acrobot_params(&acrobot, &params) == ACROBOT_OK && same(&params, &PARAMS, sizeof params));
    twin = acrobot;
    CHECK(acrobot_step(&acrobot, ACROBOT_ACTION_ZERO, &step) == ACROBOT_OK);
    CHECK(acrobot_step_torque(&twin, PARAMS.torques[1], &twin_step, NULL) == ACROBOT_OK);
    CHECK(step.observation.dtheta1 == twin_step.observation.dtheta1 && step.reward == -1 && twin_step.reward == -1);
    CHECK(acrobot_elapsed(&acrobot, &steps) == ACROBOT_OK && steps == 1);

    CHECK(acrobot_reset_within(&acrobot, .5, .5, NULL, NULL) == ACROBOT_OK);
    CHECK(acrobot_state(&acrobot, &state) == ACROBOT_OK && state.theta1 == .5f && state.dtheta2 == .5f);
    CHECK(acrobot_elapsed(&acrobot, &steps) == ACROBOT_OK && steps == 0);
}

// With the same state and parameters as an acrobot alone.
static void a_batch(void)
{
    ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
    static const uint8_t actions[COUNT] = {ACROBOT_ACTION_POSITIVE, ACROBOT_ACTION_NEGATIVE};
    static const bool mask[COUNT] = {true, false};
    float rewards[COUNT];
    bool terminated[COUNT], truncated[COUNT];
    acrobot_observation_t rows[COUNT];
    const acrobot_batch_results_t results = {rewards, terminated, truncated, rows, NULL};
    acrobot_batch_t *batch;
    acrobot_t alone;
    acrobot_state_t state;
    acrobot_params_t params;
    acrobot_step_t step;
    size_t count;
    CHECK(acrobot_batch_init(memory, sizeof memory, COUNT, 42, &batch) == ACROBOT_OK);
    CHECK(acrobot_batch_count(batch, &count) == ACROBOT_OK && count == COUNT);
    CHECK(acrobot_batch_set_state(batch, 1, &MOVING, NULL) == ACROBOT_OK);
    CHECK(acrobot_batch_state(batch, 1, &state) == ACROBOT_OK && same(&state, &MOVING, sizeof state));
    CHECK(acrobot_batch_state(batch, 0, &state) == ACROBOT_OK && !same(&state, &MOVING, sizeof state));
    CHECK(acrobot_batch_set_params(batch, &PARAMS, NULL) == ACROBOT_OK);
    CHECK(acrobot_batch_params(batch, &params) == ACROBOT_OK && same(&params, &PARAMS, sizeof params));
    CHECK(acrobot_init(&alone, 0) == ACROBOT_OK);
    CHECK(acrobot_set_state(&alone, &MOVING, NULL) == ACROBOT_OK);
    CHECK(acrobot_set_params(&alone, &PARAMS, NULL) == ACROBOT_OK);
    CHECK(acrobot_step(&alone, ACROBOT_ACTION_NEGATIVE, &step) == ACROBOT_OK);
    CHECK(acrobot_batch_step(batch, actions, &results, COUNT) == ACROBOT_OK);
    CHECK(rows[1].dtheta2 == step.observation.dtheta2 && rows[0].dtheta2 != step.observation.dtheta2);
    CHECK(rewards[1] == -1 && !terminated[1] && !truncated[1]);

    CHECK(acrobot_batch_reset_masked(batch, mask, COUNT) == ACROBOT_OK);
    CHECK(acrobot_batch_observe(batch, rows, COUNT) == ACROBOT_OK);
    CHECK(rows[1].dtheta2 == step.observation.dtheta2 && rows[0].dtheta2 <= .1f && rows[0].dtheta2 >= -.1f);
    CHECK(acrobot_batch_reset(batch) == ACROBOT_OK);
    CHECK(acrobot_batch_state(batch, 1, &state) == ACROBOT_OK && state.theta1 <= .1f && state.theta1 >= -.1f);
    CHECK(acrobot_batch_reset_with_seed(batch, 42) == ACROBOT_OK);
    CHECK(acrobot_batch_observe(batch, rows, COUNT) == ACROBOT_OK);
    CHECK(acrobot_batch_init(memory, sizeof memory, COUNT, 42, &batch) == ACROBOT_OK);
    CHECK(acrobot_batch_state(batch, 1, &state) == ACROBOT_OK && state.dtheta1 == rows[1].dtheta1);
}

int main(void)
{
    an_acrobot();
    a_batch();
    return report("values");
}
