# SPDX-License-Identifier: BSD-3-Clause
"""Scenes with the rigs to touch them: ten that a first touch may begin with, and the paper's own.

The ten keep to loads and tips that the laws of contact hold for, so that their plans warn of nothing but what they
say. What is felt of each is in :data:`FELT`. Those that begin with ``paper_`` have the numbers of the paper (Sitti and
Hashimoto, Teleoperated Touch Feedback from the Surfaces at the Nanoscale) and the largest load of its rig. What is soft
is pressed beyond small contacts there, in the paper as here (erratum E13): the plan warns of it.
"""

from __future__ import annotations

import math

from nanotouch.rheology import Rheology
from nanotouch.scene import Rig, Scene

PAPER_LOAD = 2.2e-6  # what the paper's rig can press with [N]

FELT: dict[str, str] = {
    "silicon_in_air": (
        "A wall of 665 N/m: nothing before the water films touch 0.7 nm away; the water lets go at 18 "
        "nN, eight times the noise of the lever."
    ),
    "silicon_on_gold": (
        "A wall of 850 N/m behind a bridge: the water snaps in 0.86 nm away and lets go at 54 nN. The "
        "potential's 0.53 nN drown in the noise of the lever."
    ),
    "mica_in_air": (
        "The lever snaps in 0.6 nm away, meets a wall of 366 N/m, and sticks with 3.4 nN, twelve times its noise."
    ),
    "polyester": (
        "The tip takes hold 0.2 nm away, sinks in by 4.2 nm under 700 nN, and sticks with 444 nN before it lets go."
    ),
    "silicone_rubber": (
        "Soft and sticky: the ball takes hold at the touch, sinks in by 144 nm under 1.2 µN at 18 N/m, "
        "and lets go only when 0.75 µN pull."
    ),
    "polystyrene_ball": (
        "A wall of 631 N/m, to rub: the ball sticks, then slips at up to 0.55 µN sideways, and lets go "
        "when 0.57 µN pull."
    ),
    "inas_dots": (
        "Hills as hard as a wall of 420 N/m: the hand follows their heights, not their give, and the "
        "water lets go at 18 nN."
    ),
    "cell_in_liquid": (
        "Fur over jelly: 10 pN come 360 nm away, 0.3 nN where the cell begins, 0.9 nN another 230 nm deep. "
        "Nothing pulls on the way out."
    ),
    "chondrocyte": (
        "Jelly with a delay: 4 nN sink in 0.17 µm at once and 0.29 µm after 2 s. At a held indentation the force "
        "falls to 44 %; the dent comes back after the tip has gone."
    ),
    "polymer_gel": (
        "A soft cushion that never quite rests: 1 nN sinks in 0.35 µm in a second, and a tenth more in each ten "
        "times as long."
    ),
}
"""What the hand feels of each preset, in a sentence."""


def silicon_in_air() -> tuple[Scene, Rig]:
    """Silicon tip (20 nm, 8 N/m) on silicon in air of 40 % humidity."""
    # moduli: the paper's; Y of silicon here and below: core/materials.c
    return Scene(tip={"yield_strength": 7e9}, sample={"yield_strength": 7e9}), Rig()


def silicon_on_gold() -> tuple[Scene, Rig]:
    """Blunt silicon tip (60 nm) on gold in air of 61 % humidity, at 0.25 V of contact potential."""
    hamaker, distance = 2.03e-19, 1.98e-10  # those of Fig. 6
    scene = Scene(
        tip={"radius": 60e-9, "yield_strength": 7e9},
        sample={"material": "gold"},
        # a film of van der Waals' thickness, e ~ ln(1/RH)^(-1/3): 0.35 nm at 40 % (erratum E4)
        medium={"relative_humidity": 0.61, "film_thickness": 0.43e-9},
        adhesion={
            "hamaker_constant": hamaker,
            "equilibrium_distance": distance,
            "work_of_adhesion": _work_of_adhesion(hamaker, distance),
            "contact_potential": 0.25,
        },
        # below 1.5 GPa of shear, where terraces without steps begin to yield (Kiely, Houston, PRB 57 (1998) 12588)
        range={"maximum_load": 0.44e-6},
    )
    return scene, Rig()


def mica_in_air() -> tuple[Scene, Rig]:
    """Silicon tip (25 nm) on mica in dry air, with the softer of the paper's cantilevers, 1 N/m."""
    hamaker, distance = 1e-19, 3.49e-10  # those of Fig. 16
    scene = Scene(
        tip={"radius": 25e-9, "yield_strength": 7e9},
        sample={"material": "mica"},  # 54 GPa; the paper's 0.05 GPa is no mica (erratum E19)
        medium={"relative_humidity": 0.0, "film_thickness": 0.0},
        adhesion={
            "hamaker_constant": hamaker,
            "equilibrium_distance": distance,
            "work_of_adhesion": _work_of_adhesion(hamaker, distance),
        },
        range={"maximum_load": 0.2e-6},
    )
    return scene, Rig(probe={"spring_constant": 1.0})


