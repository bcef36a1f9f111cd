// The episode of the README, with one step each 200 ms.

#include <zephyr/kernel.h>

#include "acrobot.h"

static acrobot_t acrobot;

int main(void)
{
    acrobot_step_t step;
    uint32_t steps = 0;
    acrobot_status_t status = acrobot_init(&acrobot, 42);

    if (status == ACROBOT_OK) {
        status = acrobot_observe(&acrobot, &step.observation);
    }
    while (status == ACROBOT_OK) {
        // Torque against the velocity of link 1.
        float velocity = step.observation.dtheta1;
        int action = velocity > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
        k_msleep(200);
        status = acrobot_step(&acrobot, action, &step);
        if (status == ACROBOT_OK && (step.terminated || step.truncated)) {
            status = acrobot_elapsed_steps(&acrobot, &steps);
            printk("the episode ended after %u steps\n", (unsigned)steps);
            break;
        }
    }
    if (status != ACROBOT_OK) {
        printk("%s\n", acrobot_status_text(status));
    }
    return 0;
}
