/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that keeps dents, as it is drawn (page.h): its law where the tip is, the section through the contact, and
 * the surface with what the tip has left and would leave if it let go now. The shapes are those of
 * nanotouch_app/live/dented.py; forces and dents are the library's (nanotouch/advanced/plasticity.h), which follows the
 * updates here as it follows the ticks in the session. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"

static struct {
    nt_indentation law;
    double load;    /* the largest [N] */
    nt_dents dents; /* as far as the updates say; the list is the session's */
    int is_placed;
    double *flat, *one,
        *heights;      /* before any dent; one dent alone; with those of `drawn`; an edge around for ridges */
    nt_height_map map; /* of these */
    int edge;          /* [pixels] */
    nt_dent drawn[NT_DENTS];
    int drawn_count; /* -1: not yet */
} sample = {.drawn_count = -1};

static nt_first_loading first(double radius)
{
    return nt_indentation_first(&sample.law, fmin(radius, NT_INDENTATION_LARGEST_RADIUS * sample.law.radius));
}

/* At rest at a place, with the list as it is. */
static void begin_at(double x, double y)
{
    nt_dents *dents = &sample.dents;
    dents->touches = dents->full = 0;
    dents->inside = -1;
    dents->contact = (nt_indentation_state){0};
    dents->began = dents->ploughed = dents->slid = 0.0;
    nt_dents_place(&sample.law, dents, x, y);
}

/* The sample that was planned last, under at most this load [N]. */
PAGE_API(page_dented_begin) void page_dented_begin(double load)
{
    sample.law = page_the_world()->plan.indentation;
    sample.load = load;
    begin_at(sample.dents.at[0], sample.dents.at[1]);
}

/* So many pixels that the widest dent with its ridge lies on the map wherever its middle does. */
static int edge_of(double dx, double dy)
{
    const nt_displacement how = nt_displacement_defaults();
    const double widest = NT_INDENTATION_LARGEST_RADIUS * sample.law.radius;
    return (int)fmin(ceil((1.0 + how.ridge_width) * widest / fmin(dx, dy)), 1000.0) + 2;
}

static int clamped(int number, int count)
{
    return number < 0 ? 0 : number < count ? number : count - 1;
}

/* The surface of the sample before any dent: ny rows of nx heights [m], copied. No dents, until they are told. */
PAGE_API(page_dented_lay) int page_dented_lay(const double *heights, int nx, int ny, double dx, double dy)
{
    const int edge = edge_of(dx, dy), wide = nx + 2 * edge, high = ny + 2 * edge;
    const size_t size = sizeof(double) * (size_t)wide * (size_t)high;
    free(sample.flat);
    free(sample.one);
    free(sample.heights);
    sample.flat = malloc(size);
    sample.one = calloc((size_t)wide * (size_t)high, sizeof(double));
    sample.heights = malloc(size);
    sample.dents.count = 0;
    sample.drawn_count = -1;
    sample.is_placed = 0;
    sample.edge = edge;
    sample.map = (nt_height_map){sample.heights, wide, high, dx, dy};
    if (!sample.flat || !sample.one || !sample.heights)
        return NT_E_NO_MEMORY;
    for (int j = 0; j < high; ++j)
        for (int i = 0; i < wide; ++i)
            sample.flat[j * wide + i] = heights[clamped(j - edge, ny) * nx + clamped(i - edge, nx)];
    return NT_OK;
}

/* The dents of the session, as page_dents gives them. A contact that holds goes on. */
PAGE_API(page_dented_take) void page_dented_take(const double *rows, int count)
{
    nt_dents *dents = &sample.dents;
    dents->count = count < NT_DENTS ? count : NT_DENTS;
    for (int i = 0; i < dents->count; ++i, rows += PAGE_DENT) {
        const nt_imprint imprint = {{rows[0], rows[1]}, {rows[2], rows[3]}, rows[4], rows[5]};
        dents->made[i] = (nt_dent){imprint, rows[6], (int)rows[7], 0};
    }
    if (!dents->touches)
        begin_at(dents->at[0], dents->at[1]);
    else if (dents->inside >= dents->count)
        dents->inside = -1;
}

