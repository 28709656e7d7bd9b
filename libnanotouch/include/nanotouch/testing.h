/* SPDX-License-Identifier: BSD-3-Clause
 * What a touch has to be, for tests of your own in any framework: records of a session (nt_session_read) are judged.
 * Each check gives NT_OK; NT_E_STATE where it does not hold, with a text that says what happened; NT_E_ARGUMENT where
 * something is NULL or no records are given; NT_E_RANGE for a limit or time that makes no sense. Link
 * nanotouch::testing (find_package(nanotouch COMPONENTS testing)). */
#ifndef NANOTOUCH_TESTING_H
#define NANOTOUCH_TESTING_H

#include "nanotouch/session.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_FINDING_SIZE = 256 };
/* What was found: "tip force 4.12e-07 N exceeded 4e-07 N at 1.204 s; HOLD came 3 ticks later". Empty where all is well.
 */
typedef struct nt_finding {
    char text[NT_FINDING_SIZE];
} nt_finding;

/* The state was RUN in every period. */
NT_API nt_status nt_testing_runs(const nt_record *records, long count, nt_finding *finding);

/* The force on the tip along z, as it is true in a simulated sample, stayed within +-limit [N], above 0. */
NT_API nt_status nt_testing_force_below(const nt_record *records, long count, double limit, nt_finding *finding);

/* What a session shall do about an event. */
typedef struct nt_reaction {
    uint32_t state; /* nt_state: HOLD, RETRACT or LATCHED; a stronger one does, too */
    double after;   /* when the event comes [s] */
    double within;  /* how soon [s], above 0 */
} nt_reaction;

/* It did so in time, and not before the event, which happens in the period nearest to `after`. Records whose ticks do
 * not rise, or where those are missing that would tell, are NT_E_RANGE. */
NT_API nt_status nt_testing_reacts(const nt_record *records, long count, const nt_reaction *wanted,
                                   nt_finding *finding);

/* Records equal those that are expected. tolerance: the largest difference of each number, in its own unit, in a record
 * of its own; NULL: none. Whole numbers have to be equal; NaN equals NaN. */
NT_API nt_status nt_testing_same(const nt_record *records, const nt_record *expected, long count,
                                 const nt_record *tolerance, nt_finding *finding);

#ifdef __cplusplus
}
#endif
#endif
