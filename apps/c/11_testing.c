/* SPDX-License-Identifier: BSD-3-Clause
 * A test of one's own without a framework: the sensor fails at 0.05 s; the session has to retract within half a
 * millisecond, and no force may exceed what it promises. With find_package(nanotouch COMPONENTS testing), link
 * nanotouch::testing. */
#include <stdio.h>
#include <stdlib.h>

#include "nanotouch/nanotouch.h"
#include "nanotouch/testing.h"

enum { TICKS = 2000 };

int main(void)
{
    static nt_record records[TICKS];
    nt_session_setup setup = nt_session_defaults();
    nt_session *session = NULL;
    nt_problem problem = {0};
    nt_finding finding = {{0}};
    if (nt_session_open(&session, &setup, &problem) != NT_OK)
        return EXIT_FAILURE;
    const nt_fault fault = {.kind = NT_FAULT_NAN, .channel = NT_CHANNEL_DEFLECTION, .start = 0.05, .duration = 1e-3};
    nt_status status = nt_session_inject(session, &fault);
    if (status == NT_OK)
        status = nt_session_advance(session, TICKS);
    const long count = nt_session_read(session, records, TICKS);
    const double promised = nt_session_guarantee(session).force;
    nt_session_close(session);

    if (status == NT_OK)
        status = nt_testing_force_below(records, count, promised, &finding);
    const nt_reaction wanted = {.state = NT_RETRACT, .after = 0.05, .within = 0.5e-3};
    if (status == NT_OK)
        status = nt_testing_reacts(records, count, &wanted, &finding);
    puts(status == NT_OK ? "it retracts in time, and keeps below the force that it promises" : finding.text);
    return status == NT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
