/* SPDX-License-Identifier: BSD-3-Clause
 * Where the system has no threads of ours (pace.c needs a system): a session is advanced by its caller. */
#include "session/state.h"

#if !NT_HAS_SYSTEM

nt_status nt_session_start(nt_session *session, nt_pace pace, uint64_t ticks)
{
    (void)session, (void)pace, (void)ticks;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_halt(nt_session *session)
{
    (void)session;
    return NT_OK;
}
nt_status nt_session_pause(nt_session *session, int paused)
{
    (void)session, (void)paused;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_step_on(nt_session *session, long ticks)
{
    (void)session, (void)ticks;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_set_speed(nt_session *session, double speed, nt_problem *problem)
{
    (void)session, (void)speed, (void)problem;
    return NT_E_UNSUPPORTED;
}
nt_progress nt_session_progress(const nt_session *session)
{
    return (nt_progress){.ticks = session->touch_state.ticks, .slowdown = 1.0};
}
int nt_session_is_running(const nt_session *session)
{
    (void)session;
    return 0;
}
nt_status nt_session_await(nt_session *session)
{
    (void)session;
    return NT_E_UNSUPPORTED;
}

#else

typedef int nt_has_threads; /* ISO C wants a declaration */

#endif
