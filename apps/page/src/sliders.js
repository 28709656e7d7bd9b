// SPDX-License-Identifier: BSD-3-Clause
// Sliders made from the C field tables: unit, valid range, a sentence each; logarithmic over two decades and more
// (live/sliders.py). A change is asked for when the slider is let go; one that is refused springs back.

import { parseQuantity, quantity } from "./units.js";

const MOST = 8, STEPS = 1000;

function offered(table, fields, world) {
  const made = [], given = world.scene.adhesion.given, { medium } = world.scene;
  for (const [what, name, words, least, largest] of table.offered) {
    const [section, key] = name.split("."), value = world[what][section][key];
    const field = fields[what].find((row) => row.name === name);
    if (name === "medium.relative_humidity") {
      if (medium.kind === "air" && medium.surface_tension > 0) made.push({ what, name, words, field, low: 0, high: largest });
    } else if (value > 0 && (table.given[name] ?? given) === given) {
      made.push({ what, name, words, field, low: Math.max(least * value, field.minimum), high: Math.min(largest * value, field.maximum) });
    }
  }
  return made.slice(0, MOST);
}

export class Sliders {
  constructor(place, table, ask) { Object.assign(this, { place, table, ask, sliders: [], subject: "" }); }

  forget() { this.subject = ""; }

  take(world, fields) {
    if (this.subject !== world.title) {
      this.subject = world.title;
      this.sliders = offered(this.table, fields, world);
      this.place.replaceChildren(...this.sliders.map((slider) => this.#made(slider)));
    }
    for (const slider of this.sliders) {
      const [section, key] = slider.name.split(".");
      slider.value = world[slider.what][section][key];
      if (!slider.held) this.#show(slider, slider.value);
      slider.box.classList.remove("waiting");
    }
  }

  refused(name) {
    for (const slider of this.sliders.filter((one) => one.name === name)) {
      this.#show(slider, slider.value);
      slider.box.classList.remove("waiting");
    }
  }

  #made(slider) {
    slider.logarithmic = slider.low > 0 && slider.high / slider.low >= 99;
    const box = Object.assign(document.createElement("label"), { className: "slider", title: `${slider.field.doc} (${slider.name})` });
    const range = Object.assign(document.createElement("input"), { type: "range", min: 0, max: STEPS, step: 1 });
    const number = Object.assign(document.createElement("input"), { type: "text", className: "number", size: 9 });
    const name = Object.assign(document.createElement("span"), { textContent: slider.words });
    range.setAttribute("aria-label", `${slider.words}: ${slider.field.doc}`);
    number.setAttribute("aria-label", `${slider.words}, typed with its unit`);
    box.dataset.field = slider.name;
    box.append(name, number, range);
    Object.assign(slider, { box, range, number });
    range.addEventListener("input", () => {
      slider.held = true;
      number.value = quantity(slider.name, slider.field.unit, this.#at(slider));
    });
    range.addEventListener("change", () => this.#wish(slider, this.#at(slider)));
    number.addEventListener("change", () => {
      try {
        this.#wish(slider, this.#typed(slider, number.value));
      } catch (error) {
        this.#show(slider, slider.value);
        this.ask({ note: error.message });
      }
    });
    return box;
  }

  #typed(slider, text) {
    const { unit } = slider.field, plain = text.replaceAll(" ", ""), free = ["", "-", "N/N", "m/m"].includes(unit);
    const value = plain.endsWith("%") ? Number(plain.slice(0, -1)) / 100 : free ? Number(plain) : parseQuantity(text, unit, this.table.units);
    if (!Number.isFinite(value)) throw new Error(`${JSON.stringify(text)} is no number`);
    return value;
  }

  #wish(slider, value) {
    slider.held = false;
    if (value === slider.value) return this.#show(slider, value);
    slider.box.classList.add("waiting");
    return this.ask({ do: "change", what: slider.what, field: slider.name, value });
  }

  #at({ range, low, high, logarithmic }) {
    const place = range.value / STEPS;
    return Number((logarithmic ? low * (high / low) ** place : low + (high - low) * place).toPrecision(3));
  }

  #show(slider, value) {
    const { low, high, logarithmic } = slider;
    const place = logarithmic ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
    slider.range.value = Math.round(STEPS * Math.min(Math.max(place, 0), 1));
    slider.range.setAttribute("aria-valuetext", quantity(slider.name, slider.field.unit, value));
    if (document.activeElement !== slider.number) slider.number.value = quantity(slider.name, slider.field.unit, value);
  }
}
