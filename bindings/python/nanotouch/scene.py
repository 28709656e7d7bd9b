# SPDX-License-Identifier: BSD-3-Clause
"""What there is and with what it is touched: :class:`Scene`, :class:`Rig`, :class:`Settings`, and the :class:`Plan`
made from them. All three descriptions may stand in one TOML file; every key carries its unit (``[tip] radius_nm``)."""

from __future__ import annotations

import os
import tomllib
from typing import Any, Literal, NamedTuple, Self

from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Law, as_floats, as_law
from nanotouch.description import Description
from nanotouch.errors import InvalidValue, ReadError

MAXIMUM_STRAIN = 0.3  # a/R up to which a sphere is a paraboloid to some per cent


class Scene(Description, core_type=_core.Scene):
    """Tip, sample, medium and adhesion; by default the paper's silicon tip of 20 nm on silicon in humid air."""

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The scene of a TOML file; see :func:`read_toml`."""
        return cls.from_tables(read_tables(path))

    def plan(self, rtol: float = 0.01, atol: float = 0.0, maximum_load: float = 2.2e-6) -> Plan:
        """Decide what has to be computed.

        Parameters
        ----------
        rtol : float
            Largest error of the force over max(\\|F\\|, \\|F_pull-off\\|).
        atol : float
            Forces below this cannot be felt [N].
        maximum_load : float
            The largest load that will be visited [N].
        """
        return Plan(_core.Plan(self.core, rtol, atol, maximum_load))


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
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise ReadError(f"{os.fspath(path)}: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ReadError(f"{os.fspath(path)} is not a TOML file: {error}") from error


class Term(NamedTuple):
    """One law of a plan."""

    name: str
    included: bool
    bound: float
    """contact law: its relative error; otherwise the largest force it adds, or would have added [N]"""


class Plan:
    """What is computed for a scene, and why; see ``print(plan)``."""

    def __init__(self, core: _core.Plan) -> None:
        self.core = core
        self._facts: dict[str, Any] = core.as_dict()

    @property
    def terms(self) -> list[Term]:
        """The laws that are computed."""
        return [term for term in self._all_terms() if term.included]

    @property
    def omitted(self) -> list[Term]:
        """The laws left out, with the largest force each could add."""
        return [term for term in self._all_terms() if not term.included]

    def _all_terms(self) -> list[Term]:
        return [Term(*term) for term in self._facts["terms"]]

    def explain(self) -> dict[str, Any]:
        """The plan as data, SI."""
        return dict(self._facts)

    def force(self, gap: ArrayLike, history: Literal["approach", "retract"] = "approach") -> Any:
        """Force on the tip [N] along a path of gaps [m], in their order, starting apart or in contact."""
        return self.run(gap, history).F

    def run(self, gap: ArrayLike, history: Literal["approach", "retract"] = "approach") -> Law:
        """Energy, force, stiffness and contact radius along a path of gaps [m]."""
        if history not in ("approach", "retract"):
            raise InvalidValue(f"history {history!r}: valid are approach, retract")
        return as_law(self.core.run(as_floats(gap, "gap"), history == "retract"))

    @property
    def pull_off_force(self) -> float:
        """Pull-off force under load control, tails included, a positive magnitude [N]."""
        return float(self._facts["pull_off_force"])

    @property
    def maximum_stiffness(self) -> float:
        """Stiffness of the contact at the largest load [N/m]."""
        return float(self._facts["maximum_stiffness"])

    @property
    def warnings(self) -> list[str]:
        """Where a law is outside its validity."""
        strain = self._facts["contact_strain"]
        if strain <= MAXIMUM_STRAIN:
            return []
        return [
            f"the contact radius reaches {strain:.2f} R at the largest load; "
            f"the laws are for small contacts, up to about {MAXIMUM_STRAIN} R"
        ]

    def __str__(self) -> str:
        contact, *others = self._all_terms()
        lines = [_contact_sentence(contact, self._facts)]
        lines += [_term_sentence(term, self.pull_off_force) for term in others]
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def __repr__(self) -> str:
        return f"Plan({', '.join(term.name for term in self.terms)})"


_NAMES = {
    "hertz": "Hertz", "dmt": "DMT", "jkr": "JKR", "maugis": "Maugis-Dugdale",
    "vdw": "van der Waals", "electrostatic": "electrostatic",
}  # fmt: skip
_SOURCES = {"solid": "of the solids", "meniscus": "by a water meniscus"}
_ABSENT = {"vdw": "the Hamaker constant is 0", "electrostatic": "no potential difference"}


def _contact_sentence(term: Term, facts: dict[str, Any]) -> str:
    if facts["adhesion_source"] == "none":
        return "contact: Hertz, no adhesion"
    if term.name == "hertz":
        return "contact: Hertz, the adhesion is too weak to be felt"
    accuracy = f"within {100 * term.bound:.2g} % of Maugis-Dugdale" if term.name == "jkr" else "solved to rounding"
    return (
        f"contact: {_NAMES[term.name]} (lambda {facts['lambda']:.3g}), {accuracy}; "
        f"adhesion {_SOURCES[facts['adhesion_source']]}, w = {facts['work_of_adhesion'] * 1e3:.4g} mJ/m2; "
        f"pull-off {facts['pull_off_force'] * 1e9:.4g} nN"
    )


def _term_sentence(term: Term, pull_off_force: float) -> str:
    name = _NAMES[term.name]
    if term.bound == 0.0:
        return f"{name}: none ({_ABSENT[term.name]})"
    share = f" ({100 * term.bound / pull_off_force:.2g} % of the pull-off)" if pull_off_force > 0.0 else ""
    verb = "computed, up to" if term.included else "left out, it would add at most"
    return f"{name}: {verb} {term.bound * 1e9:.2g} nN{share}"
