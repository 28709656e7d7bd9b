/* SPDX-License-Identifier: BSD-3-Clause
 * Any law of a gap, any parameters, any gap: refused by its check, or finite within a metre; attraction only attracts,
 * brushes only repel, nothing comes from NaN but NaN. */
#include "input.h"
#include "nanotouch/forces.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 6 }; /* parameters of a law */

typedef struct law_case {
    nt_status (*check)(const void *parameters);
    nt_law_value (*eval)(const void *parameters, double gap);
    int sign; /* of the force; 0: both */
    int count;
    double range[MOST][2]; /* of its parameters, in the order of the struct */
} law_case;

#define LAW(type, eval)                                                                                                \
    static nt_status eval##_checked(const void *parameters)                                                            \
    {                                                                                                                  \
        return type##_check((const type *)parameters, NULL);                                                           \
    }                                                                                                                  \
    static nt_law_value eval##_at(const void *parameters, double gap)                                                  \
    {                                                                                                                  \
        return eval((const type *)parameters, gap);                                                                    \
    }
#define BOTH(eval) eval##_checked, eval##_at

LAW(nt_vdw, nt_vdw_eval)
LAW(nt_vdw, nt_vdw_derjaguin_eval)
LAW(nt_vdw_tip, nt_vdw_tip_eval)
LAW(nt_capillary, nt_capillary_eval)
LAW(nt_electrostatic, nt_electrostatic_eval)
LAW(nt_electrostatic_plate, nt_electrostatic_plate_eval)
LAW(nt_electrostatic_tip, nt_electrostatic_tip_eval)
LAW(nt_electrostatic_lever, nt_electrostatic_lever_eval)
LAW(nt_lennard_jones, nt_lennard_jones_eval)
LAW(nt_double_layer, nt_double_layer_potential_eval)
LAW(nt_double_layer, nt_double_layer_charge_eval)
LAW(nt_hydration, nt_hydration_eval)
LAW(nt_steric, nt_steric_eval)
LAW(nt_steric, nt_steric_exponential_eval)

#define RADIUS {1e-10, 1.0}
#define FLOOR {1e-12, 1e-6}
#define VOLT {-1e4, 1e4}
#define LAYER RADIUS, {1e-11, 1e-4}, {1.0, 1e4}, {-1.0, 1.0}, {-1.0, 1.0}, FLOOR
#define BRUSH RADIUS, {1e-10, 1e-5}, {1e-10, 1e-6}, {1.0, 1e4}, FLOOR

static const law_case laws[] = {
    {BOTH(nt_vdw_eval), -1, 4, {RADIUS, {0.0, 1e-16}, {0.0, 1e-6}, FLOOR}},
    {BOTH(nt_vdw_derjaguin_eval), -1, 4, {RADIUS, {0.0, 1e-16}, {0.0, 1e-6}, FLOOR}},
    {BOTH(nt_vdw_tip_eval), -1, 6, {RADIUS, {0.0, 1e-16}, {0.0, 1.5}, {0.0, 1e-2}, {0.0, 1e-6}, FLOOR}},
    {BOTH(nt_capillary_eval), -1, 4, {RADIUS, {0.0, 10.0}, {1e-11, 1e-3}, {0.0, 1e-5}}},
    {BOTH(nt_electrostatic_eval), -1, 3, {RADIUS, VOLT, FLOOR}},
    {BOTH(nt_electrostatic_plate_eval), -1, 3, {{0.0, 1.0}, VOLT, FLOOR}},
    {BOTH(nt_electrostatic_tip_eval), -1, 5, {RADIUS, {0.01, 1.5}, {0.0, 1e-2}, VOLT, FLOOR}},
    {BOTH(nt_electrostatic_lever_eval), -1, 6, {{1e-7, 0.1}, {1e-7, 0.1}, {0.0, 1.5}, {1e-9, 1e-2}, VOLT, FLOOR}},
    {BOTH(nt_lennard_jones_eval), 0, 4, {RADIUS, {0.0, 1e3}, {1e-11, 1e-7}, {1e-12, 1e-7}}},
    {BOTH(nt_double_layer_potential_eval), 0, 6, {LAYER}},
    {BOTH(nt_double_layer_charge_eval), 0, 6, {LAYER}},
    {BOTH(nt_hydration_eval), 0, 6, {RADIUS, {-10.0, 10.0}, {1e-11, 1e-6}, {-10.0, 10.0}, {1e-11, 1e-6}, {0.0, 1e-6}}},
    {BOTH(nt_steric_eval), 1, 5, {BRUSH}},
    {BOTH(nt_steric_exponential_eval), 1, 5, {BRUSH}},
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t which;
    fuzz_take(&in, &which, sizeof which);
    const law_case *law = &laws[which % (sizeof laws / sizeof laws[0])];
    double parameters[MOST];
    for (int i = 0; i < law->count; i++)
        parameters[i] = fuzz_double(&in, law->range[i][0], law->range[i][1]);
    const double gap = which & 0x80 ? fuzz_double(&in, -1e-6, 1e-6) : fuzz_double(&in, 1e-12, 1.0);
    if (law->check(parameters) != NT_OK)
        return 0;
    const nt_law_value value = law->eval(parameters, gap);
    if (isnan(gap)) {
        REQUIRE(isnan(value.U) && isnan(value.F) && isnan(value.k));
    } else if (fabs(gap) <= 1.0) { /* a metre */
        REQUIRE(isfinite(value.U) && isfinite(value.F) && isfinite(value.k));
        REQUIRE(law->sign * value.F >= 0.0 && law->sign * value.U >= 0.0);
    }
    REQUIRE(value.a == 0.0);
    return 0;
}
