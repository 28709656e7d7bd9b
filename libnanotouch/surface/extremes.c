/* SPDX-License-Identifier: BSD-3-Clause
 * Highest, lowest and steepest place of a cubic B-spline along a path or in an area, by branch and bound. About the
 * middle of a piece the surface is its Taylor series; the remainder is bounded by derivatives that are splines of the
 * differences of the coefficients, and no spline is beyond its coefficients. A piece whose bound is not close to the
 * largest value found so far is halved. Both shrink together: the bound exceeds the truth in proportion to the square
 * of the piece. */
#include "surface/extremes.h"
#include "core/same_bits.h"
#include "internal/surface.h"

#include <math.h>

#define CLOSE_HEIGHT 1e-6 /* of the map's height range */
#define CLOSE_SLOPE 1e-3  /* of the slope */
#define ROUNDING 1e-15    /* of heights, and of slopes over a pixel */
enum {
    CELLS = 3,          /* along an axis that a piece may lie in, a piece of a path across their borders */
    WINDOW = CELLS + 3, /* coefficients that reach them */
    HALVINGS = 48
};

/* What is sought; the lowest as the highest of -z. */
enum { HIGHEST, LOWEST, STEEPEST, SOUGHT };

/* Centre and half extent: along a path the vector (a, b), in an area a box of +-a, +-b [m]. */
typedef struct piece {
    double x, y, a, b;
} piece;

/* The cells that a piece lies in. */
typedef struct cells {
    long first[2], last[2]; /* along x and y */
} cells;

/* Largest |difference| of the coefficients that reach some cells, a times over x, b times over y, over the pixel:
 * bounds of the derivatives there [m^(1 - a - b)]. */
typedef struct derivatives {
    double of[4][4];
} derivatives;

typedef struct search {
    const nt_surface *surface;
    int on_path;
    double found[SOUGHT]; /* largest values so far */
    double bound[SOUGHT]; /* of the pieces that were not halved any more */
    double close[2];      /* absolute: of a height [m] and of a slope [-] */
} search;

/* A value in the middle of a piece, its bound there, and what of that x and y add. */
typedef struct estimate {
    double value, bound, by_x, by_y;
} estimate;

static long cell_of(double u, long n)
{
    return u < 0.0 ? 0 : u < (double)(n - 2) ? (long)u : n - 2;
}

static cells cells_of(const nt_surface *s, const piece *p)
{
    const double a = fabs(p->a), b = fabs(p->b);
    const cells c = {{cell_of((p->x - a) / s->dx, s->nx), cell_of((p->y - b) / s->dy, s->ny)},
                     {cell_of((p->x + a) / s->dx, s->nx), cell_of((p->y + b) / s->dy, s->ny)}};
    return c;
}

/* Mirrored at the first and the last pixel, as the spline is. */
static long mirrored(long i, long n)
{
    return i < 0 ? -i : i < n ? i : 2 * (n - 1) - i;
}

/* The coefficients that reach some cells; sizes along x and y. */
static void window_of(const nt_surface *s, const cells *c, double window[WINDOW][WINDOW], int size[2])
{
    for (int k = 0; k < 2; k++)
        size[k] = (int)(c->last[k] - c->first[k]) + 4;
    for (int j = 0; j < size[1]; j++) {
        const double *row = s->coefficients + mirrored(c->first[1] - 1 + j, s->ny) * s->nx;
        for (int i = 0; i < size[0]; i++)
            window[j][i] = row[mirrored(c->first[0] - 1 + i, s->nx)];
    }
}

static void range_of(const nt_surface *s, const cells *c, double range[2])
{
    double window[WINDOW][WINDOW];
    int size[2];
    window_of(s, c, window, size);
    for (int j = 0; j < size[1]; j++)
        for (int i = 0; i < size[0]; i++) {
            range[0] = window[j][i] < range[0] ? window[j][i] : range[0];
            range[1] = window[j][i] > range[1] ? window[j][i] : range[1];
        }
}

/* In place over x; the last column goes. */
static void difference_x(double window[WINDOW][WINDOW], const int size[2])
{
    for (int j = 0; j < size[1]; j++)
        for (int i = 0; i + 1 < size[0]; i++)
            window[j][i] = window[j][i + 1] - window[j][i];
}

static void difference_y(double window[WINDOW][WINDOW], const int size[2])
{
    for (int j = 0; j + 1 < size[1]; j++)
        for (int i = 0; i < size[0]; i++)
            window[j][i] = window[j + 1][i] - window[j][i];
}

