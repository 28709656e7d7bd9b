/* SPDX-License-Identifier: BSD-3-Clause */
#include "nanotouch/testing.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "nanotouch/control.h"

#define ROUNDING 1e-6 /* of a time: what a record's own may have lost */

static const char *const states[] = {"RUN", "HOLD", "RETRACT", "LATCHED"};

static const char *state_of(uint32_t state)
{
    return state <= NT_LATCHED ? states[state] : "an unknown state";
}

static nt_status refused(nt_finding *finding, const char *text)
{
    snprintf(finding->text, sizeof finding->text, "%s", text);
    return NT_E_RANGE;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static nt_status found(nt_finding *finding, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->text, sizeof finding->text, format, arguments);
    va_end(arguments);
    return NT_E_STATE;
}

static int begin(const nt_record *records, long count, nt_finding *finding)
{
    if (finding)
        finding->text[0] = '\0';
    return records && finding && count > 0;
}

/* "HOLD at 0.05 s: force limit, stale sample" */
static void say_state(const nt_record *record, char *text, size_t size)
{
    int used = snprintf(text, size, "%s at %.6g s", state_of(record->state), record->time);
    const char *mark = ": ";
    for (uint32_t bit = 0; bit < 32; ++bit) {
        const char *name = nt_reason_name(1u << bit);
        if (!(record->reasons >> bit & 1u) || !name[0] || used < 0 || (size_t)used >= size)
            continue;
        used += snprintf(text + used, size - (size_t)used, "%s%s", mark, name);
        mark = ", ";
    }
}

nt_status nt_testing_runs(const nt_record *records, long count, nt_finding *finding)
{
    if (!begin(records, count, finding))
        return NT_E_ARGUMENT;
    long first = -1, ran = 0;
    for (long i = 0; i < count; ++i) {
        if (records[i].state == NT_RUN)
            ++ran;
        else if (first < 0)
            first = i;
    }
    if (first < 0)
        return NT_OK;
    char text[160];
    say_state(&records[first], text, sizeof text);
    return found(finding, "%s; it was in RUN in %ld of %ld periods and ended in %s", text, ran, count,
                 state_of(records[count - 1].state));
}

/* What the supervisor did from this record on. */
static void say_reaction(const nt_record *records, long count, long first, char *text, size_t size)
{
    if (records[first].state != NT_RUN) {
        snprintf(text, size, "it was in %s", state_of(records[first].state));
        return;
    }
    for (long i = first + 1; i < count; ++i) {
        if (records[i].state != NT_RUN) {
            snprintf(text, size, "%s came %ld tick%s later", state_of(records[i].state), i - first,
                     i - first == 1 ? "" : "s");
            return;
        }
    }
    snprintf(text, size, "nothing stopped it");
}

nt_status nt_testing_force_below(const nt_record *records, long count, double limit, nt_finding *finding)
{
    if (!begin(records, count, finding))
        return NT_E_ARGUMENT;
    if (!(limit > 0.0) || isinf(limit))
        return refused(finding, "limit: valid is a finite force above 0 N");
    long first = -1, worst = 0;
    for (long i = 0; i < count; ++i) {
        const double force = fabs(records[i].tip_force[2]);
        if (isnan(force))
            return found(finding, "tip force is not known at %.6g s", records[i].time);
        if (force > limit && first < 0)
            first = i;
        if (force > fabs(records[worst].tip_force[2]))
            worst = i;
    }
    if (first < 0)
        return NT_OK;
    char text[64];
    say_reaction(records, count, first, text, sizeof text);
    return found(finding, "tip force %.3g N exceeded %.3g N at %.6g s, and most at %.6g s; %s",
                 fabs(records[worst].tip_force[2]), limit, records[first].time, records[worst].time, text);
}

typedef struct moments {
    double event, periods; /* tick of the event, and how many later is in time */
} moments;

typedef enum verdict { EARLY, IN_TIME, LATE } verdict;

static verdict verdict_of(double tick, const moments *m)
{
    if (tick < m->event)
        return EARLY;
    return tick - m->event <= m->periods ? IN_TIME : LATE;
}

/* An event happens in the period that is nearest to its time. */
static moments moments_of(const nt_record *records, long count, const nt_reaction *wanted)
{
    const nt_record *first = &records[0], *last = &records[count - 1];
    const double ticks = (double)last->tick - (double)first->tick;
    const double period = ticks > 0.0 ? (last->time - first->time) / ticks : 1.0; /* of one record: any */
    return (moments){(double)first->tick + floor((wanted->after - first->time) / period + 0.5),
                     wanted->within / period * (1.0 + ROUNDING)};
}

