/* SPDX-License-Identifier: BSD-3-Clause
 * Forces and torques of particles and tip as derivatives of one function. With limits and directions held for a step,
 * bristles have a convex cost, whose gradient is their pull (Simo and Hughes 1998, return map as a minimum); with the
 * energies of contacts and lever it is a function of the motion. */
#include "manipulation/balance.h"

#include <math.h>
#include <string.h>

#include "manipulation/bristle.h"
#include "manipulation/vector.h"

enum { LOCAL = 2 * FREEDOMS }; /* of a link: of its particle, then of the other body */

void balance_count(balance *step)
{
    step->freedoms = FREEDOMS * step->particles;
    for (int i = 0; i < 3; ++i)
        step->tip_freedom[i] = step->lever[i] > 0.0 ? step->freedoms++ : -1;
}

double balance_tip_indentation(const nt_particle *particle, const double centre[3], const double tip[3], double n[3])
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

nt_status balance_contact(const nt_particle_laws *laws, int attached, double indentation, nt_law_value *value)
{
    const nt_branch branch = attached ? NT_BRANCH_STABLE : NT_BRANCH_APPROACH;
    return nt_contact_law_eval(&laws->normal, indentation, branch, value);
}

/* How far a body moves, and turns. */
static void motion_of(const balance *step, const double motion[], int body, double out[FREEDOMS])
{
    memset(out, 0, sizeof(double[FREEDOMS]));
    if (body >= 0)
        memcpy(out, motion + FREEDOMS * body, sizeof(double[FREEDOMS]));
    for (int i = 0; i < 3 && body == BODY_TIP; ++i)
        out[i] = step->tip_freedom[i] >= 0 ? motion[step->tip_freedom[i]] : step->base[i] - step->tip[i];
}

/* How motions of both bodies stretch a bristle: the surfaces against each other, or the turn of one against the other,
 * across or along the normal. */
static void stretch_of(const double n[3], int bristle, const double motion[LOCAL], double way[3])
{
    const double *of = motion, *other = motion + FREEDOMS;
    double moved[3], turned[3];
    for (int i = 0; i < 3; ++i) {
        moved[i] = bristle == NT_SLIDING ? of[i] - other[i] : of[3 + i] - other[3 + i];
        turned[i] = of[3 + i] + other[3 + i];
    }
    if (bristle == NT_SLIDING) {
        double rolled[3];
        cross(turned, n, rolled);
        for (int i = 0; i < 3; ++i)
            moved[i] -= rolled[i];
    }
    const double along = dot(moved, n);
    for (int i = 0; i < 3; ++i)
        way[i] = bristle == NT_SPINNING ? along * n[i] : moved[i] - along * n[i];
}

/* Adds a force, and a torque over R, on the freedoms of a body; of the tip what it feels. */
static void add_to(const balance *step, int body, int particle, const double force[3], const double torque[3],
                   balance_value *value)
{
    for (int i = 0; i < 3 && body >= 0; ++i) {
        value->gradient[FREEDOMS * body + i] += force[i];
        value->gradient[FREEDOMS * body + 3 + i] += torque[i];
    }
    for (int i = 0; i < 3 && body == BODY_TIP; ++i) {
        value->tip_shares[particle][i] -= force[i];
        if (step->tip_freedom[i] >= 0)
            value->gradient[step->tip_freedom[i]] += force[i];
    }
}

/* Adds a bristle's pull to the forces on both bodies. */
static void add_pull(const balance *step, const balance_link *link, int bristle, const double pull[3],
                     balance_value *value)
{
    const int slides = bristle == NT_SLIDING;
    double torque[3], force[3], back[3], turn[3];
    memcpy(torque, pull, sizeof torque);
    if (slides)
        cross(pull, link->normal, torque);
    for (int i = 0; i < 3; ++i) {
        force[i] = slides ? pull[i] : 0.0;
        back[i] = -force[i];
        turn[i] = slides ? torque[i] : -torque[i];
    }
    add_to(step, link->particle, link->particle, force, torque, value);
    add_to(step, link->other, link->particle, back, turn, value);
}