static double largest(double window[WINDOW][WINDOW], const int size[2])
{
    double most = 0.0;
    for (int j = 0; j < size[1]; j++)
        for (int i = 0; i < size[0]; i++)
            most = fabs(window[j][i]) > most ? fabs(window[j][i]) : most;
    return most;
}

/* All derivatives up to an order. */
static void derivatives_of(const nt_surface *s, const cells *c, int order, derivatives *d)
{
    double over_x[WINDOW][WINDOW], over_y[WINDOW][WINDOW];
    int size[2];
    window_of(s, c, over_x, size);
    double per_x = 1.0;
    for (int a = 0; a <= order; a++, per_x /= s->dx) {
        int rest[2] = {size[0] - a, size[1]};
        double per_y = 1.0;
        for (int j = 0; j < size[1]; j++)
            for (int i = 0; i < rest[0]; i++)
                over_y[j][i] = over_x[j][i];
        for (int b = 0; a + b <= order; b++, per_y /= s->dy) {
            d->of[a][b] = largest(over_y, rest) * per_x * per_y;
            difference_y(over_y, rest);
            rest[1]--;
        }
        difference_x(over_x, (int[2]){size[0] - a, size[1]});
    }
}

/* z about the middle: |z - z_c - grad z . p| <= 1/2 (|z_xx| a^2 + 2 |z_xy| a b + |z_yy| b^2). */
static estimate height_of(const search *s, const nt_surface_value *v, const derivatives *d, const piece *p)
{
    const double a = fabs(p->a), b = fabs(p->b), mixed = 0.5 * d->of[1][1] * a * b;
    estimate e = {.value = v->z,
                  .by_x = fabs(v->zx) * a + 0.5 * d->of[2][0] * a * a + mixed,
                  .by_y = fabs(v->zy) * b + 0.5 * d->of[0][2] * b * b + mixed};
    e.bound = e.value + e.by_x + e.by_y;
    if (s->on_path) /* the two directions go together */
        e.bound += fabs(v->zx * p->a + v->zy * p->b) - fabs(v->zx) * a - fabs(v->zy) * b;
    return e;
}

/* |dz/ds| of a path: its slope and two more derivatives along it. */
static estimate slope_along(const nt_surface_value *v, const derivatives *d, const piece *p)
{
    const double a = fabs(p->a), b = fabs(p->b), length = hypotenuse(a, b);
    if (!(length > 0.0))
        return (estimate){0.0, 0.0, 0.0, 0.0};
    const double bend = v->zxx * p->a * p->a + 2.0 * v->zxy * p->a * p->b + v->zyy * p->b * p->b;
    const double third =
        d->of[3][0] * a * a * a + 3.0 * (d->of[2][1] * a + d->of[1][2] * b) * a * b + d->of[0][3] * b * b * b;
    const double value = fabs(v->zx * p->a + v->zy * p->b) / length;
    return (estimate){.value = value, .bound = value + (fabs(bend) + 0.5 * third) / length};
}

/* The remainder of q = |grad z|^2 over a box: |H p|^2 + |grad z| |D^3 z p p|. */
static double remainder_of(const derivatives *d, double a, double b)
{
    const double along_x = d->of[2][0] * a + d->of[1][1] * b, along_y = d->of[1][1] * a + d->of[0][2] * b;
    const double third_x = d->of[3][0] * a * a + 2.0 * d->of[2][1] * a * b + d->of[1][2] * b * b;
    const double third_y = d->of[2][1] * a * a + 2.0 * d->of[1][2] * a * b + d->of[0][3] * b * b;
    return along_x * along_x + along_y * along_y + d->of[1][0] * third_x + d->of[0][1] * third_y;
}

/* |grad z| in an area: q about the middle, of slope 2 H grad z. */
static estimate slope_within(const nt_surface_value *v, const derivatives *d, const piece *p)
{
    const double q = v->zx * v->zx + v->zy * v->zy;
    const double linear_x = 2.0 * fabs(v->zxx * v->zx + v->zxy * v->zy) * p->a;
    const double linear_y = 2.0 * fabs(v->zxy * v->zx + v->zyy * v->zy) * p->b;
    return (estimate){.value = sqrt(q),
                      .bound = sqrt(q + linear_x + linear_y + remainder_of(d, p->a, p->b)),
                      .by_x = linear_x + remainder_of(d, p->a, 0.0),
                      .by_y = linear_y + remainder_of(d, 0.0, p->b)};
}

