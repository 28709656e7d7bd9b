/* SPDX-License-Identifier: BSD-3-Clause
 * Balance of six forces and torques as a minimum. With limits and directions held for a step, bristles have a convex
 * cost, whose gradient is their pull (Simo and Hughes 1998, return map as a minimum); with the energies of the contacts
 * it is a function of the motion that falls in each of Newton's steps, also through a jump. */
#include "manipulation/balance.h"

#include <math.h>
#include <string.h>

#include "manipulation/bristle.h"
#include "manipulation/vector.h"

#define ITERATIONS 5000
#define FAINT 1e-13 /* [N]: bristles of a contact that is about to open have no scale of their own */
#define HALVINGS 4
#define DAMPING 1e-10 /* of all stiffnesses: least, and most */
#define DAMPING_MAX 1e10
#define EXACT 1e-11 /* of the forces' sizes: the particle's place, 1e-16 of R, times a contact's stiffness is 1e-12 */
#define ENOUGH 1e-7 /* where the energy, 1e-16 of it, cannot show a smaller force */

/* Unit vector from the tip to the centre, and how deep they overlap; a cone's flank has one elevation. */
static double tip_indentation(const nt_particle *particle, const double centre[3], const double tip[3], double n[3])
{
    const double away[3] = {centre[0] - tip[0], centre[1] - tip[1], centre[2] - tip[2] - particle->tip_radius};
    const double distance = norm(away), sine = sin(particle->tip_half_angle), cosine = cos(particle->tip_half_angle);
    const double across = sqrt(away[0] * away[0] + away[1] * away[1]);
    if (away[2] <= -sine * distance && distance > 0.0) {
        for (int i = 0; i < 3; ++i)
            n[i] = away[i] / distance;
        return particle->radius + particle->tip_radius - distance;
    }
    n[0] = cosine * (across > 0.0 ? away[0] / across : 1.0);
    n[1] = cosine * (across > 0.0 ? away[1] / across : 0.0);
    n[2] = -sine;
    return particle->radius + particle->tip_radius - dot(away, n);
}

static nt_status contact_at(const nt_pushing *pushing, int which, int attached, double indentation, nt_law_value *value)
{
    const nt_branch branch = attached ? NT_BRANCH_STABLE : NT_BRANCH_APPROACH;
    return nt_contact_law_eval(&pushing->laws[which].normal, indentation, branch, value);
}

nt_status balance_contacts(const nt_pushing *pushing, nt_particle_state *state)
{
    const nt_particle *particle = &pushing->particle;
    const double depths[] = {particle->radius - state->position[2],
                             tip_indentation(particle, state->position, state->tip, state->normal)};
    nt_law_value rest = {0};
    const nt_particle_laws *substrate = &pushing->laws[NT_AT_SUBSTRATE];
    nt_status status = nt_contact_law_eval(&substrate->normal, substrate->rest_indentation, NT_BRANCH_STABLE, &rest);
    state->stored = -rest.U;
    for (int i = 0; i < NT_PARTICLE_CONTACTS && status == NT_OK; ++i) {
        nt_law_value *contact = &state->contacts[i];
        status = contact_at(pushing, i, state->attached[i], depths[i], contact);
        state->attached[i] = contact->a > 0.0 || contact->F != 0.0;
        state->stored += contact->U;
        for (int j = 0; j < NT_BRISTLES; ++j)
            state->stored += bristle_stored(&state->bristles[i][j]);
    }
    return status;
}

/* How a motion stretches a bristle: the surface against the other body, or the turn across or along the normal. */
static void stretch_of(const double n[3], int bristle, const double motion[FREEDOMS], double way[3])
{
    double moved[3];
    memcpy(moved, motion + 3, sizeof moved);
    if (bristle == NT_SLIDING) {
        cross(motion + 3, n, moved);
        for (int i = 0; i < 3; ++i)
            moved[i] = motion[i] - moved[i];
    }
    const double along = dot(moved, n);
    for (int i = 0; i < 3; ++i)
        way[i] = bristle == NT_SPINNING ? along * n[i] : moved[i] - along * n[i];
}

/* Adds a bristle's pull to the forces on the particle's freedoms. */
static void add_pull(const double n[3], int bristle, const double pull[3], double gradient[FREEDOMS])
{
    double torque[3];
    memcpy(torque, pull, sizeof torque);
    if (bristle == NT_SLIDING)
        cross(pull, n, torque);
    for (int i = 0; i < 3; ++i) {
        gradient[i] += bristle == NT_SLIDING ? pull[i] : 0.0;
        gradient[3 + i] += torque[i];
    }
}

