# SPDX-License-Identifier: BSD-3-Clause
"""Laws as ufuncs: numpy's rules, other libraries' arrays, and the same value whatever an element stands beside."""

from __future__ import annotations

import itertools
import pickle
import warnings
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from mpmath import mp, mpf, pi, sqrt
from nanotouch import ufuncs
from nanotouch.contact import BRANCHES, MODELS, TIERS, Contact, reduced
from nanotouch.errors import InvalidValue

R, E, W, S = 20e-9, 5e6, 0.05, 1e7
CONTACT = Contact(R, E, W, S)
PARAMETERS = {"hertz": (R, E), "dmt": (R, E, W), "jkr": (R, E, W), "maugis": (R, E, W, S)}
rng = np.random.default_rng(3)
DEPTHS = rng.uniform(-30e-9, 60e-9, 700)
EVERY = list(itertools.product(MODELS, BRANCHES, TIERS))


def ufunc(model: str, branch: str = "stable", tier: str = "exact", value: str = "force") -> np.ufunc:
    return ufuncs.contact_ufunc(model, value, branch, tier)


@pytest.mark.parametrize(("model", "branch", "tier"), EVERY)
def test_one_value_whatever_it_stands_beside(model: Any, branch: Any, tier: Any) -> None:
    """Alone, in an array of any length, strided, masked, through the prepared law and among four values: one number."""
    law, over = CONTACT.law(model, branch, tier), ufunc(model, branch, tier)
    expected = np.array([law.force(float(depth)) for depth in DEPTHS[:90]])
    for count in (1, 7, 64, 90):
        np.testing.assert_array_equal(over(DEPTHS[:count], *PARAMETERS[model]), expected[:count])
    long = nt.contact.force(model, DEPTHS, CONTACT, branch, tier=tier)
    np.testing.assert_array_equal(long[:90], expected)
    np.testing.assert_array_equal(over(DEPTHS[::-3], *PARAMETERS[model]), long[::-3])
    four = nt.contact.evaluate(model, DEPTHS, CONTACT, branch, tier=tier)
    np.testing.assert_array_equal(law.evaluate(float(DEPTHS[5])), [column[5] for column in four])
    # where all four are wanted, polishing takes a second step: the force agrees to rounding, not to the bit
    np.testing.assert_allclose(long, four.F, rtol=1e-13 if tier == "polished" else 0.0, atol=1e-14 * np.pi * W * R)
    for value in ("energy", "stiffness", "radius"):
        column = ufunc(model, branch, tier, value)(DEPTHS, *PARAMETERS[model])
        np.testing.assert_array_equal(column, getattr(four, {"energy": "U", "stiffness": "k", "radius": "a"}[value]))


@pytest.mark.parametrize("branch", ["", "_approach", "_unstable"])
def test_a_contact_for_every_element(branch: str) -> None:
    """Where every parameter changes, each element is that of its contact alone: errors, NaN, in place, too."""
    count = 700
    draw = np.random.default_rng(45).uniform
    radii, stresses = draw(5e-9, 50e-9, count), 10 ** draw(5, 9, count)
    works = np.where(np.arange(count) % 97 == 5, 0.0, draw(0.01, 0.1, count))
    over = getattr(ufuncs, f"maugis{branch}")
    four = over(DEPTHS[:count], radii, E, works, stresses)
    for value, column in zip(ufuncs.VALUES, four, strict=True):
        one = getattr(ufuncs, f"maugis_{value}{branch}")
        alone = [one(*row) for row in zip(DEPTHS[:count], radii, [E] * count, works, stresses, strict=True)]
        np.testing.assert_array_equal(column, alone)
        np.testing.assert_array_equal(
            one(DEPTHS[:count][::-2], radii[::-2], E, works[::-2], stresses[::-2]), alone[::-2]
        )
    depths = DEPTHS[:count].copy()
    getattr(ufuncs, f"maugis_force{branch}")(depths, radii, E, works, stresses, out=depths)
    np.testing.assert_array_equal(depths, four[1])
    lams = 10 ** draw(-3, 3, count)
    lams[40], depths = np.nan, draw(-1, 9, count)
    depths[50] = np.nan
    in_units = getattr(ufuncs, f"reduced_force{branch}")
    np.testing.assert_array_equal(in_units(lams, depths), [in_units(*row) for row in zip(lams, depths, strict=True)])
    with pytest.raises(InvalidValue, match="lam = -1"):
        in_units(np.where(np.arange(count) == 300, -1.0, lams), depths)
    with pytest.raises(InvalidValue, match="radius"):
        over(DEPTHS[:count], np.where(np.arange(count) == 300, 7.0, radii), E, works, stresses)


