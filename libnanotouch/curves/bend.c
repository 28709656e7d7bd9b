/* SPDX-License-Identifier: BSD-3-Clause
 * What bends the line of a free cantilever: found beyond the contact of an approach and beyond the last rupture of a
 * retraction, and taken off the approach. */
#include "curves/bend.h"

#include <math.h>
#include <string.h>

#include "curves/flicker.h"
#include "curves/free_law.h"
#include "curves/parts.h"

enum { LEAST_BLOCKS = 16, PASSES = 4 };
static const double plausible = 0.05; /* likelihood of a film that counts */
static const double deep = 8.0; /* times the visible force: there the indentation is 4 times that at the visible one, */
static const double foot_part = 0.33; /* so that contact begins about a third of the way between them further out; */
static const double clear_part = 0.7; /* of the way: surely outside */
static const double least_free = 0.5; /* of the travel: a bow of less is slow noise, and huge where it is continued */

double nt_curve_bend_at(const nt_curve_bend *bend, double z, double x)
{
    const double film = bend->film != 0.0 ? bend->film / (fmax(z, bend->nearest) - bend->pole) : 0.0;
    return film + bend->bow * x * x;
}

/* The last of the first `count` points whose force reaches a level; -1 without one. */
static long last_above(const nt_curve_branch *branch, long count, double level)
{
    long last = count - 1;
    while (last >= 0 && !(fabs(branch->force[last]) > level))
        last--;
    return last;
}

/* What a film does in contact is not measured: its force there may be off by all of it. The free points beside the
 * contact would say that it is known, so a law without attraction is not fitted to them. */
void nt_curve_doubt_level(const nt_curve_bend_doubts *doubts, nt_curve_branch *approach)
{
    nt_curve_baseline *baseline = &approach->baseline;
    baseline->force_variance = fmax(baseline->force_variance, doubts->level);
    if (!(doubts->film_force > 0.0) || doubts->film < plausible)
        return;
    const long touching = last_above(approach, approach->count, approach->visible) + 1;
    baseline->force_variance += doubts->film_force * doubts->film_force;
    if (touching >= NT_CURVE_FEWEST && touching < approach->repulsive)
        approach->repulsive = touching;
}

/* Adds a law over what the approach's baseline left. */
static void add_to(nt_curve_baseline *baseline, const nt_free_law *law, const nt_free_record *r)
{
    const double shift = (baseline->z_mean - r->middle) / r->half;
    double even[3];
    nt_free_even(law, r, 0, even);
    baseline->force += even[0] + (even[1] + even[2] * shift) * shift;
    baseline->slope += (even[1] + 2.0 * even[2] * shift) / r->half;
    baseline->bend.bow = even[2] / (r->half * r->half);
    if (law->has_film) {
        baseline->bend.nearest = r->middle + r->foot * r->half;
        baseline->bend.pole = baseline->bend.nearest - law->scale * r->half;
        baseline->bend.film = law->film * law->scale * r->half;
    }
}

/* Leaves a bent baseline unless there is a snap-in, whose own forces reach far out and look like a bow. */
static void take_off(const nt_curve_segment *segment, const nt_curve_baseline *bent, double *work[2],
                     nt_curve_branch *approach)
{
    double *kept = work[0], *room = work[1];
    const long count = approach->count;
    const nt_curve_branch straight = *approach;
    nt_curve_read_events(segment, bent, straight.noise, room, approach);
    if (straight.dips && approach->dips) {
        *approach = straight;
        return;
    }
    memcpy(kept, room, 2 * (size_t)count * sizeof *room);
    approach->z = kept;
    approach->force = kept + count;
    nt_curve_renew_noise(approach);
}

/* Where contact begins [m], and the first points that are surely out of it. */
typedef struct zone {
    double foot;
    long approach, tail;
} zone;

