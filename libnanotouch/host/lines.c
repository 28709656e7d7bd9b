/* SPDX-License-Identifier: BSD-3-Clause
 * State in words, computed from state: a change of any field changes them. */
#include <math.h>
#include <string.h>

#include "host/state.h"

static const double HOLDS = 1e-3; /* of the max load: a weaker pull-off is none */

void nt_line_felt(const nt_session_host *host, nt_text *text)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    const nt_plan *plan = &host->plan;
    const double load = setup->scene.range.maximum_load, pull = plan->pull_off_force;
    const nt_figure figures[] = {{"what", 0.0, NULL, plan->source == NT_ADHESION_MENISCUS ? "water" : "the sample"},
                                 {"pull", pull, "N", 0},
                                 {"felt", pull * setup->settings.gains.alpha_f, "N", 0},
                                 {"depth", plan->largest_indentation, "m", 0},
                                 {"load", load, "N", 0},
                                 {"stiffness", plan->maximum_stiffness, "N/m", 0},
                                 {0}};
    if (host->said[0]) {
        nt_text_add(text, host->said);
        nt_text_add(text, " ");
    }
    nt_text_fill(text, pull > HOLDS * load ? "{what} holds with {pull}, {felt} at your hand; " : "nothing holds it; ",
                 figures);
    nt_text_fill(text, "{depth} deep and {stiffness} stiff under {load}", figures);
}

/* What a hand may be moved with, and what lowers and lifts it. */
static const struct {
    const char *name, *down, *up;
} devices[] = {{"wheel", "Scroll down", "Scroll up"},
               {"finger", "Slide down on the bar at the left", "Slide up on the bar"},
               {"keys", "Press Page Down", "Press Page Up"},
               {"pad", "Pull the right stick down", "Push the right stick up"}};
enum { DEVICES = sizeof devices / sizeof *devices };

void nt_line_guide(const nt_session_host *host, nt_text *text)
{
    const nt_plan *plan = &host->plan;
    const nt_host_guide *guide = &host->guide;
    const int holds = plan->pull_off_force > HOLDS * nt_session_setup_of(host->session)->scene.range.maximum_load;
    const nt_figure figures[] = {
        {"down", 0.0, NULL, devices[guide->device].down}, {"up", 0.0, NULL, devices[guide->device].up}, {0}};
    if (guide->tasked)
        return;
    if (guide->touches)
        nt_text_fill(text, holds ? "{up} until it tears." : "{up} until it lets go.", figures);
    else if (guide->touched && host->hint[0])
        nt_text_add(text, host->hint);
    else
        nt_text_fill(text,
                     plan->source == NT_ADHESION_MENISCUS && holds       ? "{down} until the water snaps."
                     : nt_law_jump_gap(plan, host->hand.stiffness) > 0.0 ? "{down} until the tip snaps to the sample."
                                                                         : "{down} until you feel the sample.",
                     figures);
}

void nt_guide_follow(nt_session_host *host)
{
    nt_host_guide now = host->guide;
    now.touches = host->has_frame && host->frame.contact_radius > 0.0;
    now.touched |= now.touches;
    now.tasked = host->trainer.task != NULL;
    if (memcmp(&now, &host->guide, sizeof now) != 0)
        host->due |= NT_DUE_GUIDE;
    host->guide = now;
}

nt_status nt_guide_by(nt_session_host *host, const char *device)
{
    for (int i = 0; i < DEVICES; ++i)
        if (strcmp(devices[i].name, device) == 0) {
            host->due |= host->session && host->guide.device != i ? NT_DUE_GUIDE : 0u;
            host->guide.device = i;
            return NT_OK;
        }
    return nt_host_refuse_filled(host, "device {name}: valid are wheel, finger, keys, pad",
                                 (const nt_figure[]){{"name", 0.0, NULL, device}, {0}});
}

static void add_touch(nt_text *text, const nt_frame *frame)
{
    const nt_figure figures[] = {
        {"radius", frame->contact_radius, "m", 0}, {"gap", frame->gap, "m", 0}, {"depth", -frame->gap, "m", 0}, {0}};
    nt_text_fill(text,
                 !isfinite(frame->gap)         ? "the gap is not known: a real slave"
                 : frame->contact_radius > 0.0 ? "contact of {radius} radius"
                 : frame->gap > 0.0            ? "gap {gap}"
                                               : "pressed in by {depth}",
                 figures);
}

const char *nt_host_facts(const nt_frame *frame, const nt_host_bounds *bounds, char *line, size_t size)
{
    nt_text text = nt_text_in(line, size);
    add_touch(&text, frame);
    nt_text_add(&text, isfinite(bounds->bound) ? "  ·  within " : "  ·  no bound");
    if (isfinite(bounds->bound)) {
        nt_text_general(&text, fmax(100.0 * bounds->bound, 0.01), 2);
        nt_text_add(&text, " %");
    }
    nt_text_fill(&text,
                 isfinite(bounds->margin) ? " (plan)  ·  margin {margin}  ·  never above {force}"
                                          : " (plan)  ·  no loop closes through this hand  ·  never above {force}",
                 (const nt_figure[]){{"margin", bounds->margin, "#", 0}, {"force", bounds->force, "N", 0}, {0}});
    if (bounds->hand > 0.0)
        nt_text_fill(&text, ", {hand} at the hand", (const nt_figure[]){{"hand", bounds->hand, "N", 0}, {0}});
    return line;
}
