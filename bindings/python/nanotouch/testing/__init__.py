# SPDX-License-Identifier: BSD-3-Clause
"""Test your own program, backend or law against a rig that behaves like a real one, in virtual time.

The assertions are for any test framework; what they raise says what a person needs: "tip force 412 nN exceeded 400 nN
at 1.204 s; HOLD came 3 ticks later". With pytest there are fixtures beside them (``pytest_nanotouch``).
"""

from nanotouch.testing.checks import (
    assert_conforms,
    assert_force_below,
    assert_guarantee_kept,
    assert_reacts,
    assert_runs,
)
from nanotouch.testing.comparison import assert_same
from nanotouch.testing.hand import scripted_hand

__all__ = [
    "assert_conforms", "assert_force_below", "assert_guarantee_kept", "assert_reacts", "assert_runs", "assert_same",
    "scripted_hand",
]  # fmt: skip
