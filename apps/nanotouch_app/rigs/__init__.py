# SPDX-License-Identifier: BSD-3-Clause
"""Commands about a rig and the machine it runs on."""
