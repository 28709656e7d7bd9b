/* SPDX-License-Identifier: BSD-3-Clause
 * Goes through kept inputs of a fuzz target, and through changed copies of each: always the same ones. A wrong result
 * aborts. Usage: test_fuzz_x FILE... */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { LONGEST = 4096, COPIES = 8, SPOTS = 4 };

static uint32_t next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void run_changed(const uint8_t *data, size_t size, uint32_t *random)
{
    uint8_t changed[LONGEST];
    memcpy(changed, data, size);
    for (int spot = 0; spot < SPOTS; ++spot)
        changed[next(random) % size] = (uint8_t)next(random);
    (void)LLVMFuzzerTestOneInput(changed, size);
}

int main(int count, char **names)
{
    static uint8_t data[LONGEST];
    uint32_t random = 1;
    if (count < 2)
        return fprintf(stderr, "no kept inputs\n"), 1;
    for (int i = 1; i < count; ++i) {
        FILE *file = fopen(names[i], "rb");
        if (!file)
            return perror(names[i]), 1;
        const size_t size = fread(data, 1, sizeof data, file);
        (void)fclose(file);
        (void)LLVMFuzzerTestOneInput(data, size);
        for (int copy = 0; copy < COPIES && size > 0; ++copy)
            run_changed(data, size, &random);
    }
    return 0;
}
