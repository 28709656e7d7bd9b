/* SPDX-License-Identifier: BSD-3-Clause
 * Tapping in the time domain: q'' = -q - q'/Q + F/k_c + D cos(r t), t in 1/w0, by DOP853.
 *
 * A step ends at the lowest point of the tip, so that no tap, however short, falls between the stages. Where the force
 * jumps (a meniscus forms or breaks) the steps shrink until the tip crosses within the tolerance. All means and works
 * are integrals over the same stages with the same weights, of order 8 as the motion itself. */
#include "nanotouch/advanced/tapping.h"

#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "dop853.h"
#include "nanotouch/material.h"

#define LONGEST 0.6         /* step [rad of w0 t], a tenth of a period */
#define SHORTEST 1e-11      /* step that is taken whatever its error is */
#define SAFETY 0.9          /* of the next step's length */
#define AT_AN_END 0.02      /* a lowest point this near to an end of the step is that end */
enum { STEPS_MAX = 20000 }; /* in one period */

/* What is integrated along with the motion, over t. */
enum { COS, SIN, DEFLECTION, FORCE, VIRIAL, TIP_WORK, MEDIUM, DRIVE_WORK, DRIVE_VIRIAL, SPEED2, WAY2, SUMS };

/* The motion at one moment. */
typedef struct moment {
    double t, q, v, a; /* 1/w0, [m] */
    double force;      /* with the damping of the contact [N] */
    double gap;        /* [m] */
    double radius;     /* of contact [m] */
    double cosine, sine;
} moment;

typedef struct course {
    const nt_tapping *lever;
    const nt_tapping_over *over;
    double ground; /* gap at q = 0 [m] */
    nt_interaction_state contact;
    double sums[SUMS];
    double contact_time, peak, pull, lowest;
    long steps, evaluations;
} course;

/* A step tried. */
typedef struct trial {
    moment stages[STAGES];
    double q, v;  /* at its end [m] */
    double error; /* over what is allowed */
} trial;

static nt_law_value law_at(const course *c, double gap)
{
    return nt_interaction_eval_gap(c->over->plan, &c->contact, c->over->place, gap);
}

static moment moment_at(course *c, double t, double q, double v)
{
    const nt_tapping *lever = c->lever;
    moment m = {.t = t, .q = q, .v = v, .gap = c->ground + lever->cosine * q};
    const nt_law_value law = law_at(c, m.gap);
    m.radius = law.a;
    m.force = law.F - 2.0 * lever->viscosity * law.a * lever->cosine * v * lever->rate;
    m.cosine = cos(lever->ratio * t);
    m.sine = sin(lever->ratio * t);
    m.a = m.force / lever->spring_constant - q - v / lever->quality + lever->strength * m.cosine;
    c->evaluations++;
    return m;
}

static double error_of(const course *c, const trial *made, double h)
{
    double e3 = 0.0, e5 = 0.0;
    for (int of_speed = 0; of_speed < 2; of_speed++) {
        double three = 0.0, five = 0.0;
        for (int i = 0; i < STAGES; i++) {
            const double slope = of_speed ? made->stages[i].a : made->stages[i].v;
            three += error3[i] * slope;
            five += error5[i] * slope;
        }
        e3 += three * three;
        e5 += five * five;
    }
    const double size = c->lever->tolerance * c->lever->free_amplitude;
    return e5 > 0.0 ? h * e5 / sqrt(2.0 * (e5 + 0.01 * e3)) / size : e5;
}

static void try_step(course *c, const moment *from, double h, trial *made)
{
    made->stages[0] = *from;
    for (int i = 1; i < STAGES; i++) {
        double q = 0.0, v = 0.0;
        for (int j = 0; j < i; j++) {
            q += inner[i][j] * made->stages[j].v;
            v += inner[i][j] * made->stages[j].a;
        }
        made->stages[i] = moment_at(c, from->t + node[i] * h, from->q + h * q, from->v + h * v);
    }
    double q = 0.0, v = 0.0;
    for (int i = 0; i < STAGES; i++) {
        q += weight[i] * made->stages[i].v;
        v += weight[i] * made->stages[i].a;
    }
    made->q = from->q + h * q;
    made->v = from->v + h * v;
    made->error = error_of(c, made, h);
}

