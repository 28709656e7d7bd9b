/* SPDX-License-Identifier: BSD-3-Clause
 * Made by tools/single.py from nanotouch 0.1.0: do not edit. The touch step in single precision; docs/howto/microcontroller.md. */
#ifndef NANOTOUCH_SINGLE_H
#define NANOTOUCH_SINGLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ntf_status { NTF_OK, NTF_E_ARGUMENT, NTF_E_NOT_FINITE, NTF_E_RANGE, NTF_E_NO_SOLUTION, NTF_E_NO_CONVERGENCE, NTF_E_CAPACITY, NTF_E_STATE, NTF_E_NO_MEMORY, NTF_E_DEVICE, NTF_E_UNSUPPORTED } ntf_status;

/* What adds up over a session. A double also where the touch step is made in single precision (tools/single.py), in
 * which a slow approach would stand still. */
typedef double ntf_sum;

/* Components of what has three of them. x and y are the world's; the third one of master and stage presses: + towards
 * the sample. Deflections have the third one upwards, away from the sample. */
enum { NTF_X, NTF_Y, NTF_Z, NTF_AXES };

/* Flags of a sample. */
enum {
    NTF_SAMPLE_EMERGENCY_STOP = 1u << 0, /* pressed, or its line is lost */
    NTF_SAMPLE_LIMIT_SWITCH = 1u << 1,   /* the stage stands at its end switch */
    NTF_SAMPLE_INVALID = 1u << 2,        /* the backend itself knows that the frame is bad (CRC, short transfer) */
    NTF_SAMPLE_SATURATED = 1u << 3,      /* the deflection stood at the end of its range before the tare was taken off */
    NTF_SAMPLE_DEVICE_LOST = 1u << 4     /* a device is gone: nothing of this sample is a measurement */
};

/* What the rig measured in one tick. */
typedef struct ntf_sample {
    uint64_t tick;                   /* counts control periods [-] */
    float age;                      /* time since the slave's measurement [s] */
    float master_age;               /* since the master's [s] */
    float lateness;                 /* of this tick against its deadline, 0 where nobody measures it [s] */
    float master_position[NTF_AXES]; /* x_m [m] */
    float operator_force[NTF_AXES];  /* f_m [N] */
    float stage_position[NTF_AXES];  /* x and y of the tip, and x_s, the travel towards the sample [m] */
    float deflection[NTF_AXES];      /* of the cantilever: sideways where it is measured, and zeta [m] */
    uint32_t flags;                  /* NTF_SAMPLE_* */
} ntf_sample;

/* Safety state of the loop, in rising order of severity. */
typedef enum ntf_state { NTF_RUN, NTF_HOLD, NTF_RETRACT, NTF_LATCHED } ntf_state;

/* What the rig is told to do in one tick. */
typedef struct ntf_command {
    float motor_force[NTF_AXES];    /* tau_m [N] */
    float stage_position[NTF_AXES]; /* x and y of the tip, and x_s [m] */
    uint32_t state;                 /* ntf_state after this tick */
    uint32_t reasons;               /* NTF_REASON_* bits (control.h) that explain the state */
} ntf_command;

/* AFM cantilever, piezoresistive (paper, Eq. 2, Sec. II and IV-C). */
typedef struct ntf_probe {
    float spring_constant;       /* k_c [N/m] */
    float tilt;                  /* alpha, cantilever against the sample plane [rad] */
    float sensitivity;           /* S, deflection per volt of the bridge [m/V] */
    float range;                 /* the electronics saturate at +- this [V] */
    float noise;                 /* deflection noise, peak to peak (6 sigma) [V] */
    float resolution;            /* ADC step [V] */
    float resonance;             /* f_0, free; the effective mass is 0.24 m_c = k_c/(2 pi f_0)^2 [Hz] */
    float quality;               /* Q, free [-] */
    float temperature;           /* of the thermal motion of the dynamic model, 0 for none [K] */
    float contact_viscosity;     /* eta: the contact of radius a damps with 2 m b_i = 2 eta a (Eq. 2) [Pa s] */
    float spring_constant_sigma; /* standard deviation of k_c's calibration over k_c [-] */
    float sensitivity_sigma;     /* the same of S [-] */
    float drift;                 /* of the deflection's zero, at most [m/s] */
    float lateral_stiffness;     /* k_l of the lever (torsion, bending in the plane) at the apex; 0: rigid [N/m] */
} ntf_probe;

