/* SPDX-License-Identifier: BSD-3-Clause
 * The tables of a sample that deforms for all effective radii of a surface: each that of a flat, made for its radius.
 * Half of them first; what the others differ by from what lies between those is measured, and the bound has half of
 * it, since of four points each half as far apart a cubic errs by an eighth. */
#include <math.h>

#include "scene/deformation/cubic.h"
#include "scene/terms/term.h"

#define APART 0.7 /* of ln R: the first tables, at most */
#define LEAST 0.01
#define FAR 2.0      /* times how far a fold is from where it should be: nearer to it nothing is compared */
#define HALVED 0.5   /* of the error, by half the step, at most */
#define DEEPER 1.02  /* than the largest load */
#define WORST 10.0   /* times the error that will do: what a looser demand may bring */
#define STEEPEST 2.0 /* power of the radius with which a force at one gap grows, at most */

enum { CELLS = 2, OF_EACH = 2, NEARER = 5 }; /* at least so many; samples of each cell of a table; bisections */

/* In the making. */
typedef struct relief_maker {
    nt_plan *plan;
    const nt_scene *scene;
    nt_deform_wanted of;
    nt_deform_worst *worst;
    double work;      /* that a measured pull-off force has [J/m^2]; 0: that of the scene */
    double low, high; /* radii between which tables are alike [m] */
    double missing;   /* a radius that has none like them [m] */
    const nt_deform_table *like;
} relief_maker;

static int is_like(const nt_deform_table *one, const nt_deform_table *other)
{
    return one->jumps == other->jumps && one->holds == other->holds && !isinf(one->touch) == !isinf(other->touch);
}

/* The table of a radius, in the room; what its plan comes to counts among the worst. */
static nt_status make_one(relief_maker *m, double radius, int slot)
{
    nt_plan at;
    nt_plan_copy(&at, m->plan);
    at.ratio = radius / m->plan->contact.radius;
    at.surface = NULL;
    at.radii = at.followed = NULL;
    at.relief.count = 0;
    at.deformation.count = at.deformation.holds = 0;
    nt_status status = nt_plan_laws_at(&at, m->scene, m->work, NULL);
    if (status == NT_OK)
        status = nt_plan_deform_table(&at, m->scene, &m->of);
    if (status == NT_OK)
        status = nt_plan_deform_compose(&at, m->scene, m->work);
    if (status != NT_OK || (m->like && !is_like(&at.deformation, m->like))) {
        m->missing = radius;
        return NT_E_RANGE;
    }
    m->plan->relief.room[slot] = at.deformation;
    m->worst->pull_off_force = fmax(m->worst->pull_off_force, at.pull_off_force);
    m->worst->minimum_spring = fmax(m->worst->minimum_spring, at.minimum_spring);
    m->worst->maximum_stiffness = fmax(m->worst->maximum_stiffness, at.maximum_stiffness);
    m->worst->moved = fmax(m->worst->moved, at.deformation.jump_error);
    m->low = fmin(m->low, radius);
    m->high = fmax(m->high, radius);
    return NT_OK;
}

static double radius_of(const nt_deform_relief *relief, double index)
{
    return relief->first * exp(index * relief->step);
}

/* From the tip's own radius outwards, so that all radii between two that are known are known. */
static nt_status make_first(relief_maker *m)
{
    nt_deform_relief *relief = &m->plan->relief;
    const int count = relief->count;
    int up = 0;
    while (up < count && radius_of(relief, up) < m->plan->contact.radius)
        ++up;
    for (int down = up - 1; down >= 0 || up < count;) {
        const int next = down >= 0 ? down-- : up++;
        if (make_one(m, radius_of(relief, next), next) != NT_OK)
            return NT_E_RANGE;
        relief->table[next] = &relief->room[next];
    }
    return NT_OK;
}

/* Where the bodies touch anywhere at the largest load, tables of all radii go on to where they do; those of the least
 * touch first. With adhesion that of the tip's own radius must have a contact. */
