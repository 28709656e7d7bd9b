/* SPDX-License-Identifier: BSD-3-Clause
 * Written by nanotouch 0.2.0: do not edit. Needs nanotouch_single.h and .c (tools/single.py).
 *
 * plan_force: the force over the gap, 31 pieces. It is within 0.001 of max(|F|, 18 nN) of the plan's
 * where the gap is 0 m or more from a fold, a jump and first touch. The plan's own bound is below.
 * plan_touch: the touch step in the mode "approach", 10000 steps in a second.
 *
 * contact: Maugis-Dugdale table, lambda 0.0401; adhesion by a water meniscus, w = 140.9 mJ/m2 beside van der Waals;
 * Hertz would err by 86 %, DMT would err by 23 %, JKR would err by 26 %
 * van der Waals: in Derjaguin's form, at most 393.6 pN, 2.2 % of the pull-off; this form errs by 0.1 %
 * force within 0.11 % of the larger of itself and 17.98 nN, the pull-off; folds within 0.029 pm, bound from 0.2 pm
 * beside them on; cost 2 Hertz evaluations (1.9 where each waits for the last), everything exact 7
 * pull-off 17.98 nN; the force jumps in, whatever the spring; stiffest contact 665 N/m
 */
#ifndef NANOTOUCH_CONSTANTS_PLAN_H
#define NANOTOUCH_CONSTANTS_PLAN_H

#include <math.h>

#include "nanotouch_single.h"

static const ntf_force_piece plan_pieces[31] = {
    {-9.29994082e-10f, 2.15055130e+09f, {3.99588487e-07f, -3.09100329e-07f, 3.73146136e-08f, 5.00933739e-09f}},
    {-4.64997041e-10f, 4.30110259e+09f, {1.32812090e-07f, -1.09721547e-07f, 1.31080142e-08f, 1.69512593e-09f}},
    {-2.32498520e-10f, 8.60220518e+09f, {3.78936846e-08f, -3.92100716e-08f, 4.56205962e-09f, 5.48926071e-10f}},
    {-1.16249260e-10f, 1.72044104e+10f, {3.79459930e-09f, -1.42195873e-08f, 1.55943680e-09f, 1.64867411e-10f}},
    {-5.81246301e-11f, 1.72044104e+10f, {-8.70068373e-09f, -1.06061115e-08f, 1.88388838e-09f, 5.81641291e-10f}},
    {0.00000000e+00f, 8.00000000e+10f, {-1.68412662e-08f, -1.09536424e-09f, 1.77952722e-10f, 3.21239112e-11f}},
    {1.25000002e-11f, 1.60000016e+11f, {-1.77265544e-08f, -3.21543486e-10f, 6.61211710e-11f, 1.73238490e-11f}},
    {1.87499998e-11f, 1.59999984e+11f, {-1.79646520e-08f, -1.37329620e-10f, 2.54797156e-10f, -9.15723400e-11f}},
    {2.50000003e-11f, 8.00000082e+10f, {-1.79387563e-08f, 1.95095287e-10f, 3.32025099e-15f, 1.88559344e-17f}},
    {3.74999996e-11f, 4.00000041e+10f, {-1.77436590e-08f, 3.90203952e-10f, 1.35055719e-14f, 1.57425282e-16f}},
    {6.24999982e-11f, 2.00000020e+10f, {-1.73534414e-08f, 7.80462861e-10f, 5.58803627e-14f, 1.37498572e-15f}},
    {1.12499995e-10f, 1.14285701e+10f, {-1.65729208e-08f, 1.36601308e-09f, 1.83422843e-13f, 8.73390495e-15f}},
    {2.00000003e-10f, 4.00000000e+09f, {-1.52067159e-08f, 3.90401711e-09f, 1.65761946e-12f, 3.32134575e-13f}},
    {4.50000009e-10f, 8.00000102e+09f, {-1.13007088e-08f, 1.95416416e-09f, 6.72238795e-13f, 7.87743080e-14f}},
    {5.74999992e-10f, 7.99999949e+09f, {-9.34579347e-09f, 1.95574534e-09f, -1.13412460e-10f, 1.14449630e-10f}},
    {7.00000002e-10f, 4.53344666e+09f, {-7.38901074e-09f, 3.65685393e-09f, -6.64026542e-11f, 1.64599324e-11f}},
    {9.20582721e-10f, 9.06689536e+09f, {-3.78209952e-09f, 1.78671378e-09f, -5.24922900e-12f, 2.47430982e-12f}},
    {1.03087405e-09f, 1.81337907e+10f, {-1.99816075e-09f, 8.91819119e-10f, 3.51957341e-13f, 1.25380858e-12f}},
    {1.08601972e-09f, 3.62675814e+10f, {-1.10473575e-09f, 4.48142246e-10f, 9.05112302e-13f, 8.43946169e-13f}},
    {1.11359255e-09f, 7.25351629e+10f, {-6.54844456e-10f, 2.26242150e-10f, 7.72586910e-13f, 5.92301165e-13f}},
    {1.12737897e-09f, 1.45069162e+11f, {-4.27237412e-10f, 1.14783037e-10f, 5.76131590e-13f, 4.18322630e-13f}},
    {1.13427223e-09f, 2.90143011e+11f, {-3.11459913e-10f, 5.85941920e-11f, 4.14455308e-13f, 2.95725656e-13f}},
    {1.13771881e-09f, 5.80286022e+11f, {-2.52155546e-10f, 3.01551388e-11f, 2.94786602e-13f, 2.09100803e-13f}},
    {1.13944210e-09f, 1.16057204e+12f, {-2.21496516e-10f, 1.56860080e-11f, 2.08870193e-13f, 1.47853789e-13f}},
    {1.14030374e-09f, 2.32084498e+12f, {-2.05453779e-10f, 8.27472032e-12f, 1.47821357e-13f, 1.04601163e-13f}},
    {1.14073462e-09f, 4.64288639e+12f, {-1.96926642e-10f, 4.44093894e-12f, 1.04527769e-13f, 7.39163844e-14f}},
    {1.14095000e-09f, 9.28577277e+12f, {-1.92307253e-10f, 2.43587182e-12f, 7.39173872e-14f, 5.22614416e-14f}},
    {1.14105769e-09f, 9.28577277e+12f, {-1.89745206e-10f, 2.74049078e-12f, -9.39097342e-11f, 9.49280168e-11f}},
    {7.00000002e-10f, 2.26672358e+09f, {-4.11522622e-10f, 4.03443418e-10f, -2.50185123e-10f, 7.29478283e-11f}},
    {1.14116538e-09f, 8.42345088e+08f, {-1.85316498e-10f, 3.28073901e-10f, -3.05601877e-10f, 1.10699526e-10f}},
    {2.32832731e-09f, 2.80781728e+08f, {-5.21449377e-11f, 1.46906168e-10f, -1.74855033e-10f, 7.11056422e-11f}},
};

