# SPDX-License-Identifier: BSD-3-Clause
"""A sphere on an elastic half-space under the Lennard-Jones law, self-consistent: the surface deforms under the very
attraction that its shape decides. Its curves depend on Tabor's mu alone and are shipped as a table made by
``tools/lennard_jones``.

Units are Maugis': load in pi w R, indentation in (pi^2 w^2 R/K^2)^(1/3), K = 4/3 E*. Indentation 0 puts the undeformed
apex at z0 from the surface, the gap at which half-spaces neither attract nor repel; force + repulsive.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from importlib import resources
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import contact
from nanotouch._arrays import Floats, as_floats, plain
from nanotouch.errors import InvalidValue

Branch = Literal["stable", "approach"]
Quantity = Literal["force", "pull_off"]

#: largest attraction between half-spaces, in w/z0: the cohesive stress that Maugis-Dugdale is given
PEAK_STRESS = 16.0 / (9.0 * math.sqrt(3.0))
#: Maugis' lambda over Tabor's mu, 1.1570
LAMBDA_PER_MU = 2.0 * PEAK_STRESS * (9.0 / (16.0 * math.pi)) ** (1.0 / 3.0)
#: (pi^2 w^2 R/K^2)^(1/3) over mu z0
_INDENTATION_PER_MU = (9.0 * math.pi**2 / 16.0) ** (1.0 / 3.0)


class TableError(NamedTuple):
    """How far curves of the table are from computed ones, as the generator measured and wrote into the table.

    Each is the largest distance of two curves in the plane of d and ``P/max(|P|, |P_pull-off|)``.
    """

    every_second_mu_left_out: float
    independent: float
    """at mu, and at points along the curves, that are not in the table: the error of what this module returns"""


class _Table(NamedTuple):
    mu: Floats
    q: Floats
    values: Floats
    """d, P, dd/dq, dP/dq [mu, q, 4]"""
    error: TableError


@functools.cache
def _table() -> _Table:
    table = resources.files("nanotouch.reference").joinpath("lennard_jones.csv")
    lines = table.read_text(encoding="ascii").splitlines()
    notes = dict(line[2:].split(":", 1) for line in lines if line.startswith("#") and ":" in line)
    mu, q = (np.array(notes[name].split(), dtype=np.float64) for name in ("mu (slowest)", "q"))
    error = TableError(
        float(notes["error with every second mu left out"]), float(notes["error at independent mu and q"])
    )
    return _Table(mu, q, np.loadtxt(lines, delimiter=",").reshape(mu.size, q.size, 4), error)


@dataclass(frozen=True)
class LennardJones:
    """The curve of one mu, from far away through both folds to deep contact, in Maugis' units."""

    mu: float
    """Tabor's parameter (R w^2/(E*^2 z0^3))^(1/3)"""
    q: Floats
    """what the curve is interpolated in; grows from far away to deep contact [n]"""
    d: Floats
    """indentation at q [n]"""
    P: Floats
    """load at q [n]"""
    d_slope: Floats
    """dd/dq [n]"""
    P_slope: Floats
    """dP/dq [n]"""

    def at(self, q: ArrayLike) -> tuple[Floats, Floats]:
        """Indentation and load at any q of the curve: cubics between the entries."""
        q = as_floats(q, "q")
        step = (self.q[-1] - self.q[0]) / (self.q.size - 1)
        i = np.clip(((q - self.q[0]) / step).astype(np.intp), 0, self.q.size - 2)
        t = (q - self.q[i]) / step

        def cubic(f: Floats, slope: Floats) -> Floats:
            rise, left, right = f[i + 1] - f[i], step * slope[i], step * slope[i + 1]
            return np.asarray(
                f[i] + t * (left + t * (3.0 * rise - 2.0 * left - right + t * (left + right - 2.0 * rise)))
            )

        return cubic(self.d, self.d_slope), cubic(self.P, self.P_slope)

    def _turns(self, f: Floats, slope: Floats) -> Floats:
        """All q where the slope of the cubics is 0 and changes sign."""
        step = (self.q[-1] - self.q[0]) / (self.q.size - 1)
        i = np.flatnonzero(slope[:-1] * slope[1:] < 0.0)
        rise, left, right = f[i + 1] - f[i], step * slope[i], step * slope[i + 1]
        a, b = 3.0 * (left + right - 2.0 * rise), 3.0 * rise - 2.0 * left - right  # a t^2 + 2 b t + left = 0
        root = np.sqrt(b * b - a * left)
        t = np.where(left > 0.0, -left / (b - root), -left / (b + root))  # the only root in 0..1
        return np.asarray(self.q[i] + t * step)

    @functools.cached_property
    def _folds(self) -> tuple[float, float]:
        """q of jump-in and jump-out under grips; without hysteresis both are the last q at which nothing jumps."""
        turns = self._turns(self.d, self.d_slope)
        return (float(turns[0]), float(turns[-1])) if turns.size else (float(self.q[0]), float(self.q[0]))

    @property
    def hysteresis(self) -> bool:
        """Whether the tip jumps under grips (mu above 0.7)."""
        return self._folds[0] < self._folds[1]

    @functools.cached_property
    def pull_off_load(self) -> float:
        """The lowest load, under load control: between -2 (Bradley, mu to 0) and -1.5 (JKR)."""
        return float(self.at(self._pull_off_q)[1])

    @functools.cached_property
    def pull_off_indentation(self) -> float:
        """Where the load is lowest."""
        return float(self.at(self._pull_off_q)[0])

    @functools.cached_property
    def _pull_off_q(self) -> float:
        turns = self._turns(self.P, self.P_slope)
        return float(turns[np.argmin(self.at(turns)[1])])

    @property
    def jump_in(self) -> float:
        """Indentation (negative) at which the approaching tip jumps, under grips; NaN without hysteresis."""
        return float(self.at(self._folds[0])[0]) if self.hysteresis else math.nan

    @property
    def jump_out(self) -> float:
        """Indentation (negative) at which the retracted tip lets go, under grips; NaN without hysteresis."""
        return float(self.at(self._folds[1])[0]) if self.hysteresis else math.nan

    @functools.cached_property
    def zero_load_indentation(self) -> float:
        """Indentation in contact at no load."""
        return float(self.indentation(0.0))

    def indentation(self, load: ArrayLike) -> Any:
        """Indentation in contact at a load between the pull-off load and the end of the curve."""
        load = as_floats(load, "load")
        self._check(load, "load", self.pull_off_load, float(self.P[-1]))
        return plain(self.at(self._invert(1, load, self._pull_off_q, float(self.q[-1])))[0])

    def force(self, indentation: ArrayLike, branch: Branch = "stable") -> Any:
        """Load at an indentation under grips: on retraction from contact (``"stable"``) or on ``"approach"``.

        Farther away than the curve reaches (centre gaps above 30 z0) the load is that of rigid bodies.
        """
        if branch not in get_args(Branch):
            raise InvalidValue(f"branch {branch!r}: valid are {', '.join(get_args(Branch))}")
        d = as_floats(indentation, "indentation")
        self._check(d, "indentation", -math.inf, float(self.d[-1]))
        q_in, q_out = self._folds
        apart = d < self.at(q_out if branch == "stable" else q_in)[0]
        inside = self._invert(0, d, q_out, float(self.q[-1]))
        outside = self._invert(0, d, float(self.q[0]), q_in)
        load = self.at(np.where(apart, outside, inside))[1]
        gap = 1.0 - np.minimum(d, self.d[0]) * _INDENTATION_PER_MU * self.mu
        return plain(np.where(d < self.d[0], 2.0 / 3.0 * gap**-8 - 8.0 / 3.0 * gap**-2, load))

    def _check(self, values: Floats, name: str, low: float, high: float) -> None:
        wrong = values[~((values >= low) & (values <= high))]
        if wrong.size:
            raise InvalidValue(
                f"{name} = {wrong.flat[0]:g} in Maugis' units: at mu = {self.mu:g} it goes from {low:.6g} to {high:.6g}"
            )

    def _invert(self, column: int, values: Floats, low: float, high: float) -> Floats:
        """Q where d (column 0) or P (1) has a value, by bisection of a piece of the curve on which it grows."""
        below, above = np.full(values.shape, low), np.full(values.shape, high)
        for _ in range(50):  # to rounding of q
            middle = (below + above) / 2.0
            high_side = self.at(middle)[column] > values
            above, below = np.where(high_side, middle, above), np.where(high_side, below, middle)
        return np.asarray((below + above) / 2.0)

    def to_si(self, contact: contact.Contact) -> tuple[Floats, Floats]:
        """Indentation [m] and force [N] of the whole curve for a contact, whose own mu must be this one's."""
        mu = tabor_mu(contact)
        if not math.isclose(mu, self.mu, rel_tol=1e-6):
            raise InvalidValue(
                f"the contact's mu is {mu:.6g}, the curve's {self.mu:.6g}: lennard_jones(tabor_mu(contact))"
            )
        w, R, K = contact.work_of_adhesion, contact.radius, 4.0 / 3.0 * contact.effective_modulus
        return self.d * (R * (math.pi * w / K) ** 2) ** (1.0 / 3.0), self.P * (math.pi * w * R)


