/* SPDX-License-Identifier: BSD-3-Clause
 * Laws over arrays of 4096, and as many steps of a session, each in a function of its own, for bench_element.py to
 * count the instructions of. */
#include <stdio.h>
#include <stdlib.h>

#include "internal/contact.h"
#include "internal/maugis.h"
#include "nanotouch/advanced/maugis.h"
#include "nanotouch/contact.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"
#include "nanotouch/session.h"

enum { COUNT = 4096, CELLS = 400, CALLS = 4096 };

#if defined(__GNUC__)
#define COUNTED __attribute__((noinline)) static void
#else
#define COUNTED static void
#endif

static double in[COUNT], out[4][COUNT];
static nt_contact contacts[COUNT]; /* one for every element */
static nt_contact_law hertz, jkr, maugis;
static nt_maugis_cell cells[CELLS];
static nt_maugis_table table;
static nt_session *session;

static void over(const nt_contact_law *law, int all)
{
    const nt_strided arrays = {in, all ? out[0] : NULL, out[1], all ? out[2] : NULL, all ? out[3] : NULL, COUNT, 1, 1};
    (void)nt_contact_law_eval_n(law, NT_BRANCH_STABLE, &arrays);
}

COUNTED element_hertz(void)
{
    over(&hertz, 0);
}

COUNTED element_jkr(void)
{
    over(&jkr, 0);
}

COUNTED element_exact(void)
{
    over(&maugis, 0);
}

COUNTED element_exact_values(void)
{
    over(&maugis, 1);
}

COUNTED element_table(void)
{
    (void)nt_maugis_table_force_n(&table, NT_BRANCH_STABLE, in, out[0], COUNT);
}

COUNTED element_table_values(void)
{
    const nt_strided arrays = {in, out[0], out[1], out[2], out[3], COUNT, 1, 1};
    (void)nt_maugis_table_eval_n(&table, NT_TIER_TABLE, NT_BRANCH_STABLE, &arrays);
}

COUNTED element_polished(void)
{
    (void)nt_maugis_table_polish_n(&table, NT_BRANCH_STABLE, in, out[0], COUNT);
}

COUNTED element_scalar_exact(void)
{
    for (int i = 0; i < CALLS; i++) {
        nt_law_value value = {0};
        (void)nt_contact_law_eval(&maugis, in[i], NT_BRANCH_STABLE, &value);
        out[0][i] = value.F;
    }
}

COUNTED element_each_exact(void)
{
    const nt_maugis_bank exact = {.panels = NULL};
    const nt_bank_pairs pairs = {contacts, in, NULL, out[0], NULL, NULL, NULL, COUNT, 1, 1, 1};
    (void)nt_maugis_bank_pairs_n(&exact, NT_BRANCH_STABLE, &pairs);
}

COUNTED element_folds(void)
{
    for (int i = 0; i < CALLS; i++) {
        nt_maugis made = {.lambda = 0.0};
        (void)nt_maugis_init(&made, &contacts[i]);
        out[0][i] = made.folds.pull_off_load;
    }
}

/* As session.step(Input) in Python: an input in every period, and its frame. */
COUNTED element_session_step(void)
{
    const nt_input input = {.operator_force[NT_Z] = 0.5};
    nt_frame frame = {0};
    for (int i = 0; i < CALLS; i++)
        (void)nt_session_step(session, &input, &frame);
    out[0][0] = frame.gap;
}

static nt_status open_session(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.preflight = 0;
    setup.ring_capacity = 0;
    return nt_session_open(&session, &setup, NULL);
}

int main(void)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5};
    if (nt_contact_law_init(&hertz, NT_HERTZ, &contact) != NT_OK ||
        nt_contact_law_init(&jkr, NT_JKR, &contact) != NT_OK ||
        nt_contact_law_init(&maugis, NT_MAUGIS, &contact) != NT_OK ||
        nt_maugis_table_init(&table, &maugis.maugis, NULL, cells, CELLS) != NT_OK || open_session() != NT_OK)
        return 1;
    unsigned random = 1;
    for (int i = 0; i < COUNT; i++) {
        random = random * 1664525u + 1013904223u;
        in[i] = -0.9 + 10.0 * (double)(random >> 8) / 16777216.0;
        contacts[i] = (nt_contact){1.0, 0.75, 1.0 / NT_PI, 0.01 + 0.01 * (double)(i * 37 % COUNT)};
    }
    void (*const all[])(void) = {element_hertz,      element_jkr,          element_exact,       element_exact_values, //
                                 element_table,      element_table_values, element_polished,    element_scalar_exact,
                                 element_each_exact, element_folds,        element_session_step};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        all[i]();
    nt_session_close(session);
    printf("%g\n", out[0][COUNT / 2]);
    return 0;
}
