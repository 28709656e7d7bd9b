/* SPDX-License-Identifier: BSD-3-Clause
 * Does a backend keep the contract of hal_backend.h? Each rule is one line here and one in docs/hal.md. The backend is
 * called as it is, without what hal.c makes good. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "hal/reading.h"
#include "nanotouch/hal.h"

#define STALE_PERIODS 2.0 /* of the slower of loop and half: older is stale (supervisor.c) */
#define SAME_LEAST 50     /* readings of one number that say that a sensor has no noise, as NT_STUCK_SAMPLES does */
#define MOVE_ERROR 0.5    /* of a move: hysteresis and creep of a stage without a loop of its own take up to 0.4 */
#define MOVE_MAX 1e-4     /* [m], about what a piezo stage can */
#define ALL_FLAGS (2u * NT_SAMPLE_DEVICE_LOST - 1u)

typedef struct play {
    const nt_rehearsal *asked;
    nt_hal hal; /* opened by hal.c, which checks table and capabilities */
    nt_reading last;
    uint64_t new_readings; /* in this life */
    uint32_t changed;      /* channels that have shown more than one number in it */
    uint64_t tick;         /* of this life */
    const double *target;  /* of a slave [m]; NULL: where it reads */
    nt_rehearsed *seen;
    nt_problem *problem;
} play;

static nt_status broken(play *p, const char *rule, double value, double minimum, double maximum)
{
    const nt_status status = nt_problem_set(p->problem, rule, "", value, minimum, maximum);
    return status == NT_E_NOT_FINITE ? NT_E_RANGE : status;
}

/* An operation that fails says why, or at least which one it was. */
static nt_status named(play *p, nt_status status, const char *operation)
{
    if (status != NT_OK && p->problem && !p->problem->field)
        *p->problem = nt_problem_of(operation, "nt_status", (double)status, NT_OK, NT_OK);
    return status;
}

/* --- one reading --- */

/* A half that does not tap leaves amplitude and lag alone. */
static nt_status check_numbers(play *p, const nt_reading *reading)
{
    const nt_capabilities *has = &p->hal.capabilities;
    const uint32_t stray = reading->valid & ~nt_reading_may_hold(has->can, has->axes);
    nt_reading read = *reading;
    if (stray)
        return broken(p, "valid bits of what it cannot measure", stray, 0.0, 0.0);
    for (int i = 0; i < (has->can & NT_CAN_TAP ? NT_READS : NT_READS_AMPLITUDE); ++i) {
        const int is_valid = reading->valid >> i & 1u;
        const double value = *nt_reading_channel(&read, i);
        if (is_valid && !isfinite(value))
            return broken(p, "valid bits of what is no number", i, -1.0, -1.0);
        if (!is_valid && !isnan(value))
            return broken(p, "numbers without a valid bit", i, -1.0, -1.0);
    }
    return NT_OK;
}

static nt_status check_time(play *p, const nt_reading *reading, int64_t now)
{
    const nt_reading *last = &p->last;
    const double age = 1e-9 * (double)(now - reading->time);
    if (reading->sequence < last->sequence)
        return broken(p, "steps of the sequence", -(double)(last->sequence - reading->sequence), 0.0, HUGE_VAL);
    if (age < 0.0)
        return broken(p, "age of a reading [s]", age, 0.0, HUGE_VAL);
    if (reading->sequence > last->sequence && last->sequence > 0 && reading->time < last->time)
        return broken(p, "time between two readings [s]", 1e-9 * (double)(reading->time - last->time), 0.0, HUGE_VAL);
    const double stale = STALE_PERIODS * fmax(p->asked->configuration.period, p->hal.capabilities.period);
    if (!(age <= stale))
        return broken(p, "age of a reading [s]", age, 0.0, stale);
    if (reading->valid && age > p->seen->oldest)
        p->seen->oldest = age;
    return NT_OK;
}

