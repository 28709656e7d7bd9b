/* SPDX-License-Identifier: BSD-3-Clause
 * The work is integrated here from the forces alone (Gauss), not taken from the library's account. */
#include <stdlib.h>

#include "assertions.h"
#include "internal/friction.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/friction.h"

static const nt_friction soft = {5e9, 0.02, 50e6, 0.3};
static const nt_friction_contact touch = {2e-9, 10e-9};

static nt_friction_state slid(nt_friction_state state, double x, double y)
{
    assert_int_equal(nt_friction_advance(&soft, &state, &touch, (double[2]){x, y}), NT_OK);
    return state;
}

/* Mindlin 1949: 8 a G*; 1/G* = sum (2 - nu)/G. Numbers: E = 70 GPa, nu = 0.25: G = 28 GPa, G* = 8 GPa of a pair. */
static void sticks_as_mindlin_says(void **unused)
{
    (void)unused;
    const nt_material glass = {70e9, 0.25};
    const double G = nt_effective_shear_modulus(glass, glass);
    assert_within(G, 8e9, 1e-15 * 8e9 * 4); /* four roundings */
    const nt_friction friction = {G, 0.0, 1e12, 0.0};
    const nt_friction_contact contact = {3e-9, 0.0};
    nt_friction_state state = {0};
    assert_int_equal(nt_friction_advance(&friction, &state, &contact, (double[2]){1e-12, 0.0}), NT_OK);
    assert_within(-state.force[0] / 1e-12, 8.0 * 3e-9 * 8e9, 1e-12 * 192.0);
    assert_true(state.force[1] == 0.0 && state.dissipated == 0.0);
}

static void adds_the_compliance_of_the_lever(void **unused)
{
    (void)unused;
    const double contact = 8.0 * 2e-9 * 5e9; /* 80 N/m */
    assert_within(1.0 / nt_friction_stiffness(&soft, 2e-9), 1.0 / contact + 0.02, 1e-16);
    assert_true(nt_friction_stiffness(&soft, 0.0) == 0.0);
}

/* There and back by 2 nm: the loop is 2 F_s wide, its area 2 F_s (stroke - 2 F_s/K), each turn sticks for 2 F_s/K. */
static void loop_is_two_limits_wide(void **unused)
{
    (void)unused;
    const double limit = 50e6 * NT_PI * 4e-18 + 3e-9, stroke = 10e-9;
    assert_within(nt_friction_limit(&soft, &touch), limit, 1e-15 * limit);
    const nt_friction_state there = slid((nt_friction_state){0}, stroke, 0.0);
    const nt_friction_state back = slid(there, -stroke, 0.0), again = slid(back, stroke, 0.0);
    assert_within(back.force[0] - there.force[0], 2.0 * limit, 1e-14 * limit);
    const double area = again.work - there.work, stiffness = nt_friction_stiffness(&soft, 2e-9);
    assert_within(area, 2.0 * limit * (stroke - 2.0 * limit / stiffness), 1e-13 * area);
    assert_within(again.dissipated - there.dissipated, area, 1e-13 * area);
}

/* A quarter cycle, from rest to the limit, stores F_s^2/(2 K), all of which comes back at rest. */
static void quarter_cycle_stores_its_energy(void **unused)
{
    (void)unused;
    const double limit = nt_friction_limit(&soft, &touch), stiffness = nt_friction_stiffness(&soft, 2e-9);
    const double reach = 0.999999 * limit / stiffness;
    const nt_friction_state full = slid((nt_friction_state){0}, 0.0, reach), empty = slid(full, 0.0, -reach);
    assert_within(full.work, 0.5 * stiffness * reach * reach, 1e-13 * full.work);
    assert_true(full.dissipated == 0.0 && empty.dissipated == 0.0);
    assert_within(empty.work, 0.0, 1e-13 * full.work);
}

/* Growing: the force stays. Shrinking: the elastic slip stays. Lifted off: nothing is left; all of it is heat. */
static void changing_contact_gives_heat(void **unused)
{
    (void)unused;
    const nt_friction_contact large = {4e-9, 10e-9}, small = {1.5e-9, 10e-9}, none = {0};
    nt_friction_state state = slid((nt_friction_state){0}, 30e-12, 40e-12);
    const double fx = state.force[0], work = state.work;
    assert_int_equal(nt_friction_advance(&soft, &state, &large, (double[2]){0.0, 0.0}), NT_OK);
    assert_true(state.force[0] == fx);
    const double slip = state.force[0] / state.stiffness;
    assert_int_equal(nt_friction_advance(&soft, &state, &small, (double[2]){0.0, 0.0}), NT_OK);
    assert_within(state.force[0] / nt_friction_stiffness(&soft, 1.5e-9), slip, 1e-15 * fabs(slip) * 4);
    assert_int_equal(nt_friction_advance(&soft, &state, &none, (double[2]){1e-9, 0.0}), NT_OK);
    assert_true(state.force[0] == 0.0 && state.stored == 0.0 && state.work == work);
    assert_within(state.dissipated, work, 1e-14 * work);
}

