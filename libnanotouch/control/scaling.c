/* SPDX-License-Identifier: BSD-3-Clause
 * Scaling factors between hand and tip (paper, Sec. IV-C). */
#include "core/rig.h"
#include "nanotouch/control.h"

nt_scaling nt_scaling_heuristic(const nt_rig *rig, double slave_path, double attraction)
{
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    nt_scaling scaling = {
        .alpha_p = slave_path / rig->master.travel,
        .alpha_f = 2.0 * rig->master.gauge_range / (saturation + attraction), /* Eq. 19 */
    };
    return scaling;
}