static nt_status check_reading(play *p, const nt_reading *reading)
{
    const int leads = (p->hal.capabilities.can & NT_LEADS_CLOCK) != 0;
    if (reading->size != sizeof *reading)
        return broken(p, "reading.size", reading->size, sizeof *reading, sizeof *reading);
    if (reading->flags & ~ALL_FLAGS)
        return broken(p, "unknown flags", reading->flags, 0.0, ALL_FLAGS);
    if (reading->flags & NT_SAMPLE_DEVICE_LOST && reading->valid)
        return broken(p, "valid bits of a lost device", reading->valid, 0.0, 0.0);
    if (!(reading->lateness >= 0.0) || (!leads && reading->lateness > 0.0))
        return broken(p, "reading.lateness", reading->lateness, 0.0, leads ? HUGE_VAL : 0.0);
    const nt_status status = check_numbers(p, reading);
    return status == NT_OK ? check_time(p, reading, p->asked->host->now(p->asked->host)) : status;
}

/* --- one period --- */

/* No force, and the stage where it reads or where it is sent. */
static nt_action action_of(const play *p)
{
    nt_action action = {.size = sizeof action, .tick = p->tick, .time = p->asked->host->now(p->asked->host)};
    const double *target = p->target ? p->target : p->last.position;
    for (int i = 0; i < NT_AXES && p->asked->half == NT_HALF_SLAVE; ++i)
        action.target[i] = isfinite(target[i]) ? target[i] : 0.0;
    return action;
}

/* Which channels have changed since the last reading. */
static void look_for_noise(play *p, const nt_reading *reading)
{
    nt_reading before = p->last, now = *reading;
    for (int i = 0; i < NT_READS && p->new_readings > 0; ++i)
        if (*nt_reading_channel(&before, i) != *nt_reading_channel(&now, i))
            p->changed |= 1u << i;
    ++p->new_readings;
}

static nt_status play_period(play *p)
{
    nt_reading reading = p->last;
    nt_status status = named(p, p->hal.backend->read(p->hal.context, &reading), "read");
    if (status == NT_OK && p->tick == 0 && !(reading.valid >> NT_Z & 1u))
        return broken(p, "valid first readings of the position along z", 0.0, 1.0, 1.0);
    if (status == NT_OK)
        status = check_reading(p, &reading);
    if (status != NT_OK)
        return status;
    if (p->tick == 0 || reading.sequence > p->last.sequence) {
        ++p->seen->readings;
        look_for_noise(p, &reading);
    }
    p->last = reading;
    const nt_action action = action_of(p);
    status = named(p, p->hal.backend->write(p->hal.context, &action), "write");
    p->asked->pass(p->asked->host, p->asked->configuration.period);
    ++p->tick;
    return status;
}

static nt_status play_still(play *p)
{
    nt_status status = NT_OK;
    for (long i = 0; i < p->asked->periods && status == NT_OK; ++i)
        status = play_period(p);
    const nt_capabilities *has = &p->hal.capabilities;
    if (p->new_readings >= SAME_LEAST) /* NaN differs from itself: what is not measured has "changed" */
        p->seen->same |= nt_reading_may_hold(has->can, has->axes) & ~p->changed;
    return status;
}

/* --- what moves, where the caller allows it --- */

static int is_in_range(const play *p, int axis, double target)
{
    const nt_capabilities *has = &p->hal.capabilities;
    for (int i = 0; i < has->rows; ++i) {
        const nt_channel_row *row = &has->channels[i];
        const int is_stage = row->driven && row->axis == axis && row->unit[0] == 'm';
        if (is_stage && !(target >= row->minimum && target <= row->maximum))
            return 0;
    }
    return 1;
}

/* Away from the sample along z, where the range of the stage allows it. */
static double way_of(const play *p, int axis)
{
    const double way = axis == NT_Z ? -p->asked->move : p->asked->move;
    return is_in_range(p, axis, p->target[axis] + way) ? way : -way;
}

/* Axis goes to `to` within half of the periods and stays there. mean: where each axis read in the last quarter. */
static nt_status play_leg(play *p, double target[NT_AXES], int axis, double to, double mean[NT_AXES])
{
    const long periods = p->asked->periods, judged = periods / 4 + 1;
    const double from = target[axis];
    nt_status status = NT_OK;
    mean[NT_X] = mean[NT_Y] = mean[NT_Z] = 0.0;
    for (long i = 1; i <= periods && status == NT_OK; ++i) {
        target[axis] = from + fmin(1.0, 2.0 * (double)i / (double)periods) * (to - from);
        status = play_period(p);
        for (int k = 0; k < NT_AXES && i > periods - judged; ++k)
            mean[k] += p->last.position[k] / (double)judged;
    }
    return status;
}

