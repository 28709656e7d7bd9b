# SPDX-License-Identifier: BSD-3-Clause
"""What files say is to be touched: an image with its own relief, a scene, a measured force curve whose fit becomes the
scene."""

from __future__ import annotations

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


def of(what: str, radius: float | None = None) -> Subject:
    """A preset by its name, or what a file says; ``radius`` [m] of the tip of a measured curve."""
    if what in PRESETS:
        return of_preset(what)
    path = Path(what)
    if not path.exists():
        raise InvalidValue(f"{what}: neither a file nor a preset; presets are {', '.join(PRESETS)}")
    if path.suffix.lower() == ".toml":
        return of_scene(path)
    if path.suffix.lower() == ".nc":
        return of_map(path)
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


def of_map(path: Path) -> Subject:
    """The map.nc of ``nanotouch map``: each place has the modulus and the adhesion that were found there."""
    data = nt.maps.read(path)
    scene = nt.maps.to_scene(data)

    def surface(touching: nt.Scene) -> nt.Surface:
        return nt.maps.to_surface(data, touching, fill_by="neighbours")

    felt = "Your map: height, modulus and adhesion of each place are those that were fitted."
    hint = "Drag from a soft place to a hard one at a steady force."
    return Subject(path.stem, path.stem, scene, nt.Rig(), surface(scene).topography, felt, hint, surface)


def of_curve(path: Path, radius: float | None = None) -> Subject:
    """A force curve: its fit by Maugis-Dugdale is the scene, its lever the lever."""
    return of_fit(curves.read(path)[0], path.stem, radius)


def of_fit(curve: nt.ForceCurve, name: str, radius: float | None = None) -> Subject:
    """The same of a curve that has been read; ``radius`` [m] of its tip."""
    tip = CURVE_TIP if radius is None else radius
    result = fitting.fit_curve(curve, "maugis", radius=tip)
    scene, rig = result.to_scene(), nt.Rig()
    rig["probe.spring_constant"] = result.spring_constant
    modulus, energy = result.values["effective_modulus"], result.values["work_of_adhesion"]
    assumed = "" if radius is not None else f"; R = {in_words(tip, 'm', 3)} is assumed (--radius)"
    felt = (f"Your curve: pull-off {in_words(result.measured_pull_off_force, 'N', 3)}, work of adhesion "
            f"{in_words(energy, 'J/m^2', 3)}, E* {in_words(modulus, 'Pa', 3)}{assumed}.")  # fmt: skip
    return Subject(name, name, scene, rig, _made_for(scene, name), felt, "Touch what you have measured.")
