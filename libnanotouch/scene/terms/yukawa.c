/* SPDX-License-Identifier: BSD-3-Clause
 * A Yukawa force: each element of tip and sample interacts with each by exp(-r/l)/r. This is the screened Coulomb
 * force of charged gels and the form in which AFM looks for forces beyond Newton's (Fischbach, Krause, Mostepanenko,
 * Novello, Phys. Rev. D 64 (2001) 075010).
 *
 * The half-space makes a potential ~ exp(-z/l) above it, so that flats have W exp(-h/l). Over the slices of a sphere,
 * of area pi (2 R t - t^2) at z = h + t, it adds up to
 *     F = 2 pi R W exp(-h/l) [1 - l/R + (1 + l/R) exp(-2 R/l)],
 * exact for every l/R; Derjaguin's 2 pi R W exp(-h/l) for l << R, the volume of the sphere for l >> R. */
#include <math.h>

#include "forces/law.h"
#include "scene/terms/term.h"

/* The bracket, x = R/l. Where its parts cancel, their series: Sum_(n>1) (-2 x)^n/n! (n - 1)/(n + 1). */
static double of_sphere(double x)
{
    if (x > 1.0)
        return 1.0 - 1.0 / x + (1.0 + 1.0 / x) * exp(-2.0 * x);
    double sum = 0.0, power = -2.0 * x;
    for (int n = 2; n < 30; ++n) {
        power *= -2.0 * x / n;
        sum += power * (n - 1) / (n + 1);
    }
    return sum;
}

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const double R = scene->tip.radius, l = scene->medium.yukawa_length;
    const double W = l > 0.0 ? scene->medium.yukawa_energy * of_sphere(R / l) : 0.0;
    *(nt_yukawa_term *)law = (nt_yukawa_term){W, l, 2.0 * NT_PI * R * W, scene->adhesion.equilibrium_distance};
}

static nt_form full_form(const void *law)
{
    return ((const nt_yukawa_term *)law)->energy == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    const nt_yukawa_term *yukawa = law;
    const double F = yukawa->force * exp(-nt_law_gap(gap, yukawa->minimum_gap) / yukawa->length);
    const nt_law_value value = {.U = F * yukawa->length, .F = F, .k = F / yukawa->length};
    return nt_law_hold(value, yukawa->minimum_gap - gap);
}

static double hold(const void *law)
{
    return ((const nt_yukawa_term *)law)->minimum_gap;
}

/* Of flats that by Derjaguin's relation make the force of the sphere: a sample that hardly deforms feels that. */
static nt_pressure pressure(const void *law, double gap)
{
    const nt_yukawa_term *yukawa = law;
    const double l = yukawa->length, W = yukawa->energy * exp(-gap / l);
    return (nt_pressure){W, W / l, -W / (l * l)};
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    out[0] = (nt_term_fact){scene->medium.yukawa_length > 0.0, "energy of a Yukawa force, not used: it has no length",
                            "J/m^2", scene->medium.yukawa_energy};
    return 1;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 0.2, 0.2, "computed"}};

NT_TERM_BESIDE(yukawa, prepare, full_form, eval, hold, pressure,
               .words = {"yukawa", "Yukawa", "screened force of all matter in sphere and flat (Fischbach 2001)", NULL,
                         forms, 1, 1},
               .facts = facts, .noun = "the Yukawa force");
