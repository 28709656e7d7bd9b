/* SPDX-License-Identifier: BSD-3-Clause
 * What a session is opened with, and what of it is refused before anything is made. */
#include <limits.h>
#include <math.h>

#include "nanotouch/advanced/control.h"

#include "control/preflight.h"
#include "core/problem.h"
#include "session/state.h"

#define LEAST_CLEARANCE 1e-9                                   /* [m] */
#define LONGEST_PATH (LONG_MAX >> (sizeof(long) > 4 ? 23 : 5)) /* points; their size fits a size_t */

nt_session_setup nt_session_defaults(void)
{
    const nt_rig rig = nt_rig_defaults();
    nt_session_setup setup = {.scene = nt_scene_defaults(),
                              .rig = rig,
                              .demand = nt_demand_defaults(),
                              .settings = nt_settings_defaults(&rig),
                              .mode = NT_MODE_TOUCH,
                              .clearance = 0.1e-6,
                              .rise = NAN,
                              .seed = 1,
                              .ring_capacity = 65536,
                              .minimum_margin = 1.5,
                              .preflight = 1};
    nt_settings_keep_to(&setup.settings, setup.scene.range.maximum_load);
    return setup;
}

static nt_status check_start(const nt_session_setup *setup, nt_problem *problem)
{
    const nt_surface *surface = setup->surface;
    const nt_height_map *map = &setup->map;
    const int is_flat = !surface && !map->heights;
    const double width = surface ? (double)(surface->nx - 1) * surface->dx : (double)(map->nx - 1) * map->dx;
    const double height = surface ? (double)(surface->ny - 1) * surface->dy : (double)(map->ny - 1) * map->dy;
    const double least = is_flat ? -1.0 : 0.0;
    if (!(setup->x >= least && setup->x <= (is_flat ? 1.0 : width)))
        return nt_problem_set(problem, "x", "m", setup->x, least, is_flat ? 1.0 : width);
    if (!(setup->y >= least && setup->y <= (is_flat ? 1.0 : height)))
        return nt_problem_set(problem, "y", "m", setup->y, least, is_flat ? 1.0 : height);
    return NT_OK;
}

/* Whole numbers from 0 up, each with what it means. */
static nt_status check_choices(const nt_session_setup *setup, nt_problem *problem)
{
    const nt_control *control = &setup->settings.control;
    const int own = NT_CONTROL_OWN, laws = control->law != NULL;
    const struct {
        const char *field, *names;
        long value, minimum, maximum;
    } choices[] = {
        {"mode", NT_MODE_WORDS, (long)setup->mode, 0, NT_MODE_TAPPING},
        {"probe_model", NT_PROBE_WORDS, (long)setup->probe_model, 0, NT_PROBE_DYNAMIC},
        {"preflight", "no|yes", setup->preflight, 0, 1},
        {"dilated", "no|yes", setup->dilated, 0, 1},
        {"control.choice", NT_CONTROL_WORDS, (long)control->choice, 0, own},
        {"control.choice beside a law or a context of one's own", NT_CONTROL_WORDS, (long)control->choice,
         laws || control->context ? own : 0, own},
        {"control.law of the choice own", "no|yes", laws, control->choice == NT_CONTROL_OWN, 1},
        {"path.count", "", setup->path_count, setup->path != NULL, setup->path ? LONGEST_PATH : 0},
        {"master.context or master_option without a backend", "no|yes",
         !setup->master.backend && (setup->master.context || setup->master_option), 0, 0},
        {"slave.context or slave_option without a backend", "no|yes",
         !setup->slave.backend && (setup->slave.context || setup->slave_option), 0, 0},
        {"faults.count", "", setup->faults ? setup->faults->count : 0, 0, NT_FAULTS_MAX},
    };
    for (size_t i = 0; i < sizeof choices / sizeof *choices; ++i)
        if (choices[i].value < choices[i].minimum || choices[i].value > choices[i].maximum)
            return nt_problem_set(problem, choices[i].field, choices[i].names, (double)choices[i].value,
                                  (double)choices[i].minimum, (double)choices[i].maximum);
    return NT_OK;
}

