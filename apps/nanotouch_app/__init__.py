# SPDX-License-Identifier: BSD-3-Clause
"""The ``nanotouch`` command and the 3-D view, on the public API of the library only."""