static void local_motion(const balance *step, const balance_link *link, const double motion[], double local[LOCAL])
{
    motion_of(step, motion, link->particle, local);
    motion_of(step, motion, link->other, local + FREEDOMS);
}

static void bristles_at(const balance *step, int which, const double motion[], balance_value *value)
{
    const balance_link *link = &step->link[which];
    double local[LOCAL];
    local_motion(step, link, motion, local);
    for (int j = 0; j < NT_BRISTLES; ++j) {
        const nt_bristle *bristle = &link->bristles[j];
        double *stretch = value->link[which].stretches[j], pull[3];
        stretch_of(link->normal, j, local, stretch);
        if (!(bristle->stiffness > 0.0))
            continue;
        for (int i = 0; i < 3; ++i)
            stretch[i] += bristle->pull[i] / bristle->stiffness;
        value->cost += bristle_cost(bristle, link->limits[j], stretch, pull);
        value->scale += norm(pull);
        add_pull(step, link, j, pull, value);
    }
}

/* Unit vector from the other body to the particle, and how deep they overlap. */
static double indentation_of(const balance *step, const balance_link *link, double (*centres)[3], const double tip[3],
                             double n[3])
{
    const nt_particle *particle = step->particle;
    const double *centre = centres[link->particle];
    if (link->other == BODY_TIP)
        return balance_tip_indentation(particle, centre, tip, n);
    if (link->other == BODY_SUBSTRATE) {
        n[0] = n[1] = 0.0;
        n[2] = 1.0;
        return particle->radius - centre[2];
    }
    const double *other = centres[link->other];
    double away[3];
    for (int i = 0; i < 3; ++i)
        away[i] = centre[i] - other[i];
    const double distance = norm(away);
    for (int i = 0; i < 3; ++i)
        n[i] = distance > 0.0 ? away[i] / distance : (double)(i == 0);
    return 2.0 * particle->radius - distance;
}

static nt_status add_link(const balance *step, int which, double (*centres)[3], const double motion[],
                          balance_value *value)
{
    static const double none[3] = {0.0, 0.0, 0.0};
    const balance_link *link = &step->link[which];
    nt_law_value *contact = &value->link[which].contact;
    double *n = value->link[which].normal, force[3], back[3];
    const double indentation = indentation_of(step, link, centres, value->tip, n);
    const nt_status status = balance_contact(link->laws, link->attached, indentation, contact);
    if (status != NT_OK)
        return status;
    value->cost += contact->U;
    value->scale += fabs(contact->F);
    for (int i = 0; i < 3; ++i) {
        force[i] = -contact->F * n[i];
        back[i] = -force[i];
    }
    add_to(step, link->particle, link->particle, force, none, value);
    add_to(step, link->other, link->particle, back, none, value);
    bristles_at(step, which, motion, value);
    return NT_OK;
}

static void begin(const balance *step, const double motion[], balance_value *value)
{
    double moved[FREEDOMS];
    value->cost = value->scale = 0.0;
    memset(value->gradient, 0, (size_t)step->freedoms * sizeof value->gradient[0]);
    memset(value->tip_force, 0, sizeof value->tip_force);
    memset(value->tip_shares, 0, sizeof value->tip_shares);
    motion_of(step, motion, BODY_TIP, moved);
    for (int i = 0; i < 3; ++i)
        value->tip[i] = step->tip_freedom[i] >= 0 ? step->tip[i] + moved[i] : step->base[i];
}

nt_status balance_value_at(const balance *step, const double motion[], balance_value *value)
{
    double centres[NT_PARTICLES][3];
    begin(step, motion, value);
    for (int p = 0; p < step->particles; ++p)
        for (int i = 0; i < 3; ++i)
            centres[p][i] = step->from[p][i] + motion[FREEDOMS * p + i];
    for (int which = 0; which < step->links; ++which) {
        const nt_status status = add_link(step, which, centres, motion, value);
        if (status != NT_OK)
            return status;
    }
    for (int i = 0; i < 3; ++i) {
        for (int p = 0; p < step->particles; ++p)
            value->tip_force[i] += value->tip_shares[p][i];
        if (step->tip_freedom[i] < 0)
            continue;
        const double bent = value->tip[i] - step->base[i], pull = step->lever[i] * bent;
        value->cost += 0.5 * pull * bent;
        value->scale += fabs(pull);
        value->gradient[step->tip_freedom[i]] += pull;
    }
    return NT_OK;
}

