/* SPDX-License-Identifier: BSD-3-Clause
 * What a session is judged by, whatever its law. */
#include "control/known_law.h"

#include <math.h>

/* A law of one's own, that is: what it amounts to, or not a number, which is refused. The height servo has none. */
static nt_verdict judge_own(const nt_rig *rig, const nt_settings *settings, double contact_stiffness, nt_mode mode,
                            nt_margins *margins)
{
    nt_settings amounts = *settings;
    const nt_status status = nt_margins_own_law(rig, settings, contact_stiffness, &amounts);
    amounts.control.choice = NT_CONTROL_DEFAULT;
    const nt_verdict verdict = nt_verdict_on_known(rig, &amounts, contact_stiffness, mode, margins);
    if (status == NT_OK)
        return verdict;
    const double height = margins->height_margin;
    *margins = (nt_margins){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    margins->height_margin = height;
    return mode == NT_MODE_TOUCH ? (nt_verdict)NT_VERDICT(NAN, "own law, of no kind that can be judged") : verdict;
}

nt_verdict nt_margins_judge(const nt_rig *rig, const nt_settings *settings, double contact_stiffness, nt_mode mode,
                            nt_margins *margins)
{
    return settings->control.choice == NT_CONTROL_OWN
               ? judge_own(rig, settings, contact_stiffness, mode, margins)
               : nt_verdict_on_known(rig, settings, contact_stiffness, mode, margins);
}
