# SPDX-License-Identifier: BSD-3-Clause
"""What files say is to be touched: an image with its own relief, a scene, a measured force curve whose fit becomes the
scene."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import nanotouch as nt
from nanotouch import curves, record, rig_file
from nanotouch.errors import Error, InvalidValue
from nanotouch.scene import read_tables
from nanotouch.units import in_words

from nanotouch_app.common import surfaces
from nanotouch_app.live import measured
from nanotouch_app.live.subject import PRESETS, Subject, of_preset

MOST_PIXELS = 1024  # of an image that is touched, to a side
EXTENT = 25.0  # of the relief that is made for a scene, in radii of the tip
ROUGHNESS = 0.01  # its height over the same


def check_named(what: str) -> None:
    """Refuse what is neither a file nor a preset."""
    if what not in PRESETS and not Path(what).exists():
        raise InvalidValue(f"{what}: neither a file nor a preset; presets are {', '.join(PRESETS)}")


def of(
    what: str, radius: float | None = None, spring_constant: float | None = None, named: nt.SurfaceFile | None = None,
    told: Callable[[str], object] = str,
) -> Subject:  # fmt: skip
    """A preset by its name, or what a file says; ``radius`` [m] of the tip and ``spring_constant`` [N/m] of the lever
    that measured a curve; ``named`` where more is said of an image. ``told`` is called with what is done now."""
    if named is not None:
        return of_surface(named, *nt.presets.silicon_in_air(), Path(what).stem)
    if what in PRESETS:
        return of_preset(what)
    path = Path(what)
    check_named(what)
    told(f"reading {path.name}")
    if path.suffix.lower() == ".toml":
        return of_scene(path)
    if path.suffix.lower() == ".nc":
        return of_map(path)
    if record.is_recording(path):
        raise InvalidValue(f"{path.name} is a recording, and is played: nanotouch live {path.name}")
    if radius is not None or spring_constant is not None:
        return _of_curve_alone(path, radius, spring_constant)
    try:
        return of_image(path, told)
    except Error as no_image:
        told(f"fitting {path.name}")
        try:
            return of_curve(path)
        except Error as no_curve:
            reasons = [_reason(error, path) for error in (no_image, no_curve)]
            why = (
                reasons[0] if reasons[0] == reasons[1] else f"no image ({reasons[0]}) and no force curve ({reasons[1]})"
            )
            raise Error(f"{what}: {why}") from no_curve


def _of_curve_alone(path: Path, radius: float | None, spring_constant: float | None) -> Subject:
    """Who names tip or lever means a curve, also where the file holds an image."""
    try:
        return of_curve(path, radius, spring_constant)
    except Error as error:
        options = [name for name, value in (("--radius", radius), ("--spring-constant", spring_constant)) if value]
        told = f"{' and '.join(options)} {'are' if len(options) > 1 else 'is'} of a force curve"
        raise Error(f"{path}: {told}; {_reason(error, path)}") from error


def _reason(error: Error, path: Path) -> str:
    """What was said without the file's name, which is told once."""
    return str(error).removeprefix(f"{path}: ").removeprefix(f"{path.name}: ")


def of_scene(path: Path) -> Subject:
    """The scene and rig of a TOML file, over a gentle relief."""
    tables = rig_file.described(read_tables(path), path.parent).rig  # what it says of simulated halves, too
    scene, rig = nt.Scene.from_tables(tables), nt.Rig.from_tables(tables)
    named = nt.SurfaceFile.from_tables(tables, path.parent)
    if named is not None:
        return of_surface(named, scene, rig, path.stem)
    return Subject(path.stem, path.stem, scene, rig, _made_for(scene, path.stem), "", "Scroll down until you feel it.")


def of_surface(named: nt.SurfaceFile, scene: nt.Scene, rig: nt.Rig, name: str) -> Subject:
    """A surface by its files, with what it is made of at each place."""

    def surface(touching: nt.Scene) -> nt.Surface:
        return named.touched_by(touching, MOST_PIXELS)

    topography = surface(scene).topography
    made_of = [quantity.replace("_", " ") for quantity in named.properties]
    felt = f"The relief of {Path(named.image).name}, {in_words(topography.height_range, 'm', 3)} high"
    felt += f"; {' and '.join(made_of)} of each place are those of the file." if made_of else "."
    return Subject(name, topography.name or name, scene, rig, topography, felt, "Feel your own surface.", surface)


def _made_for(scene: nt.Scene, name: str) -> nt.Topography:
    size = EXTENT * float(scene.tip.radius)
    return surfaces.relief(size, ROUGHNESS * size, name)


def of_image(path: Path, told: Callable[[str], object] = str) -> Subject:
    """The relief of an AFM image, silicon in air. ``told`` is called with what is done now."""
    raw = nt.images.read(path)
    told(f"levelling {raw.shape[1]} x {raw.shape[0]} pixels of {path.name}")
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


def of_curve(path: Path, radius: float | None = None, spring_constant: float | None = None) -> Subject:
    """A force curve, the first one of a map: its fit, by the law that
    ``nanotouch fit`` takes, is the scene, its lever the lever."""
    return of_fit(curves.read(path, spring_constant=spring_constant)[0], path.stem, radius)


def of_fit(curve: nt.ForceCurve, name: str, radius: float | None = None) -> Subject:
    """The same of a curve that has been read; ``radius`` [m] of its tip."""
    result = measured.fit(curve, radius)
    (scene, felt), rig = measured.scene_of(result), nt.Rig()
    rig["probe.spring_constant"] = result.spring_constant
    bent = float(scene.range.maximum_load) / result.spring_constant  # its sensor has seen that
    rig["probe.sensitivity"] = max(float(rig.probe.sensitivity), measured.ROOM * bent / float(rig.probe.range))
    assumed = f"; R = {in_words(result.radius, 'm', 3)} is assumed (--radius)" if result.assumed_tip else ""
    return Subject(name, name, scene, rig, _made_for(scene, name), f"{felt}{assumed}.",
                   "Touch what you have measured.", measured=measured.points_of(result),
                   accuracy=measured.accuracy_of(result))  # fmt: skip
