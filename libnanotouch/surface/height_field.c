/* SPDX-License-Identifier: BSD-3-Clause
 * A grid of heights as an interpolating cubic B-spline with mirrored borders (Unser, "Splines: a perfect fit", 1999):
 *     z(x, y) = sum c[j][i] B(x/dx - i) B(y/dy - j).
 * The coefficients c follow from the heights by a recursive filter with the pole sqrt(3) - 2, along rows, then columns.
 * The mirror makes the slope across a border 0, so that the surface continues level outside. */
#include "internal/field.h"
#include "internal/surface.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/surface.h"

#include <math.h>
#include <stddef.h>

#include "core/problem.h"

#define HEIGHT_MAX 1.0                 /* [m] */
#define POLE (-0.26794919243112270647) /* sqrt(3) - 2 */
enum {
    PIXELS_MIN = 4,
    PIXELS_MAX = 32768,
    TAIL = 32 /* |POLE|^32 < 1e-18: what lies further off is below rounding */
};

/* Index mirrored at the first and the last pixel, without repeating them. */
static long mirror(long i, long n)
{
    const long period = 2 * (n - 1);
    i %= period;
    if (i < 0)
        i += period;
    return i < n ? i : period - i;
}

/* Heights to coefficients along one line, in place: 6 / (z + 4 + 1/z) as a causal and an anticausal pass. */
static void filter_line(double *c, long n, long stride)
{
    double first = 0.0, weight = 1.0;
    for (long k = 0; k < TAIL; k++) {
        first += weight * c[mirror(k, n) * stride];
        weight *= POLE;
    }
    c[0] = first;
    for (long k = 1; k < n; k++)
        c[k * stride] += POLE * c[(k - 1) * stride];
    const long last = n - 1;
    c[last * stride] = 6.0 * POLE / (POLE * POLE - 1.0) * (c[last * stride] + POLE * c[(last - 1) * stride]);
    for (long k = last - 1; k >= 0; k--)
        c[k * stride] = POLE * (c[(k + 1) * stride] - 6.0 * c[k * stride]);
}

/* The four pixels whose splines reach a point, with their weights for value and slope. */
typedef struct reach {
    long index[4];
    double value[4], slope[4];
    double t;     /* place between the second and the third */
    int mirrored; /* they do not lie side by side */
    int outside;  /* beyond the map, where the surface is level */
} reach;

/* u in pixels, clamped to the map; beyond it the surface is level across the border. */
static reach reach_of(double u, long n)
{
    const double inside = u<0.0 ? 0.0 : u>(double)(n - 1) ? (double)(n - 1) : u;
    long i = (long)inside;
    if (i > n - 2)
        i = n - 2;
    const double t = inside - (double)i, s = 1.0 - t;
    reach r = {
        .index = {i > 0 ? i - 1 : 1, i, i + 1, i + 2 < n ? i + 2 : n - 2}, /* mirrored */
        .value = {s * s * s * (1.0 / 6.0), 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - s * s * (1.0 - 0.5 * s),
                  t * t * t * (1.0 / 6.0)},
        .t = t,
        .mirrored = i == 0 || i == n - 2,
        .outside = inside != u,
    };
    if (!r.outside) {
        r.slope[0] = -0.5 * s * s;
        r.slope[1] = t * (1.5 * t - 2.0);
        r.slope[2] = s * (2.0 - 1.5 * s);
        r.slope[3] = 0.5 * t * t;
    }
    return r;
}

/* Weights of the second derivative. */
static void bend_of(const reach *r, double curvature[4])
{
    const double t = r->t, s = 1.0 - t, bent[4] = {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t};
    for (int k = 0; k < 4; k++)
        curvature[k] = r->outside ? 0.0 : bent[k];
}

/* The rows are summed first: four columns side by side, which processors do at once. */
static nt_height_value height_at(const nt_surface *surface, const reach *rx, const reach *ry)
{
    double value[4] = {0.0}, slope[4] = {0.0}; /* of each column, along y */
    for (int j = 0; j < 4; j++) {
        const double *row = surface->coefficients + ry->index[j] * surface->nx, *four = row + rx->index[0];
        double gathered[4];
        if (rx->mirrored) {
            for (int i = 0; i < 4; i++)
                gathered[i] = row[rx->index[i]];
            four = gathered;
        }
        for (int i = 0; i < 4; i++) {
            value[i] += ry->value[j] * four[i];
            slope[i] += ry->slope[j] * four[i];
        }
    }
    nt_height_value at = {0.0, 0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        at.z += rx->value[i] * value[i];
        at.zx += rx->slope[i] * value[i];
        at.zy += rx->value[i] * slope[i];
    }
    at.zx /= surface->dx;
    at.zy /= surface->dy;
    return at;
}

nt_status nt_height_map_check(const nt_height_map *map, nt_problem *problem)
{
    static const nt_field fields[] = {
        NT_FIELD_NAMED("map.dx", nt_height_map, dx, "m", 1e-12, 1e-3, "pixel size along x"),
        NT_FIELD_NAMED("map.dy", nt_height_map, dy, "m", 1e-12, 1e-3, "pixel size along y"),
    };
    nt_problem ignored;
    if (problem == NULL)
        problem = &ignored;
    if (map->heights == NULL) {
        *problem = nt_problem_of("map.heights", "m", 0.0, -HEIGHT_MAX, HEIGHT_MAX);
        return NT_E_ARGUMENT;
    }
    const long counts[2] = {map->nx, map->ny};
    for (int k = 0; k < 2; k++)
        if (counts[k] < PIXELS_MIN || counts[k] > PIXELS_MAX) {
            *problem = nt_problem_of(k == 0 ? "map.nx" : "map.ny", "", (double)counts[k], PIXELS_MIN, PIXELS_MAX);
            return NT_E_RANGE;
        }
    const nt_status status = nt_field_check(fields, 2, map, problem);
    if (status != NT_OK)
        return status;
    for (long p = 0; p < map->nx * map->ny; p++)
        if (!(fabs(map->heights[p]) <= HEIGHT_MAX)) {
            *problem = nt_problem_of("map.heights", "m", map->heights[p], -HEIGHT_MAX, HEIGHT_MAX);
            return isfinite(map->heights[p]) ? NT_E_RANGE : NT_E_NOT_FINITE;
        }
    return NT_OK;
}