static void bristles_at(const balance *step, int which, const double motion[FREEDOMS], balance_value *value)
{
    const double *n = step->normals[which];
    for (int j = 0; j < NT_BRISTLES; ++j) {
        const nt_bristle *bristle = &step->from->bristles[which][j];
        double *stretch = value->stretches[which][j], pull[3], relative[FREEDOMS];
        memcpy(relative, motion, sizeof relative);
        for (int i = 0; i < 3 && which == NT_AT_TIP; ++i)
            relative[i] -= step->tip[i] - step->from->tip[i];
        stretch_of(n, j, relative, stretch);
        if (!(bristle->stiffness > 0.0))
            continue;
        for (int i = 0; i < 3; ++i)
            stretch[i] += bristle->pull[i] / bristle->stiffness;
        value->cost += bristle_cost(bristle, step->limits[which][j], stretch, pull);
        value->scale += norm(pull);
        add_pull(n, j, pull, value->gradient);
    }
}

static nt_status value_at(const balance *step, const double motion[FREEDOMS], balance_value *value, double n[3])
{
    const nt_particle *particle = &step->pushing->particle;
    double centre[3];
    memset(value, 0, sizeof *value);
    for (int i = 0; i < 3; ++i)
        centre[i] = step->from->position[i] + motion[i];
    const double depths[] = {particle->radius - centre[2], tip_indentation(particle, centre, step->tip, n)};
    for (int which = NT_AT_TIP; which >= NT_AT_SUBSTRATE; --which) {
        nt_law_value *contact = &value->contacts[which];
        const nt_status status = contact_at(step->pushing, which, step->attached[which], depths[which], contact);
        if (status != NT_OK)
            return status;
        value->cost += contact->U;
        value->scale += fabs(contact->F);
        for (int i = 0; i < 3; ++i)
            value->gradient[i] -= contact->F * (which == NT_AT_TIP ? n[i] : (double)(i == 2));
        bristles_at(step, which, motion, value);
        if (which == NT_AT_TIP)
            memcpy(value->tip_force, value->gradient, sizeof value->tip_force);
    }
    return NT_OK;
}

/* B^T D B of a bristle, B its stretch per unit of each freedom. */
static void add_tangent(const balance *step, int which, int j, const balance_value *value,
                        double hessian[FREEDOMS][FREEDOMS])
{
    const nt_bristle *bristle = &step->from->bristles[which][j];
    const double *n = step->normals[which];
    double projector[3][3], tangent[3][3], columns[FREEDOMS][3];
    if (!(bristle->stiffness > 0.0))
        return;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            projector[i][k] = j == NT_SPINNING ? n[i] * n[k] : (double)(i == k) - n[i] * n[k];
    bristle_tangent(bristle, step->limits[which][j], value->stretches[which][j], projector, tangent);
    for (int i = 0; i < FREEDOMS; ++i) {
        double unit[FREEDOMS] = {0};
        unit[i] = 1.0;
        stretch_of(n, j, unit, columns[i]);
    }
    for (int i = 0; i < FREEDOMS; ++i)
        for (int k = 0; k < FREEDOMS; ++k)
            for (int m = 0; m < 3; ++m)
                hessian[i][k] += columns[i][m] * dot(tangent[m], columns[k]);
}

/* Positive: a law's negative stiffness counts by its size, so that each step goes down. */
static void hessian_at(const balance *step, const balance_value *value, const double n[3],
                       double hessian[FREEDOMS][FREEDOMS])
{
    const double up[3] = {0.0, 0.0, 1.0};
    memset(hessian, 0, sizeof(double[FREEDOMS][FREEDOMS]));
    for (int which = 0; which < NT_PARTICLE_CONTACTS; ++which) {
        const nt_law_value *contact = &value->contacts[which];
        const double least = 1e-3 * step->pushing->laws[which].normal.maugis.contact.effective_modulus * contact->a;
        const double k = fmax(fabs(contact->k), least), *along = which == NT_AT_TIP ? n : up;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                hessian[i][j] += k * along[i] * along[j];
        for (int j = 0; j < NT_BRISTLES; ++j)
            add_tangent(step, which, j, value, hessian);
    }
}

