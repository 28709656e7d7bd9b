# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 15: the spikes of a tip characteriser, imaged in tapping mode, beside their view in three dimensions with the
ball that is the tip."""

from __future__ import annotations

from functools import cache
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import presets
from nanotouch.plots import SKY

from nanotouch_app.studies.reproduce import paper
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, near, quantity

SIZE = Parameter("side of the image", 6e-6, "m", "Sec. V, TGT-01")
HEIGHT = Parameter("height of the spikes", 0.3e-6, "m", "Sec. V, TGT-01")
PITCH = Parameter("pitch of the spikes", 2.12e-6, "m", "not in the text; as the characteriser is sold")
ANGLE = Parameter("full angle of a spike", 0.872, "rad", "not in the text; as the characteriser is sold")
APEX = Parameter("radius of a spike", 8e-9, "m", "not in the text; below 10 nm as it is sold")
SET_POINT = Parameter("amplitude over the free one", 0.7, "", "not in the text")
PIXELS = Parameter("pixels of a line, and lines", 80, "", "not in the text")
PARAMETERS = (SIZE, HEIGHT, PITCH, ANGLE, APEX, SET_POINT, PIXELS, paper.TIP, paper.CANTILEVER)
FORCES = 0.3  # accuracy of the peak forces of the image; its heights are finer [-]
BALL, STRETCH = 10.0, 4.0  # the ball is drawn so many times as large as the tip, heights so many times as high
VIEW = 32.0, -62.0  # elevation and azimuth that are chosen [degrees]


def array() -> nt.Topography:
    """The spikes, one of them in the middle."""
    return nt.surface.spikes(
        SIZE.value, radius=APEX.value, height=HEIGHT.value, half_angle=0.5 * ANGLE.value, pitch=PITCH.value
    )


@cache
def image() -> Any:
    """What a slow scan shows: the loop has settled at each pixel."""
    scene, rig = presets.paper_silicon()
    scan = nt.Scan(
        raster={"width": SIZE.value, "height": SIZE.value, "pixels": PIXELS.value, "lines": PIXELS.value},
        zloop={"set_amplitude": SET_POINT.value},
    )
    plan = scene.plan(surface=nt.Surface.touched_by(scene, array()))
    return nt.Scanner(plan, scan, rig).steady(FORCES)


def reproduce() -> Reproduction:
    """Compute the figure."""
    made = image()
    heights = np.asarray(made.trace.height) - np.min(made.trace.height)
    dy, dx = made.pixel_size
    y, x = np.meshgrid(*((np.arange(count) + 0.5) * step for count, step in zip(heights.shape, (dy, dx), strict=True)),
                       indexing="ij")  # fmt: skip
    columns: dict[str, Floats] = {
        "x [m]": x.ravel(), "y [m]": y.ravel(), "height of the apex [m]": heights.ravel(),
        "peak force [N]": np.asarray(made.trace.peak_force).ravel(),
    }  # fmt: skip
    statements = (_height(heights), _pitch(heights, float(dx)), _force(made))
    return Reproduction(15, "spikes imaged by tapping, and their view in three dimensions", PARAMETERS, columns,
                        statements, lambda figure: _draw(figure, x, y, heights))  # fmt: skip


def _height(heights: Floats) -> Statement:
    found = float(np.ptp(heights))
    return Statement(
        "the image of the TGT-01 array is 6 x 6 x 0.3 um", "V, Fig. 15", holds(near(found / HEIGHT.value)),
        "highest minus lowest place of the apex", found, "m", "A tip of 20 nm reaches the ground between spikes.",
    )  # fmt: skip


def _pitch(heights: Floats, pixel: float) -> Statement:
    found = pitch_of(heights) * pixel
    return Statement(
        "the spikes stand in a square array", "V, Fig. 15", holds(near(found / PITCH.value)),
        "shift along x at which the image is most like itself", found, "m",
        f"They were placed {quantity(PITCH.value, 'm')} apart; a pixel is {quantity(pixel, 'm')}.",
    )  # fmt: skip


def pitch_of(heights: Floats) -> float:
    """[pixels]; a shift of less than an eighth of the image is none."""
    rows = heights - heights.mean()
    shifts = np.arange(heights.shape[1] // 8, heights.shape[1] // 2)
    alike = [float(np.mean(rows[:, shift:] * rows[:, :-shift])) for shift in shifts]
    return float(shifts[int(np.argmax(alike))])


def _force(made: Any) -> Statement:
    largest = float(np.nanmax(made.trace.peak_force))
    return Statement(
        "tapping leaves tip and sample whole", "V", "cannot be compared", "max force on the tip", largest, "N",
        "No force is printed for the image. It is taken slowly; a fast scan presses more on the way up a spike.",
    )  # fmt: skip


def _draw(figure: Any, x: Floats, y: Floats, heights: Floats) -> None:
    flat, view = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="3d")
    side = SIZE.value * 1e6
    shown = flat.imshow(heights * 1e9, origin="lower", extent=(0.0, side, 0.0, side), cmap="copper")
    figure.colorbar(shown, ax=flat, label="height (nm)", shrink=0.8)
    flat.set_title("image in tapping mode", loc="left", fontsize="medium")
    flat.set_xlabel("x (µm)")
    flat.set_ylabel("y (µm)")
    view.computed_zorder = False  # matplotlib would put the ball below the ground
    view.plot_surface(x * 1e6, y * 1e6, heights * 1e6, cmap="copper", rstride=1, cstride=1, linewidth=0.0)
    radius = BALL * paper.TIP.value * 1e6
    place = 0.5 * side - 0.5 * PITCH.value * 1e6  # on the ground, between four spikes
    turn, up = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 33), np.linspace(0.0, np.pi, 17))
    view.plot_surface(
        place + radius * np.sin(up) * np.cos(turn), place + radius * np.sin(up) * np.sin(turn),
        radius * (1.0 - np.cos(up)) / STRETCH, color=SKY, linewidth=0.0, zorder=3,
    )  # fmt: skip
    view.set_box_aspect((side, side, STRETCH * HEIGHT.value * 1e6))
    view.view_init(*VIEW)
    view.set_title(f"heights {STRETCH:g} times as high; the ball is the tip, {BALL:g} times as large", loc="left",
                   fontsize="medium")  # fmt: skip
    view.set_xlabel("x (µm)")
    view.set_ylabel("y (µm)")
    view.set_zticks([0.0, HEIGHT.value * 1e6])
