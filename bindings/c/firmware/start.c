// What runs before `main`: vectors, FPU and the sections of RAM. Your board's SDK has its own.

#include "console.h"

// From memory.ld.
extern uint32_t stack_top[], data_in_flash[], data_start[], data_end[], bss_start[], bss_end[];

int main(void);
void reset(void);

static void fault(void)
{
    end_program(2);
    for (;;) {
    }
}

void reset(void)
{
#ifdef __ARM_FP
    // Coprocessor Access Control Register: full access to the FPU, before it is used.
    volatile uint32_t *cpacr = (volatile uint32_t *)0xE000ED88;
    *cpacr |= 0xFu << 20;
    __asm__ volatile("dsb\nisb");
#endif
    for (uint32_t *to = data_start, *from = data_in_flash; to != data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = bss_start; to != bss_end;) {
        *to++ = 0;
    }
    end_program(main());
    fault();
}

union vector {
    uint32_t *stack;
    void (*handler)(void);
};

__attribute__((section(".vectors"), used)) static const union vector vectors[16] = {
    {.stack = stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault},
};
