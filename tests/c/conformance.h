/* SPDX-License-Identifier: BSD-3-Clause
 * What every backend has to keep, as one function that runs on any of them. It calls the backend as it is, without what
 * hal.c makes good, and returns the first rule that is broken, or NULL. */
#ifndef TESTS_CONFORMANCE_H
#define TESTS_CONFORMANCE_H

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "nanotouch/hal.h"

enum { SILENT_PERIODS = 12 };

/* A backend, and what a test can do to its device; what it cannot do is NULL, and that rule is left out. */
typedef struct conformance {
    nt_half half;
    nt_hal_choice choice;
    const nt_host *host;
    nt_configuration configuration;
    long periods; /* of the rehearsal */
    void (*pass)(const nt_host *host, double period);
    void *device;
    void (*silence)(void *device, int on); /* nothing good comes from it, or again */
    void (*lose)(void *device);            /* it is pulled out, for good */
    double (*left_at)(void *device);       /* what its z output stands at, in the units of the contract */
    double slack;                          /* of left_at: a step of its converter */
} conformance;

static inline const char *broken_rule(const char *rule)
{
    return rule;
}

static inline const char *conform_rehearsal(const conformance *c)
{
    static char text[160];
    const nt_rehearsal rehearsal = {.half = c->half,
                                    .choice = c->choice,
                                    .host = c->host,
                                    .configuration = c->configuration,
                                    .periods = c->periods,
                                    .pass = c->pass};
    nt_problem problem = {0};
    if (nt_hal_rehearse(&rehearsal, NULL, &problem) == NT_OK)
        return NULL;
    (void)snprintf(text, sizeof text, "rehearsal: %s = %g", problem.field, problem.value);
    return text;
}

/* Opened, configured and armed; the first reading is there. */
static inline const char *conform_start(const conformance *c, nt_hal *hal, nt_reading *reading)
{
    *reading = (nt_reading){.size = sizeof *reading, .position = {NAN, NAN, NAN}, .felt = {NAN, NAN, NAN}};
    nt_problem problem = {0};
    if (nt_hal_open(hal, c->half, &c->choice, c->host, &problem) != NT_OK)
        return broken_rule("it can be opened again");
    if (nt_hal_configure(hal, &c->configuration, &problem) != NT_OK || nt_hal_arm(hal) != NT_OK) {
        nt_hal_close(hal);
        return broken_rule("it can be armed again");
    }
    if (hal->backend->read(hal->context, reading) != NT_OK || !(reading->valid >> NT_Z & 1u)) {
        nt_hal_close(hal);
        return broken_rule("the first reading after arm has a position along z");
    }
    return NULL;
}

/* One period in which all is well. */
static inline const char *conform_period(const conformance *c, const nt_hal *hal, nt_reading *reading)
{
    c->pass(c->host, c->configuration.period);
    return hal->backend->read(hal->context, reading) == NT_OK ? NULL : broken_rule("a read succeeds");
}

static inline nt_status conform_stay(const conformance *c, const nt_hal *hal, const nt_reading *reading, double z)
{
    nt_action action = {.size = sizeof action, .time = c->host->now(c->host)};
    for (int i = 0; i < NT_AXES && c->half == NT_HALF_SLAVE; ++i)
        action.target[i] = isfinite(reading->position[i]) ? reading->position[i] : 0.0;
    if (!isfinite(z) || c->half == NT_HALF_MASTER)
        action.target[NT_Z] = z;
    return hal->backend->write(hal->context, &action);
}

static inline const char *conform_unarmed(const conformance *c)
{
    nt_hal hal;
    if (!c->left_at)
        return NULL;
    const double before = c->left_at(c->device);
    if (nt_hal_open(&hal, c->half, &c->choice, c->host, NULL) != NT_OK)
        return broken_rule("it can be opened");
    if (nt_hal_configure(&hal, &c->configuration, NULL) != NT_OK)
        return broken_rule("it can be configured");
    nt_hal_close(&hal);
    const double after = c->left_at(c->device);
    return before == after || (isnan(before) && isnan(after)) ? NULL : broken_rule("nothing is driven before arm");
}

/* close alone, without disarm: it has to do what disarm does. */
static inline const char *conform_close(const conformance *c)
{
    nt_hal hal;
    nt_reading reading;
    const char *rule = conform_start(c, &hal, &reading);
    if (rule || !c->left_at)
        return rule ? rule : (nt_hal_close(&hal), NULL);
    const double push = c->half == NT_HALF_MASTER ? 1e-3 : 0.0;
    if (conform_stay(c, &hal, &reading, push) != NT_OK)
        rule = broken_rule("a write succeeds");
    const double stood = c->left_at(c->device);
    if (hal.backend->close)
        hal.backend->close(hal.context);
    else if (hal.backend->disarm) /* it has nothing to give back: hal.c lifts */
        hal.backend->disarm(hal.context);
    const double left = c->left_at(c->device);
    if (rule)
        return rule;
    if (c->half == NT_HALF_MASTER)
        return fabs(left) <= c->slack ? NULL : broken_rule("close leaves a motor at 0 N");
    return left <= stood - c->configuration.lift + c->slack ? NULL : broken_rule("close lifts");
}

