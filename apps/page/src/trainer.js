// SPDX-License-Identifier: BSD-3-Clause
// Tasks and the lesson beside the session of this page; words and numbers are those of nanotouch_app/training.

import { Refused } from "./core.js";
import { dent } from "./dent.js";
import { lessonPage } from "./lesson.js";
import { push } from "./push.js";
import { Staircase } from "./staircase.js";
import { digits, parseQuantity } from "./units.js";

const SLICE = 0.01; // of the trace [s]
const TRACE = ["time [s]", "x [m]", "y [m]", "gap [m]", "least force [N]", "largest force [N]", "contact"];
export const touching = (now) => now.contact > 0 || now.gap < 0;
export const filled = (text, figures) => text.replace(/\{(\w+)\}/g, (_, name) => figures[name]);

export class Trainer {
  static presetOf(table, name) {
    if (name === "lesson") name = "lesson-1";
    const found = [...table.tasks, ...table.lesson].find((one) => one.name === name);
    if (!found) throw new Refused(`task ${name.slice(0, 40)}: valid are ${table.tasks.map((one) => one.name).join(", ")}, lesson`);
    return found.preset;
  }

  static lays(table, name) { return table.tasks.some((one) => one.name === name && one.starts); }

  constructor(host, name, seed) {
    if (name === "lesson") name = "lesson-1";
    this.host = host;
    this.texts = host.table.texts;
    this.result = null;
    this.told = 0;
    this.touches = false;
    this.trace = []; // rows of TRACE
    this.csv = "";
    this.load = host.opened.range.maximum_load;
    this.width = host.size[0];
    const page = host.table.lesson.find((one) => one.name === name);
    this.about = page ?? host.table.tasks.find((one) => one.name === name);
    this.act = page ? lessonPage(this, page) : MADE[name](this, this.about, seed);
    this.report();
  }

  get locked() { return this.act.locked ?? false; }
  get follows() { return this.result ? this.about.follows : ""; }
  say_(key, figures = {}) { return filled(this.texts[key], figures); }

  see(now) {
    this.act.show?.();
    if (!this.result && Number.isFinite(now.force)) {
      this.#keep(now);
      this.act.judge(now);
      this.touches = touching(now);
    }
    if (performance.now() - this.told > 200) this.report();
  }

  choose(number) {
    if (this.result || !this.act.choose) throw new Refused("this task offers no choice");
    const offered = this.act.choices().length;
    if (offered && !(number >= 0 && number < offered)) throw new Refused(`choice ${number + 1}: valid is 1 .. ${offered}`);
    this.act.choose(number);
    this.report();
  }

  say(text) {
    if (!this.about.asked || this.result) throw new Refused("this task asks for no number");
    let value;
    try {
      value = parseQuantity(text, this.about.asked, this.host.table.units);
    } catch (error) {
      throw new Refused(error.message);
    }
    this.act.answer(value);
    this.report();
  }

  // figures: { name: [value, unit] }, what was measured; trials: of a task with many of them
  end(passed, score, said, figures = {}, trials = []) {
    const [first, last] = [this.trace[0], this.trace.at(-1)], duration = first ? last[0] - first[0] : 0;
    this.result = { passed, score: Math.min(Math.max(score, 0), 100), said };
    this.csv = this.#csv({ ...figures, duration: [duration, "s"] }, trials);
    this.report();
  }

  #keep({ time, tip, gap, least, largest, ...now }) {
    const slot = Math.floor(time / SLICE) * SLICE, last = this.trace.at(-1);
    if (!(least <= largest)) return;
    const row = [slot, tip[0], tip[1], gap, least, largest, Number(touching({ gap, ...now }))];
    if (last?.[0] !== slot) return this.trace.push(row);
    row[4] = Math.min(row[4], last[4]);
    row[5] = Math.max(row[5], last[5]);
    return this.trace.splice(-1, 1, row);
  }

  // The file that the window writes of a result (training/exercise.py).
  #csv(figures, trials) {
    const { passed, score, said } = this.result, cell = (value) => (typeof value === "number" ? `${Number(value.toPrecision(9))}` : `${value}`);
    const head = [`# task: ${this.about.name}`, `# passed: ${passed ? "True" : "False"}`, `# score: ${score.toFixed(1)}`, `# said: ${said}`,
      ...Object.entries(figures).map(([name, [value, unit]]) => `# ${name}${unit ? ` [${unit}]` : ""}: ${cell(value)}`)];
    const rows = trials.length ? [Object.keys(trials[0]), ...trials.map(Object.values)] : [TRACE, ...this.trace];
    return `${[...head, ...rows.map((row) => row.map(cell).join(","))].join("\n")}\n`;
  }

  report() {
    this.told = performance.now();
    const { act, about, result } = this;
    const told = { tell: "task", name: about.name, title: about.title ?? this.texts[`${about.key}.title`],
      words: act.words(), now: act.now(), choices: act.choices?.() ?? [], asked: about.asked ?? "",
      hides: about.hides ?? [] };
    if (result)
      Object.assign(told, { hides: [], choices: about.follows ? [this.texts.next] : [], asked: "", words: "",
        passed: result.passed, score: result.score, now: result.said, csv: this.csv });
    this.host.tell(told);
  }
}

