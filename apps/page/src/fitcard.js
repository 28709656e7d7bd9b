// SPDX-License-Identifier: BSD-3-Clause
// A force curve of text that was dropped: its columns, what C reads of it, and the scene that it becomes.

const LENGTHS = { m: 1, mm: 1e-3, um: 1e-6, "µm": 1e-6, nm: 1e-9, pm: 1e-12 };
const FORCES = { N: 1, mN: 1e-3, uN: 1e-6, "µN": 1e-6, nN: 1e-9, pN: 1e-12 };
const FEWEST = 32;
const ABOVE = 2; // times the pull-off is the least load that is planned for: a limit below it would stop each pull

// Two columns of numbers, height of the base and force, with their units from the header: "z (nm), force (nN)".
export function readText(text) {
  const rows = [], heads = [];
  for (const line of text.split(/\r?\n/)) {
    const parts = line.trim().split(/[\s,;]+/).filter(Boolean).map(Number);
    if (parts.length >= 2 && parts.every(Number.isFinite)) rows.push(parts);
    else if (line.trim() && rows.length === 0) heads.push(line);
  }
  if (rows.length < FEWEST) throw new Error(`a force curve needs ${FEWEST} rows of numbers: height and force`);
  const head = heads.join("\n"), named = heads.at(-1)?.replace(/^#/, "").split(/[,;\t]/) ?? [];
  const column = (pattern, otherwise) => {
    const found = named.findIndex((name) => pattern.test(name));
    return found >= 0 && found < rows[0].length ? found : otherwise;
  };
  const at = [column(/\bz\b|height|position|distance/i, 0), column(/force/i, 1)];
  const factor = at.map((place, i) => {
    const unit = /[([]\s*([a-zµ]+)\s*[)\]]/i.exec(named[place] ?? "")?.[1];
    return unit ? [LENGTHS, FORCES][i][unit] ?? NaN : 1;
  });
  if (!factor.every(Number.isFinite)) throw new Error(`units of the columns ${named.join(", ").slice(0, 80)}: valid are a length and a force`);
  const spring = /spring[\s_]*constant[^0-9+-]*([0-9.eE+-]+)/i.exec(head);
  return { z: rows.map((row) => row[at[0]] * factor[0]), force: rows.map((row) => row[at[1]] * factor[1]),
    springConstant: spring ? Number(spring[1]) : NaN };
}

// The card: what the curve shows, and a scene to touch. radius [m] of the tip that measured it.
export function fitCard(core, { text, radius, springConstant }) {
  const curve = readText(text), { z, force } = curve, spring = Number.isFinite(springConstant) ? springConstant : curve.springConstant;
  if (Number.isFinite(spring) && !(spring > 0)) throw new Error(`spring constant = ${spring} N/m: valid is above 0`);
  let turn = 0;
  z.forEach((height, i) => { if (height < z[turn]) turn = i; });
  const approach = turn >= 16 ? turn + 1 : 0, retract = z.length - approach >= 16 ? z.length - approach : 0;
  const { found, branches } = core.readCurve(z, force, approach, retract, spring);
  const value = (name) => found.find(([one]) => one === name)[1];
  const pull = value("pull-off force"), k = Number.isFinite(spring) ? spring : Infinity;
  const modulus = core.c.page_hertz(radius, k), largest = branches.reduce((most, { force: forces }) => forces.reduce((a, b) => Math.max(a, b), most), -Infinity);
  return { found, branches, radius, springConstant: spring, modulus, largest,
    scene: sceneOf(core, { radius, modulus, pull, largest }),
    rig: Number.isFinite(k) ? { probe: { spring_constant: k } } : {} };
}

function sceneOf(core, { radius, modulus, pull, largest }) {
  if (!(modulus > 0)) return null;
  core.c.page_defaults();
  const { tip, sample } = core.get("scene");
  const tipCompliance = (1 - tip.poisson_ratio ** 2) / tip.youngs_modulus, rest = 1 / modulus - tipCompliance;
  const youngs = rest > 0 ? (1 - sample.poisson_ratio ** 2) / rest : 1e12; // stiffer than the tip can tell
  const measured = pull > 0 ? { given: "pull_off_force", pull_off_force: pull } : { work_of_adhesion: 0 };
  const adhesion = { ...measured, hamaker_constant: 0 }; // what pulls is in the pull-off; its tail is not known
  return { tip: { radius }, sample: { youngs_modulus: youngs }, adhesion, range: { maximum_load: Math.max(largest, ABOVE * (pull || 0)) },
    medium: { relative_humidity: 0, film_thickness: 0 } };
}
