// SPDX-License-Identifier: BSD-3-Clause
// Sliders as the host tells them: a title, a unit, a sentence, and stops with a value and its words each. A change is
// asked for when the slider is let go; one that is refused springs back.

import { parseQuantity } from "./units.js";

export class Sliders {
  constructor(place, table, ask) { Object.assign(this, { place, table, ask, sliders: [] }); }

  lay(rows) {
    this.sliders = rows.map((row) => ({ ...row }));
    this.place.replaceChildren(...this.sliders.map((slider) => this.#made(slider)));
  }

  take(world) {
    for (const slider of this.sliders) {
      const [section, key] = slider.field.split(".");
      slider.value = world[slider.what][section][key];
      slider.words = world.shown[slider.field];
      if (!slider.held) this.#show(slider);
      slider.box.classList.remove("waiting");
    }
  }

  refused(name) {
    for (const slider of this.sliders.filter((one) => one.field === name)) {
      this.#show(slider);
      slider.box.classList.remove("waiting");
    }
  }

  #made(slider) {
    const box = Object.assign(document.createElement("label"), { className: "slider", title: `${slider.doc} (${slider.field})` });
    const range = Object.assign(document.createElement("input"), { type: "range", min: 0, max: slider.stops.length - 1, step: 1 });
    const number = Object.assign(document.createElement("input"), { type: "text", className: "number", size: 9 });
    const name = Object.assign(document.createElement("span"), { textContent: slider.title });
    range.setAttribute("aria-label", `${slider.title}: ${slider.doc}`);
    number.setAttribute("aria-label", `${slider.title}, typed with its unit`);
    box.dataset.field = slider.field;
    box.append(name, number, range);
    Object.assign(slider, { box, range, number });
    range.addEventListener("input", () => {
      slider.held = true;
      number.value = slider.stops[range.value][1];
    });
    range.addEventListener("change", () => this.#wish(slider, slider.stops[range.value][0]));
    number.addEventListener("change", () => {
      try {
        this.#wish(slider, this.#typed(slider, number.value));
      } catch (error) {
        this.#show(slider);
        this.ask({ note: error.message });
      }
    });
    return box;
  }

  #typed({ unit }, text) {
    const plain = text.replaceAll(" ", ""), free = ["", "-", "N/N", "m/m"].includes(unit);
    const value = plain.endsWith("%") ? Number(plain.slice(0, -1)) / 100 : free ? Number(plain) : parseQuantity(text, unit, this.table.units);
    if (!Number.isFinite(value)) throw new Error(`${JSON.stringify(text)} is no number`);
    return value;
  }

  #wish(slider, value) {
    slider.held = false;
    if (value === slider.value) return this.#show(slider);
    slider.box.classList.add("waiting");
    return this.ask({ do: "change", what: slider.what, field: slider.field, value });
  }

  // At the nearest stop.
  #show({ stops, value, words, range, number }) {
    const above = stops.findIndex(([stop]) => stop >= value), at = above < 0 ? stops.length - 1 : above;
    range.value = at > 0 && value - stops[at - 1][0] < stops[at][0] - value ? at - 1 : at;
    range.setAttribute("aria-valuetext", words);
    if (document.activeElement !== number) number.value = words;
  }
}
