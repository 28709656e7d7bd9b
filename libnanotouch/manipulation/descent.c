/* SPDX-License-Identifier: BSD-3-Clause
 * The way to the balance: Newton's steps, damped where needed, always go down, also through a jump. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "manipulation/balance.h"
#include "manipulation/vector.h"

#define ITERATIONS 5000
#define PATIENCE 200 /* iterations; where a minimum is about to vanish, each goes a shorter way: ENOUGH ends that */
#define FAINT 1e-13  /* [N]: bristles of a contact that is about to open have no scale of their own */
#define HALVINGS 4
#define DAMPING 1e-10 /* of all stiffnesses: least, and most */
#define DAMPING_MAX 1e10
#define EXACT 1e-11 /* of the forces' sizes: the particle's place, 1e-16 of R, times a contact's stiffness is 1e-12 */
#define ENOUGH 1e-7 /* where the energy, 1e-16 of it, cannot show a smaller force */

int balance_factor(balance_matrix h, int n, double damping)
{
    double trace = 0.0;
    for (int i = 0; i < n; ++i)
        trace += h[i][i];
    for (int i = 0; i < n; ++i)
        h[i][i] += damping * trace;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j) {
            double sum = h[i][j];
            for (int k = 0; k < j; ++k)
                sum -= h[i][k] * h[j][k];
            if (i == j && !(sum > 0.0))
                return 0;
            h[i][j] = i == j ? sqrt(sum) : sum / h[j][j];
        }
    return 1;
}

int balance_solve(balance_matrix hessian, int n, double damping, const double g[], double x[])
{
    balance_matrix h;
    for (int i = 0; i < n; ++i)
        memcpy(h[i], hessian[i], (size_t)(i + 1) * sizeof h[i][0]);
    if (!balance_factor(h, n, damping))
        return 0;
    for (int i = 0; i < n; ++i) {
        x[i] = -g[i];
        for (int k = 0; k < i; ++k)
            x[i] -= h[i][k] * x[k];
        x[i] /= h[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int k = i + 1; k < n; ++k)
            x[i] -= h[k][i] * x[k];
        x[i] /= h[i][i];
    }
    return 1;
}

static double largest(const double values[], int count)
{
    double most = 0.0;
    for (int i = 0; i < count; ++i)
        most = fmax(most, fabs(values[i]));
    return most;
}

static double length_of(const double values[], int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
        sum += values[i] * values[i];
    return sqrt(sum);
}

/* What the forces need not be closer to 0 than: places are known to 1e-16 of R, a motion to 1e-16 of it; and 1 aN. */
static double finest(const balance *step, const double motion[], const balance_value *value)
{
    const double R = step->particle->radius, moved = largest(motion, step->freedoms);
    double rounding = 0.0;
    for (int i = 0; i < step->links; ++i) {
        rounding += R * fabs(value->link[i].contact.k);
        for (int j = 0; j < NT_BRISTLES; ++j)
            rounding += moved * step->link[i].bristles[j].stiffness;
    }
    for (int i = 0; i < 3; ++i)
        rounding += step->lever[i] * fmax(R, fabs(step->base[i]));
    return 4e-15 * rounding + 1e-18;
}

/* Along Newton's direction until the cost has fallen. 0: it does not. */
static int go_down(const balance *step, double motion[], const double direction[], balance_value *value)
{
    const nt_particle *particle = step->particle;
    const double reach = 0.05 * fmin(particle->radius, particle->tip_radius); /* not through the tip */
    const int n = step->freedoms;
    double slope = 0.0, share = 1.0;
    if (!(length_of(direction, n) <= reach))
        return 0;
    for (int i = 0; i < n; ++i)
        slope += value->gradient[i] * direction[i];
    for (int tries = 0; tries < HALVINGS; ++tries, share *= 0.5) {
        double to[BALANCE_FREEDOMS];
        balance_value found;
        for (int i = 0; i < n; ++i)
            to[i] = motion[i] + share * direction[i];
        if (balance_value_at(step, to, &found) != NT_OK)
            continue;
        double size = 0.0;
        for (int i = 0; i < step->links; ++i)
            size += fabs(found.link[i].contact.U);
        const double rounding = 1e-15 * (size + found.scale * particle->radius);
        const int closer = largest(found.gradient, n) < 0.9 * largest(value->gradient, n);
        if (found.cost <= value->cost + 1e-4 * share * slope || (closer && found.cost <= value->cost + rounding)) {
            memcpy(motion, to, (size_t)n * sizeof to[0]);
            memcpy(value, &found, offsetof(balance_value, link) + (size_t)step->links * sizeof found.link[0]);
            return 1;
        }
    }
    return 0;
}

/* Newton's step, and if it does not go down, a shorter and steeper one (Levenberg). 0: none does. */
static int improve(balance *step, double motion[], balance_value *value, double *damping)
{
    balance_matrix hessian;
    double direction[BALANCE_FREEDOMS];
    balance_hessian(step, value, hessian);
    for (*damping = fmax(*damping / 100.0, DAMPING); *damping < DAMPING_MAX; *damping *= 4.0)
        if (balance_solve(hessian, step->freedoms, *damping, value->gradient, direction) &&
            go_down(step, motion, direction, value))
            return 1;
    return 0;
}

nt_status balance_find(balance *step, double motion[], balance_value *value)
{
    double damping = DAMPING;
    const int n = step->freedoms;
    memset(motion, 0, (size_t)n * sizeof motion[0]);
    const nt_status status = balance_value_at(step, motion, value);
    if (status != NT_OK)
        return status;
    for (int i = 0; i < ITERATIONS; ++i) {
        const double exact = i < PATIENCE ? EXACT : ENOUGH;
        if (largest(value->gradient, n) <= exact * value->scale + finest(step, motion, value))
            return NT_OK;
        if (!improve(step, motion, value, &damping))
            break;
        for (int which = 0; which < step->links; ++which)
            step->link[which].attached |= value->link[which].contact.a > 0.0;
    }
    const double enough = ENOUGH * value->scale + finest(step, motion, value) + FAINT;
    return largest(value->gradient, n) <= enough ? NT_OK : NT_E_NO_CONVERGENCE;
}

double balance_resistance(const balance *step, const balance_value *value)
{
    balance freed = *step;
    balance_matrix hessian;
    if (freed.tip_freedom[2] >= 0)
        return 0.0;
    freed.tip_freedom[2] = freed.freedoms++; /* the last: its pivot is what is left when all others give way */
    balance_hessian(&freed, value, hessian);
    const int last = freed.freedoms - 1;
    return balance_factor(hessian, freed.freedoms, 0.0) ? hessian[last][last] * hessian[last][last] : 0.0;
}