/* Updates in their order, rows of x, y, gap, contact radius [m]; `anew`: they do not go on from those before. */
PAGE_API(page_dented_follow) void page_dented_follow(const double *rows, int count, int anew)
{
    nt_dents *dents = &sample.dents;
    for (int i = 0; i < count; ++i, rows += 4) {
        if (anew || !sample.is_placed)
            begin_at(rows[0], rows[1]);
        anew = 0;
        sample.is_placed = 1;
        if (rows[3] > 0.0) {
            nt_dents_advance(&sample.law, dents, rows[2]);
            nt_dents_slide(&sample.law, dents, rows[0], rows[1]);
        } else {
            dents->touches = 0;
            nt_dents_place(&sample.law, dents, rows[0], rows[1]);
        }
    }
}

/* --- what is drawn --- */

enum { DENTED_RELIEF, DENTED_BEGAN, DENTED_RADIUS, DENTED_DEPTH, DENTED_STORED, DENTED_YIELD };

/* How deep it can become; radius of the dent where this contact began; radius and depth of what is there now [m];
 * elastic energy of the contact [J]; the load up to which nothing yields [N]. */
PAGE_API(page_dented_fact) double page_dented_fact(int what)
{
    const nt_dents *dents = &sample.dents;
    const double most = first(HUGE_VAL).force;
    switch (what) {
    case DENTED_RELIEF:
        return first(nt_indentation_radius_at_load(&sample.law, fmin(sample.load, most))).indentation;
    case DENTED_BEGAN:
        return dents->began;
    case DENTED_RADIUS:
        return dents->contact.dent_radius;
    case DENTED_DEPTH:
        return first(dents->contact.dent_radius).residual_depth;
    case DENTED_STORED:
        return dents->touches ? dents->contact.stored : 0.0;
    case DENTED_YIELD:
        return nt_indentation_yield_load(&sample.law);
    default:
        return (double)NAN;
    }
}

/* Rows of gap and force: the way in from the dent that was there (part 0), the way out from where the contact has come
 * to (part 1); how many. */
PAGE_API(page_dented_curve) int page_dented_curve(int part, double farthest, nt_view_point *rows, int count)
{
    nt_dents dents = sample.dents;
    if (part == 0) {
        dents.contact.dent_radius = dents.began;
        dents.ploughed = 0.0;
    }
    const nt_first_loading dent = first(dents.contact.dent_radius);
    if (part != 0 && !(dent.residual_depth > 0.0))
        return 0;
    const double last = part == 0 ? fmax(page_dented_fact(DENTED_RELIEF), dent.indentation) : dent.indentation;
    const double from = part == 0 ? dents.bottom : dent.residual_depth;
    for (int i = 0; i < count; ++i) {
        const double share = part == 0 ? i - 1.0 : count - 1.0 - i, steps = part == 0 ? count - 2.0 : count - 1.0;
        const double gap = part == 0 && i == 0 ? farthest : dents.bottom - from - (last - from) * share / steps;
        rows[i] = (nt_view_point){gap, nt_dents_eval(&sample.law, &dents, gap).F};
    }
    return count;
}

/* Under Hertz' pressure within a, for a contact of tip and dent with this radius (Johnson 1985, Eq. 3.42). */
static double sunk(double r, double a, double radius)
{
    if (!(a > 0.0))
        return 0.0;
    if (r <= a)
        return (2.0 * a * a - r * r) / (2.0 * radius);
    const double share = a / r;
    return ((2.0 * a * a - r * r) * asin(share) + a * r * sqrt(1.0 - share * share)) / (NT_PI * radius);
}

