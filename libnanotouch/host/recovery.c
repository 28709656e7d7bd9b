/* SPDX-License-Identifier: BSD-3-Clause
 * The surface of a sample that relaxes, as a view draws it: pressed in by the tip, and still dented after it has gone.
 *
 * The host follows the contact by springs of its own (rheology.h), along the gaps that it sees. The surface of
 * the half-space goes with their displacement g(x), of the tip's and of those that recover (Popov, Hess 2015):
 * w(r) = 2/pi Int_0^r g(x)/sqrt(r^2 - x^2) dx. */
#include <math.h>
#include <string.h>

#include "host/state.h"
#include "internal/rheology.h"

static const double PERIOD = 1e-3;  /* of the springs [s] */
static const double TOLD = 0.05;    /* so often [s] */
static const double SEEN = 1e-3;    /* of the max indentation: less is not drawn */
static const double ERROR = 1e-2;   /* of the kernel */
static const double LONGEST = 10.0; /* without frames: from then on nothing is known [s] */
enum { SPRINGS = 48, ANGLES = 32 };

static int is_same(const nt_viscoelastic_bed *a, const nt_viscoelastic_bed *b)
{
    return a->springs == b->springs && a->arms == b->arms && !memcmp(a->depth, b->depth, sizeof a->depth) &&
           !memcmp(a->moduli, b->moduli, sizeof a->moduli) && !memcmp(a->decay, b->decay, sizeof a->decay) &&
           a->equilibrium_modulus == b->equilibrium_modulus;
}

/* Where the springs stand: a spring is reached where the contact's radius is its own. */
static void place(nt_host_recovery *of, const nt_shape *shape)
{
    for (int i = 0; i < of->bed.springs; ++i)
        of->x[i] = nt_shape_eval(shape, 1.0, of->bed.depth[i]).a;
    of->edge = nt_shape_eval(shape, 1.0, of->bed.max_indentation).a;
}

void nt_recovery_learn(nt_session_host *host)
{
    nt_host_recovery *of = &host->recovery;
    const nt_scene *scene = &nt_session_setup_of(host->session)->scene;
    const nt_plan *plan = &host->plan;
    const nt_viscoelastic contact = {
        .shape = plan->shape, .rheology = scene->rheology, .poisson_ratio = scene->sample.poisson_ratio};
    const nt_viscoelastic_demand demand = {.period = PERIOD,
                                           .max_indentation = plan->relaxation.bed.max_indentation,
                                           .longest_time = fmax(scene->range.duration, 2.0 * PERIOD),
                                           .kernel_error = ERROR,
                                           .springs = SPRINGS};
    nt_viscoelastic_bed bed;
    const int follows =
        plan->history == NT_HISTORY_RELAXES && nt_viscoelastic_bed_make(&contact, &demand, &bed, NULL) == NT_OK;
    if (follows && of->follows && is_same(&bed, &of->bed))
        return;
    nt_recovery_forget(host);
    of->follows = follows;
    if (!follows)
        return;
    of->bed = bed;
    place(of, &plan->shape);
}

void nt_recovery_forget(nt_session_host *host)
{
    nt_host_recovery *of = &host->recovery;
    memset(&of->state, 0, sizeof of->state);
    of->has_last = 0;
    of->told = -INFINITY;
    if (of->is_seen)
        host->due |= NT_DUE_RECOVERY;
    of->is_seen = 0;
}

static double deepest(const nt_host_recovery *of)
{
    double most = 0.0;
    for (int i = 0; i < of->state.touched; ++i)
        most = fmax(most, of->state.u[i]);
    return most;
}

void nt_recovery_see(nt_session_host *host, const nt_frame *frame)
{
    nt_host_recovery *of = &host->recovery;
    if (!of->follows || !isfinite(frame->gap))
        return;
    if (of->has_last && (frame->time < of->time || frame->time > of->time + LONGEST))
        nt_recovery_forget(host);
    const double depth = fmin(-frame->gap, of->bed.max_indentation);
    const long steps = of->has_last ? (long)((frame->time - of->time) / PERIOD) : 0;
    for (long i = 1; i <= steps; ++i)
        (void)nt_viscoelastic_advance(&of->bed, &of->state,
                                      of->depth + (depth - of->depth) * (double)i / (double)steps);
    if (of->has_last && !steps)
        return;
    of->time = of->has_last ? of->time + PERIOD * (double)steps : frame->time;
    of->depth = depth;
    of->has_last = 1;
    const int is_seen = deepest(of) > SEEN * of->bed.max_indentation;
    if ((is_seen || of->is_seen) && of->time >= of->told + TOLD) {
        of->told = of->time;
        of->is_seen = is_seen;
        host->due |= NT_DUE_RECOVERY;
    }
}

/* g at a distance: what the springs show, level within the first one, 0 beyond the last. */
static double displacement(const nt_host_recovery *of, double x)
{
    const double *u = of->state.u, *at = of->x;
    const int count = of->bed.springs;
    if (x <= at[0])
        return u[0];
    int low = 0, high = count - 1;
    if (x >= at[high])
        return x < of->edge ? u[high] : 0.0;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(at[middle] <= x ? &low : &high) = middle;
    }
    return u[low] + (x - at[low]) / (at[high] - at[low]) * (u[high] - u[low]);
}

double nt_recovery_depth(const nt_session_host *host, double r)
{
    const nt_host_recovery *of = &host->recovery;
    double sum = 0.0;
    for (int i = 0; i < ANGLES; ++i)
        sum += displacement(of, r * sin(0.5 * NT_PI * (i + 0.5) / ANGLES));
    return sum / ANGLES;
}

static double distance_of(const nt_host_recovery *of, int row)
{
    const double part = (double)row / (NT_RECOVERY_ROWS - 1);
    return 4.0 * of->edge * part * part;
}

void nt_recovery_tell(nt_session_host *host, nt_text *json)
{
    const nt_host_recovery *of = &host->recovery;
    const int rows = of->follows && of->is_seen ? NT_RECOVERY_ROWS : 0;
    nt_json_key(json, "r");
    nt_json_open(json, "[");
    for (int i = 0; i < rows; ++i)
        nt_json_number(json, NULL, distance_of(of, i));
    nt_json_close(json, "]");
    nt_json_key(json, "z");
    nt_json_open(json, "[");
    for (int i = 0; i < rows; ++i)
        nt_json_number(json, NULL, -nt_recovery_depth(host, distance_of(of, i)));
    nt_json_close(json, "]");
}
