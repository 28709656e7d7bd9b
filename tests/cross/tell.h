/* SPDX-License-Identifier: BSD-3-Clause
 * Words and numbers from a program, on bare metal too: no printf there. */
#ifndef TESTS_CROSS_TELL_H
#define TESTS_CROSS_TELL_H

#include <stdint.h>

#ifdef NT_BARE_METAL
void say(const char *text);
#else
#include <stdio.h>
static inline void say(const char *text)
{
    (void)fputs(text, stdout);
}
#endif

/* "name 1234", to base 10 or 16. */
static inline void tell(const char *name, uint64_t value, unsigned base)
{
    char digits[24] = {0};
    int at = 22;
    do
        digits[--at] = "0123456789abcdef"[value % base];
    while (value /= base);
    digits[22] = '\n';
    say(name);
    say(digits + at);
}

#endif
