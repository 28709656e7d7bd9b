# SPDX-License-Identifier: BSD-3-Clause
"""What every test starts from."""

import signal


def pytest_configure() -> None:
    """Let Ctrl-C through: a shell that runs the tests in the background ignores SIGINT, and so would all they start."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
