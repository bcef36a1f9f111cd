// Prints: through the debugger on a microcontroller (semihosting.c), to standard output on a host (host/console.c).

#ifndef CONSOLE_H
#define CONSOLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

void print(const char *text);
void print_number(uint32_t number);

#ifdef __cplusplus
}
#endif

#endif
