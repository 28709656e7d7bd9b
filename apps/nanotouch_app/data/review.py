# SPDX-License-Identifier: BSD-3-Clause
"""Look at force curves one by one: keep or reject each, and set contact point and baseline by hand. What is decided is
written at once to a sidecar, which fit and report take again (--sidecar). In a window with --show: drag the lines of
contact point and baseline; k keeps, x rejects, u forgets what was decided, left and right arrows turn over, q ends."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from nanotouch import fit as fitting
from nanotouch.batch import Decision, Place, Review
from nanotouch.errors import Error, InvalidValue
from nanotouch.fit import FitResult
from nanotouch.units import parse_quantity

from nanotouch_app.data import fit

HELP = (
    "k keep, x [REASON] reject, c LENGTH contact point, b LOW HIGH baseline, u forget, p picture, "
    "Enter or n next, - back, q end"
)
REASON = "rejected by hand"


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser("review", description=__doc__)
    parser.add_argument("curve", nargs="+", metavar="FILE", help="force curves, folders of them, or patterns")
    parser.add_argument("--sidecar", metavar="FILE", required=True, help="TOML file of what is decided; it may exist")
    parser.add_argument("--show", action="store_true", help="a window in place of the terminal; needs a display")
    fit.add_knowledge(parser, auto=True)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    review = Review(
        args.curve, args.sidecar, args.model, reading=fit.reading(args), branch=args.branch, **fit.knowledge(args)
    )
    for name, reason in review.unread.items():
        print(f"{name}: not read: {reason}", file=sys.stderr)
    if args.show:
        from nanotouch_app.data.review_window import show

        show(review)
    else:
        by_keys(review)
    excluded = sum(bool(review.decision(place).exclude) for place in review.places)
    args.answer = {"sidecar": args.sidecar, "curves": len(review.places), "excluded": excluded}
    print(f"{len(review.places)} curves, {excluded} excluded; now: --sidecar {args.sidecar}")
    return 0


def by_keys(review: Review) -> None:
    """A line of input for each decision, until the last curve or q."""
    print(HELP)
    number = 0
    while number < len(review.places):
        place = review.places[number]
        print(f"\n{number + 1}/{len(review.places)} {place.name}{_decided(review.decision(place))}")
        print(_shown(review.fitted(place)))
        print("> ", end="", flush=True)
        line = _read_line()
        word, _, rest = line.strip().partition(" ")
        if not line or word == "q":
            return
        try:
            number = max(0, number + _done(review, place, word or "n", rest.strip()))
        except Error as error:
            print(error)


def _read_line() -> str:
    """Empty at the end of the input, and where there is none."""
    try:
        return sys.stdin.readline()
    except (OSError, ValueError):
        return ""


def _done(review: Review, place: Place, word: str, rest: str) -> int:
    """Carry a word out; by how many curves it goes on."""
    if word in ("n", "-"):
        return 1 if word == "n" else -1
    if word == "k":
        review.decide(place, exclude="")
        return 1
    if word == "x":
        review.decide(place, exclude=rest or REASON)
        return 1
    if word == "c":
        review.decide(place, contact_point=parse_quantity(rest, "m"))
    elif word == "b" and len(rest.split()) == 2:
        low, high = (parse_quantity(end, "m") for end in rest.split())
        review.decide(place, baseline=(low, high))
    elif word == "u":
        review.decide(place, exclude="", contact_point=None, baseline=None)
    elif word == "p":
        result = review.fitted(place)
        if isinstance(result, FitResult):
            file = Path(f"{place.file.stem}-{place.index}.png")
            fitting.draw(place.curve, result, save=file)
            print(f"written: {file}")
    else:
        raise InvalidValue(f"{word!r}: {HELP}")
    return 0


def _decided(decision: Decision) -> str:
    told = []
    if decision.exclude:
        told.append(f"EXCLUDED: {decision.exclude}")
    if decision.contact_point is not None:
        told.append(f"contact point {decision.contact_point * 1e9:.6g} nm")
    if decision.baseline is not None:
        told.append(f"baseline {decision.baseline[0] * 1e9:.6g} .. {decision.baseline[1] * 1e9:.6g} nm")
    return f" [{'; '.join(told)}]" if told else ""


def _shown(result: FitResult | str) -> str:
    if isinstance(result, str):
        return f"  no fit: {result}"
    key = next(iter(result.values))
    place = result.values.get("contact_point", result.report.contact_point)
    return (
        f"  {result.status}, rating {result.rating:.1f}, {key} {result.show(key)}, contact point {place * 1e9:.5g} nm"
    )