/* Piezoelectric z stage (paper, Eq. 13 with f_s/k_stage: erratum E15). */
typedef struct ntf_stage {
    float resonance;          /* f_n [Hz] */
    float quality;            /* Q [-] */
    float stiffness;          /* k_stage, of the stage against the tip force [N/m] */
    float travel;             /* range of travel [m] */
    float resolution;         /* step of the position read-out (LVDT) [m] */
    float command_resolution; /* step of the position command [m] */
    float max_speed;          /* slew limit of the command [m/s] */
    float noise;              /* standard deviation of the read-out [m] */
    float hysteresis;         /* opening of the loop at full stroke over that stroke, open loop [-] */
    float creep;              /* drift after a step over the step, per decade of time, open loop [-] */
    float axes;               /* that it has: 1 (z: x and y stay where a session starts), or 3 [-] */
    float drift;              /* of the frame, tip against sample, at most [m/s] */
    float slip;               /* largest jump of the surface that is reckoned with [m] */
    float travel_sigma;       /* standard deviation of the calibration of what is driven, over it [-] */
    float position_sigma;     /* the same of the read-out [-] */
} ntf_stage;

/* 1-degree-of-freedom haptic master (paper, Eq. 12). */
typedef struct ntf_master {
    float mass;             /* m_m [kg] */
    float damping;          /* b_m [N s/m] */
    float friction;         /* Coulomb friction, sliding and sticking alike [N] */
    float travel;           /* x_m runs over -travel/2 .. +travel/2 [m] */
    float resolution;       /* step of the position sensor [m] */
    float max_force;        /* motor limit, +- [N] */
    int gauge;               /* "no|yes": an operator force sensor (strain gauge); without, f_m is not measured */
    float gauge_range;      /* strain gauge, +- [N] */
    float gauge_noise;      /* standard deviation of the strain gauge [N] */
    float gauge_resolution; /* step of the strain gauge [N] */
    int motor;               /* "no|yes": it can push back; without, it is a position device, as a mouse is */
    float rate;             /* of its own measurements, 0: that of the loop [Hz] */
    float axes;             /* that it has: 1 (it presses), or 3 (it moves the tip sideways, too) [-] */
} ntf_master;

/* What holds the master, beside the force that it means to apply: f_m = force - m x'' - b x' - k (x - rest), moving
 * with the master. All zero: a pure force. A finger pad is b and k, a rigid finger is m. */
typedef struct ntf_hand {
    float mass;         /* m_h [kg] */
    float damping;      /* b_h [N s/m] */
    float stiffness;    /* k_h [N/m] */
    float relaxation;   /* the rest position follows the master with this time constant, 0: it stays [s] */
    float random_force; /* adversary: a force anywhere within +- this is added [N] */
    float random_rate;  /* and changes this often, at random [1/s] */
} ntf_hand;

/* Between sensors, computer and actuators. 0 stands for one that adds nothing of its own. */
typedef struct ntf_converters {
    float adc_bits;    /* over the range of each sensor [-] */
    float adc_rate;    /* conversions per second [Hz] */
    float adc_latency; /* from the measured moment to the sample, the sample's age [s] */
    float dac_bits;    /* over the range of motor and stage [-] */
    float dac_latency; /* from the command to its effect [s] */
} ntf_converters;

typedef struct ntf_rig {
    ntf_probe probe;
    ntf_stage stage;
    ntf_master master;
    ntf_hand hand;
    ntf_converters converters;
} ntf_rig;

typedef enum ntf_mode {
    NTF_MODE_TOUCH,      /* the operator moves z and feels the force (point touch, tactile scan) */
    NTF_MODE_TOPOGRAPHY, /* z is servoed to a constant force, the operator feels the height only */
    NTF_MODE_APPROACH,   /* down at approach_speed until the set-point is felt, then held there */
    NTF_MODE_CURVE       /* down to the set-point, up again by curve_length, at approach_speed */
} ntf_mode;

