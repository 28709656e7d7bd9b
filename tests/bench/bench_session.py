# SPDX-License-Identifier: BSD-3-Clause
"""What one period costs in Python, for a loop of one's own: `session.step` shall stay below 5 us.

Run: python bench_session.py
"""

from __future__ import annotations

from collections.abc import Callable

import nanotouch as nt
from nanotouch.touch.operator import Hold, Input
from timing import least

STEPS = 10_000


def main() -> None:
    """Print one line per way to run; processor time, the least of several runs."""
    x, y = 0.0, 0.0
    push, hold = Input(0.5, x, y, 0.0), Hold(0.0, x, y, 0.0)
    quiet, recorded = nt.Session(recorded=False), nt.Session()

    def repeated(call: Callable[[], object]) -> Callable[[], None]:
        def work() -> None:
            for _ in range(STEPS):
                call()

        return work

    rows: dict[str, Callable[[], object]] = {
        "session.step(Input)": repeated(lambda: quiet.step(push)),
        "session.step(Hold)": repeated(lambda: quiet.step(hold)),
        "session.step()": repeated(quiet.step),
        "session.advance, for each row that it returns": lambda: recorded.advance(STEPS / recorded.rate),
    }
    for name, work in rows.items():
        print(f"{name:<48}{least(work) / STEPS * 1e6:8.2f} us")


if __name__ == "__main__":
    main()
