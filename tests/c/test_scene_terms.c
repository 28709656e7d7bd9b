/* SPDX-License-Identifier: BSD-3-Clause
 * Every row of scene/terms/: it is whole, its law is a potential that falls beyond any gap, its flats are those of its
 * sphere by Derjaguin's relation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "larger.h"
#include "scene/terms/term.h"

#define PI 3.14159265358979323846

static nt_plan plans[NT_MEDIUM_LIQUID + 1]; /* each takes a second */
static nt_plan *plan;                       /* the one that was made last */
static nt_custom_term last;                 /* in the last place of laws of one's own */

static nt_law_value push(const void *context, double gap)
{
    (void)context;
    const double F = 1e-7 * exp(-gap / 3e-9);
    return (nt_law_value){.U = 3e-9 * F, .F = F, .k = F / 3e-9};
}

static double bound_of_push(const void *context, double gap)
{
    return push(context, gap).F;
}

/* A blunt tip with all the forces that its medium lets it have. */
static void make(nt_medium_kind kind)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 1e-4;
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13; /* nothing that is looked at here deforms */
    scene.tip.surface_potential = 0.02;
    scene.sample.surface_potential = 0.013;
    scene.sample.charge = 1e-18;
    scene.medium.kind = kind;
    scene.medium.relative_humidity = 0.0;
    scene.medium.ionic_strength = 10.0;
    scene.medium.hydration_energy = 3e-3;
    scene.medium.brush_thickness = 12e-9;
    scene.medium.yukawa_energy = 1e-3;
    scene.medium.yukawa_length = 3e-9;
    scene.adhesion.hamaker_constant = 2e-21;
    scene.adhesion.contact_potential = 0.3;
    scene.custom[NT_CUSTOM_TERMS - 1] = last;
    const nt_plan_inputs inputs = {.scene = &scene};
    plan = &plans[kind];
    if (plan->cost == 0.0)
        assert_int_equal(nt_plan_make(plan, &inputs, NULL), NT_OK);
}

static int is_said(const char *text)
{
    return text && text[0] != '\0';
}

static const char *const ids[NT_PLAN_TERMS] = {
#define ID_OF(ID, name, type) [NT_PLAN_##ID] = #name,
    ID_OF(CONTACT, contact, ) NT_TERMS_BESIDE(ID_OF) NT_TERMS_CUSTOM(ID_OF)};

/* What a row has to have, by the name of its file and of what it lacks. */
#define HAS(term, what, holds)                                                                                         \
    do {                                                                                                               \
        if (!(holds))                                                                                                  \
            fail_msg("scene/terms: the row nt_term_%s lacks %s", ids[term], what);                                     \
    } while (0)

static void has_words(int term)
{
    const nt_term_row *row = nt_term_rows[term];
    const nt_term_words *words = nt_term_words_of(term);
    HAS(term, ".words: name", is_said(words->name));
    HAS(term, ".words: title", is_said(words->title));
    HAS(term, ".words: doc", is_said(words->doc));
    HAS(term, ".words: forms", words->form_count > 0 && words->form_count <= 32);
    for (int i = 0; i < words->form_count; i++) {
        HAS(term, "a form of .words.forms", words->forms[i].form != NT_FORM_OFF);
        HAS(term, "the cost of a form", words->forms[i].cost > 0.0);
        HAS(term, "the latency of a form", words->forms[i].latency > 0.0);
        HAS(term, "the words of a form", is_said(words->forms[i].words));
    }
    HAS(term, ".words: has_pressure, as it has a pressure or none", !words->has_pressure == !row->pressure);
    HAS(term, ".noun, with which a soft sample is refused", !row->pressure || is_said(row->noun));
    for (int other = 0; other < term; other++)
        HAS(term, "a name of its own", strcmp(words->name, nt_term_words_of(other)->name) != 0);
}