/* 0: contact cannot be told from the rest, or too little is free. */
static int find_zone(const nt_curve_branch *approach, const nt_curve_branch *tail, zone *found)
{
    const double *z = approach->z;
    const long count = approach->count, seen = last_above(approach, count, approach->visible);
    const long deeper = last_above(approach, seen + 1, deep * approach->visible);
    if (deeper < 0)
        return 0;
    const double step = z[seen] - z[deeper];
    found->foot = z[seen] + foot_part * step;
    const long clear = nt_curve_first_from(approach, z[seen] + clear_part * step);
    found->approach = clear > seen + 1 ? clear : seen + 1;
    found->tail = found->approach < count ? nt_curve_first_from(tail, z[found->approach]) : 0;
    return count - found->approach >= LEAST_BLOCKS * NT_FREE_BLOCK &&
           z[count - 1] - z[found->approach] >= least_free * (z[count - 1] - z[0]);
}

/* From where on the tail's force stays near the level of its far half. */
static long level_from(const nt_curve_branch *tail, long first)
{
    double level = 0.0;
    const long half = tail->count / 2;
    for (long i = half; i < tail->count; i++)
        level += tail->force[i] / (double)(tail->count - half);
    for (long i = first; i < tail->count; i++)
        first = fabs(tail->force[i] - level) > tail->visible ? i + 1 : first;
    return first;
}

static nt_free_record record_of(const nt_curve_branch *approach, const nt_curve_branch *tail, const zone *from)
{
    const double first = approach->z[from->approach], last = approach->z[approach->count - 1];
    nt_free_record record = {.half = 0.5 * (last - first), .middle = 0.5 * (last + first)};
    record.foot = (from->foot - record.middle) / record.half;
    record.approach = nt_free_means_of(approach, from->approach, &record);
    if (tail->count - from->tail >= LEAST_BLOCKS * NT_FREE_BLOCK)
        record.tail = nt_free_means_of(tail, from->tail, &record);
    return record;
}

/* What both branches have in common over a law, as strong against the noise as on one of them: contact shows there, a
 * film does not. Where the retraction is not free: the approach alone. */
static void common_part(const nt_curve_branch *approach, const nt_curve_branch *tail, const nt_free_law *law,
                        const nt_free_record *r, double *common)
{
    const double half = sqrt(0.5);
    double on[3], back[3];
    nt_free_even(law, r, 0, on);
    nt_free_even(law, r, 1, back);
    for (long i = 0, j = 0; i < approach->count; i++) {
        const double z = approach->z[i], x = (z - r->middle) / r->half;
        common[i] = approach->force[i] - on[0] - (on[1] + on[2] * x) * x;
        while (j + 1 < tail->count && tail->z[j + 1] <= z)
            j++;
        if (z >= tail->z[0])
            common[i] = half * (common[i] + tail->force[j] - back[0] - (back[1] + back[2] * x) * x);
        else
            common[i] -= nt_free_film_at(law, r, x);
    }
}

/* Means a zone that reaches nearer to contact, where the force in front of it may be a film; 0: there is none. */
static int nearer_zone(const nt_curve_branch *approach, const nt_curve_branch *tail, double *room, zone *found)
{
    nt_curve_branch common = *approach;
    const long before = found->approach;
    common.force = room;
    return find_zone(&common, tail, found) && found->approach < before;
}

nt_curve_bend_doubts nt_curve_unbend(const nt_curve_segment *segment, const nt_curve_branch *tail, double *work[2],
                                     nt_curve_branch *approach)
{
    nt_curve_bend_doubts left_open = {.film = !approach->dips};
    const int snaps_in = approach->dips;
    zone from;
    if (!find_zone(approach, tail, &from))
        return left_open;
    from.tail = level_from(tail, from.tail);
    nt_free_record record = record_of(approach, tail, &from);
    nt_free_law law = nt_free_judge(&record, &left_open);
    for (int pass = 1; pass < PASSES && law.confirmed && (law.has_film || law.has_bow || left_open.film > 0.0);
         pass++) {
        common_part(approach, tail, &law, &record, work[1]);
        if (!nearer_zone(approach, tail, work[1], &from))
            break;
        nt_curve_bend_doubts open;
        const nt_free_record nearer = record_of(approach, tail, &from);
        const nt_free_law found = nt_free_judge(&nearer, &open);
        if (!found.confirmed)
            break;
        record = nearer;
        law = found;
        left_open = open;
    }
    nt_curve_baseline bent = approach->baseline;
    add_to(&bent, &law, &record);
    if (law.has_bow || law.has_film)
        take_off(segment, &bent, work, approach);
    if (snaps_in)
        left_open.film = left_open.film_force = 0.0;
    return left_open;
}
