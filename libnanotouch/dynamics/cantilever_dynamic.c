/* SPDX-License-Identifier: BSD-3-Clause
 * Dynamic cantilever (Eq. 2): m zeta'' + (m w0/Q) zeta' + k_c zeta = F(z_t) - 2 eta a z_t' + thermal force.
 *
 * A sub-step h is the exact answer of spring, mass, damping and thermal force to a force that is held, and the force
 * that is held is the mean over the way that the tip goes, from the potential: z' = z_free + cos(alpha) xf (G - c (z' -
 * z)/h),   G = -(U(z') - U(z))/(z' - z),   c = eta (a + a') >= 0 (exponential discrete gradient). Multiply by the way:
 * m zeta'^2/2 + k_c zeta^2/2 + U/cos(alpha) changes by what the dampings take, which is never negative, and what the
 * base does, and by nothing else, at any h and any contact. So the scheme cannot diverge. h is accuracy: it is T/2^n
 * with w h <= substep, w = w0 sqrt(1 + k/k_c), and is halved where the change of F over the way does not agree with its
 * slopes. Far from the surface, where F is all but constant, one step takes the whole period.
 *
 * The damping of the contact follows its radius a: finite where a goes to 0, the same in tension and in compression.
 * Where the force jumps (a meniscus forms or breaks), the energy of the jump is not the tip's: in the finest step the
 * force before the jump is held, if that gives the tip less. Base inertia is left out, as in Eq. 2: (f_stage/f_0)^2. */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "internal/random.h"
#include "oscillator.h"

#define CLOSE 1e-5 /* Newton steps below this many field lengths are exact to about its square */
#define SHORT_WAY                                                                                                      \
    1e-3                /* below this many field lengths a difference of U is rounding; Hermite's mean is exact there  \
                         */
#define SMOOTH 0.1      /* mismatch of F over such a way, relative to its slopes */
#define UNRESOLVED 0.05 /* mismatch of F over a sub-step, relative to the F at its ends */
#define FLOOR 1e-3      /* and to k_c length */
#define FREE 0.01       /* (k/k_c) w0 T over substep^2 up to which the tip flies free */
enum { EVALUATIONS_MAX = 60 };

typedef nt_cantilever_substep substep;

/* One sub-step on its way. */
typedef struct arc {
    const nt_force_field *field;
    double from, free;   /* where the tip is, and where it would be without force [m] */
    nt_law_value before; /* the law at `from` */
    double gain;         /* cos(alpha) xf [m/N] */
    double viscosity;    /* eta/h [Pa] */
    double z;            /* where it ends [m] */
    nt_law_value after;
    double force; /* held over the sub-step [N] */
} arc;

/* G: mean force over the way to z. */
static double mean_force(const arc *a, double z, const nt_law_value *law)
{
    const double way = z - a->from;
    if (fabs(way) > SHORT_WAY * a->field->length)
        return -(law->U - a->before.U) / way;
    const double mean = 0.5 * (a->before.F + law->F), bend = way * (law->k - a->before.k) / 12.0;
    const double fall =
        0.5 * (law->k + a->before.k) * way; /* of F, by its slopes: else it jumps, and they say nothing */
    return fabs(a->before.F - law->F - fall) <= SMOOTH * (fabs(law->k) + fabs(a->before.k)) * fabs(way) ? mean + bend
                                                                                                        : mean;
}

/* How the held force changes with the end of the way. */
static double mean_slope(const arc *a, double z, const nt_law_value *law, double mean)
{
    const double way = z - a->from;
    if (fabs(way) > SHORT_WAY * a->field->length)
        return (law->F - mean) / way;
    return -(a->before.k + 2.0 * law->k) / 6.0;
}

static double drag_of(const arc *a, const nt_law_value *law)
{
    return a->viscosity * (a->before.a + law->a);
}

/* Where F and k before would take the tip. */
static double first_guess(const arc *a)
{
    const double stiffness = 0.5 * a->before.k + 2.0 * a->viscosity * a->before.a;
    const double denominator = 1.0 + a->gain * stiffness, drive = a->free - a->from + a->gain * a->before.F;
    return denominator > 0.1 && denominator < HUGE_VAL ? a->from + drive / denominator : a->from + drive;
}

/* The end is known to Newton's last step: the law there by its derivatives, and the force by what is better
 * conditioned, the law or the end. */