static void refuses_what_is_no_step(void **unused)
{
    (void)unused;
    nt_friction_state state = slid((nt_friction_state){0}, 1e-9, 0.0);
    const double work = state.work, way[2] = {1e-9, 0.0}, nowhere[2] = {NAN, 0.0};
    assert_int_equal(nt_friction_advance(&soft, &state, &(nt_friction_contact){-1e-12, 0.0}, way), NT_E_RANGE);
    assert_int_equal(nt_friction_advance(&soft, &state, &(nt_friction_contact){1e-9, -1e-12}, way), NT_E_RANGE);
    assert_int_equal(nt_friction_advance(&soft, &state, &(nt_friction_contact){NAN, 0.0}, way), NT_E_NOT_FINITE);
    assert_int_equal(nt_friction_advance(&soft, &state, &touch, nowhere), NT_E_NOT_FINITE);
    assert_true(state.work == work);
    nt_problem problem;
    const nt_friction wrong = {5e9, -1.0, 50e6, 0.3}, good = nt_friction_defaults();
    assert_int_equal(nt_friction_check(&wrong, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "lateral_compliance");
    assert_int_equal(nt_friction_check(&good, NULL), NT_OK);
}

typedef struct walk {
    nt_random random;
    nt_friction friction;
    nt_friction_state state;
    double work, turnover; /* integrated here; of its magnitudes */
} walk;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* Force dotted with the way over a straight way, from copies of the state: Gauss, 8 points in each of `pieces`. */
static double gauss_work(const walk *w, const nt_friction_contact *contact, const double way[2], const double ends[2])
{
    static const double node[4] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623};
    static const double weight[4] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                     0.10122853629037626};
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        const double t = i < 4 ? node[i] : -node[i - 4];
        const double share = 0.5 * (ends[0] + ends[1]) + 0.5 * t * (ends[1] - ends[0]);
        nt_friction_state there = w->state;
        const double to[2] = {share * way[0], share * way[1]};
        assert_int_equal(nt_friction_advance(&w->friction, &there, contact, to), NT_OK);
        sum -= weight[i % 4] * (there.force[0] * way[0] + there.force[1] * way[1]);
    }
    return 0.5 * (ends[1] - ends[0]) * sum;
}

/* Where the way begins to slip, as a share of it: by bisection on what the library calls heat. */
static double onset(const walk *w, const nt_friction_contact *contact, const double way[2])
{
    nt_friction_state still = w->state;
    nt_friction_advance(&w->friction, &still, contact, (double[2]){0.0, 0.0});
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high), limit = nt_friction_limit(&w->friction, contact);
        const double px = still.stiffness * middle * way[0] - still.force[0];
        const double py = still.stiffness * middle * way[1] - still.force[1];
        *(hypot(px, py) > limit ? &high : &low) = middle;
    }
    return 0.5 * (low + high);
}

static void walk_on(walk *w)
{
    const double load = nt_random_uniform(&w->random) < 0.1 ? 0.0 : between(&w->random, 1e-11, 1e-7);
    const double radius = nt_random_uniform(&w->random) < 0.1 ? 0.0 : between(&w->random, 1e-10, 1e-8);
    const nt_friction_contact contact = {radius, load};
    const double limit = nt_friction_limit(&w->friction, &contact);
    const double stiffness = nt_friction_stiffness(&w->friction, radius);
    const double reach = stiffness > 0.0 ? limit / stiffness : 1e-10;
    const double length = reach * between(&w->random, 1e-3, 4.0), angle = 2.0 * NT_PI * nt_random_uniform(&w->random);
    const double way[2] = {length * cos(angle), length * sin(angle)}, start = onset(w, &contact, way);
    double work = gauss_work(w, &contact, way, (double[]){0.0, start});
    for (int i = 0; i < 4; ++i)
        work += gauss_work(w, &contact, way,
                           (double[]){start + (1.0 - start) * i / 4.0, start + (1.0 - start) * (i + 1) / 4.0});
    const double heat = w->state.dissipated;
    assert_int_equal(nt_friction_advance(&w->friction, &w->state, &contact, way), NT_OK);
    w->work += work;
    w->turnover += fabs(work);
    assert_true(w->state.dissipated >= heat);
    assert_true(hypot(w->state.force[0], w->state.force[1]) <= limit * (1.0 + 1e-15 * 8));
}

