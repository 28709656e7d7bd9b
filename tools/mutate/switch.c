/* SPDX-License-Identifier: BSD-3-Clause
 * Linked into every program of a mutated build. NT_MUTANT=17 switches mutant 17 on; NT_REACHED=file gets the numbers of
 * those that the program has passed through. */
#include <stdio.h>
#include <stdlib.h>

#include "switch.h"

int mutant_on;
unsigned char mutant_reached[MUTANTS];

__attribute__((constructor)) static void choose(void)
{
    const char *number = getenv("NT_MUTANT");
    mutant_on = number ? atoi(number) : 0;
}

__attribute__((destructor)) static void report(void)
{
    const char *name = getenv("NT_REACHED");
    FILE *file = name ? fopen(name, "a") : NULL;
    for (int i = 0; file && i < MUTANTS; ++i)
        if (mutant_reached[i])
            fprintf(file, "%d\n", i);
    if (file)
        fclose(file);
}
