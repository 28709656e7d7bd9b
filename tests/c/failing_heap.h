/* SPDX-License-Identifier: BSD-3-Clause
 * A heap that fails on demand, for everything in the process: our libraries, libstdc++, libceres. A call under test is
 * repeated with its allocation number n failing, n = 1, 2, ..., until it comes to its end without meeting number n. */
#ifndef FAILING_HEAP_H
#define FAILING_HEAP_H

#ifdef __GLIBC__
#define HEAP_CAN_FAIL 1
#else
#define HEAP_CAN_FAIL 0 /* only glibc and the sanitizers give the original malloc away */
#endif

typedef enum heap_failure {
    HEAP_ONCE, /* allocation number n fails, and no other */
    HEAP_FULL, /* from number n on there is only what is freed after it */
    HEAP_GONE  /* number n fails, and all after it */
} heap_failure;

/* From now on allocation number n = 1, 2, ... fails; 0: none. */
void heap_fail(long n, heap_failure failure);
/* Ends that; returns how many allocations were asked for since heap_fail. */
long heap_recover(void);
/* Blocks that are allocated now, those of the C++ runtime and of other threads included. */
long heap_blocks(void);
/* Whether it stands on that of a sanitizer, which needs memory itself to start a thread. */
int heap_is_sanitized(void);

typedef void heap_new_handler(void);
/* Sets the new handler of C++, in programs with failing_new.cpp; returns the one before. */
heap_new_handler *heap_set_new_handler(heap_new_handler *handler);

#endif
