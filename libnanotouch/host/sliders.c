/* SPDX-License-Identifier: BSD-3-Clause
 * The sliders: which fields, under which names, and how far they go (host.h). */
#include <math.h>
#include <string.h>

#include "host/state.h"
#include "internal/host.h"

/* Where a slider ends, as factors of the value that it begins with; what is read only of one kind of adhesion. */
typedef struct row {
    nt_host_kind kind;
    const char *field, *title;
    double low, high;
    int given; /* nt_adhesion_given; -1: of any */
} row;
static const row rows[] = {
    {NT_HOST_SCENE, "medium.relative_humidity", "humidity", 0.0, 0.95, -1},
    {NT_HOST_SCENE, "sample.youngs_modulus", "sample modulus", 0.02, 20.0, -1},
    {NT_HOST_SCENE, "rheology.modulus", "modulus", 0.02, 20.0, -1},
    {NT_HOST_SCENE, "rheology.exponent", "exponent", 0.0, 0.6, -1},
    {NT_HOST_SCENE, "rheology.equilibrium_modulus", "modulus at rest", 0.1, 10.0, -1},
    {NT_HOST_SCENE, "rheology.arm_modulus_1", "what relaxes", 0.1, 10.0, -1},
    {NT_HOST_SCENE, "rheology.relaxation_time_1", "relaxation time", 0.1, 10.0, -1},
    {NT_HOST_SCENE, "adhesion.work_of_adhesion", "work of adhesion", 0.1, 4.0, NT_ADHESION_GIVEN_WORK},
    {NT_HOST_SCENE, "adhesion.sample_surface_energy", "surface energy", 0.1, 4.0, NT_ADHESION_GIVEN_ENERGIES},
    {NT_HOST_SCENE, "tip.radius", "tip radius", 0.5, 4.0, -1},
    {NT_HOST_RIG, "probe.spring_constant", "spring constant", 0.1, 10.0, -1},
    {NT_HOST_SETTINGS, "gains.coupling_stiffness", "virtual coupling", 0.1, 4.0, -1},
    {NT_HOST_SETTINGS, "gains.alpha_f", "force scaling", 0.1, 10.0, -1},
    {NT_HOST_SCENE, "medium.ionic_strength", "salt", 0.05, 20.0, -1},
    {NT_HOST_SCENE, "medium.brush_thickness", "brush", 0.3, 2.0, -1},
};
enum { ROWS = sizeof rows / sizeof *rows };

const char *nt_host_slider_field(int number, nt_host_kind *kind)
{
    if (number < 0 || number >= ROWS)
        return NULL;
    if (kind)
        *kind = rows[number].kind;
    return rows[number].field;
}

const nt_field *nt_host_fields(nt_host_kind kind, int *count)
{
    return kind == NT_HOST_SCENE ? nt_scene_fields(count)
           : kind == NT_HOST_RIG ? nt_rig_fields(count)
                                 : nt_settings_fields(count);
}

const nt_field *nt_host_field(const char *name, nt_host_kind *kind)
{
    for (int k = NT_HOST_SCENE; k <= NT_HOST_SETTINGS; ++k) {
        int count;
        const nt_field *fields = nt_host_fields((nt_host_kind)k, &count);
        for (int i = 0; i < count; ++i)
            if (strcmp(fields[i].name, name) == 0) {
                *kind = (nt_host_kind)k;
                return &fields[i];
            }
    }
    return NULL;
}

/* Moduli are those of the kernel that the sample has. */
static int is_of_kernel(const char *field, nt_rheology_kind kind)
{
    if (strcmp(field, "sample.youngs_modulus") == 0)
        return kind == NT_RHEOLOGY_ELASTIC;
    if (strncmp(field, "rheology.", 9) != 0)
        return 1;
    const int is_power = strcmp(field, "rheology.modulus") == 0 || strcmp(field, "rheology.exponent") == 0;
    return kind != NT_RHEOLOGY_ELASTIC && is_power == (kind == NT_RHEOLOGY_POWER_LAW);
}

/* Whether a row means something: what is 0 and no humidity stays away. */
static int is_offered(const row *of, const nt_scene *scene, double value)
{
    if (!is_of_kernel(of->field, scene->rheology.kind))
        return 0;
    if (strcmp(of->field, "medium.relative_humidity") == 0)
        return scene->medium.kind == NT_MEDIUM_AIR && scene->medium.surface_tension > 0.0;
    return value > 0.0 && (of->given < 0 || of->given == (int)scene->adhesion.given);
}

int nt_host_sliders(const nt_scene *scene, const nt_rig *rig, const nt_settings *settings,
                    nt_host_slider made[NT_HOST_SLIDERS])
{
    const void *const of[] = {scene, rig, settings};
    int count = 0;
    for (int i = 0; i < ROWS && count < NT_HOST_SLIDERS; ++i) {
        nt_host_kind kind = rows[i].kind;
        const nt_field *field = nt_host_field(rows[i].field, &kind);
        const double value = nt_field_get(field, of[kind]);
        if (!is_offered(&rows[i], scene, value))
            continue;
        const int is_share = rows[i].low == 0.0; /* its ends are those of the field's own */
        const double low = is_share ? 0.0 : fmax(rows[i].low * value, field->minimum);
        const double high = is_share ? rows[i].high : fmin(rows[i].high * value, field->maximum);
        made[count++] = (nt_host_slider){kind, field, rows[i].title, low, high, low > 0.0 && high / low >= 99.0};
    }
    return count;
}

const char *nt_host_slider_title(const char *field)
{
    for (int i = 0; i < ROWS; ++i)
        if (strcmp(rows[i].field, field) == 0)
            return rows[i].title;
    return NULL;
}

double nt_host_slider_at(const nt_host_slider *slider, double place)
{
    const double at = fmin(fmax(place, 0.0), 1.0), low = slider->low, high = slider->high;
    const double value = slider->logarithmic ? low * pow(high / low, at) : low + at * (high - low);
    const double scale = pow(10.0, 2.0 - floor(log10(fabs(value))));
    return value == 0.0 ? 0.0 : rint(value * scale) / scale;
}

double nt_host_slider_place(const nt_host_slider *slider, double value)
{
    const double low = slider->low, high = slider->high;
    const double place =
        slider->logarithmic ? log(fmax(value, low) / low) / log(high / low) : (value - low) / (high - low);
    return fmin(fmax(place, 0.0), 1.0);
}

const char *nt_host_digits(double value, const char *unit, int count, char *text, size_t size)
{
    nt_text words = nt_text_in(text, size);
    nt_text_digits(&words, value, unit, count);
    return text;
}

const char *nt_host_quantity(const nt_field *field, double value, char *text, size_t size)
{
    nt_text words = nt_text_in(text, size);
    if (strcmp(field->name, "medium.relative_humidity") == 0) {
        nt_text_fixed(&words, 100.0 * value, 0);
        nt_text_add(&words, " %");
    } else if (strcmp(field->unit, "N/N") == 0) {
        nt_text_general(&words, value / (value >= 1e9 ? 1e9 : 1e6), 3);
        nt_text_add(&words, value >= 1e9 ? " billion" : " million");
    } else {
        nt_text_digits(&words, value, field->unit, 3);
    }
    return text;
}
