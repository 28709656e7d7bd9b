# SPDX-License-Identifier: BSD-3-Clause
"""The host of a session stands twice, in Python and in JavaScript: both say the same of each sample, of a change, and
of one that is refused.

Usage: hosts.py FILE.wasm. Status 77, with a word, where node, zig's compiler or the package is not there."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

from reference import ROOT, node_that_runs, python_with_zig, skip

# heights of the page have 16 bits: 1e-5 of the relief, which is a part of the way that the scales are made for
ALLOWED = 1e-4
# the sharpest and the bluntest curvature of rounded heights are others (found: 1.3e-3 of the promised force on terraces
# of gold, below 2e-5 elsewhere); where a line begins is that of the dilated surface there, of the
# bare one here
SAME_DENT = 1e-9  # forces of two compilers differ in their last digits
LARGER = {"bound": 5e-3, "force": 5e-3, "zero": 1e-3}
NUMBERS = ("stiffness", "bound", "margin", "force", "clearance", "zero", "relative_accuracy", "undo", "redo")
CHANGES: list[dict[str, Any]] = [
    {"do": "change", "what": "scene", "field": "sample.youngs_modulus", "factor": 0.9},
    {"do": "change", "what": "settings", "field": "gains.alpha_f", "factor": 0.7},
    {"do": "change", "what": "rig", "field": "probe.spring_constant", "factor": 0.8},
]
REFUSED: dict[str, dict[str, Any]] = {
    "silicon_in_air": {"do": "change", "what": "settings", "field": "gains.alpha_f", "factor": 10.0},
    "silicon_on_gold": {"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.0},
    "mica_in_air": {"do": "change", "what": "scene", "field": "adhesion.work_of_adhesion", "value": 2e-3},
}


def of_python(asked: dict[str, list[dict[str, Any]]]) -> dict[str, list[dict[str, Any]]]:
    """What live/host.py tells."""
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    worlds: dict[str, list[dict[str, Any]]] = {}
    for preset, messages in asked.items():
        told: list[dict[str, Any]] = []
        host = Host(of_preset(preset), told.append, stepped=True)
        host.advance(0.001)
        worlds[preset] = [host.world()]
        for message in messages:
            section, key = message["field"].split(".")
            value = message.get("value")
            if value is None:
                value = message["factor"] * host.world()[message["what"]][section][key]
            host.answer({**message, "value": value})
            worlds[preset].append(told[-1])
        host.close()
    return worlds


def differences(ours: Any, theirs: Any, place: str, allowed: float = ALLOWED) -> list[str]:
    """In words, of all numbers and words of two descriptions."""
    if isinstance(ours, dict):
        return [
            line
            for key, value in ours.items()
            for line in differences(value, theirs.get(key), f"{place}.{key}", allowed)
        ]
    if isinstance(ours, list | tuple):
        return [line for n, value in enumerate(ours) for line in differences(value, theirs[n], f"{place}.{n}", allowed)]
    if isinstance(ours, float | int) and not isinstance(ours, bool):
        if theirs is None:
            return [] if not math.isfinite(ours) else [f"{place}: {ours} and none"]
        return [] if math.isclose(ours, theirs, rel_tol=allowed, abs_tol=1e-18) else [f"{place}: {ours} and {theirs}"]
    return [] if ours == theirs else [f"{place}: {ours} and {theirs}"]


def compare(ours: dict[str, Any], theirs: dict[str, Any], place: str) -> list[str]:
    """Of two messages."""
    if ours["tell"] == "refused":
        a, b = (message["why"].replace(" of virtual coupling", "") for message in (ours, theirs))
        return [] if a == b else [f"{place}: {a!r} and {b!r}"]
    parts = ("title", "felt", "hint", "scene", "rig", "settings", *NUMBERS)
    return [
        line
        for part in parts
        for line in differences(ours[part], theirs.get(part), f"{place}.{part}", LARGER.get(part, ALLOWED))
    ]


def touch_differs(theirs: list[dict[str, Any]]) -> list[str]:
    """A touch by the space bar in both: force, and where the work of the hand went.

    Where a touch begins and ends is told by blocks of frames there and by ticks here, and noise shakes the spring all
    the while: 0.08 of the work was found between the two.
    """
    import nanotouch as nt
    from nanotouch_app.live.energy import Balance
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    scene, gains = host.session.scene, host.session.settings.gains
    weighed = Balance(host.hand.stiffness, host.hand.zero, float(gains.alpha_p), float(scene.range.maximum_load))
    wrong = []
    with nt.frames.attach(host.name) as observer:
        for on, found in zip((True, False), theirs, strict=True):
            host.answer({"do": "press", "on": on})
            for _ in range(150):
                host.advance(0.01)
                weighed.add(observer.read())
            hand, stored, tip, heat = found["energies"]
            force = float(host.observer.newest()["tip_force"][2])
            largest = max(map(abs, weighed.energies))
            if not math.isclose(hand, stored + tip + heat, abs_tol=1e-9 * largest):
                wrong.append(f"the parts of the work are not the whole: {found['energies']}")
            if not math.isclose(force, found["force"], rel_tol=0.02, abs_tol=2e-10):  # noise of another seed
                wrong.append(f"force {force} and {found['force']}")
            if any(abs(a - b) > 0.15 * largest for a, b in zip(weighed.energies, found["energies"], strict=True)):
                wrong.append(f"energies {weighed.energies} and {found['energies']}")
    host.close()
    if not (theirs[0]["contact"] > 0.0 and theirs[1]["contact"] == 0.0 and theirs[1]["energies"][3] > 0.0):
        wrong.append(f"nothing was touched and let go: {theirs}")
    return wrong


def property_differs(theirs: dict[str, Any]) -> list[str]:
    """The middle lies between two moduli; an adhesion below 0 is refused by its name."""
    modulus, why = theirs["here"]["youngs_modulus"], theirs["refused"].get("why", "")
    ends = all(math.isclose(a, b, rel_tol=1e-6) for a, b in zip(theirs["ends"], (1e9, 1e11), strict=True))  # float32
    good = 1e9 <= modulus <= 1e11 and ends and "work_of_adhesion" in why
    return [] if good else [f"properties: {theirs}"]


def push_differs(theirs: list[dict[str, Any]], told: list[str]) -> list[str]:
    """A ball that is pushed, lost and laid back: places within what noise of the lever moves the tip, 1 nm."""
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    host = Host(of_preset("latex_on_glass"), lambda message: None, stepped=True)
    host.advance(0.001)
    host.answer({"do": "task", "name": "push", "seed": 1})
    wrong = []
    for (way, count), found in zip(((-20e-9, 65), (20e-9, 40), (0.0, 1)), theirs, strict=True):
        if way == 0.0:
            host.answer({"do": "undo"})
        for _ in range(count):
            host.answer({"do": "move", "way": (way, 0.0, 0.0)})
            host.advance(0.02)
        ours, theirs_now, frame = host.session.particles, found["laid"][0], host.observer.newest()
        near = all(abs(a - b) < 1e-9 for a, b in zip(ours.positions[0], theirs_now["place"], strict=True))
        near = near and math.isclose(float(frame["tip_force"][0]), found["side"], rel_tol=0.02, abs_tol=1e-12)
        counts = (ours.touches[0], ours.losses[0]) == (theirs_now["touches"], theirs_now["losses"])
        if not (near and counts and host.world()["undo"] == found["undo"]):
            wrong.append(f"a push: {ours}, force {frame['tip_force'][0]}, and {found}")
    host.close()
    start, pushed, back = (3.5e-6, *(found["laid"][0]["place"][0] for found in theirs[1:]))
    if not (pushed < start - 50e-9 and back == start and told == ["snap", "tear"]):
        wrong.append(f"nothing was pushed, lost and laid back: {theirs}, {told}")
    return wrong


def dents_differ(theirs: dict[str, Any]) -> list[str]:
    """Two presses, a groove, undo, with the same seed and ticks in both hosts: the same dents within 1e-9."""
    import nanotouch as nt
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    with mock.patch.object(nt, "Session", partial(nt.Session, seed=1)):
        host = Host(of_preset("soft_gold"), lambda message: None, stepped=True)
    host.session.core.advance(1)
    host.advance(0.01)
    found = []

    def go(count: int, message: dict[str, Any]) -> None:
        for _ in range(count):
            host.answer(message)
            host.advance(0.01)

    def note() -> None:
        rows = [[*dent.imprint, dent.load, -1 if dent.before is None else dent.before] for dent in host.left.dents]
        found.append((rows, host.world()["undo"]))

    for count in (60, 70):  # below where the hand stops
        go(count, {"do": "wheel", "steps": 1})
        go(count, {"do": "wheel", "steps": -1})
        note()
    go(70, {"do": "wheel", "steps": 1})
    go(60, {"do": "move", "way": (0.5e-9, 0.25e-9, 0.0)})
    host.answer({"do": "undo"})  # refused
    go(70, {"do": "wheel", "steps": -1})
    note()
    host.answer({"do": "undo"})
    note()
    host.close()
    wrong = []
    for (ours, undo), one in zip(found, theirs["found"], strict=True):
        alike = len(ours) == len(one["dents"]) and undo == one["undo"]
        near = alike and all(
            math.isclose(a, b, rel_tol=SAME_DENT, abs_tol=1e-18)
            for mine, other in zip(ours, one["dents"], strict=True) for a, b in zip(mine, other, strict=True)
        )  # fmt: skip
        if not near:
            wrong.append(f"dents: {ours}, {undo}, and {one}")
    counts = [len(ours) for ours, _ in found]
    grooves = sum(row[:2] != row[2:4] for row in found[2][0])
    if not (counts[0] >= 1 and counts[2] > counts[1] and counts[3] == counts[2] - 1 and grooves == 1):
        wrong.append(f"not a dent, a groove and one that is taken back: {found}")
    told = (theirs["refused"].get("why", ""), theirs["held"].get("why", ""))
    if "keeps no dents; lay soft_gold" not in told[0] or "lift it first" not in told[1]:
        wrong.append(f"refusals of dents: {told}")
    return wrong


def main(wasm: str) -> int:
    """Compare."""
    try:
        import nanotouch_app  # noqa: F401
    except ImportError:
        skip("the package is not installed: tools/setup.sh test")
    node = node_that_runs()
    subprocess.run([python_with_zig(), ROOT / "apps/page/build_wasm.py", wasm], check=True)
    with tempfile.TemporaryDirectory() as folder:
        table, questions = Path(folder) / "table.json", Path(folder) / "asked.json"
        subprocess.run([sys.executable, ROOT / "apps/page/export.py", table], check=True)
        at_home = [one["name"] for one in json.loads(table.read_text(encoding="utf-8"))["presets"]]
        asked = {name: [*CHANGES, *([REFUSED[name]] if name in REFUSED else [])] for name in at_home}
        questions.write_text(json.dumps(asked), encoding="utf-8")
        told = subprocess.run([node, Path(__file__).with_name("hosts.mjs"), wasm, table, questions],
                              capture_output=True, text=True, check=True)  # fmt: skip
    theirs, ours = json.loads(told.stdout), of_python(asked)
    wrong = touch_differs(theirs["touch"]) + property_differs(theirs["property"])
    wrong += push_differs(theirs["push"], theirs["told"]) + dents_differ(theirs["dents"])
    wrong += [line for name, messages in ours.items() for n, message in enumerate(messages)
             for line in compare(message, theirs[name][n], f"{name} {n}")]  # fmt: skip
    refused = sum(message["tell"] == "refused" for messages in ours.values() for message in messages)
    print(f"{len(ours)} samples, {sum(map(len, ours.values()))} messages, {refused} of them refusals", *wrong, sep="\n")
    return 0 if not wrong and refused == len(REFUSED) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
