// SPDX-License-Identifier: BSD-3-Clause
// A scene as text: TOML whose keys carry their unit, over the C field tables, in a file or in the fragment of the URL.
// Nothing of it is trusted: every name, type and range is checked before the library sees it.

import { parse } from "smol-toml";
import { keySpellings } from "./units.js";

const LONGEST = 20000; // letters
const KNOWN = ["scene", "rig"];

// {scene: {section: {key: SI}}, rig: {...}} of a text; an error in words names what is wrong.
export function fromToml(text, fields, units) {
  if (text.length > LONGEST) throw new Error(`a scene of ${text.length} letters: valid are ${LONGEST}`);
  const tables = parsed(text), made = { scene: {}, rig: {} };
  for (const [section, values] of Object.entries(tables)) {
    const kind = KNOWN.find((one) => fields[one].some((row) => row.name.startsWith(`${section}.`)));
    if (!kind) throw new Error(`unknown section [${section}]`);
    if (typeof values !== "object" || values === null || Array.isArray(values)) throw new Error(`[${section}] is no table`);
    for (const [key, value] of Object.entries(values)) {
      const row = fields[kind].find((one) => one.name.startsWith(`${section}.`) && key in spellings(one, units));
      if (!row) throw new Error(`[${section}] has no key ${key}`);
      (made[kind][section] ??= {})[row.name.split(".")[1]] = valueOf(row, section, key, value, units);
    }
  }
  return made;
}

function parsed(text) {
  try {
    return parse(text);
  } catch (error) {
    const [why, at] = [error.message.split("\n")[0], error.line];
    throw new Error(at ? `${why} (line ${at})` : why);
  }
}

function spellings(row, units) {
  const name = row.name.split(".")[1];
  return row.choices ? Object.assign(Object.create(null), { [name]: 1 }) : Object.assign(Object.create(null), keySpellings(name, row.unit, units));
}

function valueOf(row, section, key, value, units) {
  if (row.choices) {
    const word = value === true ? "yes" : value === false ? "no" : value;
    if (row.choices.includes(word)) return word;
    throw new Error(`[${section}] ${key}: valid are ${row.choices.join(", ")}`);
  }
  const number = typeof value === "number" || typeof value === "bigint" ? Number(value) : NaN;
  const factor = spellings(row, units)[key];
  const si = factor === 1 ? number : Number((number * factor).toPrecision(15)); // 3 nm are 3e-9 m
  if (!(si >= row.minimum && si <= row.maximum))
    throw new Error(`[${section}] ${key} = ${String(value).slice(0, 40)} (${row.doc}): valid is ${row.minimum} .. ${row.maximum} ${row.unit}`);
  return si;
}

// What differs from other tables, as TOML in SI units.
export function toToml(world, usual, fields, units) {
  const lines = [];
  for (const kind of KNOWN)
    for (const [section, values] of Object.entries(world[kind])) {
      const changed = Object.entries(values).filter(([key, value]) => value !== usual[kind][section]?.[key]);
      if (!changed.length) continue;
      lines.push(`[${section}]`);
      for (const [key, value] of changed) {
        const row = fields[kind].find((one) => one.name === `${section}.${key}`);
        const spelling = row.choices ? key : Object.entries(keySpellings(key, row.unit, units)).find(([, factor]) => factor === 1)?.[0] ?? key;
        lines.push(`${spelling} = ${row.choices ? JSON.stringify(value) : value}`);
      }
    }
  return `${lines.join("\n")}\n`;
}

// The fragment: #preset=name&scene=TOML&task=name; a session elsewhere: #key=...
export function fromFragment(hash) {
  if (hash.length > 2 * LONGEST) throw new Error("the link is too long for a scene");
  return new URLSearchParams(hash.replace(/^#/, ""));
}

// Of one description into another, known sections and keys only.
export function laidOver(usual, over) {
  const made = structuredClone(usual);
  for (const [section, values] of Object.entries(over)) made[section] = { ...made[section], ...values };
  return made;
}