def mu_range() -> tuple[float, float]:
    """The smallest and largest mu of the table."""
    mu = _table().mu
    return float(mu[0]), float(mu[-1])


def table_error() -> TableError:
    """The measured error of the table."""
    return _table().error


@functools.lru_cache(maxsize=64)
def lennard_jones(mu: float) -> LennardJones:
    """The Lennard-Jones curve of a mu between 0.05 and 5: the polynomial in ln mu through all curves of the table."""
    table = _table()
    low, high = mu_range()
    if not low <= mu <= high:
        raise InvalidValue(f"mu = {mu}: the Lennard-Jones table holds {low:g} to {high:g}")
    x = np.log(table.mu / mu)
    others = [np.delete(x, k) for k in range(x.size)]
    weights = np.array([np.prod(other / (other - x[k])) for k, other in enumerate(others)])
    return LennardJones(mu, table.q, *np.tensordot(weights, table.values, 1).T)


def tabor_mu(contact: contact.Contact) -> float:
    """Tabor's mu of a contact whose cohesive stress is the largest of the Lennard-Jones law, 1.0264 w/z0."""
    return float(contact.maugis_lambda / LAMBDA_PER_MU)


def pull_off(mu: float) -> float:
    """Pull-off load of the Lennard-Jones sphere [pi w R], negative."""
    return lennard_jones(mu).pull_off_load


