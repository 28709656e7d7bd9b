# SPDX-License-Identifier: BSD-3-Clause
"""One door for arrays: what lies under a mask, or carries a unit, is refused and never used; order and strides are
honoured. No function converts an array that it is given by itself."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.curves import Segment, thermal_tune

PACKAGE = Path(nt.__file__).parent
CONVERSIONS = ("asarray", "ascontiguousarray", "asanyarray", "array", "atleast_1d", "asfarray")
OF_THEIR_OWN = {
    ("_arrays.py", "as_floats"),  # the door itself
    ("_arrays.py", "as_mask"),
    ("_io/transfer.py", "_flattened"),  # what a reader made
    ("images/topography.py", "_frozen"),  # of other types too; the door's refusals before
    ("manipulation/pushing.py", "_done"),  # its own track
    ("maps/touched.py", "_filled"),  # of a map that a fit has made
    ("touch/columns.py", "_converted"),  # integers too; refuses masks and units in its own words
    ("touch/sessions.py", "_values"),  # names of choices too; the door's refusals before
    ("units.py", "engineering"),  # picks a prefix for a text
}


def direct_conversions(source: str) -> Iterator[tuple[str, str, int]]:
    """Function, argument and line: where a parameter goes into numpy directly, whatever it is said to be."""
    for function in ast.walk(ast.parse(source)):
        if not isinstance(function, ast.FunctionDef):
            continue
        every = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
        given = {one.arg for one in every if one.arg not in ("self", "cls")}
        for call in ast.walk(function):
            if (
                isinstance(call, ast.Call)
                and isinstance(call.func, ast.Attribute)
                and ast.unparse(call.func.value) in ("np", "numpy")
                and call.func.attr in CONVERSIONS
                and call.args
                and isinstance(call.args[0], ast.Name)
                and call.args[0].id in given
            ):
                yield function.name, call.args[0].id, call.lineno


def test_every_array_goes_through_the_door() -> None:
    bypasses = [
        f"{file.relative_to(PACKAGE)}:{line}: {function}({argument})"
        for file in sorted(PACKAGE.rglob("*.py"))
        for function, argument, line in direct_conversions(file.read_text(encoding="utf-8"))
        if (file.relative_to(PACKAGE).as_posix(), function) not in OF_THEIR_OWN
    ]
    assert bypasses == []


def test_the_check_finds_a_bypass() -> None:
    source = (
        "def f(x: Any, y: Floats) -> None:\n    z = 1\n    np.asarray(z)\n    np.asarray(y)\n    np.array(x, float)\n"
    )
    assert list(direct_conversions(source)) == [("f", "y", 4), ("f", "x", 5)]


class Quantity:
    """As of pint: an array with a unit."""

    units = "nm"

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.asarray(self.values, dtype=dtype)


X = np.linspace(0.0, 100e-9, 200)
F = 1e-9 * (np.linspace(0.0, 1.0, 200)) ** 1.5
FREQUENCY = np.linspace(50e3, 70e3, 400)
RATIO = FREQUENCY / 60e3
SCATTER = np.random.default_rng(1).gamma(20.0, 1.0 / 20.0, 400)
DENSITY = SCATTER * (1e-25 / ((RATIO**2 - 1.0) ** 2 + (RATIO / 50.0) ** 2) + 1e-25)

TAKERS: dict[str, tuple[Callable[[Any], Any], np.ndarray]] = {
    "fit_points position": (lambda v: nt.fit.fit_points(v, F, radius=1e-6).values["effective_modulus"], X),
    "fit_points force": (lambda v: nt.fit.fit_points(X, v, radius=1e-6).values["effective_modulus"], F),
    "Segment z": (lambda v: Segment("approach", X, v, "height (measured)", F).z.sum(), X),
    "Segment force": (lambda v: Segment("approach", X, X, "height (measured)", v).force.sum(), F),
    "thermal_tune density": (lambda v: thermal_tune(FREQUENCY, v, averages=20).spring_constant, DENSITY),
    "sokolov indentation": (
        lambda v: nt.fit.sokolov.force_of(v, 1e-6, 1e4, 1e-6, 100.0).sum(),
        X,
    ),
    "thermal_tune frequency": (lambda v: thermal_tune(v, DENSITY, averages=20).spring_constant, FREQUENCY),
}


@pytest.mark.parametrize("name", TAKERS)
def test_masks_and_units_are_refused_order_and_strides_are_not(name: str) -> None:
    take, values = TAKERS[name]
    mask = np.arange(len(values)) % 50 == 7
    with pytest.raises(TypeError, match=f"{name.split()[1]} is a masked array"):
        take(np.ma.masked_array(np.where(mask, 5e-8, values), mask=mask))
    with pytest.raises(TypeError, match="carries a unit"):
        take(Quantity(values))
    right = take(values)
    apart = np.repeat(values, 3)[::3]
    assert not apart.flags.c_contiguous
    for same in (values.astype(">f8"), apart, values[::-1].copy()[::-1], list(values)):
        assert take(same) == right


RAMP = np.concatenate([np.linspace(1e-6, 0.0, 64), np.linspace(0.0, 1e-6, 64)])
FORCES = np.zeros((1, 1, 128))
HEIGHTS = np.random.default_rng(2).normal(size=(16, 16)) * 1e-9
IMAGES: dict[str, tuple[Callable[[Any], Any], np.ndarray]] = {
    "volume": (lambda v: nt.maps.fit(v, "hertz", radius=1e-6, z=RAMP, spring_constant=0.1), FORCES),
    "z of a volume": (lambda v: nt.maps.fit(FORCES, "hertz", radius=1e-6, z=v, spring_constant=0.1), RAMP),
    "topography": (lambda v: nt.Topography(v, (1e-9, 1e-9)), HEIGHTS),
    "mask of levelling": (
        lambda v: nt.images.level(nt.Topography(HEIGHTS, (1e-9, 1e-9)), "plane", mask=v),
        HEIGHTS > 1e-9,
    ),
    "tip": (
        lambda v: nt.images.dilate(nt.Topography(HEIGHTS, (1e-9, 1e-9)), v),
        np.abs(np.mgrid[-1:2, -1:2]).sum(0) * 1e-9,
    ),
    "pixel size": (lambda v: nt.images.reading.checked_pixel_size(v), np.array([1e-9, 1e-9])),
    "target": (lambda v: nt.manipulation.push(nt.manipulation.latex(5e-7), v, most=1), np.array([1e-7, 0.0])),
}


@pytest.mark.parametrize("name", IMAGES)
def test_maps_images_and_paths_refuse_masks_and_units(name: str) -> None:
    take, values = IMAGES[name]
    pytest.importorskip("xarray")
    pytest.importorskip("cv2")
    with pytest.raises((TypeError, nt.Error), match="mask"):
        take(np.ma.masked_array(values, mask=np.zeros(values.shape, bool)))
    if name not in ("volume", "z of a volume"):  # what only carries numbers there has no shape
        with pytest.raises((TypeError, nt.Error), match="carries a unit"):
            take(Quantity(values))


@pytest.mark.parametrize(("key", "value"), [("units", "mN"), ("scale_factor", 0.1)])
def test_what_an_hdf5_dataset_states_is_not_lost(key: str, value: object, tmp_path: Path) -> None:
    """Its unit was: E* came out 1e3 times too large, marked ok."""
    h5py = pytest.importorskip("h5py")
    pytest.importorskip("xarray")
    with h5py.File(tmp_path / "v.h5", "w") as file:
        file["force"] = np.zeros((2, 2, 40))
        file["force"].attrs[key] = value
        with pytest.raises(TypeError, match=f"states {key} = {value}"):
            nt.maps.fit(file["force"], "hertz", radius=1e-6, z=np.zeros(40), spring_constant=1.0)
