/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step: numbers in, numbers out, once per period. It sees neither device nor clock nor scene and may be
 * called from any loop at a fixed rate. */
#ifndef NANOTOUCH_TOUCH_H
#define NANOTOUCH_TOUCH_H

#include "nanotouch/advanced/control.h"
#include "nanotouch/control.h"
#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All that does not change while it runs. Immutable after nt_touch_make. */
typedef struct nt_touch {
    nt_rig rig;
    nt_settings settings;
    nt_mode mode;  /* to begin with */
    double period; /* T [s] */
    nt_control_law law;
    nt_stage_loop stage_loop;
    int leads_sideways;     /* master and stage have more than one axis: x and y follow the hand, not a path ... */
    int feels_sideways;     /* and its motors push back in x and y, for the lever shows what holds the tip */
    double borders[2][2];   /* ... within these, of x and of y; infinite where nothing borders it [m] */
    double force_filter;    /* of the low-pass of f_m, per period [-] */
    uint32_t delay;         /* after which a motor force acts, as far as it is remembered [periods] */
    double speed_filter;    /* of the master's speed estimate, per period [-] */
    double stage_step;      /* largest, in a period [m] */
    double stage_end;       /* of its travel, either way [m] */
    double motor_step;      /* largest, in a period [N] */
    double fade_product;    /* after an event a motor force F is gone within this over |F| (nt_motor_bound) [N s] */
    double drive_amplitude; /* of mode tapping, 0 in the others [m] */
    double drive_frequency; /* the same [Hz] */
    double spike;           /* a deflection that jumps by more than this may be a wrong reading [m] */
    nt_passivity passivity;
    nt_passivity passivity_sideways; /* of x and of y, by what the master shows of the hand */
    nt_rescale rescale;
    nt_supervisor supervisor;
} nt_touch;

/* Of a mode that ends: approach and curve. */
typedef enum nt_phase { NT_PHASE_DOWN, NT_PHASE_UP, NT_PHASE_DONE } nt_phase;

enum { NT_TOUCH_SENT = 256 };

/* The motor's force after an event that uncouples hand and tip. */
typedef struct nt_fade {
    nt_sum left;          /* of the force before the event; 1: they are coupled [-] */
    double step;          /* by which that falls in a period [-] */
    double from[NT_AXES]; /* the force before the event [N] */
} nt_fade;

/* Periods in a row without a measurement of a channel, this one counted. */
typedef struct nt_gaps {
    uint32_t position; /* of the master along z */
    uint32_t force;    /* of the operator */
    uint32_t slave;    /* stage or deflection */
} nt_gaps;

typedef struct nt_touch_state {
    nt_mode mode, wanted_mode; /* they differ while the force of the old one fades out */
    nt_phase phase;
    nt_sum turn; /* of a curve: where the stage has turned [m] */
    nt_supervisor_state supervisor;
    nt_passivity_state passivity;
    nt_passivity_state passivity_sideways[2]; /* of one gain: to scale x and y apart would give energy */
    nt_rescale_state rescale;
    nt_stage_loop_state stage_loop;
    nt_signals signals;    /* what the law is given */
    double deflections[2]; /* of the last two valid samples [m] */
    double amplitude, lag; /* of mode tapping, of the last valid sample [m], [rad] */
    nt_sum reference;      /* where the stage shall be [m] */
    nt_sum offset;         /* target = alpha_p x_m + offset: re-indexed after every stop [m] */
    double stretch;        /* of the virtual coupling, at the operator's scale [m] */
    int clutch_open;       /* the master moves alone */
    nt_sum engaged;        /* 0 .. 1, fades the force in and out [-] */
    nt_fade fade;
    nt_gaps gaps;
    double motor_force;                  /* last command [N] */
    nt_sum retracted;                    /* lifted so far [m] */
    double hand_at[2];                   /* x and y of the master when it was last seen [m] */
    double stage_at[2];                  /* x and y of the stage then [m] */
    double sideways[2];                  /* how far it has gone since that the tip has not followed yet [m] */
    double hand_speed[2];                /* of the master in x and y, behind the same low-pass as along z [m/s] */
    double lateral_force[2];             /* on the tip, + along x and y; 0 where the lever does not show it [N] */
    double projected_force;              /* f_s, and what a hand of one axis feels of the lateral force [N] */
    double target_x, target_y;           /* lateral set-point [m] */
    nt_sum target_time;                  /* left to get there [s] */
    double sent[NT_TOUCH_SENT][NT_AXES]; /* motor forces of the last ticks, by their number [N] */
    nt_command command;                  /* last command */
    uint64_t since;                      /* the tick in which the safety state became what it is */
    uint64_t ticks;
} nt_touch_state;

/* Checks rig and settings, and that no limit promises more than the rig can keep; a law that needs f_m is refused
 * without a gauge. */
NT_API nt_status nt_touch_make(nt_touch *touch, const nt_rig *rig, const nt_settings *settings, nt_mode mode,
                               nt_problem *problem);
/* A loop at rest at (x, y), the stage at 0, the master at x_m (both finite), armed. */
NT_API nt_touch_state nt_touch_start(const nt_touch *touch, double master_position, double x, double y);
/* One control period. */
NT_API NT_REALTIME void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample,
                                      nt_command *command);
/* Sends the tip to (x, y) on a straight line within `duration` >= 0 [s], no faster than the lateral limit. */
NT_API NT_REALTIME nt_status nt_touch_aim(const nt_touch *touch, nt_touch_state *state, double x, double y,
                                          double duration);
/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig). The force fades in again, the
 * tip stays where it is until the next nt_touch_aim. NT_E_STATE if LATCHED and not confirmed. */
NT_API nt_status nt_touch_arm(nt_touch_state *state, int confirmed);
/* Changes the mode, where the stage stands; the force fades in again. NT_E_ARGUMENT if there is no such mode. */
NT_API NT_REALTIME nt_status nt_touch_set_mode(nt_touch_state *state, nt_mode mode);
/* Changes the scales while running: without a bump, over ramp_time, and as far as it is passive (nt_rescale). Not
 * finite or not positive: refused. Whether the loop is still stable is for the caller to know (margins.h). */
NT_API NT_REALTIME nt_status nt_touch_rescale(nt_touch_state *state, const nt_scaling *scaling);
/* Open: master and stage are uncoupled, the stage stays, the force fades out. Closed: re-indexed, it fades in. */
NT_API NT_REALTIME void nt_touch_clutch(nt_touch_state *state, int open);
/* The master is at x_m [m], finite, after a time in which no step was made: stage and tip stay where they are. */
NT_API NT_REALTIME void nt_touch_index(nt_touch_state *state, double master_position);

#ifdef __cplusplus
}
#endif
#endif