def polyester() -> tuple[Scene, Rig]:
    """Blunt methylated silicon tip (1.5 um) on polyester (2 GPa) in dry air."""
    scene = Scene(
        # blunt and without water: that alone would press a sharp tip in for good
        tip={"radius": 1.5e-6, "yield_strength": 7e9},
        # E as in Fig. 11; Poisson ratio and Y of PET: core/materials.c
        sample={"youngs_modulus": 2e9, "poisson_ratio": 0.4, "yield_strength": 0.07e9},
        medium={"relative_humidity": 0.0, "film_thickness": 0.0},
        # 22 mJ/m2 of methyl groups (Chaudhury and Whitesides, 1991), 44.6 of PET (core/materials.c); all of it acts in
        # contact, for before it a tail would draw up the polymer, which is left out
        adhesion={
            "given": "surface_energies", "tip_surface_energy": 0.022, "sample_surface_energy": 0.0446,
            "hamaker_constant": 0.0,
        },
        range={"maximum_load": 0.7e-6},
    )  # fmt: skip
    return scene, Rig()


def silicone_rubber() -> tuple[Scene, Rig]:
    """Silica ball (4 um) on hard silicone rubber (9 MPa) in air."""
    scene = Scene(
        tip={"radius": 4e-6, "material": "silica"},
        # h-PDMS: Schmid, Michel, Macromolecules 33 (2000) 3042; incompressible, as rubbers are
        sample={"youngs_modulus": 9e6, "poisson_ratio": 0.5},
        medium={"surface_tension": 0.0, "film_thickness": 0.0},  # water does not wet it: no meniscus
        # twice the surface energy of silicone, 19.8 mJ/m2 (Wu: core/materials.c); z0 as for silicon
        # all of it in contact, as for polyester
        adhesion={"work_of_adhesion": 0.0396, "hamaker_constant": 0.0},
        range={"maximum_load": 1.2e-6},
    )
    return scene, Rig()


def polystyrene_ball() -> tuple[Scene, Rig]:
    """Polystyrene ball (2 um) on glass in dry air, to rub: a hand of three axes feels friction in x and y."""
    scene = Scene(
        tip={"radius": 2e-6, "material": "polystyrene", "yield_strength": 0.1e9},
        sample={"material": "silica"},
        medium={"relative_humidity": 0.0, "film_thickness": 0.0},
        # all of it in contact, as for polyester
        adhesion={"work_of_adhesion": 0.06, "hamaker_constant": 0.0},
        # 9 to 15 MPa: polystyrene balls pushed over glass (Sumer and Sitti 2008)
        friction={"shear_strength": 12e6},
        range={"maximum_load": 1.2e-6},
    )
    return scene, Rig(master={"axes": 3}, probe={"lateral_stiffness": 50.0})


def inas_dots() -> tuple[Scene, Rig]:
    """Silicon tip on InAs quantum dots in humid air, for ``surface.dots()``."""
    scene = Scene(tip={"yield_strength": 7e9}, sample={"material": "indium arsenide"}, range={"maximum_load": 0.33e-6})
    return scene, Rig()


def cell_in_liquid() -> tuple[Scene, Rig]:
    """A living cell in saline under a colloidal probe: soft, thin, with a brush of sugars, no adhesion."""
    scene = Scene(
        tip={"shape": "sphere", "radius": 2.5e-6, "material": "silica", "surface_potential": -0.02},
        # E, T and the brush: Sokolov et al., Nat. Nanotechnol. 4 (2009) 605; potential: some -15 mV of zeta
        sample={
            "youngs_modulus": 1e3, "poisson_ratio": 0.5, "thickness": 5e-6, "conducting": "no",
            "surface_potential": -0.015,
        },
        medium={
            "kind": "liquid", "temperature": 310.15, "relative_humidity": 0.0, "ionic_strength": 150.0,
            "brush_thickness": 0.5e-6, "brush_spacing": 80e-9, "relative_permittivity": 74.0,
        },
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 1e-21},
        range={"maximum_load": 0.9e-9, "viscosity": 0.7e-3, "speed": 1e-6},
    )  # fmt: skip
    return scene, Rig(probe={"spring_constant": 0.06})


