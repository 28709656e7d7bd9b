# SPDX-License-Identifier: BSD-3-Clause
"""A haptic device as a program of its own: copy this file, and put your device into `Hand`.

Usage: device.py [NAME]    then, elsewhere: nanotouch.Session(master=nanotouch.hal.Mailbox(NAME), ...)
"""

import math
import sys
import time

import nanotouch as nt

PERIOD = 1e-3  # between two readings [s]
TRAVEL = 0.02  # z runs over half of it to either side [m]
STRONGEST = 3.0  # force of the motor [N]


class Hand:
    """Your device. This one follows a script, and has a motor that nobody feels."""

    def __init__(self) -> None:
        self.start = time.monotonic()

    def position(self) -> float:
        """z [m], + towards the sample; NaN while the device does not know."""
        return -8e-3 + 3.4e-3 * (1.0 - math.cos(2.0 * math.pi * (time.monotonic() - self.start) / 4.0))

    def push(self, force: float) -> None:
        """The force of the motor [N], + towards the sample."""


def serve(hand: Hand, name: str) -> None:
    """Serve until the process ends."""
    z = [nt.hal.Channel("position", "m", minimum=-TRAVEL / 2, maximum=TRAVEL / 2)]
    motor = nt.hal.Channel("motor force", "N", driven=True, minimum=-STRONGEST, maximum=STRONGEST, safe=0.0)
    device = nt.hal.Capabilities(axes=1, period=PERIOD, pushes=True, channels=[*z, motor])
    with nt.mailbox.Device(name, device) as mailbox:
        try:
            while True:
                hand.push(mailbox.ask().target[2])  # 0 N unless a session drives
                mailbox.publish(nt.hal.Reading(position=(math.nan, math.nan, hand.position())))
                time.sleep(PERIOD / 2)  # twice as often as it promises
        finally:
            hand.push(0.0)


if __name__ == "__main__":
    serve(Hand(), *(sys.argv[1:] or ["device"]))
