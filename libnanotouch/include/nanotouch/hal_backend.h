/* SPDX-License-Identifier: BSD-3-Clause
 * For those who write a backend: a rig has two halves, master and slave, and a backend is one of them. Include only
 * this header; a shared object links nothing and exports NT_BACKEND_ENTRY. The guide is docs/hal.md. */
#ifndef NANOTOUCH_HAL_BACKEND_H
#define NANOTOUCH_HAL_BACKEND_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_HAL_API_VERSION 3
/* Of a shared object: `const nt_backend *nanotouch_backend(void)`. */
#define NT_BACKEND_ENTRY "nanotouch_backend"

typedef enum nt_half { NT_HALF_MASTER, NT_HALF_SLAVE } nt_half;

/* The channels that a half may read: three of position, three of what it feels, and of a lever that taps two. */
enum { NT_READS_POSITION = 0, NT_READS_FELT = NT_AXES, NT_READS_AMPLITUDE = 2 * NT_AXES, NT_READS_LAG, NT_READS };

/* One channel, read or driven. */
typedef struct nt_channel_row {
    const char *name; /* "deflection", "motor force x", ... */
    const char *unit; /* SI: "m", "N"; "rad", "Hz" */
    int driven;       /* 0: it is read; 1: it is driven */
    int axis;         /* NT_X, NT_Y, NT_Z; NT_AXES: of drive or lock-in amplifier */
    double minimum;   /* of its range [unit] */
    double maximum;   /* [unit] */
    double step;      /* of its converter, 0: none is known [unit] */
    double noise;     /* standard deviation [unit] */
    double latency;   /* from the moment measured to the reading, or from the write to its effect [s] */
    double safe;      /* driven: what disarm leaves it at, NaN: a position or frequency that stays; read: NaN [unit] */
} nt_channel_row;

/* What a half can do. */
enum {
    NT_CAN_FEEL = 1u << 0,         /* master: measures the operator's force; slave: measures deflections */
    NT_CAN_PUSH = 1u << 1,         /* master: has motors. Without them it is a position device: a mouse */
    NT_CAN_SERVO = 1u << 2,        /* slave: owns its z servo; what is written is its set-point */
    NT_LEADS_CLOCK = 1u << 3,      /* read waits for the half's own next period, two at most; one half at most may */
    NT_IS_REAL = 1u << 4,          /* an actuator can move something: needs the hard pace */
    NT_IS_EVENT_DRIVEN = 1u << 5,  /* readings come when something happens; a heartbeat comes every period */
    NT_KEEPS_OWN_SAFETY = 1u << 6, /* stops by itself when writes stay away */
    NT_IS_SLOW = 1u << 7,          /* its calls are not real-time safe (a Python class): free or wall pace only */
    NT_CAN_TAP = 1u << 8           /* slave: its lever is driven, and a lock-in amplifier reads amplitude and lag */
};

typedef struct nt_capabilities {
    uint32_t size; /* sizeof(nt_capabilities), set by the host; a backend fills no more */
    uint32_t can;  /* the bits above */
    int axes;      /* that it has: 1 (NT_Z alone), 2 (x and y too are positions) or 3 */
    int rows;      /* number of channels */
    const nt_channel_row *channels;
    double period; /* between its own measurements, 0: a new one in every period of the loop [s] */
} nt_capabilities;

/* What the host tells a half before it is armed. */
typedef struct nt_configuration {
    uint32_t size;      /* sizeof(nt_configuration) */
    uint32_t reserved;  /* 0 */
    double period;      /* of the loop [s] */
    double lift;        /* slave: how far close has to lift the tip, at the least [m] */
    const char *option; /* what the user gave for this backend, "" if nothing */
} nt_configuration;

/* What a half measured. What cannot be measured is NaN and not in `valid`; it is never 0. */
typedef struct nt_reading {
    uint32_t size;            /* sizeof(nt_reading), set by the host */
    uint32_t flags;           /* NT_SAMPLE_* */
    uint64_t sequence;        /* of the measurement, rising; the same number again: nothing new */
    int64_t time;             /* of the measurement, on the clock of nt_host.now [ns] */
    double position[NT_AXES]; /* of hand or stage, x, y and towards the sample [m] */
    double felt[NT_AXES];     /* master: the operator's force [N]; slave: deflections, the third + upwards [m] */
    double lateness;          /* of this period, where the half leads the clock; else 0 [s] */
    uint32_t valid;           /* bit 1 << channel: position 0 .. 2, felt 3 .. 5, amplitude 6, lag 7 */
    uint32_t buttons;         /* of the master, bit by bit */
    double amplitude;         /* slave with NT_CAN_TAP: of the deflection at the drive's frequency [m] */
    double lag;               /* the same: of the deflection behind the drive, 90 degrees free at resonance [rad] */
} nt_reading;

/* What a half shall do. */
typedef struct nt_action {
    uint32_t size;          /* sizeof(nt_action) */
    uint32_t state;         /* nt_state after this tick */
    uint64_t tick;          /* of the loop */
    int64_t time;           /* of this tick [ns] */
    double target[NT_AXES]; /* master: motor force [N]; slave: x, y and travel towards the sample [m] */
    double drive_amplitude; /* slave with NT_CAN_TAP: that the lever shall have far from the sample, 0: no drive [m] */
    double drive_frequency; /* the same [Hz] */
} nt_action;

/* What the host offers a shared object. */
typedef struct nt_host {
    uint32_t size;
    uint32_t version;                                          /* NT_HAL_API_VERSION */
    int64_t (*now)(const struct nt_host *host);                /* the loop's clock [ns] */
    void (*say)(const struct nt_host *host, const char *text); /* a line for the user; not from read and write */
    void *context;
} nt_host;

/* One table of operations. open, configure, arm come in this order, then read and write once a period each, by one
 * thread and real-time safe where the pace is hard; then disarm, close. A failed open or configure is followed by
 * close. Operations that a backend does not need are NULL, but read and write. */
typedef struct nt_backend {
    uint32_t size;    /* sizeof(nt_backend) */
    uint32_t version; /* NT_HAL_API_VERSION */
    const char *name; /* "sim", "spidev", ... */
    nt_half half;
    nt_status (*open)(void *context, const nt_host *host, nt_problem *problem);
    nt_status (*describe)(void *context, nt_capabilities *capabilities); /* NULL: 1 axis, feels, pushes */
    nt_status (*configure)(void *context, const nt_configuration *configuration, nt_problem *problem);
    nt_status (*arm)(void *context);
    nt_status (*read)(void *context, nt_reading *reading);
    nt_status (*write)(void *context, const nt_action *action);
    void (*disarm)(void *context); /* driven channels go to their safe values; a slave lifts */
    void (*close)(void *context);  /* disarm, and everything is given back */
    void *context;                 /* of a shared object; else the caller gives one to nt_hal_open */
} nt_backend;

#ifdef __cplusplus
}
#endif
#endif
