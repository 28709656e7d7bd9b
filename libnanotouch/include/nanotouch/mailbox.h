/* SPDX-License-Identifier: BSD-3-Clause
 * A half in another process: a device's own program and a session meet in a mailbox, a block of shared memory. For
 * closed libraries, code under the GPL, and what may crash: if the program dies, the session lives and holds. Neither
 * side waits for the other. Linux and Windows; elsewhere nt_mailbox_open gives NT_E_UNSUPPORTED. The guide:
 * docs/devices.md. */
#ifndef NANOTOUCH_MAILBOX_H
#define NANOTOUCH_MAILBOX_H

#include "nanotouch/hal_backend.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NT_MAILBOX_NAME = 65,              /* [byte] of a mailbox's name with its ending 0 */
    NT_MAILBOX_CHANNELS = 3 * NT_AXES, /* of a half, at most */
    NT_MAILBOX_CHANNEL_NAME = 32       /* [byte] of a channel's name with its ending 0 */
};

/* --- the program's end --- */

/* What the device is. */
typedef struct nt_mailbox_device {
    nt_half half;
    uint32_t can; /* as nt_capabilities.can, without NT_LEADS_CLOCK and NT_IS_SLOW */
    int axes;
    int rows; /* up to NT_MAILBOX_CHANNELS */
    const nt_channel_row *channels;
    double period; /* between two readings, 0: one in every period of the loop [s] */
    double
        timeout; /* who gives no sign of life for so long is lost, program or session [s], above 2 periods, 1 at most */
    int64_t (*clock)(void); /* NULL: the monotonic clock; a test may give its own [ns] */
} nt_mailbox_device;
/* 1 axis, nothing but a position, 1 kHz, 0.1 s. */
NT_API nt_mailbox_device nt_mailbox_device_defaults(nt_half half);

/* What the session wants. */
typedef struct nt_mailbox_request {
    int32_t is_armed;       /* 0: nobody drives. A motor gives 0 N; a slave that was armed lifts by `lift`, once */
    uint32_t state;         /* nt_state */
    uint64_t tick;          /* of the loop */
    int64_t time;           /* when it was asked, on the clock of nt_mailbox_now [ns] */
    double target[NT_AXES]; /* master: motor force, 0 unless armed [N]; slave: x, y and travel, NaN: stay [m] */
    double drive_amplitude; /* slave that taps: of its lever far from the sample, 0: no drive [m] */
    double drive_frequency; /* the same [Hz] */
    double lift;            /* slave: how far to lift at the least, once is_armed goes from 1 to 0 [m] */
} nt_mailbox_request;

typedef struct nt_mailbox nt_mailbox;

/* Makes the mailbox `name`: letters, digits, '.', '-' and '_'. This user alone may open it. What a dead program left
 * under the name is removed. NT_E_STATE if a living program, or another user, has the name; NT_E_RANGE or
 * NT_E_NOT_FINITE for a bad name or device, with the field; NT_E_NO_MEMORY; NT_E_DEVICE if the system refuses
 * otherwise. problem may be NULL. The result belongs to the caller: nt_mailbox_close. */
NT_API nt_status nt_mailbox_open(nt_mailbox **mailbox, const char *name, const nt_mailbox_device *device,
                                 nt_problem *problem);
/* A new measurement, and a sign of life. Its size and sequence are not looked at: the mailbox numbers them. Its time is
 * that of the measurement on the clock of nt_mailbox_now. NT_E_RANGE, and nothing is shown: unknown flags, valid bits
 * of what the device cannot measure or what is no number, a time in the future. */
NT_API NT_REALTIME nt_status nt_mailbox_publish(nt_mailbox *mailbox, const nt_reading *reading);
/* A sign of life without a measurement: the program lives, its device is silent. The last reading grows old. */
NT_API NT_REALTIME void nt_mailbox_beat(nt_mailbox *mailbox);
/* What the session wants now. It is not armed if there is no session, or if it was silent for the timeout. */
NT_API NT_REALTIME void nt_mailbox_ask(nt_mailbox *mailbox, nt_mailbox_request *request);
/* The clock of both sides, the monotonic one unless the device gave another [ns]. */
NT_API NT_REALTIME int64_t nt_mailbox_now(const nt_mailbox *mailbox);
/* Removes the name; a session sees in its next tick that the device is gone. Accepts NULL. */
NT_API void nt_mailbox_close(nt_mailbox *mailbox);

/* --- the session's end --- */

/* What a half has met since it was opened [-]. */
typedef struct nt_mailbox_counts {
    uint64_t readings; /* taken */
    uint64_t torn;     /* not taken: they were written meanwhile */
    uint64_t unsound;  /* not taken: flags, bits, numbers or times that cannot be */
    uint64_t clipped;  /* targets beyond the range of their channel, which went to its end */
} nt_mailbox_counts;

/* The half itself: the caller's, opened through nt_mailbox_backend. */
typedef struct nt_mailbox_half {
    char name[NT_MAILBOX_NAME];
    int64_t (*clock)(void); /* NULL: the monotonic clock; a test may give its own [ns] */
    nt_mailbox_counts counts;
    struct nt_mailbox_link *link; /* NULL: not open */
} nt_mailbox_half;

/* Of the mailbox `name`, which need not be there yet. NT_E_RANGE if the name is empty or too long. */
NT_API nt_status nt_mailbox_half_init(nt_mailbox_half *half, const char *name);
/* The backend of a half; its context is the nt_mailbox_half. open fails with NT_E_DEVICE if no living program serves
 * the mailbox, with NT_E_STATE if another session has it. read fails with NT_E_DEVICE once the program gave no sign of
 * life for its timeout, or has closed; one that is started anew needs a new session. */
NT_API const nt_backend *nt_mailbox_backend(nt_half half);

#ifdef __cplusplus
}
#endif
#endif
