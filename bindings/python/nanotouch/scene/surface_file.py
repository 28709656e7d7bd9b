# SPDX-License-Identifier: BSD-3-Clause
"""A surface by the names of its files: heights of an image, and what the sample is made of from channels of that image,
of another file or of a fitted map. As a table of a TOML file::

    [surface]
    image = "film.ibw"                    # heights; beside the TOML file, or an absolute path
    youngs_modulus = "DMTModulus"         # a channel of it
    pull_off_force = "Adhesion"
    pull_off_force_unit = "nN"            # where the file states none
    fill_by = "neighbours"                # pixels without a value; else they are refused
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from nanotouch import images
from nanotouch._io.digest import file_digest
from nanotouch._io.words import shortened, told
from nanotouch.errors import InvalidValue
from nanotouch.images.values import QUANTITIES, Fill
from nanotouch.scene import Scene
from nanotouch.scene.description import as_table
from nanotouch.scene.surface import Surface
from nanotouch.units import in_words, parse_quantity

_SI = {"youngs_modulus": "Pa", "effective_modulus": "Pa", "work_of_adhesion": "J/m^2", "pull_off_force": "N"}
_TEXTS = ("image", "channel", "level", "pixel_size", "z_unit", "file", "fill_by")


@dataclass(frozen=True)
class SurfaceFile:
    """What files a surface is read from.

    Attributes
    ----------
    image : str
        Of the heights: an AFM image, or a fitted map (``map.nc``), whose contact points are not dilated again.
    channel : str, optional
        Of the heights.
    level : str
        How the image is levelled, see :func:`nanotouch.images.prepare`.
    pixel_size : float or (float, float), optional
        ``(dy, dx)`` [m] of an image that states none; in a TOML file a text, ``"10nm"``.
    z_unit : str, optional
        Unit of the heights of an image that states none.
    file : str, optional
        That holds the channels of `properties`; by default the image.
    properties : mapping
        Channel of each quantity: ``youngs_modulus`` or ``effective_modulus``, ``work_of_adhesion`` or
        ``pull_off_force``. A pull-off force becomes the w with which the scene's tip pulls off with it.
    units : mapping
        Of quantities whose file states none.
    fill_by : {"neighbours", "median"}, optional
        What pixels without a value get; without it they are refused.
    digests : mapping
        SHA-256 of the files by their names; where given, another content is refused.
    untrusted : bool, optional
        Open them in a guarded worker process.
    """

    image: str
    channel: str | None = None
    level: str = "auto"
    pixel_size: float | tuple[float, float] | None = None
    z_unit: str | None = None
    file: str | None = None
    properties: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    fill_by: Fill | None = None
    digests: Mapping[str, str] = field(default_factory=dict)
    untrusted: bool | None = None

    def __post_init__(self) -> None:
        for name in (*self.properties, *self.units):
            if name not in QUANTITIES:
                raise InvalidValue(f"[surface] has no quantity {name!r}; it has {', '.join(QUANTITIES)}")
        for name in self.units:
            if name not in self.properties:
                raise InvalidValue(f"[surface] {name}_unit = {self.units[name]!r}: no channel is named for {name}")

    @classmethod
    def from_tables(cls, tables: Mapping[str, Any], folder: Path | None = None) -> SurfaceFile | None:
        """The table ``surface`` of a TOML file, its paths beside that file; None where there is none."""
        if "surface" not in tables:
            return None
        given: dict[str, str] = {}
        for key, value in as_table("surface", tables["surface"]).items():
            known = (*_TEXTS, *QUANTITIES, *(f"{name}_unit" for name in QUANTITIES))
            if key not in known:
                raise InvalidValue(f"[surface] has no key {shortened(key)}; it has {', '.join(known)}")
            if not isinstance(value, str):
                raise InvalidValue(f"[surface] {key} = {told(value)}: it must be a text")
            given[key] = value
        if "image" not in given:
            raise InvalidValue("[surface] lacks image, the file of its heights")
        units: dict[str, str] = {name: given.pop(f"{name}_unit") for name in QUANTITIES if f"{name}_unit" in given}
        properties: dict[str, str] = {name: given.pop(name) for name in QUANTITIES if name in given}
        for key in ("image", "file"):
            if folder is not None and key in given:
                given[key] = str(folder / given[key])
        texts: dict[str, Any] = {**given}
        if "pixel_size" in given:
            texts["pixel_size"] = parse_quantity(given["pixel_size"], "m")
        return cls(**texts, properties=properties, units=units)

    def touched_by(self, scene: Scene, most_pixels: int | None = None) -> Surface:
        """Read, levelled, dilated by the tip of a scene, with what the sample is made of.

        ``surface.origin`` is this, with digests, and ``surface.notes`` says what reading did. Images of more pixels to
        a side than `most_pixels` are averaged.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the notes hold them
            topography, notes = self._heights(scene)
        if most_pixels is not None and max(topography.shape) > most_pixels:
            topography = _coarser(topography, most_pixels)
        maps = {
            name: images.read_values(
                self._checked(self._property_file), channel, name,  # type: ignore[arg-type]
                unit=self.units.get(name), fill_by=self.fill_by, untrusted=self.untrusted,
            )
            for name, channel in self.properties.items()
        }  # fmt: skip
        surface = Surface.touched_by(scene, topography, is_dilated=self._is_map, **maps)  # type: ignore[arg-type]
        digests = {name: file_digest(name) for name in {self.image, *([self._property_file] if maps else [])}}
        surface.origin = asdict(replace(self, digests=digests))
        surface.notes = (*notes, *map(_line, maps.values()))
        return surface

    @property
    def _property_file(self) -> str:
        return self.image if self.file is None else self.file

    @property
    def _is_map(self) -> bool:
        return Path(self.image).suffix.lower() == ".nc"

    def _heights(self, scene: Scene) -> tuple[images.Topography, list[str]]:
        """And what was done to them."""
        path = self._checked(self.image)
        if self._is_map:
            from nanotouch import maps  # its extra is needed for maps only

            return maps.to_surface(maps.read(path), scene, fill_by=self.fill_by).topography, []
        raw = images.read(path, self.channel, pixel_size=self.pixel_size, z_unit=self.z_unit, untrusted=self.untrusted)
        topography, reports = images.prepare(raw, self.level)
        filled = [f"{raw.masked_pixels} missing pixels filled from their neighbours"] * bool(raw.masked_pixels)
        return topography, [*filled, *(f"note: {note}" for note in raw.notes), *map(str, reports)]

    def _checked(self, name: str) -> Path:
        """Its path, unless it holds something else than when its digest was taken."""
        expected = self.digests.get(name)
        if expected is not None and file_digest(name) != expected:
            raise InvalidValue(f"{name}: it has changed since (its SHA-256 is not {expected[:12]}...)")
        return Path(name)


def _coarser(topography: images.Topography, most: int) -> images.Topography:
    level = next(one for one in images.mip_levels(topography, smallest=1) if max(one.mean.shape) <= most)
    return images.Topography(heights=level.mean, pixel_size=level.pixel_size, name=topography.name)


def _line(found: images.ValueMap) -> str:
    unit = _SI[found.quantity]
    low, high = (in_words(float(one), unit, 3) for one in (found.values.min(), found.values.max()))
    notes = "".join(f"; {note}" for note in found.notes)
    return f"{found.quantity.replace('_', ' ')}: {low} .. {high}, channel {found.channel!r} of {found.name}{notes}"