static nt_status begin(relief_maker *m)
{
    nt_deform_relief *relief = &m->plan->relief;
    const int adheres = m->plan->source != NT_ADHESION_NONE;
    m->like = adheres ? &m->plan->deformation : NULL;
    const nt_status status = make_one(m, adheres ? m->plan->contact.radius : relief->first, 0);
    if (adheres)
        return status;
    m->of.touches = status == NT_OK && !isinf(relief->room[0].touch);
    m->like = relief->room;
    return status;
}

/* --- What lies between tables --- */

static double over(double error, double value, double scale)
{
    return fabs(error) / fmax(fabs(value), scale);
}

static double difference(const nt_plan *plan, const nt_deform_wanted *of, const nt_law_value *found,
                         const nt_law_value *truth)
{
    if (plan->quantity == NT_QUANTITY_STIFFNESS)
        return over(found->k - truth->k, truth->k, plan->scale);
    const double error = over(found->F - truth->F, truth->F, plan->scale);
    return of->radius_scale > 0.0 ? fmax(error, over(found->a - truth->a, truth->a, of->radius_scale)) : error;
}

/* The gap of the plan that a place in a cell of a table is [m]. */
static double gap_of(const nt_deform_table *table, int part, double v)
{
    if (part == 0)
        return table->hold - v;
    if (part < 0)
        return table->hold + table->touch + v * v;
    return (table->holds ? table->release : table->touch) - v * v;
}

/* Without adhesion laws are held over a distance where the bodies touch, at either end of which the stiffness jumps. */
static int near_fold(const nt_plan *plan, const nt_deform_table *table, double beside, double distance)
{
    const double other = plan->source == NT_ADHESION_NONE ? table->hold : 0.0;
    return fabs(beside) < distance || fabs(beside + other) < distance;
}

/* Of a table to what the others make of its radius, but nearer to its fold than that is known. */
static double error_of(const relief_maker *m, const nt_deform_table *table, double moved)
{
    const nt_place place = {.radius = {.radius = table->ratio * m->plan->contact.radius}};
    const double load = DEEPER * m->scene->range.maximum_load;
    double worst = 0.0;
    for (int i = 1; i < table->count; ++i) {
        const int part = part_of(table, i), attached = part > 0 && table->holds;
        const double fold = attached ? table->release : table->touch + table->hold;
        for (int j = 0; j <= OF_EACH && i != table->apart; ++j) {
            const double from = table->node[i - 1].v, share = (double)j / OF_EACH;
            const double gap = gap_of(table, part, from + share * (table->node[i].v - from));
            const nt_law_value truth = nt_deform_around(m->plan, table, attached, gap);
            const int sharp = part < 0 || attached || m->plan->quantity == NT_QUANTITY_STIFFNESS;
            if (truth.F > load || (sharp && near_fold(m->plan, table, gap - fold, FAR * moved)))
                continue;
            const nt_law_value found = nt_deform_relief_at(m->plan, &place, attached, gap).law;
            worst = fmax(worst, difference(m->plan, &m->of, &found, &truth));
        }
    }
    if (table->share > 0.0) { /* and what it keeps in contact */
        const nt_law_value truth = nt_deform_around(m->plan, table, 1, 0.0);
        const nt_law_value found = nt_deform_relief_at(m->plan, &place, 1, 0.0).law;
        worst = fmax(worst, difference(m->plan, &m->of, &found, &truth));
    }
    return worst;
}

/* How far folds are from where they should be [m]. */
static double moved_of(const nt_plan *plan, const nt_deform_table *table)
{
    const double radius = table->ratio * plan->contact.radius;
    const double touch = isinf(table->touch) ? 0.0 : nt_deform_relief_fold(plan, radius, 0) - table->touch;
    const double release = table->holds ? nt_deform_relief_fold(plan, radius, 1) - table->release : 0.0;
    return fmax(fabs(touch), fabs(release));
}