typedef enum ntf_control_choice {
    NTF_CONTROL_DEFAULT,
    NTF_CONTROL_PAPER,
    NTF_CONTROL_IMPEDANCE,
    NTF_CONTROL_OWN
} ntf_control_choice;

struct ntf_signals;

struct ntf_effort;

struct ntf_gains;

/* Which law (servo.h). All zero: the default one. */
typedef struct ntf_control {
    ntf_control_choice choice;
    struct ntf_effort (*law)(void *context, const struct ntf_gains *gains, const struct ntf_signals *signals); /* OWN */
    void *context;                                                                                          /* OWN */
} ntf_control;

typedef struct ntf_gains {
    float rate;                 /* force loop, 1/T [Hz] */
    float alpha_p;              /* stage over master [m/m] */
    float alpha_f;              /* operator over tip [N/N] */
    float alpha_f_approach;     /* factor on alpha_f before contact [-] */
    float alpha_f_retract;      /* factor on alpha_f where the tip is held by adhesion [-] */
    float force_gain;           /* K_f of Eq. 17 [-] */
    float force_filter;         /* low-pass of f_m [Hz] */
    float velocity_feedforward; /* beta, share of the master's damping that the motor takes over [-] */
    float stage_damping;        /* zeta that the notch leaves to the stage's resonance [-] */
    float stage_integral;       /* integral gain of the stage loop [1/s] */
    float stage_proportional;   /* K_p of Eq. 17, the paper's law only [-] */
    float stage_derivative;     /* K_v of Eq. 17, the paper's law only [s] */
    float coupling_stiffness;   /* of the spring between master and virtual tool, 0: rigid [N/m] */
    float coupling_damping;     /* of the virtual tool against the ground [N s/m] */
    float projection_x;         /* share of the lateral tip force that a master of one axis feels along z ... */
    float projection_y;         /* ... of x, and of y; 0: z alone [-] */
    float ramp_time;            /* force fades in over this on engagement, a new scale too [s] */
    float set_point;            /* force held in topography mode, sought in approach and curve [N] */
    float height_gain;          /* integral gain of the height servo [1/s] */
    float height_stiffness;     /* how hard the master is drawn to the height [N/m] */
    float approach_speed;       /* of the stage in approach and curve [m/s] */
    float curve_length;         /* a curve draws back by this from where it turned [m] */
    float delay;                /* conversion, computing and link delay of the rig [periods] */
} ntf_gains;

typedef struct ntf_limits {
    float force;            /* on the sample, either sign [N] */
    float lateral_force;    /* on the sample in x and y, where the lever shows it [N] */
    float indentation;      /* of tip and sample past first touch [m] */
    float stage_speed;      /* [m/s] */
    float lateral_speed;    /* [m/s] */
    float motor_force;      /* [N] */
    float motor_rate;       /* [N/s] */
    float motor_power;      /* that the motor may put into the hand [W] */
    float retract_distance; /* RETRACT lifts by this [m] */
    float retract_speed;    /* at this [m/s] */
    float follow_error;     /* the stage may be this far from its command [m] ... */
    float follow_time;      /* ... for this long [s] */
    float deflection_bias;  /* what the tare may find at the deflection [m] ... */
    float deflection_drift; /* ... and how fast it may change [m/s] */
    float gauge_bias;       /* the same of the hand's gauge [N] ... */
    float gauge_drift;      /* ... [N/s] */
} ntf_limits;

typedef struct ntf_settings {
    ntf_gains gains;
    ntf_limits limits;
    ntf_control control;
} ntf_settings;

/* x_s = alpha_p x_m, f_m = alpha_f f_s (Eq. 16). */
typedef struct ntf_scaling {
    float alpha_p; /* stage metres per master metre [m/m] */
    float alpha_f; /* operator newtons per tip newton [N/N] */
} ntf_scaling;

/* --- changes while running. At the operator's scale the contact holds the energy (alpha_f/alpha_p) S, S the work that
 *     the tip has done on it. A fall of alpha_f/alpha_p takes energy away and is always allowed; a rise would give the
 *     operator energy that nobody has put in, so it has to be paid for: by what the hand has lost in the master's
 *     damping, kept in a tank --- */