/* The section at a gap: as page_section. */
PAGE_API(page_dented_section)
void page_dented_section(double gap, const double *r, nt_view_profile *rows, int count, double found[3])
{
    const nt_dents *dents = &sample.dents;
    const double R = sample.law.radius, reached = dents->contact.dent_radius;
    const nt_first_loading dent = first(reached);
    const double deep = fmax(dents->bottom - gap, 0.0) - dent.residual_depth, radius = dent.effective_radius;
    double a = deep > 0.0 ? sqrt(radius * deep) : 0.0;
    if (reached > 0.0)
        a = fmin(a, reached);
    for (int i = 0; i < count; ++i) {
        const double tip = r[i] > R ? HUGE_VAL : gap - dents->bottom + R - sqrt(R * R - r[i] * r[i]);
        const double share = reached > 0.0 ? r[i] / reached : 1.0;
        const double left = share < 1.0 ? -dent.residual_depth * (1.0 - share * share) : 0.0;
        const double ground = left - sunk(r[i], a, radius);
        rows[i] = (nt_view_profile){tip, r[i] <= a ? fmin(tip, ground) : ground, tip};
    }
    found[0] = found[1] = a;
    found[2] = a > 0.0;
}

/* --- the surface --- */

/* As seen from the corner of the edge. */
static nt_imprint moved(nt_imprint of)
{
    const double by[2] = {sample.edge * sample.map.dx, sample.edge * sample.map.dy};
    for (int axis = 0; axis < 2; ++axis) {
        of.start[axis] += by[axis];
        of.end[axis] += by[axis];
    }
    return of;
}

/* One more dent. Where they overlap the deepest counts, beside it the highest ridge; `way` holds so far how far from
 * the ground each pixel is. */
static void add(double *way, const nt_imprint *imprint)
{
    const nt_displacement how = nt_displacement_defaults();
    const nt_imprint_change change = {NULL, imprint, &how};
    nt_edit done;
    if (nt_imprint_edit(sample.one, &sample.map, &change, &done, NULL) != NT_OK)
        return; /* finer than the pixels */
    for (long j = done.first_y; j < done.first_y + done.count_y; ++j)
        for (long i = done.first_x; i < done.first_x + done.count_x; ++i) {
            double *so_far = &way[j * sample.map.nx + i], *new = &sample.one[j * sample.map.nx + i];
            *so_far = *so_far < 0.0 || *new < 0.0 ? fmin(*so_far, *new) : fmax(*so_far, *new);
            *new = 0.0;
        }
}

/* All dents with their ridges, but those that have grown into another one. */
static void edit(const nt_dents *dents)
{
    const long pixels = sample.map.nx * sample.map.ny;
    int has_grown[NT_DENTS] = {0};
    for (int i = 0; i < dents->count; ++i)
        if (dents->made[i].before >= 0 && dents->made[i].before < i)
            has_grown[dents->made[i].before] = 1;
    memset(sample.heights, 0, sizeof(double) * (size_t)pixels);
    for (int i = 0; i < dents->count; ++i) {
        const nt_imprint imprint = moved(dents->made[i].imprint);
        if (!has_grown[i])
            add(sample.heights, &imprint);
    }
    for (long i = 0; i < pixels; ++i)
        sample.heights[i] += sample.flat[i];
}

/* Into `heights`, the pixels of page_dented_lay: with all dents, and with the one that would be left if the tip let go
 * now [m]. 0: as they were drawn last, nothing is written. */
PAGE_API(page_dented_heights) int page_dented_heights(double *heights)
{
    nt_dents dents = sample.dents;
    if (!sample.heights)
        return 0;
    if (dents.touches) {
        dents.touches = 0;
        nt_dents_place(&sample.law, &dents, dents.at[0], dents.at[1]);
    }
    const size_t size = sizeof dents.made[0] * (size_t)dents.count;
    if (dents.count == sample.drawn_count && !memcmp(dents.made, sample.drawn, size))
        return 0;
    memcpy(sample.drawn, dents.made, size);
    sample.drawn_count = dents.count;
    edit(&dents);
    const long edge = sample.edge, nx = sample.map.nx - 2 * edge, ny = sample.map.ny - 2 * edge;
    for (long j = 0; j < ny; ++j)
        memcpy(heights + j * nx, sample.heights + (j + edge) * sample.map.nx + edge, sizeof(double) * (size_t)nx);
    return 1;
}
