// Prints to standard output on a host, and by semihosting.c on a microcontroller.

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
