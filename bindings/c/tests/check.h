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

#define INF __builtin_inff()
#define NAN __builtin_nanf("")

#define ACCEPTED(call) CHECK((call) == ACROBOT_OK)
#define REJECTED(error, call) CHECK((call) == ACROBOT_ERROR_##error)

static inline int report(const char *name)
{
    print(name);
    print(failures == 0 ? ": passed\n" : ": FAILED\n");
    return failures == 0 ? 0 : 1;
}

// Also compares the bytes between fields, which nothing writes: valgrind.supp excuses that here.
__attribute__((noinline, unused)) static bool same(const void *left, const void *right, size_t size)
{
    const uint8_t *a = (const uint8_t *)left, *b = (const uint8_t *)right;
    for (size_t i = 0; i < size; i++) {
        if (a[i] != b[i]) {
            return false;
        }
    }
    return true;
}

// What follows the start of a text, or null where it starts in another way.
static inline const char *after(const char *text, const char *start)
{
    while (*start != 0 && *text == *start) {
        text++;
        start++;
    }
    return *start == 0 ? text : NULL;
}

static inline bool same_text(const char *left, const char *right)
{
    const char *rest = after(left, right);
    return rest != NULL && *rest == 0;
}

__attribute__((unused)) static acrobot_error_t error;

// Whether a number was rejected with this message, up to its value.
__attribute__((unused)) static void expect_message(acrobot_status_t status, const char *message)
{
    const char *parts[] = {error.name, " must be ", error.rule, ", got "}, *rest = message;
    CHECK(status == ACROBOT_ERROR_OUT_OF_RANGE);
    for (int i = 0; i < 4 && rest != NULL; i++) {
        rest = after(rest, parts[i]);
    }
    if (rest == NULL) {
        print(message);
        print(" is not what the error says\n");
        failures++;
    }
}

#endif
