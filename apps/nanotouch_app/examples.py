# SPDX-License-Identifier: BSD-3-Clause
"""The examples of every ``--help``. In the order of :data:`EXAMPLES` they work as written, in an empty folder."""

from __future__ import annotations

EXAMPLES: dict[str, tuple[tuple[str, str], ...]] = {
    "samples": (("nanotouch samples", "scan.gwy, curve.h5, map.h5, scene.toml, ...: for the other examples"),),
    "touch": (
        ("nanotouch touch", "press on a grating of 480 nm"),
        ("nanotouch touch scan.gwy --mode scan --out result", "feel a line over an image"),
        ("nanotouch touch --surface dots --mode topography", "feel only the height, at constant force"),
        ("nanotouch touch --scene mica_in_air --surface flat", "another sample; presets as in nanotouch plan"),
        ("nanotouch touch --force-range plan --control impedance", "all of the hand's range, no force sensor"),
    ),
    "live": (
        ("nanotouch live --list", "all presets, with what to try"),
        ("nanotouch live silicon_in_air --film touch.gif", "a film of a touch; needs no display"),
    ),
    "scan": (
        ("nanotouch scan --forecast", "forces, speed limit and margins of a scan, before it begins"),
        ("nanotouch scan dots --pixels 32 --out scanned", "quantum dots in tapping mode: scanned/scan.gwy"),
        ("nanotouch touch scanned/surface.gwy --out touched", "touch what was scanned"),
    ),
    "push": (
        ("nanotouch push --to 2um,1um --out pushed", "a particle of polystyrene on glass, under drift and noise"),
    ),
    "indent": (("nanotouch indent 100nN --out indented", "the dent of a diamond tip in gold, with force and heat"),),
    "margins": (("nanotouch margins scene.toml --no-map", "is the loop of this scene stable? numbers only"),),
    "info": (
        ("nanotouch info scan.gwy", "channels, size and units of an image"),
        ("nanotouch info result/recording.mcap --json", "what a touch left, as data"),
    ),
    "plan": (
        ("nanotouch plan silicon_on_gold", "the cheapest models that keep to 1 %"),
        ("nanotouch plan scene.toml --json", "your own scene, as data"),
    ),
    "curve": (("nanotouch curve --scene scene.toml", "force against gap, for four contact models"),),
    "image": (
        ("nanotouch image scan.gwy", "level it, and measure its roughness"),
        ("nanotouch image scan.gwy --scars --grains", "find particles: a table of them in grains.csv"),
        ("nanotouch image scan.gwy --spectrum", "also power spectral density and autocorrelation"),
    ),
    "fit": (("nanotouch fit curve.h5 --radius 20nm --model maugis", "modulus and adhesion from a force curve"),),
    "map": (("nanotouch map map.h5 --radius 20nm", "the same for every curve of a force volume"),),
    "review": (("nanotouch review curves --radius 20nm --sidecar kept.toml", "keep or reject curves one by one"),),
    "report": (("nanotouch report curves --radius 20nm --model maugis", "one page about a folder of force curves"),),
    "recalibrate": (
        (
            "nanotouch recalibrate curves --lever 1.9N/m --lever-known-to 4 --thermal-known-to 3 --out calibration.csv",
            "sensitivities by a lever of known stiffness",
        ),
    ),
    "export": (("nanotouch export result/recording.mcap --out touch.csv", "a recording as a table, with units"),),
    "recover": (("nanotouch recover cut.mcap --out whole.mcap", "what a killed touch has left"),),
    "workflow": (("nanotouch workflow --pixels 48", "the paper's work from scan to push, roughly, as a film"),),
    "reproduce": (("nanotouch reproduce --figure 5", "a figure of the paper, and which statements hold"),),
    "tradeoff": (("nanotouch tradeoff --quick", "speed against accuracy on this machine, roughly"),),
    "bench": (("nanotouch bench --quick", "what each law costs, roughly"),),
    "latency": (("nanotouch latency --seconds 1", "how late this machine wakes a loop of 1 kHz up"),),
    "rig": (
        ("nanotouch rig check rig.toml", "is a rig file whole? nothing is moved"),
        ("nanotouch rig allow --help", "let a rig file load the shared object that it names"),
    ),
    "doctor": (("nanotouch doctor", "what is installed, and what to install for the rest"),),
}
"""command: (line, what it does), in an order in which each line finds the files that it names"""

FIRST = (
    ("nanotouch live", "touch a surface with your own hand, in a window"),
    ("nanotouch touch", "the same without a hand: a touch is simulated, recorded and drawn"),
    ("nanotouch plan silicon_in_air", "which forces matter for a sample, and how well they are known"),
    ("nanotouch samples", "write an image, a force curve, a map and a scene to try the next two on"),
    ("nanotouch image scan.gwy", "level an AFM image and measure its roughness"),
    ("nanotouch fit curve.h5 --radius 20nm", "modulus and adhesion from a force curve"),
)
"""what to try first: the six commands that most people need, in an order in which they work"""
ALL = ("nanotouch --help", "all commands")


FIT = ("model", "radius", "spring_constant", "out")
USUAL = {
    "touch": ("surface", "mode", "scene", "duration", "out"),
    "live": ("list", "task", "record", "film", "browser"),
    "scan": ("mode", "scene", "pixels", "forecast", "out"),
    "plan": ("relative_accuracy",),
    "image": ("level", "grains", "scars", "out"),
    "export": ("out",),
    **dict.fromkeys(("fit", "map", "report", "review"), FIT),
}
"""options that ``--help`` shows first"""


def table(lines: tuple[tuple[str, str], ...]) -> str:
    """The lines in two columns."""
    width = max(len(line) for line, _ in lines)
    return "\n".join(f"  {line:{width}}   {what}" for line, what in lines)