/* The motion inside a step, by a polynomial of degree 5 through both ends; share 0 .. 1. */
static double way_at(const moment *a, const moment *b, double share)
{
    const double h = b->t - a->t, s = share, r = 1.0 - s;
    const double h0 = r * r * r * (1.0 + 3.0 * s + 6.0 * s * s), h1 = s * r * r * r * (1.0 + 3.0 * s);
    const double h2 = 0.5 * s * s * r * r * r, k0 = 1.0 - h0, k1 = -r * s * s * s * (1.0 + 3.0 * r),
                 k2 = 0.5 * r * r * s * s * s;
    return h0 * a->q + k0 * b->q + h * (h1 * a->v + k1 * b->v) + h * h * (h2 * a->a + k2 * b->a);
}

/* Where in a step the tip turns from down to up, as a share of it: the speed by a cubic. */
static double turning_share(const moment *a, const moment *b)
{
    double low = 0.0, high = 1.0;
    const double h = b->t - a->t;
    for (int i = 0; i < 40; i++) {
        const double s = 0.5 * (low + high), r = 1.0 - s;
        const double v =
            r * r * ((1.0 + 2.0 * s) * a->v + s * h * a->a) + s * s * ((1.0 + 2.0 * r) * b->v - r * h * b->a);
        if (v < 0.0)
            low = s;
        else
            high = s;
    }
    return 0.5 * (low + high);
}

/* Share of an accepted step that the tip spent in contact. */
static double contact_share(const course *c, const moment *a, const moment *b)
{
    const int before = a->radius > 0.0, after = b->radius > 0.0;
    if (before == after)
        return before;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 24; i++) {
        const double s = 0.5 * (low + high);
        if ((law_at(c, c->ground + c->lever->cosine * way_at(a, b, s)).a > 0.0) == before)
            low = s;
        else
            high = s;
    }
    return before ? low : 1.0 - low;
}

static void add_moment(course *c, const moment *m, double weighted)
{
    const nt_tapping *lever = c->lever;
    const double drive = lever->strength * m->cosine;
    const double deflection = m->q - (lever->at_base ? drive : 0.0);
    const double of[SUMS] = {deflection * m->cosine, deflection * m->sine, deflection,  m->force,
                             m->force * m->q,        m->force * m->v,      m->v * m->v, drive * m->v,
                             drive * m->q,           m->v * m->v,          m->q * m->q};
    for (int i = 0; i < SUMS; i++)
        c->sums[i] += weighted * of[i];
    c->peak = fmax(c->peak, m->force);
    c->pull = fmax(c->pull, -m->force);
    c->lowest = fmin(c->lowest, m->gap);
}

/* Takes a step: what it adds, then the history of the contact. */
static moment accept(course *c, const trial *made, double h)
{
    const moment *from = &made->stages[0];
    moment to = moment_at(c, from->t + h, made->q, made->v);
    for (int i = 0; i < STAGES; i++)
        if (weight[i] != 0.0)
            add_moment(c, &made->stages[i], weight[i] * h);
    add_moment(c, &to, 0.0);
    c->contact_time += h * contact_share(c, from, &to);
    c->steps++;
    const int held = c->contact.attached;
    nt_interaction_advance_gap(c->over->plan, &c->contact, c->over->place, to.gap);
    return c->contact.attached == held ? to : moment_at(c, to.t, to.q, to.v);
}

/* One period from `at`, t = 0, to `*at`, t = 0 again. */
static nt_status run_period(course *c, moment *at, double *step)
{
    const double period = 2.0 * NT_PI / c->lever->ratio;
    double next = *step > 0.0 ? *step : 0.1 * LONGEST;
    trial made;
    for (int i = 0; i < STEPS_MAX; i++) {
        const double left = period - at->t;
        double h = fmin(fmin(next, LONGEST), left);
        const int last = h >= left * (1.0 - 1e-12);
        try_step(c, at, h, &made);
        if (!isfinite(made.q) || !isfinite(made.v) || isnan(made.error))
            return NT_E_NOT_FINITE;
        const double factor = made.error > 0.0 ? SAFETY * pow(made.error, -0.125) : 5.0;
        if (made.error > 1.0 && h > SHORTEST) {
            next = fmax(h * fmin(fmax(factor, 0.1), SAFETY), 0.5 * SHORTEST);
            continue;
        }
        if (at->v < 0.0 && made.v > 0.0) {
            const moment end = {.t = at->t + h, .q = made.q, .v = made.v, .a = made.stages[STAGES - 1].a};
            const double share = turning_share(at, &end);
            if (share > AT_AN_END && share < 1.0 - AT_AN_END) {
                next = share * h;
                continue;
            }
        }
        *at = accept(c, &made, h);
        next = h * fmin(fmax(factor, 0.2), 5.0);
        if (last) {
            at->t = 0.0;
            *step = fmin(next, LONGEST);
            return NT_OK;
        }
    }
    return NT_E_NO_CONVERGENCE;
}