static void accept(arc *a, double z, double step, const nt_law_value *law)
{
    a->z = z + step;
    a->after = *law;
    a->after.U -= step * (law->F - 0.5 * step * law->k);
    a->after.F -= step * law->k;
    const int stiff = a->gain * (0.5 * fabs(law->k) + drag_of(a, law)) > 1.0;
    a->force = stiff ? (a->z - a->free) / a->gain : mean_force(a, a->z, &a->after) - drag_of(a, law) * (a->z - a->from);
}

/* z - free - gain (G - c way) = 0: Newton, kept inside its bracket. The left side goes to -+infinity with z, so there
 * is a root; where F jumps the bracket closes on the jump, and the force is what holds the tip there. */
static nt_status arc_solve(arc *a)
{
    double low = -HUGE_VAL, high = HUGE_VAL, reach = a->field->length, z = first_guess(a);
    nt_law_value law = a->before;
    for (int i = 0; i < EVALUATIONS_MAX; i++) {
        law = a->field->eval(a->field->context, z);
        const double mean = mean_force(a, z, &law), drag = drag_of(a, &law);
        const double rest = z - a->free - a->gain * (mean - drag * (z - a->from));
        const double slope = 1.0 + a->gain * (drag - mean_slope(a, z, &law, mean));
        if (!isfinite(rest))
            return NT_E_NOT_FINITE;
        const double step = -rest / slope;
        if (slope > 0.0 && fabs(step) <= CLOSE * a->field->length) {
            accept(a, z, step, &law);
            return NT_OK;
        }
        if (rest > 0.0)
            high = z;
        else
            low = z;
        const int closed = low > -HUGE_VAL && high < HUGE_VAL;
        if (closed && high - low <= CLOSE * CLOSE * a->field->length)
            break;
        double next = z + step;
        if (!(slope > 0.0 && next > low && next < high)) {
            next = closed ? 0.5 * (low + high) : z + (rest > 0.0 ? -reach : reach);
            reach *= 2.0;
        }
        z = next;
    }
    a->z = z;
    a->after = law;
    a->force = a->gain > 0.0 ? (z - a->free) / a->gain : mean_force(a, z, &law);
    return NT_OK;
}

/* Does the sub-step see all of the structure between its ends? */
static int is_resolved(const arc *a, double spring_constant)
{
    const double way = a->z - a->from, allowed = UNRESOLVED * (fabs(a->before.F) + fabs(a->after.F)) +
                                                 FLOOR * spring_constant * a->field->length;
    const double change = a->after.F - a->before.F + 0.5 * (a->before.k + a->after.k) * way;
    const double mean = mean_force(a, a->z, &a->after) - 0.5 * (a->before.F + a->after.F);
    return fabs(change) <= allowed && fabs(mean) <= allowed;
}

/* Across a jump of the force in the finest step: hold the force before it, if the tip gets less energy that way. */
static void cross_jump(arc *a)
{
    const double drag = 2.0 * a->viscosity * a->before.a;
    const double drive = a->free - a->from + a->gain * a->before.F;
    const double way = drive / (1.0 + a->gain * drag), z = a->from + way;
    const nt_law_value law = a->field->eval(a->field->context, z);
    if (!(a->before.F * way <= a->before.U - law.U))
        return;
    a->z = z;
    a->after = law;
    a->force = a->before.F - drag * way;
}

/* Halvings of the period that a contact of this stiffness asks for. */
static int level_for(const nt_cantilever_model *model, double stiffness)
{
    const double rate = model->rate * sqrt(1.0 + fabs(stiffness) / model->probe.spring_constant);
    const double steps = rate * model->period / model->substep;
    if (!(steps < ldexp(1.0, model->finest)))
        return model->finest;
    return steps > 1.0 ? ilogb(steps) + 1 : 0;
}

/* So soft that one step over the whole period does. */
static int is_negligible(const nt_cantilever_model *model, double stiffness)
{
    const double share = fabs(stiffness) / model->probe.spring_constant;
    return share * model->rate * model->period <= FREE * model->substep * model->substep;
}

/* Would one step over the whole period do? The force is all but constant down to the lowest place the tip can reach. */
static int flies_free(const nt_cantilever_model *model, const nt_cantilever_state *state, const nt_force_field *field,
                      const nt_law_value *law, double lowest_base)
{
    const double spring = model->probe.spring_constant, shift = law->F / spring;
    const double swing = hypotenuse(state->deflection - shift, state->speed / model->rate);
    const double low = lowest_base + model->cosine * (shift - swing - 6.0 * model->steps[0].noise[0]);
    const nt_law_value lowest = field->eval(field->context, low);
    return is_negligible(model, lowest.k);
}

