/* SPDX-License-Identifier: BSD-3-Clause
 * How far the loop is from its stability limit, from numbers alone, before anything moves (docs/margins.md). Rules R1
 * to R5 are sums of delays that a reader can check; beside them stands the exact limit of the sampled linear loop. For
 * another law than the default one take rig and gains from nt_servo_equivalent_of. Every function is thread-safe. */
#ifndef NANOTOUCH_MARGINS_H
#define NANOTOUCH_MARGINS_H

#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Limits that nothing comes near are infinite. */
typedef struct nt_margins {
    double loop_stiffness;  /* kappa = (1 + K_f) alpha_f alpha_p k_eff at the stiffest contact [N/m] */
    double loop_delay;      /* D = 2 (T/2 + dead time) + tau_stage [s] */
    double stability_limit; /* R1: b_m/D, less what the stage's integral costs; a rule of thumb, knows no hand [N/m] */
    double margin;          /* stability_limit/loop_stiffness [-]; 1 is the limit */
    double pad_limit;       /* R2: K_f at which a pad b_h on the gauge oscillates, f_m unfiltered [-] */
    double mass_limit;      /* R3: K_f at which a finger m_h rigidly on the gauge does, f_m unfiltered [-] */
    double quantisation_step; /* R4: motor force of one step of stage or scaled master [N] */
    double force_noise;       /* R5: motor noise that the sensors' noise makes, RMS [N] */
    double height_margin;     /* topography: of the height servo or of the master's spring, the smaller one [-] */
    double exact_limit;       /* kappa at which the sampled loop, hand and filters included, is unstable [N/m] */
    double exact_frequency;   /* at which it then oscillates [Hz]; NaN if exact_limit is infinite */
    double force_gain_limit;  /* K_f at which it is, in air or at the stiffest contact, whichever comes first [-] */
    double integral_limit;  /* integral gain at which the stage's own loop oscillates, whoever holds the master [1/s] */
    double coupling_margin; /* of tool and stage behind a virtual coupling, the master held still; exact [-] */
} nt_margins;
/* contact_stiffness: k of the stiffest contact [N/m]; k_eff = k k_c/(k + k_c). A virtual coupling softens it: kappa
 * counts that, and the exact limits hold for the rig's hand, for none, and for a released handle of 0.1 kg; exact_limit
 * over loop_stiffness is then by how much alpha_f may grow. */
NT_API nt_margins nt_margins_compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness);

/* What a session is to be judged by: the smallest of its margins, each scaled so that 1 is the limit. */
typedef struct nt_verdict {
    double margin;     /* [-] */
    const char *rule;  /* which one: "R1 contact", "exact contact", "exact K_f", "R4 steps", ...; static */
    const char *field; /* the same for an nt_problem: "stability margin (R1 contact)", ...; static */
} nt_verdict;
/* The margins of these settings' law into *margins, and the verdict. In touch: R1 and the exact limit over kappa, K_f's
 * limit over K_f, the motor's force over one step and over three standard deviations of its noise, and the virtual
 * coupling; of a master without a motor only that and integral_limit over the stage's integral, and where there is
 * neither no loop is closed: infinite. Topography and approach: the height servo alone. A curve moves no master:
 * infinite. A law of one's own is tried first (nt_margins_own_law); where that does not succeed, all but the height
 * servo's is NaN. */
NT_API nt_verdict nt_margins_judge(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                                   nt_mode mode, nt_margins *margins);
/* The settings with which the default law does what a law of one's own does, found by calling that law some hundred
 * times: its slopes at rest under six forces between the limits of either sign; those with the smallest margin.
 * NT_E_UNSUPPORTED if it is none of that kind: it has memory, bends, gives no number, sends the stage elsewhere than to
 * its target, or hears what the rules know nothing of (positions, raw speeds, raw and smooth f_m both, damping).
 * NT_E_ARGUMENT for any other law. */
NT_API nt_status nt_margins_own_law(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                                    nt_settings *amounts);

/* How the forces on a tip grow with its way, at most: what a plan and a surface hold ready. */
typedef struct nt_sideways_contact {
    double stick;     /* of a contact that sticks, with tip and lever in series [N/m]; 0: no friction */
    double grip;      /* of friction's limit, by indentation [N/m] */
    double slope;     /* of the surface [-] */
    double curvature; /* of the surface [1/m] */
    double load;      /* largest vertical force [N] */
} nt_sideways_contact;

/* Of a master of three axes, x and y alike, and of all three together (docs/margins.md). */
typedef struct nt_sideways_margins {
    double loop_stiffness;  /* kappa_l = alpha_f alpha_p times what holds the tip sideways [N/m] */
    double loop_delay;      /* D_l: of x or y, from the master's reading to its motor [s] */
    double margin;          /* R1 sideways: b/(D_l kappa_l) [-] */
    double exact_limit;     /* kappa_l at which the sampled loop over a spring oscillates, hand included [N/m] */
    double exact_frequency; /* at which it does [Hz] */
    double coupling;        /* of z into x and y and back, over the mean of both alone [-] */
    double coupled_margin;  /* all axes together: R1, or the exact limit while it sticks and while it slips, whichever
                               is less; never above those of each [-] */
} nt_sideways_margins;

/* What stirs the hand where nothing moves: steps of converters and noise of sensors. */
typedef enum nt_ripple_source {
    NT_RIPPLE_MASTER,        /* steps of the master's position sensor */
    NT_RIPPLE_STAGE_COMMAND, /* steps of the stage's command, past the notch */
    NT_RIPPLE_STAGE_READING, /* steps and noise of the stage's read-out, through the stage's integral */
    NT_RIPPLE_PROBE,         /* noise and steps of the deflection */
    NT_RIPPLE_GAUGE,         /* noise and steps of the hand's gauge, behind the low-pass */
    NT_RIPPLE_SOURCES
} nt_ripple_source;

