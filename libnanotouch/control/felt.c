/* SPDX-License-Identifier: BSD-3-Clause
 * The force scale of a first touch (docs/margins.md): the sample's pull-off is clearly felt, as far as Eq. 19,
 * stability and calm allow. */
#include <math.h>

#include "nanotouch/margins.h"

#define SEEN 0.93      /* of a plan's pull-off that a loop shows at least: the tear lies between two of its steps */
#define WELL_ARMED 3.0 /* margin: twice that at which sessions are armed */
#define BISECTIONS 8   /* to 2 % of a range of 100 */

static int is_at_ease(const nt_rig *rig, const nt_settings *settings, double contact_stiffness)
{
    nt_margins margins;
    return nt_margins_judge(rig, settings, contact_stiffness, NT_MODE_TOUCH, &margins).margin >= WELL_ARMED &&
           nt_margins_calm(rig, settings, contact_stiffness).margin >= 1.0;
}

double nt_margins_felt_alpha_f(const nt_rig *rig, const nt_settings *settings, double pull_off_force, double load,
                               double contact_stiffness)
{
    const nt_master *master = &rig->master;
    const double reach = master->gauge ? fmin(master->gauge_range, master->max_force) : master->max_force;
    const double wanted = pull_off_force > 0.0 ? NT_CLEARLY_FELT / (SEEN * pull_off_force) : HUGE_VAL;
    nt_settings trial = *settings;
    double low = settings->gains.alpha_f, high = fmin(wanted, 2.0 * reach / (pull_off_force + load));
    if (!(high > low))
        return low;
    trial.gains.alpha_f = high;
    if (is_at_ease(rig, &trial, contact_stiffness))
        return high;
    for (int i = 0; i < BISECTIONS; i++) {
        trial.gains.alpha_f = sqrt(low * high);
        if (is_at_ease(rig, &trial, contact_stiffness))
            low = trial.gains.alpha_f;
        else
            high = trial.gains.alpha_f;
    }
    return low;
}
