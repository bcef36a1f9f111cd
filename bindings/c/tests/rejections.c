// The rejected calls of tests/data/rejections.jsonl, which all languages share.

#include "check.h"

#define INF __builtin_inff()
#define NAN __builtin_nanf("")

static acrobot_t acrobot;

// What the rows change, and where the functions write.
static acrobot_params_t defaults, params;
static acrobot_state_t state;
static struct {
    double low, high;
} bounds;
static acrobot_draws_t draws;
static acrobot_step_t step;
static acrobot_error_t error;

static void set(acrobot_draw_t *draw, int kind, float low, float high, float mean, float deviation)
{
    draw->kind = kind;
    draw->low = low;
    draw->high = high;
    draw->mean = mean;
    draw->standard_deviation = deviation;
}

// Whether the call was rejected with this message, which ends with the value.
static void expect(acrobot_status_t status, const char *message)
{
    const char *parts[] = {error.name, " must be ", error.rule, ", got "};
    CHECK(status == ACROBOT_ERROR_OUT_OF_RANGE);
    for (int i = 0; i < 4; i++) {
        for (const char *part = parts[i]; *part != 0; part++, message++) {
            if (*part != *message) {
                print(message);
                print(" is not what the error says\n");
                failures++;
                return;
            }
        }
    }
}

#define params_rejects(message, set) \
    params = defaults; \
    set; \
    expect(acrobot_set_params(&acrobot, &params, &error), message);
#define state_rejects(message, set) \
    state.theta1 = state.theta2 = state.dtheta1 = state.dtheta2 = 0; \
    set; \
    expect(acrobot_set_state(&acrobot, &state, &error), message);
#define torque_rejects(message, torque) \
    expect(acrobot_step_torque(&acrobot, torque, &step, &error), message);
#define bounds_rejects(message, set) \
    set; \
    expect(acrobot_reset_within(&acrobot, bounds.low, bounds.high, NULL, &error), message);
#define draw_rejects(message, kind, mean, deviation, low, high) \
    set(&draws.mass2, ACROBOT_DRAW_##kind, low, high, mean, deviation); \
    expect(acrobot_draw_params(&acrobot, &draws, &error), message);
#define action_rejects(message, action) \
    REJECTED(UNKNOWN_ACTION, acrobot_step(&acrobot, action, &step));

int main(void)
{
    acrobot_t before;
    ACCEPTED(acrobot_init(&acrobot, 42));
    ACCEPTED(acrobot_params(&acrobot, &defaults));
    before = acrobot;
#include "rejections.h"
    CHECK(same(&acrobot, &before, sizeof before));
    return report("rejections");
}
