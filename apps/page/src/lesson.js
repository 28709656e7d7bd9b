// SPDX-License-Identifier: BSD-3-Clause
// The five pages of the lesson: predict, touch, explain. The right answer is that of the C library, not of a table
// (training/lesson_pages.py).

import { Refused } from "./core.js";
import { filled, touching } from "./trainer.js";
import { digits } from "./units.js";

const SAME = 0.02; // a change of less than this is none
const way = (before, after) => (Math.abs(after - before) <= SAME * Math.abs(before) ? 1 : after > before ? 2 : 0);
const line = (from, to, count) => Float64Array.from({ length: count }, (_, i) => from + ((to - from) * i) / (count - 1));

// The plan of the host's scene with one field changed, and what `ask` finds in it; the scene is as before afterwards.
function withField(host, field, value, ask) {
  const [section, key] = field.split("."), { core } = host;
  core.set("scene", field, value);
  try {
    return ask(core.plan());
  } finally {
    core.set("scene", field, host.opened[section][key]);
    core.plan();
  }
}

// The largest gap at which attraction grows faster with nearness than a spring pulls back [m].
function jumpGap(core, spring) {
  const gaps = Float64Array.from({ length: 6000 }, (_, i) => 1e-11 * 1e4 ** (i / 5999));
  const { k } = core.law(gaps, false);
  return gaps.reduce((most, gap, i) => (-k[i] > spring ? Math.max(most, gap) : most), 0);
}

const depthAt = (gaps, F, load) => -gaps[F.findIndex((force) => force <= load)];

const RIGHT = {
  jump(host) {
    const stiff = host.hand.stiffness, soft = 0.25 * stiff;
    const near = jumpGap(host.core, stiff), far = jumpGap(host.core, soft);
    return [way(near, far), { stiff: digits(stiff, "N/m"), soft: digits(soft, "N/m"), near: digits(near, "m"),
      far: digits(far, "m") }];
  },
  stick(host) {
    const wet = host.facts.pull_off_force;
    const dry = withField(host, "medium.relative_humidity", 0, (facts) => facts.pull_off_force);
    return [way(wet, dry), { wet: digits(wet, "N"), dry: digits(dry, "N") }];
  },
  deep(host) {
    const load = 0.4 * host.opened.range.maximum_load, deepest = 1.5 * host.facts.largest_indentation;
    const gaps = line(-deepest, 0, 4001), { F } = host.core.law(gaps, true);
    const ratio = depthAt(gaps, F, 2 * load) / depthAt(gaps, F, load);
    const own = host.table.presets.find((one) => one.name === host.subject.name).scene.adhesion.work_of_adhesion;
    const radius = withField(host, "adhesion.work_of_adhesion", own, () => {
      const law = host.core.law(gaps, true), at = law.F.findIndex((force) => force <= 0);
      return law.a[at < 0 ? law.a.length - 1 : at];
    });
    const distance = [2 ** 0.5, 2 ** (2 / 3), 2].map((one) => Math.abs(Math.log(one / ratio)));
    return [distance.indexOf(Math.min(...distance)), { ratio: ratio.toFixed(2), radius: digits(radius, "m") }];
  },
  sticky(host) {
    const [, field, factor] = host.table.lesson.find((one) => one.key === "sticky").then;
    const soft = host.facts.lambda;
    const stiff = withField(host, field, factor * host.opened.sample.youngs_modulus, (facts) => facts.lambda);
    return [way(soft, stiff), { soft: digits(soft, ""), stiff: digits(stiff, "") }];
  },
  felt(host) { // with the paper's rig, whose master has a motor
    const { core, facts } = host, kept = { rig: core.get("rig"), settings: core.get("settings") };
    const scene = core.get("scene");
    core.c.page_defaults();
    const before = core.c.page_loop_margin(facts.maximum_stiffness);
    core.set("settings", "gains.alpha_f", 0.5 * core.get("settings").gains.alpha_f);
    const after = core.c.page_loop_margin(facts.maximum_stiffness);
    core.take("scene", scene);
    core.take("rig", kept.rig);
    core.take("settings", kept.settings);
    core.c.page_accuracy(host.accuracy);
    return [way(before, after), { before: digits(before, ""), after: digits(after, "") }];
  },
};

export function lessonPage(trainer, page) {
  const { host, texts } = trainer, text = (key) => texts[`${page.key}.${key}`];
  for (const [field, value] of page.changes) host.changeForTask("scene", field, value);
  const right = RIGHT[page.key](host); // before anything is changed
  const pulls = [];
  let predicted = null, lowest = 0;
  const explain = () => {
    const [answer, figures] = right, good = predicted === answer;
    let said = good ? texts.right : filled(texts.wrong, { wanted: text("choices").split("|")[answer] });
    said += ` ${filled(text("explain"), figures)}`;
    if (page.key === "stick")
      said += filled(texts.measured, { first: digits(pulls[0], "N"), second: digits(pulls[1], "N") });
    trainer.end(good, good ? 100 : 0, said, Object.fromEntries(pulls.map((pull, i) => [`pull-off ${i + 1}`, [pull, "N"]])));
  };
  const change = () => {
    const [what, field, factor] = page.then, [section, key] = field.split(".");
    if (what === "settings") host.changeForTask("scaled", field, factor);
    else host.changeForTask(what, field, factor * host.opened[section][key]);
  };
  return {
    get locked() { return predicted === null; },
    words: () => text(predicted === null ? "question" : "do"),
    now: () => texts[predicted === null ? "predict" : pulls.length ? "again" : "touch"],
    choices: () => (predicted === null ? text("choices").split("|") : []),
    choose(number) {
      if (predicted !== null) throw new Refused("not yet: touch and let go first");
      predicted = number;
    },
    judge(now) {
      if (predicted === null) return;
      const touches = touching(now);
      lowest = trainer.touches || touches ? Math.min(lowest, now.least) : 0;
      if (!trainer.touches || touches) return;
      pulls.push(-lowest);
      lowest = 0;
      if (pulls.length === 1 && page.then) change();
      if (pulls.length >= (page.then ? 2 : 1)) explain();
    },
  };
}
