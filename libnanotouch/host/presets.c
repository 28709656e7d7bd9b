/* SPDX-License-Identifier: BSD-3-Clause
 * The samples of a live session, in the order in which they are shown (host.h). */
#include "nanotouch/host.h"

static const nt_host_preset presets[] = {
    {"silicon_in_air", "Silicon in air", "silicon_in_air",
     "Touch it and pull off. Then set the humidity to 0, and do it again.", "", 0.01, NT_HOST_NOTHING},
    {"silicon_on_gold", "Silicon on gold", "silicon_on_gold", "Follow a terrace at a steady force and feel its edge.",
     "", 0.01, NT_HOST_NOTHING},
    {"mica_in_air", "Mica in dry air", "mica_in_air",
     "The soft lever jumps in before it touches: go down by single steps and watch its line meet the curve.", "", 0.03,
     NT_HOST_NOTHING},
    {"polyester", "Polyester", "polyester", "Press, then let go slowly: retraction is another curve than approach.", "",
     0.01, NT_HOST_NOTHING},
    {"silicone_rubber", "Silicone rubber", "silicone_rubber",
     "Press deep, then pull: the rubber stretches into a neck before it lets go.", "", 0.01, NT_HOST_NOTHING},
    {"polystyrene_ball", "Polystyrene ball on glass", "polystyrene_ball",
     "Press, then draw it sideways: it sticks, and then slips.", "", 0.01, NT_HOST_NOTHING},
    {"inas_dots", "Quantum dots", "inas_dots", "Find a dot with the lightest touch that you can hold.", "", 0.01,
     NT_HOST_NOTHING},
    {"grating", "Calibration grating", "silicon_in_air",
     "Draw the tip along x: the walls are felt before they are seen.", "", 0.01, NT_HOST_NOTHING},
    {"spikes", "Field of spikes", "silicon_in_air", "Go over a spike: what you feel is the shape of your own tip.", "",
     0.01, NT_HOST_NOTHING},
    {"dna", "DNA on mica", "mica_in_air", "Find the strand and follow it with the lightest touch.", "", 0.02,
     NT_HOST_NOTHING},
    {"rough", "Rough film", "silicon_in_air", "Pull off on a hill and in a hollow: the pull differs.", "", 0.01,
     NT_HOST_NOTHING},
    {"soft_gold", "Soft gold", "soft_gold",
     "Press hard, then let go: a dent stays. Press and draw the tip sideways: a groove. Z takes it back.",
     "It gives way for good: retraction is steeper than approach.", 0.01, NT_HOST_NOTHING},
    {"latex_on_glass", "Glass for latex balls", "latex_on_glass",
     "T: push a ball into its ring, or five into a pattern.",
     "Smooth and hard; a ball resists until it rolls, and clicks when the tip touches or loses it.", 0.01,
     NT_HOST_PARTICLES},
    {"wire_on_glass", "Glass for a nanowire", "wire_on_glass",
     "T: push a wire of zinc oxide into a place, and to an angle.",
     "Smooth and hard; a wire resists as it slides. Pushed near an end it turns, and resists less.", 0.01, NT_HOST_ROD},
    {"cell_in_liquid", "A living cell", "cell_in_liquid",
     "Nothing snaps: feel the brush first, then the cell. Press on the nucleus, then on the rim.", "", 0.01,
     NT_HOST_NOTHING},
    {"chondrocyte", "A cell that relaxes", "chondrocyte",
     "Press quickly and hold: the force falls under your hand. Then lift: the dent comes back late.", "", 0.01,
     NT_HOST_NOTHING},
    {"polymer_gel", "A polymer gel", "polymer_gel",
     "Press fast, then slowly, to the same depth: the gel is stiffer for the fast hand.", "", 0.01, NT_HOST_NOTHING},
};

const nt_host_preset *nt_host_presets(int *count)
{
    if (count)
        *count = (int)(sizeof presets / sizeof *presets);
    return presets;
}
