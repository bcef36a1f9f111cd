// Prints to standard output on a host, and through the debugger on a microcontroller
// (semihosting.c).

#ifndef CONSOLE_H
#define CONSOLE_H

#include <stdint.h>

#if __STDC_HOSTED__
#include <stdio.h>

static inline void print(const char *text)
{
    fputs(text, stdout);
}

static inline void print_number(uint32_t number)
{
    printf("%lu", (unsigned long)number);
}
#else
void print(const char *text);
void print_number(uint32_t number);
// Ends the program with this exit status.
void end_program(int status);
#endif

#endif
