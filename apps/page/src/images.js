// SPDX-License-Identifier: BSD-3-Clause
// Images that are dropped: PNG (grey is height) and GSF (Gwyddion's simple field). Nothing leaves the page.

const FEWEST = 4;
const MOST = 1024; // pixels to a side: a larger one is drawn smaller
const GSF = "Gwyddion Simple Field 1.0\n";

const HOLDS = { m: "heights", Pa: "youngs_modulus", "J/m^2": "work_of_adhesion", "J/m2": "work_of_adhesion", "N/m": "work_of_adhesion" };

export async function readImage(file) {
  const head = new TextDecoder("latin1").decode(await file.slice(0, GSF.length).arrayBuffer());
  if (head === GSF) return readGsf(await file.arrayBuffer());
  return { ...(await readPicture(file)), asks: true };
}

export function readGsf(buffer) {
  const bytes = new Uint8Array(buffer), end = bytes.indexOf(0);
  const head = new TextDecoder().decode(bytes.subarray(0, end < 0 ? 0 : end)), fields = {};
  for (const line of head.split("\n").slice(1)) {
    const [name, value] = line.split("=").map((part) => part?.trim());
    if (value !== undefined) fields[name.toLowerCase()] = value;
  }
  const columns = Number(fields.xres), rows = Number(fields.yres), start = 4 * Math.floor((end + 4) / 4);
  if (!(columns >= 4 && rows >= 4 && columns <= 8192 && rows <= 8192)) throw new Error(`a field of ${fields.xres} x ${fields.yres} pixels`);
  if (buffer.byteLength < start + 4 * rows * columns) throw new Error("the file is shorter than its header says");
  const unit = fields.zunits || "m", of = HOLDS[unit.replace(/\s+/g, "")];
  if (!of) throw new Error(`the field holds ${unit}; valid are m (heights), Pa (modulus), J/m^2 or N/m (work of adhesion)`);
  const view = new DataView(buffer, start), heights = new Float64Array(rows * columns);
  for (let j = 0; j < rows; ++j)
    for (let i = 0; i < columns; ++i) { // row 0 of the file is the top
      const value = view.getFloat32(4 * (j * columns + i), true);
      if (!Number.isFinite(value)) throw new Error("the field has pixels without a height");
      heights[(rows - 1 - j) * columns + i] = value;
    }
  const size = (name) => (Number(fields[name]) > 0 ? Number(fields[name]) : 1);
  return { ...smaller({ heights, rows, columns, dx: size("xreal") / columns, dy: size("yreal") / rows }), of };
}

async function readPicture(file) {
  const bitmap = await createImageBitmap(file), share = Math.min(1, MOST / Math.max(bitmap.width, bitmap.height));
  const [columns, rows] = [bitmap.width, bitmap.height].map((side) => Math.round(share * side));
  if (!(columns >= FEWEST && rows >= FEWEST)) throw new Error(`a picture of ${bitmap.width} x ${bitmap.height} pixels`);
  const canvas = new OffscreenCanvas(columns, rows), context = canvas.getContext("2d");
  context.drawImage(bitmap, 0, 0, columns, rows);
  const { data } = context.getImageData(0, 0, columns, rows), heights = new Float64Array(rows * columns);
  for (let j = 0; j < rows; ++j)
    for (let i = 0; i < columns; ++i) {
      const at = 4 * (j * columns + i);
      heights[(rows - 1 - j) * columns + i] = (data[at] + data[at + 1] + data[at + 2]) / 765;
    }
  return { heights, rows, columns, dx: 1 / columns, dy: 1 / columns };
}

// A picture knows neither its width nor its heights: both are asked for [m].
export function scaled(map, width, height) {
  return { ...map, heights: map.heights.map((value) => value * height), dx: width / map.columns, dy: width / map.columns };
}

function smaller(map) {
  const size = Math.ceil(Math.max(map.rows, map.columns) / MOST);
  if (size === 1) return map;
  const rows = Math.floor(map.rows / size), columns = Math.floor(map.columns / size), heights = new Float64Array(rows * columns);
  for (let j = 0; j < rows * size; ++j)
    for (let i = 0; i < columns * size; ++i)
      heights[Math.floor(j / size) * columns + Math.floor(i / size)] += map.heights[j * map.columns + i] / (size * size);
  return { heights, rows, columns, dx: map.dx * size, dy: map.dy * size };
}
