/* SPDX-License-Identifier: BSD-3-Clause
 * Faults of the simulated rig, by kind, channel and time: what a test injects where a real rig would fail. The table of
 * docs/safety.md says what has to happen. */
#ifndef NANOTOUCH_FAULTS_H
#define NANOTOUCH_FAULTS_H

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_fault_kind {
    NT_FAULT_NAN,
    NT_FAULT_INFINITE,
    NT_FAULT_SATURATED,
    NT_FAULT_STUCK,
    NT_FAULT_STALE,
    NT_FAULT_DROPOUT,
    NT_FAULT_NOISE,
    NT_FAULT_JUMP,
    NT_FAULT_LATE,
    NT_FAULT_CLOCK,
    NT_FAULT_LIMIT,
    NT_FAULT_GAIN,
    NT_FAULT_DRIFT,
    NT_FAULT_HYSTERESIS,
    NT_FAULT_PUSH,
    NT_FAULT_EMERGENCY_STOP,
    NT_FAULT_LIMIT_SWITCH,
    NT_FAULT_DEVICE_LOST,
    NT_FAULT_POWER,
    NT_FAULT_CLOCK_DRIFT,
    NT_FAULT_SLIP
} nt_fault_kind;

/* Where. The four sensors come first. */
typedef enum nt_channel {
    NT_CHANNEL_DEFLECTION,
    NT_CHANNEL_STAGE_POSITION,
    NT_CHANNEL_MASTER_POSITION,
    NT_CHANNEL_OPERATOR_FORCE,
    NT_CHANNEL_STAGE, /* the actuator itself */
    NT_CHANNEL_MOTOR,
    NT_CHANNEL_RIG /* a fault of no channel: frame, clock, surface, hand, lines */
} nt_channel;

typedef struct nt_fault {
    nt_fault_kind kind;
    nt_channel channel;
    double start;    /* on the rig's clock [s] */
    double duration; /* [s], > 0; below a period: in the one tick nearest to start; infinite: it stays */
    double value;    /* by kind: see the table [unit of the kind] */
} nt_fault;

enum { NT_FAULTS_MAX = 16 };

/* A schedule; caller-owned, may be copied. Zero is none. */
typedef struct nt_faults {
    nt_fault list[NT_FAULTS_MAX];
    int count;
} nt_faults;

/* One kind. */
typedef struct nt_fault_description {
    const char *name;  /* "nan", "stuck", ...; static storage */
    const char *unit;  /* of the value, "" if it has none or takes that of the channel */
    const char *doc;   /* what it does */
    double value;      /* usual [unit of the kind] */
    double minimum;    /* of the value [unit of the kind] */
    double maximum;    /* [unit of the kind] */
    int row;           /* of the fault table in docs/evidence/safety.md */
    unsigned channels; /* bit 1 << nt_channel where it may be */
} nt_fault_description;

/* By kind; *count (NULL allowed) their number. */
NT_API const nt_fault_description *nt_fault_descriptions(int *count);
/* "deflection", ...; "" for none. */
NT_API const char *nt_channel_name(nt_channel channel);
/* Adds one. NT_E_ARGUMENT (no such kind, or not on this channel), NT_E_NOT_FINITE (start, value; duration NaN),
 * NT_E_RANGE (start below 0, duration not above 0, a value out of its range), NT_E_CAPACITY. */
NT_API nt_status nt_faults_add(nt_faults *faults, const nt_fault *fault);

#ifdef __cplusplus
}
#endif
#endif