/* x = -(H + damping tr(H))^-1 g by Cholesky; 0 where that is not positive. */
static int solve(double hessian[FREEDOMS][FREEDOMS], double damping, const double g[FREEDOMS], double x[FREEDOMS])
{
    double h[FREEDOMS][FREEDOMS], trace = 0.0;
    memcpy(h, hessian, sizeof h);
    for (int i = 0; i < FREEDOMS; ++i)
        trace += h[i][i];
    for (int i = 0; i < FREEDOMS; ++i)
        h[i][i] += damping * trace;
    for (int i = 0; i < FREEDOMS; ++i)
        for (int j = 0; j <= i; ++j) {
            double sum = h[i][j];
            for (int k = 0; k < j; ++k)
                sum -= h[i][k] * h[j][k];
            if (i == j && !(sum > 0.0))
                return 0;
            h[i][j] = i == j ? sqrt(sum) : sum / h[j][j];
        }
    for (int i = 0; i < FREEDOMS; ++i) {
        x[i] = -g[i];
        for (int k = 0; k < i; ++k)
            x[i] -= h[i][k] * x[k];
        x[i] /= h[i][i];
    }
    for (int i = FREEDOMS - 1; i >= 0; --i) {
        for (int k = i + 1; k < FREEDOMS; ++k)
            x[i] -= h[k][i] * x[k];
        x[i] /= h[i][i];
    }
    return 1;
}

static double largest(const double gradient[FREEDOMS])
{
    double most = 0.0;
    for (int i = 0; i < FREEDOMS; ++i)
        most = fmax(most, fabs(gradient[i]));
    return most;
}

/* What the forces need not be closer to 0 than: places are known to 1e-16 of R, a motion to 1e-16 of it; and 1 aN. */
static double finest(const balance *step, const double motion[FREEDOMS], const balance_value *value)
{
    double rounding = 0.0;
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        rounding += step->pushing->particle.radius * fabs(value->contacts[i].k);
        for (int j = 0; j < NT_BRISTLES; ++j)
            rounding += largest(motion) * step->from->bristles[i][j].stiffness;
    }
    return 4e-15 * rounding + 1e-18;
}

/* Along Newton's direction until the cost has fallen. 0: it does not. */
static int go_down(const balance *step, double motion[FREEDOMS], const double direction[FREEDOMS], balance_value *value,
                   double n[3])
{
    const nt_particle *particle = &step->pushing->particle;
    const double reach = 0.05 * fmin(particle->radius, particle->tip_radius); /* not through the tip */
    double slope = 0.0, share = 1.0;
    if (!(norm(direction) <= reach))
        return 0;
    for (int i = 0; i < FREEDOMS; ++i)
        slope += value->gradient[i] * direction[i];
    for (int tries = 0; tries < HALVINGS; ++tries, share *= 0.5) {
        double to[FREEDOMS], there[3];
        balance_value found;
        for (int i = 0; i < FREEDOMS; ++i)
            to[i] = motion[i] + share * direction[i];
        if (value_at(step, to, &found, there) != NT_OK)
            continue;
        const double size = fabs(found.contacts[0].U) + fabs(found.contacts[1].U);
        const double rounding = 1e-15 * (size + found.scale * particle->radius);
        const int closer = largest(found.gradient) < 0.9 * largest(value->gradient);
        if (found.cost <= value->cost + 1e-4 * share * slope || (closer && found.cost <= value->cost + rounding)) {
            memcpy(motion, to, sizeof to);
            memcpy(n, there, sizeof there);
            *value = found;
            return 1;
        }
    }
    return 0;
}

/* Newton's step, and if it does not go down, a shorter and steeper one (Levenberg). 0: none does. */
static int improve(balance *step, double motion[FREEDOMS], balance_value *value, double n[3], double *damping)
{
    double hessian[FREEDOMS][FREEDOMS], direction[FREEDOMS];
    hessian_at(step, value, n, hessian);
    for (*damping = fmax(*damping / 100.0, DAMPING); *damping < DAMPING_MAX; *damping *= 4.0)
        if (solve(hessian, *damping, value->gradient, direction) && go_down(step, motion, direction, value, n))
            return 1;
    return 0;
}

nt_status balance_find(balance *step, double motion[FREEDOMS], balance_value *value)
{
    double n[3], damping = DAMPING;
    memset(motion, 0, sizeof(double[FREEDOMS]));
    const nt_status status = value_at(step, motion, value, n);
    if (status != NT_OK)
        return status;
    for (int i = 0; i < ITERATIONS; ++i) {
        if (largest(value->gradient) <= EXACT * value->scale + finest(step, motion, value))
            return NT_OK;
        if (!improve(step, motion, value, n, &damping))
            break;
        for (int which = 0; which < NT_PARTICLE_CONTACTS; ++which)
            step->attached[which] |= value->contacts[which].a > 0.0;
    }
    const double enough = ENOUGH * value->scale + finest(step, motion, value) + FAINT;
    return largest(value->gradient) <= enough ? NT_OK : NT_E_NO_CONVERGENCE;
}