def test_jkr_in_every_tier_against_mpmath() -> None:
    """delta(a) and F(a) of the textbook at 40 digits, away from the fold; the bounds are those of the tiers."""
    with mp.workdps(40):
        K = mpf(4) / 3 * E
        radii = [mpf(R) * (mpf(6) / 10 + mpf(i) / 10) for i in range(30)]
        depths = np.array([float(a**2 / R - sqrt(8 * pi * W * a / (3 * K))) for a in radii])
        loads = np.array([float(K * a**3 / R - sqrt(6 * pi * W * K * a**3)) for a in radii])
    scale = np.maximum(np.abs(loads), 1.5 * np.pi * W * R)
    for tier, bound in (("exact", 1e-14), ("polished", 1e-13), ("table", 1.5e-6)):
        found = ufunc("jkr", tier=tier)(depths, R, E, W)
        assert np.max(np.abs(found - loads) / scale) < bound, tier


@pytest.mark.parametrize("model", MODELS)
def test_every_argument_broadcasts(model: str) -> None:
    radius, modulus = R * np.linspace(0.5, 2.0, 3)[:, None], E * np.array([1.0, 3.0, 1.0, 2.0])
    rest = tuple(np.asarray(value) * np.ones(4) for value in PARAMETERS[model][2:])
    found = ufunc(model)(10e-9, radius, modulus, *rest)
    assert found.shape == (3, 4)
    for i, j in np.ndindex(3, 4):
        made = Contact(float(radius[i, 0]), float(modulus[j]), W, S)
        assert found[i, j] == nt.contact.force(model, 10e-9, made)  # type: ignore[arg-type]


def test_reduced_is_the_contact_in_its_units() -> None:
    lam = np.array([[0.1], [1.0], [30.0]])
    d = np.linspace(-1.5, 8.0, 40)
    for tier in TIERS:
        found = reduced.force(lam, d, tier=tier)
        for i in range(3):  # a contact whose units are 1
            one = Contact(1.0, 0.75, 1 / np.pi, cohesive_stress=0.5 * float(lam[i, 0]))
            np.testing.assert_allclose(found[i], nt.contact.force("maugis", d, one, tier=tier), rtol=1e-12, atol=1e-12)
    repeated = np.tile(lam.ravel(), 50)
    every = rng.uniform(0.0, 5.0, 150)
    np.testing.assert_array_equal(reduced.force(repeated, every), ufuncs.reduced_force(repeated, every))
    assert np.isnan(ufuncs.reduced_force([1.0, np.nan], 0.5)).tolist() == [False, True]


@pytest.mark.parametrize("model", MODELS)
def test_out_and_where(model: Any) -> None:
    whole = nt.contact.force(model, DEPTHS, CONTACT)
    out = np.full((2, 700), 7.0)[:, ::2]
    assert nt.contact.force(model, DEPTHS[:350], CONTACT, out=out[0]) is not None
    np.testing.assert_array_equal(out[0], whole[:350])
    assert (out[1] == 7.0).all()
    mask = rng.random(700) < 0.5
    np.testing.assert_array_equal(nt.contact.force(model, DEPTHS, CONTACT, where=mask), np.where(mask, whole, np.nan))
    kept = np.full(700, 7.0)
    assert nt.contact.force(model, DEPTHS, CONTACT, out=kept, where=mask) is kept
    np.testing.assert_array_equal(kept, np.where(mask, whole, 7.0))
    place = DEPTHS.copy()  # in place, and one beside the other
    np.testing.assert_array_equal(nt.contact.force(model, place, CONTACT, out=place), whole)
    shifted = np.append(DEPTHS, 0.0)
    np.testing.assert_array_equal(ufunc(model)(shifted[:-1], *PARAMETERS[model], out=shifted[1:]), whole)
    with pytest.raises(ValueError, match="broadcast"):
        nt.contact.force(model, DEPTHS, CONTACT, out=np.empty(3))


def test_types() -> None:
    over = ufunc("jkr")
    single = DEPTHS.astype(np.float32)
    assert over(single, *PARAMETERS["jkr"]).dtype == np.float64
    np.testing.assert_array_equal(over(single, *PARAMETERS["jkr"]), over(single.astype(float), *PARAMETERS["jkr"]))
    assert over(1, 1, 3, 0) == over(1.0, 1.0, 3.0, 0.0) == 4.0
    for wrong in (1j * DEPTHS, DEPTHS.astype(str), np.array([None])):
        with pytest.raises(TypeError):
            over(wrong, *PARAMETERS["jkr"])
    record = np.zeros(50, dtype=[("tag", "i4"), ("depth", "f8"), ("more", "i2")])  # strides of 14 bytes
    record["depth"] = DEPTHS[:50]
    np.testing.assert_array_equal(over(record["depth"], *PARAMETERS["jkr"]), over(DEPTHS[:50], *PARAMETERS["jkr"]))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: ufuncs.jkr_force(DEPTHS, -1.0, E, W), ["radius = -1 m", "1e-10 .. 1 m"]),
        (lambda: ufuncs.dmt(1e-9, R, np.array([E, np.inf]), W), ["effective_modulus = inf Pa"]),
        (lambda: ufuncs.maugis_force(DEPTHS, R, E, W, np.append(np.ones(699), -1.0)), ["cohesive_stress = -1 Pa"]),
        (lambda: ufuncs.reduced_force(-1.0, DEPTHS), ["lam = -1", "1e-15"]),
        (lambda: ufuncs.vdw_force(DEPTHS, R, 1e-19, 0.0, 0.0), ["minimum_gap = 0 m"]),
        (lambda: nt.forces.vdw(DEPTHS, radius=np.array([[R], [5.0]]), hamaker_constant=1e-19), ["radius = 5 m"]),
    ],
)
def test_bad_parameters_are_named(call: Any, words: list[str]) -> None:
    with pytest.raises(InvalidValue) as caught:
        call()
    assert all(word in str(caught.value) for word in words), caught.value


