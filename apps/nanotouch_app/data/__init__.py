# SPDX-License-Identifier: BSD-3-Clause
"""Commands that read, fit and convert what was measured."""
