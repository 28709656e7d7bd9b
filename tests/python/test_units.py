# SPDX-License-Identifier: BSD-3-Clause
"""Quantities with units: every spelling, decimal exactness, what is refused and how."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nanotouch.errors import InvalidValue
from nanotouch.units import UNITS, from_si, in_words, key_spellings, parse_quantity, to_si

SPELLINGS = [(unit, spelling) for unit, spellings in UNITS.items() for spelling in spellings]


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("2.5um", "m", 2.5e-6),
        ("2.5 µm", "m", 2.5e-6),  # micro sign
        ("2.5 μm", "m", 2.5e-6),  # Greek mu
        (" 20nm ", "m", 20e-9),
        ("-3e2pm", "m", -3e-10),
        (".5m", "m", 0.5),
        ("+1.m", "m", 1.0),
        ("40%", "", 0.4),
        ("0.4", "", 0.4),
        ("72 mJ/m²", "J/m^2", 0.072),
        ("72mJ/m^2", "J/m^2", 0.072),
        ("18cm³/mol", "m^3/mol", 18e-6),
        ("135GPa", "Pa", 135e9),
        ("180deg", "rad", math.pi),
        ("20s", "s", 20.0),
    ],
)
def test_quantities(text: str, unit: str, value: float) -> None:
    assert parse_quantity(text, unit) == value


@pytest.mark.parametrize(
    "text",
    [
        "",
        "um",
        "2.5",
        "2.5 mu",
        "2.5kg",
        "2,5um",
        "nanum",
        "infum",
        "1e400um",
        "1 e-6m",
        "2.5umm",
        "0x1um",
        "²um",
        "1um um",
    ],
)
def test_what_is_no_length_is_refused(text: str) -> None:
    with pytest.raises(InvalidValue) as caught:
        parse_quantity(text, "m")
    assert repr(text) in str(caught.value)
    assert "finite" in str(caught.value) or "2.5um" in str(caught.value)


@pytest.mark.parametrize("unit", UNITS)
def test_every_message_gives_an_example_that_is_read(unit: str) -> None:
    with pytest.raises(InvalidValue) as caught:
        parse_quantity("5 parsec", unit)
    example = str(caught.value).split("write it like ")[1].split(" (")[0]
    assert math.isfinite(parse_quantity(example, unit))


@pytest.mark.parametrize(("unit", "spelling"), SPELLINGS)
@given(value=st.floats(1e-6, 1e6))
@settings(max_examples=20)
def test_every_spelling_round_trips(unit: str, spelling: str, value: float) -> None:
    factor = UNITS[unit][spelling]
    assert parse_quantity(f"{value!r}{spelling}", unit) == to_si(value, factor)
    # what a file in this unit says is read back: where a double can be had, the same
    si = to_si(value, factor)
    written = from_si(si, factor)
    assert written == pytest.approx(value, rel=3e-16)
    assert to_si(written, factor) == si


@given(st.floats(1e-12, 1e-3), st.sampled_from([1e3, 1e-3, 1e-6, 1e-9, 1e-12]))
def test_a_length_that_is_written_is_read_back_to_the_last_digit(si: float, factor: float) -> None:
    """Not every double has one in another unit; then the one beside it is read."""
    assert abs(to_si(from_si(si, factor), factor) - si) <= math.ulp(si)


@given(st.integers(-9999, 9999), st.integers(-12, 9), st.sampled_from([1e3, 1e-3, 1e-6, 1e-9, 1e-12]))
def test_decimal_prefixes_are_exact(digits: int, power: int, factor: float) -> None:
    """3 nm is the double 3e-9, not 3.0000000000000004e-09."""
    assert to_si(float(f"{digits}e{power}"), factor) == float(f"{digits}e{power + round(math.log10(factor))}")


@given(st.text(max_size=12))
def test_any_text_is_a_quantity_or_refused(text: str) -> None:
    try:
        value = parse_quantity(text, "m")
    except InvalidValue:
        return
    assert math.isfinite(value)


def test_keys() -> None:
    assert key_spellings("radius", "m") == {
        "radius_m": 1.0, "radius_mm": 1e-3, "radius_um": 1e-6, "radius_nm": 1e-9, "radius_pm": 1e-12,
    }  # fmt: skip
    assert key_spellings("spring_constant", "N/m")["spring_constant_N_per_m"] == 1.0
    assert key_spellings("stage_integral", "1/s")["stage_integral_per_s"] == 1.0
    assert key_spellings("relative_humidity", "") == {"relative_humidity": 1.0, "relative_humidity_percent": 0.01}


@pytest.mark.parametrize("unit", UNITS)
def test_keys_are_bare_keys_of_toml(unit: str) -> None:
    assert all(key.replace("_", "").isalnum() and key.isascii() for key in key_spellings("x", unit))


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [(3.936e-10, "N", "393.6 pN"), (9.9996e-10, "N", "1 nN"), (0.0, "N", "0 N"), (-3.2, "V", "-3.2 V"),
     (1162.4, "N/m", "1.162 kN/m"), (0.379, "", "0.379"), (1053.0, "", "1053"),
     (math.inf, "N", "inf N"), (math.nan, "m", "nan m")],
)  # fmt: skip
def test_numbers_in_words(value: float, unit: str, said: str) -> None:
    assert in_words(value, unit) == said
