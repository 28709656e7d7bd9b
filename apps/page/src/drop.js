// SPDX-License-Identifier: BSD-3-Clause
// Files that are dropped or opened: an image becomes the surface, a curve its card and its touch, a TOML file the scene.
// They are read here; nothing is uploaded.

import { readImage, scaled } from "./images.js";
import { fromToml, laidOver } from "./scenefile.js";
import { relief } from "./subject.js";
import { byId, element } from "./words.js";
import { digits, parseQuantity } from "./units.js";

const LARGEST = 64e6; // [byte]
const MORE = "This page fits Hertz alone. nanotouch live FILE --browser fits all laws, those of samples that relax, too, and draws what was measured.";
const USUAL_RADIUS = "20 nm";

export class Drop {
  constructor(table, words, link, state) {
    Object.assign(this, { table, words, link, state });
    const file = byId("file");
    file.addEventListener("change", () => { if (file.files[0]) this.open(file.files[0]); file.value = ""; });
    document.addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      if (event.dataTransfer.files[0]) this.open(event.dataTransfer.files[0]);
    });
  }

  async open(file) {
    try {
      if (!this.state.own && !this.link.open) throw new Error("files are opened where the session runs: name them there");
      if (file.size > LARGEST) throw new Error(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB; valid are ${LARGEST / 1e6} MB`);
      if (!this.state.own) {
        this.words.close();
        return await this.link.open(file);
      }
      if (/\.mcap$/i.test(file.name)) throw new Error(`a recording is played in a window: nanotouch live ${file.name}`);
      if (/\.toml$/i.test(file.name)) this.scene(await file.text(), file.name);
      else if (/\.(png|jpe?g|gsf)$/i.test(file.name)) await this.#image(file);
      else await this.#curve(file);
    } catch (error) {
      this.state.note(`${file.name}: ${error.message}`);
    }
    return undefined;
  }

  #lay(title, { scene, rig, map, hint }) {
    this.words.close();
    this.link.ask({ do: "lay", subject: { name: "", title, hint: hint ?? "", scene, rig, map } });
  }

  #usual(name = this.table.presets[0].name) { return this.table.presets.find((preset) => preset.name === name); }

  // TOML over a preset's scene; its own surface is a gentle relief.
  scene(text, title, preset) {
    const usual = this.#usual(preset) ?? this.#usual(), read = fromToml(text, this.state.fields, this.table.units);
    const scene = laidOver(usual.scene, read.scene), { radius } = scene.tip, size = Math.max(500e-9, 15 * radius);
    this.#lay(title, { scene, rig: laidOver(usual.rig, read.rig), map: relief(size, 0.012 * size) });
  }

  async #image(file) {
    const map = await readImage(file), { scene, rig } = this.#usual();
    const lay = (made) => this.#lay(file.name, { scene, rig, map: made, hint: `Your own surface, as ${this.#usual().title}.` });
    if (map.of && map.of !== "heights") return this.#property(file.name, map);
    if (!map.asks) return lay(map);
    const length = (text) => parseQuantity(text, "m", this.table.units);
    return this.words.form(file.name, [element("p", { textContent: "A picture knows no lengths. How wide is it, and how high is white?" })],
      [["width", "width", "1 um"], ["height", "height of white", "20 nm"]], ({ width, height }) => this.#tried(() =>
        lay(scaled(map, length(width), length(height)))));
  }

  #property(title, map) {
    this.words.close();
    this.link.ask({ do: "property", name: map.of, map, title });
  }

  async #curve(file) {
    const text = await file.text();
    const card = async (radius, springConstant) => {
      const { card: made, error } = await this.link.draw({ draw: "curve", text, radius, springConstant });
      if (error) throw new Error(error);
      return made;
    };
    const again = (given) => this.#tried(async () => {
      const radius = parseQuantity(given.radius, "m", this.table.units);
      const spring = given.spring.trim() ? parseQuantity(given.spring, "N/m", this.table.units) : NaN;
      const made = await card(radius, spring);
      if (!made.scene) throw new Error("nothing of this curve presses: there is no modulus to touch");
      const usual = this.#usual(), size = Math.max(500e-9, 15 * radius);
      this.#lay(file.name, { scene: laidOver(usual.scene, made.scene), rig: laidOver(usual.rig, made.rig), map: relief(size, 0.005 * size),
        hint: "What you have measured, to be touched." });
    });
    const made = await card(parseQuantity(USUAL_RADIUS, "m", this.table.units), NaN);
    const unit = { "contact point": "m", "pull-off force": "N", "work of adhesion area": "J", noise: "N", "contact slope": "N/m",
      "baseline slope": "N/m", "visible from": "N", ruptures: "" };
    const rows = made.found.filter(([name]) => name in unit).map(([name, value]) => [name, name === "ruptures" ? `${value}` : digits(value, unit[name])]);
    rows.push([`effective modulus (Hertz, R = ${USUAL_RADIUS})`, digits(made.modulus, "Pa")]);
    this.words.form(`${file.name}: what the curve shows`, [this.words.facts(rows), element("p", { className: "quiet", textContent: MORE })], [["radius", "radius of the tip", USUAL_RADIUS],
      ["spring", "stiffness of the lever", Number.isFinite(made.springConstant) ? `${made.springConstant} N/m` : ""]], again);
  }

  async #tried(act) {
    try {
      await act();
    } catch (error) {
      this.state.note(error.message);
    }
  }
}
