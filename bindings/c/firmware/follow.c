// Follows a plan that Python has written, without a planner: swings up, and then holds upright by
// the gain of a regulator, which also comes from there.

#include "acrobot.h"
#include "console.h"
#include "plan.h"

static const acrobot_state_t UPRIGHT = {3.1415927f, 0, 0, 0};
static const float LIMIT = 10; // N m; a fifth is for corrections

static acrobot_t acrobot; // stands for the machine

int main(void)
{
    const size_t length = sizeof KNOTS / sizeof *KNOTS;
    acrobot_state_t state = {0, 0, 0, 0}, x = UPRIGHT;
    acrobot_step_t step;
    acrobot_status_t status = acrobot_init(&acrobot, 0);

    if (status == ACROBOT_OK) {
        status = acrobot_set_params(&acrobot, &PARAMS, NULL);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_set_state(&acrobot, &state, NULL);
    }
    for (size_t tick = 0; tick < 200 && status == ACROBOT_OK; tick++) {
        float torque = 0;
        status = acrobot_deviation_from(&state, &UPRIGHT, &x, NULL);
        if (tick >= length) {
            torque = -(GAIN[0] * x.theta1 + GAIN[1] * x.theta2 + GAIN[2] * x.dtheta1 +
                       GAIN[3] * x.dtheta2);
        } else if (status == ACROBOT_OK) {
            status = acrobot_plan_torque(KNOTS, length, &AFTER, tick, &state, &torque, NULL);
        }
        torque = torque > LIMIT ? LIMIT : torque < -LIMIT ? -LIMIT : torque;
        if (status == ACROBOT_OK) {
            status = acrobot_step_torque(&acrobot, torque, &step, NULL);
        }
        if (status == ACROBOT_OK) {
            status = acrobot_state(&acrobot, &state);
        }
    }
    if (status != ACROBOT_OK || x.theta1 > .001f || x.theta1 < -.001f) {
        print(status == ACROBOT_OK ? "the acrobot fell" : acrobot_status_text(status));
        print("\n");
        return 1;
    }
    print("upright after 10 s\n");
    return 0;
}
