/* SPDX-License-Identifier: BSD-3-Clause
 * What the three laws mean for the stability rules. */
#include "internal/control.h"
#include "internal/rig.h"
#include "nanotouch/control.h"

#include <math.h>

#include "control/servo.h"
#include "core/clamp.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/material.h"

/* alpha_f alpha_p k_eff: the contact, through the lever, at the operator's scale [N/m]. */
static double reflected_stiffness(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const double k_c = rig->probe.spring_constant;
    return gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
}

/* The contact that would feel as this one does through the coupling. */
static double softened(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    if (gains->coupling_stiffness == 0.0)
        return contact_stiffness;
    const double k_c = rig->probe.spring_constant;
    const double k_r = reflected_stiffness(rig, gains, contact_stiffness);
    const double k_eff = k_r / (1.0 + k_r / gains->coupling_stiffness) / (gains->alpha_f * gains->alpha_p);
    return k_eff / (1.0 - k_eff / k_c);
}

nt_servo_equivalent nt_servo_equivalent_of(const nt_rig *rig, const nt_settings *settings, double contact_stiffness)
{
    nt_servo_equivalent equivalent = {nt_rig_with_steps(rig), settings->gains, contact_stiffness};
    const nt_control_choice choice = settings->control.choice;
    if (choice == NT_CONTROL_DEFAULT || choice == NT_CONTROL_IMPEDANCE)
        equivalent.rig.master.damping *= 1.0 - settings->gains.velocity_feedforward;
    if (choice == NT_CONTROL_IMPEDANCE || !rig->master.gauge)
        equivalent.gains.force_gain = 0.0;
    if (choice == NT_CONTROL_PAPER || !nt_stage_loop_notches(&rig->stage, &settings->gains))
        equivalent.gains.stage_damping = 0.5 / rig->stage.quality;
    if (choice == NT_CONTROL_PAPER)
        equivalent.gains.stage_integral = 0.0;
    equivalent.gains.alpha_f *=
        greater(1.0, greater(equivalent.gains.alpha_f_approach, equivalent.gains.alpha_f_retract));
    equivalent.contact_stiffness = softened(rig, &equivalent.gains, contact_stiffness);
    return equivalent;
}

/* The square wave's fundamental times the gain of the resonance that the notch leaves, or, where that is more, all that
 * a speed can make of the step response, v int |1 - s| dt = 2 v/(w_n (1 - exp(-pi zeta/sqrt(1 - zeta^2)))), less the
 * lag 2 zeta v/w_n that the reaction time holds already. */
double nt_servo_ringing(const nt_servo_equivalent *equivalent, double speed)
{
    const double zeta = equivalent->gains.stage_damping, split = zeta < 1.0 ? sqrt(1.0 - zeta * zeta) : 0.0;
    const double gain = 2.0 * zeta * zeta < 1.0 ? 0.5 / (zeta * split) : 1.0;
    const double all = split > 0.0 ? -2.0 / expm1(-NT_PI * zeta / split) - 2.0 * zeta : 0.0;
    return greater(4.0 / NT_PI * gain, all) * speed / (2.0 * NT_PI * equivalent->rig.stage.resonance);
}
