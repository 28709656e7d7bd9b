/* SPDX-License-Identifier: BSD-3-Clause
 * The program's own malloc and its family stand before the originals, also for the shared libraries. */
#include <errno.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>

#include "failing_heap.h"

static atomic_long failing, asked, blocks, freed; /* freed since the heap is full [byte] */
static atomic_int kind;

void heap_fail(long n, heap_failure failure)
{
    atomic_store(&asked, 0);
    atomic_store(&freed, 0);
    atomic_store(&kind, (int)failure);
    atomic_store(&failing, n);
}

long heap_recover(void)
{
    atomic_store(&failing, 0);
    return atomic_load(&asked);
}

long heap_blocks(void)
{
    return atomic_load(&blocks);
}

#if HEAP_CAN_FAIL

/* The original of a sanitizer, where the program has one, or of glibc. This file itself is built without sanitizers:
 * malloc is called before they are ready. */
#define DECLARE(result, name, ...)                                                                                     \
    __attribute__((weak)) result __interceptor_##name(__VA_ARGS__);                                                    \
    result __libc_##name(__VA_ARGS__);
#define ORIGINAL(name) (__interceptor_##name ? __interceptor_##name : __libc_##name)

DECLARE(void *, malloc, size_t size)
DECLARE(void *, calloc, size_t count, size_t size)
DECLARE(void *, realloc, void *memory, size_t size)
DECLARE(void *, memalign, size_t alignment, size_t size)
DECLARE(void, free, void *memory)

int heap_is_sanitized(void)
{
    return __interceptor_malloc != NULL;
}

/* Takes it from what has been freed, if there is enough of it. */
static int is_full(long size)
{
    if (atomic_fetch_sub(&freed, size) >= size)
        return 0;
    atomic_fetch_add(&freed, size);
    return 1;
}

static int fails(size_t size)
{
    const long number = atomic_fetch_add(&asked, 1) + 1, first = atomic_load(&failing);
    if (first == 0 || number < first)
        return 0;
    const int failure = atomic_load(&kind);
    if (failure == HEAP_ONCE ? number > first : failure == HEAP_FULL && number > first && !is_full((long)size))
        return 0;
    errno = ENOMEM;
    return 1;
}

static void *counted(void *memory)
{
    atomic_fetch_add(&blocks, memory != NULL);
    return memory;
}

static void give_back(void *memory)
{
    const long first = atomic_load(&failing);
    atomic_fetch_sub(&blocks, memory != NULL);
    if (memory && first != 0 && atomic_load(&asked) >= first)
        atomic_fetch_add(&freed, (long)malloc_usable_size(memory));
    ORIGINAL(free)(memory);
}

int posix_memalign(void **memory, size_t alignment, size_t size); /* not of C11 */

#pragma GCC visibility push(default)

void *malloc(size_t size)
{
    return fails(size) ? NULL : counted(ORIGINAL(malloc)(size));
}

void *calloc(size_t count, size_t size)
{
    return fails(count * size) ? NULL : counted(ORIGINAL(calloc)(count, size));
}

void *realloc(void *memory, size_t size)
{
    if (!memory)
        return malloc(size);
    return fails(size) ? NULL : ORIGINAL(realloc)(memory, size);
}

void *memalign(size_t alignment, size_t size)
{
    return fails(size) ? NULL : counted(ORIGINAL(memalign)(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    void *made = memalign(alignment, size);
    if (!made)
        return ENOMEM;
    *memory = made;
    return 0;
}

void free(void *memory)
{
    give_back(memory);
}

#pragma GCC visibility pop

#else

int heap_is_sanitized(void)
{
    return 0;
}

#endif
