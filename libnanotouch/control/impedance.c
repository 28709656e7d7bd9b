/* SPDX-License-Identifier: BSD-3-Clause
 * What the hand feels at a contact, over frequency: Z = f_m/x_m', how far it is from the contact's own (transparency,
 * Lawrence 1993), and Llewellyn's criterion on the two-port between hand and tip (Hashtrudi-Zaad and Salcudean 2001).
 *
 * A hand moves the master as X exp(j w t). With A = (b + j w m) j w X, R = k_r Hs X what the tip reflects, P the
 * low-pass of f_m, H the motor's hold and dead time, and d the whole periods after which a force is seen by the gauge:
 *   tau = -(1 + K_f) R + K_f P F,   F = A - z^-d tau  (f_m at the samples),   f_m = A - H tau.
 * At rest Z is (b + j w m)/(1 + K_f) + k_r C/(j w). Where P has turned f_m, far above its corner, Z can give energy to
 * the hand: Re Z < 0. Left out is what the steps of the held force put at multiples of the rate. */
#include <math.h>

#include "control/sampled.h"
#include "core/same_bits.h"
#include "internal/margins.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

#define SQRT2 1.41421356237309504880

/* H: a hold over a period, behind a dead time. */
static double complex hold(double theta, double dead_angle)
{
    const double half = 0.5 * theta, lag = half + dead_angle;
    return sin(half) / half * nt_complex(cos(lag), -sin(lag));
}

nt_loop_response nt_margins_response(const nt_rig *rig, const nt_gains *gains, double contact_stiffness,
                                     double frequency)
{
    nt_loop_response response = {{NAN, NAN}, {NAN, NAN}, NAN};
    if (!(frequency > 0.0 && frequency <= 0.5 * gains->rate))
        return response;
    const nt_sampled_loop loop = nt_sampled_loop_make(rig, gains);
    const double w = 2.0 * NT_PI * frequency, theta = w * loop.master.period, k_c = rig->probe.spring_constant;
    const double k_r = gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
    const double dead_time = nt_sampled_dead_time(rig, gains) + 2.0 * nt_sampled_master_hold(rig, gains);
    const double seen = (1.0 + loop.master.whole) * theta; /* z^-d */
    const double complex motor = hold(theta, w * dead_time), stage = nt_sampled_stage(&loop, theta);
    const double complex gain = gains->force_gain * nt_sampled_low_pass(&loop, theta);
    const double complex share = motor / (1.0 + gain * nt_complex(cos(seen), -sin(seen)));
    const double complex path = motor * stage, felt = share * stage; /* of C; of what f_m leaves of it */
    const double complex own = nt_complex(rig->master.damping, w * rig->master.mass) * (1.0 - gain * share);
    const double complex impedance = own + (1.0 + gains->force_gain) * k_r * felt * nt_complex(0.0, -1.0 / w);
    response.path[0] = creal(path);
    response.path[1] = cimag(path);
    response.impedance[0] = creal(impedance);
    response.impedance[1] = cimag(impedance);
    response.llewellyn = creal(felt) / cabs(felt); /* Re h22 = 0: the stage is a source of position */
    return response;
}

/* Is |Z| within 3 dB of the contact's own? */
static int is_transparent(const nt_rig *rig, const nt_gains *gains, double contact_stiffness, double frequency)
{
    const nt_loop_response at = nt_margins_response(rig, gains, contact_stiffness, frequency);
    const double k_c = rig->probe.spring_constant;
    const double k_r = gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
    const double ratio = hypotenuse(at.impedance[0], at.impedance[1]) * 2.0 * NT_PI * frequency / k_r;
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