static estimate estimate_of(const search *s, int what, const derivatives *d, const piece *p)
{
    nt_surface_value v = nt_surface_eval(s->surface, p->x, p->y);
    if (what == STEEPEST)
        return s->on_path ? slope_along(&v, d, p) : slope_within(&v, d, p);
    if (what == LOWEST) {
        v.z = -v.z;
        v.zx = -v.zx;
        v.zy = -v.zy;
    }
    return height_of(s, &v, d, p);
}

/* A bound up to here is close enough. */
static double enough(const search *s, int what)
{
    const double found = s->found[what];
    return what == STEEPEST ? found * (1.0 + CLOSE_SLOPE) + s->close[1] : found + s->close[0];
}

static void halve(search *s, int what, const derivatives *d, piece p, int halvings)
{
    const estimate e = estimate_of(s, what, d, &p);
    s->found[what] = fmax(s->found[what], e.value);
    if (e.bound <= enough(s, what) || halvings == 0) {
        s->bound[what] = fmax(s->bound[what], e.bound);
        return;
    }
    piece half[2] = {p, p};
    for (int k = 0; k < 2; k++) {
        const double side = k == 0 ? -0.5 : 0.5;
        if (s->on_path || e.by_x >= e.by_y) {
            half[k].x += side * p.a;
            half[k].a *= 0.5;
        }
        if (s->on_path || e.by_x < e.by_y) {
            half[k].y += side * p.b;
            half[k].b *= 0.5;
        }
        halve(s, what, d, half[k], halvings - 1);
    }
}

/* No slope is above those of the coefficients, nor these above what the range of heights lets them be, which is seen
 * at once and enough for most cells. */
static double steepest_of(const search *s, const cells *c, const double range[2])
{
    const double span = range[1] - range[0], roughly = hypotenuse(span / s->surface->dx, span / s->surface->dy);
    derivatives d;
    if (roughly <= enough(s, STEEPEST))
        return roughly;
    derivatives_of(s->surface, c, 1, &d);
    return hypotenuse(d.of[1][0], d.of[0][1]);
}

/* The largest in a piece of some cells, if it may be larger than what has been found. */
static void search_piece(search *s, const cells *c, const piece *p)
{
    double range[2] = {HUGE_VAL, -HUGE_VAL};
    derivatives d;
    range_of(s->surface, c, range);
    const double most[SOUGHT] = {range[1], -range[0], steepest_of(s, c, range)};
    int known = 0;
    for (int what = 0; what < SOUGHT; what++) {
        if (most[what] <= enough(s, what)) {
            s->bound[what] = fmax(s->bound[what], most[what]);
            continue;
        }
        if (!known)
            derivatives_of(s->surface, c, 3, &d);
        known = 1;
        halve(s, what, &d, *p, HALVINGS);
    }
}

static search search_of(const nt_surface *surface, int on_path)
{
    const double low = surface->height_minimum, high = surface->height_maximum;
    const double rounding = ROUNDING * fmax(fabs(low), fabs(high));
    return (search){
        .surface = surface,
        .on_path = on_path,
        .found = {-HUGE_VAL, -HUGE_VAL, 0.0},
        .bound = {-HUGE_VAL, -HUGE_VAL, 0.0},
        .close = {CLOSE_HEIGHT * (high - low) + rounding, 1e-9 + rounding / fmin(surface->dx, surface->dy)}};
}

#define NOTHING_YET                                                                                                    \
    {                                                                                                                  \
        {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL},                                                                  \
        {                                                                                                              \
            HUGE_VAL, -HUGE_VAL                                                                                        \
        }                                                                                                              \
    }

/* No such spline is beyond its coefficients. */
static void ranges_of(const nt_fields *fields, const cells *c, double range[NT_FIELDS][2])
{
    for (int field = 0; field < NT_FIELDS; field++)
        if (fields->of[field])
            range_of(fields->of[field], c, range[field]);
}

/* Between two points, in pieces of a pixel at most. */
static void search_leg(search *s, const double from[2], const double to[2], const nt_fields *fields,
                       double range[NT_FIELDS][2])
{
    const nt_surface *surface = s->surface;
    const double along[2] = {to[0] - from[0], to[1] - from[1]};
    const long count = 1 + (long)fmax(fabs(along[0]) / surface->dx, fabs(along[1]) / surface->dy);
    for (long k = 0; k < count; k++) {
        const double t = ((double)k + 0.5) / (double)count, half = 0.5 / (double)count;
        const piece p = {from[0] + t * along[0], from[1] + t * along[1], half * along[0], half * along[1]};
        const cells c = cells_of(surface, &p);
        search_piece(s, &c, &p);
        ranges_of(fields, &c, range);
    }
}

