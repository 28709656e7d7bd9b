# SPDX-License-Identifier: BSD-3-Clause
"""A plan in plain words with numbers."""

from __future__ import annotations

import math
from typing import Any

from nanotouch._plan_terms import Term, Warning

_NAMES = {
    "vdw": "van der Waals", "electrostatic": "electrostatic", "charge": "trapped charge",
    "double_layer": "double layer", "hydration": "hydration", "steric": "polymer brush",
}  # fmt: skip
_CONTACT = {
    "table": "Maugis-Dugdale table", "polished": "Maugis-Dugdale, polished table", "exact": "Maugis-Dugdale, exact",
    "local": "Maugis-Dugdale with the radius of each place", "jkr": "JKR",
    "local exact": "Maugis-Dugdale, exact, with the radius of each place",
}  # fmt: skip
_FORMS = {"derjaguin": "in Derjaguin's form", "sphere": "of the sphere", "tip": "of the whole tip", "on": "computed"}
_SOURCES = {"solid": "of the solids", "meniscus": "by a water meniscus"}
_QUANTITIES = ("force", "stiffness", "contact radius", "folds")


def text_of(facts: dict[str, Any]) -> str:
    """All of it."""
    contact, *others = (Term(*term) for term in facts["terms"])
    lines = [_contact(contact, facts)]
    lines += [_term(term, facts["pull_off_force"]) for term in others if term.force > 0.0]
    if facts["curvature_error"] > 0.0:
        lines.append(_surface(contact, facts))
    lines.append(_total(facts))
    lines.append(_numbers(facts))
    return "\n".join(lines + [f"warning: {Warning(*warning)}" for warning in facts["warnings"]])


def contact_law_of(term: Term, facts: dict[str, Any]) -> str:
    """The law of contact in words."""
    if not term.included:
        return "none"
    if facts["adhesion_source"] != "none":
        return _CONTACT[term.form]
    if term.form == "local":
        return "Hertz with the radius of each place"
    shape = facts["shape"]
    if term.form == "paraboloid":
        return f"Hertz in place of the {shape}"
    return "Hertz" if shape == "paraboloid" else f"law of the {shape}"


def _contact(term: Term, facts: dict[str, Any]) -> str:
    law = contact_law_of(term, facts)
    if not term.included:
        return "contact: none within the range of gaps"
    if facts["adhesion_source"] == "none":
        felt = " that could be felt" if math.isfinite(facts["lambda"]) else ""
        within = f", within {_percent(term.bound)}" if term.form == "paraboloid" else ""
        return f"contact: {law}{within}, no adhesion{felt}"
    text = f"contact: {law}"
    if math.isfinite(facts["lambda"]):
        text += f", lambda {facts['lambda']:.3g}"
    text += f"; adhesion {_SOURCES[facts['adhesion_source']]}, w = {facts['work_of_adhesion'] * 1e3:.4g} mJ/m2"
    rivals = {name.upper() if name != "hertz" else "Hertz": error for name, error in facts["rivals"].items()}
    if math.isfinite(facts["lambda"]):
        text += "; " + ", ".join(f"{name} would err by {_percent(error)}" for name, error in rivals.items())
    return text


def _term(term: Term, pull_off_force: float) -> str:
    share = f", {_percent(term.force / pull_off_force)} of the pull-off" if pull_off_force > 0.0 else ""
    size = f"at most {_nano(term.force)} nN{share}"
    if not term.included:
        return f"{_NAMES[term.name]}: left out, {size}"
    error = f"; this form errs by {_percent(term.bound)}" if term.bound > 0.0 else ""
    return f"{_NAMES[term.name]}: {_FORMS[term.form]}, {size}{error}"


def _surface(contact: Term, facts: dict[str, Any]) -> str:
    least, largest, own = (facts[name] * 1e9 for name in ("least_radius", "largest_radius", "radius"))
    radii, error = f"{least:.4g} to {largest:.4g} nm", _percent(facts["curvature_error"])
    if contact.form.startswith("local"):
        return f"surface: curved, effective radius {radii}; the tip's own {own:.4g} nm everywhere would err by {error}"
    return f"surface: curvature left out, the tip's own {own:.4g} nm in place of {radii}, which errs by {error}"


def _total(facts: dict[str, Any]) -> str:
    quantity = _QUANTITIES[("force", "stiffness", "radius", "folds").index(facts["quantity"])]
    text = f"{quantity} within {_percent(facts['bound'])}, folds within {facts['fold_shift'] * 1e9:.2g} nm"
    if not math.isnan(facts["model_error"]):
        text += f" (beside Lennard-Jones the model itself errs by {_percent(facts['model_error'])})"
    return f"{text}; cost {facts['cost']:.3g} Hertz evaluations, everything exact {facts['full_cost']:.3g}"


def _numbers(facts: dict[str, Any]) -> str:
    spring = facts["minimum_spring"]
    jump = "the force jumps in, whatever the spring" if math.isinf(spring) else f"no jump-in above {spring:.3g} N/m"
    return (
        f"pull-off {_nano(facts['pull_off_force'])} nN; {jump}; stiffest contact {facts['maximum_stiffness']:.3g} N/m"
    )


def _nano(force: float) -> str:
    return f"{force * 1e9:.4g}"


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %"