/* The coarsest level whose sub-steps begin at this place of the period, in finest sub-steps. */
static int level_at(uint32_t place, int finest)
{
    int level = finest;
    for (; level > 0 && place % 2u == 0u; place /= 2u)
        level--;
    return level;
}

/* Is the contact slow enough for this sub-step? */
static int is_slow(const nt_cantilever_model *model, double stiffness, const substep *s)
{
    return model->rate * sqrt(1.0 + fabs(stiffness) / model->probe.spring_constant) * s->length <= 2.0 * model->substep;
}

/* A period on its way. */
typedef struct course {
    const nt_cantilever_model *model;
    const nt_force_field *field;
    nt_cantilever_state *state;
    nt_law_value law;   /* at the tip */
    double first, last; /* height of the base at the beginning and at the end [m] */
    uint32_t place;     /* how far it is, in finest sub-steps */
    double kick[2];     /* standard normal: the thermal force of this sub-step */
} course;

static double base_at(const course *c, uint32_t place)
{
    const uint32_t end = 1u << c->model->finest;
    return place == end ? c->last : c->first + (c->last - c->first) * ((double)place / end);
}

static nt_status try_level(const course *c, int level, arc *a)
{
    const substep *s = &c->model->steps[level];
    const nt_oscillator *o = &s->oscillator;
    const nt_cantilever_state *now = c->state;
    const double deflection =
        now->deflection + o->xv * now->speed - o->xf * o->k * now->deflection + s->noise[0] * c->kick[0];
    const double base = base_at(c, c->place + (1u << (c->model->finest - level)));
    *a = (arc){.field = c->field,
               .from = now->tip_height,
               .before = c->law,
               .gain = c->model->cosine * o->xf,
               .viscosity = c->model->probe.contact_viscosity / s->length,
               .free = base + c->model->cosine * deflection};
    return arc_solve(a);
}

static void arrive(course *c, int level, const arc *a)
{
    const substep *s = &c->model->steps[level];
    const nt_oscillator *o = &s->oscillator;
    nt_cantilever_state *now = c->state;
    const double pull = a->force - o->k * now->deflection, speed = now->speed;
    now->deflection += o->xv * speed + o->xf * pull + s->noise[0] * c->kick[0];
    now->speed = o->vv * speed + o->vf * pull + s->noise[1] * c->kick[0] + s->noise[2] * c->kick[1];
    c->place += 1u << (c->model->finest - level);
    now->tip_height = base_at(c, c->place) + c->model->cosine * now->deflection;
    c->law = a->after;
    if (c->field->advance != NULL)
        c->field->advance(c->field->context, now->tip_height);
}

/* One sub-step, of the level asked for or of a finer one. */
static nt_status advance(course *c, int level)
{
    const nt_cantilever_model *model = c->model;
    arc a;
    int slow = 0;
    for (;; level++) {
        const nt_status status = try_level(c, level, &a);
        if (status != NT_OK)
            return status;
        slow = is_slow(model, a.after.k, &model->steps[level]) || (level == 0 && is_negligible(model, a.after.k));
        const int resolved = slow && is_resolved(&a, model->probe.spring_constant);
        if (resolved)
            break;
        if (level == model->finest) {
            if (fabs(a.z - a.from) > SHORT_WAY * a.field->length)
                cross_jump(&a);
            break;
        }
    }
    c->state->unresolved += !slow;
    arrive(c, level, &a);
    return NT_OK;
}

nt_status nt_cantilever_step(const nt_cantilever_model *model, nt_cantilever_state *state, const nt_force_field *field,
                             double base_height, nt_noise *noise)
{
    if (field->eval == NULL || !(field->length > 0.0))
        return NT_E_ARGUMENT;
    course c = {.model = model,
                .field = field,
                .state = state,
                .law = field->eval(field->context, state->tip_height),
                .first = state->tip_height - model->cosine * state->deflection,
                .last = base_height};
    if (!isfinite(c.law.F) || !isfinite(base_height))
        return NT_E_NOT_FINITE;
    const int free = flies_free(model, state, field, &c.law, fmin(c.first, c.last));
    while (c.place < 1u << model->finest) {
        if (model->probe.temperature > 0.0) {
            c.kick[0] = nt_noise_normal(noise);
            c.kick[1] = nt_noise_normal(noise);
        }
        const int wanted = free ? 0 : level_for(model, c.law.k), allowed = level_at(c.place, model->finest);
        const nt_status status = advance(&c, wanted > allowed ? wanted : allowed);
        if (status != NT_OK)
            return status;
    }
    return NT_OK;
}