const MADE = { find, pull_off: pullOff, trace, steady, stiffer, dent, scratch: dent, push, pattern: push };

function find(trainer, { SHARE, HELD }) {
  const limit = SHARE * trainer.load, told = { limit: digits(limit, "N"), held: HELD };
  let largest = 0, since = Infinity;
  return {
    words: () => trainer.say_("find.words", told),
    now: () => trainer.say_("find.now", { largest: digits(largest, "N") }),
    judge(now) {
      largest = Math.max(largest, now.largest);
      if (!touching(now)) since = Infinity;
      else if (since === Infinity) since = now.time;
      else if (now.time - since >= HELD)
        trainer.end(largest <= limit, (100 * limit) / Math.max(largest, 1e-15),
          trainer.say_("find.said", { largest: digits(largest, "N"), limit: told.limit }),
          { "largest force": [largest, "N"], limit: [limit, "N"] });
    },
  };
}

function pullOff(trainer, { NEEDED, ALLOWED }) {
  const measured = [];
  let lowest = 0;
  const left = () => NEEDED - measured.length;
  return {
    words: () => trainer.say_("pull_off.words", { needed: NEEDED }),
    now: () => trainer.say_(left() > 0 ? "pull_off.left" : "pull_off.now", { left: left() }),
    judge(now) {
      const touches = touching(now);
      if (touches) lowest = trainer.touches ? Math.min(lowest, now.least) : now.least;
      else if (trainer.touches) measured.push(-Math.min(lowest, now.least));
    },
    answer(value) {
      if (left() > 0) throw new Refused(`not yet: ${trainer.say_("pull_off.early", { left: left() })}`);
      const mean = measured.reduce((sum, one) => sum + one, 0) / measured.length;
      const error = mean > 0 ? Math.abs(Math.abs(value) - mean) / mean : Infinity;
      const told = { answer: Math.abs(value), mean, law: trainer.host.facts.pull_off_force };
      const figures = { answer: [told.answer, "N"], measured: [mean, "N"], law: [told.law, "N"], error: [error, ""] };
      for (const key of Object.keys(told)) told[key] = digits(told[key], "N");
      trainer.end(error <= ALLOWED, 100 * (1 - error), trainer.say_("pull_off.said", told), figures);
    },
  };
}

function trace(trainer, { PARTS, NEEDED, ALLOWED }) {
  const touched = new Uint8Array(PARTS), { period } = trainer.host.table;
  let largest = 0;
  const share = () => touched.reduce((sum, one) => sum + one, 0) / PARTS;
  const told = () => ({ share: (100 * share()).toFixed(0) });
  return {
    words: () => trainer.say_("trace.words", { width: digits(trainer.width, "m") }),
    now: () => trainer.say_(share() >= NEEDED ? "trace.now" : "trace.left", told()),
    judge(now) {
      largest = Math.max(largest, now.largest);
      if (touching(now))
        touched[Math.min(Math.max(Math.floor((now.tip[0] / trainer.width) * PARTS), 0), PARTS - 1)] = 1;
    },
    answer(value) {
      if (share() < NEEDED) throw new Refused(`not yet: ${trainer.say_("trace.early", told())}`);
      const error = Math.abs(value - period) / period;
      trainer.end(error <= ALLOWED, 100 * (1 - error),
        trainer.say_("trace.said", { answer: digits(value, "m"), period: digits(period, "m") }), { answer: [value, "m"],
          period: [period, "m"], error: [error, ""], "largest force": [largest, "N"], "width touched": [share(), ""] });
    },
  };
}

