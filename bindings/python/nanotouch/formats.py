# SPDX-License-Identifier: BSD-3-Clause
"""Which files are read, by what, and what to export from those that are not.

One table, from which come the tables of the documentation (``python -m nanotouch.formats images``) and the sentence
with which a known file is refused.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

Kind = Literal["images", "curves"]

HDF5 = b"\x89HDF\r\n\x1a\n"
_NANOSCOPE_HEADER, _IGOR_LAYERS = 1 << 20, 64 + 76  # length, and place of the count of pictures [byte]
HEAD = 1024  # bytes at the start of a file by which it is recognised

_GWY = "open it in Gwyddion and save it as .gwy"
_TEXT = "export it as text and build the curve with curves.ForceCurve and curves.Segment"


@dataclass(frozen=True)
class Format:
    """One kind of file.

    Attributes
    ----------
    name : str
        Vendor and format.
    endings : tuple of str
        Usual endings, lower case.
    kind : {"images", "curves"}
        What is wanted of it.
    reader : str
        What reads it; empty where it is refused.
    tried : str
        What reading was tested on: ``"real file"``, ``"file made by the tests"``, ``"not tried"``.
    remedy : str
        What to do instead, where it is refused.
    signatures : tuple of (int, bytes)
        Offset and bytes by which a refused file is known; without any, the ending decides.
    """

    name: str
    endings: tuple[str, ...]
    kind: Kind
    reader: str = ""
    tried: str = ""
    remedy: str = ""
    signatures: tuple[tuple[int, bytes], ...] = ()

    def matches(self, file: Path, head: bytes) -> bool:
        """Whether a file that begins with `head` is one of these."""
        if self.signatures:
            return any(head[at : at + len(mark)] == mark for at, mark in self.signatures)
        return file.suffix.lower() in self.endings


def _reads(name: str, endings: str, kind: Kind, reader: str, tried: str) -> Format:
    return Format(name, tuple(endings.split()), kind, reader, tried)


def _refuses(name: str, endings: str, kind: Kind, remedy: str, *signatures: tuple[int, bytes]) -> Format:
    return Format(name, tuple(endings.split()), kind, remedy=remedy, signatures=signatures)


_ST, _AF, _OWN, _REAL, _MADE, _NOT = (
    "SurfaceTopography",
    "afmformats",
    "nanotouch",
    "real file",
    "file made by the tests",
    "not tried",
)

_RAMPS = f"{_REAL}, {_MADE}"

FORMATS: tuple[Format, ...] = (
    _reads("Bruker/Veeco/DI NanoScope", ".spm .000 .001 .di", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Asylum Research (Igor binary wave)", ".ibw", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("JPK image (TIFF)", ".jpk .jpk-qi-image", "images", _ST, _REAL),
    _reads("JPK movie (HDF5), each frame a channel", ".h5-jpk", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Nanonis", ".sxm", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("TopoStats", ".topostats", "images", _OWN, _MADE),
    _reads("Gwyddion Simple Field", ".gsf", "images", _OWN, _MADE),
    _reads("Park Systems", ".tiff", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Nanosurf easyScan", ".nid", "images", _ST, f"{_REAL}, {_MADE}"),
    _reads("NT-MDT", ".mdt", "images", f"{_ST}; arrays of later versions: {_OWN}", f"{_REAL}, {_MADE}"),
    _reads("Agilent/Keysight PicoView", ".mi", "images", _ST, _REAL),
    _reads("WSxM", ".stp .top", "images", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Gwyddion", ".gwy", "images", _ST, _MADE),
    _reads("text matrix with Gwyddion's header", ".txt .asc", "images", _ST, _MADE),
    _reads("text of x, y, z", ".xyz", "images", _ST, _MADE),
    _reads("HDF5 of nanotouch.images.write", ".h5 .hdf5", "images", _OWN, _MADE),
    _reads("bare HDF5 array", ".h5", "images", _ST, _MADE),
    _reads("bare numpy array", ".npy .npz", "images", _ST, _MADE),
    _reads("profilers: AL3D, FRT, SUR, X3P, SDF, BCR, OPD, Keyence, Zygo ...", ".al3d .frt .sur", "images", _ST, _REAL),
    _refuses("Omicron/Scienta MATRIX", ".mtrx ._mtrx", "images", _GWY, (0, b"ONTMATRX")),
    _refuses("Omicron SCALA", ".par .tf0", "images", _GWY),
    _refuses("RHK", ".sm4 .sm3 .sm2", "images", _GWY, (2, "STiMage".encode("utf-16-le"))),
    _refuses("ISO 28600 (SPM data transfer)", ".spm", "images", _GWY, (0, b"ISO/TC 201 SPM data transfer format")),
    _refuses("Nanosurf HDF5", ".nhf", "images", "export it from the Nanosurf software as .nid, or " + _GWY),
    _refuses("Park SmartScan container", ".ps-ppt", "images", "export it from SmartScan as .tiff"),
    _refuses("Asylum force map archive", ".ardf", "images", "export it from Igor as .ibw", (8, b"ARDF")),
    _refuses("Igor packed experiment", ".pxp", "images", "save the wave in Igor as .ibw"),
    _refuses("RIBM high-speed AFM", ".asd", "images", _GWY),
    _refuses("Anasys Analysis Studio", ".axz .axd", "images", _GWY),
    _refuses("file packed by gzip", ".gz", "images", "unpack it first", (0, b"\x1f\x8b")),
    _refuses("Topometrix", ".tfr .ffr .zfr", "images", _GWY, (0, b"#R3"), (0, b"#R4"), (0, b"#R5")),
    _refuses("picture (PNG)", ".png", "images", "a picture holds colours, not heights: use the instrument's own file",
             (0, b"\x89PNG")),
    _refuses("picture (JPEG)", ".jpg .jpeg", "images",
             "a picture holds colours, not heights: use the instrument's own file", (0, b"\xff\xd8\xff")),
    _reads("JPK force curve", ".jpk-force", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("JPK force map", ".jpk-force-map", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("JPK quantitative imaging", ".jpk-qi-data", "curves", _OWN, _NOT),
    _reads("JPK quantitative imaging, series", ".jpk-qi-series", "curves", _OWN, _REAL),
    _reads("Asylum Research (Igor binary wave)", ".ibw", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Nanonis spectroscopy over z", ".dat", "curves", _OWN, _MADE),
    _reads("Asylum Research, pair of deflection and height", "Defl.ibw", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Bruker NanoScope ramp", ".spm .000 .001", "curves", _OWN, _RAMPS),
    _reads("Bruker NanoScope force volume", ".spm .003", "curves", _OWN, _RAMPS),
    _reads("Bruker PeakForce capture", ".pfc", "curves", _OWN, _MADE),
    _reads("NT-MDT text, exported by Nova", ".txt", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("JPK text export", ".txt .out", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("Bruker NanoScope text export", ".txt", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _reads("AFM Workshop", ".csv .zip", "curves", _AF, _REAL),
    _reads("Optics11 Chiaro text", ".txt", "curves", _AF, _REAL),
    _reads("afmformats' own", ".h5 .tab", "curves", _AF, _MADE),
    _reads("archive of any of these", ".zip", "curves", _OWN, f"{_REAL}, {_MADE}"),
    _refuses("Asylum force map archive", ".ardf", "curves", "export single curves from Igor as .ibw", (8, b"ARDF")),
    _refuses("Igor packed experiment", ".pxp", "curves", "save the wave in Igor as .ibw"),
    _refuses("Park Systems", ".tiff .ps-ppt", "curves", _TEXT, (0, b"II*\0"), (0, b"MM\0*")),
    _refuses("Nanosurf", ".nid .nhf", "curves", _TEXT),
    _refuses("NT-MDT", ".mdt", "curves", "export the curves from Nova as text", (0, b"\x01\xb0\x93\xff")),
    _refuses("Anasys Analysis Studio", ".axz .axd", "curves", _TEXT),
    _refuses("file packed by gzip", ".gz", "curves", "unpack it first", (0, b"\x1f\x8b")),
    _refuses("Nanonis grid of spectra", ".3ds", "curves", _TEXT),
    _refuses("Omicron/Scienta MATRIX", ".mtrx", "curves", _TEXT, (0, b"ONTMATRX")),
    _refuses("WSxM curve", ".cur", "curves", _TEXT, (0, b"WSxM file copyright")),
    _refuses("Gwyddion", ".gwy", "curves", f"for an image: nanotouch image; for a curve: {_TEXT}", (0, b"GWYP")),
    _refuses("Agilent/Keysight PicoView", ".mi", "curves", _TEXT, (0, b"fileType ")),
)  # fmt: skip


def refusal(file: Path, head: bytes, kind: Kind) -> str | None:
    """Why a known file of this kind is not read and what to do; None if it is not known as such."""
    for known in FORMATS:
        if known.kind == kind and not known.reader and known.matches(file, head):
            return f"{known.name}: not read as {kind}; {known.remedy}"
    return None


def begins_with(file: Path, mark: bytes) -> bool:
    """Whether these are its first bytes."""
    return _head(file).startswith(mark)


def _head(file: Path) -> bytes:
    """Empty where it cannot be read, a pipe (which would wait for ever) included: who reads it says why."""
    if not file.is_file():
        return b""
    try:
        with file.open("rb") as stream:
            return stream.read(HEAD)
    except OSError:
        return b""


def is_image(file: Path) -> bool:
    """Whether a file is known as one of images that is refused as curves, by its first bytes or its ending."""
    head = _head(file)
    read = any(known.kind == "images" and known.reader and file.suffix.lower() in known.endings for known in FORMATS)
    return read and refusal(file, head, "curves") is not None


def looks_like_image(file: Path) -> bool:
    """Whether it is to be tried as an image first: by the header of NanoScope and Igor, else by an ending that curves
    do not have."""
    head = _head(file)
    if head.startswith(b"\\*File list"):
        with file.open("rb") as stream:
            return b"\\*Ciao force" not in stream.read(_NANOSCOPE_HEADER)
    if head[:2] in (b"\5\0", b"\0\5"):
        layers = head[_IGOR_LAYERS : _IGOR_LAYERS + 4]
        return len(layers) == 4 and any(layers)
    ending = file.suffix.lower()
    kinds = {known.kind for known in FORMATS if known.reader and ending in known.endings}
    return kinds == {"images"} and not head.startswith(b"\\*")


def markdown(kind: Kind) -> str:
    """The table for the documentation."""
    lines = ["| format | endings | read by | tried on, or what to do |", "|---|---|---|---|"]
    for known in FORMATS:
        if known.kind == kind:
            endings = " ".join(f"`{ending}`" for ending in known.endings)
            lines.append(f"| {known.name} | {endings} | {known.reader or 'refused'} | {known.tried or known.remedy} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print("\n\n".join(markdown("curves" if name == "curves" else "images") for name in sys.argv[1:] or ["images"]))
