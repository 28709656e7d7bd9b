# SPDX-License-Identifier: BSD-3-Clause
"""The descriptions: what there is (:class:`Scene`), with what it is touched (:class:`Rig`), how well (:class:`Demand`),
how it is controlled (:class:`Settings`). All may stand in one TOML file; every key carries its unit
(``[tip] radius_nm``)."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, Self, Unpack, get_args

from nanotouch import _core
from nanotouch._io.files import toml_tables
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.rheology import Rheology
from nanotouch.scene import materials
from nanotouch.scene._custom import CustomTerm, find
from nanotouch.scene._custom import register as register
from nanotouch.scene._custom import registered as registered
from nanotouch.scene.description import as_table

if TYPE_CHECKING:
    from nanotouch._fields import DemandFields, RigFields, SceneFields, SceneSections, SettingsFields
    from nanotouch.scene.plan import Plan
    from nanotouch.scene.surface import Surface
else:
    from nanotouch.scene.description import Description

    SceneFields = DemandFields = RigFields = SettingsFields = Description

Quantity = Literal["force", "stiffness", "radius", "folds"]
Bound = Literal["kept", "exact", "any"]
ARMS = 8  # that a kernel has at most
SINGLE = ("arm_count", "arm_modulus_", "relaxation_time_")  # fields of single arms
BOUNDS: tuple[Bound, ...] = get_args(Bound)


class Scene(SceneFields, core_type=_core.Scene):
    """Tip, sample, medium and adhesion; by default the paper's silicon tip of 20 nm on silicon in humid air.

    ``terms`` are laws of one's own, by the name of :func:`register` and with their parameters:
    ``Scene(terms={"gel": {"strength": 1e-3}})``, in a file ``[terms.gel]``.

    A sample that relaxes is a `Rheology`, ``Scene(rheology=Rheology.power_law(1200.0, 0.2))``, in a file
    ``[rheology]``: docs/rheology.md.
    """

    beside = ("terms", "surface", "drive", "zloop", "raster", "readout")  # read by surface_file and scan
    _terms: dict[str, tuple[CustomTerm, dict[str, float | str]]]

    def __init__(
        self,
        *,
        terms: Mapping[str, Mapping[str, Any]] | None = None,
        rheology: Rheology | Mapping[str, Any] | None = None,
        **sections: Unpack[SceneSections],
    ) -> None:
        super().__init__(**sections)
        self._relax_by(rheology)
        for name, values in (terms or {}).items():
            self.add_term(name, **values)

    def _relax_by(self, rheology: object) -> None:
        """Take a kernel, or the fields of one."""
        if isinstance(rheology, Rheology):
            rheology = {name: getattr(rheology, name) for name in ("kind", *rheology.keys)}
        table = as_table("rheology", {} if rheology is None else rheology)
        if "kind" not in table and not table.keys().isdisjoint(("arm_moduli", "relaxation_times")):
            raise InvalidValue("rheology lacks its kind: elastic, power_law, standard_linear_solid or prony")
        for key, value in table.items():
            if self._set("rheology", key, value):
                continue
            if f"rheology.{key}" not in self.fields:
                raise InvalidValue(f"rheology has no field {key!r}; it has {', '.join(self.keys_of('rheology'))}")
            self[f"rheology.{key}"] = value

    @property
    def terms(self) -> Mapping[str, Mapping[str, float]]:
        """The laws of one's own with their parameters, SI. To be read: :meth:`add_term` sets them."""
        return MappingProxyType({name: MappingProxyType(self._term_values(name)) for name in self._terms})

    def add_term(self, name: str, /, version: int | None = None, **parameters: Any) -> None:
        """Add a registered law, or give one that is there other parameters; a text is a field that one follows."""
        term = find(name, version)
        if name not in self._terms and len(self._terms) == _core.custom_terms:
            raise InvalidValue(f"terms.{name}: a scene has at most {_core.custom_terms} laws of one's own")
        values = term.values(parameters)
        for key, value in values.items():
            if not isinstance(value, str):
                continue
            if value not in self.fields or self.fields[value].choices:
                raise InvalidValue(f"terms.{name}: the scene has no field {value!r} that is a number")
            if self.fields[value].unit != term.units[key]:
                raise InvalidValue(
                    f"terms.{name}: {key} [{term.units[key]}] cannot follow {value} [{self.fields[value].unit}]"
                )
        self._terms[name] = term, values
        self._describe_terms()

    def remove_term(self, name: str) -> None:
        """Remove a law that :meth:`add_term` has added."""
        if name not in self._terms:
            raise InvalidValue(f"terms.{name}: the scene has {', '.join(self._terms) or 'no law of one own'}")
        del self._terms[name]
        self._describe_terms()

    def term_force(self, name: str, gap: float) -> float:
        """Force of an added law [N] at a gap [m], computed by the function that was added."""
        term = self._terms[name][0]
        return float(term.force(gap, **self._term_values(name)))

    @contextmanager
    def naming_terms(self) -> Iterator[None]:
        """A refusal of the C library names a law of one's own by its place: here by its name, with what it raised."""
        try:
            yield
        except InvalidValue as refusal:
            for place, (name, (term, _)) in enumerate(self._terms.items()):
                if f"custom[{place}]" in str(refusal):
                    said = str(refusal).replace(f"custom[{place}]", f"terms.{name}")
                    gap = re.search(r"\.law = (\S+) m:", said)  # where it is not finite
                    raised = term.failure(self._term_values(name), float(gap[1]) if gap else 1e-9)
                    raise InvalidValue(f"{said}; it raised {raised!r}" if raised else said) from raised
            raise

    def _term_values(self, name: str) -> dict[str, float]:
        values = self._terms[name][1]
        return {key: self[value] if isinstance(value, str) else value for key, value in values.items()}

    def _describe_terms(self) -> None:
        """Tell the C library; a parameter may follow a field that has changed."""
        self.core.set_custom([term.bind(self._term_values(name)) for name, (term, _) in self._terms.items()])

    def _take(self, core: Any) -> None:
        super()._take(core)
        object.__setattr__(self, "_terms", {})

    def copy(self) -> Self:
        """An independent copy."""
        made = super().copy()
        made._terms.update(self._terms)
        return made

    def update_from_tables(self, tables: Mapping[str, Any]) -> None:
        """Set what the tables name; a section that no description has is refused."""
        of = as_table("rheology", tables.get("rheology", {}))
        is_kernel = "kind" in of and len(of) > 1 and not any(key.startswith(SINGLE) for key in of)
        super().update_from_tables(
            {name: table for name, table in tables.items() if name != "rheology" or not is_kernel}
        )
        if is_kernel:  # with all that its kind has, and nothing else
            self._relax_by(Rheology.from_table(of))
        for name, table in as_table("terms", tables.get("terms", {})).items():
            values: dict[str, Any] = {**find(name).from_table(as_table(f"terms.{name}", table))}
            self.add_term(name, **values)
        self._describe_terms()

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """Nested plain numbers in SI, and names of choices, for JSON; of laws of one's own their version, too."""
        nested = super().to_dict()
        if self._terms:
            nested["terms"] = {
                name: {"version": term.version, **values} for name, (term, values) in self._terms.items()
            }
        return nested

    def __setitem__(self, name: str, value: float | str) -> None:
        super().__setitem__(name, value)
        if self._terms:
            self._describe_terms()

    def __eq__(self, other: object) -> bool:
        same = not isinstance(other, Scene) or self._terms == other._terms
        return same and super().__eq__(other)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return _restore, (self.to_dict(),)

    def __repr__(self) -> str:
        shown = super().__repr__()
        if not self._terms:
            return shown
        terms = {name: self._term_values(name) for name in self._terms}
        return f"{shown.removesuffix(')')}{'' if shown.endswith('()') else ', '}terms={terms!r})"

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The scene of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))

    def _set(self, section: str, key: str, value: object) -> bool:
        """``material``: moduli and yield strength, and the surface energy where the table has it, of a named one. Arms
        of a kernel as lists."""
        if section == "rheology" and key in ("arm_moduli", "relaxation_times"):
            values = [float(one) for one in value] if isinstance(value, Sequence) else []
            if not 1 <= len(values) <= ARMS:
                raise InvalidValue(f"rheology.{key} = {told(value)}: valid are 1 to {ARMS} numbers")
            short = {"arm_moduli": "arm_modulus", "relaxation_times": "relaxation_time"}[key]
            for place, one in enumerate(values, 1):
                self[f"rheology.{short}_{place}"] = one
            self["rheology.arm_count"] = len(values)
            return True
        if section not in ("tip", "sample") or key != "material":
            return False
        material = materials.find(value if isinstance(value, str) else told(value))
        self[f"{section}.youngs_modulus"] = material.youngs_modulus
        self[f"{section}.poisson_ratio"] = material.poisson_ratio
        self[f"{section}.yield_strength"] = material.yield_strength if math.isfinite(material.yield_strength) else 0.0
        if math.isfinite(material.surface_energy):
            self[f"adhesion.{section}_surface_energy"] = material.surface_energy
        return True

    def plan(
        self,
        relative_accuracy: float | Demand = 0.01,
        force_floor: float = 0.0,
        quantity: Quantity = "force",
        *,
        rig: Rig | None = None,
        budget: float | None = None,
        surface: Surface | None = None,
        bound: Bound = "kept",
    ) -> Plan:
        """Decide what has to be computed, at the least cost that keeps the demand over the whole ``range``.

        Parameters
        ----------
        relative_accuracy : float or Demand
            Largest error of the quantity over max(\\|it\\|, its scale), for a force the pull-off force. A `Demand`
            stands for all of itself: ``force_floor``, ``quantity``, ``budget`` and ``bound``, too.
        force_floor : float
            Forces below this cannot be felt [N].
        quantity : str
            What has to be that accurate: ``"force"``, ``"stiffness"``, ``"radius"`` (of contact), ``"folds"`` (their
            gaps, under grips).
        rig : Rig, optional
            Tells the force noise of its probe beside the plan; what is computed stays the same.
        budget : float, optional
            What one evaluation may cost, in Hertz evaluations.
        surface : Surface, optional
            The topography, dilated by the tip; otherwise a flat at z = 0.
        bound : str
            ``"kept"``: the plan's bound is no more than `relative_accuracy`, or there is no plan. ``"exact"``: every
            law in full, with the bound of that. ``"any"``: what is demanded or else the least bound there is; where
            none is known it is infinite, and a warning says so. No real slave is armed with such a plan.

        Raises
        ------
        InvalidValue
            For a scene that no law covers, naming the field; for a demand that cannot be kept, with the best that can.
        """
        if budget == 0.0:
            raise InvalidValue("budget = 0: it must be above 0; None: whatever it costs")
        from nanotouch.scene.plan import Plan  # the next layer, which needs this one: a method for convenience

        if isinstance(relative_accuracy, Demand):
            if (force_floor, quantity, budget, bound) != (0.0, "force", None, "kept"):
                raise TypeError("force_floor, quantity, budget and bound are those of the Demand")
            return Plan.make(self, relative_accuracy, rig, surface)
        demand = Demand(
            demand={
                "relative_accuracy": relative_accuracy,
                "force_floor": force_floor,
                "quantity": quantity,
                "budget": budget or 0.0,
                "bound": bound,
            }
        )
        return Plan.make(self, demand, rig, surface)

    def plans(self, over: Mapping[str, Sequence[Any]], demand: Demand | None = None, *, rig: Rig | None = None) -> Any:
        """Plans for every combination of values of fields, in one labeled array per result.

        Parameters
        ----------
        over : mapping
            Names of fields (``"tip.radius"``) with their values, SI or the name of a choice. Each is a dimension.
        demand : Demand, optional
            As for :meth:`plan`.
        rig : Rig, optional
            As for :meth:`plan`.

        Returns
        -------
        xarray.Dataset
            ``pull_off_force`` [N], ``maugis_lambda``, ``minimum_spring`` [N/m], ``maximum_stiffness`` [N/m], ``bound``,
            ``scale``, ``fold_shift_m`` [m], ``cost``, ``latency``, ``contact_law``; where there is no plan they are NaN
            and ``refused`` has the reason.

        Raises
        ------
        InvalidValue
            For a name that is no field, and for what is no sequence.
        MissingExtra
            Without xarray.
        """
        from nanotouch.scene.plans import plans_over  # the next layer, as in plan()

        return plans_over(self, over, demand, rig)


class Demand(DemandFields, core_type=_core.Demand):
    """How true the felt force must be and what it may cost; by default 1 % of the force."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The demand of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))


class Rig(RigFields, core_type=_core.Rig):
    """Probe, stage and master. The defaults are the paper's rig (k_c = 8 N/m)."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The rig of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))


class Settings(SettingsFields, core_type=_core.Settings):
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


def _restore(sections: dict[str, Any]) -> Scene:
    return Scene(**sections)


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
