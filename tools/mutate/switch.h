/* SPDX-License-Identifier: BSD-3-Clause
 * Before every source of a mutated build. */
#ifndef MUTANT_SWITCH_H
#define MUTANT_SWITCH_H

enum { MUTANTS = 200000 };
extern int mutant_on;
extern unsigned char mutant_reached[MUTANTS];

static inline int mutant_is_on(int number)
{
    mutant_reached[number] = 1;
    return mutant_on == number;
}

#endif
