/* SPDX-License-Identifier: BSD-3-Clause
 * Whichever allocation of nt_session_open fails: NT_E_NO_MEMORY, no session, no leak. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "failing_heap.h"
#include "nanotouch/nanotouch.h"

static void open_without_memory(void **state)
{
    (void)state;
#if !HEAP_CAN_FAIL
    skip();
#endif
    const nt_session_setup setup = nt_session_defaults();
    long tried = 0;
    for (int failure = HEAP_ONCE; failure <= HEAP_GONE; failure++)
        for (long n = 1, met = 1; met; n++) {
            nt_session *session = NULL;
            const long before = heap_blocks();
            heap_fail(n, (heap_failure)failure);
            const nt_status status = nt_session_open(&session, &setup, NULL);
            met = heap_recover() >= n;
            tried += met;
            assert_int_equal(status, met ? NT_E_NO_MEMORY : NT_OK);
            assert_true((session == NULL) == (status != NT_OK));
            nt_session_close(session);
            assert_int_equal(heap_blocks(), before);
        }
    assert_true(tried >= 6); /* session and ring, in three ways */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(open_without_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
