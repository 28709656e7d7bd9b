# SPDX-License-Identifier: BSD-3-Clause
"""All that the tasks say, in one table, for the window and for the page: translate it by another table with the same
keys and the same {figures}."""

from __future__ import annotations

TEXTS: dict[str, str] = {
    "find.title": "Find the surface",
    "find.words":
        "Go down until the tip touches, and stay there for {held} s. Never press with more than {limit}.",
    "find.now": "largest force so far {largest}",
    "find.said": "found with {largest}; allowed were {limit}",
    "pull_off.title": "Measure a pull-off",
    "pull_off.words":
        "Touch and tear {needed} times. Read the largest pull on the tip from the bars or the chart. "
        "Then press N and type it with its unit, as 12nN.",
    "pull_off.left": "{left} to go",
    "pull_off.now": "press N and type the force",
    "pull_off.early": "{left} pull-offs are missing",
    "pull_off.said": "you say {answer}; it tore at {mean}; the law of a flat has {law}",
    "trace.title": "Trace a grating, lights off",
    "trace.words":
        "Touch, then draw the tip along x over half of the width ({width}) without letting go. Count its steps up. "
        "Then press N and type the period, as 2.5um.",
    "trace.left": "{share} % of the width touched",
    "trace.now": "press N and type the period",
    "trace.early": "only {share} % of the width are touched",
    "trace.said": "you say {answer}; it is {period}",
    "steady.title": "Keep a constant force",
    "steady.words":
        "Hold {target} within {band} % for {time} s, and carry the tip over {way} of the surface meanwhile.",
    "steady.left": "it begins at {target}",
    "steady.now": "within the band for {share} % of the time",
    "steady.still": ", but the tip hardly moved",
    "stiffer.title": "Tell the stiffer of two samples",
    "stiffer.words":
        "Press on A, lift, press on B. Which one is stiffer? Of 10 % of the modulus {felt} % are felt.",
    "stiffer.dull": " This sample is stiffer than the lever: all such samples feel like the lever.",
    "stiffer.now": "sample {felt} lies under the tip; pair {pair}",
    "stiffer.choices": "lay A|lay B|A is stiffer|B is stiffer",
    "stiffer.early": "lift the tip first",
    "stiffer.said":
        "told apart ({right} % right) at {modulus} % of the modulus, {stiffness} % of the felt stiffness; "
        "people have 9 to 15 % of stiffness",
    "dent.title": "Leave a dent of a depth",
    "dent.words":
        "Press, let go, and leave a dent that is {depth} deep when the tip is away. It is less deep than you press. "
        "You may press again in the same dent, or elsewhere; the newest one counts.",
    "dent.none": "nothing is left yet",
    "dent.now": "the newest one is {depth} deep",
    "dent.choice": "measure it",
    "dent.touches": "lift the tip first",
    "dent.said": "it is {depth} deep, asked were {asked}; the tip went down by {reached}",
    "push.title": "Push a particle",
    "push.words":
        "Push the ball (radius {radius}) into the ring, within {allowed}. Stay low, push against its middle, go around "
        "it for another direction. A push beside the middle turns it away.",
    "push.now": "{off} off; the ball pushes back with {force}",
    "push.choice": "it lies there",
    "push.touches": "take the tip away first",
    "push.said": "{off} off, allowed were {allowed}; contact lost {losses} times on the way",
    "pattern.title": "Push five into a pattern",
    "pattern.words":
        "Push each ball (radius {radius}) into a ring, within {allowed}. Any ball for any ring; they pass through each "
        "other, so keep them apart.",
    "wire.title": "Push a nanowire",
    "wire.words":
        "Push the wire (radius {radius}) until each end lies in a ring, within {allowed}. Stay low. On its middle it "
        "goes without turning; near an end it turns, and resists less.",
    "wire.now": "{off} off; the wire pushes back with {force}",
    "wire.choice": "it lies there",
    "scratch.title": "Scratch a groove",
    "scratch.words":
        "Press and draw the tip in a straight line of {length}, so that a groove of {depth} stays. "
        "The newest groove counts.",
    "scratch.said": "; {length} long, asked were {asked}",
}  # fmt: skip
