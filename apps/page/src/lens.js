// SPDX-License-Identifier: BSD-3-Clause
// The lens: the contact, magnified, over the scene and beside the tip. It grows while something snaps or tears; then
// its rim lights up, and one large number says how hard (live/lens.py).

import { Contact, stateOf } from "./contact.js";
import { digits, stepUp } from "./units.js";

const SMALL = 0.17, LARGE = 0.27; // radius, of the view's shorter side; while something happens
const NARROW = 480, WIDER = 1.25; // a phone's [pixels]; there by so much
const SHOWN = 4, GROWS = 0.18, FLASH = 0.5; // an event; its lens; its light [s]
const AWAY = 2.1; // of its middle from the tip, in radii
const DARK = [10, 11, 13]; // words on the sample, in light and dark
const LOW = [0.45, 0.58]; // of its middle, from above; on a phone the number stands over it

export class Lens {
  constructor(draw) { Object.assign(this, { contact: new Contact(draw, 1.8), side: 1 }); }

  forget() { this.contact.forget(); }

  // 0 before and long after an event, 1 while it is shown; at once where nothing shall move.
  #grown(age, still) {
    if (!(age < SHOWN)) return 0;
    return still ? 1 : Math.min(age / GROWS, (SHOWN - age) / GROWS, 1);
  }

  draw(painter, seen, tip, palette, { still, below }) {
    const age = seen.event ? (performance.now() - seen.event.at) / 1000 : Infinity, grown = this.#grown(age, still);
    const { width, height } = painter, side = Math.min(width, height) * (width < NARROW ? WIDER : 1);
    const radius = this.radius = side * (SMALL + (LARGE - SMALL) * grown), [x, y] = this.#place(tip, radius, painter);
    const frame = { left: x - radius, top: y - radius, width: 2 * radius, height: 2 * radius };
    this.#leads(painter, tip, [x, y], radius, palette);
    painter.dot(x, y, radius, palette.panel);
    painter.within(x, y, radius, () => {
      const view = this.contact.draw(painter, frame, seen, palette, still);
      if (view) this.#words(painter, seen, palette, { ...view, radius });
    });
    if (grown > 0) this.#light(painter, tip, [x, y], radius, { age, still, colour: palette.accent });
    painter.dot(x, y, radius, null, grown > 0 ? palette.accent : palette.quiet, grown > 0 ? 5 : 2);
    if (grown > 0) this.#number(painter, seen.event, palette, below);
    return age < SHOWN; // it is drawn again
  }

  // Beside the tip, on the side where there is room; not back and forth.
  #place([x], radius, { width, height }) {
    if (x > 0.62 * width) this.side = -1;
    else if (x < 0.45 * width) this.side = 1;
    const edge = radius + 8;
    return [Math.min(Math.max(x + this.side * AWAY * radius, edge), width - edge), Math.max(LOW[Number(width < NARROW)] * height, edge)];
  }

  #leads(painter, [x, y], middle, radius, palette) {
    const way = [middle[0] - x, middle[1] - y], far = Math.hypot(...way);
    if (far <= radius) return;
    const turn = Math.acos(radius / far), back = Math.atan2(-way[1], -way[0]);
    for (const sign of [-1, 1])
      painter.line([[x, y], [0, 1].map((axis) => middle[axis] + radius * [Math.cos, Math.sin][axis](back + sign * turn))], palette.quiet, 1);
  }

  // Where nothing shall move the light stands still as long as the number.
  #light(painter, tip, middle, radius, { age, still, colour }) {
    const strength = still ? 0.5 : Math.max(1 - age / FLASH, 0);
    if (!(strength > 0)) return;
    painter.glow(...middle, 1.5 * radius, colour, strength, radius);
    painter.glow(...tip, 0.9 * radius, colour, strength, 0);
  }

  #words(painter, seen, palette, { scale, middle, bottom, radius }) {
    const { section, halfWidth } = this.contact, length = stepUp(0.3 * halfWidth), half = (length * scale) / 2;
    painter.text(middle, bottom - 0.5 * radius, section.a > 0 ? `${digits(2 * section.a, "m")} wide` : stateOf(section, seen.world),
      DARK, { align: "center", bold: true });
    painter.scale(middle - half, middle + half, bottom - 0.2 * radius, "", DARK);
    painter.text(middle, bottom - 0.32 * radius, digits(length, "m", 1), DARK, { align: "center" });
  }

  #number(painter, { text, kind }, palette, below) {
    const size = painter.width < NARROW ? 22 : 34, x = painter.width / 2, y = painter.width < NARROW ? 46 : painter.height - 116 - below;
    const room = painter.widthOf(text, { size, bold: true }) + 32;
    painter.box(x - room / 2, y - 1.35 * size, room, 2.15 * size, palette.panel, 0.94);
    painter.text(x, y - 0.85 * size, kind, palette.quiet, { align: "center", size: 14 });
    painter.text(x, y, text, palette.accent, { align: "center", bold: true, size });
  }
}
