/* SPDX-License-Identifier: BSD-3-Clause
 * Constants of common materials of tips and samples, for want of one's own: see material.h.
 *
 * Each value with its source; "~" marks those on which sources differ by more than a tenth, with how far. Short names:
 * Bergstrom = Adv. Colloid Interface Sci. 70 (1997) 125 (Lifshitz theory); Israelachvili = Intermolecular and Surface
 * Forces, 3rd ed. 2011, ch. 13; Kaye Laby = Tables of Physical and Chemical Constants; Wu = Polymer Interface and
 * Adhesion, 1982 (surface tension at 20 C); Tyson Miller = Surf. Sci. 62 (1977) 267.
 *
 * Y of hard materials: Petersen, Proc. IEEE 70 (1982) 420, Table I; silica's is that of fibres. Y of polymers, at 20 C
 * and slow: Polymer Handbook, ~ 0.08..0.11 (PS), 0.09..0.13 (PMMA), 0.05..0.1 GPa (PET, more where it is drawn). Left
 * out where it says little of a contact of nanometres: gold (0.1 GPa in bulk, far more on a terrace without steps:
 * Kiely, Houston, Phys. Rev. B 57 (1998) 12588), InAs, layers that cleave (mica, graphite), rubbers, which tear first.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "nanotouch/material.h"

#define UNKNOWN ((double)NAN)
#define ZJ 1e-21 /* [J] */

static const nt_material_entry materials[] = {
    /* E, nu along <100> from C11 = 165.7, C12 = 63.9 GPa (Hopcroft, Nix, Kenny, J. MEMS 19 (2010) 229), up to 188 GPa
     * along <111>; gamma of (111): Gilman, J. Appl. Phys. 31 (1960) 2208; H ~ 187..255: Senden, Drummond, Colloids
     * Surf. A 94 (1995) 29 */
    {"silicon", "Si", {130e9, 0.28}, 1.24, 186.5 * ZJ, 7.0e9},
    /* E ~ 250..310, of LPCVD films; H of the amorphous nitride: Bergstrom */
    {"silicon nitride", "Si3N4", {290e9, 0.23}, UNKNOWN, 167.0 * ZJ, 14e9},
    /* fused silica; gamma ~ 0.13 hydrated .. 4 fresh fracture, 0.26 dry: Brunauer, Kantro, Weise, Can. J. Chem. 34
     * (1956) 1483; H: Bergstrom */
    {"silica", "SiO2", {73e9, 0.17}, 0.26, 65.0 * ZJ, 8.4e9},
    /* muscovite across the sheets, from C11 .. C33 of Vaughan, Guggenheim, J. Geophys. Res. 91 (1986) 4657 (along them
     * E = 178; the paper's 0.05 GPa is none: E19); gamma ~ 0.2..0.4 in air, 4..5 in vacuum: left out; H: Bergstrom */
    {"mica", "", {54e9, 0.10}, UNKNOWN, 98.6 * ZJ, UNKNOWN},
    /* Kaye Laby; gamma: Tyson Miller; H ~ 250..450, Israelachvili */
    {"gold", "Au", {78e9, 0.44}, 1.50, 400.0 * ZJ, UNKNOWN},
    /* Kaye Laby; gamma: Tyson Miller, ~ 2.9..3.7 */
    {"tungsten", "W", {411e9, 0.28}, 3.27, UNKNOWN, 4.0e9},
    /* across the sheets, from C11 .. C33 of Blakslee et al., J. Appl. Phys. 41 (1970) 3373; gamma, half the cleavage
     * energy 0.37: Wang et al., Nat. Commun. 6 (2015) 7853; H: sources differ by twice */
    {"graphite", "C", {36e9, 0.012}, 0.185, UNKNOWN, UNKNOWN},
    /* average of polycrystals: Klein, Cardinale, Diamond Relat. Mater. 2 (1993) 918; gamma of (111) ~ 5.3..6: Field,
     * Pickles, Diamond Relat. Mater. 5 (1996) 625; H: Bergstrom */
    {"diamond", "", {1143e9, 0.069}, 5.3, 296.0 * ZJ, 53e9},
    /* dense alpha-alumina: Munro, J. Am. Ceram. Soc. 80 (1997) 1919, single crystals ~ 345..460 by direction; gamma:
     * McHale et al., Science 277 (1997) 788; H: Bergstrom */
    {"sapphire", "Al2O3", {416e9, 0.23}, 2.6, 152.0 * ZJ, 15.4e9},
    /* along <100> from C11 = 83.4, C12 = 45.4 GPa (Ioffe Institute, New Semiconductor Materials) */
    {"indium arsenide", "InAs", {51.4e9, 0.35}, UNKNOWN, UNKNOWN, UNKNOWN},
    /* E 3.0..3.5, nu 0.33..0.35: Brandrup, Immergut, Polymer Handbook; gamma: Wu; H 65..79: Israelachvili */
    {"polystyrene", "PS", {3.3e9, 0.34}, 0.0407, 66.0 * ZJ, 0.10e9},
    /* E ~ 2.4..3.3, nu 0.35..0.40: Polymer Handbook; gamma: Wu; H: Israelachvili */
    {"polymethylmethacrylate", "PMMA", {3.0e9, 0.37}, 0.0411, 71.0 * ZJ, 0.11e9},
    /* polyester; E ~ 2..4, nu ~ 0.37..0.44: Polymer Handbook; gamma: Wu */
    {"polyethylene terephthalate", "PET", {2.8e9, 0.40}, 0.0446, UNKNOWN, 0.07e9},
    /* Sylgard 184, 10:1; E ~ 1.3..3.0 with curing: Johnston et al., J. Micromech. Microeng. 24 (2014) 035017; gamma:
     * Wu; H: Drummond, Chan, Langmuir 13 (1997) 3890 */
    {"polydimethylsiloxane", "PDMS", {2.0e6, 0.49}, 0.0198, 44.0 * ZJ, UNKNOWN},
    /* 20 C: IAPWS; H: Israelachvili */
    {"water", "H2O", {UNKNOWN, UNKNOWN}, 0.0728, 37.0 * ZJ, UNKNOWN},
};

enum { MATERIALS = (int)(sizeof materials / sizeof materials[0]) };

const nt_material_entry *nt_material_at(int index)
{
    return index >= 0 && index < MATERIALS ? &materials[index] : NULL;
}

const nt_material_entry *nt_material_find(const char *name)
{
    if (name == NULL || *name == '\0')
        return NULL;
    for (int i = 0; i < MATERIALS; i++)
        if (strcmp(name, materials[i].name) == 0 || strcmp(name, materials[i].symbol) == 0)
            return &materials[i];
    return NULL;
}

double nt_hamaker_combine(double hamaker_1, double hamaker_2, double hamaker_3)
{
    return (sqrt(hamaker_1) - sqrt(hamaker_3)) * (sqrt(hamaker_2) - sqrt(hamaker_3));
}

double nt_work_of_adhesion(double surface_energy_1, double surface_energy_2)
{
    return 2.0 * sqrt(surface_energy_1) * sqrt(surface_energy_2);
}