/* Tables half way between those there are, and what these err by. */
static nt_status halve(relief_maker *m)
{
    nt_deform_relief *relief = &m->plan->relief;
    const int count = relief->count;
    const nt_deform_table *between[NT_DEFORM_RADII];
    double error = 0.0, moved = 0.0;
    if (2 * count - 1 > NT_DEFORM_RADII)
        return NT_E_NO_CONVERGENCE;
    for (int i = 0; i < count - 1; ++i) {
        if (make_one(m, radius_of(relief, i + 0.5), count + i) != NT_OK)
            return NT_E_RANGE;
        between[i] = &relief->room[count + i];
        const double here = moved_of(m->plan, between[i]);
        moved = fmax(moved, here);
        error = fmax(error, error_of(m, between[i], here));
    }
    for (int i = count - 1; i > 0; --i) {
        relief->table[2 * i] = relief->table[i];
        relief->table[2 * i - 1] = between[i - 1];
    }
    relief->count = 2 * count - 1;
    relief->step *= 0.5;
    m->worst->error = HALVED * NT_SAMPLED * error;
    m->worst->moved += HALVED * moved;
    return NT_OK;
}

/* The work of adhesion that a measured pull-off force has with the table of the tip's own radius [J/m^2]. */
static double work_of(const nt_plan *plan, const nt_scene *scene)
{
    nt_plan own;
    if (scene->adhesion.given != NT_ADHESION_GIVEN_PULL_OFF || plan->source == NT_ADHESION_NONE)
        return 0.0;
    nt_plan_copy(&own, plan);
    nt_deform_join(&own, &own.deformation);
    return nt_plan_adhere(&own, scene, NULL) == NT_OK ? own.contact.work_of_adhesion + own.tail : 0.0;
}

/* Of a dry contact the radii that are alike go on to nearer where they no longer are. */
static void find_limit(relief_maker *m)
{
    double missing = m->missing;
    for (int i = 0; i < NEARER && m->plan->source != NT_ADHESION_NONE && !m->plan->deformation.holds; ++i) {
        const double good = missing < m->low ? m->low : m->high, middle = sqrt(good * missing);
        if (make_one(m, middle, 0) != NT_OK)
            missing = middle;
    }
}

nt_problem nt_deform_spread(double radius, double minimum, double maximum)
{
    return nt_problem_coded(NT_PROBLEM_SPREAD, nt_problem_of("surface", "m", radius, minimum, maximum));
}

/* Where the tip's own radius has no contact either, it is no matter of the surface. */
static nt_status refuse(relief_maker *m, nt_problem *problem)
{
    if (!problem || m->missing == m->plan->contact.radius)
        return NT_E_RANGE;
    find_limit(m);
    return nt_problem_refuse(problem, nt_deform_spread(m->missing, m->low, m->high));
}

/* No more tables fit: a looser demand is kept by those there are. */
static nt_status refuse_error(const relief_maker *m, double most, nt_problem *problem)
{
    const double demanded = m->plan->accuracy;
    return nt_problem_refuse(problem, nt_demand_accuracy(demanded, fmin(demanded * m->worst->error / most, WORST)));
}

nt_status nt_plan_deform_over(nt_plan *plan, const nt_scene *scene, const nt_deform_wanted *of, double most,
                              nt_deform_worst *worst, nt_problem *problem)
{
    nt_deform_relief *relief = &plan->relief;
    const double R = plan->contact.radius, least = plan->radii->minimum, largest = plan->radii->maximum;
    const double span = fmax(log(largest / least), LEAST);
    relief_maker m = {plan, scene, *of, worst, work_of(plan, scene), R, R, 0.0, NULL};
    relief->count = 1 + (int)fmax(ceil(span / APART), CELLS);
    relief->first = least;
    relief->step = span / (relief->count - 1);
    m.of.load *= exp(STEEPEST * relief->step);
    nt_status status = begin(&m);
    if (status == NT_OK)
        status = make_first(&m);
    if (status != NT_OK)
        return refuse(&m, problem);
    do {
        status = halve(&m);
    } while (status == NT_OK && worst->error > most);
    if (status == NT_OK)
        return NT_OK;
    if (status != NT_E_NO_CONVERGENCE)
        return refuse(&m, problem);
    m.missing = largest;
    return worst->error < WORST * most ? refuse_error(&m, most, problem) : refuse(&m, problem);
}
