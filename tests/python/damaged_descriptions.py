# SPDX-License-Identifier: BSD-3-Clause
"""Damaged scenes, rigs, recordings and messages of a page: each is taken or refused in words, none ends in a traceback.
The tests run a few of each; ``tests/heavy/descriptions.py`` as many as asked for.

A mutant is a sound text with words replaced by others, lines twice, cut off or swapped, and what mutations.py does to
bytes. What is taken must hold numbers only.
"""

from __future__ import annotations

import itertools
import json
import math
import re
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import mutations
import nanotouch as nt
import numpy as np
from nanotouch import record, rig_file
from nanotouch.errors import Error
from nanotouch.units import key_spellings
from nanotouch_app.browser import access

DOCS = Path(__file__).parents[2] / "docs/examples"
ROWS, BLOCK = 120, 40
WORDS = [b"nan", b"inf", b"-inf", b"1e400", b"-0", b"true", b"null", b'"\\u0000"', b"[[1]]", b"{a = 1}",
         b"0x7fffffffffffffff", b"99999999999999999999", b'"no"', b"", b"'''", b"\xff", b"[" * 2000, b"9" * 5000,
         b"1979-05-27"]  # fmt: skip
WORD = re.compile(rb"[\w.+-]+")


def _toml(described: Any) -> bytes:
    """All fields, each in one of the units that it may be written in."""
    lines = []
    for section in described.sections():
        lines.append(f"[{section}]")
        for key in described.keys_of(section):
            field = described.fields[f"{section}.{key}"]
            name = key if field.choices else next(iter(key_spellings(key, field.unit)))
            value = field.choices[0] if field.choices else described[f"{section}.{key}"]
            lines.append(f'{name} = "{value}"' if field.choices else f"{name} = {value!r}")
    return "\n".join(lines).encode()


def _scene() -> list[bytes]:
    scene, rig = nt.Scene(), nt.Rig()
    whole = [_toml(one) for one in (scene, rig, nt.Settings.for_rig(rig))]
    return [*whole, b"[tip]\nradius_nm = 35\n[probe]\nspring_constant_N_per_m = 5\n"]


def _take_scene(path: Path) -> None:
    for described in nt.scene.read_toml(path):
        assert all(math.isfinite(value) for value in described.values() if isinstance(value, float))


def _rig() -> list[bytes]:
    return [path.read_bytes() for path in sorted(DOCS.rglob("*.toml"))]


def _take_rig(path: Path) -> None:
    rig_file.read(path)


def _recording() -> list[bytes]:
    rng = np.random.default_rng(1)
    columns = {name: rng.standard_normal(ROWS) * 1e-9 for name in record.COLUMNS}
    columns["time"] = np.arange(ROWS) * 1e-4
    for name in ("state", "phase", "reasons", "flags"):
        columns[name] = rng.integers(0, 4, ROWS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "r.mcap"
        whole = record.Recording(columns, {"alpha_p": 4e-6, "alpha_f": 2e6, "scene": {"tip": {"radius": 2e-8}}})
        with record.Writer(path, whole.metadata) as writer:
            for start in range(0, ROWS, BLOCK):
                writer.append(whole[start : start + BLOCK].columns)
        return [path.read_bytes()]


def _take_recording(path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it says what is lost
        found = record.read(path)
    assert {len(column) for column in found.columns.values()} <= {len(found)}
    assert len(found) <= ROWS


def _messages() -> list[bytes]:
    asked: list[dict[str, object]] = [
        {"do": "move", "way": [1e-9, -1e-9, 0.0]}, {"do": "wheel", "steps": 3}, {"do": "press", "on": True},
        {"do": "task", "name": ""}, {"do": "choose", "number": 1}, {"do": "say", "text": "3 nN"},
        {"do": "preset", "name": "silicon_in_air"}, {"do": "device", "name": "wheel"}, {"do": "stop"},
        {"do": "change", "what": "scene", "field": "sample.youngs_modulus", "value": 1e9},
    ]  # fmt: skip
    return [json.dumps(one).encode() for one in asked]


def _take_message(path: Path) -> None:
    try:
        message = json.loads(path.read_bytes())
    except (ValueError, RecursionError) as error:  # as the server does
        raise Error("no JSON") from error
    found = access.checked(message)
    assert found["do"] in access.ASKED
    for value in itertools.chain.from_iterable(v if isinstance(v, list) else [v] for v in found.values()):
        assert isinstance(value, str | bool | int) or math.isfinite(value)


class Kind(NamedTuple):
    """A kind of description."""

    seeds: Callable[[], list[bytes]]
    take: Callable[[Path], Any]
    ending: str


KINDS = {
    "scene": Kind(_scene, _take_scene, ".toml"),
    "rig": Kind(_rig, _take_rig, ".toml"),
    "recording": Kind(_recording, _take_recording, ".mcap"),
    "message": Kind(_messages, _take_message, ".json"),
}


def _reworded(data: bytes, rng: np.random.Generator) -> bytes:
    """Some words by absurd ones, or by others of the same text."""
    for _ in range(int(rng.integers(1, 4))):
        found = list(WORD.finditer(data))
        if not found:
            return data
        match = found[int(rng.integers(len(found)))]
        other = WORDS[int(rng.integers(len(WORDS)))] if rng.random() < 0.6 else found[int(rng.integers(len(found)))][0]
        data = data[: match.start()] + other + data[match.end() :]
    return data


def _relined(data: bytes, rng: np.random.Generator) -> bytes:
    """Lines twice, gone, or elsewhere."""
    lines = data.split(b"\n")
    one, other = (int(rng.integers(len(lines))) for _ in range(2))
    what = rng.random()
    if what < 0.4:
        lines.insert(other, lines[one])
    elif what < 0.7:
        lines.pop(one)
    else:
        lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def mutant(whole: bytes, rng: np.random.Generator) -> bytes:
    """One damaged copy."""
    what = rng.random()
    if what < 0.45:
        return _reworded(whole, rng)
    return _relined(whole, rng) if what < 0.6 else mutations.mutant(whole, rng)


def run(name: str, count: int, seed: int, folder: Path) -> Counter[str]:
    """How many were taken and refused. Anything but a refusal of ours is raised; the mutant then lies in the folder."""
    kind, found = KINDS[name], Counter[str]()
    seeds = kind.seeds()
    rng = np.random.default_rng([seed, sorted(KINDS).index(name)])
    path = folder / f"mutant{kind.ending}"
    for number in range(count):
        path.write_bytes(mutant(seeds[number % len(seeds)], rng))
        try:
            kind.take(path)
            found["taken"] += 1
        except Error as error:
            found["refused" if 0 < len(str(error)) < 4000 else "without a word"] += 1
    return found
