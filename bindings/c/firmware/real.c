// Identifies a machine, and swings it up from what its encoders count.

#include "acrobot.h"
#include "console.h"

#define TURN 6.2831853f
#define COUNTS 4096
#define SAMPLES 500
#define DT .002f

// What the machine is, and what its drawings say: the masses are wrong, and there is no friction.
static const acrobot_params_t TRUTH = {
    .2f, .3f, .523f, .626f, .2f, .256f, .011f, .0099f, 9.81f, DT, 12.57f, 28.27f, {0, 0, 0}, 0,
    .001f, .001f, .16f, .12f, 0, ACROBOT_DYNAMICS_BOOK,
};
static const acrobot_params_t DRAWN = {
    .2f, .3f, .4f, .8f, .2f, .256f, .01f, .01f, 9.81f, DT, 12.57f, 28.27f, {0, 0, 0}, 0,
    0, 0, 0, 0, 0, ACROBOT_DYNAMICS_BOOK,
};
static const acrobot_state_t UPRIGHT = {3.1415927f, 0, 0, 0};

static acrobot_t machine; // stands for encoders and motor
static acrobot_state_t state;
static int32_t counts[2];

static acrobot_status_t drive(float torque)
{
    acrobot_step_t step;
    acrobot_status_t status = acrobot_step_torque(&machine, torque, &step, NULL);
    if (status == ACROBOT_OK) {
        status = acrobot_state(&machine, &state);
    }
    counts[0] = (int32_t)(state.theta1 / TURN * COUNTS);
    counts[1] = (int32_t)(state.theta2 / TURN * COUNTS);
    return status;
}

// Shakes the machine for 1 s, and adds that to the regression.
static acrobot_status_t record(acrobot_regression_t *regression, int begin)
{
    static acrobot_sample_t samples[SAMPLES];
    acrobot_status_t status = ACROBOT_OK;
    for (int tick = 0; tick < SAMPLES && status == ACROBOT_OK; tick++) {
        const float torque = (begin + tick) % 150 < 75 ? 2 : -2;
        samples[tick].angles[0] = (double)counts[0] / COUNTS * (double)TURN;
        samples[tick].angles[1] = (double)counts[1] / COUNTS * (double)TURN;
        samples[tick].torques[1] = (double)torque;
        status = drive(torque);
    }
    if (status == ACROBOT_OK) {
        // Velocities from 5 angles, and windows of 0.5 s.
        status = acrobot_regression_add(regression, samples, SAMPLES, DT, 9.81, 2, 250, NULL);
    }
    return status;
}

static acrobot_status_t identify(acrobot_params_t *params)
{
    static acrobot_regression_t regression;
    static acrobot_fit_t fit;
    acrobot_status_t status = acrobot_regression_init(&regression);
    for (int second = 0; second < 4 && status == ACROBOT_OK; second++) {
        status = record(&regression, second * SAMPLES);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_regression_fit(&regression, &fit);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_fit_params(&fit, &DRAWN, params, NULL);
    }
    return status;
}

int main(void)
{
    static acrobot_controller_t controller;
    static acrobot_replanner_t replanner;
    acrobot_settings_t settings = {DRAWN, 6, {COUNTS, COUNTS}, 0, 1};
    acrobot_state_t x = UPRIGHT;
    float torque;
    acrobot_status_t status = acrobot_init(&machine, 0);

    if (status == ACROBOT_OK) {
        status = acrobot_set_params(&machine, &TRUTH, NULL);
    }
    if (status == ACROBOT_OK) {
        status = identify(&settings.params);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_controller_init(&controller, &settings, NULL);
    }
    if (status == ACROBOT_OK) {
        status = acrobot_replanner_init(&replanner, &settings, NULL);
    }
    for (int tick = 0; tick < 5000 && status == ACROBOT_OK; tick++) {
        // In a timer's interrupt, every 2 ms:
        status = acrobot_controller_tick(&controller, counts[0], counts[1], &torque, NULL);
        if (status == ACROBOT_OK) {
            status = drive(torque);
        }
        // In the main loop, which takes some ticks:
        if (tick % 10 == 0 && status == ACROBOT_OK) {
            status = acrobot_replanner_exchange(&replanner, &controller); // without interrupts
            if (status == ACROBOT_OK) {
                status = acrobot_replanner_work(&replanner);
            }
        }
    }
    if (status == ACROBOT_OK) {
        status = acrobot_deviation_from(&state, &UPRIGHT, &x, NULL);
    }
    if (status != ACROBOT_OK || x.theta1 > .1f || x.theta1 < -.1f) {
        print(status == ACROBOT_OK ? "the acrobot fell" : acrobot_status_text(status));
        print("\n");
        return 1;
    }
    print("the acrobot is upright after 10 s\n");
    return 0;
}