/* What came at record i, the first that is in the state. */
static nt_status judge(const nt_record *records, long i, const moments *m, const nt_reaction *wanted,
                       nt_finding *finding)
{
    const verdict is = verdict_of((double)records[i].tick, m);
    const verdict since = i > 0 ? verdict_of((double)records[i - 1].tick + 1.0, m) : is;
    const char *state = state_of(wanted->state);
    char text[120];
    say_state(&records[i], text, sizeof text);
    if (is == EARLY)
        return found(finding, "%s, before %.6g s", text, wanted->after);
    if (since != is) { /* it may have come in any period since the record before */
        snprintf(finding->text, sizeof finding->text,
                 "no records between %.6g s and %.6g s: whether %s came %s %.6g s is not known; give every period",
                 records[i - 1].time, records[i].time, state, since == EARLY ? "before" : "in time after",
                 wanted->after);
        return NT_E_RANGE;
    }
    if (is == LATE)
        return found(finding, "no %s within %.3g s of %.6g s; %s", state, wanted->within, wanted->after, text);
    return NT_OK;
}

nt_status nt_testing_reacts(const nt_record *records, long count, const nt_reaction *wanted, nt_finding *finding)
{
    if (!begin(records, count, finding) || !wanted)
        return NT_E_ARGUMENT;
    if (wanted->state < NT_HOLD || wanted->state > NT_LATCHED)
        return refused(finding, "state: valid are HOLD, RETRACT and LATCHED");
    if (!(wanted->within > 0.0) || isinf(wanted->within))
        return refused(finding, "within: valid is a finite time above 0 s");
    if (!(wanted->after >= records[0].time && wanted->after <= records[count - 1].time))
        return refused(finding, "after: it must lie within the records");
    const moments m = moments_of(records, count, wanted);
    for (long i = 0; i < count; ++i) {
        if (i > 0 && records[i].tick <= records[i - 1].tick)
            return refused(finding, "tick: it must rise from record to record");
        if (records[i].state >= wanted->state && records[i].state <= NT_LATCHED) /* a number that is no state is none */
            return judge(records, i, &m, wanted, finding);
    }
    return found(finding, "no %s within %.3g s of %.6g s; it ended in %s", state_of(wanted->state), wanted->within,
                 wanted->after, state_of(records[count - 1].state));
}

/* The numbers of a record, by name. */
static const struct {
    const char *name, *unit;
    size_t offset;
    int count;
} numbers[] = {
#define ROW(field, unit, count) {#field, unit, offsetof(nt_record, field), count}
    ROW(time, "s", 1),
    ROW(master_position, "m", NT_AXES),
    ROW(operator_force, "N", NT_AXES),
    ROW(stage_position, "m", NT_AXES),
    ROW(stage_command, "m", NT_AXES),
    ROW(deflection, "m", NT_AXES),
    ROW(amplitude, "m", 1),
    ROW(lag, "rad", 1),
    ROW(slave_force, "N", 1),
    ROW(motor_force, "N", NT_AXES),
    ROW(gap, "m", 1),
    ROW(tip_force, "N", NT_AXES),
    ROW(contact_radius, "m", 1),
    ROW(surface_height, "m", 1),
    ROW(age, "s", 1),
    ROW(master_age, "s", 1),
    ROW(lateness, "s", 1),
#undef ROW
};

static double number_of(const nt_record *record, size_t offset, int axis)
{
    double value;
    memcpy(&value, (const char *)record + offset + (size_t)axis * sizeof value, sizeof value);
    return value;
}

static nt_status compared(const nt_record *record, const nt_record *expected, const nt_record *tolerance,
                          nt_finding *finding)
{
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; ++k) {
        for (int axis = 0; axis < numbers[k].count; ++axis) {
            const double a = number_of(record, numbers[k].offset, axis);
            const double b = number_of(expected, numbers[k].offset, axis);
            const double most = tolerance ? number_of(tolerance, numbers[k].offset, axis) : 0.0;
            if (a == b || (isnan(a) && isnan(b)) || fabs(a - b) <= most)
                continue;
            return found(finding, "%s%s at %.6g s: %.9g %s, expected %.9g %s", numbers[k].name,
                         numbers[k].count == 1 ? "" : (const char *const[]){" x", " y", " z"}[axis], expected->time, a,
                         numbers[k].unit, b, numbers[k].unit);
        }
    }
    if (record->tick != expected->tick || record->state != expected->state || record->reasons != expected->reasons ||
        record->flags != expected->flags || record->phase != expected->phase) {
        char text[160];
        say_state(record, text, sizeof text);
        return found(finding, "tick, state, reasons, flags or phase differ at %.6g s: %s, expected %s", expected->time,
                     text, state_of(expected->state));
    }
    return NT_OK;
}

nt_status nt_testing_same(const nt_record *records, const nt_record *expected, long count, const nt_record *tolerance,
                          nt_finding *finding)
{
    if (!begin(records, count, finding) || !expected)
        return NT_E_ARGUMENT;
    for (long i = 0; i < count; ++i) {
        const nt_status status = compared(&records[i], &expected[i], tolerance, finding);
        if (status)
            return status;
    }
    return NT_OK;
}
