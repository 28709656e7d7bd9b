# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of the paper, each with the place it comes from, and where the text is silent, the value taken and why."""

from __future__ import annotations

from nanotouch_app.studies.reproduce.statement import Parameter

CANTILEVER = Parameter("spring constant k_c", 8.0, "N/m", "Sec. VI-B; 'around 8 N/m' in III-B")
TILT = Parameter("tilt alpha of the cantilever", 0.0, "rad", "not in the text")
TIP = Parameter("tip radius R", 20e-9, "m", "Sec. VI-B, the same 8 N/m probe; Sec. III-B says 20-30 nm")
OTHER_TIP = Parameter("other tip radius", 30e-9, "m", "upper end of Sec. III-B's 20-30 nm, for comparison")
SILICON = Parameter("Young's modulus of silicon", 135e9, "Pa", "Sec. III-B")
SILICON_RATIO = Parameter("Poisson ratio of silicon", 0.35, "", "Sec. III-B")
WATER = Parameter("surface tension gamma_L of water", 0.072, "N/m", "Sec. III-B")
WORK = Parameter("work of adhesion w = 2 gamma_L", 0.144, "J/m^2", "Sec. III-B")
# Fig. 9 needs an a0 for lambda: that of Fig. 6 is the only one given for a silicon tip in air
DISTANCE = Parameter("interatomic distance a0", 1.98e-10, "m", "Sec. III-A, for silicon and gold; none for Fig. 9, 10")
HUMIDITY = Parameter("relative humidity", 0.40, "", "Sec. VI-B")
RESOLUTION = Parameter("force resolution, peak to peak", 13e-9, "N", "Sec. IV-C, 0.05 V x k_c S")
LARGEST_ATTRACTION = Parameter("typical largest attraction", 0.6e-6, "N", "Sec. IV-C")
ONSET = Parameter("onset of attraction, point A", 40e-9, "m", "Sec. III")
SLOPE = Parameter("measured slope of unloading", 8.5, "N/m", "Sec. III-B, Fig. 9")
POLYESTER = Parameter("Young's modulus of polyester", 2e9, "Pa", "Sec. III-B")
RUBBER = Parameter("Young's modulus of silicone rubber", 0.6e6, "Pa", "Sec. III-B")
MICA = Parameter("modulus called mica", 0.05e9, "Pa", "Sec. VI-B; far too soft for mica, erratum E19")

GOLD_TIP = Parameter("tip radius R", 30e-9, "m", "Sec. III-A")
HAMAKER = Parameter("Hamaker constant H", 2.03e-19, "J", "Sec. III-A")
FILM = Parameter("thickness e of the film", 5e-9, "m", "Sec. III-A")
MENISCUS = Parameter("meniscus radius r1", 1.06e-9, "m", "Sec. III-A; 61 % humidity, erratum E4")
POTENTIAL = Parameter("potential difference U", 0.25, "V", "Sec. III-A")
PERMITTIVITY = Parameter("vacuum permittivity eps0", 8.85e-12, "F/m", "Sec. III-A")
