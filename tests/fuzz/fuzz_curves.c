/* SPDX-License-Identifier: BSD-3-Clause
 * Any force curve, any choice of a baseline: refused, or what is read lies within the curve, and nothing is infinite.
 */
#include "input.h"
#include "nanotouch/curves.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { POINTS = 256 };
static double z[2][POINTS], force[2][POINTS];
static nt_curve_reading reading;

/* A contact, an adhesion that is torn off, noise, and some points that are anything. */
static nt_curve_segment segment_of(fuzz_input *in, int number)
{
    uint8_t count, odd;
    fuzz_take(in, &count, sizeof count);
    fuzz_take(in, &odd, sizeof odd);
    const double span = fuzz_double(in, 1e-9, 1e-5), stiffness = fuzz_double(in, 1e-4, 100.0);
    const double dip = fuzz_double(in, 1e-12, 1e-8), noise = fuzz_double(in, 1e-13, 1e-9);
    uint32_t random = 1;
    for (int i = 0; i < count; ++i) {
        const double place = number == 0 ? count - 1.0 - i : i, at = span * (place / count - 0.3);
        random = random * 1664525u + 1013904223u;
        z[number][i] = at;
        force[number][i] = at < 0.0 ? -stiffness * at : at < 0.2 * span && number == 1 ? -dip : 0.0;
        force[number][i] += noise * (random / 4294967296.0 - 0.5);
    }
    for (int i = 0; i < odd % 8 && count > 0; ++i) {
        uint8_t place;
        fuzz_take(in, &place, sizeof place);
        (place & 1 ? z : force)[number][place % count] = fuzz_double(in, -1e-6, 1e-6);
    }
    return (nt_curve_segment){z[number], force[number], count};
}

static void check_measured(const nt_curve_measured *found)
{
    REQUIRE(!isinf(found->value) && !isinf(found->sigma) && !(found->sigma < 0.0));
}

static void check(const nt_curve_branch *branch)
{
    if (branch->count == 0)
        return;
    REQUIRE(branch->count <= POINTS && branch->lowest >= 0 && branch->lowest < branch->count);
    REQUIRE(branch->torn >= -1 && branch->torn < branch->count);
    REQUIRE(branch->repulsive >= 0 && branch->repulsive <= branch->count);
    REQUIRE(branch->noise >= 0.0 && isfinite(branch->noise) && isfinite(branch->visible));
    check_measured(&branch->dip);
    check_measured(&branch->adhesion_work);
    check_measured(&branch->contact_slope);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t kind;
    fuzz_take(&in, &kind, sizeof kind);
    nt_curve curve = {.spring_constant = kind & 0x80 ? (double)NAN : fuzz_double(&in, 1e-3, 100.0)};
    curve.approach = segment_of(&in, 0);
    curve.retract = segment_of(&in, 1);
    if (kind & 0x40)
        curve.most_drag = fuzz_double(&in, 0.0, 1e-9);
    nt_curve_choice choice = {(nt_curve_baseline_kind)(kind % 8), 0.0, 0.0};
    choice.lowest = fuzz_double(&in, -1e-6, 1e-6);
    choice.highest = fuzz_double(&in, -1e-6, 1e-6);
    double *work = malloc((size_t)nt_curve_work_size(curve.approach.count + curve.retract.count) * sizeof *work);
    REQUIRE(work);
    if (nt_curve_read(&curve, &choice, work, &reading, NULL) == NT_OK) {
        check(&reading.approach);
        check(&reading.retract);
        check_measured(&reading.contact_point);
        REQUIRE(reading.ruptures >= 0 && reading.ruptures <= NT_CURVE_RUPTURES);
        REQUIRE(!(reading.pull_off_least > reading.pull_off_most));
    }
    free(work);
    return 0;
}
