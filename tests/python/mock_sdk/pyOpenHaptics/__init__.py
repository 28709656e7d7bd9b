# SPDX-License-Identifier: BSD-3-Clause
"""A mock of pyopenhaptics 1.0, after its source: what a bridge calls of it, over a device on the desk."""
