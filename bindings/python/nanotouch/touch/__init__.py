# SPDX-License-Identifier: BSD-3-Clause
"""A touch: :class:`~nanotouch.Session` and what it consists of.

Who leads it (``operator``, ``commands``), with what (``hal``, ``rig_file``, ``faults``), how safely (``margins``,
``supervisor``) and what stays of it (``record``, ``columns``, ``replay``, ``frames``).
"""
