/* SPDX-License-Identifier: BSD-3-Clause
 * What a tip leaves while a person touches: dents in a sample that keeps them, and particles where it has pushed them.
 * Both can be taken back. */
#include <math.h>
#include <string.h>

#include "host/state.h"

static const double APART = 0.3;    /* for so long, until the next contact is another touch [s] */
static const double MOVED = 1e-10;  /* less is no push [m], [rad] */
static const double ASIDE = -50e-6; /* where the tip cannot go [m] */

void nt_left_forget(nt_session_host *host)
{
    host->left = (nt_host_left){.touched_at = -INFINITY};
}

/* --- dents --- */

static void note_touch(nt_host_left *left, double time)
{
    if (!(time >= left->touched_at && time < left->touched_at + APART)) {
        if (left->touches == NT_DENTS)
            memmove(left->began, left->began + 1, sizeof *left->began * (size_t)(--left->touches));
        left->began[left->touches++] = left->count;
    }
    left->touched_at = time;
}

void nt_left_see(nt_session_host *host, const nt_frame *frame)
{
    if (host->plan.history == NT_HISTORY_DENTS && frame->contact_radius > 0.0)
        note_touch(&host->left, frame->time);
}

void nt_host_see_dents(nt_session_host *host, const nt_dent *dents, int count)
{
    nt_host_left *left = &host->left;
    count = count < NT_DENTS ? count : NT_DENTS;
    if (count == left->count && !memcmp(dents, left->dents, sizeof *dents * (size_t)count))
        return;
    if (count > left->count) /* a tap may be over already */
        note_touch(left, host->frame.time);
    memcpy(left->dents, dents, sizeof *dents * (size_t)count);
    left->count = count;
    host->due |= NT_DUE_DENTS;
    if (count == NT_DENTS) {
        nt_text text = nt_text_in(host->note, sizeof host->note);
        nt_text_fill(&text, "{count} dents are kept, no more: take some back (Z), or lay the sample anew (C)",
                     (const nt_figure[]){{"count", NT_DENTS, "#", 0}, {0}});
        host->due |= NT_DUE_NOTE;
    }
}

/* All that the last touch has left that is there still. */
static nt_status undo_dents(nt_session_host *host)
{
    nt_host_left *left = &host->left;
    int before = left->count - 1;
    for (int i = left->touches - 1; i >= 0; --i)
        if (left->began[i] < left->count) {
            before = left->began[i];
            break;
        }
    while (left->count > before) {
        if (nt_session_undent(host->session) != NT_OK)
            return nt_host_refuse_filled(host, "the tip presses: lift it first, then take the dent back", NULL);
        --left->count;
    }
    int kept = 0;
    for (int i = 0; i < left->touches; ++i)
        if (left->began[i] < before)
            left->began[kept++] = left->began[i];
    left->touches = kept;
    host->due |= NT_DUE_DENTS;
    return NT_OK;
}

/* --- particles --- */

static void pose_of(const nt_session_particles *laid, int number, double pose[3])
{
    pose[0] = laid->position[number][NT_X];
    pose[1] = laid->position[number][NT_Y];
    pose[2] = laid->angle[number];
}

static void rest(nt_host_left *left)
{
    for (int i = 0; i < left->laid.count; ++i)
        pose_of(&left->laid, i, left->rested[i]);
}

static void note_moves(nt_session_host *host)
{
    nt_host_left *left = &host->left;
    const int push = left->move_count ? left->moves[left->move_count - 1].push + 1 : 0;
    for (int i = 0; i < left->laid.count; ++i) {
        double pose[3], way = 0.0;
        pose_of(&left->laid, i, pose);
        for (int k = 0; k < 3; ++k)
            way = fmax(way, fabs(pose[k] - left->rested[i][k]));
        if (!(way > MOVED))
            continue;
        if (left->move_count == NT_HOST_MOVES)
            memmove(left->moves, left->moves + 1, sizeof *left->moves * (size_t)(--left->move_count));
        nt_host_move *move = &left->moves[left->move_count++];
        *move = (nt_host_move){.time = host->frame.time, .push = push, .number = i};
        memcpy(move->pose, left->rested[i], sizeof move->pose);
    }
    rest(left);
}

/* A push is done when nothing is touched any more. After a rewind those that came later have not been. */
void nt_left_look(nt_session_host *host)
{
    nt_host_left *left = &host->left;
    if (host->pushed == NT_HOST_NOTHING)
        return;
    const int before = left->laid.count;
    if (nt_session_read_particles(host->session, &left->laid) != NT_OK)
        return;
    int is_back = 0, touches = 0;
    while (left->move_count && left->moves[left->move_count - 1].time > host->frame.time) {
        --left->move_count;
        is_back = 1;
    }
    for (int i = 0; i < left->laid.count; ++i)
        touches |= left->laid.touches[i] > left->laid.losses[i];
    if (is_back || before != left->laid.count)
        rest(left);
    else if (!touches)
        note_moves(host);
}

static nt_status lay_one(nt_session_host *host, int number, const double pose[3])
{
    return host->pushed == NT_HOST_ROD ? nt_session_lay_rod(host->session, pose)
                                       : nt_session_lay(host->session, number, pose);
}

nt_status nt_left_lay(nt_session_host *host, const double (*poses)[3], int count)
{
    nt_host_left *left = &host->left;
    nt_status status = NT_OK;
    (void)nt_session_read_particles(host->session, &left->laid);
    for (int i = 0; i < left->laid.count && host->pushed == NT_HOST_PARTICLES && status == NT_OK; ++i)
        status = lay_one(host, i, (const double[3]){ASIDE * (i + 1), ASIDE, 0.0}); /* those that lie there */
    for (int i = 0; i < count && status == NT_OK; ++i)
        status = lay_one(host, i, poses[i]);
    left->move_count = 0;
    (void)nt_session_read_particles(host->session, &left->laid);
    rest(left);
    return status == NT_OK
               ? status
               : nt_host_refuse_filled(
                     host, "the tip is where a particle shall lie, or touches one: move it away first", NULL);
}

/* All that the last push has moved goes back, in whatever order there is room. */
static nt_status undo_push(nt_session_host *host)
{
    nt_host_left *left = &host->left;
    int first = left->move_count, goes_on = 1;
    while (first > 0 && left->moves[first - 1].push == left->moves[left->move_count - 1].push)
        --first;
    if (first == left->move_count)
        return NT_OK;
    while (goes_on && left->move_count > first) {
        goes_on = 0;
        for (int i = left->move_count - 1; i >= first; --i)
            if (lay_one(host, left->moves[i].number, left->moves[i].pose) == NT_OK) {
                left->moves[i] = left->moves[--left->move_count];
                goes_on = 1;
            }
    }
    (void)nt_session_read_particles(host->session, &left->laid);
    rest(left);
    return goes_on || left->move_count == first
               ? NT_OK
               : nt_host_refuse_filled(host, "the tip touches a particle, or is where it lay: take it away first",
                                       NULL);
}

nt_status nt_left_undo(nt_session_host *host)
{
    return host->left.count ? undo_dents(host) : undo_push(host);
}
