/* SPDX-License-Identifier: BSD-3-Clause
 * The two halves of a session's rig: those that the setup names, or simulated ones. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "hal/sim/sim.h"
#include "session/state.h"

#define LOCK_IN_RANGE 4.0      /* over the free amplitude */
#define MOST_SUBSTEPS 100000.0 /* of a cantilever in a period; the session would hardly move on */

static int64_t session_now(const nt_host *host)
{
    const nt_session *session = host->context;
    return session->waits && session->clock ? session->clock() : session->time;
}

static void session_say(const nt_host *host, const char *text)
{
    const nt_session_setup *setup = &((const nt_session *)host->context)->now->setup;
    if (setup->say)
        setup->say(setup->say_context, text);
}

/* Room to press, and room to draw back: a margin, and what the surface rises above the clearance. */
static double master_start(const nt_composition *composition)
{
    const nt_session_setup *setup = &composition->setup;
    const double rise = isnan(setup->rise) ? composition->reach.rise : setup->rise;
    const double climb = fmax(0.0, rise - setup->clearance) / setup->settings.gains.alpha_p;
    return -0.4 * setup->rig.master.travel + climb;
}

nt_sim_lock_in nt_session_lock_in(const nt_tap *tap)
{
    return (nt_sim_lock_in){
        .drive = {tap->at ? NT_DRIVE_BASE : NT_DRIVE_TIP, tap->frequency, tap->free_amplitude},
        .time = tap->lock_in,
        .sensor = {tap->noise, tap->resolution, LOCK_IN_RANGE * tap->free_amplitude},
    };
}

static nt_sim_setup sim_setup_of(const nt_session *session)
{
    const nt_session_setup *setup = &session->now->setup;
    return (nt_sim_setup){.plan = nt_terrain_plan(session->now->terrain),
                          .rig = &setup->rig,
                          .period = session->now->touch.period,
                          .x = setup->x,
                          .y = setup->y,
                          .clearance = setup->clearance,
                          .master_position = master_start(session->now),
                          .seed = setup->seed,
                          .delay = setup->settings.gains.delay,
                          .probe_model = setup->probe_model,
                          .substep = setup->substep,
                          .faults = setup->faults,
                          .pushed = nt_composition_pushes(session->now) ? &session->now->pushed : NULL};
}

/* The one that the setup names, or a simulated one. */
static nt_status open_half(nt_session *session, nt_half half, nt_problem *problem)
{
    const nt_session_setup *setup = &session->now->setup;
    nt_sim_setup simulated = sim_setup_of(session);
    const nt_sim_lock_in lock_in = nt_session_lock_in(&setup->settings.tap);
    if (setup->mode == NT_MODE_TAPPING)
        simulated.lock_in = &lock_in;
    const int is_master = half == NT_HALF_MASTER;
    nt_hal_choice choice = is_master ? setup->master : setup->slave;
    nt_status status = NT_OK;
    session->simulates[half] = choice.backend == NULL;
    if (!choice.backend && is_master) {
        status = nt_sim_master_init(&session->sim.master, &simulated);
        choice = (nt_hal_choice){nt_sim_master_backend(), &session->sim.master};
    } else if (!choice.backend) {
        status = nt_sim_slave_init(&session->sim.slave, &simulated);
        if (status == NT_E_UNSUPPORTED)
            (void)nt_problem_set(problem,
                                 setup->mode == NT_MODE_TAPPING ? "tapping on a sample that keeps dents or relaxes"
                                                                : "a dynamic lever over a sample that relaxes",
                                 "no|yes", 1.0, 0.0, 0.0);
        choice = (nt_hal_choice){nt_sim_slave_backend(), &session->sim.slave};
    }
    nt_hal *hal = is_master ? &session->master : &session->slave;
    if (status == NT_OK)
        status = nt_hal_open(hal, half, &choice, &session->host, problem);
    hal->is_model = session->simulates[half];
    return status;
}

