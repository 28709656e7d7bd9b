# SPDX-License-Identifier: BSD-3-Clause
"""Where the ``nanotouch`` command begins and ends, in a process of its own."""

import atexit
import os
import signal
import sys


def start() -> int:
    """Run the command; returns the exit status. A signal before it runs ends the process without a traceback."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from nanotouch.awaiting import left

    from nanotouch_app.main import main

    status = main()
    if left():  # beneath compiled code that still runs nothing is taken down
        atexit._run_exitfuncs()
        os._exit(status)
    return status


if __name__ == "__main__":
    sys.exit(start())
