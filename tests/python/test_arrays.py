# SPDX-License-Identifier: BSD-3-Clause
"""Arrays at the edge: scalar in, scalar out; any shape; NaN stays NaN; masks and units are refused."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.contact import MODELS, Contact, evaluate

CONTACT = Contact(radius=20e-9, effective_modulus=76.9e9, work_of_adhesion=0.144, cohesive_range=1.2e-9)
SURFACE = nt.Surface(nt.Topography(1e-9 * np.random.default_rng(1).random((8, 9)), (1e-9, 1e-9)))
PLAN = nt.Scene().plan()


def contact_law(model: str) -> Callable[[Any], Any]:
    return lambda x: evaluate(model, x, CONTACT).F  # type: ignore[arg-type]


LAWS: dict[str, Callable[[Any], Any]] = {model: contact_law(model) for model in MODELS} | {
    "indentation": lambda x: nt.contact.indentation("maugis", x, CONTACT),
    "cone": lambda x: nt.contact.cone(x, 1e9, 0.3).F,
    "punch": lambda x: nt.contact.punch(x, 1e9, 1e-8).F,
    "vdw": lambda x: nt.forces.vdw(x, radius=2e-8, hamaker_constant=1e-19).F,
    "capillary": lambda x: nt.forces.capillary(x, radius=2e-8, meniscus_radius=1e-9).F,
    "electrostatic": lambda x: nt.forces.electrostatic(x, radius=2e-8, potential=0.2).F,
    "height": lambda x: SURFACE.height(x, 3e-9),
    "plan": lambda x: PLAN.force(x),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())


@every_law
def test_scalar_gives_float(law: Callable[[Any], Any]) -> None:
    for scalar in (1e-9, np.float64(1e-9), np.array(1e-9), 0):
        assert type(law(scalar)) is float


@every_law
@pytest.mark.parametrize("shape", [(0,), (1,), (3,), (2, 0), (2, 3), (1, 2, 3)])
def test_shape_is_kept(law: Callable[[Any], Any], shape: tuple[int, ...]) -> None:
    result = law(np.full(shape, 1e-9))
    assert result.shape == shape
    assert result.dtype == np.float64


@every_law
def test_element_by_element(law: Callable[[Any], Any]) -> None:
    values = np.linspace(-1e-9, 2e-9, 12)
    expected = [law(float(value)) for value in values]
    if law is LAWS["plan"]:  # a path: it has a history
        expected = list(PLAN.force(list(values)))
    np.testing.assert_array_equal(law(values), expected)
    np.testing.assert_array_equal(law(values.reshape(3, 4)), np.reshape(expected, (3, 4)))
    np.testing.assert_array_equal(law(values.reshape(3, 4).T.copy().T), np.reshape(expected, (3, 4)))  # Fortran order
    np.testing.assert_array_equal(law(np.repeat(values, 2)[::2]), expected)  # strided
    np.testing.assert_array_equal(law(list(values)), expected)


@every_law
def test_nan_gives_nan(law: Callable[[Any], Any]) -> None:
    assert np.isnan(law(float("nan")))
    result = law(np.array([1e-9, np.nan, 2e-9]))
    np.testing.assert_array_equal(np.isnan(result), [False, True, False])


@every_law
def test_integers_and_single_precision_are_widened(law: Callable[[Any], Any]) -> None:
    assert law(np.zeros(2, dtype=np.int32)).dtype == np.float64
    single = np.array([1e-9, 2e-9], dtype=np.float32)
    np.testing.assert_array_equal(law(single), law(single.astype(np.float64)))


class Quantity:
    """Stands for pint, unyt (``units``)."""

    units = "nm"

    def __array__(self, *_: Any, **__: Any) -> Any:
        return np.array([1.0])


class AstropyQuantity(Quantity):
    """Stands for astropy (``unit``)."""

    unit = "nm"
    units = property()  # type: ignore[assignment]


REFUSED = {
    "masked": np.ma.array([1e-9, 2e-9], mask=[True, False]),
    "masked without mask": np.ma.array([1e-9]),
    "units": Quantity(),
    "unit": AstropyQuantity(),
    "object": np.array([1e-9, None]),
    "huge integer": 10**30,
    "complex": np.array([1e-9 + 0j]),
    "bool": np.array([True]),
    "text": "1e-9",
    "time": np.array(["2020-01-01"], dtype="datetime64[D]"),
    "matrix": np.array([[1e-9]]).view(np.matrix),
    "None": None,
}


@pytest.mark.parametrize("values", REFUSED.values(), ids=REFUSED.keys())
def test_what_is_not_plain_numbers_is_refused(values: Any) -> None:
    for call in (
        lambda: nt.contact.force("hertz", values, CONTACT),
        lambda: nt.contact.indentation("hertz", values, CONTACT),
        lambda: nt.forces.vdw(values, radius=2e-8, hamaker_constant=1e-19),
        lambda: SURFACE.height(values, 0.0),
        lambda: PLAN.force(values),
    ):
        with pytest.raises(TypeError, match=r"indentation|force|gap|x "):
            call()


def test_the_input_is_not_written_to() -> None:
    values = np.linspace(0, 1e-9, 5)
    values.flags.writeable = False
    before = values.copy()
    for law in LAWS.values():
        law(values)
    np.testing.assert_array_equal(values, before)


def test_threads_share_laws_and_surfaces() -> None:
    """The GIL is released, const objects are shared: what comes out is what one thread computes."""
    values = np.linspace(-2e-9, 3e-9, 20_000)
    expected = {name: law(values) for name, law in LAWS.items()}
    jobs = list(LAWS) * 4
    with ThreadPoolExecutor(8) as pool:
        results = list(pool.map(lambda name: LAWS[name](values), jobs))
    for name, result in zip(jobs, results, strict=True):
        np.testing.assert_array_equal(result, expected[name])