static int leads(const nt_hal *half)
{
    return (half->capabilities.can & NT_LEADS_CLOCK) != 0;
}

/* One at most, and once in every period of the loop. */
static nt_status find_leader(nt_session *session, nt_problem *problem)
{
    const double period = session->now->touch.period;
    if (leads(&session->master) && leads(&session->slave))
        return nt_problem_set(problem, "halves that lead the clock", "", 2.0, 0.0, 1.0);
    if (leads(&session->master) || leads(&session->slave))
        session->leader = leads(&session->master) ? &session->master : &session->slave;
    const double own = session->leader ? session->leader->capabilities.period : 0.0;
    if (own > 0.0 && fabs(own / period - 1.0) > 1e-3)
        return nt_problem_set(problem, "gains.rate (a half leads the clock)", "Hz", 1.0 / period, 1.0 / own, 1.0 / own);
    return NT_OK;
}

static nt_status check_substep(const nt_session *session, nt_problem *problem)
{
    const nt_sim_slave *slave = &session->sim.slave;
    if (!session->simulates[NT_HALF_SLAVE] || !slave->dynamic)
        return NT_OK;
    const nt_cantilever_model *model = &slave->cantilever_model;
    const double least = model->rate * model->period / MOST_SUBSTEPS;
    if (model->substep >= least)
        return NT_OK;
    return nt_problem_set(problem, "substep", "rad", model->substep, least, 1e9);
}

/* What the halves say of themselves against what the rig says of them: margins and stale limits count with the rig. */
static nt_status check_halves(const nt_session *session, nt_problem *problem)
{
    const nt_master *described = &session->now->setup.rig.master;
    const nt_capabilities *master = &session->master.capabilities, *slave = &session->slave.capabilities;
    const double period = session->now->touch.period, declared = described->rate > 0.0 ? 1.0 / described->rate : 0.0;
    if (master->period > 1.001 * fmax(declared, period))
        return nt_problem_set(problem, "master.rate (of the loop where it is 0)", "Hz", 1.0 / fmax(declared, period),
                              0.0, 1.0 / master->period);
    if (slave->period > 1.001 * period)
        return nt_problem_set(problem, "gains.rate", "Hz", 1.0 / period, 0.0, 1.0 / slave->period);
    if (session->now->setup.rig.stage.axes > 1.0 && slave->axes < 2)
        return nt_problem_set(problem, "stage.axes (this slave has fewer)", "", session->now->setup.rig.stage.axes, 1.0,
                              slave->axes);
    if (!(slave->can & NT_CAN_FEEL))
        return nt_problem_set(problem, "slave that measures its deflection", "no|yes", 0.0, 1.0, 1.0);
    if (described->gauge && !(master->can & NT_CAN_FEEL))
        return nt_problem_set(problem, "master.gauge (this master measures no force)", "no|yes", described->gauge, 0.0,
                              0.0);
    if (described->motor && !(master->can & NT_CAN_PUSH))
        return nt_problem_set(problem, "master.motor (this master has none)", "no|yes", described->motor, 0.0, 0.0);
    if (described->axes > master->axes)
        return nt_problem_set(problem, "master.axes (this master has fewer)", "", described->axes, 1.0, master->axes);
    return NT_OK;
}

/* A slave that taps, with what its drive reaches; one that is not driven through the hal is the instrument's own. */
static nt_status check_drive(const nt_session *session, nt_problem *problem)
{
    const nt_capabilities *slave = &session->slave.capabilities;
    const nt_touch *touch = &session->now->touch;
    if (session->now->setup.mode != NT_MODE_TAPPING)
        return NT_OK;
    if (!(slave->can & NT_CAN_TAP))
        return nt_problem_set(problem, "mode tapping (this slave has no lock-in amplifier)", "no|yes", 1.0, 0.0, 0.0);
    for (int i = 0; i < slave->rows; ++i) {
        const nt_channel_row *row = &slave->channels[i];
        const int is_frequency = strcmp(row->unit, "Hz") == 0;
        const double asked = is_frequency ? touch->drive_frequency : touch->drive_amplitude;
        if (row->driven && row->axis == NT_AXES && !(asked >= row->minimum && asked <= row->maximum))
            return nt_problem_set(problem, is_frequency ? "tap.frequency" : "tap.free_amplitude", row->unit, asked,
                                  row->minimum, row->maximum);
    }
    return NT_OK;
}