/* No axis may be far from where it was sent, nor may one that was not sent have gone along. */
static nt_status check_places(play *p, const double mean[NT_AXES])
{
    static const char *const names[] = {"error of x after a move, over the move",
                                        "error of y after a move, over the move",
                                        "error of z after a move, over the move"};
    for (int i = 0; i < NT_AXES; ++i) {
        const double error = (mean[i] - p->target[i]) / p->asked->move;
        if (fabs(error) > MOVE_ERROR)
            return broken(p, names[i], error, -MOVE_ERROR, MOVE_ERROR);
    }
    return NT_OK;
}

/* Each axis whose position is read goes out and comes back, one after the other. */
static nt_status play_moves(play *p)
{
    static const char *const names[] = {"room for a move along x [m]", "room for a move along y [m]",
                                        "room for a move along z [m]"};
    double target[NT_AXES], mean[NT_AXES];
    for (int i = 0; i < NT_AXES; ++i)
        target[i] = p->last.position[i];
    p->target = target;
    nt_status status = NT_OK;
    for (int i = 0; i < NT_AXES && status == NT_OK; ++i) {
        const double start = target[i], way = isfinite(start) ? way_of(p, i) : 0.0;
        if (!isfinite(start))
            continue;
        if (!is_in_range(p, i, start + way))
            return broken(p, names[i], 0.0, p->asked->move, HUGE_VAL);
        for (int leg = 0; leg < 2 && status == NT_OK; ++leg) {
            status = play_leg(p, target, i, leg ? start : start + way, mean);
            if (status == NT_OK)
                status = check_places(p, mean);
        }
        p->seen->moved |= status == NT_OK ? 1u << i : 0u;
    }
    return status;
}

/* --- a life --- */

static nt_status play_armed(play *p, int moves)
{
    nt_status status = nt_hal_configure(&p->hal, &p->asked->configuration, p->problem);
    if (named(p, status, "configure") == NT_OK)
        status = named(p, nt_hal_arm(&p->hal), "arm");
    if (status == NT_OK)
        status = play_still(p);
    if (status == NT_OK && moves)
        status = play_moves(p);
    nt_hal_disarm(&p->hal);
    return status;
}

/* Armed once or not at all; closed in any case. */
static nt_status play_life(play *p, int is_armed, int moves)
{
    p->new_readings = 0;
    p->changed = 0;
    p->tick = 0;
    p->target = NULL;
    p->last = (nt_reading){.size = sizeof p->last, .position = {NAN, NAN, NAN}, .felt = {NAN, NAN, NAN}};
    nt_status status = nt_hal_open(&p->hal, p->asked->half, &p->asked->choice, p->asked->host, p->problem);
    if (status != NT_OK)
        return named(p, status, "open");
    p->seen->capabilities = p->hal.capabilities;
    if (is_armed)
        status = play_armed(p, moves);
    nt_hal_close(&p->hal);
    return status;
}

nt_status nt_hal_rehearse(const nt_rehearsal *rehearsal, nt_rehearsed *seen, nt_problem *problem)
{
    if (!rehearsal || !rehearsal->choice.backend || !rehearsal->host || !rehearsal->host->now || !rehearsal->pass)
        return NT_E_ARGUMENT;
    if (rehearsal->periods < 1)
        return nt_problem_set(problem, "periods", "", (double)rehearsal->periods, 1.0, HUGE_VAL);
    const int moves = rehearsal->move != 0.0;
    if (moves && (!(rehearsal->move > 0.0 && rehearsal->move <= MOVE_MAX) || rehearsal->half == NT_HALF_MASTER))
        return nt_problem_set(problem, "move", "m", rehearsal->move, 0.0,
                              rehearsal->half == NT_HALF_MASTER ? 0.0 : MOVE_MAX);
    nt_rehearsed found = {.readings = 0};
    nt_problem wrong = {0};
    play p = {.asked = rehearsal, .seen = &found, .problem = &wrong};
    nt_status status = play_life(&p, 0, 0); /* opened and closed again */
    for (int i = 0; i < 2 && status == NT_OK; ++i)
        status = play_life(&p, 1, moves && i == 1);
    if (seen)
        *seen = found;
    if (status != NT_OK && problem)
        *problem = wrong;
    return status;
}
