/* SPDX-License-Identifier: BSD-3-Clause
 * The drive of a lever, and the lever prepared with it: how strong the drive has to be for the free amplitude. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/same_bits.h"
#include "internal/field.h"
#include "nanotouch/advanced/tapping.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(struct described, path, __VA_ARGS__)
#define RATIO_MIN 0.1 /* farther from the resonance one mode of the lever is not what answers */
#define RATIO_MAX 3.0

/* For the dotted names. */
struct described {
    nt_drive drive;
};

static const nt_field drive_fields[] = {
    FIELD(drive.at, "tip|base", 0.0, 1.0, "where the lever is driven: by a force at its tip, or by shaking its base"),
    FIELD(drive.frequency, "Hz", 0.0, 1e9, "frequency f of the drive, 0 for the free resonance"),
    FIELD(drive.free_amplitude, "m", 1e-11, 1e-6, "amplitude A0 of the deflection, far from the surface"),
};

enum { DRIVE_FIELDS = (int)(sizeof drive_fields / sizeof drive_fields[0]) };

nt_drive nt_drive_defaults(void)
{
    return (nt_drive){.at = NT_DRIVE_BASE, .frequency = 0.0, .free_amplitude = 20e-9};
}

const nt_field *nt_drive_fields(int *count)
{
    if (count != NULL)
        *count = DRIVE_FIELDS;
    return drive_fields;
}

nt_status nt_drive_check(const nt_drive *drive, nt_problem *problem)
{
    return nt_field_check(drive_fields, DRIVE_FIELDS, drive, problem);
}

static nt_status check_lever(const nt_probe *probe, nt_problem *problem)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe = *probe;
    const nt_status status = nt_rig_check(&rig, problem);
    if (status != NT_OK)
        return status;
    if (probe->quality < NT_TAPPING_QUALITY_MIN)
        return nt_problem_set(problem, "probe.quality", "", probe->quality, NT_TAPPING_QUALITY_MIN, 1e7);
    return NT_OK;
}

/* Free, q = D/(1 - r^2 + i r/Q); the deflection is q, or q - D where the base is driven. */
static double answer(double ratio, double quality, int at_base)
{
    const double swing = hypotenuse(1.0 - ratio * ratio, ratio / quality);
    return (at_base ? ratio * hypotenuse(ratio, 1.0 / quality) : 1.0) / swing;
}

nt_status nt_tapping_init(nt_tapping *tapping, const nt_probe *probe, const nt_drive *drive, double tolerance,
                          nt_problem *problem)
{
    if (tapping == NULL || probe == NULL || drive == NULL)
        return NT_E_ARGUMENT;
    nt_status status = check_lever(probe, problem);
    if (status == NT_OK)
        status = nt_drive_check(drive, problem);
    if (status != NT_OK)
        return status;
    const double frequency = drive->frequency > 0.0 ? drive->frequency : probe->resonance;
    const double ratio = frequency / probe->resonance;
    if (!(ratio >= RATIO_MIN && ratio <= RATIO_MAX))
        return nt_problem_set(problem, "drive.frequency", "Hz", frequency, RATIO_MIN * probe->resonance,
                              RATIO_MAX * probe->resonance);
    if (!(tolerance >= 1e-13 && tolerance <= 1e-3))
        return nt_problem_set(problem, "tolerance", "", tolerance, 1e-13, 1e-3);
    const int at_base = drive->at == NT_DRIVE_BASE;
    *tapping = (nt_tapping){.spring_constant = probe->spring_constant,
                            .quality = probe->quality,
                            .rate = 2.0 * NT_PI * probe->resonance,
                            .ratio = ratio,
                            .strength = drive->free_amplitude / answer(ratio, probe->quality, at_base),
                            .cosine = cos(probe->tilt),
                            .viscosity = probe->contact_viscosity,
                            .free_amplitude = drive->free_amplitude,
                            .at_base = at_base,
                            .tolerance = tolerance};
    return NT_OK;
}

nt_tapping_state nt_tapping_free(const nt_tapping *tapping)
{
    const double r = tapping->ratio, real = 1.0 - r * r, imaginary = r / tapping->quality;
    const double square = real * real + imaginary * imaginary;
    /* q = D (real cos(w t) + imaginary sin(w t))/square */
    return (nt_tapping_state){.position = tapping->strength * real / square,
                              .speed = r * tapping->strength * imaginary / square};
}
