# SPDX-License-Identifier: BSD-3-Clause
"""Sessions at the paper's literal values, some of which a stop ends: the figure shows that, and no warning has to."""

import warnings
from typing import Any

from nanotouch import Recording, Session


def run(session: Session, *args: Any, **options: Any) -> Recording:
    """As Session.run, without the warning of a run that a stop ended."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the session", UserWarning)
        return session.run(*args, **options)