typedef enum ntf_region { NTF_REGION_APPROACH, NTF_REGION_INDENT, NTF_REGION_RETRACT } ntf_region;

typedef struct ntf_rescale {
    float share;           /* of its value by which a scale may change in a period [-] */
    float threshold;       /* forces below this are free air [N] */
    float spring_constant; /* k_c [N/m] */
    float income;          /* half of what the damping takes from the hand in a period, over v^2 [N s^2/m] */
    float capacity;        /* of the tank [J] */
    float factors[3];      /* on alpha_f, by ntf_region [-] */
} ntf_rescale;

typedef struct ntf_rescale_state {
    ntf_scaling now;    /* in force */
    ntf_scaling wanted; /* by the operator, in contact */
    ntf_region region;
    float work;          /* of the tip on the contact, since it was free [J] */
    ntf_sum tank;          /* [J] */
    float last_position; /* x_s [m] */
} ntf_rescale_state;

/* At these scales, free of contact, with an empty tank. */
ntf_rescale_state ntf_rescale_start(const ntf_rescale *rescale, const ntf_scaling *scaling);

/* One period: the tip's force [N], the stage [m], the master's speed [m/s]. Moves `now` towards `wanted` and region. */
void ntf_rescale_step(const ntf_rescale *rescale, ntf_rescale_state *state, float slave_force,
                                        float stage_position, float master_speed);

#define NTF_PASSIVITY_STORE 10.0f

/* What does not change while it runs. */
typedef struct ntf_passivity {
    float dead_zone;    /* what quantised positions may seem to release at full force [J] */
    float due;          /* b_m T times the share of the damping that must show [N s^2/m] */
    float force_gain;   /* K_f, which divides the damping that the operator feels [-] */
    float damping;      /* b_m [N s/m] */
    float credit;       /* b_m where no gauge sees the hand, which then also gives what the damping takes [N s/m] */
    float speed_filter; /* of the low-pass of the master's speed, per period [-] */
    float speed_floor;  /* what one step of the master seems to be [m/s] */
    float speed_limit;  /* the master cannot be so fast, a reading is wrong [m/s] */
    float period;       /* T [s] */
} ntf_passivity;

/* One side, at the operator's scale. */
typedef struct ntf_port {
    float force;    /* [N] */
    float position; /* [m] */
} ntf_port;

typedef struct ntf_passivity_state {
    ntf_sum energy;  /* swallowed beyond what was due since the last event, at most NTF_PASSIVITY_STORE dead zones [J] */
    float gain;    /* factor on K_f, 1 .. 0 [-] */
    float damping; /* share of the master's damping that the motor shall add, 0 .. 1 [-] */
    float speed;   /* of the master, filtered [m/s] */
    ntf_port last_hand, last_tip;
    uint32_t trips;
} ntf_passivity_state;

/* hand: (f_m, x_m), in; where there is no gauge (-tau_m, x_m), of the motor force that has been held since the last
 * step; tip: (alpha_f f_s, x_s/alpha_p), out. Returns the gain factor. */
float ntf_passivity_step(const ntf_passivity *passivity, ntf_passivity_state *state,
                                            const ntf_port *hand, const ntf_port *tip);

/* What the motor shall add: -damping b v, 0 where steps of the sensor cannot be told from motion [N]. */
float ntf_passivity_damping_force(const ntf_passivity *passivity, const ntf_passivity_state *state);

/* Neither gain to take away nor damping to add is left. */
int ntf_passivity_is_exhausted(const ntf_passivity_state *state);

typedef struct ntf_stage_loop {
    ntf_sum b[3], a[3]; /* biquad in z^-1, a[0] = 1: zeros on the sampled poles of the stage */
    ntf_sum integral;   /* integral gain per period [-] */
} ntf_stage_loop;

typedef struct ntf_stage_loop_state {
    ntf_sum w[2];       /* filter memory [m] */
    ntf_sum correction; /* integral of the error [m] */
} ntf_stage_loop_state;

