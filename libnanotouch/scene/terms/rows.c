/* SPDX-License-Identifier: BSD-3-Clause
 * The table of all laws, made from the list in scene.h: a law without its row does not link. */
#include <math.h>
#include <stddef.h>

#include "scene/terms/term.h"

#define ROW(ID, name, type) [NT_PLAN_##ID] = &nt_term_##name,
const nt_term_row *const nt_term_rows[NT_PLAN_TERMS] = {ROW(CONTACT, contact, ) NT_TERMS_BESIDE(ROW)
                                                            NT_TERMS_CUSTOM(ROW)};

#define OFFSET(ID, name, type) [NT_PLAN_##ID] = (unsigned)offsetof(nt_plan, laws.name),
const unsigned nt_term_offsets[NT_PLAN_TERMS] = {[NT_PLAN_CONTACT] = 0,
                                                 NT_TERMS_BESIDE(OFFSET) NT_TERMS_CUSTOM(OFFSET)};

#define NAME(ID, name, what) name,
const char *nt_form_name(nt_form form)
{
    static const char *const names[] = {NT_FORMS(NAME)};
    return (unsigned)form < NT_FORM_COUNT ? names[form] : "unknown";
}

static const nt_term_form left_out = {NT_FORM_OFF, 0.0, 0.0, "left out"};

const nt_term_words *nt_term_words_of(int term)
{
    return term >= 0 && term < NT_PLAN_TERMS ? &nt_term_rows[term]->words : NULL;
}

const nt_term_form *nt_term_form_of(const nt_plan *plan, int term, nt_form form)
{
    const nt_term_row *row = nt_term_rows[term];
    if (form == NT_FORM_OFF)
        return &left_out;
    if (row->form_of)
        return row->form_of(nt_term_law(plan, term), form);
    int i = 0;
    while (i < row->words.form_count - 1 && row->words.forms[i].form != form)
        ++i;
    return &row->words.forms[i];
}

nt_law_value nt_plan_term_eval(const nt_plan *plan, int term, double gap)
{
    const nt_law_value none = {0.0, 0.0, 0.0, 0.0};
    if (term < 0 || term >= NT_PLAN_TERMS)
        return (nt_law_value){NAN, NAN, NAN, NAN};
    const nt_form full = nt_plan_full_form(plan, term);
    return full == NT_FORM_OFF ? none : nt_term_rows[term]->eval(nt_term_law(plan, term), full, gap);
}

nt_pressure nt_plan_term_pressure(const nt_plan *plan, int term, double gap)
{
    if (term < 0 || term >= NT_PLAN_TERMS || !nt_term_rows[term]->words.has_pressure)
        return (nt_pressure){NAN, NAN, NAN};
    if (nt_plan_full_form(plan, term) == NT_FORM_OFF)
        return (nt_pressure){0.0, 0.0, 0.0};
    return nt_term_rows[term]->pressure(nt_term_law(plan, term), gap);
}

const char *nt_term_name_of(const nt_plan *plan, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    return row->name_of ? row->name_of(nt_term_law(plan, term)) : row->words.name;
}
