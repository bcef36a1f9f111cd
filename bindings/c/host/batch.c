// A batch in static memory: how many episodes a policy ends, and a rejected parameter.

#include <stdio.h>

#include "acrobot.h"

#define COUNT 1000

ACROBOT_ALIGNED(ACROBOT_BATCH_ALIGN) static uint8_t memory[ACROBOT_BATCH_SIZE(COUNT)];
static uint8_t actions[COUNT];
static float rewards[COUNT];
static bool terminated[COUNT], truncated[COUNT];
static acrobot_observation_t observations[COUNT];

int main(void)
{
    acrobot_params_t params;
    acrobot_error_t error;
    long episodes = 0;
    const acrobot_batch_results_t results = {rewards, terminated, truncated, observations, NULL};
    acrobot_batch_t *batch;
    acrobot_status_t status = acrobot_batch_init(
        memory, sizeof memory, COUNT, ACROBOT_TASK_GYMNASIUM, false, 42, &batch);

    if (status == ACROBOT_OK) {
        status = acrobot_batch_observe(batch, observations, COUNT);
    }
    for (int step = 0; step < 1000 && status == ACROBOT_OK; step++) {
        for (int i = 0; i < COUNT; i++) {
            float velocity = observations[i].dtheta1;
            actions[i] = velocity > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
        }
        status = acrobot_batch_step(batch, actions, &results, COUNT);
        for (int i = 0; i < COUNT; i++) {
            episodes += terminated[i] || truncated[i];
        }
    }
    if (status == ACROBOT_OK) {
        status = acrobot_batch_params(batch, 0, &params);
    }
    if (status != ACROBOT_OK) {
        fprintf(stderr, "%s\n", acrobot_status_text(status));
        return 1;
    }
    printf("%ld episodes ended in 1000 steps of %d acrobots\n", episodes, COUNT);
    params.dt = 0;
    status = acrobot_batch_set_all_params(batch, &params, &error);
    if (status == ACROBOT_ERROR_OUT_OF_RANGE) {
        // dt must be finite and above 0 s, got 0
        printf("%s must be %s, got %g\n", error.name, error.rule, error.value);
    }
    return 0;
}