/* One period: reference and read-out [m] in, the command to the stage [m] out. */
ntf_sum ntf_stage_loop_step(const ntf_stage_loop *loop, ntf_stage_loop_state *state, ntf_sum reference,
                                             float measured);

/* What a law is given. All numbers are finite. */
typedef struct ntf_signals {
    float period;          /* T [s] */
    float master_position; /* x_m [m] */
    float master_speed;    /* of x_m, by differences [m/s] */
    float smooth_speed;    /* the same behind a low-pass of 20 Hz: positions come in steps [m/s] */
    float operator_force;  /* f_m, 0 where there is no gauge [N] */
    float smooth_force;    /* the same behind gains.force_filter [N] */
    float slave_force;     /* f_s = k_c zeta [N] */
    float felt_force;      /* the same, or what a virtual coupling makes of it: to be reflected [N] */
    float stage_position;  /* x_s [m] */
    float stage_speed;     /* of x_s, by differences [m/s] */
    float target;          /* alpha_p x_m from where it was last indexed: x_s by Eq. 16 [m] */
    ntf_scaling scaling;     /* in force now */
    float master_damping;  /* b_m [N s/m] */
    float gain_factor;     /* 1, less when the passivity observer has backed off: on K_f [-] */
} ntf_signals;

/* What a law wants; limits come after it. */
typedef struct ntf_effort {
    float motor_force; /* tau_m, + towards the sample [N] */
    float stage;       /* where the stage shall be [m] */
} ntf_effort;

/* Must be real-time safe where the loop is. A number that is not finite stops the coupling (NTF_REASON_LAW). */
typedef ntf_effort (*ntf_control_law)(void *context, const ntf_gains *gains, const ntf_signals *signals);

/* Eq. 17 with the low-pass on f_m and velocity feed-forward: tau = -alpha_f f_s - K_f (alpha_f f_s - f_m) + beta b v;
 * the stage goes to the target through notch and integral (stage_loop.h). At rest f_m = alpha_f f_s for any K_f. */
ntf_effort ntf_servo_default(void *unused, const ntf_gains *gains, const ntf_signals *signals);

/* Eq. 17 as printed: the raw f_m, and a stage that is driven by K_v (alpha_p x_m' - x_s') + K_p (alpha_p x_m - x_s)
 * alone, without notch and integral. For reproduction: see docs/control.md for what is wrong with it. */
ntf_effort ntf_servo_paper(void *unused, const ntf_gains *gains, const ntf_signals *signals);

/* For masters without a gauge: tau = -alpha_f f_s + beta b v. The hand feels f_m = alpha_f f_s + (1 - beta) b v. */
ntf_effort ntf_servo_impedance(void *unused, const ntf_gains *gains, const ntf_signals *signals);

/* The function of a choice. */
ntf_control_law ntf_control_law_of(const ntf_control *control);

enum {
    NTF_REASON_INVALID = 1u << 0,   /* NaN, infinite, beyond any reading of the sensor, or bad frame */
    NTF_REASON_SATURATED = 1u << 1, /* deflection at the end of its range */
    NTF_REASON_FORCE_LIMIT = 1u << 2,
    NTF_REASON_STALE = 1u << 3,    /* sample older than 2 T */
    NTF_REASON_STUCK = 1u << 4,    /* the deflection does not change while z moves */
    NTF_REASON_FOLLOW = 1u << 5,   /* the stage does not follow */
    NTF_REASON_UNSTABLE = 1u << 6, /* the passivity observer has used up what it had */
    NTF_REASON_EMERGENCY_STOP = 1u << 7,
    NTF_REASON_LIMIT_SWITCH = 1u << 8,
    NTF_REASON_OPERATOR_CLIPPED = 1u << 9, /* the gauge is at its range: a flag, the state stays RUN */
    NTF_REASON_COMMAND_LIMITED = 1u << 10, /* stage speed or travel is at its limit: a flag */
    NTF_REASON_LATE = 1u << 11,            /* ticks late by more than T/5, in a row */
    NTF_REASON_DEVICE = 1u << 12,          /* a device is gone */
    NTF_REASON_INDENTATION = 1u << 13,     /* the indentation is at its limit */
    NTF_REASON_LAW = 1u << 14,             /* the control law gave no number */
    NTF_REASON_BACKED_OFF = 1u << 15,      /* the passivity observer has taken gain away: a flag */
    NTF_REASON_MASTER_STALE = 1u << 16,    /* the master's reading is older than two of its own periods */
    NTF_REASON_LATERAL = 1u << 17          /* the lateral force is at its limit */
};

