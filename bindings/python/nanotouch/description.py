# SPDX-License-Identifier: BSD-3-Clause
"""Descriptions whose fields come from the C library's tables: scene, rig, settings.

One table gives the attributes (``scene.tip.radius``), the checks, the keys of a TOML file (``[tip] radius_nm = 20``) and
their documentation, so that they cannot disagree.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, NamedTuple, Self

from nanotouch.errors import InvalidValue
from nanotouch.units import key_spellings


class Field(NamedTuple):
    """One field: dotted name, SI unit, valid range, meaning."""

    name: str
    unit: str
    minimum: float
    maximum: float
    doc: str


class Section:
    """The fields under one name, as attributes in SI."""

    def __init__(self, owner: Description, name: str) -> None:
        object.__setattr__(self, "_owner", owner)
        object.__setattr__(self, "_name", name)

    def __getattr__(self, key: str) -> float:
        owner: Description = self.__dict__["_owner"]
        return owner[f"{self.__dict__['_name']}.{key}"]

    def __setattr__(self, key: str, value: float) -> None:
        self.__dict__["_owner"][f"{self.__dict__['_name']}.{key}"] = value

    def __dir__(self) -> list[str]:
        prefix = self.__dict__["_name"] + "."
        owner: Description = self.__dict__["_owner"]
        return [name.removeprefix(prefix) for name in owner if name.startswith(prefix)]

    def __repr__(self) -> str:
        owner: Description = self.__dict__["_owner"]
        name = self.__dict__["_name"]
        values = ", ".join(f"{key}={owner[f'{name}.{key}']:g}" for key in dir(self))
        return f"{name}({values})"


class Description(Mapping[str, float]):
    """A mapping of dotted field names to SI values, with sections as attributes.

    >>> scene = Scene(tip={"radius": 30e-9})    # doctest: +SKIP
    >>> scene.tip.radius, scene["tip.radius"]   # doctest: +SKIP
    (3e-08, 3e-08)
    """

    _core_type: ClassVar[Any]
    fields: ClassVar[dict[str, Field]]

    def __init__(self, **sections: Mapping[str, float]) -> None:
        self.core = self._core_type()
        for section, values in sections.items():
            for key, value in values.items():
                self[f"{section}.{key}"] = value

    def __init_subclass__(cls, core_type: Any) -> None:
        cls._core_type = core_type
        cls.fields = {entry[0]: Field(*entry) for entry in core_type.fields}

    @classmethod
    def sections(cls) -> list[str]:
        """Names of the sections, in order."""
        return list(dict.fromkeys(name.split(".")[0] for name in cls.fields))

    @classmethod
    def from_tables(cls, tables: Mapping[str, Any]) -> Self:
        """From the tables of a TOML file, ``{"tip": {"radius_nm": 20}}``; sections of other descriptions are left alone."""
        made = cls()
        made.update_from_tables(tables)
        return made

    def update_from_tables(self, tables: Mapping[str, Any]) -> None:
        """Set what the tables name, then check everything."""
        for section in self.sections():
            table = tables.get(section, {})
            if not isinstance(table, Mapping):
                raise InvalidValue(f"[{section}] must be a table of keys")
            seen: dict[str, str] = {}
            for key, value in table.items():
                name, factor = self._field_of(section, key)
                if name in seen:
                    raise InvalidValue(f"[{section}] has both {seen[name]} and {key}: give one")
                seen[name] = key
                if isinstance(value, bool) or not isinstance(value, int | float):
                    raise InvalidValue(f"[{section}] {key} = {value!r}: it must be a number")
                self._check_entry(section, key, name, float(value), factor)
                self[name] = float(value) * factor
        self.check()

    def _field_of(self, section: str, key: str) -> tuple[str, float]:
        spellings: dict[str, tuple[str, float]] = {}
        for name, field in self.fields.items():
            if name.startswith(section + "."):
                keys = key_spellings(name.removeprefix(section + "."), field.unit)
                spellings |= {spelling: (name, factor) for spelling, factor in keys.items()}
        if key in spellings:
            return spellings[key]
        with_unit = [spelling for spelling in spellings if spelling.startswith(key + "_")]
        if with_unit:
            raise InvalidValue(f"[{section}] {key} lacks its unit: write {', '.join(with_unit[:4])}")
        near = difflib.get_close_matches(key, spellings, 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise InvalidValue(f"[{section}] has no key {key}{hint}")

    def _check_entry(self, section: str, key: str, name: str, value: float, factor: float) -> None:
        field = self.fields[name]
        if not math.isfinite(value) or not field.minimum <= value * factor <= field.maximum:
            low, high = field.minimum / factor, field.maximum / factor
            raise InvalidValue(f"[{section}] {key} = {value:g} ({field.doc}): valid is {low:.6g} .. {high:.6g}")

    def check(self) -> None:
        """Raise :class:`~nanotouch.errors.InvalidValue` naming the first field out of its range."""
        self.core.check()

    def copy(self) -> Self:
        """An independent copy."""
        made = type(self).__new__(type(self))
        made.core = self.core.copy()
        return made

    def to_dict(self) -> dict[str, dict[str, float]]:
        """Nested plain numbers in SI, for JSON."""
        nested: dict[str, dict[str, float]] = {section: {} for section in self.sections()}
        for name in self.fields:
            section, key = name.split(".")
            nested[section][key] = self[name]
        return nested

    def __getitem__(self, name: str) -> float:
        value: float = self.core.get(name)
        return value

    def __setitem__(self, name: str, value: float) -> None:
        if name not in self.fields:
            raise AttributeError(f"{type(self).__name__} has no field {name!r}")
        self.core.set(name, float(value))

    def __getattr__(self, name: str) -> Section:
        if name in type(self).sections():
            return Section(self, name)
        raise AttributeError(f"{type(self).__name__} has no section {name!r}; it has {', '.join(self.sections())}")

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields)

    def __len__(self) -> int:
        return len(self.fields)

    def __reduce__(self) -> Any:
        return _restore, (type(self), dict(self))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(repr(getattr(self, name)) for name in self.sections())})"


def _restore(kind: type[Description], values: dict[str, float]) -> Description:
    made = kind()
    for name, value in values.items():
        made[name] = value
    return made