static const ntf_force_table plan_force = {
    plan_pieces,
    28, /* contact */
    3, /* apart */
    6.99999947e-10f, /* capture_gap */
    1.14116538e-09f, /* release_gap */
    5.88981264e-09f, /* farthest */
    1.79763244e-08f, /* scale */
    9.98725765e-04f, /* bound */
    0.00000000e+00f, /* fold_distance */
};

static const ntf_touch plan_touch = {
    {
        {
            8.00000000e+00f, /* spring_constant */
            0.00000000e+00f, /* tilt */
            3.29999992e-08f, /* sensitivity */
            1.00000000e+01f, /* range */
            5.00000007e-02f, /* noise */
            3.05175781e-04f, /* resolution */
            1.00000000e+05f, /* resonance */
            1.00000000e+02f, /* quality */
            2.95000000e+02f, /* temperature */
            0.00000000e+00f, /* contact_viscosity */
            5.00000007e-02f, /* spring_constant_sigma */
            1.99999996e-02f, /* sensitivity_sigma */
            1.00000001e-10f, /* drift */
            0.00000000e+00f, /* lateral_stiffness */
        }, /* probe */
        {
            4.50000000e+02f, /* resonance */
            2.00000000e+01f, /* quality */
            1.00000000e+06f, /* stiffness */
            9.99999975e-05f, /* travel */
            9.99999972e-10f, /* resolution */
            1.00000001e-10f, /* command_resolution */
            9.99999975e-05f, /* max_speed */
            0.00000000e+00f, /* noise */
            0.00000000e+00f, /* hysteresis */
            0.00000000e+00f, /* creep */
            1.00000000e+00f, /* axes */
            9.99999972e-10f, /* drift */
            9.99999994e-09f, /* slip */
            0.00000000e+00f, /* travel_sigma */
            0.00000000e+00f, /* position_sigma */
        }, /* stage */
        {
            1.00000001e-01f, /* mass */
            1.00000000e+02f, /* damping */
            0.00000000e+00f, /* friction */
            1.99999996e-02f, /* travel */
            3.99999990e-05f, /* resolution */
            5.00000000e+00f, /* max_force */
            3.00000012e-01f, /* max_speed */
            1, /* gauge */
            5.00000000e+00f, /* gauge_range */
            3.33333341e-03f, /* gauge_noise */
            1.99999996e-02f, /* gauge_resolution */
            1, /* motor */
            0.00000000e+00f, /* rate */
            1.00000000e+00f, /* axes */
        }, /* master */
        {
            0.00000000e+00f, /* mass */
            0.00000000e+00f, /* damping */
            0.00000000e+00f, /* stiffness */
            0.00000000e+00f, /* relaxation */
            0.00000000e+00f, /* random_force */
            0.00000000e+00f, /* random_rate */
        }, /* hand */
        {
            0.00000000e+00f, /* adc_bits */
            0.00000000e+00f, /* adc_rate */
            0.00000000e+00f, /* adc_latency */
            0.00000000e+00f, /* dac_bits */
            0.00000000e+00f, /* dac_latency */
        }, /* converters */
    }, /* rig */
    {
        {
            1.00000000e+04f, /* rate */
            1.99999995e-05f, /* alpha_p */
            3.08641975e+06f, /* alpha_f */
            1.00000000e+00f, /* alpha_f_approach */
            1.00000000e+00f, /* alpha_f_retract */
            2.00000000e+00f, /* force_gain */
            2.00000000e+02f, /* force_filter */
            0.00000000e+00f, /* velocity_feedforward */
            6.99999988e-01f, /* stage_damping */
            6.00000000e+01f, /* stage_integral */
            5.00000000e-01f, /* stage_proportional */
            0.00000000e+00f, /* stage_derivative */
            0.00000000e+00f, /* coupling_stiffness */
            0.00000000e+00f, /* coupling_damping */
            0.00000000e+00f, /* projection_x */
            0.00000000e+00f, /* projection_y */
            1.00000001e-01f, /* ramp_time */
            1.00000001e-07f, /* set_point */
            3.00000000e+02f, /* height_gain */
            3.00000000e+03f, /* height_stiffness */
            9.99999997e-07f, /* approach_speed */
            4.99999999e-07f, /* curve_length */
            1.00000000e+00f, /* delay */
        }, /* gains */
        {
            2.24399992e-06f, /* force */
            2.24399992e-06f, /* lateral_force */
            3.00000011e-07f, /* indentation */
            1.99999995e-05f, /* stage_speed */
            1.99999995e-05f, /* lateral_speed */
            5.00000000e+00f, /* motor_force */
            2.00000000e+03f, /* motor_rate */
            2.00000000e+00f, /* motor_power */
            4.99999999e-07f, /* retract_distance */
            9.99999975e-06f, /* retract_speed */
            1.00000001e-07f, /* follow_error */
            5.00000007e-02f, /* follow_time */
            3.29999992e-08f, /* deflection_bias */
            9.89999975e-08f, /* deflection_drift */
            5.00000000e-01f, /* gauge_bias */
            1.50000000e+00f, /* gauge_drift */
        }, /* limits */
        {
            1, /* at */
            0.00000000e+00f, /* frequency */
            1.99999999e-08f, /* free_amplitude */
            1.00000001e-01f, /* tolerance */
            0, /* hold */
            6.99999988e-01f, /* set_amplitude */
            7.85398185e-01f, /* set_phase */
            1.99999995e-05f, /* lock_in */
            1.99999999e-11f, /* noise */
            0.00000000e+00f, /* resolution */
        }, /* tap */
        {
            (ntf_control_choice)0, /* choice */
            0, /* none */
            0, /* none */
        }, /* control */
    }, /* settings */
    (ntf_mode)2, /* mode */
    9.99999975e-05f, /* period */
    ntf_servo_default, /* law */
    {
        {8.3166756334817293e-01, -1.5860801645013831e+00, 8.1999285823423818e-01}, /* b */
        {1.0000000000000000e+00, -1.6075336746265632e+00, 6.7311393170759115e-01}, /* a */
        6.0000000000000001e-03, /* integral */
    }, /* stage_loop */
    0, /* leads_sideways */
    0, /* feels_sideways */
    {{-INFINITY, INFINITY}, {-INFINITY, INFINITY}}, /* borders */
    1.18088625e-01f, /* force_filter */
    1u, /* delay */
    1.24877430e-02f, /* speed_filter */
    1.99999994e-09f, /* stage_step */
    4.99999987e-05f, /* stage_end */
    2.00000003e-01f, /* motor_step */
    6.33249572e-03f, /* fade_product */
    0.00000000e+00f, /* drive_amplitude */
    0.00000000e+00f, /* drive_frequency */
    1.93022114e-08f, /* spike */
    {
        2.50000012e-04f, /* dead_zone */
        2.00000009e-03f, /* due */
        2.00000000e+00f, /* force_gain */
        1.00000000e+02f, /* damping */
        0.00000000e+00f, /* credit */
        1.18088625e-01f, /* speed_filter */
        4.72354479e-02f, /* speed_floor */
        1.00000000e+00f, /* speed_limit */
        9.99999975e-05f, /* period */
    }, /* passivity */
    {
        2.50000012e-04f, /* dead_zone */
        2.00000009e-03f, /* due */
        0.00000000e+00f, /* force_gain */
        1.00000000e+02f, /* damping */
        1.00000000e+02f, /* credit */
        1.18088625e-01f, /* speed_filter */
        4.72354479e-02f, /* speed_floor */
        1.00000000e+00f, /* speed_limit */
        9.99999975e-05f, /* period */
    }, /* passivity_sideways */
    {
        1.00000005e-03f, /* share */
        1.32002462e-08f, /* threshold */
        8.00000000e+00f, /* spring_constant */
        1.66666671e-03f, /* income */
        4.99999989e-03f, /* capacity */
        {1.00000000e+00f, 1.00000000e+00f, 1.00000000e+00f}, /* factors */
    }, /* rescale */
    {
        9.99999975e-05f, /* master_period */
        9.99999975e-05f, /* period */
        8.00000000e+00f, /* spring_constant */
        0.00000000e+00f, /* lateral_stiffness */
        3.30000006e-07f, /* deflection_range */
        1.32806468e-08f, /* free_force */
        1.99999996e-02f, /* master_range */
        0, /* leads_sideways */
        5.00000000e+00f, /* gauge_range */
        9.99999975e-05f, /* stage_range */
        4.99999997e-09f, /* stuck_distance */
        2.74999995e-10f, /* noise */
        1.43854111e-01f, /* stage_share */
        1.99999999e-08f, /* stage_slack */
        1.00000001e-07f, /* stage_most */
        1.00000001e-07f, /* correction_most */
        1.99999999e-08f, /* turn_slack */
        0.00000000e+00f, /* lift_share */
        9.98001993e-01f, /* path_kept */
        {
            2.24399992e-06f, /* force */
            2.24399992e-06f, /* lateral_force */
            3.00000011e-07f, /* indentation */
            1.99999995e-05f, /* stage_speed */
            1.99999995e-05f, /* lateral_speed */
            5.00000000e+00f, /* motor_force */
            2.00000000e+03f, /* motor_rate */
            2.00000000e+00f, /* motor_power */
            4.99999999e-07f, /* retract_distance */
            9.99999975e-06f, /* retract_speed */
            1.00000001e-07f, /* follow_error */
            5.00000007e-02f, /* follow_time */
            3.29999992e-08f, /* deflection_bias */
            9.89999975e-08f, /* deflection_drift */
            5.00000000e-01f, /* gauge_bias */
            1.50000000e+00f, /* gauge_drift */
        }, /* limits */
        {
            0.00000000e+00f, /* lost */
            0.00000000e+00f, /* most */
            0u, /* settling */
            {
                0.00000000e+00f, /* distance */
                0.00000000e+00f, /* noise */
            }, /* stuck */
            0.00000000e+00f, /* shake */
            0.00000000e+00f, /* reach */
            0.00000000e+00f, /* memory */
            0.00000000e+00f, /* kept */
            0.00000000e+00f, /* share */
        }, /* amplitude */
    }, /* supervisor */
};

#endif