def test_nothing_warns() -> None:
    """NaN and what lies beyond a branch are answers, not accidents of floating point."""
    depths = np.array([np.nan, -np.inf, np.inf, -1e300, 1e300, 0.0, -0.0, 5e-324, 1e-9] * 30)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for model, branch, tier in EVERY:
            found = nt.contact.force(model, depths, CONTACT, branch, tier=tier)
            assert np.isnan(found[0])
        nt.forces.vdw(depths, radius=R, hamaker_constant=1e-19)


def test_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    depth = xarray.DataArray(DEPTHS[:60].reshape(3, 20), dims=("y", "x"), coords={"y": [1, 2, 4]})
    force = nt.contact.force("jkr", depth, CONTACT, tier="polished")
    assert force.dims == ("y", "x")
    assert list(force.y) == [1, 2, 4]
    np.testing.assert_array_equal(force.values, nt.contact.force("jkr", depth.values, CONTACT, tier="polished"))
    radius = xarray.DataArray([R, 2 * R], dims="tip")
    both = ufuncs.hertz_force(depth, radius, E)
    assert both.dims == ("y", "x", "tip")
    np.testing.assert_array_equal(both[..., 1], ufuncs.hertz_force(depth.values, 2 * R, E))
    vdw = nt.forces.vdw(1e-9 + abs(depth), radius=radius, hamaker_constant=1e-19)
    assert vdw.F.dims == vdw.a.dims == ("y", "x", "tip")
    in_nm = depth.assign_attrs(units="nm")
    with pytest.raises(TypeError, match="carries a unit"):
        nt.contact.force("jkr", in_nm, CONTACT)


def test_dask_stays_lazy() -> None:
    dask = pytest.importorskip("dask.array")
    depth = dask.from_array(DEPTHS, chunks=90)
    for tier in TIERS:
        force = nt.contact.force("maugis", depth, CONTACT, tier=tier)
        assert isinstance(force, dask.Array)
        np.testing.assert_array_equal(force.compute(), nt.contact.force("maugis", DEPTHS, CONTACT, tier=tier))
    values = nt.contact.evaluate("jkr", depth, CONTACT)
    np.testing.assert_array_equal(values.k.compute(), nt.contact.evaluate("jkr", DEPTHS, CONTACT).k)
    steric = nt.forces.steric(dask.absolute(depth), radius=R, thickness=5e-9, spacing=1e-9)
    assert isinstance(steric.F, dask.Array)
    assert (steric.a.compute() == 0.0).all()


def test_pandas() -> None:
    pandas = pytest.importorskip("pandas")
    depth = pandas.Series(DEPTHS[:10], index=list("abcdefghij"), name="depth")
    force = nt.contact.force("dmt", depth, CONTACT)
    assert list(force.index) == list("abcdefghij")
    np.testing.assert_array_equal(force.to_numpy(), nt.contact.force("dmt", DEPTHS[:10], CONTACT))


def test_names_and_pickles() -> None:
    assert ufuncs.maugis_force_approach_table.__name__ == "maugis_force_approach_table"
    assert ufuncs.jkr.nout == 4
    assert (ufuncs.hertz_force.nin, ufuncs.maugis.nin, ufuncs.reduced.nin, ufuncs.vdw_tip.nin) == (3, 5, 2, 7)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy looks for the name in every module, deprecated ones too
        assert pickle.loads(pickle.dumps(ufuncs.jkr_force_table)) is ufuncs.jkr_force_table
    assert pickle.loads(pickle.dumps(CONTACT)) == CONTACT
    with pytest.raises(AttributeError, match="jkr_froce"):
        ufuncs.jkr_froce  # noqa: B018
    with pytest.raises(InvalidValue, match="valid are table, polished, exact"):
        nt.contact.force("jkr", 1e-9, CONTACT, tier="fast")  # type: ignore[arg-type]


def test_threads_have_their_own_tables() -> None:
    """Each thread keeps the last laws that it made; more contacts than it keeps, from many threads at once."""
    contacts = [Contact(R * factor, E, W, S) for factor in np.linspace(1.0, 3.0, 9)]
    expected = [nt.contact.force("maugis", DEPTHS, one, tier="table") for one in contacts]

    def work(seed: int) -> bool:
        order = np.random.default_rng(seed).permutation(9)
        found = {int(i): nt.contact.force("maugis", DEPTHS, contacts[i], tier="table") for i in order}
        return all(np.array_equal(found[i], expected[i]) for i in range(9))

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(work, range(16)))