enum { NTF_STUCK_SAMPLES = 50 };

/* without noise, in a row, while z moves: the sensor is dead */

/* What a stop does with the stage. */
typedef enum ntf_lift {
    NTF_LIFT_GOES,    /* it lifts, by retract_distance, and on while force shows or cannot be read */
    NTF_LIFT_WAITS,   /* the stage did not follow, or went the wrong way: it stays, until the force grows */
    NTF_LIFT_TRIES,   /* it did grow: it lifts, and the force alone tells whether that helps */
    NTF_LIFT_GIVEN_UP /* it went the wrong way */
} ntf_lift;

/* All that does not change while it runs. */
typedef struct ntf_supervisor {
    float master_period;     /* between two readings of the master [s] */
    float period;            /* T [s] */
    float spring_constant;   /* k_c [N/m] */
    float lateral_stiffness; /* k_l: x and y of the deflection are judged; 0: the lever does not show them [N/m] */
    float deflection_range;  /* [m] */
    float free_force;        /* forces below this are the sensor's noise [N] */
    float master_range;      /* readings beyond these cannot be [m] */
    int leads_sideways;       /* a master of three axes: its x and y are judged, too */
    float gauge_range;       /* [N], 0 without a gauge */
    float stage_range;       /* [m] */
    float stuck_distance;    /* deflections without noise over this travel are a dead sensor, 0: cannot be told [m] */
    float noise;             /* of the deflection, as declared: standard deviation [m] */
    float stage_share;       /* of the way to its reference that the stage should go in a period [-] */
    float stage_slack;       /* by which it may be off at rest, or three quarters of the way that it was to go [m] */
    float stage_most;      /* never by more than this: follow_error, and hysteresis that no integral takes away [m] */
    float correction_most; /* that the integral may add to where the stage is told to be [m] */
    float turn_slack;      /* when it should be farther back than this, a lift has begun to show [m] */
    float lift_share;      /* of the way up that declared hysteresis and creep may take, while no integral acts [-] */
    float path_kept;       /* of that way, per period: it fades over follow_time [-] */
    ntf_limits limits;
} ntf_supervisor;

typedef struct ntf_supervisor_state {
    ntf_state state;
    uint32_t reasons;
    uint32_t invalid_run;    /* invalid samples in a row */
    uint32_t law_run;        /* laws without a number in a row */
    uint32_t late_run;       /* late ticks less punctual ones, at least 0 */
    uint32_t late_ticks;     /* all of them */
    uint32_t stuck_run;      /* deflections without noise in a row */
    float stuck_deflection; /* [m] */
    float stuck_band;       /* within which a deflection shows no noise [m]; from these: */
    uint32_t noise_samples;  /* that have been looked at */
    float noise_sum;        /* of their differences, in this block [m] */
    float noise;            /* of the quietest block: standard deviation [m] */
    float last_deflection;  /* [m] */
    float stuck_position;   /* x_s where they began [m] */
    float expected;         /* where the stage should be by now [m] */
    float path;             /* that this has gone lately, to and fro [m] */
    uint32_t off_run;        /* ticks in a row in which the stage was not there */
    ntf_lift lift;            /* of a stop */
    int presses;             /* in a stop: force shows, or cannot be read */
    int lifts;               /* the stage is told to go up */
    ntf_sum reference;        /* where it was told to be [m] */
    float turn;             /* where it should have been when the lift began [m] */
    float stopped;          /* where it should have been when the stop began [m] */
    float lift_force;       /* largest force until it should have turned [N] */
    uint32_t growth_run;     /* ticks in a row in which the force has grown since */
    float turn_position;    /* where it was read to be when the lift began [m] */
    float top_position;     /* the farthest up that it has been read since [m] */
    float fall_position;    /* where it was first read to be well below that [m] */
    uint32_t fall_run;       /* ticks in a row in which it has gone on the wrong way */
    float late;             /* of this tick: a stop lifts by the clock, not by ticks [s] */
    float surface;          /* travel of the tip at first touch [m] */
    float indentation;      /* [m] */
} ntf_supervisor_state;