static void every_row_is_whole(void **state)
{
    (void)state;
    for (int term = 0; term < NT_PLAN_TERMS; term++) {
        const nt_term_row *row = nt_term_rows[term];
        has_words(term);
        HAS(term, "full_form or eval", row->full_form && row->eval);
        HAS(term, "prepare or .tabulate", row->offer || row->prepare || row->tabulate);
        HAS(term, "hold", row->offer || row->hold);
        HAS(term, "the rule for laws beside contact: .offer is contact's", !row->offer || term == NT_PLAN_CONTACT);
        HAS(term, ".advance, as it has a state or none", !row->advance == (row->state_size == 0));
    }
    assert_null(nt_term_words_of(-1));
    assert_null(nt_term_words_of(NT_PLAN_TERMS));
}

/* Every law has been seen that a scene can have beside contact, those of one's own apart. */
static void assert_all_seen(int seen)
{
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_CUSTOM_1; term++)
        if (!(seen & 1 << term))
            fail_msg("%s: no scene of `make`, above, has this law: a line there gives it",
                     nt_term_words_of(term)->name);
}

/* Words and cost of a form are those of the form, and of no other. */
static void assert_form_is_listed(int term)
{
    const nt_form full = nt_plan_full_form(plan, term);
    HAS(term, "its fullest form in .words.forms", nt_term_form_of(plan, term, full)->form == full);
}

/* F = -dU/dh and k = -dF/dh by differences; no larger gap exceeds the limit; held inside. */
static void every_law_is_a_potential_within_its_limit(void **state)
{
    (void)state;
    int seen = 0;
    for (int kind = NT_MEDIUM_VACUUM; kind <= NT_MEDIUM_LIQUID; kind++) {
        make((nt_medium_kind)kind);
        for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; term++) {
            if (nt_plan_full_form(plan, term) == NT_FORM_OFF)
                continue;
            const double hold = nt_plan_hold_gap(plan, term);
            seen |= 1 << term;
            assert_form_is_listed(term);
            for (double gap = 1.1 * hold; gap < 10e-9; gap *= 1.3) {
                const double step = 1e-4 * gap;
                const nt_law_value less = nt_plan_term_eval(plan, term, gap - step);
                const nt_law_value here = nt_plan_term_eval(plan, term, gap);
                const nt_law_value more = nt_plan_term_eval(plan, term, gap + step);
                assert_true(fabs((less.U - more.U) / (2.0 * step) - here.F) < 1e-5 * fabs(here.F));
                assert_true(fabs((less.F - more.F) / (2.0 * step) - here.k) < 1e-5 * fabs(here.k));
                assert_true(fabs(here.F) <= nt_plan_law_limit(plan, term, 0.9 * gap, NT_QUANTITY_FORCE));
                assert_true(fabs(here.k) <= nt_plan_law_limit(plan, term, 0.9 * gap, NT_QUANTITY_STIFFNESS));
            }
            assert_true(nt_plan_term_eval(plan, term, 0.1 * hold).F == nt_plan_term_eval(plan, term, hold).F);
        }
    }
    assert_all_seen(seen);
}

/* W = F/(2 pi R) of a sphere much larger than the gap, p = -dW/dh, and the slope of p. */
static void flats_are_those_of_the_sphere(void **state)
{
    (void)state;
    int seen = 0;
    for (int kind = NT_MEDIUM_VACUUM; kind <= NT_MEDIUM_LIQUID; kind++) {
        make((nt_medium_kind)kind);
        for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; term++) {
            if (nt_plan_full_form(plan, term) == NT_FORM_OFF || !nt_term_words_of(term)->has_pressure)
                continue;
            ++seen;
            for (double gap = 1e-9; gap < 8e-9; gap *= 1.2) {
                const double step = 1e-4 * gap, W = nt_plan_term_eval(plan, term, gap).F / (2.0 * PI * 1e-4);
                const nt_pressure less = nt_plan_term_pressure(plan, term, gap - step);
                const nt_pressure here = nt_plan_term_pressure(plan, term, gap);
                const nt_pressure more = nt_plan_term_pressure(plan, term, gap + step);
                assert_true(fabs(here.energy / W - 1.0) < 1e-3); /* gap/R */
                assert_true(fabs((less.energy - more.energy) / (2.0 * step) / here.pressure - 1.0) < 1e-5);
                assert_true(fabs((more.pressure - less.pressure) / (2.0 * step) / here.slope - 1.0) < 1e-5);
            }
        }
    }
    assert_true(seen >= 5);
    assert_true(isnan(nt_plan_term_pressure(plan, NT_PLAN_CONTACT, 1e-9).pressure));
    assert_true(isnan(nt_plan_term_pressure(plan, NT_PLAN_CHARGE, 1e-9).pressure));
    assert_true(nt_plan_term_pressure(plan, NT_PLAN_ELECTROSTATIC, 1e-9).pressure == 0.0); /* not in a liquid */
}

