# SPDX-License-Identifier: BSD-3-Clause
"""Studies with the library: the figures of the paper, and speed against accuracy."""
