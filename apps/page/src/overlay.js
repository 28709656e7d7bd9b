// SPDX-License-Identifier: BSD-3-Clause
// Over the scene: the ring of the hand and the band to the tip, the scale bar, the bars of force.

import { digits, stepUp } from "./units.js";

const BAND = 0.15, RING = 13; // of the picture's height: the band under the largest planned force; [pixels]
const BAR = 80; // least length of the scale bar [pixels]
const BARS = 60; // that the bars of force take below the large number [pixels]
const NARROW = 480; // a phone's [pixels]
const squeezed = (share) => Math.sign(share) * Math.sqrt(Math.min(Math.abs(share), 1));

// From the lowest point; where a tip dents it, from the ground.
const heightsOf = ({ dent, ends: [low, high], low: ground, relief }) => (dent
  ? `${digits(low - ground, "m", 2)} to ${digits(high - ground, "m", 2)}` : `0 to ${digits(relief, "m")}`);

export class Overlay {
  constructor(painter, lens, constants) { Object.assign(this, { painter, lens, constants }); }

  // Whether it changes by itself, too: a lens that grows.
  draw(seen, stage, palette, { still, all }) {
    const { painter } = this;
    if (!painter.begin() || !seen.now || !seen.world || !stage.grid) return false;
    this.#proxy(seen, stage, palette);
    this.#scales(stage, palette);
    if (all) this.#bars(seen, palette);
    if (seen.hides.has("contact") || seen.hides.has("surface") || seen.blind) return false;
    return this.lens.draw(painter, seen, stage.pixel(stage.apex(seen.now)), palette, { still, below: all ? BARS : 0 });
  }

  #proxy(seen, stage, palette) {
    const [x, y] = stage.pixel(stage.apex(seen.now)), { painter } = this;
    const share = Math.min(Math.max(seen.force / Math.max(seen.load, 1e-15), -1.5), 1.5);
    const [across, along] = this.#sideways(seen, stage), ring = [x + across, y + along + BAND * painter.height * share];
    const colour = share >= 0 ? palette.repulsion : palette.attraction;
    if (Math.hypot(ring[0] - x, ring[1] - y) > 1) painter.line([[x, y], ring], colour, 3);
    painter.dot(...ring, RING, null, seen.stale ? palette.quiet : palette.ink);
  }

  // What holds the tip sideways stretches the band, as it is seen: the ring is ahead of it.
  #sideways(seen, stage) {
    const size = Math.hypot(...seen.sideways);
    if (!(size > 0)) return [0, 0];
    const at = stage.apex(seen.now), here = stage.pixel(at);
    const there = stage.pixel([at[0] - (1e-3 * seen.sideways[0]) / size, at[1] - (1e-3 * seen.sideways[1]) / size, at[2]]);
    const way = [there[0] - here[0], there[1] - here[1]];
    const length = (BAND * this.painter.height * Math.min(size / Math.max(seen.load, 1e-15), 1.5)) / Math.max(Math.hypot(...way), 1e-12);
    return way.map((part) => length * part);
  }

  #scales(stage, palette) {
    const { painter } = this, { perMetre } = stage, length = stepUp(BAR / perMetre);
    const pixels = length * perMetre, y = painter.height - 22;
    const told = this.#told(stage, painter.width < NARROW), has = Boolean(told);
    const wide = 36 + Math.max(pixels + 10 + painter.widthOf(digits(length, "m", 1)), has ? 130 + painter.widthOf(told) : 0);
    painter.box(8, y - (has ? 40 : 12), wide, has ? 52 : 24, palette.panel, 0.86);
    painter.line([[18, y], [18 + pixels, y]], palette.ink, 3);
    painter.text(28 + pixels, y, digits(length, "m", 1), palette.ink);
    if (!has) return;
    const { table } = stage;
    for (let part = 0; part < 24; ++part) {
      const place = (part / 24) * (table.length - 1), i = Math.floor(place), share = place - i;
      const colour = table[i].map((low, k) => Math.round((1 - share) * low + share * table[Math.min(i + 1, table.length - 1)][k]));
      painter.area([[18 + 5 * part, y - 31], [24 + 5 * part, y - 31], [24 + 5 * part, y - 21], [18 + 5 * part, y - 21]], colour);
    }
    painter.text(148, y - 26, told, palette.ink);
  }

  // What the colours mean; "" where there are none.
  #told({ grid, ends, shown }, narrow) {
    if (shown !== "height") {
      const [name, unit] = this.constants.PROPERTY_NAMES[shown];
      return `${name} ${ends.map((end) => digits(end, unit)).join(" to ")}`;
    }
    const drawn = grid.factor === 1 ? "" : narrow ? `, x ${grid.factor}` : `, drawn ${grid.factor} times as high`;
    return grid.relief > 0 ? `heights ${heightsOf(grid)}${drawn}` : "";
  }

  // Force at the tip and at the hand, signed, with ticks at what can just be told apart.
  #bars(seen, palette) {
    const { painter, constants } = this, { probe } = seen.world.rig, width = Math.min(220, 0.4 * painter.width);
    const noise = (probe.spring_constant * probe.sensitivity * probe.noise) / 6, scale = seen.world.settings.gains.alpha_f;
    const full = Math.max(seen.load, 1.2 * seen.pullOff), left = painter.width - width - 12;
    const narrow = painter.width < NARROW, low = narrow ? 12 : painter.height - 136; // above, where there is no room below
    painter.box(left, low, width, 124, palette.panel, 0.86);
    const told = seen.reading && !seen.stale ? seen.reading.force : 0;
    const rows = [[narrow ? "tip" : "at the tip", 1, constants.TIP_STEP * noise], [narrow ? "hand" : "at the hand", scale, constants.HAND_STEPS[1]]];
    rows.forEach(([name, factor, step], number) => {
      const y = low + 20 + 58 * number, a = left + 12, b = left + width - 12, middle = 0.5 * (a + b), half = 0.5 * (b - a);
      painter.text(a, y, name, palette.quiet);
      const shown = Math.abs(told * factor) > 0.01 * step ? digits(told * factor, "N") : "0 N";
      painter.text(b, y, shown, palette.ink, { align: "right", bold: true, size: 13 });
      const share = squeezed(seen.force / full), at = y + 20;
      painter.line([[a, at], [b, at]], palette.line, 10);
      painter.line([[middle, at], [middle + half * share, at]], share >= 0 ? palette.repulsion : palette.attraction, 10);
      painter.line([[middle, at - 8], [middle, at + 8]], palette.ink);
      for (const sign of [-1, 1]) {
        const tick = middle + sign * half * squeezed(Math.min(step / factor / full, 1));
        painter.line([[tick, at - 7], [tick, at + 7]], palette.quiet, 1);
      }
    });
  }
}
