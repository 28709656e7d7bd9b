# SPDX-License-Identifier: BSD-3-Clause
"""Damaged files through all readers, in the guarded worker: ``make damage`` prints the table of the documentation
(2000 files, some minutes) and fails if the guard had to stop more than 0.2 %; the tests run one of each kind.

A seed is a whole file in a real format, made here or found among the real data; a mutant is cut off, has bits or bytes
changed, numbers replaced by absurd ones, or bytes added. Members of zip archives are damaged inside a sound archive.
"""

from __future__ import annotations

import argparse
import io
import re
import struct
import sys
import tempfile
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import synthetic
import synthetic_images
from nanotouch import curves, images
from nanotouch.errors import ReadError

SIDE = (3e-6, 4e-6)
ALLOWED_STOPS = 0.002  # of the damaged files; the HDF5 library loops on some
OUTCOMES = ("refused", "same", "values", "scale", "stopped")


@dataclass(frozen=True)
class Seed:
    """A whole file, how it is read, and what it holds."""

    kind: str
    path: Path
    options: dict[str, Any] = field(default_factory=dict)

    def read(self, path: Path) -> Any:
        reader = images.read if path.suffix and self.is_image else curves.read
        return reader(path, untrusted=True, **self.options)

    @property
    def is_image(self) -> bool:
        return self.kind.startswith("image")


# --- seeds ------------------------------------------------------------------------------------------------------------


def seeds(folder: Path) -> list[Seed]:
    """One file of each format, and the real ones where they are."""
    heights, known = synthetic.asymmetric(), synthetic.known_curve(n=200)
    bare = {"pixel_size": 1.25e-7, "z_unit": "m"}
    found = [
        Seed("image .gwy", synthetic.write_gwy(folder / "a.gwy", heights, SIDE)),
        Seed("image .ibw", synthetic.write_ibw_image(folder / "b.ibw", {"HeightTrace": heights}, 1.25e-7)),
        Seed("image .nid", synthetic.write_nid(folder / "c.nid", heights, SIDE)),
        Seed("image NanoScope", synthetic_images.write_nanoscope_image(folder / "d.spm", heights, SIDE)),
        Seed("image WSxM", synthetic_images.write_wsxm(folder / "e.stp", heights, SIDE)),
        Seed("image .mi", synthetic_images.write_mi(folder / "f.mi", heights, SIDE)),
        Seed("image text", synthetic.write_matrix(folder / "g.txt", heights, SIDE)),
        Seed("image .xyz", _xyz(folder / "h.xyz", heights), {"z_unit": "m", "pixel_size": 1.25e-7}),
        Seed("image .npy", _npy(folder / "i.npy", heights), bare),
        Seed("image .h5 (bare)", _bare_hdf5(folder / "j.h5", heights), bare),
        Seed("image .h5 (ours)", images.write(folder / "k.h5", images.Topography(heights, (1.25e-7, 1.25e-7)))),
        Seed("curve .ibw", synthetic.write_ibw_curve(folder / "l.ibw", known)),
        Seed("curve JPK", synthetic.write_jpk(folder / "m.jpk-force", [
            ("extend", known.approach_z, known.approach_force), ("retract", known.retract_z, known.retract_force)])),
        Seed("curve .tab", _tab(folder / "n.tab", known)),
        Seed("curve .h5", _hdf5_curve(folder / "o.h5", known)),
        Seed("curve NanoScope", _ramps(folder / "p.000", 1)),
        Seed("curve NanoScope", _ramps(folder / "q.003", 9)),
    ]  # fmt: skip
    return found + [Seed(kind, path) for kind, path in _real()]


def _real() -> Iterator[tuple[str, Path]]:
    kinds = {".nid": "image .nid", ".tiff": "image Park .tiff", ".ibw": "image .ibw", ".mi": "image .mi",
             ".stp": "image WSxM", ".di": "image NanoScope"}  # fmt: skip
    for path in sorted((synthetic.DATA / "images").glob("*")):
        if path.suffix in kinds:
            yield kinds[path.suffix], path
    for path in sorted((synthetic.DATA / "curves").rglob("*.*")):
        if path.suffix == ".ibw" or path.suffix.startswith(".jpk"):
            yield ("curve .ibw" if path.suffix == ".ibw" else "curve JPK"), path
        elif re.fullmatch(r"\.00\d", path.suffix):
            yield "curve NanoScope", path


def _xyz(path: Path, heights: synthetic.Array) -> Path:
    ny, nx = heights.shape
    rows = [f"{i * 1.25e-7:.9g} {j * 1.25e-7:.9g} {heights[j, i]:.9g}" for j in range(ny) for i in range(nx)]
    path.write_text("\n".join(rows) + "\n")
    return path


def _npy(path: Path, heights: synthetic.Array) -> Path:
    np.save(path, heights[::-1])
    return path


