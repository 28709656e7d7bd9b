// SPDX-License-Identifier: BSD-3-Clause
// Why a slider has sprung back, in words, and how far it may go: the same as nanotouch_app/live/refusals.py.

import { digits, quantity } from "./units.js";

const NUMBER = "([-+.\\deEinfa]+)";
const INACCURATE = new RegExp(`demand\\.relative_accuracy = ${NUMBER}\\s*: valid is ${NUMBER} \\.\\. `);
const UNSTABLE = new RegExp(`margin.*= ${NUMBER}: valid is ${NUMBER} \\.\\. `);
const NO_LAW = /the sample deforms under (.*) before contact\)/;
const OTHER = /([a-z]+\.[a-z_]+)(?: \(([^)]*)\))? = (\S+(?: \S+)?): valid is ([^;]*)/;
const HALVINGS = 20, SURE = 0.999; // of the way to what was asked; of what was found is told, so that asking for it works
const percent = (share) => Number((100 * Number(share)).toPrecision(2));

// host: of the session as it is; what was asked of which field, and what the library has said to it.
export function inWords(host, { field, old, value }, said) {
  const row = host.core.field(fieldKind(host, field), field), name = nameOf(host, field);
  const told = (number) => quantity(field, row.unit, number), asked = `${name} ${told(value)}`, stays = `It stays at ${told(old)}.`;
  let found = INACCURATE.exec(said);
  if (found) return `${asked}: known only within ${percent(found[2])} % there, and this session keeps ${percent(found[1])} %. ${stays}`;
  found = NO_LAW.exec(said);
  if (found) return `${asked}: so soft that ${found[1]} moves it before contact; no law within the demand. ${stays}`;
  found = UNSTABLE.exec(said);
  if (found) {
    const limit = furthest(old, value, (at) => host.marginWith(field, at) >= host.leastMargin);
    const possible = limit === null ? "" : ` Possible is up to ${told(limit)}.`;
    return `${asked}: the loop would not be stable enough (margin ${digits(Number(found[1]), "")}; at least ${found[2]} is kept).` +
      `${possible} ${stays}`;
  }
  found = OTHER.exec(said);
  if (found && found[1] !== field)
    return `${asked}: that does not go with ${found[1]} = ${found[3]}, which would have to be within ${found[4]}` +
      `${found[2] ? ` (${found[2]})` : ""}. ${stays}`;
  return `${asked}: ${said.replace(`${field}: `, "")}. ${stays}`;
}

const fieldKind = ({ core }, field) => Object.keys(core.fields).find((kind) => core.fields[kind].some(({ name }) => name === field));
const nameOf = ({ table }, field) => table.offered.find(([, name]) => name === field)?.[2] ?? field.split(".")[1].replaceAll("_", " ");

// Nearest to a bad value from a good one, by halves of the way; null where not even the good one holds.
function furthest(good, bad, holds) {
  if (!(good > 0 && bad > 0 && holds(good))) return null;
  const up = bad > good;
  for (let i = 0; i < HALVINGS; ++i) {
    const middle = Math.sqrt(good * bad);
    if (holds(middle)) good = middle;
    else bad = middle;
  }
  return good * (up ? SURE : 2 - SURE);
}
