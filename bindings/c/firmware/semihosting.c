// Semihosting: the debugger, here QEMU, prints and ends the program. Without one, print by a UART.

#include "console.h"

// ARM's "Semihosting for AArch32 and AArch64" has these numbers.
enum { SYS_WRITE0 = 0x04, SYS_EXIT_EXTENDED = 0x20, ADP_STOPPED_APPLICATION_EXIT = 0x20026 };

static void call_debugger(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void print(const char *text)
{
    call_debugger(SYS_WRITE0, text);
}

void print_number(uint32_t number)
{
    char digits[11];
    char *first = digits + sizeof digits;
    *--first = 0;
    do {
        *--first = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0);
    print(first);
}

void end_program(int status)
{
    uint32_t block[2] = {ADP_STOPPED_APPLICATION_EXIT, (uint32_t)status};
    call_debugger(SYS_EXIT_EXTENDED, block);
}
