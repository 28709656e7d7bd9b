/* SPDX-License-Identifier: BSD-3-Clause
 * A session at hard pace on a slave of converters, with spidev's driver and modelled chips behind its system calls: it
 * is checked, runs, is stopped by the button's line, and lifts. A busy machine is late and holds; no time is judged. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "rig_session.h"

enum { PATIENCE = 20000 }; /* readings of the ring, 2 ms apart where it is empty */

/* Until a record has this state, or patience is over; how many records there were. */
static long await_state(nt_session *session, uint32_t state, long least)
{
    const struct timespec nap = {.tv_nsec = 2000000};
    long seen = 0;
    nt_record r;
    for (int i = 0; i < PATIENCE; ++i) {
        if (nt_session_read(session, &r, 1) != 1) {
            (void)nanosleep(&nap, NULL);
            continue;
        }
        assert_true(isfinite(r.stage_position[NT_Z]) && isfinite(r.deflection[NT_Z]));
        if (++seen >= least && r.state == state)
            return seen;
    }
    fail_msg("state %u not seen in %ld records", (unsigned)state, seen);
    return 0;
}

static void it_runs_stops_and_lifts(void **state)
{
    (void)state;
    nt_spi spi;
    static nt_converter_half half;
    open_slave(&half, &spi);
    const nt_session_setup setup = setup_on(&half);
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 1), NT_E_UNSUPPORTED); /* it can move something */
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, 0), NT_OK);
    const long before = await_state(session, NT_RUN, 100);
    atomic_store(&is_pressed, 1);
    const long until = await_state(session, NT_LATCHED, 1);
    assert_int_equal(nt_session_halt(session), NT_OK);
    print_message("%ld records, latched %ld later; %lu messages\n", before, until, (unsigned long)spi.messages);
    const double stood = simulated_travel(&bus);
    nt_session_close(session);
    assert_true(simulated_travel(&bus) < stood - 1e-8);
    assert_true(half.counts.failed == 0 && half.counts.mismatched == 0 && half.counts.stuck == 0);
    nt_spi_close(&spi);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_runs_stops_and_lifts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
