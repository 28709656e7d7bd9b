# SPDX-License-Identifier: BSD-3-Clause
"""Scenes that a laboratory has: forty by hand, with where their values come from, and a sampler of others.

Hamaker constants are those of J. Israelachvili, Intermolecular and Surface Forces, 3rd ed. (2011), tables 13.2 and
13.3; of two materials the geometric mean. Moduli are those of data sheets and of the papers that are named.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Ordinary(NamedTuple):
    """One scene and the source of its values."""

    name: str
    source: str
    tables: dict[str, Any]


SILICON = {"youngs_modulus": 130e9, "poisson_ratio": 0.28}
NITRIDE = {"youngs_modulus": 250e9, "poisson_ratio": 0.23}
SILICA = {"youngs_modulus": 70e9, "poisson_ratio": 0.17}
DIAMOND = {"youngs_modulus": 1100e9, "poisson_ratio": 0.07}


def _dry(
    tip: dict[str, Any], radius: float, sample: tuple[float, float], surface: tuple[float, float], load: float
) -> dict[str, Any]:
    """Sample: E [Pa] and nu; surface: w [J/m2] and H [J]."""
    return {
        "tip": {**tip, "radius": radius},
        "sample": {"youngs_modulus": sample[0], "poisson_ratio": sample[1]},
        "medium": {"relative_humidity": 0.0},
        "adhesion": {"work_of_adhesion": surface[0], "hamaker_constant": surface[1]},
        "range": {"maximum_load": load},
    }


def _humid(
    tip: dict[str, Any], radius: float, sample: tuple[float, float], humidity: float, load: float
) -> dict[str, Any]:
    scene = _dry(tip, radius, sample, (0.1, 1e-19), load)
    scene["medium"] = {"relative_humidity": humidity}
    return scene


def _wet(
    scene: dict[str, Any], salt: float, potentials: tuple[float, float] = (0.0, 0.0), **medium: float
) -> dict[str, Any]:
    """In water with salt [mM], with surface potentials of tip and sample [V]."""
    scene["medium"] = {"kind": "liquid", "ionic_strength": salt, **medium}
    scene["tip"]["surface_potential"], scene["sample"]["surface_potential"] = potentials
    return scene


ORDINARY = (
    # --- polymers in dry gas ---
    Ordinary(
        "silicon tip on polystyrene",
        "E 3.3 GPa; gamma 33 mJ/m2, w by the geometric mean; H of Si and PS",
        _dry(SILICON, 10e-9, (3.3e9, 0.33), (0.07, 1.1e-19), 2e-8),
    ),
    Ordinary(
        "silicon tip on PMMA",
        "E 3 GPa; H of Si and PMMA; w of Burnham, Colton (1991)",
        _dry(SILICON, 10e-9, (3.0e9, 0.37), (0.05, 1.15e-19), 2e-8),
    ),
    Ordinary(
        "silicon tip on PEEK",
        "E 3.7 GPa, data sheet; w of polymers, 50 to 80 mJ/m2",
        _dry(SILICON, 15e-9, (3.7e9, 0.4), (0.06, 1.1e-19), 3e-8),
    ),
    Ordinary(
        "silicon tip on PTFE",
        "E 0.5 GPa; gamma 19 mJ/m2; H of Si and PTFE",
        _dry(SILICON, 20e-9, (0.5e9, 0.46), (0.04, 0.84e-19), 2e-8),
    ),
    Ordinary(
        "silicon tip on LDPE", "E 0.2 GPa; gamma 31 mJ/m2", _dry(SILICON, 10e-9, (0.2e9, 0.45), (0.06, 1e-19), 5e-9)
    ),
    Ordinary("silicon tip on HDPE", "E 1 GPa; gamma 33 mJ/m2", _dry(SILICON, 8e-9, (1e9, 0.42), (0.065, 1e-19), 1e-8)),
    Ordinary(
        "silicon tip on polycarbonate",
        "E 2.3 GPa; gamma 34 mJ/m2; H 5.1e-20 of PC",
        _dry(SILICON, 20e-9, (2.3e9, 0.37), (0.066, 0.97e-19), 3e-8),
    ),
    Ordinary("silicon tip on epoxy", "E 4 GPa; gamma 43 mJ/m2", _dry(SILICON, 30e-9, (4e9, 0.35), (0.08, 1e-19), 5e-8)),
    Ordinary(
        "nitride tip on nylon 6",
        "E 2.8 GPa; gamma 46 mJ/m2; H of Si3N4 1.67e-19",
        _dry(NITRIDE, 20e-9, (2.8e9, 0.39), (0.08, 1.1e-19), 3e-8),
    ),
    Ordinary(
        "colloidal silica on PDMS",
        "E 2 MPa, w 45 mJ/m2: Chaudhury, Whitesides (1991); H of silica and PDMS",
        _dry(SILICA, 5e-6, (2e6, 0.49), (0.045, 5.3e-20), 1e-6),
    ),
    Ordinary(
        "silicon tip on PDMS", "the same with a sharp tip", _dry(SILICON, 20e-9, (2e6, 0.49), (0.045, 9e-20), 2e-9)
    ),
    Ordinary(
        "silica sphere on polystyrene",
        "Rumpf-like particle adhesion: R 2 um, E 3.3 GPa, w 60 mJ/m2",
        _dry(SILICA, 2e-6, (3.3e9, 0.33), (0.06, 6.4e-20), 5e-6),
    ),
    # --- crystals, oxides, metals in dry gas or vacuum ---
    Ordinary(
        "silicon tip on mica",
        "E 54 GPa effective (basal); Carpick et al. (1996): w 0.1 to 0.4 J/m2",
        _dry(SILICON, 20e-9, (54e9, 0.25), (0.2, 1.36e-19), 1e-7),
    ),
    Ordinary(
        "silicon tip on silicon dioxide",
        "E 70 GPa; w 0.1 J/m2 of oxidised silicon, dry",
        _dry(SILICON, 10e-9, (70e9, 0.17), (0.1, 1.1e-19), 5e-8),
    ),
    Ordinary(
        "diamond tip on diamond",
        "Enachescu et al. (1998): E 1.1 TPa, w 10 mJ/m2 of hydrogenated surfaces",
        _dry(DIAMOND, 100e-9, (1100e9, 0.07), (0.02, 5e-20), 1e-7),
    ),
    Ordinary(
        "silicon tip on graphite",
        "E 36 GPa along c; w 0.1 J/m2; H of graphite 2.4e-19",
        _dry(SILICON, 10e-9, (36e9, 0.16), (0.15, 2.1e-19), 2e-8),
    ),
    Ordinary(
        "nitride tip on alumina", "E 370 GPa; w 0.15 J/m2", _dry(NITRIDE, 20e-9, (370e9, 0.22), (0.15, 1.5e-19), 1e-7)
    ),
    Ordinary(
        "gold-coated tip on gold",
        "E 78 GPa, w 1 J/m2 of clean metals cut by contamination to 0.5; H 4e-19",
        _dry({"youngs_modulus": 78e9, "poisson_ratio": 0.44}, 40e-9, (78e9, 0.44), (0.5, 4e-19), 1e-7),
    ),
    Ordinary(
        "silicon tip on copper in vacuum",
        "Landman-like: E 120 GPa, w 0.6 J/m2; H 3e-19",
        {**_dry(SILICON, 15e-9, (120e9, 0.34), (0.6, 2.7e-19), 5e-8), "medium": {"kind": "vacuum"}},
    ),
    Ordinary(
        "silicon over gold, never nearer than 5 nm",
        "non-contact: H of Si and Au; w of clean metal on silicon",
        {
            **_dry(SILICON, 20e-9, (78e9, 0.44), (0.3, 3e-19), 1e-8),
            "medium": {"kind": "vacuum"},
            "range": {"minimum_gap": 5e-9},
        },
    ),
    Ordinary(
        "silica sphere over silica, non-contact",
        "Derjaguin: R 10 um, H 6.3e-20, from 10 nm",
        {**_dry(SILICA, 10e-6, (70e9, 0.17), (0.1, 6.3e-20), 1e-8), "range": {"minimum_gap": 10e-9}},
    ),
    Ordinary(
        "PtIr tip on silicon at 3 V",
        "electrostatic microscopy: R 25 nm, E 170 GPa",
        {
            **_dry({"youngs_modulus": 170e9, "poisson_ratio": 0.37}, 25e-9, (130e9, 0.28), (0.1, 2e-19), 2e-8),
            "adhesion": {"work_of_adhesion": 0.1, "hamaker_constant": 2e-19, "contact_potential": 3.0},
        },
    ),
    Ordinary(
        "conducting tip over silicon at 1 V, non-contact",
        "Kelvin probe in the lift mode, from 10 nm",
        {
            **_dry(SILICON, 20e-9, (130e9, 0.28), (0.1, 1.8e-19), 2e-8),
            "adhesion": {"work_of_adhesion": 0.1, "hamaker_constant": 1.8e-19, "contact_potential": 1.0},
            "range": {"minimum_gap": 10e-9},
        },
    ),
    # --- ambient air ---
    Ordinary(
        "silicon tip on silicon at 40 %",
        "Israelachvili (2011), chapter 17.11",
        _humid(SILICON, 10e-9, (130e9, 0.28), 0.4, 5e-8),
    ),
    Ordinary("silicon tip on polystyrene at 30 %", "E 3.3 GPa", _humid(SILICON, 10e-9, (3.3e9, 0.33), 0.3, 2e-8)),
    Ordinary("nitride tip on mica at 60 %", "E 54 GPa", _humid(NITRIDE, 30e-9, (54e9, 0.25), 0.6, 1e-7)),
    Ordinary("silica sphere on glass at 50 %", "R 5 um", _humid(SILICA, 5e-6, (70e9, 0.17), 0.5, 1e-5)),
    Ordinary(
        "silicon tip on dry collagen fibril at 35 %",
        "E 3 GPa: Wenger et al. (2007)",
        _humid(SILICON, 8e-9, (3e9, 0.4), 0.35, 1e-8),
    ),
    # --- biology in buffer ---
    Ordinary(
        "nitride tip on a bacterium",
        "E 20 MPa wet wall; w 1 mJ/m2; H 5e-21; 10 mM",
        _wet(_dry(NITRIDE, 20e-9, (2e7, 0.5), (0.001, 5e-21), 2e-9), 10.0),
    ),
    Ordinary(
        "pyramid-blunted tip on a fibroblast",
        "E 1 kPa; brush of 300 nm: Sokolov et al. (2013)",
        _wet(_dry(NITRIDE, 50e-9, (1e3, 0.5), (0.0, 0.0), 5e-10), 150.0, brush_thickness=2e-7, brush_spacing=5e-8),
    ),
    Ordinary(
        "5 um ball on a cell with its brush",
        "E 1 kPa: Iyer et al. (2009)",
        _wet(_dry(SILICA, 2.5e-6, (1e3, 0.5), (0.0, 0.0), 1e-9), 150.0, brush_thickness=1e-6, brush_spacing=6e-8),
    ),
    Ordinary(
        "tip on a lipid bilayer",
        "E 20 MPa, 4 nm thick on mica: Das et al. (2010); repulsive hydration of 10 mJ/m2",
        _wet(
            {
                **_dry(NITRIDE, 20e-9, (2e7, 0.45), (0.0, 5e-21), 2e-9),
                "sample": {"youngs_modulus": 2e7, "poisson_ratio": 0.45, "thickness": 4e-9},
            },
            150.0,
            hydration_energy=0.01,
        ),
    ),
    Ordinary(
        "tip on a virus capsid",
        "E 1 GPa: Ivanovska et al. (2004), as a half-space; buffer 100 mM, w 1 mJ/m2",
        _wet(_dry(NITRIDE, 15e-9, (1e9, 0.3), (0.001, 5e-21), 1e-9), 100.0),
    ),
    Ordinary(
        "tip on collagen in buffer",
        "E 5 MPa; 150 mM; -20 mV each",
        _wet(_dry(NITRIDE, 20e-9, (5e6, 0.48), (0.0005, 4e-21), 1e-9), 150.0, (-0.02, -0.02)),
    ),
    Ordinary(
        "ball on an agarose gel",
        "E 20 kPa; 10 mM; no adhesion",
        _wet(_dry(SILICA, 2.5e-6, (2e4, 0.5), (0.0, 0.0), 1e-8), 10.0, (-0.03, -0.01)),
    ),
    # --- colloids in water ---
    Ordinary(
        "silica ball on mica, 1 mM",
        "Ducker et al. (1991): -30 and -60 mV; w 5 mJ/m2; H 1e-20",
        _wet(_dry(SILICA, 5e-6, (54e9, 0.25), (0.005, 1e-20), 1e-7), 1.0, (-0.03, -0.06)),
    ),
    Ordinary(
        "silica ball on silica, 0.1 mM, without adhesion",
        "Ducker et al. (1991): -60 mV; H 0.85e-20 masked by hydration",
        _wet(_dry(SILICA, 3.5e-6, (70e9, 0.17), (0.0, 0.0), 1e-8), 0.1, (-0.06, -0.06)),
    ),
    Ordinary(
        "nitride tip on mica, 10 mM",
        "Butt (1991): -20 and -40 mV; w 5 mJ/m2; H 2e-20",
        _wet(_dry(NITRIDE, 30e-9, (54e9, 0.25), (0.005, 2e-20), 1e-8), 10.0, (-0.02, -0.04)),
    ),
    Ordinary(
        "polystyrene ball on polystyrene, 1 mM",
        "E 3.3 GPa; -40 mV; w 10 mJ/m2; H 1.3e-20",
        _wet(
            _dry({"youngs_modulus": 3.3e9, "poisson_ratio": 0.33}, 2.5e-6, (3.3e9, 0.33), (0.01, 1.3e-20), 5e-8),
            1.0,
            (-0.04, -0.04),
        ),
    ),
    Ordinary(
        "silicon tip on calcite, 100 mM",
        "E 80 GPa: Rode et al. (2009); w 10 mJ/m2; hydration 5 mJ/m2",
        _wet(_dry(SILICON, 8e-9, (80e9, 0.31), (0.01, 1e-20), 5e-9), 100.0, (-0.02, 0.0), hydration_energy=0.005),
    ),
)


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))


_TIPS = (SILICON, NITRIDE, SILICA, DIAMOND)


def random_ordinary(rng: np.random.Generator) -> dict[str, Any]:
    """Dry solids and polymers, air, water with salt: each as often as the others."""
    kind = int(rng.integers(4))
    tip = dict(_TIPS[int(rng.integers(3))])
    colloid = rng.random() < 0.2
    radius = _log(rng, 5e-7, 1e-5) if colloid else _log(rng, 5e-9, 1e-7)
    load = radius * _log(rng, 0.2, 3.0)
    if kind == 0:  # dry polymer
        return _dry(
            tip,
            radius,
            (_log(rng, 1e8, 1e10), rng.uniform(0.3, 0.48)),
            (rng.uniform(0.03, 0.1), _log(rng, 5e-20, 1.5e-19)),
            load,
        )
    if kind == 1:  # dry crystal, oxide, metal
        return _dry(
            tip,
            radius,
            (_log(rng, 1e10, 4e11), rng.uniform(0.1, 0.4)),
            (_log(rng, 0.05, 0.5), _log(rng, 5e-20, 3e-19)),
            load,
        )
    if kind == 2:  # ambient air
        return _humid(tip, radius, (_log(rng, 1e9, 4e11), rng.uniform(0.1, 0.45)), rng.uniform(0.1, 0.8), load)
    adheres = rng.random() < 0.6
    soft = rng.random() < 0.5
    modulus = _log(rng, 1e3, 1e8) if soft and not adheres else _log(rng, 1e7, 1e11)
    surface = (_log(rng, 1e-3, 2e-2) if adheres else 0.0, _log(rng, 2e-21, 2e-20) if adheres else 0.0)
    potentials = (rng.uniform(-0.06, 0.0), rng.uniform(-0.06, 0.0))
    return _wet(
        _dry(tip, radius, (modulus, rng.uniform(0.2, 0.5)), surface, 0.3 * load), _log(rng, 0.1, 150.0), potentials
    )
