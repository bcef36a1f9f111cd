// The header alone, and a batch aligned as each standard does it.

#include "acrobot.h"

#if defined(__cplusplus)
#define ALIGNED alignas
#elif __STDC_VERSION__ >= 201112L
#define ALIGNED _Alignas
#else
#define ALIGNED ACROBOT_ALIGNED
#endif

extern uint8_t memory[ACROBOT_BATCH_SIZE(3)];
ALIGNED(ACROBOT_BATCH_ALIGN) uint8_t memory[ACROBOT_BATCH_SIZE(3)];
extern uint8_t bytes[ACROBOT_SIZE];
ALIGNED(ACROBOT_ALIGN) uint8_t bytes[ACROBOT_SIZE];
