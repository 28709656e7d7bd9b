// SPDX-License-Identifier: BSD-3-Clause
// What is drawn of a scene, from C: the law with its folds, the section. In a module of its own, so that the session's
// scene is not touched; the same for a session that runs elsewhere.

import { Dented } from "./dented.js";

const PLACE = { radius: "tip.radius", youngs_modulus: "sample.youngs_modulus", work_of_adhesion: "adhesion.work_of_adhesion" };

export class Drawn {
  constructor(core) { Object.assign(this, { core, dented: new Dented(core), keeps: false }); }

  // The plan of a scene at a place of its own (may be {}), its curve, and how far it is of interest.
  plan({ scene, rig, here = {}, accuracy }) {
    const { core } = this;
    core.c.page_defaults();
    core.take("scene", scene);
    if (rig) core.take("rig", rig);
    for (const [name, value] of Object.entries(here))
      if (PLACE[name] && (name !== "work_of_adhesion" || scene.adhesion.given === name)) core.set("scene", PLACE[name], value);
    if (accuracy) core.c.page_accuracy(accuracy);
    const facts = core.plan(), load = scene.range.maximum_load;
    const ends = [facts.release_gap, facts.capture_gap].filter(Number.isFinite);
    let reach = Math.max(3 * Math.max(...ends, 0), 0.4 * facts.largest_indentation, 3e-9);
    if (facts.pull_off_force < 1e-3 * load)
      reach = Math.max(reach, Math.min(core.c.page_cutoff_gap(0.01 * load), 5 * facts.largest_indentation));
    this.keeps = scene.sample.dents === "yes";
    if (this.keeps) return { facts, reach, ...this.dented.begin(facts, load, 11 * reach) };
    const [apart, attached, unstable] = core.curve(-1.5 * facts.largest_indentation, 11 * reach);
    return { facts, reach, curve: { apart, attached, unstable } };
  }

  section({ gap, force, r }) { return this.keeps ? this.dented.section(gap, r) : this.core.section(gap, force, r); }
}