/* The freedoms of a link: which of its own, and where in the motion. */
typedef struct freedoms {
    int count;
    int local[LOCAL], place[LOCAL];
} freedoms;

static freedoms freedoms_of(const balance *step, const balance_link *link)
{
    freedoms of = {0};
    for (int i = 0; i < LOCAL; ++i) {
        const int body = i < FREEDOMS ? link->particle : link->other, k = i % FREEDOMS;
        const int place = body >= 0 ? FREEDOMS * body + k : body == BODY_TIP && k < 3 ? step->tip_freedom[k] : -1;
        if (place < 0)
            continue;
        of.local[of.count] = i;
        of.place[of.count++] = place;
    }
    return of;
}

/* B^T D B, B the columns of what moves per unit of each freedom; the lower half. */
static void add_tangent(const balance_link *link, const freedoms *of, int j, double (*stretches)[3],
                        balance_matrix hessian)
{
    const nt_bristle *bristle = &link->bristles[j];
    const double *n = link->normal;
    double projector[3][3], tangent[3][3], columns[LOCAL][3];
    if (!(bristle->stiffness > 0.0))
        return;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            projector[i][k] = j == NT_SPINNING ? n[i] * n[k] : (double)(i == k) - n[i] * n[k];
    bristle_tangent(bristle, link->limits[j], stretches[j], projector, tangent);
    for (int i = 0; i < of->count; ++i) {
        double unit[LOCAL] = {0};
        unit[of->local[i]] = 1.0;
        stretch_of(n, j, unit, columns[i]);
    }
    for (int k = 0; k < of->count; ++k) {
        const double pulled[3] = {dot(tangent[0], columns[k]), dot(tangent[1], columns[k]),
                                  dot(tangent[2], columns[k])};
        for (int i = 0; i < of->count; ++i)
            if (of->place[k] <= of->place[i])
                hessian[of->place[i]][of->place[k]] += dot(columns[i], pulled);
    }
}

static void add_normal(const balance_link *link, const freedoms *of, const balance_link_value *value,
                       balance_matrix hessian)
{
    const double least = 1e-3 * link->laws->normal.maugis.contact.effective_modulus * value->contact.a;
    const double k = fmax(fabs(value->contact.k), least);
    for (int i = 0; i < of->count; ++i)
        for (int j = 0; j < of->count; ++j) {
            const int a = of->local[i], b = of->local[j];
            if (a % FREEDOMS < 3 && b % FREEDOMS < 3 && of->place[j] <= of->place[i])
                hessian[of->place[i]][of->place[j]] +=
                    (a / FREEDOMS == b / FREEDOMS ? k : -k) * value->normal[a % FREEDOMS] * value->normal[b % FREEDOMS];
        }
}

void balance_hessian(const balance *step, const balance_value *value, balance_matrix hessian)
{
    for (int i = 0; i < step->freedoms; ++i)
        memset(hessian[i], 0, (size_t)step->freedoms * sizeof hessian[i][0]);
    for (int which = 0; which < step->links; ++which) {
        const freedoms of = freedoms_of(step, &step->link[which]);
        add_normal(&step->link[which], &of, &value->link[which], hessian);
        for (int j = 0; j < NT_BRISTLES; ++j)
            add_tangent(&step->link[which], &of, j, (double (*)[3])value->link[which].stretches, hessian);
    }
    for (int i = 0; i < 3; ++i)
        if (step->tip_freedom[i] >= 0)
            hessian[step->tip_freedom[i]][step->tip_freedom[i]] += step->lever[i];
}
