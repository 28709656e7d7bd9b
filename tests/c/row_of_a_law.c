/* SPDX-License-Identifier: BSD-3-Clause
 * A row of scene/terms/ that compiles whole, and must not without an operation that every law has. */
#include <stddef.h>

#include "scene/terms/term.h"

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)law, (void)scene, (void)capture_gap;
}

static nt_form full_form(const void *law)
{
    (void)law;
    return NT_FORM_OFF;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)law, (void)form, (void)gap;
    return (nt_law_value){0.0, 0.0, 0.0, 0.0};
}

static double hold(const void *law)
{
    (void)law;
    return 0.0;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 1.0, 1.0, "computed"}};

#ifndef FORGOTTEN
NT_TERM_BESIDE(steric, prepare, full_form, eval, hold, NULL, .words = {"steric", "law", "a test", NULL, forms, 1, 0});
#else
NT_TERM_BESIDE(steric, prepare, eval, hold, NULL, .words = {"steric", "law", "a test", NULL, forms, 1, 0});
#endif
