# SPDX-License-Identifier: BSD-3-Clause
"""A plan in plain words with numbers."""

from __future__ import annotations

import math
from typing import Any

from nanotouch.scene._plan_terms import ROWS, Term, Warning
from nanotouch.units import in_words

_TAILS = {row.name for row in ROWS if row.tail}
_SOURCES = {"solid": "of the solids", "meniscus": "by a water meniscus"}
_QUANTITIES = {"force": "force", "stiffness": "stiffness", "radius": "contact radius", "folds": "folds"}
_UNITS = {"force": "N", "stiffness": "N/m", "radius": "m", "folds": "m"}
#: below this a shift of a fold is no more than rounding [m]
_IN_PLACE = 1e-15
#: a pull-off below this share of the largest load is none to speak of
_NO_PULL = 1e-5


def text_of(facts: dict[str, Any]) -> str:
    """All of it."""
    contact, *others = _terms(facts)
    lines = [_contact(contact, facts)]
    lines += [_term(term, facts) for term in others if term.force > 0.0]
    lines += _friction(Term(*facts["friction"]))
    lines += _deformation(facts)
    lines += _relaxation(facts)
    if facts["curvature_error"] > 0.0:
        lines.append(_surface(contact, facts))
    lines += _properties(facts)
    lines.append(_total(facts))
    lines.append(_numbers(contact, facts))
    if facts["probe_noise"] > 0.0:
        lines.append(f"the probe cannot tell forces below {in_words(facts['probe_noise'], 'N')}, its noise")
    return "\n".join(lines + [f"warning: {Warning(*warning)}" for warning in facts["warnings"]])


def contact_law_of(term: Term) -> str:
    """The law of contact in words."""
    return term.words if term.included else "none"


def _contact(term: Term, facts: dict[str, Any]) -> str:
    law = contact_law_of(term)
    if not term.included:
        return "contact: none within the range of gaps"
    if facts["adhesion_source"] == "none":
        felt = " that could be felt" if math.isfinite(facts["lambda"]) else ""
        apart = term.form not in ("shape", "local", "deformed") and facts["quantity"] != "folds"
        within = f", within {_percent(term.bound)}" if apart else ""
        return f"contact: {law}{within}, no adhesion{felt}"
    text = f"contact: {law}"
    if math.isfinite(facts["lambda"]):
        text += f", lambda {facts['lambda']:.3g}"
    text += f"; adhesion {_SOURCES[facts['adhesion_source']]}, w = {facts['work_of_adhesion'] * 1e3:.4g} mJ/m2"
    tails = [other.title for other in _terms(facts) if other.name in _TAILS and other.force > 0.0]
    text += f" beside {' and '.join(tails)}" if tails else ""
    rivals = {name.upper() if name != "hertz" else "Hertz": error for name, error in facts["rivals"].items()}
    if math.isfinite(facts["lambda"]):
        text += "; " if facts["quantity"] == "force" else "; in force "
        text += ", ".join(f"{name} would err by {_percent(error)}" for name, error in rivals.items())
    return text


def _friction(term: Term) -> list[str]:
    """Of the contact sideways; nothing where the scene has none."""
    if term.force == 0.0:
        return []
    largest = f"up to {in_words(term.force, 'N')} sideways"
    if not term.included:
        return [f"friction: left out, {largest}, {_percent(term.bound)} of the larger of the force and its scale"]
    bound = "bound not known" if math.isnan(term.bound) else f"within {_percent(term.bound)}"
    return [f"friction: {term.words}, {largest}, {bound}"]


def _relaxation(facts: dict[str, Any]) -> list[str]:
    """Whether time matters."""
    if facts["relaxation"] is None:
        return []
    springs, arms, modulus, slow, error = facts["relaxation"]
    if not springs:
        return [f"time: left out, {in_words(slow, 'Pa')} at any time, within {_percent(error)}"]
    return [
        f"time: {springs} springs of {arms} arms, within {_percent(error)}; {in_words(modulus, 'Pa')} over a period, "
        f"{in_words(slow, 'Pa')} in the end"
    ]


def _deformation(facts: dict[str, Any]) -> list[str]:
    """How far the sample gives to forces before contact, where that is felt."""
    size = f"elastic number {in_words(facts['elastic_number'], '', 2)}"
    rigid = max(facts["rigid_error"], facts["around_error"])
    error = "would jump" if math.isinf(rigid) else f"could err by {_percent(rigid)}"
    if facts["deforms"]:
        return [f"sample: deforms under all forces together, {size}; laws that add on the undeformed gap {error}"]
    if facts["rigid_error"] == 0.0 or facts["adhesion_source"] != "none":
        return []
    return [
        f"sample: does not deform before contact, {size}; forces add on the undeformed gap, which errs by "
        f"{_percent(facts['rigid_error'])}"
    ]


def _terms(facts: dict[str, Any]) -> list[Term]:
    return [Term(*term) for term in facts["terms"]]


