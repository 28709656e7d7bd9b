# SPDX-License-Identifier: BSD-3-Clause
"""Programs for devices on the market, each a process of its own behind a mailbox (docs/devices.md)."""