def model_error(
    model: contact.Model,
    mu: float,
    quantity: Quantity = "force",
    *,
    rezeroed: bool = False,
    loads: tuple[float, float] = (-0.9, 10.0),
) -> float:
    """Distance of a contact model to the Lennard-Jones sphere of the same mu (lambda = 1.157 mu).

    Parameters
    ----------
    model : str
        ``"hertz"``, ``"dmt"``, ``"jkr"`` or ``"maugis"``.
    mu : float
        Tabor's parameter, 0.05 to 5.
    quantity : str
        ``"force"``: the largest ``|dF|/max(|F|, |F_pull-off|)`` at equal indentation (grips) on the stable branch.
        ``"pull_off"``: the relative difference of the pull-off loads.
    rezeroed : bool
        Count both indentations from where the load is 0, as one does with measured curves.
    loads : (float, float)
        Lowest and highest load compared, in pull-off forces of the Lennard-Jones sphere, between -1 and 10. At -1 a
        model that lets go a little earlier is off by all of the pull-off force.
    """
    if quantity not in get_args(Quantity):
        raise InvalidValue(f"quantity {quantity!r}: valid are {', '.join(get_args(Quantity))}")
    truth = lennard_jones(mu)
    # Maugis' units: R = K = pi w = 1
    unit = contact.Contact(1.0, 0.75, 1.0 / math.pi, cohesive_stress=LAMBDA_PER_MU * mu / 2.0)
    if quantity == "pull_off":
        return abs(contact.pull_off_force(model, unit) / -truth.pull_off_load - 1.0)
    lowest, highest = (float(truth.indentation(-load * truth.pull_off_load)) for load in loads)
    d = np.linspace(lowest, highest, 2001)
    F = truth.force(d)
    shift = float(contact.indentation(model, 0.0, unit)) - truth.zero_load_indentation if rezeroed else 0.0
    modelled = contact.force(model, d + shift, unit)
    return float(np.max(np.abs(modelled - F) / np.maximum(np.abs(F), -truth.pull_off_load)))
