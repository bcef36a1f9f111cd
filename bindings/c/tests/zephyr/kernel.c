#include "zephyr/kernel.h"

#include <stdarg.h>

#include "console.h"

void k_msleep(int milliseconds)
{
    (void)milliseconds;
}

// Knows %u and %s.
int printk(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (; *format != 0; format++) {
        char character[2] = {*format, 0};
        if (*format != '%') {
            print(character);
        } else if (*++format == 'u') {
            print_number(va_arg(arguments, unsigned));
        } else {
            print(va_arg(arguments, const char *));
        }
    }
    va_end(arguments);
    return 0;
}
