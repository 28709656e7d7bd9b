// SPDX-License-Identifier: BSD-3-Clause
// A thin hand over a 2-D canvas, and a frame with two axes in engineering units.

import { engineering, stepUp } from "./units.js";

const css = (colour, opacity = 1) => (opacity === 1 ? `rgb(${colour.join(",")})` : `rgba(${colour.join(",")},${opacity})`);

export class Painter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  // Begin a drawing; false where the panel is not shown.
  begin(fill) {
    const { width, height } = this.canvas.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
    if (width < 2 || height < 2) return false;
    const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, { width: w, height: h });
    Object.assign(this, { width, height });
    this.context.setTransform(scale, 0, 0, scale, 0, 0);
    if (fill) this.box(0, 0, width, height, fill);
    else this.context.clearRect(0, 0, width, height);
    return true;
  }

  area(points, fill, opacity) {
    this.#path(points);
    this.context.fillStyle = css(fill, opacity);
    this.context.fill();
  }

  box(x, y, width, height, fill, opacity) { this.area([[x, y], [x + width, y], [x + width, y + height], [x, y + height]], fill, opacity); }

  line(points, colour, width = 1.5, dashed = false) {
    if (points.length < 2) return;
    this.#path(points);
    this.context.setLineDash(dashed ? [5, 4] : []);
    Object.assign(this.context, { strokeStyle: css(colour), lineWidth: width, lineJoin: "round" });
    this.context.stroke();
  }

  #path(points) {
    this.context.beginPath();
    points.forEach(([x, y], i) => (i ? this.context.lineTo(x, y) : this.context.moveTo(x, y)));
  }

  dot(x, y, radius, fill, edge, width = fill ? 1.5 : 2.5) {
    if (!(radius > 0)) return;
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    if (fill) {
      this.context.fillStyle = css(fill);
      this.context.fill();
    }
    if (!edge) return;
    this.context.setLineDash([]);
    Object.assign(this.context, { strokeStyle: css(edge), lineWidth: width });
    this.context.stroke();
  }

  // What is drawn meanwhile is seen in a circle alone.
  within(x, y, radius, draw) {
    this.context.save();
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.clip();
    draw();
    this.context.restore();
  }

  // A light that fades outwards, from a radius on.
  glow(x, y, radius, colour, strength, from) {
    const light = this.context.createRadialGradient(x, y, from, x, y, radius);
    light.addColorStop(0, css(colour, strength));
    light.addColorStop(1, css(colour, 0));
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    if (from > 0) this.context.arc(x, y, from, 0, 2 * Math.PI, true);
    this.context.fillStyle = light;
    this.context.fill();
  }

  // A length, its words to the left.
  scale(left, right, y, words, colour) {
    this.line([[left, y], [right, y]], colour, 2);
    for (const end of [left, right]) this.line([[end, y - 4], [end, y + 4]], colour, 2);
    this.text(left - 8, y, words, colour, { align: "right" });
  }

  #letters({ size = 12, bold = false } = {}) { return `${bold ? "600 " : ""}${size}px system-ui, sans-serif`; }

  widthOf(words, of) {
    this.context.font = this.#letters(of);
    return this.context.measureText(words).width;
  }

  text(x, y, words, colour, { align = "left", size = 12, bold = false } = {}) {
    Object.assign(this.context, { fillStyle: css(colour), textAlign: align, textBaseline: "middle",
      font: this.#letters({ size, bold }) });
    this.context.fillText(words, x, y);
  }
}

export class Axes {
  constructor(painter, x, y, [left, top, right, bottom] = [56, 30, 14, 40]) {
    Object.assign(this, { painter, x, y, left, top, width: painter.width - left - right,
      height: painter.height - top - bottom });
  }

  // What is not in the frame is drawn at its edge.
  at(x, y) {
    const across = Math.min(Math.max((x - this.x[0]) / (this.x[1] - this.x[0]), 0), 1);
    const up = Math.min(Math.max((y - this.y[0]) / (this.y[1] - this.y[0]), 0), 1);
    return [this.left + across * this.width, this.top + (1 - up) * this.height];
  }

  holds(x, y) { return x >= this.x[0] && x <= this.x[1] && y >= this.y[0] && y <= this.y[1]; }

  // Of flat rows x, y those in the frame, and the first outside of it at either end, as pixels.
  mapped(rows) {
    const inside = (i) => this.holds(rows[i], rows[i + 1]);
    let first = -1, last = -1;
    for (let i = 0; i < rows.length; i += 2) {
      if (!inside(i)) continue;
      if (first < 0) first = i;
      last = i;
    }
    if (first < 0) return [];
    const made = [];
    for (let i = Math.max(first - 2, 0); i <= Math.min(last + 2, rows.length - 2); i += 2) made.push(this.at(rows[i], rows[i + 1]));
    return made;
  }

  draw(palette, names, units) {
    const { painter } = this;
    [this.x, this.y].forEach((ends, axis) => {
      const [prefixed, factor] = engineering(units[axis], ends);
      const step = stepUp(((ends[1] - ends[0]) * factor) / (axis ? 5 : 6));
      for (let n = Math.ceil((ends[0] * factor) / step - 1e-9); n <= (ends[1] * factor) / step + 1e-9; ++n) {
        const label = `${Number((n * step).toPrecision(6))}`, place = (n * step) / factor;
        const [x, y] = axis ? this.at(this.x[0], place) : this.at(place, this.y[0]);
        const end = axis ? [x + this.width, y] : [x, y - this.height];
        painter.line([[x, y], end], palette.line, 1);
        painter.text(axis ? x - 6 : x, axis ? y : y + 11, label, palette.quiet, { align: axis ? "right" : "center" });
      }
      if (axis) painter.text(8, this.top - 14, `${names[1]} (${prefixed})`, palette.quiet);
      else painter.text(this.left + this.width, this.top + this.height + 28, `${names[0]} (${prefixed})`, palette.quiet, { align: "right" });
    });
    if (this.y[0] < 0 && this.y[1] > 0) painter.line([this.at(this.x[0], 0), this.at(this.x[1], 0)], palette.quiet, 1);
  }
}
