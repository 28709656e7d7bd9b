/* SPDX-License-Identifier: BSD-3-Clause
 * The exact transition of m x'' + b x' + k x = f, f held. With s = b/2m and w^2 = k/m - s^2 the answer to a unit
 * impulse is g(t)/m, g = e^(-st) sin(wt)/w (sinh where w^2 < 0, t where it is 0), and everything follows from it:
 *     x(t) = x0 + xv v0 + xf (f - k x0),   xv = g,         xf = integral of g/m = (1 - g' - 2 s g)/k,
 *     v(t) =      vv v0 + vf (f - k x0),   vv = g',        vf = g/m.
 * Written with f - k x0, so that rest is rest to the last bit. */
#include "oscillator.h"

#include <math.h>

#define SHORT 0.5 /* below this the closed forms cancel and the power series is used */
enum { TERMS = 18 };

/* s [1/s] and w^2 [1/s^2]. */
typedef struct shape {
    double decay, square;
} shape;

static shape shape_of(const nt_oscillator_constants *c)
{
    const double decay = 0.5 * c->damping / c->mass;
    return (shape){decay, c->stiffness / c->mass - decay * decay};
}

/* Powers of t: x'' = 1 - 2 s x' - (k/m) x from rest gives xf m and vf m; x'' = -2 s x' - (k/m) x with v0 = 1 gives vv.
 */
static nt_oscillator over_short(const nt_oscillator_constants *c, double t)
{
    const double a = c->damping / c->mass * t, b = c->stiffness / c->mass * t * t;
    double older = 0.0, term = 0.5, position = 0.5, speed = 1.0; /* coefficients of t^2 and t */
    for (int n = 3; n < TERMS; n++) {
        const double next = -(a * term * (n - 1) + b * older) / (n * (n - 1.0));
        older = term;
        term = next;
        position += term;
        speed += n * term;
    }
    const double g = t * speed;
    return (nt_oscillator){.xv = g,
                           .vv = 1.0 - a * speed - b * position,
                           .xf = t * t * position / c->mass,
                           .vf = g / c->mass,
                           .k = c->stiffness};
}

static nt_oscillator over_swing(const nt_oscillator_constants *c, const shape *s, double t)
{
    const double w = sqrt(s->square), e = exp(-s->decay * t);
    const double g = w > 0.0 ? e * sin(w * t) / w : e * t, slope = e * cos(w * t) - s->decay * g;
    return (nt_oscillator){.xv = g,
                           .vv = slope,
                           .xf = (1.0 - slope - 2.0 * s->decay * g) / c->stiffness,
                           .vf = g / c->mass,
                           .k = c->stiffness};
}

/* (1 - e^(-r t))/r */
static double decayed(double r, double t)
{
    return r > 0.0 ? -expm1(-r * t) / r : t;
}

/* Two decays, fast and slow; the slow one from their product, so that it does not cancel. */
static nt_oscillator over_creep(const nt_oscillator_constants *c, const shape *s, double t)
{
    const double w = sqrt(-s->square), fast = s->decay + w, slow = c->stiffness / c->mass / fast;
    const double g = exp(-slow * t) * decayed(2.0 * w, t);
    const double slope = exp(-fast * t) - slow * g;
    const double twice = 2.0 * w * c->mass;
    const int near_critical = w < 0.5 * s->decay;
    const double xf = near_critical ? (1.0 - slope - 2.0 * s->decay * g) / c->stiffness
                                    : (decayed(slow, t) - decayed(fast, t)) / twice;
    return (nt_oscillator){.xv = g, .vv = slope, .xf = xf, .vf = g / c->mass, .k = c->stiffness};
}

nt_oscillator nt_oscillator_over(const nt_oscillator_constants *constants, double t)
{
    const shape s = shape_of(constants);
    if (2.0 * s.decay * t + sqrt(constants->stiffness / constants->mass) * t < SHORT)
        return over_short(constants, t);
    return s.square >= 0.0 ? over_swing(constants, &s, t) : over_creep(constants, &s, t);
}

/* v(t) e^(st) = v0 cos(wt) + y sin(wt)/w with y = (f - k x0)/m - s v0. */
double nt_oscillator_turns_after(const nt_oscillator_constants *constants, double pull, double speed)
{
    const shape s = shape_of(constants);
    const double way = speed > 0.0 ? 1.0 : -1.0, v = fabs(speed);
    const double y = way * pull / constants->mass - s.decay * v;
    const double w = sqrt(fabs(s.square));
    if (s.square > 0.0)
        return atan2(w * v, -y) / w;
    if (!(-y > w * v))
        return HUGE_VAL;
    const double share = w * v / -y; /* tanh(wt) */
    return w > 0.0 ? 0.5 * log1p(2.0 * share / (1.0 - share)) / w : v / -y;
}
