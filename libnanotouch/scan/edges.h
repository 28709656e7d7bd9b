/* SPDX-License-Identifier: BSD-3-Clause
 * Private: gaps between which the force on a tapping tip is smooth, where a quadrature over its way is cut. */
#ifndef NANOTOUCH_SCAN_EDGES_H
#define NANOTOUCH_SCAN_EDGES_H

#include <math.h>

#include "nanotouch/advanced/tapping.h"
#include "scene/parts.h"

#define NEAREST 0.25e-9 /* thickness of the first shell of forces that fall with the gap [m] */
#define GROWTH 4.0
enum { EDGES_MAX = 12, POINTS = 5 };

/* Gauss-Legendre on 0 .. 1. */
static const double points[POINTS] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155,
                                      0.95308992296933200};
static const double weights[POINTS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                       0.23931433524968324, 0.11846344252809454};

/* A way down to a gap and up to another; release: 1 if the contact lets go on it. */
typedef struct nt_edges {
    double low, top; /* [m] */
    int count;
    double at[EDGES_MAX + 1]; /* rising, the top last [m] */
} nt_edges;

static inline void nt_edges_add(nt_edges *edges, double gap)
{
    if (gap <= edges->low || gap >= edges->top || edges->count == EDGES_MAX)
        return;
    int i = edges->count++;
    for (; i > 0 && edges->at[i - 1] > gap; i--)
        edges->at[i] = edges->at[i - 1];
    edges->at[i] = gap;
}

/* First touch, capture, release where the contact lets go, and shells. */
static inline nt_edges nt_edges_of(const nt_tapping_over *over, double low, double top, int lets_go)
{
    nt_edges edges = {.low = low, .top = top};
    nt_edges_add(&edges, 0.0);
    const double capture = nt_plan_capture_gap(over->plan, over->place), release = over->plan->release_gap;
    if (isfinite(capture))
        nt_edges_add(&edges, capture);
    if (lets_go && isfinite(release))
        nt_edges_add(&edges, release);
    const double start = fmax(low, 0.0);
    for (double shell = NEAREST; edges.count < EDGES_MAX && start + shell < 0.7 * top; shell *= GROWTH)
        nt_edges_add(&edges, start + shell);
    edges.at[edges.count++] = top;
    return edges;
}

#endif