static piece cell_in(const nt_surface *s, const double x[2], const double y[2], long i, long j)
{
    const double west = fmax(x[0], (double)i * s->dx), east = fmin(x[1], (double)(i + 1) * s->dx);
    const double south = fmax(y[0], (double)j * s->dy), north = fmin(y[1], (double)(j + 1) * s->dy);
    return (piece){0.5 * (west + east), 0.5 * (south + north), 0.5 * fabs(east - west), 0.5 * fabs(north - south)};
}

/* First a value of each cell, so that most cells need no second look. */
static void search_area(search *s, const double x[2], const double y[2], const nt_fields *fields,
                        double range[NT_FIELDS][2])
{
    const piece all = {0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])};
    const cells c = cells_of(s->surface, &all);
    for (long j = c.first[1]; j <= c.last[1]; j++)
        for (long i = c.first[0]; i <= c.last[0]; i++) {
            const piece p = cell_in(s->surface, x, y, i, j);
            const nt_height_value at = nt_surface_height(s->surface, p.x, p.y);
            s->found[HIGHEST] = fmax(s->found[HIGHEST], at.z);
            s->found[LOWEST] = fmax(s->found[LOWEST], -at.z);
            s->found[STEEPEST] = fmax(s->found[STEEPEST], hypotenuse(at.zx, at.zy));
        }
    for (long j = c.first[1]; j <= c.last[1]; j++)
        for (long i = c.first[0]; i <= c.last[0]; i++) {
            const cells cell = {{i, j}, {i, j}};
            const piece p = cell_in(s->surface, x, y, i, j);
            search_piece(s, &cell, &p);
            ranges_of(fields, &cell, range);
        }
}

static nt_extremes extremes_of(const search *s, const nt_fields *fields, double range[NT_FIELDS][2])
{
    double most[SOUGHT];
    for (int what = 0; what < SOUGHT; what++)
        most[what] = fmax(s->found[what], s->bound[what]);
    nt_extremes found = {.highest = most[HIGHEST], .lowest = -most[LOWEST], .steepest = most[STEEPEST]};
    for (int field = 0; field < NT_FIELDS; field++) {
        found.least[field] = fields->of[field] ? range[field][0] : 0.0;
        found.most[field] = fields->of[field] ? range[field][1] : 0.0;
    }
    return found;
}

nt_extremes nt_extremes_on_path(const nt_surface *surface, const nt_fields *fields, const double *xy, long count)
{
    search s = search_of(surface, 1);
    double range[NT_FIELDS][2] = NOTHING_YET;
    search_leg(&s, xy, xy, fields, range);
    for (long i = 0; i + 1 < count; i++)
        search_leg(&s, xy + 2 * i, xy + 2 * (i + 1), fields, range);
    return extremes_of(&s, fields, range);
}

nt_extremes nt_extremes_in_area(const nt_surface *surface, const nt_fields *fields, const double x[2],
                                const double y[2])
{
    search s = search_of(surface, 0);
    double range[NT_FIELDS][2] = NOTHING_YET;
    search_area(&s, x, y, fields, range);
    return extremes_of(&s, fields, range);
}

static piece cell_at(const nt_surface *s, long i, long j)
{
    return (piece){((double)i + 0.5) * s->dx, ((double)j + 0.5) * s->dy, 0.5 * s->dx, 0.5 * s->dy};
}

double nt_extremes_in_cell(const nt_surface *surface, long i, long j, double enough_slope)
{
    search s = search_of(surface, 0);
    const cells c = {{i, j}, {i, j}};
    derivatives d;
    derivatives_of(surface, &c, 1, &d);
    const double roughly = hypotenuse(d.of[1][0], d.of[0][1]);
    s.found[STEEPEST] = enough_slope;
    if (roughly <= enough(&s, STEEPEST))
        return roughly;
    derivatives_of(surface, &c, 3, &d);
    halve(&s, STEEPEST, &d, cell_at(surface, i, j), HALVINGS);
    return fmax(s.found[STEEPEST], s.bound[STEEPEST]);
}

double nt_extremes_lowest_in_cell(const nt_surface *surface, long i, long j, double close)
{
    search s = search_of(surface, 0);
    const cells c = {{i, j}, {i, j}};
    derivatives d;
    s.close[0] = close;
    derivatives_of(surface, &c, 3, &d);
    halve(&s, LOWEST, &d, cell_at(surface, i, j), HALVINGS);
    return -fmax(s.found[LOWEST], s.bound[LOWEST]);
}
