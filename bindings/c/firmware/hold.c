// Holds the acrobot upright with a motor of 10 N m, 100 times a second.

#include "acrobot.h"
#include "console.h"

static const acrobot_state_t UPRIGHT = {3.1415927f, 0, 0, 0}, LEANING = {3.1f, 0, 0, 0};
static const acrobot_weights_t WEIGHTS = {{{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}}, 1};
static const float LIMIT = 10;

static acrobot_t acrobot; // stands for the machine

int main(void)
{
    acrobot_params_t params;
    acrobot_state_t state = LEANING, x = LEANING;
    acrobot_lqr_t lqr;
    acrobot_step_t step;
    acrobot_status_t status = acrobot_init(&acrobot, 0);

    if (status == ACROBOT_OK) {
        status = acrobot_params(&acrobot, &params);
    }
    if (status == ACROBOT_OK) {
        params.dt = .01f;
        status = acrobot_set_params(&acrobot, &params, NULL);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_regulator(&params, &UPRIGHT, 0, &WEIGHTS, &lqr, NULL);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_set_state(&acrobot, &LEANING, NULL);
    }
    for (int tick = 0; tick < 1000 && status == ACROBOT_OK; tick++) {
        status = acrobot_deviation_from(&state, &UPRIGHT, &x, NULL);
        float torque = -(lqr.gain.theta1 * x.theta1 + lqr.gain.theta2 * x.theta2 +
                         lqr.gain.dtheta1 * x.dtheta1 + lqr.gain.dtheta2 * x.dtheta2);
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
    print("the acrobot stands upright after 10 s\n");
    return 0;
}
