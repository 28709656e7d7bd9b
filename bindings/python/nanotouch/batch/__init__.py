# SPDX-License-Identifier: BSD-3-Clause
"""Many force curve files: one row of results for each curve, whatever some of the files are like.

>>> import nanotouch as nt
>>> summary = nt.batch.fit_files(["day1"], "results.csv", model="jkr", radius=20e-9)         # doctest: +SKIP

A killed or repeated run goes on from what is in the journal beside the results: docs/maps.md.
"""

from .files import WITHOUT, Summary, files_of, fit_files
from .groups import FOLDER, Spread, spreads
from .pulls import Pulls, pulls
from .report import write_report
from .review import Place, Review
from .sidecar import Decision, Sidecar
from .stability import Stabilities, stabilities

__all__ = [
    "FOLDER",
    "WITHOUT",
    "Decision",
    "Place",
    "Pulls",
    "Review",
    "Sidecar",
    "Spread",
    "Stabilities",
    "Summary",
    "files_of",
    "fit_files",
    "pulls",
    "spreads",
    "stabilities",
    "write_report",
]
