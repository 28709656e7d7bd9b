// SPDX-License-Identifier: BSD-3-Clause
// Opens a page by its file, as a person would who has nothing else, until it has touched, and says how long that took.
// Usage: node tests/page/opened.mjs FILE
import path from "node:path";
import { open, touched, value, visit } from "./browser.mjs";

const began = performance.now();
const { context, close } = await open({ offline: true });
try {
  const { page, said, requests } = await visit(context, `file://${path.resolve(process.argv[2])}`);
  await touched(page);
  const law = await value(page, () => Object.keys(window.nanotouch.seen.law).length);
  const foreign = requests.filter((one) => !/^(file|blob|data):/.test(one));
  const wrong = [...said.filter((line) => !/GL Driver|WebGL/.test(line)), ...foreign];
  if (wrong.length || !law) throw new Error(wrong.join("\n") || "no force law is shown");
  console.log(`touched after ${((performance.now() - began) / 1000).toFixed(1)} s, without a request to the net`);
} finally {
  await close();
}
