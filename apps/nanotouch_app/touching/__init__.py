# SPDX-License-Identifier: BSD-3-Clause
"""Commands that touch, scan, push and indent."""