/* All terms beside contact together: the sum of each alone, those last in the list, which only push, too. */
static void what_is_beside_contact(void **state)
{
    (void)state;
    int seen = 0;
    last = (nt_custom_term){.name = "push", .law = push, .bound = bound_of_push};
    memset(plans, 0, sizeof plans);
    for (int kind = NT_MEDIUM_AIR; kind <= NT_MEDIUM_LIQUID; kind++) {
        make((nt_medium_kind)kind);
        for (double gap = -1e-9; gap < 20e-9; gap += 0.7e-9) {
            double sum = 0.0, largest = 0.0;
            for (int term = NT_PLAN_TERMS - 1; term > NT_PLAN_CONTACT; term--) {
                const double F = nt_plan_term_eval(plan, term, gap).F;
                seen |= (F != 0.0) << term;
                sum += F;
                largest = larger(largest, fabs(F));
            }
            assert_true(fabs(nt_plan_beside_at(plan, gap).F - sum) <= 1e-14 * largest);
        }
    }
    assert_all_seen(seen);
    assert_true(seen & 1 << (NT_PLAN_TERMS - 1)); /* and `last` */
}

/* A term alone, whether the plan has it or not. */
static void one_term_alone(void **state)
{
    (void)state;
    make(NT_MEDIUM_VACUUM);
    assert_true(nt_plan_term_eval(plan, NT_PLAN_VDW, 2e-9).F == nt_vdw_eval(&plan->laws.vdw.sphere, 2e-9).F);
    assert_true(nt_plan_term_eval(plan, NT_PLAN_HYDRATION, 2e-9).F == 0.0);
    assert_true(isnan(nt_plan_term_eval(plan, NT_PLAN_TERMS, 2e-9).F));
    assert_true(nt_plan_term_eval(plan, NT_PLAN_CONTACT, -1e-6).F > 0.0);
}

/* Every form of contact that can be offered has its own words and cost: all but those of laws beside contact, and the
 * exact one, which is only measured by. */
static void every_form_of_contact_has_its_row(void **state)
{
    (void)state;
    static const nt_form others[] = {NT_FORM_ON, NT_FORM_DERJAGUIN, NT_FORM_SPHERE, NT_FORM_TIP, NT_FORM_EXACT};
    make(NT_MEDIUM_VACUUM);
    for (int form = NT_FORM_OFF; form < NT_FORM_COUNT; form++) {
        int is_other = 0;
        for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
            is_other |= form == (int)others[i];
        if (!is_other && (int)nt_term_form_of(plan, NT_PLAN_CONTACT, (nt_form)form)->form != form)
            fail_msg("scene/terms/contact.c: `row_of` and `forms` do not give the form %s its row",
                     nt_form_name((nt_form)form));
    }
    assert_string_equal(nt_form_name((nt_form)NT_FORM_COUNT), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_is_whole),
        cmocka_unit_test(every_law_is_a_potential_within_its_limit),
        cmocka_unit_test(flats_are_those_of_the_sphere),
        cmocka_unit_test(what_is_beside_contact),
        cmocka_unit_test(one_term_alone),
        cmocka_unit_test(every_form_of_contact_has_its_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
