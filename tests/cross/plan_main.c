/* SPDX-License-Identifier: BSD-3-Clause
 * apps/mcu/plan.h beside the plan that it was made from, on both histories: within what it says of itself, in double
 * precision computed here; and the same forces on every machine (same_bits.py). */
#include "../../apps/mcu/plan.h"

#include "../c/larger.h"
#include "nanotouch/interaction.h"
#include "tell.h"

enum { GAPS = 3000 };

static nt_plan plan;
static uint64_t sum = 0xcbf29ce484222325u;
static double largest; /* error over what is allowed [-] */
static long compared;

static void add_to_sum(float force)
{
    union {
        float number;
        uint8_t bytes[sizeof(float)];
    } as = {force};
    for (unsigned i = 0; i < sizeof as.bytes; ++i) /* FNV-1a */
        sum = (sum ^ as.bytes[i]) * 0x100000001b3u;
}

static double away(double gap, double from)
{
    return gap > from ? gap - from : from - gap;
}

static void compare_at(float gap, int attached)
{
    const double h = (double)gap, bound = (double)plan_force.bound, clear = (double)plan_force.fold_distance;
    const nt_interaction_state contact = {.attached = attached};
    const float found = ntf_force_table_eval(&plan_force, &attached, gap).force;
    add_to_sum(found);
    if (away(h, 0.0) < clear || away(h, plan.capture_gap) < clear || away(h, plan.release_gap) < clear)
        return;
    const double force = nt_interaction_eval_gap(&plan, &contact, NULL, h).F;
    const double size = larger(away(force, 0.0), (double)plan_force.scale);
    const double error = away((double)found, force) / size / bound;
    largest = larger(largest, error);
    ++compared;
}

int main(void)
{
    const nt_scene scene = nt_scene_defaults(); /* scene.toml names nothing of it */
    const nt_plan_inputs inputs = {.scene = &scene};
    if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
        return 1;
    const double deepest = -plan.largest_indentation, span = 20e-9 - deepest;
    for (int i = 0; i <= GAPS; ++i) {
        const double share = (double)i / GAPS;
        compare_at((float)(deepest + span * share * share * share), i & 1); /* most of them in contact */
    }
    tell("forces compared ", (uint64_t)compared, 10);
    tell("bound of the table [1e-9] ", (uint64_t)(1e9 * (double)plan_force.bound), 10);
    tell("largest error of it [%] ", (uint64_t)(100.0 * largest), 10);
    tell("forces ", sum, 16);
    return compared > GAPS / 2 && largest <= 1.0 ? 0 : 2;
}