static double relative(double error, double size)
{
    return size > 0.0 ? fabs(error) / size : fabs(error);
}

/* Sums over t of all periods to works per period and means. */
static void tell(const course *c, const nt_tapping_state *first, const nt_tapping_state *end, long periods,
                 nt_tapping_value *value)
{
    const nt_tapping *lever = c->lever;
    const double k = lever->spring_constant, *sums = c->sums, time = 2.0 * NT_PI / lever->ratio * (double)periods;
    const double x = 2.0 * sums[COS] / time, y = 2.0 * sums[SIN] / time;
    const double stored = 0.5 * (end->speed * end->speed + end->position * end->position - first->speed * first->speed -
                                 first->position * first->position);
    const double medium = sums[MEDIUM] / lever->quality;
    const double energy = sums[DRIVE_WORK] - medium + sums[TIP_WORK] / k - stored;
    const double moved = end->position * end->speed - first->position * first->speed;
    const double drag = 0.5 * (end->position * end->position - first->position * first->position) / lever->quality;
    const double virial = sums[SPEED2] - sums[WAY2] + sums[VIRIAL] / k + sums[DRIVE_VIRIAL] - drag - moved;
    const double per = 1.0 / (double)periods;
    *value = (nt_tapping_value){
        .amplitude = hypotenuse(x, y),
        .phase = atan2(y, x),
        .mean = sums[DEFLECTION] / time,
        .peak_force = c->peak,
        .pull = c->pull,
        .lowest_gap = c->lowest,
        .contact_time = c->contact_time / time,
        .drive_work = k * sums[DRIVE_WORK] * per,
        .medium_loss = k * medium * per,
        .tip_loss = -sums[TIP_WORK] * per,
        .jump_loss = (end->contact.dissipated - first->contact.dissipated) * per / lever->cosine,
        .mean_force = sums[FORCE] / time,
        .virial = sums[VIRIAL] / time,
        .energy_error = relative(energy, fmax(fabs(sums[DRIVE_WORK]), medium)),
        .virial_error = relative(virial, time * lever->free_amplitude * lever->free_amplitude),
        .change = hypotenuse(end->position - first->position, end->speed - first->speed) / lever->free_amplitude,
        .steps = c->steps,
        .evaluations = c->evaluations};
}

nt_status nt_tapping_run(const nt_tapping *tapping, nt_tapping_state *state, const nt_tapping_over *over, long periods,
                         nt_tapping_value *value)
{
    if (tapping == NULL || state == NULL || over == NULL || over->plan == NULL || value == NULL || periods < 1)
        return NT_E_ARGUMENT;
    const double surface = over->place != NULL ? over->place->surface.z : 0.0;
    course c = {.lever = tapping,
                .over = over,
                .ground = over->base_height - surface,
                .contact = state->contact,
                .peak = -HUGE_VAL,
                .pull = 0.0,
                .lowest = HUGE_VAL};
    if (!isfinite(c.ground) || !isfinite(state->position) || !isfinite(state->speed))
        return NT_E_NOT_FINITE;
    const nt_tapping_state first = *state;
    nt_interaction_advance_gap(over->plan, &c.contact, over->place, c.ground + tapping->cosine * state->position);
    moment at = moment_at(&c, 0.0, state->position, state->speed);
    for (long i = 0; i < periods; i++) {
        const nt_status status = run_period(&c, &at, &state->step);
        if (status != NT_OK)
            return status;
        *state = (nt_tapping_state){.position = at.q, .speed = at.v, .step = state->step, .contact = c.contact};
    }
    tell(&c, &first, state, periods, value);
    return NT_OK;
}