/* What the supervisor has to know beside the sample. */
typedef struct ntf_situation {
    ntf_sum reference;   /* where the stage was told to be [m] */
    int moves_sideways; /* the surface may rise and fall: the indentation is not followed */
    int unstable;       /* the passivity observer has used up what it had */
} ntf_situation;

/* In RUN, nothing seen yet. */
ntf_supervisor_state ntf_supervisor_start(void);

/* One tick. Returns the new state, never less severe than RETRACT or LATCHED once reached (ntf_supervisor_arm). */
ntf_state ntf_supervisor_step(const ntf_supervisor *supervisor, ntf_supervisor_state *state,
                                               const ntf_sample *sample, const ntf_situation *situation);

/* The law gave no number in this tick: HOLD, the second time in a row RETRACT. */
ntf_state ntf_supervisor_fail_law(ntf_supervisor_state *state);

/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig), else NTF_E_STATE. */
ntf_status ntf_supervisor_arm(ntf_supervisor_state *state, int confirmed);

/* All that does not change while it runs. Immutable after ntf_touch_make. */
typedef struct ntf_touch {
    ntf_rig rig;
    ntf_settings settings;
    ntf_mode mode;  /* to begin with */
    float period; /* T [s] */
    ntf_control_law law;
    ntf_stage_loop stage_loop;
    int leads_sideways;   /* master and stage have more than one axis: x and y follow the hand, not a path ... */
    int feels_sideways;   /* and its motors push back in x and y, for the lever shows what holds the tip */
    float borders[2][2]; /* ... within these, of x and of y; infinite where nothing borders it [m] */
    float force_filter;  /* of the low-pass of f_m, per period [-] */
    uint32_t delay;       /* after which a motor force acts, as far as it is remembered [periods] */
    float speed_filter;  /* of the master's speed estimate, per period [-] */
    float stage_step;    /* largest, in a period [m] */
    float stage_end;     /* of its travel, either way [m] */
    float motor_step;    /* largest, in a period [N] */
    float spike;         /* a deflection that jumps by more than this may be a wrong reading [m] */
    ntf_passivity passivity;
    ntf_passivity passivity_sideways; /* of x and of y, by what the master shows of the hand */
    ntf_rescale rescale;
    ntf_supervisor supervisor;
} ntf_touch;

/* Of a mode that ends: approach and curve. */
typedef enum ntf_phase { NTF_PHASE_DOWN, NTF_PHASE_UP, NTF_PHASE_DONE } ntf_phase;

enum { NTF_TOUCH_SENT = 256 };

typedef struct ntf_touch_state {
    ntf_mode mode, wanted_mode; /* they differ while the force of the old one fades out */
    ntf_phase phase;
    ntf_sum turn; /* of a curve: where the stage has turned [m] */
    ntf_supervisor_state supervisor;
    ntf_passivity_state passivity;
    ntf_passivity_state passivity_sideways[2]; /* of one gain: to scale x and y apart would give energy */
    ntf_rescale_state rescale;
    ntf_stage_loop_state stage_loop;
    ntf_signals signals;                  /* what the law is given */
    float deflections[2];               /* of the last two valid samples [m] */
    ntf_sum reference;                    /* where the stage shall be [m] */
    ntf_sum offset;                       /* target = alpha_p x_m + offset: re-indexed after every stop [m] */
    float stretch;                      /* of the virtual coupling, at the operator's scale [m] */
    int clutch_open;                     /* the master moves alone */
    ntf_sum engaged;                      /* 0 .. 1, fades the force in and out [-] */
    float motor_force;                  /* last command [N] */
    float coupled_force;                /* what is left of the last command given while coupled [N] */
    ntf_sum retracted;                    /* lifted so far [m] */
    float hand_at[2];                   /* x and y of the master when it was last seen [m] */
    float stage_at[2];                  /* x and y of the stage then [m] */
    float sideways[2];                  /* how far it has gone since that the tip has not followed yet [m] */
    float hand_speed[2];                /* of the master in x and y, behind the same low-pass as along z [m/s] */
    float lateral_force[2];             /* on the tip, + along x and y; 0 where the lever does not show it [N] */
    float projected_force;              /* f_s, and what a hand of one axis feels of the lateral force [N] */
    float coupled_sideways[2];          /* last force on the hand in x and y while coupled [N] */
    float target_x, target_y;           /* lateral set-point [m] */
    ntf_sum target_time;                  /* left to get there [s] */
    float sent[NTF_TOUCH_SENT][NTF_AXES]; /* motor forces of the last ticks, by their number [N] */
    ntf_command command;                  /* last command */
    uint64_t ticks;
} ntf_touch_state;

