/* SPDX-License-Identifier: BSD-3-Clause
 * The host of the page's session (nanotouch/host.h), as flat functions (page.h). */
#include <stdlib.h>
#include <string.h>

#include "nanotouch/host.h"
#include "page.h"

static nt_session_host *host;
static double clearance; /* of what was composed last [m] */

static nt_session_host *the_host(void)
{
    if (!host) {
        void *memory = malloc(nt_host_size());
        host = memory ? nt_host_init(memory) : NULL;
    }
    return host;
}

/* Settings and master of the scene and rig that were set: width, height, relief, clearance [m], and whether what the
 * person has changed is kept. */
PAGE_API(page_compose) int page_compose(const double ground[5])
{
    page_world *world = page_the_world();
    const nt_host_ground given = {ground[0], ground[1], ground[2], ground[3], ground[4] != 0.0};
    nt_session_setup setup = nt_session_defaults();
    setup.scene = world->scene;
    setup.rig = world->rig;
    setup.demand = world->demand;
    world->problem = (nt_problem){0};
    const nt_status status = the_host() ? nt_host_compose(host, &setup, &given, &world->problem) : NT_E_NO_MEMORY;
    if (status != NT_OK)
        return (int)status;
    world->rig = setup.rig;
    world->settings = setup.settings;
    clearance = setup.clearance;
    return NT_OK;
}

PAGE_API(page_clearance) double page_clearance(void)
{
    return clearance;
}

/* Another sample; texts: name, title, hint, source. */
PAGE_API(page_host_lay) void page_host_lay(const char *const texts[4], const double size[2], int pushed)
{
    const nt_host_subject subject = {texts[0], texts[1], texts[2], texts[3],
                                     "",       size[0],  size[1],  (nt_host_pushed)pushed};
    if (the_host())
        nt_host_lay(host, &subject);
}

/* The session that page_open has opened. */
PAGE_API(page_host_open) int page_host_open(void)
{
    return the_host() ? (int)nt_host_open(host, page_the_session()) : NT_E_NO_MEMORY;
}

void page_host_see(const nt_frame *frame)
{
    if (host)
        nt_host_see(host, frame, 1);
}

/* What the hand does in a time [s], and what the sample keeps. */
PAGE_API(page_host_follow) void page_host_follow(double elapsed)
{
    const nt_dents *dents = nt_session_dents(page_the_session());
    if (dents)
        nt_host_see_dents(host, dents->made, dents->count);
    nt_host_follow(host, elapsed);
}

/* 0: the host does not know it. */
PAGE_API(page_host_ask) int page_host_ask(const char *what, const char *text, const double values[3])
{
    const nt_host_asked asked = {what, text, {values[0], values[1], values[2]}};
    return nt_host_ask(the_host(), &asked) != NT_E_UNSUPPORTED;
}

PAGE_API(page_host_refuse) void page_host_refuse(const char *why)
{
    nt_host_refuse(the_host(), why);
}

/* The next message, or part of the result from *at on; NULL: there is none. */
static char text[NT_HOST_MESSAGE];

PAGE_API(page_host_tell) const char *page_host_tell(void)
{
    return nt_host_tell(the_host(), text, sizeof text) > 0 ? text : NULL;
}

PAGE_API(page_host_result) const char *page_host_result(int begin)
{
    static long at;
    at = begin ? 0 : at;
    return nt_host_result(host, &at, text, sizeof text) > 0 ? text : NULL;
}

/* A preset that a task waits for, a field that another session is needed for; NULL: none. */
PAGE_API(page_host_wants) const char *page_host_wants(void)
{
    return nt_host_wants(the_host());
}

PAGE_API(page_host_reopens) const char *page_host_reopens(void)
{
    const nt_host_change *change = nt_host_reopens(the_host());
    return change ? change->field : NULL;
}

PAGE_API(page_host_reopens_to) double page_host_reopens_to(void)
{
    const nt_host_change *change = nt_host_reopens(the_host());
    return change ? change->after : 0.0;
}

/* Height of the hand [m], what can be taken back, four energies [J]. */
PAGE_API(page_host_state) void page_host_state(double found[6])
{
    const nt_host_state state = nt_host_state_of(host);
    found[0] = state.hand->height;
    found[1] = state.undo;
    memcpy(found + 2, state.energies, sizeof state.energies);
}

/* What touches, and what is promised, in a line. */
PAGE_API(page_host_facts) const char *page_host_facts(void)
{
    static char line[NT_HOST_LINE];
    const nt_host_state state = nt_host_state_of(host);
    return state.frame ? nt_host_facts(state.frame, &state.bounds, line, sizeof line) : "";
}

PAGE_API(page_host_task) const char *page_host_task(void)
{
    return nt_host_state_of(host).task;
}

static nt_status advance(void *context, double duration)
{
    const int pieces = duration > 0.01 ? (int)(100.0 * duration + 0.5) : 1;
    const double rate = nt_session_setup_of(page_the_session())->settings.gains.rate;
    (void)context;
    for (int i = 0; i < pieces; ++i) {
        const int status = page_run((int)(0.01 * rate + 0.5));
        if (status != NT_OK)
            return (nt_status)status;
        page_host_follow(0.01);
    }
    return NT_OK;
}

/* The ideal operator of the task that runs. */
PAGE_API(page_host_solve) int page_host_solve(void)
{
    const nt_host_clock clock = {advance, NULL};
    return (int)nt_host_solve(host, &clock);
}
