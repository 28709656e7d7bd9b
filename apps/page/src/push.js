// SPDX-License-Identifier: BSD-3-Clause
// Push particles to where they shall lie: one, or five into a pattern (nanotouch_app/training/push.py).

import { Refused } from "./core.js";
import { digits } from "./units.js";

const EACH = 15; // so often they are told [ms]
const sum = (rows, of) => rows.reduce((total, row) => total + of(row), 0);

export function push(trainer, about) {
  const { host, width, texts } = trainer, { RADIUS, ALLOWED, WORST, LOSS } = about;
  const scaled = (places) => places.map((place) => place.map((part) => part * width));
  const lays = scaled(about.starts), targets = scaled(about.targets), count = lays.length;
  let places = lays.map(([x, y]) => [x, y, RADIUS]), force = 0, largest = 0, before = null, touched = 0, losses = 0, shown = "", told = -Infinity;
  const errors = () => targets.map(([x, y]) => Math.min(...places.map((place) => Math.hypot(place[0] - x, place[1] - y))));
  const off = () => digits(Math.max(...errors()), "m");

  function show() {
    const laid = host.balls.laid.slice(0, count), counts = [sum(laid, (one) => one.touches), sum(laid, (one) => one.losses)];
    places = laid.map(({ place }) => place);
    force = Math.hypot(...[0, 1, 2].map((axis) => sum(laid, (one) => one.force[axis])));
    largest = Math.max(largest, force);
    before ??= counts;
    const [touches, lost] = counts.map((now, i) => now - before[i]);
    const events = [...(touches > touched ? ["snap"] : []), ...(lost > losses ? ["tear"] : [])];
    [touched, losses] = [touches, lost];
    const now = JSON.stringify(places);
    if ((now === shown || performance.now() < told + EACH) && !events.length) return;
    [shown, told] = [now, performance.now()];
    host.tell({ tell: "particles", radius: RADIUS, places, targets, events });
  }

  return {
    lays,
    words: () => trainer.say_(`${about.name}.words`, { radius: digits(RADIUS, "m"), allowed: digits(ALLOWED, "m") }),
    now: () => trainer.say_("push.now", { off: off(), force: digits(force, "N", 2) }),
    choices: () => [texts["push.choice"]],
    show,
    judge() {},
    choose() {
      if (touched > losses) throw new Refused(`not yet: ${texts["push.touches"]}`);
      const far = errors(), extra = Math.max(losses - count, 0); // the last one of each is no loss
      const score = sum(far, (error) => 1 - Math.min(Math.max(error - ALLOWED, 0) / ((WORST - 1) * ALLOWED), 1)) / count;
      trainer.end(far.every((error) => error <= ALLOWED), 100 * score - LOSS * extra,
        trainer.say_("push.said", { off: off(), allowed: digits(ALLOWED, "m"), losses: extra }),
        { "largest error": [Math.max(...far), "m"], "mean error": [sum(far, Number) / count, "m"],
          "losses of contact": [extra, ""], "largest push": [largest, "N"] });
    },
  };
}
