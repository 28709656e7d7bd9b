// SPDX-License-Identifier: BSD-3-Clause
// Leave a dent of a depth that is asked for, in a sample that yields; scratch a groove (nanotouch_app/training/dent.py).

import { Refused } from "./core.js";
import { touching } from "./trainer.js";
import { digits } from "./units.js";

export function dent(trainer, about, seed = Date.now()) {
  const { host, texts } = trainer, { SHARES, ALLOWED, GROOVE, LONG } = about;
  if (!host.keepsDents) throw new Refused(`task ${about.name}: this sample keeps no dents; lay ${about.preset}`);
  const random = (Math.imul(seed >>> 0, 1664525) + 1013904223) >>> 0;
  const share = SHARES[0] + ((SHARES[1] - SHARES[0]) * random) / 2 ** 32;
  const asked = host.core.c.page_dent_depth(share * trainer.load), long = GROOVE * trainer.width; // NaN for a dent
  let deepest = 0, largest = 0;
  const isGroove = ([x, y, endX, endY]) => x !== endX || y !== endY;
  const newest = () => {
    const row = host.dents.list.findLast((one) => isGroove(one) === Boolean(GROOVE));
    return row && { depth: row[5], length: Math.hypot(row[2] - row[0], row[3] - row[1]) };
  };
  const now = () => {
    const made = newest();
    return made ? trainer.say_("dent.now", { depth: digits(made.depth, "m") }) : texts["dent.none"];
  };
  return {
    words: () => trainer.say_(`${about.name}.words`, { depth: digits(asked, "m", 2), length: digits(long, "m", 2) }),
    now,
    choices: () => [texts["dent.choice"]],
    judge(at) {
      if (touching(at)) deepest = Math.max(deepest, -at.tip[2]);
      largest = Math.max(largest, at.largest);
    },
    choose() {
      const made = newest();
      if (trainer.touches) throw new Refused(`not yet: ${texts["dent.touches"]}`);
      if (!made) throw new Refused(`not yet: ${texts["dent.none"]}`);
      const error = Math.abs(made.depth - asked) / asked, off = GROOVE ? Math.abs(made.length - long) / long : 0;
      const said = trainer.say_("dent.said", { depth: digits(made.depth, "m"), asked: digits(asked, "m"), reached: digits(deepest, "m") });
      const groove = GROOVE ? trainer.say_("scratch.said", { length: digits(made.length, "m"), asked: digits(long, "m") }) : "";
      trainer.end(error <= ALLOWED && !(off > LONG), 100 * (1 - Math.max(error, off)), said + groove,
        { "residual depth": [made.depth, "m"], asked: [asked, "m"], error: [error, ""], "depth reached": [deepest, "m"],
          "largest force": [largest, "N"],
          ...(GROOVE ? { length: [made.length, "m"], "error of the length": [off, ""] } : {}) });
    },
  };
}
