# SPDX-License-Identifier: BSD-3-Clause
"""The host of a session stands once, in C, natively and as WebAssembly: both say the same of each sample, of a change,
of one that is refused, and of each task that its ideal operator solves.

Usage: hosts.py FILE.wasm. Status 77, with a word, where node, zig's compiler or the package is not there."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from reference import ROOT, node_that_runs, python_with_zig, skip

# heights of the page have 16 bits: 1e-5 of the relief, which is a part of the way that the scales are made for
ALLOWED = 1e-4
# the sharpest and the bluntest curvature of rounded heights are others (found: 1.3e-3 of the promised force on terraces
# of gold, below 2e-5 elsewhere); where a line begins is that of the dilated surface there, of the bare one here
LARGER = {"bound": 5e-3, "force": 5e-3, "zero": 1e-3, "error": 5e-3}
OWN = {"name", "source", "changes"}  # of a view
FLAT = ("dent", "push", "wire")  # tasks without a relief: the same ticks, the same words
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
        host.report()
        worlds[preset] = [host.about, next(message for message in told if message["tell"] == "sliders")]
        for message in messages:
            section, key = message["field"].split(".")
            value = message.get("value", message.get("factor", 0.0) * host.about[message["what"]][section][key])
            told.clear()
            host.answer({**message, "value": value})
            worlds[preset].append(next(one for one in reversed(told) if one["tell"] in ("world", "refused")))
        host.close()
    return worlds


def solved_by_python(names: list[str]) -> dict[str, dict[str, Any]]:
    """Each task on its sample, by the same operators."""
    from nanotouch_app.live.board import TASKS
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    found = {}
    for name in names:
        told: list[dict[str, Any]] = []
        host = Host(of_preset(TASKS[name]["preset"]), told.append, stepped=True)
        host.session.core.advance(1)
        host.answer({"do": "task", "name": name, "seed": 1})
        host.core.solve()
        host.report()
        found[name] = next(one for one in reversed(told) if one["tell"] == "task")
        host.close()
    return found


def differences(ours: Any, theirs: Any, place: str, allowed: float = ALLOWED) -> list[str]:
    """In words, of all numbers and words of two descriptions."""
    if isinstance(ours, dict):
        return [
            line
            for key, value in ours.items() if key not in OWN
            for line in differences(value, theirs.get(key), f"{place}.{key}", LARGER.get(key, allowed))
        ]  # fmt: skip
    if isinstance(ours, list | tuple):
        return [line for n, value in enumerate(ours) for line in differences(value, theirs[n], f"{place}.{n}", allowed)]
    if isinstance(ours, float | int) and not isinstance(ours, bool) and isinstance(theirs, float | int):
        return [] if math.isclose(ours, theirs, rel_tol=allowed, abs_tol=1e-18) else [f"{place}: {ours} and {theirs}"]
    if isinstance(ours, float) and not math.isfinite(ours) and theirs is None:
        return []
    return [] if ours == theirs else [f"{place}: {ours} and {theirs}"]


def touch_differs(theirs: list[dict[str, Any]]) -> list[str]:
    """A touch by the space bar in both: force, and where the work of the hand went. Noise of the lever shakes the
    spring all the while."""
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    wrong = []
    for on, found in zip((True, False), theirs, strict=True):
        host.answer({"do": "press", "on": on})
        host.advance(1.5)
        ours, force = host.clock()["energies"], float(host.observer.newest()["tip_force"][2])
        hand, stored, tip, heat = found["energies"]
        largest = max(map(abs, ours))
        if not math.isclose(hand, stored + tip + heat, abs_tol=1e-9 * largest):
            wrong.append(f"the parts of the work are not the whole: {found['energies']}")
        if not math.isclose(force, found["force"], rel_tol=0.02, abs_tol=2e-10):
            wrong.append(f"force {force} and {found['force']}")
        if any(abs(a - b) > 0.15 * largest for a, b in zip(ours, found["energies"], strict=True)):
            wrong.append(f"energies {ours} and {found['energies']}")
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


def tasks_differ(theirs: dict[str, dict[str, Any]]) -> list[str]:
    """Each row of the table is there, runs and scores in both."""
    wrong = []
    for name, ours in solved_by_python(list(theirs)).items():
        one = theirs[name]
        keys = ("name", "title", "passed", "scored", *(("now", "score") if name in FLAT else ()))
        good = one["status"] == 0 and one["passed"] and one["score"] > 80.0 and one["lines"] > 10
        if not good or any(differences(ours.get(key), one.get(key), key, 1e-6) for key in keys):
            wrong.append(f"task {name}: {ours} and {one}")
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
                              stdout=subprocess.PIPE, text=True, check=True)  # fmt: skip
    theirs, ours = json.loads(told.stdout), of_python(asked)
    wrong = touch_differs(theirs["touch"]) + property_differs(theirs["property"]) + tasks_differ(theirs["solved"])
    wrong += [line for name, messages in ours.items() for n, message in enumerate(messages)
             for line in differences(message, theirs["worlds"][name][n], f"{name} {n}")]  # fmt: skip
    refused = sum(message["tell"] == "refused" for messages in ours.values() for message in messages)
    counts = f"{len(ours)} samples, {sum(map(len, ours.values()))} messages, {refused} of them refusals"
    print(f"{counts}, {len(theirs['solved'])} tasks", *wrong, sep="\n")
    return 0 if not wrong and refused == len(REFUSED) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
