/* SPDX-License-Identifier: BSD-3-Clause
 * The lists of a live session, its staircase and its words (libnanotouch/host/). */
#include <math.h>
#include <string.h>

#include "assertions.h"
#include "host/state.h"
#include "internal/host.h"
#include "nanotouch/advanced/random.h"

static const nt_host_preset *preset_named(const char *name)
{
    int count;
    const nt_host_preset *rows = nt_host_presets(&count);
    for (int i = 0; i < count; ++i)
        if (strcmp(rows[i].name, name) == 0)
            return &rows[i];
    return NULL;
}

static void test_rows_are_whole(void **state)
{
    (void)state;
    for (int i = 0; nt_host_tasks(i); ++i) {
        const nt_host_task *about = nt_host_tasks(i);
        const nt_task *task = nt_task_named(about->name);
        assert_non_null(task);
        assert_non_null(preset_named(about->preset));
        assert_int_equal(preset_named(about->preset)->pushed, about->pushed);
        assert_true(about->title[0] && task->words[0] && task->hides && task->choices);
        assert_non_null(task->solve); /* it is known to be solvable */
        assert_true(!about->asked[0] == !task->answer);
        assert_true(!task->choices[0] == !task->choose);
        assert_true(!about->follows[0] || nt_task_named(about->follows));
        for (int k = 0; k < i; ++k)
            assert_string_not_equal(about->name, nt_host_tasks(k)->name);
    }
    assert_null(nt_task_named("none"));
}

static void test_every_slider_is_a_field(void **state)
{
    (void)state;
    nt_host_kind kind, found;
    for (int i = 0; nt_host_slider_field(i, &kind); ++i) {
        assert_non_null(nt_host_field(nt_host_slider_field(i, NULL), &found));
        assert_int_equal(kind, found);
    }
    const nt_scene scene = nt_scene_defaults();
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_host_slider rows[NT_HOST_SLIDERS];
    const int count = nt_host_sliders(&scene, &rig, &settings, rows);
    assert_true(count > 4);
    for (int i = 0; i < count; ++i)
        for (int part = 0; part <= 20; ++part) {
            const double value = nt_host_slider_at(&rows[i], part / 20.0);
            assert_true(fabs(nt_host_slider_place(&rows[i], value) - part / 20.0) < 0.01); /* three digits */
        }
}

/* An observer with a known psychometric function: the mean threshold over many runs is its 70.7 % point. */
static void test_a_staircase_settles_where_seven_of_ten_are_right(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    double sum = 0.0;
    for (int run = 0; run < 300; ++run) {
        nt_staircase stairs = nt_staircase_begin(3.0, 1.0001, 100.0, 20);
        while (!nt_staircase_done(&stairs)) {
            const double x = log(nt_staircase_ratio(&stairs)) / 0.3;
            nt_staircase_take(&stairs, nt_random_uniform(&random) < 1.0 - 0.5 * exp(-x * x));
        }
        sum += log(nt_staircase_threshold(&stairs));
    }
    const double at = 0.3 * sqrt(-log(2.0 * (1.0 - 0.7071)));
    assert_true(fabs(sum / 300.0 - at) < 0.12 * at);
}

static void test_a_staircase_ends_for_the_perfect_and_for_the_blind(void **state)
{
    (void)state;
    nt_staircase perfect = nt_staircase_begin(3.0, 1.02, 10.0, 8), blind = perfect;
    while (!nt_staircase_done(&perfect))
        nt_staircase_take(&perfect, 1);
    assert_true(fabs(nt_staircase_threshold(&perfect) - 1.02) < 1e-9);
    for (int i = 0; i < 400 && !nt_staircase_done(&blind); ++i)
        nt_staircase_take(&blind, i % 2 == 0);
    assert_true(nt_staircase_ratio(&blind) <= 10.0 * (1.0 + 1e-9));
}

