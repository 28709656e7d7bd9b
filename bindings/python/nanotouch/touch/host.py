# SPDX-License-Identifier: BSD-3-Clause
"""What a live session offers to a person, as the C library has it (host.h, docs/host.md). For the programs beside this
package; not a part of its promises."""

from __future__ import annotations

from nanotouch._core import HostSlider as Slider
from nanotouch._core import LiveHost, Proxy
from nanotouch._core import host_facts as facts
from nanotouch._core import host_presets as presets
from nanotouch._core import host_slider_fields as slider_fields
from nanotouch._core import host_sliders as sliders
from nanotouch._core import host_tasks as tasks
from nanotouch._core import proxy_glide as GLIDE
from nanotouch._core import proxy_load as LOAD

__all__ = [
    "GLIDE", "LOAD", "LiveHost", "Proxy", "Slider", "facts", "presets", "slider_fields", "sliders", "tasks",
]  # fmt: skip
