# SPDX-License-Identifier: BSD-3-Clause
"""What files say is to be touched: an image with its own relief, a scene, a measured force curve whose fit becomes the
scene."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import nanotouch as nt
from nanotouch import curves
from nanotouch import fit as fitting
from nanotouch.errors import Error, InvalidValue
from nanotouch.scene import read_tables
from nanotouch.units import in_words

from nanotouch_app.live.subject import PRESETS, Subject, of_preset, relief

MOST_PIXELS = 1024  # of an image that is touched, to a side
EXTENT = 25.0  # of the relief that is made for a scene, in radii of the tip
ROUGHNESS = 0.01  # its height over the same
CURVE_TIP = 20e-9  # [m]; assumed, and told, where nobody gives the radius
POISSON = 0.3  # of a sample of which nobody knows it
DUGDALE = 16.0 / (9.0 * math.sqrt(3.0))  # sigma0 z0/w of an atomic potential


def of(what: str, radius: float | None = None) -> Subject:
    """A preset by its name, or what a file says; ``radius`` [m] of the tip of a measured curve."""
    if what in PRESETS:
        return of_preset(what)
    path = Path(what)
    if not path.exists():
        raise InvalidValue(f"{what}: neither a file nor a preset; presets are {', '.join(PRESETS)}")
    if path.suffix.lower() == ".toml":
        return of_scene(path)
    try:
        return of_image(path)
    except Error as no_image:
        try:
            return of_curve(path, radius)
        except Error as no_curve:
            raise Error(f"{what}: no image ({no_image}) and no force curve ({no_curve})") from no_curve


def of_scene(path: Path) -> Subject:
    """The scene and rig of a TOML file, over a gentle relief."""
    tables = read_tables(path)
    scene, rig = nt.Scene.from_tables(tables), nt.Rig.from_tables(tables)
    return Subject(path.stem, path.stem, scene, rig, _made_for(scene, path.stem), "", "Scroll down until you feel it.")


def _made_for(scene: nt.Scene, name: str) -> nt.Topography:
    size = EXTENT * float(scene.tip.radius)
    return relief(size, ROUGHNESS * size, name)


def of_image(path: Path) -> Subject:
    """The relief of an AFM image, silicon in air."""
    raw = nt.images.read(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # what was done to it is told by nanotouch image
        topography, _ = nt.images.prepare(raw)
    if max(topography.shape) > MOST_PIXELS:
        level = next(one for one in nt.images.mip_levels(topography, smallest=1) if max(one.mean.shape) <= MOST_PIXELS)
        topography = nt.Topography(heights=level.mean, pixel_size=level.pixel_size, name=topography.name)
    scene, rig = nt.presets.silicon_in_air()
    felt = f"The relief of {path.name}, touched as silicon in air: {in_words(topography.height_range, 'm', 3)} high."
    return Subject(path.stem, topography.name or path.stem, scene, rig, topography, felt, "Feel your own surface.")


def of_curve(path: Path, radius: float | None = None) -> Subject:
    """A force curve: its fit by Maugis-Dugdale is the scene, its lever the lever."""
    return of_fit(curves.read(path)[0], path.stem, radius)


def of_fit(curve: nt.ForceCurve, name: str, radius: float | None = None) -> Subject:
    """The same of a curve that has been read; ``radius`` [m] of its tip."""
    tip = CURVE_TIP if radius is None else radius
    result = fitting.fit_curve(curve, "maugis", radius=tip)
    scene, rig = scene_of_fit(result), nt.Rig()
    rig["probe.spring_constant"] = result.spring_constant
    modulus, energy = result.values["effective_modulus"], result.values["work_of_adhesion"]
    assumed = "" if radius is not None else f"; R = {in_words(tip, 'm', 3)} is assumed (--radius)"
    felt = (f"Your curve: pull-off {in_words(result.measured_pull_off_force, 'N', 3)}, work of adhesion "
            f"{in_words(energy, 'J/m^2', 3)}, E* {in_words(modulus, 'Pa', 3)}{assumed}.")  # fmt: skip
    return Subject(name, name, scene, rig, _made_for(scene, name), felt, "Touch what you have measured.")


def scene_of_fit(result: nt.FitResult) -> nt.Scene:
    """The contact that was fitted, in dry air: all adhesion acts in contact, over the range that was found."""
    scene = nt.Scene()
    silicon = (1.0 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    rest = max(1.0 / result.values["effective_modulus"] - silicon, 1e-3 / result.values["effective_modulus"])
    scene["tip.radius"] = result.radius
    scene["sample.poisson_ratio"] = POISSON
    scene["sample.youngs_modulus"] = (1.0 - POISSON**2) / rest
    scene["medium.relative_humidity"] = scene["medium.film_thickness"] = 0.0
    scene["adhesion.hamaker_constant"] = 0.0
    scene["adhesion.work_of_adhesion"] = result.values.get("work_of_adhesion", 0.0)
    if "cohesive_range" in result.values:
        scene["adhesion.equilibrium_distance"] = DUGDALE * result.values["cohesive_range"]
    scene["range.maximum_load"] = float(max(result.force.max(), result.measured_pull_off_force))
    return scene