static const char *option_of(const char *option)
{
    return option ? option : "";
}

static nt_status configure(nt_session *session, nt_problem *problem)
{
    const nt_session_setup *setup = &session->now->setup;
    nt_configuration configuration = {.size = sizeof configuration,
                                      .period = session->now->touch.period,
                                      .lift = setup->settings.limits.retract_distance,
                                      .option = option_of(setup->master_option)};
    nt_status status = nt_hal_configure(&session->master, &configuration, problem);
    configuration.option = option_of(setup->slave_option);
    if (status == NT_OK)
        status = nt_hal_configure(&session->slave, &configuration, problem);
    if (status == NT_OK)
        status = nt_hal_arm(&session->slave);
    return status == NT_OK ? nt_hal_arm(&session->master) : status;
}

/* A real master is where it is; the stage follows from there. */
static nt_status find_master(nt_session *session, nt_problem *problem)
{
    nt_sample sample;
    const nt_status status = nt_session_sample(session, 0, &sample);
    if (status != NT_OK)
        return status;
    session->master_start = sample.master_position[NT_Z];
    if (isfinite(session->master_start))
        return NT_OK;
    const double end = 0.5 * session->now->setup.rig.master.travel;
    (void)nt_problem_set(problem, "the master's first reading along z", "m", session->master_start, -end, end);
    return NT_E_DEVICE;
}

nt_status nt_session_check_bound(const nt_session *session, const nt_composition *composition, nt_problem *problem)
{
    const nt_plan *plan = nt_terrain_plan(composition->terrain);
    if (!(session->slave.capabilities.can & NT_IS_REAL) || plan->history == NT_HISTORY_DENTS ||
        isfinite(plan->bound.force_error))
        return NT_OK;
    return nt_problem_refuse(problem, (nt_problem){.code = NT_PROBLEM_BOUND_OF_REAL_SLAVE});
}

nt_status nt_session_open_halves(nt_session *session, nt_problem *problem)
{
    session->host = (nt_host){sizeof session->host, NT_HAL_API_VERSION, session_now, session_say, session};
    nt_status status = open_half(session, NT_HALF_MASTER, problem);
    if (status == NT_OK)
        status = open_half(session, NT_HALF_SLAVE, problem);
    if (status == NT_OK)
        status = find_leader(session, problem);
    if (status == NT_OK)
        status = check_halves(session, problem);
    if (status == NT_OK)
        status = nt_session_check_bound(session, session->now, problem);
    if (status == NT_OK)
        status = check_drive(session, problem);
    if (status == NT_OK)
        status = check_substep(session, problem);
    if (status == NT_OK && (session->master.capabilities.can | session->slave.capabilities.can) & NT_IS_REAL)
        session->clock = nt_clock_now;
    if (status == NT_OK)
        status = configure(session, problem);
    session->master_start = session->sim.master.arm[NT_Z].position;
    if (status == NT_OK && !session->simulates[NT_HALF_MASTER])
        status = find_master(session, problem);
    return status;
}

double nt_session_own_period(const nt_session *session)
{
    const nt_hal *const halves[] = {&session->master, &session->slave};
    double shortest = INFINITY;
    for (int half = NT_HALF_MASTER; half <= NT_HALF_SLAVE; ++half) {
        const double own = halves[half]->capabilities.period;
        if (!session->simulates[half] && own > 0.0)
            shortest = fmin(shortest, own);
    }
    return shortest;
}
