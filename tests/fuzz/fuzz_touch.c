/* SPDX-License-Identifier: BSD-3-Clause
 * Any rig, any settings, any samples: a touch is refused, or each of its commands is finite and within its limits, and
 * no stop is left by itself. */
#include "input.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Some fields are changed, the rest stay as they are by default. */
static void change(fuzz_input *in, const nt_field *fields, int count, void *object)
{
    uint8_t changes, which;
    fuzz_take(in, &changes, sizeof changes);
    for (int i = 0; i < changes % 8; ++i) {
        fuzz_take(in, &which, sizeof which);
        const nt_field *field = &fields[which % count];
        const double value = fuzz_double(in, field->minimum, field->maximum);
        nt_field_set(field, object,
                     field->unit[0] && memchr(field->unit, '|', strlen(field->unit)) ? floor(value) : value);
    }
}

/* A number of the sample is anything, or its flags are. */
static void disturb(fuzz_input *in, nt_sample *sample)
{
    double *const numbers[] = {&sample->age,
                               &sample->master_age,
                               &sample->lateness,
                               &sample->amplitude,
                               &sample->lag,
                               &sample->master_position[NT_X],
                               &sample->master_position[NT_Y],
                               &sample->master_position[NT_Z],
                               &sample->operator_force[NT_Z],
                               &sample->stage_position[NT_X],
                               &sample->stage_position[NT_Y],
                               &sample->stage_position[NT_Z],
                               &sample->deflection[NT_X],
                               &sample->deflection[NT_Y],
                               &sample->deflection[NT_Z]};
    static const double ranges[] = {1e-3, 1e-3, 1e-3, 1e-7, 3.0,  0.1,  0.1, 0.1,
                                    5.0,  1e-5, 1e-5, 1e-5, 1e-7, 1e-7, 1e-7};
    uint8_t which, flags;
    fuzz_take(in, &which, sizeof which);
    const size_t count = sizeof numbers / sizeof *numbers;
    if (which % 16 < count) {
        *numbers[which % 16] = fuzz_double(in, which % 16 < 3 ? 0.0 : -ranges[which % 16], ranges[which % 16]);
        return;
    }
    fuzz_take(in, &flags, sizeof flags);
    sample->flags = flags;
}

/* What a person may ask between two samples. */
static void ask(fuzz_input *in, const nt_touch *touch, nt_touch_state *state)
{
    uint8_t what;
    fuzz_take(in, &what, sizeof what);
    const double first = fuzz_double(in, -1e-5, 1e-5), second = fuzz_double(in, -1e-5, 1e-5);
    const nt_scaling scaling = {fabs(first), fabs(second) * 1e10};
    switch (what % 5) {
    case 0:
        (void)nt_touch_arm(state, what & 0x80);
        break;
    case 1:
        (void)nt_touch_set_mode(state, (nt_mode)(what >> 4));
        break;
    case 2:
        (void)nt_touch_rescale(state, &scaling);
        break;
    case 3:
        nt_touch_clutch(state, what & 0x80);
        break;
    default:
        (void)nt_touch_aim(touch, state, first, second, fuzz_double(in, 0.0, 1.0));
    }
}

static void check(const nt_touch *touch, const nt_command *command)
{
    const double most = touch->settings.limits.motor_force * (1.0 + 1e-12);
    for (int i = 0; i < NT_AXES; ++i) {
        REQUIRE(fabs(command->motor_force[i]) <= most); /* NaN is not */
        REQUIRE(isfinite(command->stage_position[i]));
    }
    REQUIRE(fabs(command->stage_position[NT_Z]) <= 0.5 * touch->rig.stage.travel);
    REQUIRE(command->state <= NT_LATCHED && (command->state == NT_RUN || command->reasons != 0));
}

static void run(fuzz_input *in, const nt_touch *touch)
{
    nt_touch_state state = nt_touch_start(touch, 0.0, 0.0, 0.0);
    nt_sample sample = {.amplitude = touch->drive_amplitude, .lag = 1.5707963267948966};
    uint32_t before = NT_RUN;
    while (in->size > 0) {
        uint8_t what;
        fuzz_take(in, &what, sizeof what);
        nt_command command = {0};
        if (what % 4 == 3) {
            ask(in, touch, &state);
            before = (uint32_t)state.supervisor.state;
        }
        for (int i = 0; i < what % 4; ++i)
            disturb(in, &sample);
        for (int i = 0; i <= what >> 4; ++i) {
            nt_touch_step(touch, &state, &sample, &command);
            check(touch, &command);
            REQUIRE(before < NT_RETRACT || command.state >= before);
            before = command.state;
            if (what & 4) /* it goes where it is sent */
                memcpy(sample.stage_position, command.stage_position, sizeof sample.stage_position);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t mode;
    int count;
    fuzz_take(&in, &mode, sizeof mode);
    nt_rig rig = nt_rig_defaults();
    const nt_field *fields = nt_rig_fields(&count);
    change(&in, fields, count, &rig);
    nt_settings settings = nt_settings_defaults(&rig);
    fields = nt_settings_fields(&count);
    change(&in, fields, count, &settings);
    static nt_touch touch;
    if (nt_touch_make(&touch, &rig, &settings, (nt_mode)(mode % 8), NULL) == NT_OK)
        run(&in, &touch);
    return 0;
}
