# SPDX-License-Identifier: BSD-3-Clause
"""What all rooms need of files and text: clear errors, whole files, a worker for files that are not trusted."""
