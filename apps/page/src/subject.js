// SPDX-License-Identifier: BSD-3-Clause
// What is touched: a scene with its rig and its heights. Presets come from the table, images and curves are dropped.

// Heights as the table holds them (export.py): differences of 16 bits in two planes, deflated.
export async function unpack(surface) {
  const [rows, columns] = surface.shape;
  const packed = Uint8Array.from(atob(surface.data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = rows * columns, heights = new Float64Array(count);
  for (let j = 0, at = 0; j < rows; ++j) {
    let value = 0;
    for (let i = 0; i < columns; ++i, ++at) {
      value = (value + bytes[at] + 256 * bytes[count + at]) & 0xffff;
      heights[at] = surface.low + surface.step * value;
    }
  }
  return { heights, rows, columns, dy: surface.pixel_size[0], dx: surface.pixel_size[1] };
}

export const PROPERTIES = ["youngs_modulus", "work_of_adhesion"]; // of each place, in the order of page.h

// A row and a column more, as the last ones: the extent of a session's map is that of its pixels.
export function edged(values, { rows, columns }) {
  const made = new Float64Array((rows + 1) * (columns + 1));
  for (let j = 0, at = 0; j <= rows; ++j)
    for (let i = 0; i <= columns; ++i, ++at)
      made[at] = values[Math.min(j, rows - 1) * columns + Math.min(i, columns - 1)];
  return made;
}

// The values of a map at the pixels of another one that shows the same place: the nearest.
export function stretched(map, { rows, columns }) {
  const made = new Float64Array(rows * columns);
  for (let j = 0, at = 0; j < rows; ++j)
    for (let i = 0; i < columns; ++i, ++at)
      made[at] = map.heights[Math.floor(((j + 0.5) * map.rows) / rows) * map.columns + Math.floor(((i + 0.5) * map.columns) / columns)];
  return made;
}

export function extremes(heights) {
  let low = Infinity, high = -Infinity;
  for (const value of heights) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

// A gentle relief for what was given without one: waves of a third to a whole of the size [m].
export function relief(size, height, pixels = 128) {
  const heights = new Float64Array(pixels * pixels);
  const waves = [[0.4, 1.3, 0.2], [1.7, 2.1, 2.0], [2.6, 1.8, 4.1], [0.9, 2.7, 1.1], [2.1, 1.1, 5.2]];
  for (let j = 0, at = 0; j < pixels; ++j)
    for (let i = 0; i < pixels; ++i, ++at) {
      const x = (2 * Math.PI * i) / pixels, y = (2 * Math.PI * j) / pixels;
      for (const [angle, count, phase] of waves)
        heights[at] += Math.cos(count * (Math.cos(angle) * x + Math.sin(angle) * y) + phase) / count;
    }
  const [low, high] = extremes(heights);
  for (let at = 0; at < heights.length; ++at) heights[at] = ((heights[at] - low) / (high - low)) * height;
  return { heights, rows: pixels, columns: pixels, dx: size / pixels, dy: size / pixels };
}

export async function ofPreset(table, name) {
  const found = table.presets.find((preset) => preset.name === name);
  if (!found) throw new Error(`preset ${name}: there are ${table.presets.map((one) => one.name).join(", ")}`);
  return { name, title: found.title, hint: found.hint, scene: structuredClone(found.scene),
    rig: structuredClone(found.rig), accuracy: found.accuracy, pushed: found.pushed,
    particles: found.particles, rod: found.rod, map: await unpack(found.surface) };
}