/* A loop at rest at (x, y), the stage at 0, the master at x_m (both finite), armed. */
ntf_touch_state ntf_touch_start(const ntf_touch *touch, float master_position, float x, float y);

/* One control period. */
void ntf_touch_step(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample,
                                      ntf_command *command);

/* Sends the tip to (x, y) on a straight line within `duration` >= 0 [s], no faster than the lateral limit. */
ntf_status ntf_touch_aim(const ntf_touch *touch, ntf_touch_state *state, float x, float y,
                                          float duration);

/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig). The force fades in again, the
 * tip stays where it is until the next ntf_touch_aim. NTF_E_STATE if LATCHED and not confirmed. */
ntf_status ntf_touch_arm(ntf_touch_state *state, int confirmed);

/* Changes the mode, where the stage stands; the force fades in again. NTF_E_ARGUMENT if there is no such mode. */
ntf_status ntf_touch_set_mode(ntf_touch_state *state, ntf_mode mode);

/* Changes the scales while running: without a bump, over ramp_time, and as far as it is passive (scaling.h). Not
 * finite or not positive: refused. Whether the loop is still stable is for the caller to know (margins.h). */
ntf_status ntf_touch_rescale(ntf_touch_state *state, const ntf_scaling *scaling);

/* Open: master and stage are uncoupled, the stage stays, the force fades out. Closed: re-indexed, it fades in. */
void ntf_touch_clutch(ntf_touch_state *state, int open);

/* The master is at x_m [m], finite, after a time in which no step was made: stage and tip stay where they are. */
void ntf_touch_index(ntf_touch_state *state, float master_position);

/* F = c[0] + u (c[1] + u (c[2] + u c[3])), u = (h - gap) per_width from 0 to 1. */
typedef struct ntf_force_piece {
    float gap;       /* h where it begins; it ends where the next one does [m] */
    float per_width; /* 1 over its width [1/m] */
    float cubic[4];  /* c [N] */
} ntf_force_piece;

/* Immutable after ntf_force_table_make. */
typedef struct ntf_force_table {
    const ntf_force_piece *pieces; /* borrowed; by rising gap: first those in contact, then those apart */
    int contact, apart;           /* how many of each */
    float capture_gap;            /* at and below it the tip is in contact, from wherever it comes [m] ... */
    float release_gap;            /* ... and a tip in contact stays so up to here [m] */
    float farthest;               /* apart there is no force beyond this gap [m] */
    float scale;                  /* S: errors are over max(|F|, S) [N] */
    float bound;                  /* largest error beside the plan, over max(|F|, S) [-] */
    float fold_distance;          /* from this far from a fold, a jump or first touch on it holds [m] */
} ntf_force_table;

/* Force on the tip, + away from the sample, and dF/d(delta) = -dF/dh. */
typedef struct ntf_force_here {
    float force;     /* [N] */
    float stiffness; /* [N/m] */
} ntf_force_here;

/* At a gap h of the undeformed bodies [m], from far away or from contact: *attached is 0 at first, and kept between
 * calls. Deeper than the largest load the force goes on with its last slope. NaN gives NaN and changes nothing. */
ntf_force_here ntf_force_table_eval(const ntf_force_table *table, int *attached, float gap);

#ifdef __cplusplus
}
#endif
#endif
