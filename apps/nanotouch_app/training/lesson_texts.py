# SPDX-License-Identifier: BSD-3-Clause
"""All that the lesson says, in one table: translate it by another table with the same keys and the same {figures}."""

TEXTS: dict[str, str] = {
    "predict": "First say what you expect. Then you may touch.",
    "touch": "Touch and let go.",
    "again": "Now it is changed. Touch and let go once more.",
    "right": "You were right.",
    "wrong": "You expected something else: {wanted}.",
    "measured": " You measured {first} before and {second} after the change.",
    "next": "next page",
    "jump.title": "1 Why does it jump?",
    "jump.question":
        "Attraction grows the nearer the tip comes. A spring holds the tip. The spring becomes four"
        " times as soft: where does the tip jump in now?",
    "jump.choices": "nearer to the surface|at the same height|further away",
    "jump.do": "Go down slowly by the wheel with shift. Watch the orange line meet the curve.",
    "jump.explain":
        "The tip jumps where attraction grows faster with nearness than the spring can pull back: "
        "where the line touches the curve. With {stiff} that is at {near}, with {soft} at {far}.",
    "stick.title": "2 Why does it stick?",
    "stick.question":
        "In humid air water condenses between tip and sample. The air is dried. What becomes of the"
        " force at which the tip tears off?",
    "stick.choices": "it becomes smaller|it stays|it becomes larger",
    "stick.do": "Press lightly, then pull up until it tears.",
    "stick.explain":
        "The neck of water pulls with 4 pi R gamma cos(theta), whatever its size. Without water "
        "only the solids hold each other. The law has {wet} in humid and {dry} in dry air. Both "
        "grow as the radius.",
    "deep.title": "3 How deep am I?",
    "deep.question":
        "A ball without adhesion is pressed into rubber. The load doubles. How much deeper is it?",
    "deep.choices": "1.41 times|1.59 times|2 times",
    "deep.do": "Press by the space bar and let go. There is no adhesion yet.",
    "deep.explain":
        "Hertz: the contact grows with the depth, so F ~ depth^1.5 and the depth grows as F^(2/3): "
        "{ratio} times. With the rubber's own adhesion the contact at zero load has a radius of "
        "{radius}; without it, none.",
    "sticky.title": "4 Soft or sticky?",
    "sticky.question":
        "Soft rubber is drawn up into a neck before it lets go: JKR. The rubber becomes 20 times as"
        " stiff. Where does it go on Maugis' map?",
    "sticky.choices": "towards DMT|nowhere|further into JKR",
    "sticky.do": "Press, then pull slowly. Look how far the way out lies behind the way in.",
    "sticky.explain":
        "Tabor's number compares how far adhesion draws up the surface with how far it reaches; "
        "lambda is 1.16 times it and falls as E^(-2/3): from {soft} to {stiff}. Below 0.1 it is "
        "DMT, above 5 JKR.",
    "felt.title": "5 What would a hand feel?",
    "felt.question":
        "A motor shows your hand the force on the tip, some million times larger. That scale is "
        "halved. What becomes of the margin to instability?",
    "felt.choices": "it halves|it stays|it doubles",
    "felt.do": "Touch, and watch the force at the hand.",
    "felt.explain":
        "The loop meets the contact's stiffness times the scale. With the paper's device the margin"
        " goes from {before} to {after}. Force gain and scale act as one product: so K_f cannot be "
        "any number.",
}  # fmt: skip
