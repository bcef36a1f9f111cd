// Changes parameters, and prints why one is rejected.

#include <stdio.h>

#include "acrobot.h"

int main(void)
{
    static acrobot_t acrobot;
    acrobot_params_t params;
    acrobot_error_t error;
    acrobot_status_t status = acrobot_init(&acrobot, 42);

    if (status == ACROBOT_OK) {
        status = acrobot_params(&acrobot, &params);
    }
    if (status != ACROBOT_OK) {
        fprintf(stderr, "%s\n", acrobot_status_text(status));
        return 1;
    }
    params.dt = 0;
    status = acrobot_set_params(&acrobot, &params, &error);
    if (status == ACROBOT_ERROR_OUT_OF_RANGE) {
        // dt must be finite and above 0 s, got 0
        printf("%s must be %s %s, got %g\n", error.name, error.rule, error.unit, error.value);
    }
    return 0;
}