/* 1e-12 of the energy that went to and fro: 40 steps, each with a handful of roundings and a Gauss rule exact to 1e-13
 * (a piece is at most one K/F long). NANOTOUCH_FRICTION_PATHS=100000 is the heavy run. */
static void never_gives_more_than_it_took(void **unused)
{
    (void)unused;
    const char *more = getenv("NANOTOUCH_FRICTION_PATHS");
    const long paths = more ? atol(more) : 1000;
    double worst = 0.0;
    for (long seed = 0; seed < paths; ++seed) {
        walk w = {.random = nt_random_seed((uint64_t)seed)};
        w.friction = (nt_friction){between(&w.random, 1e6, 1e11), between(&w.random, 1e-4, 10.0),
                                   between(&w.random, 1e4, 1e9), between(&w.random, 1e-3, 1.0)};
        for (int i = 0; i < 40; ++i)
            walk_on(&w);
        const double found = w.state.stored + w.state.dissipated;
        worst = larger(worst, fabs(found - w.work) / w.turnover);
        worst = larger(worst, fabs(found - w.state.work) / w.turnover);
    }
    print_message("worst energy balance of %ld paths: %.2g\n", paths, worst);
    assert_true(worst <= 1e-12);
}

/* A way in one step or in 100: the same force and heat, also round a corner. */
static void parts_of_a_way_are_the_whole(void **unused)
{
    (void)unused;
    nt_friction_state whole = slid(slid((nt_friction_state){0}, 1e-9, 0.0), 0.05e-9, 0.4e-9), parts;
    parts = slid((nt_friction_state){0}, 1e-9, 0.0);
    for (int i = 0; i < 100; ++i)
        parts = slid(parts, 0.0005e-9, 0.004e-9);
    const double limit = nt_friction_limit(&soft, &touch); /* 100 roundings */
    assert_within(parts.force[0], whole.force[0], 1e-14 * limit);
    assert_within(parts.force[1], whole.force[1], 1e-14 * limit);
    assert_within(parts.dissipated, whole.dissipated, 1e-13 * whole.dissipated);
}

/* Slipping round a corner beside Runge-Kutta on dp/ds = K (n - (n.p) p/F^2). */
static void turns_as_its_equation_says(void **unused)
{
    (void)unused;
    const double limit = nt_friction_limit(&soft, &touch), stiffness = nt_friction_stiffness(&soft, 2e-9);
    const nt_friction_state from = slid((nt_friction_state){0}, 1e-9, 0.0);
    double t = 0.5 * NT_PI; /* between pull and way */
    const double way = 1.5 * limit / stiffness, step = way * stiffness / limit / 2000;
    for (int i = 0; i < 2000; ++i) {
        const double a = -sin(t), b = -sin(t + 0.5 * step * a), c = -sin(t + 0.5 * step * b), d = -sin(t + step * c);
        t += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    const nt_friction_state to = slid(from, 0.0, way);
    assert_within(-to.force[1], limit * cos(t), 1e-12 * limit); /* 2000 steps of 1e-3: 1e-15 each */
    assert_within(-to.force[0], limit * sin(t), 1e-12 * limit);
}

static void runs_over_arrays(void **unused)
{
    (void)unused;
    const nt_friction_contact contacts[3] = {{2e-9, 1e-8}, {2e-9, 1e-8}, {-1.0, 0.0}};
    const double ways[3][2] = {{1e-9, 0.0}, {0.0, 1e-10}, {0.0, 0.0}};
    nt_friction_state states[3] = {{{0}, 0, 0, 0, 0}, {{0}, 0, 0, 0, 0}, {{0}, 0, 0, 0, -7.0}}, state = {0};
    const nt_friction_path path = {contacts, ways, states, 3};
    assert_int_equal(nt_friction_run_n(&soft, &state, &path), NT_E_RANGE);
    const nt_friction_state expected = slid(slid((nt_friction_state){0}, 1e-9, 0.0), 0.0, 1e-10);
    assert_true(states[1].work == expected.work && state.work == expected.work);
    assert_true(states[2].work == -7.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sticks_as_mindlin_says),        cmocka_unit_test(adds_the_compliance_of_the_lever),
        cmocka_unit_test(loop_is_two_limits_wide),       cmocka_unit_test(quarter_cycle_stores_its_energy),
        cmocka_unit_test(changing_contact_gives_heat),   cmocka_unit_test(refuses_what_is_no_step),
        cmocka_unit_test(never_gives_more_than_it_took), cmocka_unit_test(parts_of_a_way_are_the_whole),
        cmocka_unit_test(turns_as_its_equation_says),    cmocka_unit_test(runs_over_arrays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
