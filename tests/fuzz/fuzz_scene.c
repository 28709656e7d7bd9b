/* SPDX-License-Identifier: BSD-3-Clause
 * Any scene, any path of the tip: a plan is refused, or it gives a finite force everywhere. */
#include <math.h>
#include <string.h>

#include "input.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Within the field's range, mostly; choices are whole numbers. */
static double any_value(fuzz_input *in, const nt_field *field)
{
    const double value = fuzz_double(in, field->minimum, field->maximum);
    return strchr(field->unit, '|') ? floor(value) : value;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    nt_scene scene = nt_scene_defaults();
    nt_demand demand = nt_demand_defaults();
    static nt_plan plan;
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    for (int i = 0; i < count; i++)
        nt_field_set(&fields[i], &scene, any_value(&in, &fields[i]));
    fields = nt_demand_fields(&count);
    for (int i = 0; i < count; i++)
        nt_field_set(&fields[i], &demand, any_value(&in, &fields[i]));

    const nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
    const nt_status checked = nt_scene_check(&scene, NULL);
    const nt_status made = nt_plan_make(&plan, &inputs, NULL);
    REQUIRE(checked == NT_OK || made != NT_OK);
    if (made != NT_OK)
        return 0;
    nt_interaction_state state = {0};
    while (in.size > 0) {
        const double gap = fuzz_double(&in, -1e-8, 1e-6);
        if (fabs(gap) > 1.0) /* a metre: powers may overflow beyond */
            continue;
        const nt_law_value value = nt_interaction_eval_gap(&plan, &state, NULL, gap);
        REQUIRE(isfinite(value.F) == isfinite(gap) && isfinite(value.k) == isfinite(gap));
        if (isfinite(gap))
            nt_interaction_advance_gap(&plan, &state, NULL, gap);
    }
    return 0;
}
