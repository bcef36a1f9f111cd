// Checks that name the line which fails.

#ifndef CHECK_H
#define CHECK_H

#include "acrobot.h"
#include "console.h"

static int failures = 0;

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            print(__FILE__ ":"); \
            print_number(__LINE__); \
            print(": " #condition "\n"); \
            failures++; \
        } \
    } while (0)

static inline int report(const char *name)
{
    print(name);
    print(failures == 0 ? ": passed\n" : ": FAILED\n");
    return failures == 0 ? 0 : 1;
}

#endif
