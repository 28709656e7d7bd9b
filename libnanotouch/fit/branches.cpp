// SPDX-License-Identifier: BSD-3-Clause
// What both branches say against an elastic contact without adhesion: a tip that snaps in or is torn off a contact, and
// work that the approach puts in and the retraction does not return.
#include <algorithm>
#include <cmath>
#include <limits>

#include "internal/fit.h"
#include "nanotouch/fit.h"

namespace
{

constexpr double snaps = 0.02;   // of the load: a depth below the baseline on the approach
constexpr double tears = 0.05;   // the same on the retraction, where it is a contact that lets go
constexpr double reach = 4.5;    // times force over slope, within which one does (curves/adhesion.py)
constexpr double told = 0.08;    // sigma of the power: below, the approach would show an adhesion that it has
constexpr double elastic = 0.12; // of the work
constexpr double by_noise = 5.0; // of the work, times noise over load and what a soft lever makes of it

// Of the contact, over its indentation [J].
double work_of(const nt_curve_branch &branch, double contact_point, double spring_constant)
{
    double work = 0.0, last_depth = 0.0, last_force = 0.0;
    for (long i = 0; i < branch.count && branch.z[i] < contact_point; i++) {
        const double depth = std::max(contact_point - branch.z[i] - branch.force[i] / spring_constant, 0.0);
        const double force = std::max(branch.force[i], 0.0);
        if (i > 0)
            work += 0.5 * (force + last_force) * (last_depth - depth);
        last_depth = depth;
        last_force = force;
    }
    return work + 0.5 * last_depth * last_force;
}

// A dip at the contact, and not one of slow noise.
bool snaps_in(const nt_curve_branch &approach, double contact_point, double load)
{
    const double depth = approach.dip.value, slope = approach.contact_slope.value;
    return approach.dips && depth > snaps * load && slope > 0.0 &&
           std::fabs(approach.dip_z - contact_point) < reach * depth / slope;
}

bool is_torn_off(const nt_curve_branch &retract, int ruptures)
{
    if (!retract.dips || retract.torn < 0 || ruptures > 1 || !(retract.contact_slope.value > 0.0))
        return false;
    long crossing = 0;
    while (crossing < retract.torn && retract.force[crossing] > 0.0)
        crossing++;
    return retract.z[retract.torn] - retract.z[crossing] <= reach * retract.dip.value / retract.contact_slope.value;
}

} // namespace

unsigned nt_fit_branch_doubts(const nt_fit_branches *branches, double *kept_back)
{
    *kept_back = std::numeric_limits<double>::quiet_NaN();
    const nt_curve_branch &approach = *branches->approach, &retract = *branches->retract;
    if (approach.count == 0 || retract.count == 0)
        return 0U;
    unsigned doubts = 0U;
    const double load = *std::max_element(approach.force, approach.force + approach.count);
    const bool seen = snaps_in(approach, branches->contact_point, load);
    const bool hidden = !(branches->power_sigma < told);
    if (seen || (hidden && retract.dip.value > tears * load && is_torn_off(retract, branches->ruptures)))
        doubts |= NT_FIT_ADHESIVE;
    const double in = work_of(approach, branches->contact_point, branches->spring_constant);
    const double back = work_of(retract, branches->contact_point, branches->spring_constant);
    if (in > 0.0) {
        *kept_back = 1.0 - back / in;
        const double bent = load / branches->spring_constant, depth = branches->contact_point - approach.z[0] - bent;
        const double noise = std::max(approach.noise, retract.noise) / load;
        if (std::fabs(*kept_back) > elastic + by_noise * noise * (1.0 + bent / std::max(depth, 1e-3 * bent)))
            doubts |= NT_FIT_HYSTERESIS;
    }
    return doubts;
}
