/* SPDX-License-Identifier: BSD-3-Clause
 * What the hand feels at a contact, over frequency: the impedance Z = (m s + b)/(1 + K_f) + alpha_f alpha_p k_eff C/s,
 * how far it is from the contact's own (transparency, Lawrence 1993), and Llewellyn's criterion on the two-port between
 * hand and tip, h = [[(m s + b)/(1 + K_f), alpha_f C_m], [-alpha_p C_s, 0]] (Hashtrudi-Zaad and Salcudean 2001). */
#include <math.h>

#include "control/sampled.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

#define SQRT2 1.41421356237309504880

/* C: stage and its hop as sampled, then the motor's dead time and hold. */
static double complex path_at(const nt_sampled_loop *loop, double dead_time, double angular_frequency)
{
    const double T = loop->master.period, theta = angular_frequency * T;
    const double half = 0.5 * theta;
    const double lag = half + angular_frequency * dead_time;
    return nt_sampled_stage(loop, theta) * (sin(half) / half * nt_complex(cos(lag), -sin(lag)));
}

nt_loop_response nt_margins_response(const nt_rig *rig, const nt_gains *gains, double contact_stiffness,
                                     double frequency)
{
    nt_loop_response response = {{NAN, NAN}, {NAN, NAN}, NAN};
    if (!(frequency > 0.0 && frequency <= 0.5 * gains->rate))
        return response;
    const nt_sampled_loop loop = nt_sampled_loop_make(rig, gains);
    const double w = 2.0 * NT_PI * frequency, k_c = rig->probe.spring_constant;
    const double k_r = gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
    const double complex path = path_at(&loop, nt_sampled_dead_time(rig, gains), w);
    const double complex own = nt_complex(rig->master.damping, w * rig->master.mass) / (1.0 + gains->force_gain);
    const double complex impedance = own + k_r * path * nt_complex(0.0, -1.0 / w);
    response.path[0] = creal(path);
    response.path[1] = cimag(path);
    response.impedance[0] = creal(impedance);
    response.impedance[1] = cimag(impedance);
    response.llewellyn = creal(path) / cabs(path); /* Re h22 = 0: the stage is a source of position */
    return response;
}

/* Is |Z| within 3 dB of the contact's own? */
static int is_transparent(const nt_rig *rig, const nt_gains *gains, double contact_stiffness, double frequency)
{
    const nt_loop_response at = nt_margins_response(rig, gains, contact_stiffness, frequency);
    const double k_c = rig->probe.spring_constant;
    const double k_r = gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
    const double ratio = hypot(at.impedance[0], at.impedance[1]) * 2.0 * NT_PI * frequency / k_r;
    return ratio < SQRT2 && ratio * SQRT2 > 1.0;
}

double nt_margins_bandwidth(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const double nyquist = 0.5 * gains->rate;
    double low = 1e-9 * nyquist;
    if (isnan(contact_stiffness))
        return NAN;
    if (!is_transparent(rig, gains, contact_stiffness, low))
        return 0.0;
    double high = low;
    while (high < nyquist && is_transparent(rig, gains, contact_stiffness, high)) {
        low = high;
        high = fmin(1.05 * high, nyquist);
    }
    if (is_transparent(rig, gains, contact_stiffness, high))
        return nyquist;
    for (int i = 0; i < 50; i++) {
        const double middle = 0.5 * (low + high);
        *(is_transparent(rig, gains, contact_stiffness, middle) ? &low : &high) = middle;
    }
    return low;
}