def _bare_hdf5(path: Path, heights: synthetic.Array) -> Path:
    import h5py

    with h5py.File(path, "w") as file:
        file["z"] = heights[::-1]
    return path


def _tab(path: Path, known: synthetic.KnownCurve) -> Path:
    columns = {
        "force": np.concatenate([known.approach_force, known.retract_force]),
        "height (measured)": np.concatenate([known.approach_z, known.retract_z]),
        "segment": np.repeat([0, 1], [known.approach_z.size, known.retract_z.size]),
    }
    return synthetic.write_tab(path, columns, {"imaging mode": "force-distance", "spring constant": 0.8})


def _hdf5_curve(path: Path, known: synthetic.KnownCurve) -> Path:
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs.update({"software": "afmformats", "software version": "0.18.7"})
        group = file.create_group("0")
        group.attrs.update({"imaging mode": "force-distance", "spring constant": 0.8, "enum": 0})
        group["force"] = np.concatenate([known.approach_force, known.retract_force])
        group["height (measured)"] = np.concatenate([known.approach_z, known.retract_z])
        group["segment"] = np.repeat([0, 1], [known.approach_z.size, known.retract_z.size]).astype(np.uint8)
    return path


def _ramps(path: Path, count: int) -> Path:
    z = np.arange(256) * 300e-9 / 256
    volts = np.where(40e-9 - z > -20e-9, 40e-9 - z, 0.0) / 41e-9
    return synthetic.write_nanoscope(path, [(volts, volts)] * count, spring_constant=0.5)


# --- damage -----------------------------------------------------------------------------------------------------------

Mutator = Callable[[bytearray, np.random.Generator], bytearray]
_ABSURD = (b"0", b"-1", b"1e99", b"nan", b"inf", b"99999999999", b"1e-30", b"4294967295", b"2147483647", b"")
_ABSURD_BINARY = [struct.pack("<I", n) for n in (0, 1, 0x7FFFFFFF, 0xFFFFFFFF, 0x40000000)]
_ABSURD_BINARY += [struct.pack("<d", x) for x in (0.0, -1.0, 1e300, float("nan"), float("inf"), 1e-30)]


def _place(data: bytearray, rng: np.random.Generator) -> int:
    """Half of them in the header."""
    end = min(len(data), 2048) if rng.random() < 0.5 else len(data)
    return int(rng.integers(end))


def truncated(data: bytearray, rng: np.random.Generator) -> bytearray:
    return data[: int(rng.integers(1, len(data)))]


def flipped(data: bytearray, rng: np.random.Generator) -> bytearray:
    for _ in range(int(rng.integers(1, 9))):
        data[_place(data, rng)] ^= 1 << int(rng.integers(8))
    return data


def scribbled(data: bytearray, rng: np.random.Generator) -> bytearray:
    start = _place(data, rng)
    noise = rng.bytes(int(rng.integers(1, 33)))
    data[start : start + len(noise)] = noise
    return data


def absurd_text(data: bytearray, rng: np.random.Generator) -> bytearray:
    """A number in the header, by the number 0, a huge one, another power of ten ..."""
    numbers = list(re.finditer(rb"(?<![0-9A-Za-z.])[0-9][0-9.]*(?:[eE][-+]?[0-9]+)?", bytes(data[:65536])))
    if not numbers:
        return flipped(data, rng)
    match = numbers[int(rng.integers(len(numbers)))]
    scaled = match[0] + b"0" if rng.random() < 0.3 else _ABSURD[int(rng.integers(len(_ABSURD)))]
    data[match.start() : match.end()] = scaled
    return data


def absurd_binary(data: bytearray, rng: np.random.Generator) -> bytearray:
    value = _ABSURD_BINARY[int(rng.integers(len(_ABSURD_BINARY)))]
    start = _place(data, rng) // 2 * 2
    data[start : start + len(value)] = value
    return data


def extended(data: bytearray, rng: np.random.Generator) -> bytearray:
    return data + rng.bytes(int(rng.integers(1, 5000)))


MUTATORS: tuple[Mutator, ...] = (truncated, flipped, scribbled, absurd_text, absurd_binary, extended)


def mutant(whole: bytes, rng: np.random.Generator) -> bytes:
    """One damaged copy."""
    mutate = MUTATORS[int(rng.integers(len(MUTATORS)))]
    if whole.startswith(b"PK\3\4") and rng.random() < 0.6:
        return _inside_archive(whole, mutate, rng)
    return bytes(mutate(bytearray(whole), rng))


