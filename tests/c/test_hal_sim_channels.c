/* SPDX-License-Identifier: BSD-3-Clause
 * What the simulated halves say of their channels is what they do: range, step, noise, latency, safe value. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/sim.h"

#define T 1e-4
static nt_plan plan;
static nt_sim_master master;
static nt_sim_slave slave;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

/* Far from the surface. */
static void begin(const nt_rig *rig, double delay)
{
    const nt_sim_setup setup = {.plan = &plan, .rig = rig, .period = T, .clearance = 50e-6, .seed = 3, .delay = delay};
    assert_int_equal(nt_sim_master_init(&master, &setup), NT_OK);
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
}

static nt_capabilities says(nt_half half)
{
    nt_capabilities found = {.size = sizeof found};
    const nt_backend *backend = half == NT_HALF_MASTER ? nt_sim_master_backend() : nt_sim_slave_backend();
    void *context = half == NT_HALF_MASTER ? (void *)&master : (void *)&slave;
    assert_int_equal(backend->describe(context, &found), NT_OK);
    return found;
}

static const nt_channel_row *row_of(const nt_capabilities *has, const char *name)
{
    for (int i = 0; i < has->rows; i++)
        if (strcmp(has->channels[i].name, name) == 0)
            return &has->channels[i];
    fail_msg("no channel %s", name);
    return NULL;
}

/* One period with these targets along z; what was read before. */
static void tick(double motor_force, double travel, nt_reading *hand, nt_reading *probe)
{
    nt_action action = {.size = sizeof action, .target = {[NT_Z] = motor_force}};
    assert_int_equal(nt_sim_master_read(&master, hand), NT_OK);
    assert_int_equal(nt_sim_slave_read(&slave, probe), NT_OK);
    assert_int_equal(nt_sim_master_write(&master, &action), NT_OK);
    action.target[NT_Z] = travel;
    assert_int_equal(nt_sim_slave_write(&slave, &action), NT_OK);
}

static nt_rig rough_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage.noise = 5e-9;
    rig.master.gauge_noise = 0.05;
    rig.converters.adc_bits = 16.0; /* coarser than the steps of some sensors */
    rig.converters.dac_bits = 10.0;
    return rig;
}

/* At rest: the standard deviation, and whole steps. */
static void noise_and_steps_are_what_is_read(void **state)
{
    (void)state;
    const nt_rig rig = rough_rig();
    begin(&rig, 0.0);
    enum { COUNT = 20000 };
    const nt_capabilities hand = says(NT_HALF_MASTER), probe = says(NT_HALF_SLAVE);
    const nt_channel_row *rows[] = {row_of(&probe, "position z"), row_of(&probe, "deflection"),
                                    row_of(&hand, "operator force z"), row_of(&hand, "position z")};
    double sums[4] = {0.0}, squares[4] = {0.0};
    for (int i = 0; i < COUNT; i++) {
        nt_reading h = {0}, p = {0};
        tick(0.0, 0.0, &h, &p);
        const double values[] = {p.position[NT_Z], p.felt[NT_Z], h.felt[NT_Z], h.position[NT_Z]};
        for (int k = 0; k < 4; k++) {
            sums[k] += values[k];
            squares[k] += values[k] * values[k];
            const double steps = values[k] / rows[k]->step;
            assert_true(fabs(steps - round(steps)) < 1e-6);
        }
    }
    for (int k = 0; k < 4; k++) {
        const double mean = sums[k] / COUNT, step = rows[k]->step;
        const double found = squares[k] / COUNT - mean * mean, own = rows[k]->noise * rows[k]->noise;
        const double expected = own > 0.0 ? own + step * step / 12.0 : 0.0; /* rounding is a noise of its own */
        assert_true(fabs(found - expected) <= 0.06 * expected);
    }
    assert_true(rows[0]->step == 2.0 * rows[0]->maximum / 65536.0);
    assert_true(rows[3]->maximum == 0.5 * rig.master.travel && rows[2]->maximum == rig.master.gauge_range);
    assert_true(rows[1]->maximum == rig.probe.sensitivity * rig.probe.range);
}

/* An arm at its end, and a hand that presses harder than its gauge can tell: no reading leaves the range. */
static void ranges_are_kept(void **state)
{
    (void)state;
    const nt_rig rig = rough_rig();
    begin(&rig, 0.0);
    const nt_capabilities hand = says(NT_HALF_MASTER);
    nt_sim_aim_hand(&master, &(nt_hand_target){.force = {[NT_Z] = 3.0 * rig.master.gauge_range}});
    nt_reading h = {0}, p = {0};
    for (int i = 0; i < 10000; i++)
        tick(0.0, 0.0, &h, &p);
    assert_true(h.position[NT_Z] == row_of(&hand, "position z")->maximum);
    assert_true(h.felt[NT_Z] == row_of(&hand, "operator force z")->maximum);
}

