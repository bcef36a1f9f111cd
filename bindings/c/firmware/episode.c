// The episode of the README, on a Cortex-M4F.

#include "acrobot.h"
#include "console.h"

static acrobot_t acrobot; // env = gym.make("Acrobot-v1")

int main(void)
{
    acrobot_step_t step;
    uint32_t steps = 0;
    acrobot_status_t status = acrobot_init(&acrobot, 0);

    if (status == ACROBOT_OK) {
        status = acrobot_reset_with_seed(&acrobot, 42, &step.observation); // env.reset(seed=42)
    }
    while (status == ACROBOT_OK) {
        // Torque against the velocity of link 1.
        float velocity = step.observation.dtheta1;
        int action = velocity > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
        status = acrobot_step(&acrobot, action, &step);
        if (status == ACROBOT_OK && (step.terminated || step.truncated)) {
            break;
        }
    }
    if (status == ACROBOT_OK) {
        status = acrobot_elapsed_steps(&acrobot, &steps);
    }
    if (status != ACROBOT_OK) {
        print(acrobot_status_text(status));
        print("\n");
        return 1;
    }
    print("the episode ended after ");
    print_number(steps);
    print(" steps\n");
    return 0;
}