int nt_session_has_fault(const nt_fault *fault, int simulates_master, int simulates_slave)
{
    switch (fault->channel) {
    case NT_CHANNEL_DEFLECTION:
    case NT_CHANNEL_STAGE_POSITION:
    case NT_CHANNEL_STAGE:
        return simulates_slave;
    case NT_CHANNEL_MASTER_POSITION:
    case NT_CHANNEL_OPERATOR_FORCE:
    case NT_CHANNEL_MOTOR:
        return simulates_master;
    case NT_CHANNEL_RIG:
        break;
    }
    if (fault->kind == NT_FAULT_PUSH)
        return simulates_master;
    return fault->kind == NT_FAULT_JUMP ? simulates_slave : simulates_master || simulates_slave;
}

static nt_status check_faults(const nt_session_setup *setup, nt_problem *problem)
{
    for (int i = 0; setup->faults && i < setup->faults->count; ++i)
        if (!nt_session_has_fault(&setup->faults->list[i], !setup->master.backend, !setup->slave.backend))
            return nt_problem_set(problem, "faults of a half of one's own", "", 1.0, 0.0, 0.0);
    return NT_OK;
}

/* What only simulated halves, or only a dynamic cantilever, would heed. */
static nt_status check_heeded(const nt_session_setup *setup, nt_problem *problem)
{
    const int has_own_slave = setup->slave.backend != NULL;
    if (!(setup->substep == 0.0 || (setup->substep > 0.0 && setup->substep <= 1e9)))
        return nt_problem_set(problem, "substep", "rad", setup->substep, 0.0, 1e9);
    if (setup->substep > 0.0 && (has_own_slave || setup->probe_model == NT_PROBE_QUASI_STATIC))
        return nt_problem_set(problem, "substep where no cantilever is simulated as dynamic", "rad", setup->substep,
                              0.0, 0.0);
    if (setup->mode == NT_MODE_TAPPING && !has_own_slave) {
        const nt_sim_lock_in lock_in = nt_session_lock_in(&setup->settings.tap);
        nt_tapping lever;
        const nt_status status = nt_tapping_init(&lever, &setup->rig.probe, &lock_in.drive, 1e-9, problem);
        if (status != NT_OK)
            return status;
    }
    if (setup->probe_model != NT_PROBE_AUTO && has_own_slave)
        return nt_problem_set(problem, "probe_model with a slave of one's own", NT_PROBE_WORDS,
                              (double)setup->probe_model, NT_PROBE_AUTO, NT_PROBE_AUTO);
    return NT_OK;
}

/* The frame's declared drift brings the surface nearer while the preflight runs: the tip is still free at its end [m].
 */
static double least_clearance(const nt_session_setup *setup)
{
    const nt_preflight preflight = nt_preflight_make(&setup->rig, &setup->settings);
    return LEAST_CLEARANCE + (setup->preflight ? setup->rig.stage.drift * nt_preflight_time(&preflight) : 0.0);
}

/* Numbers that no other check sees; rig and settings have been checked. */
static nt_status check_numbers(const nt_session_setup *setup, nt_problem *problem)
{
    if (setup->settings.gains.delay > NT_SIM_DELAY_MAX)
        return nt_problem_set(problem, "gains.delay", "periods", setup->settings.gains.delay, 0.0, NT_SIM_DELAY_MAX);
    const double least = least_clearance(setup);
    if (!(setup->clearance >= least && setup->clearance <= 1e-3))
        return nt_problem_set(problem, "clearance", "m", setup->clearance, least, 1e-3);
    if (setup->ring_capacity < 0 || setup->ring_capacity == 1 || setup->ring_capacity > 1L << 26)
        return nt_problem_set(problem, "ring_capacity", "", (double)setup->ring_capacity, 2.0, 67108864.0);
    const double climb = setup->settings.gains.alpha_p * 0.8 * setup->rig.master.travel;
    if (!isnan(setup->rise) && !(setup->rise >= 0.0 && setup->rise <= setup->clearance + climb))
        return nt_problem_set(problem, "rise", "m", setup->rise, 0.0, setup->clearance + climb);
    if (!(setup->minimum_margin >= 0.0))
        return nt_problem_set(problem, "minimum_margin", "", setup->minimum_margin, 0.0, INFINITY);
    return check_start(setup, problem);
}

nt_status nt_session_check_setup(const nt_session_setup *setup, nt_problem *problem)
{
    nt_status status = check_choices(setup, problem);
    if (status == NT_OK)
        status = nt_rig_check(&setup->rig, problem);
    if (status == NT_OK)
        status = nt_settings_check(&setup->settings, problem);
    if (status == NT_OK)
        status = check_heeded(setup, problem);
    if (status == NT_OK)
        status = check_faults(setup, problem);
    return status == NT_OK ? check_numbers(setup, problem) : status;
}