def _term(term: Term, facts: dict[str, Any]) -> str:
    size = f"at most {in_words(term.force, 'N')}"
    if _holds(facts):
        size += f", {_share(term.force / facts['pull_off_force'])} the pull-off"
    if not term.included:
        unfelt = f"; no part of the {_QUANTITIES[facts['quantity']]}" if term.bound == 0.0 else ""
        return f"{term.title}: {term.words}, {size}{unfelt}"
    error = f"; this form errs by {_percent(term.bound)}" if term.bound > 0.0 else ""
    return f"{term.title}: {term.words}, {size}{error}"


def _surface(contact: Term, facts: dict[str, Any]) -> str:
    least, largest, own = (in_words(facts[name], "m") for name in ("least_radius", "largest_radius", "radius"))
    radii, error = f"{least} to {largest}", _percent(facts["curvature_error"])
    if contact.form.startswith("local") or facts["of_each_radius"]:
        return f"surface: curved, effective radius {radii}; the tip's own {own} everywhere would err by {error}"
    return f"surface: curvature left out, the tip's own {own} in place of {radii}, which errs by {error}"


def _properties(facts: dict[str, Any]) -> list[str]:
    """What the surface is made of."""
    words = {"youngs_modulus": ("Young's modulus", "Pa"), "work_of_adhesion": ("w", "J/m2")}
    ranges = [
        f"{words[name][0]} {in_words(least, words[name][1])} to {in_words(largest, words[name][1])}"
        for name, (least, largest) in facts["properties"].items()
    ]
    if not ranges:
        return []
    least = " and ".join(
        word for name, word in (("youngs_modulus", "softest"), ("work_of_adhesion", "least adhesive"))
        if name in facts["properties"]
    )  # fmt: skip
    pull = f", pull-off up to {in_words(facts['largest_pull_off_force'], 'N')}" if _holds(facts) else ""
    return [
        f"surface: made of something else at each place, {', '.join(ranges)}{pull}; numbers of the contact are those "
        f"of the {least} place"
    ]


def _total(facts: dict[str, Any]) -> str:
    """What the bound says and what it costs."""
    text = _folds(facts) if facts["quantity"] == "folds" else f"{_within(facts)}; {_folds(facts)}"
    if not math.isnan(facts["model_error"]):
        text += f" (beside Lennard-Jones the model itself errs by {_percent(facts['model_error'])})"
    cost, latency, full = (in_words(facts[name], "", 3) for name in ("cost", "latency", "full_cost"))
    return f"{text}; cost {cost} Hertz evaluations ({latency} where each waits for the last), everything exact {full}"


def _within(facts: dict[str, Any]) -> str:
    quantity = facts["quantity"]
    if math.isnan(facts["bound"]):
        return f"{_QUANTITIES[quantity]} without a bound"
    if math.isinf(facts["bound"]):
        return f"{_QUANTITIES[quantity]} with a bound that is not known"
    text = f"{_QUANTITIES[quantity]} within {_percent(facts['bound'])}"
    scale = in_words(facts["scale"], _UNITS[quantity])
    pulled = ", the pull-off" if quantity == "force" and facts["scale"] == facts["pull_off_force"] else ""
    return f"{text} of the larger of itself and {scale}{pulled}"


def _folds(facts: dict[str, Any]) -> str:
    shift = facts["fold_shift"]
    if facts["quantity"] == "folds":
        shift = max(shift, facts["bound"] * facts["scale"])
    without = facts["adhesion_source"] == "none" and facts["fold_shift"] == 0.0
    if without or not _terms(facts)[0].included:
        return "no folds"
    text = "folds in place" if shift < _IN_PLACE else f"folds within {in_words(shift, 'm', 2)}"
    if math.isinf(shift) or shift > max(abs(facts["release_gap"]), abs(facts["capture_gap"])) > 0.0:
        return "where the folds are is not known"
    if facts["quantity"] == "folds":
        return text
    return f"{text}, bound from {in_words(facts['fold_distance'], 'm', 2)} beside them on"


def _numbers(contact: Term, facts: dict[str, Any]) -> str:
    pull_off = f"pull-off {in_words(facts['pull_off_force'], 'N')}" if _holds(facts) else "no pull-off"
    if not contact.included:
        return f"{pull_off}, in contact, which is not visited"
    spring = facts["minimum_spring"]
    jump = f"no jump-in above {in_words(spring, 'N/m', 3)}" if spring > 0.0 else "no jump-in"
    if math.isinf(spring):
        jump = "the force jumps in, whatever the spring"
    return f"{pull_off}; {jump}; stiffest contact {in_words(facts['maximum_stiffness'], 'N/m', 3)}"


def _holds(facts: dict[str, Any]) -> bool:
    """Whether there is a pull-off to speak of."""
    return bool(facts["pull_off_force"] > _NO_PULL * _terms(facts)[0].force)


def _share(share: float) -> str:
    """``2.2 % of``, ``25 times``."""
    return f"{share:.2g} times" if share > 9.95 else f"{_percent(share)} of"


def _percent(share: float) -> str:
    """In per cent; as a bare number where that would be lost in zeros."""
    if 0.0 < share < 1e-5:
        return f"{share:.2g}"
    percent = 100.0 * share
    return f"{percent:.0f} %" if percent > 99.0 else f"{percent:.2g} %"
