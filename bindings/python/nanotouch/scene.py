# SPDX-License-Identifier: BSD-3-Clause
"""The descriptions: what there is (:class:`Scene`), with what it is touched (:class:`Rig`), how well (:class:`Demand`),
how it is controlled (:class:`Settings`). All may stand in one TOML file; every key carries its unit
(``[tip] radius_nm``)."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any, Literal, Self

from nanotouch import _core, materials
from nanotouch._files import toml_tables
from nanotouch._words import told
from nanotouch.description import Description
from nanotouch.errors import InvalidValue

if TYPE_CHECKING:
    from nanotouch.plan import Plan
    from nanotouch.surface import Surface

Quantity = Literal["force", "stiffness", "radius", "folds"]


class Scene(Description, core_type=_core.Scene):
    """Tip, sample, medium and adhesion; by default the paper's silicon tip of 20 nm on silicon in humid air."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The scene of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))

    def _set(self, section: str, key: str, value: object) -> bool:
        """``material``: the moduli, and the surface energy where the table has it, of a named material."""
        if section not in ("tip", "sample") or key != "material":
            return False
        material = materials.find(value if isinstance(value, str) else told(value))
        self[f"{section}.youngs_modulus"] = material.youngs_modulus
        self[f"{section}.poisson_ratio"] = material.poisson_ratio
        if math.isfinite(material.surface_energy):
            self[f"adhesion.{section}_surface_energy"] = material.surface_energy
        return True

    def plan(
        self,
        rtol: float = 0.01,
        atol: float = 0.0,
        quantity: Quantity = "force",
        probe: Rig | None = None,
        budget: float | None = None,
        surface: Surface | None = None,
    ) -> Plan:
        """Decide what has to be computed, at the least cost that keeps the demand over the whole ``range``.

        Parameters
        ----------
        rtol : float
            Largest error of the quantity over max(\\|it\\|, its scale), for a force the pull-off force; 0: everything
            on, exact.
        atol : float
            Forces below this cannot be felt [N].
        quantity : str
            What has to be that accurate: ``"force"``, ``"stiffness"``, ``"radius"`` (of contact), ``"folds"`` (their
            gaps, under grips).
        probe : Rig, optional
            Raises ``atol`` to the force noise of its probe.
        budget : float, optional
            What one evaluation may cost, in Hertz evaluations.
        surface : Surface, optional
            The topography, dilated by the tip; otherwise a flat at z = 0.

        Raises
        ------
        InvalidValue
            For a scene that no law covers, naming the field; for a demand that cannot be kept, with the best that can.
        """
        if budget == 0.0:
            raise InvalidValue("budget = 0: it must be above 0; None: whatever it costs")
        from nanotouch.plan import Plan  # the next layer, which needs this one: a method for convenience

        demand = Demand(
            demand={"relative_accuracy": rtol, "force_floor": atol, "quantity": quantity, "budget": budget or 0.0}
        )
        return Plan.make(self, demand, probe, surface)


class Demand(Description, core_type=_core.Demand):
    """How true the felt force must be and what it may cost; by default 1 % of the force."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The demand of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))


class Rig(Description, core_type=_core.Rig):
    """Probe, stage and master. The defaults are the paper's rig (k_c = 8 N/m)."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The rig of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))


class Settings(Description, core_type=_core.Settings):
    """Gains and limits of the loop. The defaults follow a rig: :meth:`for_rig`."""

    @classmethod
    def for_rig(cls, rig: Rig) -> Self:
        """10 kHz, K_f = 2, scaling by the heuristic rule, limits inside the rig's ranges."""
        made = cls()
        made._take(_core.settings_for(rig.core))
        return made

    @classmethod
    def from_core(cls, core: _core.Settings) -> Self:
        """Those that the C library has made."""
        made = cls()
        made._take(core)
        return made

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str], rig: Rig) -> Self:
        """The settings of a TOML file over those that follow the rig; see :func:`read_toml`."""
        made = cls.for_rig(rig)
        made.update_from_tables(read_tables(path))
        return made


def read_toml(path: str | os.PathLike[str]) -> tuple[Scene, Rig, Settings]:
    """Scene, rig and settings of one TOML file; what it does not name keeps its default."""
    tables = read_tables(path)
    rig = Rig.from_tables(tables)
    settings = Settings.for_rig(rig)
    settings.update_from_tables(tables)
    return Scene.from_tables(tables), rig, settings


def read_tables(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The tables of a TOML file."""
    return toml_tables(path)
