/* SPDX-License-Identifier: BSD-3-Clause
 * What a person has come for: the tip snaps to the sample, and tears off. How hard, at the tip and at the hand. */
#include <math.h>

#include "host/state.h"

static const double LOOKED = 5e-3; /* after a snap: the deepest pull in this time is its force [s] */
static const double APART = 0.1;   /* between two events that are told: a lever that rings makes one [s] */
static const double FELT = 1e-3;   /* of the max load: a weaker pull is no event */

static void note(nt_session_host *host, const char *kind, double time)
{
    nt_host_event *event = &host->event;
    if (event->pull < FELT * host->hand.facts.load || fabs(time - event->told) < APART)
        return;
    event->told = time;
    event->kind = kind;
    event->force = event->pull;
    host->due |= NT_DUE_EVENT;
}

void nt_event_see(nt_session_host *host, const nt_frame *frame)
{
    nt_host_event *event = &host->event;
    const int touches = frame->contact_radius > 0.0;
    const double pull = -frame->tip_force[NT_Z];
    if (touches && !event->touches) {
        event->since = frame->time;
        event->pull = 0.0;
        event->waits = 1;
    }
    if (touches || event->touches)
        event->pull = fmax(event->pull, isfinite(pull) ? pull : 0.0);
    if (event->waits && (!touches || frame->time > event->since + LOOKED)) {
        event->waits = 0;
        if (touches)
            note(host, "snap", frame->time);
    }
    if (!touches && event->touches)
        note(host, "tear", frame->time);
    event->touches = touches;
}

void nt_event_tell(nt_session_host *host, nt_text *json)
{
    const double force = host->event.force, hand = force * host->hand.facts.alpha_f;
    char words[NT_HOST_NAME];
    nt_text text = nt_text_in(words, sizeof words);
    nt_text_fill(&text, "{force}, {hand} N at your hand",
                 (const nt_figure[]){{"force", force, "2 N", 0}, {"hand", hand, "#2", 0}, {0}});
    nt_json_text(json, "kind", host->event.kind);
    nt_json_number(json, "force", force);
    nt_json_number(json, "hand", hand);
    nt_json_text(json, "text", words);
}
