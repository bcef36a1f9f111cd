// The episode of the README, with one step each 200 ms: 94 steps, then the next one.

#include <acrobot.h>

static acrobot_t acrobot;
static acrobot_step_t result;

static void check(acrobot_status_t status) {
  if (status != ACROBOT_OK) {
    Serial.println(acrobot_status_text(status));
    for (;;) {
    }
  }
}

void setup() {
  Serial.begin(115200);
  check(acrobot_init(&acrobot, 42));
  check(acrobot_observe(&acrobot, &result.observation));
}

void loop() {
  // Torque against the velocity of link 1.
  int action = result.observation.dtheta1 > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
  check(acrobot_step(&acrobot, action, &result));
  if (result.terminated || result.truncated) {
    uint32_t steps;
    check(acrobot_elapsed_steps(&acrobot, &steps));
    Serial.print("the episode ended after ");
    Serial.print(steps);
    Serial.println(" steps");
    check(acrobot_reset(&acrobot, &result.observation));
  }
  delay(200);
}
