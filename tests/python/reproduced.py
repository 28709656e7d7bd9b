# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the paper, each computed once for all tests of a process."""

from __future__ import annotations

import functools

from nanotouch_app.studies import reproduce

reproduction = functools.cache(reproduce.reproduction)
