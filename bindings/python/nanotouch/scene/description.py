# SPDX-License-Identifier: BSD-3-Clause
"""Descriptions whose fields come from the C library's tables: scene, rig, settings.

One table gives the attributes (``scene.tip.radius``), the checks, the keys of a TOML file (``[tip] radius_nm = 20``)
and their documentation, so that they cannot disagree.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from nanotouch._io import html
from nanotouch._io.words import shortened, told
from nanotouch.errors import InvalidValue
from nanotouch.units import engineering, from_si, key_spellings, to_si


class Field(NamedTuple):
    """One field: dotted name, SI unit, valid range, meaning."""

    name: str
    unit: str
    minimum: float
    maximum: float
    doc: str

    @property
    def choices(self) -> tuple[str, ...]:
        """The names of a field that is a choice; it holds the number of one of them."""
        return tuple(self.unit.split("|")) if "|" in self.unit else ()

    def number_of(self, choice: object, label: str) -> float:
        """The number of a choice given by its name; yes and no may be true and false."""
        if isinstance(choice, bool | np.bool_) and self.choices == ("no", "yes"):
            return float(choice)
        if isinstance(choice, str) and choice in self.choices:
            return float(self.choices.index(choice))
        if isinstance(choice, int | float) and not isinstance(choice, bool) and choice in range(len(self.choices)):
            return float(choice)
        raise InvalidValue(f"{label} = {told(choice)} ({self.doc}): valid are {', '.join(self.choices)}")

    def check(self, value: float, label: str, written: float, factor: float = 1.0) -> None:
        """Raise :class:`~nanotouch.errors.InvalidValue` for an SI value out of range, in the unit it was written in."""
        if math.isfinite(value) and self.minimum <= value <= self.maximum:
            return
        low, high = from_si(self.minimum, factor), from_si(self.maximum, factor)
        unit = f" {self.unit}" if self.unit and factor == 1.0 else ""
        raise InvalidValue(f"{label} = {written:g}{unit} ({self.doc}): valid is {low:.6g} .. {high:.6g}{unit}")


class Section:
    """The fields under one name, as attributes in SI."""

    __slots__ = ("_name", "_owner")
    _name: str
    _owner: Description

    def __init__(self, owner: Description, name: str) -> None:
        object.__setattr__(self, "_owner", owner)
        object.__setattr__(self, "_name", name)

    def _field(self, key: str) -> str:
        name = f"{self._name}.{key}"
        if name not in self._owner.fields:
            raise AttributeError(f"{self._name} has no field {key!r}; it has {', '.join(self.__dir__())}")
        return name

    if not TYPE_CHECKING:  # type checkers know the fields from _fields.pyi, and refuse others

        def __getattr__(self, key: str) -> float | str:
            if key.startswith("_"):  # copying and pickling ask before there is an owner
                raise AttributeError(key)
            return self._owner.plain(self._field(key))

        def __setattr__(self, key: str, value: float | str) -> None:
            self._owner[self._field(key)] = value

    def __reduce__(self) -> Any:
        return Section, (self._owner, self._name)

    def __dir__(self) -> list[str]:
        return self._owner.keys_of(self._name)

    def __repr__(self) -> str:
        return f"{self._name}({', '.join(f'{key}={_shown(getattr(self, key))}' for key in self.__dir__())})"


class Description(Mapping[str, float]):
    """A mapping of dotted field names to SI values, with sections as attributes. A value out of its range is refused.

    >>> scene = Scene(tip={"radius": 30e-9})    # doctest: +SKIP
    >>> scene.tip.radius, scene["tip.radius"]   # doctest: +SKIP
    (3e-08, 3e-08)
    """

    _core_type: ClassVar[Any]
    _all_sections: ClassVar[list[str]] = []
    beside: ClassVar[tuple[str, ...]] = ()
    """tables of a file that are no section of fields"""
    fields: ClassVar[dict[str, Field]]
    core: Any
    _instead: str | None

    def __init__(self, **sections: object) -> None:
        self._take(self._core_type())
        for section, values in sections.items():
            if section not in self.sections():
                raise InvalidValue(
                    f"{type(self).__name__} has no section {section!r}; it has {', '.join(self.sections())}"
                )
            for key, value in as_table(section, values).items():
                name = f"{section}.{key}"
                if self._set(section, key, value):
                    continue
                if name not in self.fields:
                    raise InvalidValue(f"{section} has no field {key!r}; it has {', '.join(self.keys_of(section))}")
                self[name] = value

    def __init_subclass__(cls, core_type: Any) -> None:
        cls._core_type = core_type
        cls.fields = {entry[0]: Field(*entry) for entry in core_type.fields}
        Description._all_sections = [*Description._all_sections, *cls.sections(), *cls.beside]

    @classmethod
    def sections(cls) -> list[str]:
        """Names of the sections, in order."""
        return list(dict.fromkeys(name.split(".")[0] for name in cls.fields))

    @classmethod
    def keys_of(cls, section: str) -> list[str]:
        """Names of the fields of a section, in order."""
        return [name.removeprefix(f"{section}.") for name in cls.fields if name.startswith(f"{section}.")]

    @classmethod
    def from_tables(cls, tables: Mapping[str, Any]) -> Self:
        """From the tables of a TOML file, ``{"tip": {"radius_nm": 20}}``; sections of others are left alone."""
        made = cls()
        made.update_from_tables(tables)
        return made

    def update_from_tables(self, tables: Mapping[str, Any]) -> None:
        """Set what the tables name; a section that no description has is refused."""
        self._check_free(type(self).__name__)
        for section in tables:
            if section not in Description._all_sections:
                known = ", ".join(Description._all_sections)
                raise InvalidValue(f"unknown section [{shortened(section)}]; known are {known}")
        for section in self.sections():
            seen: dict[str, str] = {}
            for key, value in as_table(section, tables.get(section, {})).items():
                if self._set(section, key, value):
                    continue
                name, factor = self._field_of(section, key)
                if name in seen:
                    raise InvalidValue(f"[{section}] has both {seen[name]} and {key}: give one")
                seen[name] = key
                if self.fields[name].choices:
                    self.core.set(name, self.fields[name].number_of(value, f"[{section}] {key}"))
                    continue
                if isinstance(value, bool) or not isinstance(value, int | float):
                    raise InvalidValue(f"[{section}] {key} = {told(value)}: it must be a number")
                number = _as_float(value)
                si = to_si(number, factor) if math.isfinite(number) else number
                self.fields[name].check(si, f"[{section}] {key}", number, factor)
                self.core.set(name, si)

    def _set(self, section: str, key: str, value: object) -> bool:
        """Take a key that stands for several fields; False if it is none."""
        return False

    def _field_of(self, section: str, key: str) -> tuple[str, float]:
        spellings: dict[str, tuple[str, float]] = {}
        for name, field in self.fields.items():
            if name.startswith(section + "."):
                short = name.removeprefix(section + ".")
                keys = {short: 1.0} if field.choices else key_spellings(short, field.unit)
                if key == name.removeprefix(section + ".") and key not in keys:
                    raise InvalidValue(f"[{section}] {key} lacks its unit: write {', '.join(keys)}")
                spellings |= {spelling: (name, factor) for spelling, factor in keys.items()}
        if key in spellings:
            return spellings[key]
        near = difflib.get_close_matches(key, spellings, 1)
        hint = f"did you mean {near[0]}?" if near else f"it has {', '.join(self.keys_of(section))}"
        raise InvalidValue(f"[{section}] has no key {shortened(key)}; {hint}")

    def check(self) -> None:
        """Let the C library check it: :class:`~nanotouch.errors.InvalidValue` names the first bad field."""
        self.core.check()

    def copy(self) -> Self:
        """An independent copy."""
        made = type(self).__new__(type(self))
        made._take(self.core.copy())
        return made

    def frozen(self, instead: str) -> Self:
        """A copy that refuses every change and says what to do ``instead``."""
        made = self.copy()
        object.__setattr__(made, "_instead", instead)
        return made

    def _take(self, core: Any) -> None:
        object.__setattr__(self, "core", core)
        object.__setattr__(self, "_instead", None)

    def _check_free(self, what: str) -> None:
        if self._instead is not None:
            raise InvalidValue(f"{what} is frozen: {self._instead}")

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """Nested plain numbers in SI, and names of choices, for JSON."""
        nested: dict[str, dict[str, Any]] = {section: {} for section in self.sections()}
        for name in self.fields:
            section, key = name.split(".")
            nested[section][key] = self.plain(name)
        return nested

    def plain(self, name: str) -> float | str:
        """The value of a field; for a choice, its name."""
        choices = self.fields[name].choices
        return choices[int(self[name])] if choices else self[name]

    def __getitem__(self, name: str) -> float:
        value: float = self.core.get(name)
        return value

    def __setitem__(self, name: str, value: float | str) -> None:
        if name not in self.fields:
            raise KeyError(name)
        self._check_free(name)
        field = self.fields[name]
        number = field.number_of(value, name) if field.choices else _as_number(value, name)
        field.check(number, name, number)
        self.core.set(name, number)

    if not TYPE_CHECKING:  # type checkers know the sections from _fields.pyi, and refuse others

        def __getattr__(self, name: str) -> Section:
            if name in type(self).sections():
                return Section(self, name)
            raise AttributeError(f"{type(self).__name__} has no section {name!r}; it has {', '.join(self.sections())}")

        def __setattr__(self, name: str, value: object) -> None:
            first = next((field for field in self.fields if field.startswith(f"{name}.")), next(iter(self.fields)))
            said = f"{type(self).__name__}: set a field of a section, such as {first}, not {name!r} itself"
            raise AttributeError(said)

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__}: {name!r} cannot be deleted")

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields)

    def __len__(self) -> int:
        return len(self.fields)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.sections()]

    def __reduce__(self) -> Any:
        return _restore, (type(self), dict(self))

    def __repr__(self) -> str:
        """What differs from the default, as it would be written in a program."""
        usual, differing = type(self)(), dict[str, dict[str, float | str]]()
        for name, value in self.items():
            if value != usual[name]:
                section, key = name.split(".")
                differing.setdefault(section, {})[key] = self.plain(name)
        return f"{type(self).__name__}({', '.join(f'{name}={values!r}' for name, values in differing.items())})"

    def _repr_html_(self) -> str:
        """Every field with its value in engineering units; what differs from the default is marked by a star."""
        usual = type(self)()
        rows = [
            (name + (" *" if value != usual[name] else ""), _told(value, self.fields[name].unit), self.fields[name].doc)
            for name, value in self.items()
        ]
        return html.table(f"{type(self).__name__} (*: not the default)", ("field", "value", "meaning"), rows)


def _told(value: float | str, unit: str) -> str:
    if isinstance(value, str) or unit in ("", "-") or not math.isfinite(value):
        return _shown(value)
    prefixed, factor = engineering(unit, [value])
    return f"{value * factor:.4g} {prefixed}"


def _shown(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def as_table(section: str, values: Any) -> Mapping[str, Any]:
    """A table of a file or of a program."""
    if not isinstance(values, Mapping):
        raise InvalidValue(f"[{section}] must be a table of keys, not {told(values)}")
    return values


def _as_number(value: Any, label: str) -> float:
    """A number of one's own or of numpy's; text, truth values and what has parts are none."""
    if isinstance(value, bool | np.bool_ | str | bytes):
        raise InvalidValue(f"{label} = {told(value)}: it must be a number")
    try:
        return _as_float(value)
    except TypeError as error:
        raise InvalidValue(f"{label} = {told(value)}: it must be a number") from error


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # a whole number beyond the largest double
        return math.inf if value > 0 else -math.inf


def _restore(kind: type[Description], values: dict[str, float]) -> Description:
    made = kind()
    for name, value in values.items():
        made[name] = value
    return made