static void test_words_are_as_people_write_them(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *unit, *words;
    } rows[] = {{1.8e-8, "N", "18.0 nN"},    {9.999e-10, "m", "1000 pm"},
                {0.1, "J/m^2", "100 mJ/m²"}, {1.35e11, "Pa", "135 GPa"},
                {0.0, "N", "0 N"},           {-3.2e-9, "m", "-3.20 nm"},
                {(double)NAN, "m", "-"},     {(double)INFINITY, "N/m", "-"},
                {0.25, "", "0.250"}};
    char text[NT_HOST_NAME];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i)
        assert_string_equal(nt_host_digits(rows[i].value, rows[i].unit, 3, text, sizeof text), rows[i].words);
    char small[8];
    nt_text cut = nt_text_in(small, sizeof small);
    nt_text_fill(&cut, "{a} of {b}", (const nt_figure[]){{"a", 0.5, "%", 0}, {"b", 0.0, NULL, "all of it"}, {0}});
    assert_string_equal(small, "50 of a"); /* what does not fit is cut */
    nt_text json = nt_text_in(text, sizeof text);
    nt_json_open(&json, "{");
    nt_json_text(&json, "a\"", "b\\\n");
    nt_json_number(&json, "c", (double)NAN);
    nt_json_close(&json, "}");
    assert_string_equal(text, "{\"a\\\"\":\"b\\\\\\n\",\"c\":null}");
}

static void test_without_a_session_everything_is_refused_in_words(void **state)
{
    (void)state;
    static const char *const asked[] = {"move", "wheel", "press", "change", "undo", "task", "choose", "say", "report"};
    nt_session_host *host = nt_host_init(test_malloc(nt_host_size()));
    char text[NT_HOST_LINE];
    for (size_t i = 0; i < sizeof asked / sizeof *asked; ++i) {
        assert_int_equal(nt_host_ask(host, &(nt_host_asked){asked[i], "x", {0.0, 0.0, 0.0}}), NT_E_STATE);
        assert_true(nt_host_tell(host, text, sizeof text) > 0);
        assert_string_equal(text, "{\"tell\":\"refused\",\"why\":\"nothing is touched yet: lay a sample first\"}");
        assert_int_equal(nt_host_tell(host, text, sizeof text), 0);
    }
    assert_int_equal(nt_host_solve(host, NULL), NT_E_STATE);
    test_free(host);
}

/* A slave that has failed gives frames without numbers: the hand stays where it was. */
static void test_a_hand_resumes_where_it_is_known_to_be(void **state)
{
    (void)state;
    const nt_proxy_facts facts = {.alpha_p = 1e-5,
                                  .alpha_f = 1e6,
                                  .lever = 8.0,
                                  .travel = 0.02,
                                  .axes = 3,
                                  .load = 1e-7,
                                  .limit = 1e-7,
                                  .start_height = 1e-7,
                                  .held = -0.01};
    nt_proxy hand = nt_proxy_begin(&facts);
    nt_frame frame = {
        .master_position = {1e-3, (double)NAN, -5e-3}, .tip_position = {[NT_Z] = (double)NAN}, .gap = (double)NAN};
    nt_proxy_resume(&hand, &frame);
    assert_true(hand.place[NT_X] == 1e-3 && hand.place[NT_Y] == 0.0 && hand.place[NT_Z] == -5e-3);
    assert_true(hand.height == 1e-7);
    frame.tip_position[NT_Z] = 3e-8;
    nt_proxy_resume(&hand, &frame);
    assert_true(hand.height == 3e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_are_whole),
        cmocka_unit_test(test_every_slider_is_a_field),
        cmocka_unit_test(test_a_staircase_settles_where_seven_of_ten_are_right),
        cmocka_unit_test(test_a_staircase_ends_for_the_perfect_and_for_the_blind),
        cmocka_unit_test(test_words_are_as_people_write_them),
        cmocka_unit_test(test_a_hand_resumes_where_it_is_known_to_be),
        cmocka_unit_test(test_without_a_session_everything_is_refused_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
