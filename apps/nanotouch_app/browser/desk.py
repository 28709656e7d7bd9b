# SPDX-License-Identifier: BSD-3-Clause
"""Host and browsers together: the session stays in this process, pages come and go."""

from __future__ import annotations

from typing import Any

from nanotouch.images import Topography

from nanotouch_app.browser.server import Server
from nanotouch_app.browser.update import surface_bytes
from nanotouch_app.live.serving import serve


class BrowserDesk:
    """What a window's desk is, for pages."""

    def __init__(
        self, topography: Topography, page: bytes, port: int = 0, corner: tuple[float, float] = (0.0, 0.0)
    ) -> None:  # fmt: skip
        self.server = Server(page, port)
        self.server.readers.corner = corner
        self.asked = self.server.asked
        self.topography = topography
        self.server.readers.surface = surface_bytes(topography.heights, topography.pixel_size)

    def tell(self, message: dict[str, Any]) -> None:
        """To the pages."""
        self.server.tell(message)

    def wait_ready(self) -> str:
        """There is nothing to wait for."""
        return self.links()

    def links(self, does: str = "touch it") -> str:
        """In words, for the terminal; ``does``: what the first one is for."""
        server, keys = self.server, self.server.keys
        return (f"{does} (this link works once):\n  {server.link(keys.operate)}\n"
                f"watch it (any number):\n  {server.link(keys.watch)}\n"
                f"from another machine: ssh -L {server.port}:localhost:{server.port} THIS_MACHINE, "
                "then the same links there\n"
                "Ctrl-C ends the session.")  # fmt: skip

    def serve(self, host: Any, first: dict[str, Any] | None = None, until: float | None = None) -> None:
        """Until Ctrl-C, or a time of the monotonic clock: what is asked, what happens by itself, the clock."""
        if properties := host.properties():
            self.server.readers.surface = surface_bytes(self.topography.heights, self.topography.pixel_size, properties)
        host.report()
        serve(self, host, first, until)

    def close(self) -> None:
        """End the server."""
        self.server.close()