/* A force at the hand that nobody misses [N]. */
#define NT_CLEARLY_FELT 0.3
/* A contact that answers a slow oscillation of the hand with more than so many times its force rings: near twice it, a
 * hand that lands with its whole push bounces. */
#define NT_RINGING_MOST 1.75

/* Whether a loop that is stable is calm, too: three numbers, each as a margin that is 1 where it begins to be felt. */
typedef struct nt_calm {
    double ripple;                   /* of the force at the hand, pressing at rest, peak to peak [N] */
    double parts[NT_RIPPLE_SOURCES]; /* of it [N] */
    double felt;                     /* ripple from which it is not calm: NT_CLEARLY_FELT, or where the force limit
                                        leaves the hand less, a quarter of that [N] */
    double ringing;                  /* largest force at the contact over that of a hand that oscillates [-] */
    double slewing;                  /* R1's margin, counting that the stage takes a while for one step of the master,
                                        for it goes no faster than limits.stage_speed [-] */
    double margin;                   /* the least of felt/ripple, NT_RINGING_MOST/ringing and slewing/1.5 [-] */
    const char *rule;                /* which one: "ripple", "ringing", "slewing"; static */
} nt_calm;
/* In touch, at the contact stiffness [N/m]; of the law that the settings name, a law of one's own as the default one.
 * Nothing where no loop closes through the hand: a master without a motor. NaN where the master has no
 * damping or a dead time is beyond 10 000 periods. The loop is taken as linear; each converter adds a white error of
 * its step, doubled, or one whole step (half a step of the stage's read-out), whichever is more. docs/margins.md says
 * how near that comes. A millisecond. */
NT_API nt_calm nt_margins_calm(const nt_rig *rig, const nt_settings *settings, double contact_stiffness);

/* alpha_f of a first touch: the pull-off of the sample [N] is NT_CLEARLY_FELT at the hand, or as much of it as leaves a
 * margin of 3 and calm at the contact stiffness [N/m]. Never above Eq. 19 for forces from the pull-off to `load` [N],
 * nor below that of the settings. Some milliseconds. */
NT_API double nt_margins_felt_alpha_f(const nt_rig *rig, const nt_settings *settings, double pull_off_force,
                                      double load, double contact_stiffness);

/* The loop at one frequency. */
typedef struct nt_loop_response {
    double path[2]; /* C, real and imaginary: from x_m to the force at the motor, held and delayed, 1 at rest [-] */
    double impedance[2]; /* Z = f_m/x_m', felt by the hand at the contact, the low-pass of f_m included [N s/m] */
    double llewellyn;    /* 2 Re h11 Re h22/|h12 h21| - cos(arg(h12 h21)): absolutely stable where >= 1 [-] */
} nt_loop_response;
/* frequency: above 0, below half the rate [Hz]. NaN beyond. */
NT_API nt_loop_response nt_margins_response(const nt_rig *rig, const nt_gains *gains, double contact_stiffness,
                                            double frequency);

/* Largest loop stiffness of master and zero-order hold alone, without delay: the exact (Jury) limit [N/m]. */
NT_API double nt_margins_jury_limit(const nt_master *master, double period);

/* --- The hard guarantee, to be read before arming: whatever the operator does, force and indentation stay below a
 * limit and a bound on how far it can be overshot before the reaction shows; and another bound for when one thing
 * fails. --- */

#define NT_GUARANTEE_SIGMAS 3.0 /* of the calibration */

/* What may fail, one at a time. */
typedef enum nt_failure {
    NT_FAILURE_READ_OUT, /* the deflection is read with a wrong gain, or its zero drifts away */
    NT_FAILURE_SENSOR,   /* the deflection does not change any more */
    NT_FAILURE_SLIP,     /* the stage sticks and then slips, or the surface jumps */
    NT_FAILURE_STAGE,    /* the stage goes too far, too fast or the wrong way */
    NT_FAILURES
} nt_failure;
/* "deflection read wrong", ...; "" for none. */
NT_API const char *nt_failure_name(nt_failure failure);

typedef struct nt_guarantee {
    double reaction_time;        /* from the sample that shows it until the stage turns [s] */
    double speed;                /* at which tip and surface come closer, at most [m/s] */
    double calibration;          /* of the limit, if k_c and sensitivity are off by 3 sigma [N] */
    double motion;               /* stage and surface come closer meanwhile, times stiffness [N] */
    double ringing;              /* the stage's resonance, excited by its own commands and their steps [N] */
    double snap_in;              /* what is left of the swing of a jump when the force is there [N] */
    double arrival;              /* a snap-in alone presses with this, limit or not [N] */
    double noise;                /* 6 sigma and a step of the reading [N] */
    double tare;                 /* the sample's force at the start, which the tare takes off [N] */
    double force;                /* limit and all six: never more than this on the sample, either sign [N] */
    double zero_drift;           /* and this more for each second since the tare [N/s] */
    double failure[NT_FAILURES]; /* what each adds; infinite where nothing would show it [N] */
    double with_failure;         /* force and the largest of them [N] */
    double indentation;          /* never more than this past first touch, at rest sideways [m] */
    double lateral_force;        /* never more than this on the sample in x and y [N] */
    double help_time;            /* the stage can lift from the drift of the frame for this long [s] ... */
    double frame_drift;          /* ... a stop that cannot lift is pressed by this much more in a second [N/s] */
    int moves_sideways; /* 0: the stage has one axis, and all this holds at the place where the session starts */
} nt_guarantee;

#ifdef __cplusplus
}
#endif
#endif
