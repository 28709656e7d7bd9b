# SPDX-License-Identifier: BSD-3-Clause
"""The exceptions of nanotouch: one base, so that ``except nanotouch.Error`` catches everything we raise on purpose."""

from __future__ import annotations

import importlib
import sys
import warnings
from types import ModuleType

from nanotouch.extras import ADDS, advice


class Error(Exception):
    """Base of all nanotouch errors."""


class InvalidValue(Error, ValueError):
    """A value is missing, not finite or outside its valid range; the message names it, its unit and the range."""


class ReadError(Error, OSError):
    """A file cannot be read, or what it holds is not plausible; the message names file, reason and reader.

    Attributes
    ----------
    reader : str
        What read the file, as ``"SurfaceTopography/gwy"``; empty where none was reached.
    """

    def __init__(self, message: str, reader: str = "") -> None:
        super().__init__(message)
        self.reader = reader

    def __str__(self) -> str:
        message = super().__str__()
        return f"{message} (reader: {self.reader})" if self.reader and self.reader not in message else message


class SolverError(Error, ArithmeticError):
    """A solver has no solution there or did not converge."""


class DeviceError(Error, OSError):
    """A device is missing or failed."""


class MissingExtra(Error, ImportError):
    """An optional package is missing; the message names the extra that installs it."""


def require(module: str, extra: str) -> ModuleType:
    """Import an optional module, or raise :class:`MissingExtra` naming the extra that brings it. What it says while it
    loads, such as that it goes without MPI, is no warning about the user's data."""
    loaded = sys.modules.get(module)
    if loaded is not None:
        return loaded
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(module)
    except ImportError as error:
        raise missing(module, extra) from error


def missing(module: str, extra: str) -> MissingExtra:
    """The error of a module that is not there, naming what installs it."""
    return MissingExtra(f"{module} is not installed (extra {extra}, {ADDS[extra]}): {advice(extra)}")
