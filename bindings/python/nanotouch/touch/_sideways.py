# SPDX-License-Identifier: BSD-3-Clause
"""Margins of a master of three axes, in x and y and of all axes together. Formulas: docs/margins.md."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from nanotouch.scene import Settings
from nanotouch.touch import margins
from nanotouch.touch.margins import Margins

if TYPE_CHECKING:
    from nanotouch.touch.session import Session

__all__ = ["Sideways", "margins_of", "sideways_of"]


class Sideways(NamedTuple):
    """What a lever that shows lateral forces lets a hand of three axes feel, and how far that is from its limit.

    Infinite margins where no motor pushes back sideways.
    """

    loop_stiffness: float
    """kappa_l = alpha_f alpha_p times what holds the tip sideways [N/m]"""
    loop_delay: float
    """D_l: of x or y, from the master's reading to its motor [s]"""
    margin: float
    """R1 sideways, b/(D_l kappa_l)"""
    exact_limit: float
    """kappa_l at which the sampled loop over a spring oscillates, hand included [N/m]"""
    exact_frequency: float
    """at which it does [Hz]; NaN where there is no limit"""
    coupling: float
    """of z into x and y and back, over the mean of both alone; 0: they do not know of each other"""
    coupled_margin: float
    """all axes together: R1, or the exact limit while it sticks and while it slips; never above those of each"""
    least: float
    """the smallest of the three; 1 is the limit"""
    rule: str
    """which one that is"""


def sideways_of(session: Session) -> Sideways:
    """Of a session, of a master of three axes over a lever that shows lateral forces."""
    found = dict(session.core.sideways)
    del found["projected"]
    return Sideways(**found)


def margins_of(session: Session) -> Margins:
    """Of a session in its mode: along z, with what a projection adds; the least counts x and y, too, and the tap."""
    settings = session.settings
    amounts: Settings | None = settings
    if session.control == "own":
        amounts = None if session.core.amounts is None else Settings.from_core(session.core.amounts)
    projected = session.core.sideways["projected"]
    if projected > 1.0 and amounts is not None:
        amounts = amounts.copy()
        amounts.gains.alpha_f *= projected
    along_z = margins.of_own_law(
        session.rig, settings, amounts, contact_stiffness=session.plan.maximum_stiffness, mode=session.mode
    )
    sideways = sideways_of(session)
    found = [(along_z.least, along_z.rule), (sideways.least, sideways.rule), session.core.tap]
    least, rule = min(found, key=lambda one: one[0])
    return along_z._replace(least=least, rule=rule) if least < along_z.least else along_z