nt_status nt_surface_init(nt_surface *surface, const nt_height_map *map, double *coefficients)
{
    const nt_status status = nt_height_map_check(map, NULL);
    if (status != NT_OK)
        return status;
    if (coefficients == NULL)
        return NT_E_ARGUMENT;
    const long nx = map->nx, ny = map->ny;
    nt_surface made = {coefficients, nx, ny, map->dx, map->dy, map->heights[0], map->heights[0]};
    for (long p = 0; p < nx * ny; p++) {
        const double height = map->heights[p];
        made.height_minimum = fmin(made.height_minimum, height);
        made.height_maximum = fmax(made.height_maximum, height);
        coefficients[p] = height;
    }
    for (long j = 0; j < ny; j++)
        filter_line(coefficients + j * nx, nx, 1);
    for (long i = 0; i < nx; i++)
        filter_line(coefficients + i, ny, nx);
    *surface = made;
    return NT_OK;
}

nt_surface nt_surface_flat(void)
{
    return (nt_surface){.coefficients = NULL, .dx = 1.0, .dy = 1.0};
}

nt_surface_value nt_surface_eval(const nt_surface *surface, double x, double y)
{
    nt_surface_value v = {0};
    if (isnan(x) || isnan(y)) {
        const double nan = x + y;
        return (nt_surface_value){nan, nan, nan, nan, nan, nan};
    }
    if (surface->coefficients == NULL)
        return v;
    const double dx = surface->dx, dy = surface->dy;
    const reach rx = reach_of(x / dx, surface->nx), ry = reach_of(y / dy, surface->ny);
    double bend_x[4], bend_y[4];
    bend_of(&rx, bend_x);
    bend_of(&ry, bend_y);
    for (int j = 0; j < 4; j++) {
        const double *row = surface->coefficients + ry.index[j] * surface->nx;
        double value = 0.0, slope = 0.0, curvature = 0.0; /* along x, of this row */
        for (int i = 0; i < 4; i++) {
            const double c = row[rx.index[i]];
            value += rx.value[i] * c;
            slope += rx.slope[i] * c;
            curvature += bend_x[i] * c;
        }
        v.z += ry.value[j] * value;
        v.zx += ry.value[j] * slope / dx;
        v.zy += ry.slope[j] * value / dy;
        v.zxx += ry.value[j] * curvature / (dx * dx);
        v.zxy += ry.slope[j] * slope / (dx * dy);
        v.zyy += bend_y[j] * value / (dy * dy);
    }
    return v;
}

nt_height_value nt_surface_height(const nt_surface *surface, double x, double y)
{
    if (isnan(x) || isnan(y))
        return (nt_height_value){x + y, x + y, x + y};
    if (surface->coefficients == NULL)
        return (nt_height_value){0.0, 0.0, 0.0};
    const reach rx = reach_of(x / surface->dx, surface->nx), ry = reach_of(y / surface->dy, surface->ny);
    return height_at(surface, &rx, &ry);
}

static nt_property_value property_at(const nt_surface *grid, const reach *rx, const reach *ry)
{
    if (grid->coefficients == NULL)
        return (nt_property_value){0.0, 0.0, 0.0};
    const nt_height_value at = height_at(grid, rx, ry);
    return (nt_property_value){at.z, at.zx, at.zy};
}

nt_place nt_surface_place(const nt_surface *surface, const nt_radius_map *radii, const nt_properties *properties,
                          double x, double y)
{
    const double R = radii != NULL ? radii->tip_radius : 0.0;
    nt_place place = {.radius = {.radius = R}};
    if (isnan(x) || isnan(y) || surface->coefficients == NULL) {
        place.surface = nt_surface_height(surface, x, y);
        return place;
    }
    const reach rx = reach_of(x / surface->dx, surface->nx), ry = reach_of(y / surface->dy, surface->ny);
    place.surface = height_at(surface, &rx, &ry);
    if (radii != NULL && radii->ratio.coefficients != NULL) {
        const nt_height_value ratio = height_at(&radii->ratio, &rx, &ry);
        place.radius = (nt_radius_value){.radius = R * ratio.z, .dx = R * ratio.zx, .dy = R * ratio.zy};
    }
    if (properties != NULL) {
        place.youngs_modulus = property_at(&properties->youngs_modulus, &rx, &ry);
        place.work_of_adhesion = property_at(&properties->work_of_adhesion, &rx, &ry);
    }
    return place;
}

int nt_surface_contains(const nt_surface *surface, double x, double y)
{
    if (surface->coefficients == NULL)
        return !isnan(x) && !isnan(y);
    return x >= 0.0 && x <= (double)(surface->nx - 1) * surface->dx && //
           y >= 0.0 && y <= (double)(surface->ny - 1) * surface->dy;
}
