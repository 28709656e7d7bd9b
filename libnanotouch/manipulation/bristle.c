/* SPDX-License-Identifier: BSD-3-Clause
 * A spring that gives way at a limit: see bristle.h. */
#include "manipulation/bristle.h"

#include <math.h>

#include "manipulation/vector.h"

double bristle_stored(const nt_bristle *bristle)
{
    return bristle->stiffness > 0.0 ? 0.5 * dot(bristle->pull, bristle->pull) / bristle->stiffness : 0.0;
}

double bristle_cost(const nt_bristle *bristle, double limit, const double stretch[3], double pull[3])
{
    const double k = bristle->stiffness, length = norm(stretch);
    const int gives = k * length > limit;
    for (int i = 0; i < 3; ++i)
        pull[i] = gives ? limit / length * stretch[i] : k * stretch[i];
    return gives ? limit * (length - 0.5 * limit / k) : 0.5 * k * length * length;
}

void bristle_tangent(const nt_bristle *bristle, double limit, const double stretch[3], double projector[3][3],
                     double tangent[3][3])
{
    const double k = bristle->stiffness, length = norm(stretch);
    const int gives = k * length > limit;
    const double across = gives ? limit / length : k;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double along = gives ? stretch[i] * stretch[j] / (length * length) : 0.0;
            tangent[i][j] = across * (projector[i][j] - along);
        }
}

/* The pull falls to `share` of itself; returns what the spring loses, which has `left` of its energy. */
static double give_up(nt_bristle *bristle, double share, double left)
{
    const double stored = bristle_stored(bristle);
    for (int i = 0; i < 3; ++i)
        bristle->pull[i] *= share;
    return stored * (1.0 - left);
}

double bristle_change(nt_bristle *bristle, double stiffness, double limit)
{
    double heat = 0.0;
    if (stiffness > bristle->stiffness && bristle->stiffness > 0.0)
        heat += give_up(bristle, 1.0, bristle->stiffness / stiffness);
    else if (stiffness < bristle->stiffness)
        heat += give_up(bristle, stiffness / bristle->stiffness, stiffness / bristle->stiffness);
    bristle->stiffness = stiffness;
    const double pull = norm(bristle->pull);
    if (pull > limit)
        heat += give_up(bristle, limit / pull, limit / pull * (limit / pull));
    return heat;
}

double bristle_end(nt_bristle *bristle, double limit, const double stretch[3])
{
    const double length = norm(stretch);
    (void)bristle_cost(bristle, limit, stretch, bristle->pull);
    if (!(bristle->stiffness * length > limit))
        return 0.0;
    const double given = length - limit / bristle->stiffness;
    bristle->given += given;
    return limit * given;
}
