/* SPDX-License-Identifier: BSD-3-Clause
 * Converters behind IIO: libiio's own client, against a server that speaks iiod's protocol. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "conformance.h"
#include "host_fixture.h"
#include "iiod_model.h"
#include "nanotouch/advanced/hal_iio.h"

static iiod_model model;
static nt_iio iio;
static nt_converter_half half;
static char uri[40];

static nt_iio_device devices[2];

static nt_status open_both(char *reason)
{
    devices[0] = (nt_iio_device){"dac", {"voltage0"}, nt_chip_of_iio(20, 1, 1), {-10.0, 10.0}};
    devices[1] = (nt_iio_device){"iio:device1", {"voltage0", "voltage1"}, nt_chip_of_iio(16, 2, 0), {-10.0, 9.99969}};
    return nt_iio_open(&iio, uri, devices, 2, reason);
}

static int begin(void **state)
{
    (void)state;
    model = (iiod_model){.port = 0};
    clock_now = 0;
    const int is_there = iiod_start(&model);
    (void)snprintf(uri, sizeof uri, "ip:127.0.0.1:%d", model.port);
    return !is_there;
}

static int end(void **state)
{
    (void)state;
    nt_iio_close(&iio);
    nt_iio_close(&iio);
    iiod_stop(&model);
    return 0;
}

static void open_half(void)
{
    char reason[NT_IIO_REASON] = "";
    if (open_both(reason) != NT_OK)
        fail_msg("%s", reason);
    nt_converter_setup setup = {
        .half = NT_HALF_SLAVE, .axes = 1, .converters = 2, .exchange = nt_iio_exchange, .bus = &iio};
    for (int i = 0; i < 2; ++i)
        setup.converter[i] = (nt_converter){&iio.converter[i].chip, devices[i].span};
    setup.driven[NT_Z] =
        (nt_converter_channel){.is_used = 1, .gain = STAGE_GAIN, .minimum = -9.999e-6, .maximum = 9.999e-6};
    setup.position[NT_Z] = setup.driven[NT_Z];
    setup.position[NT_Z].converter = 1;
    setup.felt[NT_Z] = (nt_converter_channel){
        .is_used = 1, .converter = 1, .channel = 1, .gain = DEFLECTION_GAIN, .minimum = -0.329e-6, .maximum = 0.329e-6};
    nt_problem problem = {0};
    if (nt_converter_half_init(&half, &setup, &problem) != NT_OK)
        fail_msg("%s %g %g %g", problem.field, problem.value, problem.minimum, problem.maximum);
}

/* --- the rules of a half --- */

static bus_fault silence_is;

static void silence(void *device, int on)
{
    (void)device;
    atomic_store(&model.error, on && silence_is == BUS_REFUSED ? EIO : 0);
    model.bus.fault = on && silence_is != BUS_REFUSED ? silence_is : BUS_WELL;
}

static void lose(void *device)
{
    (void)device;
    atomic_store(&model.error, ENODEV);
}

static double left_at(void *device)
{
    (void)device;
    return simulated_travel(&model.bus);
}

static void the_half_conforms(void **state)
{
    (void)state;
    static const struct {
        bus_fault fault;
        const char *name;
    } silences[] = {{BUS_ALL_ONE, "IIO, a number that cannot be"}, {BUS_REFUSED, "IIO, refusing"}};
    for (int i = 0; i < 2; ++i) {
        model.bus.dac = 0x80000;
        open_half();
        const conformance c = {.half = NT_HALF_SLAVE,
                               .choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half},
                               .host = &host,
                               .configuration = {sizeof(nt_configuration), 0, 0.1, 1e-6, ""},
                               .periods = 30,
                               .pass = pass,
                               .silence = silence,
                               .lose = lose,
                               .left_at = left_at,
                               .slack = 2e-9};
        silence_is = silences[i].fault;
        const char *rule = conform(silences[i].name, &c);
        if (rule)
            fail_msg("%s: %s", silences[i].name, rule);
        atomic_store(&model.error, 0);
        nt_iio_close(&iio);
    }
}

/* --- numbers --- */

static void numbers_go_both_ways(void **state)
{
    (void)state;
    open_half();
    nt_hal hal;
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    const nt_configuration configuration = {sizeof configuration, 0, 0.1, 1e-6, ""};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_true(fabs(simulated_travel(&model.bus)) < 2e-11); /* where it stood */
    for (int i = -4; i <= 4; ++i) {
        nt_action action = {.size = sizeof action, .target = {NAN, NAN, 2e-6 * i}};
        action.target[0] = action.target[1] = 0.0;
        assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
        assert_true(fabs(simulated_travel(&model.bus) - 2e-6 * i) <= 0.51 * 20e-6 / 1048575.0 + 1e-11);
        pass(&host, 0.1);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_true(fabs(hal.reading.position[NT_Z] - 2e-6 * i) < 2.0 * 20e-6 / 65536.0 + 1e-11);
        assert_true(fabs(hal.reading.felt[NT_Z] - simulated_deflection(&model.bus)) < 2.0 * 0.66e-6 / 65536.0 ||
                    hal.reading.flags & NT_SAMPLE_SATURATED);
    }
    nt_hal_close(&hal);
    assert_true(fabs(simulated_travel(&model.bus) - 7e-6) < 2e-11); /* lifted by 1 um */
    assert_true(iio.read > 0 && iio.written > 0 && iio.refused == 0);
}

