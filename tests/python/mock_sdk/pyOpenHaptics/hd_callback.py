# SPDX-License-Identifier: BSD-3-Clause
"""A callback is called with one argument, and goes on until there is an error."""

import functools

from . import hd


def hd_callback(input_function):
    @functools.wraps(input_function)
    def _callback(pUserData):
        input_function()
        return hd.DONE if hd.get_error() else hd.CONTINUE

    return _callback


def hdAsyncSheduler(callback):
    hd.schedule(callback)