/* After a write nothing moves for the latency that is said, and then it does: both halves. */
static void latencies_are_what_passes(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.converters.dac_latency = 2.5 * T;
    rig.converters.adc_latency = 3.0 * T;
    rig.master.resolution = 0.0;
    rig.stage.resolution = 0.0;
    rig.stage.noise = 0.0;
    begin(&rig, 4.0);
    const nt_capabilities hand = says(NT_HALF_MASTER), probe = says(NT_HALF_SLAVE);
    const double effect = row_of(&hand, "motor force z")->latency, seen = row_of(&probe, "position z")->latency;
    assert_true(fabs(effect - 6.5 * T) < 1e-12 && row_of(&probe, "stage travel")->latency == effect);
    assert_true(seen == 3.0 * T && row_of(&hand, "position z")->latency == seen);
    const double first = ceil((effect + seen) / T); /* the tick in which it can be seen to have moved */
    for (int i = 0; i < 20; i++) {
        nt_reading h = {0}, p = {0};
        tick(1.0, -1e-6, &h, &p);
        assert_int_equal(h.position[NT_Z] != 0.0, i >= first);
        assert_int_equal(fabs(p.position[NT_Z]) > 1e-20, i >= first); /* the tip pulls at it a little */
    }
}

/* Neither more nor less than there is a row for; the rest is no number. */
static void valid_is_what_has_a_row(void **state)
{
    (void)state;
    for (int variant = 0; variant < 8; variant++) {
        nt_rig rig = nt_rig_defaults();
        rig.master.axes = variant & 1 ? 3.0 : 1.0;
        rig.master.gauge = (variant & 2) != 0;
        rig.master.motor = (variant & 4) != 0;
        begin(&rig, 0.0);
        nt_reading readings[2] = {{0}, {0}};
        tick(0.0, 0.0, &readings[NT_HALF_MASTER], &readings[NT_HALF_SLAVE]);
        for (int half = 0; half < 2; half++) {
            const nt_capabilities has = says((nt_half)half);
            uint32_t listed = 0;
            int driven = 0;
            for (int i = 0; i < has.rows; i++) {
                const nt_channel_row *row = &has.channels[i];
                const int is_felt = strstr(row->name, "position") == NULL;
                if (row->driven)
                    ++driven;
                else
                    listed |= 1u << (row->axis + (is_felt ? NT_READS_FELT : NT_READS_POSITION));
            }
            const nt_reading *reading = &readings[half];
            assert_int_equal(reading->valid, listed);
            for (int i = 0; i < NT_AXES; i++) {
                assert_int_equal(isfinite(reading->position[i]) != 0, listed >> (NT_READS_POSITION + i) & 1u);
                assert_int_equal(isfinite(reading->felt[i]) != 0, listed >> (NT_READS_FELT + i) & 1u);
            }
            const int motors = variant & 4 ? (variant & 1 ? 3 : 1) : 0;
            assert_int_equal(driven, half == NT_HALF_MASTER ? motors : 3);
        }
    }
}

/* Without a motor a command does nothing. */
static void a_master_without_a_motor_is_left_alone(void **state)
{
    (void)state;
    for (int motor = 0; motor < 2; motor++) {
        nt_rig rig = nt_rig_defaults();
        rig.master.motor = motor;
        begin(&rig, 0.0);
        nt_reading h = {0}, p = {0};
        for (int i = 0; i < 1000; i++)
            tick(1.0, 0.0, &h, &p);
        assert_int_equal(h.position[NT_Z] > 1e-4, motor);
    }
}

/* Disarmed: without a force, and drawn back to the safe value. */
static void disarm_leaves_the_safe_values(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    begin(&rig, 3.0);
    nt_reading h = {0}, p = {0};
    for (int i = 0; i < 100; i++)
        tick(2.0, 1e-6, &h, &p);
    nt_sim_master_backend()->disarm(&master);
    nt_sim_slave_backend()->disarm(&slave);
    const nt_capabilities hand = says(NT_HALF_MASTER), probe = says(NT_HALF_SLAVE);
    const nt_channel_row *motor = row_of(&hand, "motor force z"), *travel = row_of(&probe, "stage travel");
    assert_true(motor->safe == 0.0 && travel->safe == -0.5 * rig.stage.travel &&
                isnan(row_of(&probe, "stage x")->safe));
    for (int k = 0; k < NT_SIM_SLOTS; k++)
        assert_true(master.pending[k][NT_Z] == motor->safe && slave.pending[k][NT_Z] == travel->safe);
    tick(0.0, travel->safe, &h, &p);
    const double before = slave.stage_drive;
    tick(0.0, travel->safe, &h, &p);
    assert_true(slave.stage_drive < before); /* it lifts at once */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_and_steps_are_what_is_read),
        cmocka_unit_test(ranges_are_kept),
        cmocka_unit_test(latencies_are_what_passes),
        cmocka_unit_test(valid_is_what_has_a_row),
        cmocka_unit_test(a_master_without_a_motor_is_left_alone),
        cmocka_unit_test(disarm_leaves_the_safe_values),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
