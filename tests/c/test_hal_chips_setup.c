/* SPDX-License-Identifier: BSD-3-Clause
 * What a half on converters may not be; each refusal names its field. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "converter_rig.h"

static simulated_bus bus;
static nt_converter_half half;

static void refused(void (*spoil)(nt_converter_setup *), nt_status expected, const char *field)
{
    nt_converter_setup setup = slave_setup(&bus, 0);
    nt_problem problem = {0};
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_OK);
    spoil(&setup);
    assert_int_equal(nt_converter_half_init(&half, &setup, &problem), expected);
    assert_string_equal(problem.field ? problem.field : "", field);
}

static void no_chip(nt_converter_setup *s)
{
    s->converter[1].chip = NULL;
}
static void no_span(nt_converter_setup *s)
{
    s->converter[0].span.high = -10.0;
}
static void nan_span(nt_converter_setup *s)
{
    s->converter[0].span.low = NAN;
}
static void no_gain(nt_converter_setup *s)
{
    s->driven[NT_Z].gain = 0.0;
}
static void nan_gain(nt_converter_setup *s)
{
    s->felt[NT_Z].gain = NAN;
}
static void no_travel(nt_converter_setup *s)
{
    s->driven[NT_Z].is_used = 0;
}
static void no_position(nt_converter_setup *s)
{
    s->position[NT_Z].is_used = 0;
}
static void far(nt_converter_setup *s)
{
    s->driven[NT_Z].maximum = 11e-6;
}
static void low(nt_converter_setup *s)
{
    s->felt[NT_Z].minimum = -1.0;
}
static void ninth(nt_converter_setup *s)
{
    s->felt[NT_Z].channel = 8;
}
static void third(nt_converter_setup *s)
{
    s->felt[NT_Z].converter = 2;
}
static void swapped(nt_converter_setup *s)
{
    s->driven[NT_Z].converter = s->position[NT_Z].converter = 1;
}
static void sideways(nt_converter_setup *s)
{
    s->felt[NT_X] = s->felt[NT_Z];
}
static void unsure(nt_converter_setup *s)
{
    s->felt[NT_Z].uncertainty = NAN;
}
static void old(nt_converter_setup *s)
{
    s->felt[NT_Z].latency = -1.0;
}
static void coarse(nt_converter_setup *s)
{
    s->felt[NT_Z].gain *= 1e6;
}
static void loud(nt_converter_setup *s)
{
    s->felt[NT_Z].noise = 1.0;
}
static void lifted(nt_converter_setup *s)
{
    s->driven[NT_Z].maximum = 0.5 * s->driven[NT_Z].minimum;
}

static void a_setup_names_what_is_wrong(void **state)
{
    (void)state;
    refused(no_chip, NT_E_RANGE, "converter without a chip");
    refused(no_span, NT_E_RANGE, "converter.span.high");
    refused(nan_span, NT_E_NOT_FINITE, "converter.span.low");
    refused(no_gain, NT_E_RANGE, "channel.gain, which is not 0");
    refused(nan_gain, NT_E_NOT_FINITE, "channel.gain, which is not 0");
    refused(no_travel, NT_E_RANGE, "channels of a slave's travel and deflection along z");
    refused(no_position, NT_E_RANGE, "channels of the position along z");
    refused(far, NT_E_RANGE, "channel.maximum");
    refused(low, NT_E_RANGE, "channel.minimum");
    refused(ninth, NT_E_RANGE, "channel.channel");
    refused(third, NT_E_RANGE, "channel.converter");
    refused(swapped, NT_E_RANGE, "driven: channels of a DAC");
    refused(sideways, NT_E_RANGE, "channels of an axis that the half does not have");
    refused(unsure, NT_E_NOT_FINITE, "channel.uncertainty");
    refused(old, NT_E_RANGE, "channel.latency");
    refused(coarse, NT_E_RANGE, "channel.gain, with which the range has 16 steps");
    refused(loud, NT_E_RANGE, "channel.noise");
    refused(lifted, NT_E_RANGE, "channel.maximum of a travel that holds 0");
    assert_int_equal(nt_converter_half_init(&half, NULL, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_setup_names_what_is_wrong)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