static void what_is_gone_is_told_from_what_failed(void **state)
{
    (void)state;
    uint8_t out[7] = {0}, in[7];
    const nt_transfer ask = {out, in, 7};
    open_half();
    assert_int_equal(nt_iio_exchange(&iio, 1, &ask, 1), NT_OK);
    static const struct {
        int error;
        nt_status status;
    } table[] = {{EIO, NT_E_STATE},     {EBUSY, NT_E_STATE},  {EINVAL, NT_E_STATE},  {ETIMEDOUT, NT_E_STATE},
                 {ENODEV, NT_E_DEVICE}, {ENXIO, NT_E_DEVICE}, {ENOENT, NT_E_DEVICE}, {ESHUTDOWN, NT_E_DEVICE}};
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        atomic_store(&model.error, table[i].error);
        assert_int_equal(nt_iio_exchange(&iio, 1, &ask, 1), table[i].status);
        assert_int_equal(iio.error, table[i].error);
    }
    atomic_store(&model.error, 0);
    assert_int_equal(nt_iio_exchange(&iio, 1, &ask, 1), NT_OK);
    const nt_transfer odd = {out, in, 6};
    assert_int_equal(nt_iio_exchange(&iio, 1, &odd, 1), NT_E_STATE);
    assert_int_equal(nt_iio_exchange(&iio, 2, &ask, 1), NT_E_DEVICE);
    atomic_store(&model.leaves, 1); /* the connection is lost */
    assert_int_equal(nt_iio_exchange(&iio, 1, &ask, 1), NT_E_DEVICE);
    nt_iio_close(&iio);
    assert_int_equal(nt_iio_exchange(&iio, 1, &ask, 1), NT_E_DEVICE);
}

/* --- open --- */

static void expect_refusal(const char *words)
{
    char reason[NT_IIO_REASON] = "";
    if (nt_iio_open(&iio, uri, devices, 2, reason) != NT_E_DEVICE || !strstr(reason, words))
        fail_msg("\"%s\" is not in \"%s\"", words, reason);
    assert_null(iio.context);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    char reason[NT_IIO_REASON] = "";
    if (open_both(reason) != NT_OK)
        fail_msg("%s", reason);
    nt_iio_close(&iio);
    devices[0].device = "dax";
    expect_refusal("there is no device dax");
    devices[0].device = "dac";
    devices[1].channels[1] = "voltage7";
    expect_refusal("iio:device1 has no input voltage7");
    devices[1].channels[1] = "temp0";
    expect_refusal("temp0 has no scale");
    devices[1].channels[1] = "voltage1";
    devices[1].span.high = 5.0;
    expect_refusal("steps of 0.000305");
    devices[1].span = (nt_chip_span){3.0, 22.99969};
    expect_refusal("begins at 0 V or at -10 V, low says 3 V");
    devices[1].span = (nt_chip_span){-10.0, 9.99969};
    model.scale[1] = 0.0;
    expect_refusal("has no scale");
    assert_int_equal(nt_iio_open(&iio, uri, devices, 0, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_iio_open(&iio, NULL, devices, 2, NULL), NT_E_ARGUMENT);
    devices[0].chip.name = NULL;
    assert_int_equal(nt_iio_open(&iio, uri, devices, 2, NULL), NT_E_ARGUMENT);
    assert_int_equal(open_both(NULL), NT_E_DEVICE);
    (void)snprintf(uri, sizeof uri, "xml:/nowhere.xml");
    assert_int_equal(open_both(reason), NT_E_DEVICE);
    assert_non_null(strstr(reason, "xml:/nowhere.xml"));
}

static void chips_that_there_cannot_be(void **state)
{
    (void)state;
    assert_null(nt_chip_of_iio(1, 1, 0).name);
    assert_null(nt_chip_of_iio(25, 1, 0).name);
    assert_null(nt_chip_of_iio(21, 1, 1).name);
    assert_null(nt_chip_of_iio(16, 0, 0).name);
    assert_null(nt_chip_of_iio(16, 6, 0).name);
    assert_null(nt_chip_of_iio(16, 5, 1).name);
    const nt_chip chip = nt_chip_of_iio(24, 5, 0);
    assert_int_equal(chip.answer.count, NT_CHIP_FRAME_SIZE);
}

static void a_device_without_a_buffer_has_no_scans(void **state)
{
    (void)state;
    double volts[4];
    open_half();
    assert_int_equal(nt_iio_scan(&iio, 0, NULL, volts, 2), NT_E_ARGUMENT);
    assert_int_equal(nt_iio_scan(&iio, 1, NULL, volts, 2), NT_E_ARGUMENT);
    assert_int_equal(nt_iio_scan(&iio, 1, NULL, volts, 0), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_half_conforms, begin, end),
        cmocka_unit_test_setup_teardown(numbers_go_both_ways, begin, end),
        cmocka_unit_test_setup_teardown(what_is_gone_is_told_from_what_failed, begin, end),
        cmocka_unit_test_setup_teardown(what_does_not_fit_is_refused, begin, end),
        cmocka_unit_test_setup_teardown(a_device_without_a_buffer_has_no_scans, begin, end),
        cmocka_unit_test(chips_that_there_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