def chondrocyte() -> tuple[Scene, Rig]:
    """A cartilage cell in saline under a colloidal probe: it relaxes within a second."""
    # E0 = 21 +- 3 kPa, E_inf = 9.3 +- 0.8 kPa, apparent viscosity 2.8 +- 0.5 kPa s: Nguyen et al., J. R. Soc. Interface
    # 7 (2010) 1723, abstract (whole cells pressed to half their height). tau = viscosity/(E0 - E_inf).
    equilibrium, arm, viscosity = 9.3e3, 21e3 - 9.3e3, 2.8e3
    scene = Scene(
        tip={"shape": "sphere", "radius": 2.5e-6, "material": "silica"},
        sample={"poisson_ratio": 0.5},
        rheology=Rheology.standard_linear_solid(equilibrium, arm, viscosity / arm),
        medium={"kind": "liquid", "temperature": 310.15, "relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 4e-9, "viscosity": 0.7e-3, "speed": 1e-6, "duration": 100.0},
    )
    return scene, Rig(probe={"spring_constant": 0.1})


def polymer_gel() -> tuple[Scene, Rig]:
    """A polymer gel in water under a colloidal probe: it relaxes a little in each decade of time."""
    # 1.72 kPa at 1 s, beta = 0.057: our fit of the public curve fmt-jpk-cc_pr14-polymergel-2021.06.30 of afmformats,
    # second row of docs/evidence/viscoelastic_fits.md. The file does not state the tip: 2.5 um is assumed there, too.
    scene = Scene(
        tip={"shape": "sphere", "radius": 2.5e-6, "material": "silica"},
        sample={"poisson_ratio": 0.5},
        rheology=Rheology.power_law(1.72e3, 0.057),
        medium={"kind": "liquid", "relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 1e-9, "viscosity": 0.9e-3, "speed": 1e-6, "duration": 100.0},
    )
    return scene, Rig(probe={"spring_constant": 0.06})


def paper_silicon() -> tuple[Scene, Rig]:
    """Silicon tip (20 nm, 8 N/m) on silicon in air of 40 % humidity: Fig. 9 and 17."""
    return Scene(range={"maximum_load": PAPER_LOAD}), Rig()


def paper_gold() -> tuple[Scene, Rig]:
    """Silicon tip on gold under a thick water film, at 0.25 V of contact potential: Fig. 6."""
    hamaker, distance = 2.03e-19, 1.98e-10
    scene = Scene(
        tip={"radius": 30e-9},
        sample={"youngs_modulus": 79e9, "poisson_ratio": 0.42},  # gold, handbook
        # r1 and e as given, though they do not belong to one humidity (erratum E4); r1 is that of 61 % (Kelvin)
        medium={
            "relative_humidity": 0.61,
            "meniscus_radius": 1.06e-9,
            "film_thickness": 5e-9,
            "surface_tension": 0.072,
        },
        adhesion={
            "hamaker_constant": hamaker,
            "equilibrium_distance": distance,
            "work_of_adhesion": _work_of_adhesion(hamaker, distance),
            "contact_potential": 0.25,
        },
        range={"maximum_load": PAPER_LOAD},
    )
    return scene, Rig()


def paper_mica() -> tuple[Scene, Rig]:
    """The simulation of Fig. 16: no meniscus, 30 N/m, and a modulus far too low for mica (erratum E19)."""
    hamaker, distance = 1e-19, 3.49e-10
    scene = Scene(
        tip={"radius": 25e-9},
        sample={"youngs_modulus": 0.05e9, "poisson_ratio": 0.3},
        medium={"relative_humidity": 0.0, "film_thickness": 0.0},
        adhesion={
            "hamaker_constant": hamaker,
            "equilibrium_distance": distance,
            "work_of_adhesion": _work_of_adhesion(hamaker, distance),
        },
        range={"maximum_load": PAPER_LOAD},
    )
    return scene, Rig(probe={"spring_constant": 30.0}, master={"gauge_noise": math.sqrt(0.001)})


def paper_polyester() -> tuple[Scene, Rig]:
    """Silicon tip on polyester (2 GPa) in humid air: Fig. 11."""
    scene = Scene(
        sample={"youngs_modulus": 2e9, "poisson_ratio": 0.4},  # Poisson ratio: handbook
        range={"maximum_load": PAPER_LOAD},
    )
    return scene, Rig()


def paper_silicone_rubber() -> tuple[Scene, Rig]:
    """Silicon tip on silicone rubber (0.6 MPa), with the softer of the paper's cantilevers, 1 N/m: Fig. 11."""
    scene = Scene(
        sample={"youngs_modulus": 0.6e6, "poisson_ratio": 0.5},  # incompressible, as rubbers are
        medium={"surface_tension": 0.0, "film_thickness": 0.0},  # water does not wet it: no meniscus
        # twice the surface energy of silicone, 22 mJ/m2 (Chaudhury and Whitesides, 1991); z0 as for silicon
        adhesion={"work_of_adhesion": 0.044, "hamaker_constant": 6e-20},
        range={"maximum_load": PAPER_LOAD},
    )
    return scene, Rig(probe={"spring_constant": 1.0})


def paper_inas() -> tuple[Scene, Rig]:
    """Silicon tip on InAs quantum dots in humid air, for ``surface.dots()``: Fig. 19."""
    return Scene(
        sample={"youngs_modulus": 51.4e9, "poisson_ratio": 0.35}, range={"maximum_load": PAPER_LOAD}
    ), Rig()  # handbook


def _work_of_adhesion(hamaker_constant: float, equilibrium_distance: float) -> float:
    """w = H/(12 pi a0^2) [J/m^2]: what the van der Waals attraction of two half-spaces holds at contact."""
    return hamaker_constant / (12.0 * math.pi * equilibrium_distance**2)
