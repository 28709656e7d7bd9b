# SPDX-License-Identifier: BSD-3-Clause
"""Scenes and rigs of the paper (Sitti and Hashimoto, Teleoperated Touch Feedback from the Surfaces at the Nanoscale).

Numbers are the paper's unless a comment says otherwise. What is soft is pressed beyond the validity of the
small-contact laws at the rig's largest load, in the paper as here (erratum E13): the plan warns of it.
"""

from __future__ import annotations

import math

from nanotouch.scene import Rig, Scene


def silicon_in_air() -> tuple[Scene, Rig]:
    """Silicon tip (20 nm, 8 N/m) on silicon in air of 40 % humidity: Fig. 9 and 17."""
    return Scene(), Rig()


def silicon_on_gold() -> tuple[Scene, Rig]:
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
    )
    return scene, Rig()


def mica_in_air() -> tuple[Scene, Rig]:
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
    )
    return scene, Rig(probe={"spring_constant": 30.0}, master={"gauge_noise": math.sqrt(0.001)})


def polyester() -> tuple[Scene, Rig]:
    """Silicon tip on polyester (2 GPa) in humid air: Fig. 11."""
    return Scene(sample={"youngs_modulus": 2e9, "poisson_ratio": 0.4}), Rig()  # Poisson ratio: handbook


def silicone_rubber() -> tuple[Scene, Rig]:
    """Silicon tip on silicone rubber (0.6 MPa), with the softer of the paper's cantilevers, 1 N/m: Fig. 11."""
    scene = Scene(
        sample={"youngs_modulus": 0.6e6, "poisson_ratio": 0.5},  # incompressible, as rubbers are
        medium={"surface_tension": 0.0, "film_thickness": 0.0},  # water does not wet it: no meniscus
        # twice the surface energy of silicone, 22 mJ/m2 (Chaudhury and Whitesides, 1991); z0 as for silicon
        adhesion={"work_of_adhesion": 0.044, "hamaker_constant": 6e-20},
    )
    return scene, Rig(probe={"spring_constant": 1.0})


def inas_dots() -> tuple[Scene, Rig]:
    """Silicon tip on InAs quantum dots in humid air, for ``surface.dots()``: Fig. 19."""
    return Scene(sample={"youngs_modulus": 51.4e9, "poisson_ratio": 0.35}), Rig()  # InAs, handbook


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
        range={"maximum_load": 2e-9, "viscosity": 0.7e-3, "speed": 1e-6},
    )  # fmt: skip
    return scene, Rig(probe={"spring_constant": 0.06})


def _work_of_adhesion(hamaker_constant: float, equilibrium_distance: float) -> float:
    """w = H/(12 pi a0^2) [J/m^2]: what the van der Waals attraction of two half-spaces holds at contact."""
    return hamaker_constant / (12.0 * math.pi * equilibrium_distance**2)