def _inside_archive(whole: bytes, mutate: Mutator, rng: np.random.Generator) -> bytes:
    """Else the archive's check sums find everything."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(whole)) as archive, zipfile.ZipFile(out, "w") as written:
        items = archive.infolist()
        held = [number for number, item in enumerate(items) if item.file_size > 1]
        chosen = held[int(rng.integers(len(held)))]
        for number, item in enumerate(items):
            content = archive.read(item)
            written.writestr(item, bytes(mutate(bytearray(content), rng)) if number == chosen else content)
    return out.getvalue()


# --- what becomes of them ---------------------------------------------------------------------------------------------


def outcome(seed: Seed, path: Path, whole: Any) -> tuple[str, str]:
    """One of :data:`OUTCOMES`, and what was said."""
    try:
        found = seed.read(path)
    except ReadError as error:
        return ("stopped" if error.reader == "worker" else "refused"), str(error)
    if seed.is_image:
        check_image(found)
        if not np.allclose(found.pixel_size, whole.pixel_size, rtol=1e-9) or found.shape != whole.shape:
            return "scale", repr(found)
        spans = np.ptp(found.heights), np.ptp(whole.heights)
        if not np.array_equal(found.heights, whole.heights):
            return ("scale" if _rescaled(found.heights, whole.heights) else "values"), f"{spans}"
        return "same", ""
    for curve in found:
        check_curve(curve)
    return _compared_curves(found, whole), ""


def _rescaled(found: synthetic.Array, whole: synthetic.Array) -> bool:
    """Whether all values changed by one factor."""
    if found.shape != whole.shape or not np.ptp(whole):
        return False
    factor = np.ptp(found) / np.ptp(whole)
    return bool(abs(factor - 1.0) > 1e-9 and np.allclose(found - found.mean(), factor * (whole - whole.mean())))


def _compared_curves(found: list[curves.ForceCurve], whole: list[curves.ForceCurve]) -> str:
    if [[len(s) for s in c.segments] for c in found] != [[len(s) for s in c.segments] for c in whole]:
        return "values"
    for one, other in zip(found, whole, strict=True):
        for a, b in zip(one.segments, other.segments, strict=True):
            for key in ("z", "force"):
                x, y = getattr(a, key), getattr(b, key)
                if not np.array_equal(x, y):
                    return "scale" if _rescaled(x, y) else "values"
    return "same" if all(a.meta.get("spring constant") == b.meta.get("spring constant")
                         for a, b in zip(found, whole, strict=True)) else "scale"  # fmt: skip


def check_image(topography: images.Topography) -> None:
    """What every image that was accepted keeps, with numbers of its own."""
    assert np.isfinite(topography.heights).all()
    assert topography.heights.size <= 64 * 2**20
    assert 1e-9 <= min(topography.size) <= max(topography.size) <= 1e-3
    assert 1e-12 <= np.ptp(topography.heights) <= min(1e-4, max(topography.size))


def check_curve(curve: curves.ForceCurve) -> None:
    """What every curve that was accepted keeps."""
    for segment in curve.segments:
        assert segment.force is not None
        assert np.isfinite(segment.z).all()
        assert np.isfinite(segment.force).all()
        assert np.abs(segment.force).max() <= 1e-2
        assert np.ptp(segment.z) <= 1e-3
    assert curve.spring_constant is None or 1e-4 <= curve.spring_constant <= 1e4


def run(folder: Path, per_seed: int, random_seed: int = 1, *, real: bool = True) -> dict[str, Counter[str]]:
    """Outcomes by kind of file. Raises AssertionError if something implausible was accepted."""
    found: dict[str, Counter[str]] = {}
    for number, seed in enumerate(seeds(folder)):
        if not real and seed.path.parent != folder:
            continue
        whole, content = seed.read(seed.path), seed.path.read_bytes()
        rng = np.random.default_rng([random_seed, number])
        path = folder / f"mutant{seed.path.suffix}"
        for _ in range(per_seed):
            path.write_bytes(mutant(content, rng))
            what, said = outcome(seed, path, whole)
            found.setdefault(seed.kind, Counter())[what] += 1
            if what == "stopped":
                print(f"{seed.kind} ({seed.path.name}): {said}", file=sys.stderr)
    return found


def table(found: dict[str, Counter[str]]) -> str:
    """Markdown; the last column is the share of mutants that were read with another content."""
    lines = ["| file | damaged | refused | same content | other values | other scale | stopped | undetected |"]
    lines.append("|---|---|---|---|---|---|---|---|")
    for kind in [*sorted(found), "all"]:
        counts = sum(found.values(), Counter()) if kind == "all" else found[kind]
        total = sum(counts.values())
        undetected = counts["values"] + counts["scale"]
        shown = " | ".join(str(counts[key]) for key in OUTCOMES)
        lines.append(f"| {kind} | {total} | {shown} | {100 * undetected / total:.0f} % |")
    return "\n".join(lines)


def main() -> int:
    """The table; the exit status says whether the readers held."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="damaged files in all (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (default: %(default)s)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        per_seed = -(-args.count // len(seeds(folder)))
        found = run(folder, per_seed, args.seed)
    print(table(found))
    total = sum(found.values(), Counter())
    return int(total["stopped"] > ALLOWED_STOPS * sum(total.values()))


if __name__ == "__main__":
    sys.exit(main())
