# SPDX-License-Identifier: BSD-3-Clause
"""More small images in real formats, as :mod:`synthetic`: row 0 of the heights is the lower edge of the picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from synthetic import Array


def write_nanoscope_image(path: Path, heights: Array, side: tuple[float, float]) -> Path:
    """Bruker's NanoScope 8 image: int16 lines from the bottom up, full scale = 65536 counts."""
    ny, nx = heights.shape
    sensitivity = 25e-9  # m/V
    middle = 0.5 * (heights.max() + heights.min())
    full = 1.01 * float(np.ptp(heights)) / sensitivity  # V
    counts = np.round((heights - middle) / sensitivity / full * 65536.0).astype("<i2")
    width, height, offset = side[1] * 1e9, side[0] * 1e9, 2048
    lines = [
        "*File list", "Version: 0x08150300", "Date: 01:06:11 PM Wed Oct 09 2019", f"Data length: {offset}",
        "*Scanner list", f"@Sens. Zsens: V {sensitivity * 1e9:.5f} nm/V",
        "*Ciao scan list", f"Scan Size: {width:.6g} nm", f"Samps/line: {nx}", f"Lines: {ny}",
        "*Ciao image list", f"Data offset: {offset}", f"Data length: {counts.nbytes}", "Bytes/pixel: 2",
        f"Samps/line: {nx}", f"Number of lines: {ny}", f"Scan Size: {width:.6g} {height:.6g} nm",
        '@2:Image Data: S [Height] "Height"', "@Z magnify: C [2:Z scale] 1.000000",
        f"@2:Z scale: V [Sens. Zsens] ({full / 65536.0:.12g} V/LSB) {full:.12g} V", "*File list end",
    ]  # fmt: skip
    header = "".join(f"\\{line}\r\n" for line in lines).encode("latin-1") + b"\x1a"
    path.write_bytes(header.ljust(offset, b"\0") + counts.tobytes())
    return path


def write_nanoscope_channel(path: Path, values: Array, side: tuple[float, float], name: str, sensitivity: str) -> Path:
    """The same with one channel that is no height: ``sensitivity`` is what the header says of it, as ``2.5 MPa/V``."""
    ny, nx = values.shape
    per_volt = float(sensitivity.split()[0])
    full = 2.1 * float(np.abs(values).max()) / per_volt  # V
    counts = np.round(values / per_volt / full * 65536.0).astype("<i2")
    width, height, offset = side[1] * 1e9, side[0] * 1e9, 2048
    lines = [
        "*File list", "Version: 0x08150300", "Date: 01:06:11 PM Wed Oct 09 2019", f"Data length: {offset}",
        "*Scanner list", "@Sens. Zsens: V 25 nm/V",
        "*Ciao scan list", f"Scan Size: {width:.6g} nm", f"Samps/line: {nx}", f"Lines: {ny}",
        f"@Sens. {name}Sens: V {sensitivity}",
        "*Ciao image list", f"Data offset: {offset}", f"Data length: {counts.nbytes}", "Bytes/pixel: 2",
        f"Samps/line: {nx}", f"Number of lines: {ny}", f"Scan Size: {width:.6g} {height:.6g} nm",
        f'@2:Image Data: S [{name}] "{name}"', "@Z magnify: C [2:Z scale] 1.000000",
        f"@2:Z scale: V [Sens. {name}Sens] ({full / 65536.0:.12g} V/LSB) {full:.12g} V", "*File list end",
    ]  # fmt: skip
    header = "".join(f"\\{line}\r\n" for line in lines).encode("latin-1") + b"\x1a"
    path.write_bytes(header.ljust(offset, b"\0") + counts.tobytes())
    return path


def write_wsxm(path: Path, heights: Array, side: tuple[float, float]) -> Path:
    """WSxM's .stp with doubles: the picture turned by 180 degrees, its first pixel the lower right one."""
    ny, nx = heights.shape
    data = np.ascontiguousarray(heights[:, ::-1] * 1e9, "<f8").tobytes()
    body = [
        "[Control]", f"    X Amplitude: {side[1] * 1e9:.6g} nm", f"    Y Amplitude: {side[0] * 1e9:.6g} nm",
        "[General Info]", "    Image Data Type: double", f"    Number of columns: {nx}", f"    Number of rows: {ny}",
        f"    Z Amplitude: {np.ptp(heights) * 1e9:.6g} nm", "[Header end]", "",
    ]  # fmt: skip
    text = "\r\n".join(body)
    first = "WSxM file copyright UAM\r\nSxM Image file\r\nImage header size: "
    size = len(first) + 5 + len(text)
    path.write_bytes(f"{first}{size}\r\n{text}".encode("latin-1") + data)
    assert len(str(size)) == 3  # what the 5 above stands for, with the end of its line
    return path


def write_mi(path: Path, heights: Array, side: tuple[float, float]) -> Path:
    """Agilent's .mi: keys of 14 characters, then int32 lines from the bottom up, normalised with the range."""
    ny, nx = heights.shape
    span = 2.0 * float(np.abs(heights).max()) * 1e6  # um
    counts = np.round(heights * 1e6 / span * 2.0**31).astype("<i4")
    facts = {
        "fileType": "Image", "version": "PicoView 0x10c04", "xPixels": nx, "yPixels": ny,
        "xLength": repr(side[1]), "yLength": repr(side[0]), "scanUp": "TRUE", "bufferLabel": "Topography",
        "bufferRange": repr(span), "bufferUnit": "um", "data": "BINARY_32",
    }  # fmt: skip
    path.write_bytes("".join(f"{key:14}{value}\n" for key, value in facts.items()).encode() + counts.tobytes())
    return path