function steady(trainer, { TARGET, BAND, TIME, WAY, NEEDED }) {
  const target = TARGET * trainer.load;
  let since = Infinity, last = 0, good = 0, all = 0, squares = 0;
  const ends = [Infinity, -Infinity];
  const share = () => ({ share: ((100 * good) / all).toFixed(0) });
  return {
    words: () => trainer.say_("steady.words", { target: digits(target, "N"), band: (100 * BAND).toFixed(0), time: TIME,
      way: digits(WAY * trainer.width, "m") }),
    now: () => (all > 0 ? trainer.say_("steady.now", share()) : trainer.say_("steady.left", { target: digits(target, "N") })),
    judge(now) {
      const within = Math.abs(now.least - target) <= BAND * target && Math.abs(now.largest - target) <= BAND * target;
      if (since === Infinity) {
        if (within) since = last = now.time;
        return;
      }
      good += within ? now.time - last : 0;
      all += now.time - last;
      squares += (now.time - last) * (now.force - target) ** 2;
      last = now.time;
      ends[0] = Math.min(ends[0], now.tip[0]);
      ends[1] = Math.max(ends[1], now.tip[0]);
      if (now.time < since + TIME) return;
      const way = ends[1] - ends[0], needed = WAY * trainer.width, moved = way >= needed;
      trainer.end(good / all >= NEEDED && moved, ((100 * good) / all) * Math.min(1, way / needed),
        trainer.say_("steady.now", share()) + (moved ? "" : trainer.texts["steady.still"]), { "share within": [good / all, ""],
          "RMS error": [Math.sqrt(squares / all), "N"], target: [target, "N"], way: [way, "m"] });
    },
  };
}

function stiffer(trainer, { LOAD, DULL }, seed = Date.now()) {
  const stairs = new Staircase(), { host } = trainer, modulus = host.opened.sample.youngs_modulus;
  const trials = [];
  let stiff = "A", felt = "A", random = seed >>> 0 || 1;
  const draw = () => ((random = (Math.imul(random, 1664525) + 1013904223) >>> 0) >>> 31 ? "A" : "B");
  const show = (letter) => {
    felt = letter;
    const half = Math.sqrt(stairs.ratio);
    host.changeForTask("scene", "sample.youngs_modulus", modulus * (letter === stiff ? half : 1 / half));
  };
  const k = () => contactStiffness(host, LOAD * trainer.load), spring = host.hand.stiffness;
  const share = (2 / 3) * (spring / (spring + k()));
  const series = (factor) => {
    const one = k() * factor ** (2 / 3); // Hertz: k ~ E^(2/3) at a load
    return (one * spring) / (one + spring);
  };
  stiff = draw();
  show("A");
  return {
    words: () => trainer.say_("stiffer.words", { felt: (10 * share).toFixed(1) }) +
      (share < (DULL * 2) / 3 ? trainer.texts["stiffer.dull"] : ""),
    now: () => trainer.say_("stiffer.now", { felt, pair: stairs.trials + 1 }),
    choices: () => trainer.texts["stiffer.choices"].split("|"),
    judge() {},
    choose(number) {
      if (trainer.touches) throw new Refused(`not yet: ${trainer.texts["stiffer.early"]}`);
      if (number < 2) return show("AB"[number]);
      const answer = "AB"[number - 2], right = answer === stiff;
      trials.push({ pair: stairs.trials + 1, "ratio of moduli": Number(stairs.ratio.toFixed(6)), stiffer: stiff, answer, right: Number(right) });
      stairs.take(right);
      if (!stairs.done) {
        stiff = draw();
        return show("A");
      }
      const ratio = stairs.threshold, half = Math.sqrt(ratio), difference = series(half) / series(1 / half) - 1;
      host.changeForTask("scene", "sample.youngs_modulus", modulus);
      return trainer.end(difference <= 0.15, 100 * Math.min(1, 0.05 / Math.max(difference, 1e-9)),
        trainer.say_("stiffer.said", { right: (100 * host.table.right).toFixed(0),
          modulus: (100 * (ratio - 1)).toFixed(0), stiffness: (100 * difference).toFixed(1) }),
        { "Weber fraction of the modulus": [ratio - 1, ""], "Weber fraction of felt stiffness": [difference, ""],
          "d ln k/d ln E": [share, ""], "right answers": [trials.reduce((sum, one) => sum + one.right, 0) / trials.length, ""] }, trials);
    },
  };
}

// dF/d(indentation) under a load, by the law of the scene as it is [N/m].
export function contactStiffness(host, load) {
  const deepest = 1.5 * host.facts.largest_indentation;
  const gaps = Float64Array.from({ length: 2001 }, (_, i) => -deepest + (deepest * i) / 2000);
  const { F, k } = host.core.law(gaps, true);
  return k[F.findIndex((force) => force <= load)] ?? k[0];
}
