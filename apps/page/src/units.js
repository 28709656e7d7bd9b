// SPDX-License-Identifier: BSD-3-Clause
// Units at the edge, as nanotouch/units.py: three digits under a prefix, quantities with their unit, keys of TOML.

const PREFIXES = { "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };

export function engineering(unit, values) {
  const largest = Math.max(0, ...values.filter(Number.isFinite).map(Math.abs));
  let power = largest > 0 ? 3 * Math.floor(Math.log10(largest) / 3 + 1e-12) : 0;
  power = Math.min(Math.max(power, -12), 9);
  return [PREFIXES[power] + unit, 10 ** -power];
}

// Three digits with the unit; "-" where it is not known.
export function digits(value, unit, count = 3) {
  if (!Number.isFinite(value)) return "-";
  const [prefixed, factor] = unit ? engineering(unit, [value]) : ["", 1];
  const scaled = value * factor;
  if (Math.abs(scaled) < 1e-3) return `0 ${unit}`.trim();
  const decimals = Math.max(0, count - 1 - Math.floor(Math.log10(Math.abs(scaled))));
  return `${scaled.toFixed(Math.min(decimals, count))} ${prefixed}`.trim();
}

export function stepUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value * (1 - 1e-9));
}

// "2.5um" with unit "m" to 2.5e-6; the unit must be written. units: the table of all spellings.
export function parseQuantity(text, unit, units) {
  const found = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$/.exec(text);
  const spellings = units[unit] ?? { "": 1 };
  const given = found?.[2].replace(/[µμ]/g, "u").replace("²", "2").replace("³", "3").replace("^", "");
  if (!found || !(given in spellings)) {
    const valid = Object.keys(spellings).filter(Boolean).join(", ");
    throw new Error(`${JSON.stringify(text)} is no such quantity${valid ? ` (units: ${valid})` : ""}`);
  }
  return Number(`${found[1]}`) * spellings[given];
}

// All TOML keys of a field with their factors: radius_m, radius_nm, ...
export function keySpellings(name, unit, units) {
  const keys = {};
  for (const [spelling, factor] of Object.entries(units[unit] ?? { "": 1 })) {
    const suffix = spelling === "%" ? "percent" : spelling.replace("/", "_per_").replace(/^_/, "");
    keys[suffix ? `${name}_${suffix}` : name] = factor;
  }
  return keys;
}
