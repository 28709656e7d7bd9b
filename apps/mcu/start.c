/* SPDX-License-Identifier: BSD-3-Clause
 * From reset to main on a Cortex-M: initial values, floating point, the exit code. */
#include <stdint.h>

extern uint32_t data_begin[], data_end[], data_in_flash[], bss_begin[], bss_end[], stack_top[];
int main(void);
void start(void);

/* Semihosting: the debugger, or QEMU, does what is asked. */
static uint32_t ask_host(uint32_t what, const void *with)
{
    register uint32_t r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void say(const char *text);
void say(const char *text)
{
    (void)ask_host(0x04, text);
}

static void leave(uint32_t code)
{
    const uint32_t block[2] = {0x20026, code}; /* the program has ended by itself, with this code */
    (void)ask_host(0x20, block);
    for (;;)
        ;
}

static void fault(void)
{
    leave(99);
}

void start(void)
{
    for (uint32_t *to = data_begin, *from = data_in_flash; to < data_end;)
        *to++ = *from++;
    for (uint32_t *to = bss_begin; to < bss_end;)
        *to++ = 0;
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* the floating-point unit on */
    __asm__ volatile("dsb\n isb");
    leave((uint32_t)main());
}

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    stack_top, (void *)start, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault};