static inline const char *conform_disarm(const conformance *c)
{
    nt_hal hal;
    nt_reading reading;
    const char *rule = conform_start(c, &hal, &reading);
    if (rule)
        return rule;
    if (hal.backend->disarm)
        hal.backend->disarm(hal.context);
    const double left = c->left_at ? c->left_at(c->device) : 0.0;
    if (hal.backend->close)
        hal.backend->close(hal.context);
    const double after = c->left_at ? c->left_at(c->device) : 0.0;
    return fabs(left - after) <= c->slack || isnan(left) ? NULL : broken_rule("close after disarm moves nothing more");
}

/* A target that is no number: it may fail, but must not move. */
static inline const char *conform_no_number(const conformance *c)
{
    nt_hal hal;
    nt_reading reading;
    const char *rule = conform_start(c, &hal, &reading);
    if (rule || !c->left_at)
        return rule ? rule : (nt_hal_close(&hal), NULL);
    const double stood = c->left_at(c->device);
    (void)conform_stay(c, &hal, &reading, (double)NAN);
    const double stands = c->left_at(c->device);
    nt_hal_close(&hal);
    return fabs(stands - stood) <= c->slack ? NULL : broken_rule("a target that is no number moves nothing");
}

static inline int is_held(const nt_reading *now, const nt_reading *before)
{
    return now->sequence == before->sequence && now->time == before->time && now->valid == before->valid &&
           (now->position[NT_Z] == before->position[NT_Z] || isnan(before->position[NT_Z]));
}

/* What a silent device may show: the last reading, growing old; or a flag, with no position; or a failure. */
static inline const char *conform_silent_periods(const conformance *c, const nt_hal *hal, nt_reading *last)
{
    for (int i = 0; i < SILENT_PERIODS; ++i) {
        nt_reading reading = *last;
        c->pass(c->host, c->configuration.period);
        if (hal->backend->read(hal->context, &reading) != NT_OK)
            continue;
        const int is_flagged =
            reading.flags & (NT_SAMPLE_INVALID | NT_SAMPLE_DEVICE_LOST) && !(reading.valid >> NT_Z & 1u);
        if (!is_flagged && !is_held(&reading, last))
            return broken_rule("a silent device gives nothing new");
        if (reading.sequence < last->sequence)
            return broken_rule("the sequence does not fall");
        (void)conform_stay(c, hal, last, 0.0);
        if (!is_flagged)
            *last = reading;
    }
    return NULL;
}

static inline const char *conform_silence(const conformance *c)
{
    nt_hal hal;
    nt_reading reading;
    if (!c->silence)
        return NULL;
    const char *rule = conform_start(c, &hal, &reading);
    if (rule)
        return rule;
    rule = conform_period(c, &hal, &reading);
    c->silence(c->device, 1);
    if (!rule)
        rule = conform_silent_periods(c, &hal, &reading);
    c->silence(c->device, 0);
    const double stood = c->left_at ? c->left_at(c->device) : 0.0;
    nt_hal_close(&hal);
    if (!rule && c->left_at && c->half == NT_HALF_SLAVE &&
        !(c->left_at(c->device) <= stood - c->configuration.lift + c->slack))
        rule = broken_rule("close lifts after a silence");
    return rule;
}

static inline const char *conform_loss(const conformance *c)
{
    nt_hal hal;
    nt_reading reading;
    if (!c->lose)
        return NULL;
    const char *rule = conform_start(c, &hal, &reading);
    if (rule)
        return rule;
    rule = conform_period(c, &hal, &reading);
    c->lose(c->device);
    int is_said = 0;
    for (int i = 0; i < SILENT_PERIODS && !rule; ++i) {
        nt_reading next = reading;
        c->pass(c->host, c->configuration.period);
        const nt_status status = hal.backend->read(hal.context, &next);
        is_said |= status != NT_OK || (next.flags & NT_SAMPLE_DEVICE_LOST) != 0;
        if (status == NT_OK && next.valid && !is_held(&next, &reading))
            rule = broken_rule("a lost device gives nothing new");
    }
    nt_hal_close(&hal);
    return rule ? rule : is_said ? NULL : broken_rule("a lost device says so");
}

enum { NEEDS_NOTHING = 0, NEEDS_PLACE = 1, NEEDS_SILENCE = 2, NEEDS_LOSS = 4 };

static inline int conform_has(const conformance *c)
{
    return (c->left_at ? NEEDS_PLACE : 0) | (c->silence ? NEEDS_SILENCE : 0) | (c->lose ? NEEDS_LOSS : 0);
}

/* All rules, in order, as a row of the table of `make conformance`: kept, broken, or - where a test cannot do to this
 * device what the rule needs. The first that is broken, or NULL. The device is lost at the end if it can be. */
static inline const char *conform(const char *name, const conformance *c)
{
    static const struct {
        const char *(*rule)(const conformance *);
        int needs;
    } rules[] = {{conform_rehearsal, NEEDS_NOTHING}, {conform_unarmed, NEEDS_PLACE},   {conform_close, NEEDS_PLACE},
                 {conform_disarm, NEEDS_PLACE},      {conform_no_number, NEEDS_PLACE}, {conform_silence, NEEDS_SILENCE},
                 {conform_loss, NEEDS_LOSS}};
    const char *broken = NULL;
    (void)printf("| %s", name);
    for (size_t i = 0; i < sizeof rules / sizeof *rules && !broken; ++i) {
        const int can = (rules[i].needs & ~conform_has(c)) == 0;
        broken = can ? rules[i].rule(c) : NULL;
        (void)printf(" | %s", broken ? "broken" : can ? "kept" : "-");
    }
    (void)printf(" |\n");
    return broken;
}

#endif
