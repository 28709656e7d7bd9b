// SPDX-License-Identifier: BSD-3-Clause
// Meshes: points, cells and normals as plain arrays.

// Cells of vtk.js: the number of corners before each.
function quads(rows, columns) {
  const cells = new Uint32Array(5 * (rows - 1) * (columns - 1));
  let at = 0;
  for (let j = 0; j < rows - 1; ++j)
    for (let i = 0; i < columns - 1; ++i, at += 5) {
      const corner = j * columns + i;
      cells.set([4, corner, corner + 1, corner + columns + 1, corner + columns], at);
    }
  return cells;
}

const SHOWN = 0.25; // of the deepest dent: so far the colours go at least, so that noise of a shallow one is none

// How much higher than they are heights are drawn (live/relief.py).

// Way along y or x after which heights are as good as any others: their mean square difference is the variance.
function featureWidth({ heights, rows, columns, dx, dy }) {
  const mean = heights.reduce((sum, one) => sum + one, 0) / heights.length;
  const variance = heights.reduce((sum, one) => sum + (one - mean) ** 2, 0) / heights.length;
  const differs = (lag, step, lines, others, other) => {
    let sum = 0;
    for (let i = 0; i < lines - lag; ++i)
      for (let j = 0; j < others; ++j) sum += (heights[(i + lag) * step + j * other] - heights[i * step + j * other]) ** 2;
    return sum >= variance * (lines - lag) * others;
  };
  const way = (lines, step, others, other) => {
    const most = Math.floor(lines / 2);
    let lag = 1;
    while (lag < most && !differs(lag, step, lines, others, other)) ++lag;
    return lag;
  };
  return Math.min(way(rows, columns, columns, 1) * dy, way(columns, 1, rows, columns) * dx);
}

function stepBelow(factor, ladder) {
  if (!(factor > 1)) return 1;
  const power = 10 ** Math.floor(Math.log10(factor));
  return Math.max(...ladder.map((step) => step * power).filter((step) => step <= factor * (1 + 1e-12)));
}

// The next step, from 1 to where the relief (in scene units) is the highest.
export function stepped(factor, up, relief, { LADDER, HIGHEST }) {
  if (!up) return stepBelow(factor * (1 - 1e-9), LADDER);
  const power = 10 ** Math.floor(Math.log10(factor * (1 + 1e-9)));
  const following = [...LADDER, 10].map((step) => step * power).find((step) => step > factor * (1 + 1e-9));
  return following * relief <= HIGHEST ? following : factor;
}

// Mean heights over squares of pixels.
function means({ heights, columns }, size, ny, nx) {
  const mean = new Float32Array(nx * ny);
  for (let j = 0; j < ny * size; ++j)
    for (let i = 0; i < nx * size; ++i)
      mean[Math.floor(j / size) * nx + Math.floor(i / size)] += heights[j * columns + i] / (size * size);
  return mean;
}

function extremesOf(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

// The drawn surface, at most `most` points to a side; in units of the longer side.
export function grid({ heights, rows, columns, dx, dy }, most, { RELIEF, SLENDER, LADDER }) {
  const size = Math.ceil(Math.max(rows, columns) / most);
  const ny = Math.floor(rows / size), nx = Math.floor(columns / size), mean = means({ heights, columns }, size, ny, nx);
  const unit = Math.max(rows * dy, columns * dx), [low, high] = extremesOf(mean);
  const made = { heights: mean, rows: ny, columns: nx, size, unit, low, dx: (size * dx) / unit, dy: (size * dy) / unit, ends: [low, Math.max(high, low + Math.max(1e-12, 1e-9 * Math.abs(low)))], relief: high - low, dent: 0 };
  made.factor = made.built = high > low
    ? stepBelow((unit * Math.min(RELIEF, SLENDER * featureWidth(made))) / (high - low), LADDER) : 1;
  made.scale = made.factor / unit;
  made.width = nx * made.dx;
  made.height = ny * made.dy;
  // height of the drawn surface [m], linear between its points
  made.at = (x, y) => {
    const column = Math.min(Math.max(x / unit / made.dx - 0.5, 0), nx - 1.001);
    const row = Math.min(Math.max(y / unit / made.dy - 0.5, 0), ny - 1.001);
    const i = Math.floor(column), j = Math.floor(row), u = column - i, v = row - j, at = j * nx + i;
    return (1 - v) * ((1 - u) * mean[at] + u * mean[at + 1]) + v * ((1 - u) * mean[at + nx] + u * mean[at + nx + 1]);
  };
  return made;
}

// Other heights in a grid whose tip dents it by so much at most [m]; whether all of it is drawn otherwise now: the first
// time it is stretched, so that a dent is seen. Its ground stays where it is drawn.
export function dented(map, heights, columns, dent, { RELIEF, LADDER }) {
  map.heights.set(means({ heights, columns }, map.size, map.rows, map.columns));
  const [low, high] = extremesOf(map.heights), isFirst = map.dent !== dent;
  map.ends = [Math.min(low, map.low - SHOWN * dent), Math.max(high, map.low + SHOWN * dent)];
  map.relief = Math.max(high - low, dent);
  if (!isFirst) return false;
  map.dent = dent;
  map.factor = map.built = stepBelow((map.unit * RELIEF) / map.relief, LADDER);
  map.scale = map.factor / map.unit;
  return true;
}

export function tile(map, row, column, size) {
  const scale = map.built / map.unit; // what is changed by hand stretches the actor
  const rows = Math.min(size, map.rows - row), columns = Math.min(size, map.columns - column), count = rows * columns;
  const points = new Float32Array(3 * count), normals = new Float32Array(3 * count), heights = new Float32Array(count);
  const height = (j, i) => map.heights[j * map.columns + i];
  for (let j = 0, at = 0; j < rows; ++j)
    for (let i = 0; i < columns; ++i, ++at) {
      const y = row + j, x = column + i, left = Math.max(x - 1, 0), right = Math.min(x + 1, map.columns - 1);
      const below = Math.max(y - 1, 0), above = Math.min(y + 1, map.rows - 1);
      heights[at] = height(y, x);
      points.set([(x + 0.5) * map.dx, (y + 0.5) * map.dy, (heights[at] - map.low) * scale], 3 * at);
      const slopeX = ((height(y, right) - height(y, left)) * scale) / ((right - left) * map.dx);
      const slopeY = ((height(above, x) - height(below, x)) * scale) / ((above - below) * map.dy);
      const length = Math.hypot(slopeX, slopeY, 1);
      normals.set([-slopeX / length, -slopeY / length, 1 / length], 3 * at);
    }
  return { points, normals, heights, cells: quads(rows, columns) };
}

// What another map of the same grid holds at the points of a tile.
export function tileValues(map, [row, column], size) {
  const rows = Math.min(size, map.rows - row), columns = Math.min(size, map.columns - column);
  return Float32Array.from({ length: rows * columns }, (_, at) =>
    map.heights[(row + Math.floor(at / columns)) * map.columns + column + (at % columns)]);
}

// A tip: a sphere that goes over into a cone, or a ball on a stem; its apex at 0.
export function turned(radius, halfAngle, ball, tall) {
  const last = ball ? 0.9 * Math.PI : Math.PI / 2 - halfAngle, profile = [];
  for (let i = 0; i < 28; ++i) {
    const angle = (last * i) / 27;
    profile.push([radius * Math.sin(angle), radius * (1 - Math.cos(angle)), Math.sin(angle), -Math.cos(angle)]);
  }
  const end = profile.at(-1);
  if (end[1] < tall) {
    const widening = last < Math.PI / 2 ? Math.tan(halfAngle) : 0;
    profile.push([end[0] + (tall - end[1]) * widening, tall, Math.cos(halfAngle), -Math.sin(halfAngle)]);
  }
  profile.push([profile.at(-1)[0], profile.at(-1)[1], 0, 1], [0, profile.at(-1)[1], 0, 1]); // it is closed above
  const around = 41, points = [], normals = [];
  for (const [r, h, nr, nz] of profile)
    for (let k = 0; k < around; ++k) {
      const turn = (2 * Math.PI * k) / (around - 1), [c, s] = [Math.cos(turn), Math.sin(turn)];
      points.push(r * c, r * s, h);
      normals.push(nr * c, nr * s, nz);
    }
  return { points: Float32Array.from(points), normals: Float32Array.from(normals), cells: quads(profile.length, around) };
}

// A sphere around 0.
export function ball(radius, rows = 33, around = 49) {
  const normals = new Float32Array(3 * rows * around);
  for (let i = 0, at = 0; i < rows; ++i)
    for (let k = 0; k < around; ++k, at += 3) {
      const angle = (Math.PI * i) / (rows - 1), turn = (2 * Math.PI * k) / (around - 1);
      normals.set([Math.sin(angle) * Math.cos(turn), Math.sin(angle) * Math.sin(turn), -Math.cos(angle)], at);
    }
  return { points: normals.map((part) => radius * part), normals, cells: quads(rows, around) };
}

// Along x with round ends; of no length a ball.
export function rod(radius, length) {
  const made = ball(radius);
  for (let at = 0; at < made.points.length; at += 3) made.points[at] += 0.5 * Math.sign(made.points[at]) * length;
  return made;
}

// A flat ring around 0.
export function ring(inner, outer, around = 65) {
  const points = new Float32Array(6 * around), normals = new Float32Array(6 * around);
  for (let k = 0; k < 2 * around; ++k) {
    const turn = (2 * Math.PI * (k % around)) / (around - 1), r = k < around ? inner : outer;
    points.set([r * Math.cos(turn), r * Math.sin(turn), 0], 3 * k);
    normals.set([0, 0, 1], 3 * k);
  }
  return { points, normals, cells: quads(2, around) };
}

// Corners of a ring across a lever, closed: left and right below, right and left above.
const corners = (x, y, half, low, high) => [[x - half, y, low], [x + half, y, low], [x + half, y, high], [x - half, y, high], [x - half, y, low]];
const closed = (place) => Array(5).fill(place);

// The lever with its chip: a beam that is clamped behind, w = zeta (3 s^2 - s^3)/2; its nose is before the tip.
export function lever(at, bend, { LEVER, LEVER_POINTS: count, TIP_HEIGHT, NOSE, TILT, CHIP }) {
  const [length, width, thick] = LEVER, [back, wide, tall] = CHIP, foot = at[2] + TIP_HEIGHT, rings = [];
  const ring = (y, half, low, high) => rings.push(corners(at[0], y, half, low, high));
  const root = at[1] + length, top = foot - bend + TILT * length;
  rings.push(closed([at[0], root + back, top]));
  ring(root + back, wide / 2, top, top + tall);
  ring(root, wide / 2, top, top + tall);
  for (let i = 0; i < count; ++i) {
    const s = i / (count - 1), y = root - (length + NOSE) * s, ahead = Math.max((at[1] - y) / NOSE - 0.5, 0);
    const z = foot - bend * (1 - 0.5 * (3 * s * s - s ** 3)) + TILT * (y - at[1]);
    ring(y, (width / 2) * (1 - ahead), z, z + thick);
  }
  rings.push(closed([at[0], at[1] - NOSE, rings.at(-1)[0][2]]));
  return { points: Float32Array.from(rings.flat(2)), cells: quads(rings.length, 5) };
}

// A strip that lies on the surface, from a place along y.
export function stripOn(map, [x, y], [length, width], lifted, count = 24) {
  const points = new Float32Array(9 * count);
  for (let i = 0, at = 0; i < count; ++i)
    for (let side = -1; side <= 1; ++side, at += 3) {
      const u = Math.min(Math.max(x + (side * width) / 2, map.dx / 2), map.width - map.dx / 2);
      const v = Math.min(Math.max(y + (length * i) / (count - 1), map.dy / 2), map.height - map.dy / 2);
      points.set([u, v, (map.at(u * map.unit, v * map.unit) - map.low) * map.scale + lifted], at);
    }
  return { points, cells: quads(count, 3) };
}

// The walls of the block whose top the surface is, down to a floor.
export function walls(map, floor) {
  const { rows, columns } = map, rim = [];
  for (let i = 0; i < columns; ++i) rim.push([0, i]);
  for (let j = 1; j < rows; ++j) rim.push([j, columns - 1]);
  for (let i = columns - 2; i >= 0; --i) rim.push([rows - 1, i]);
  for (let j = rows - 2; j >= 0; --j) rim.push([j, 0]);
  const points = new Float32Array(6 * rim.length);
  rim.forEach(([j, i], at) => {
    const place = [(i + 0.5) * map.dx, (j + 0.5) * map.dy];
    points.set([...place, ((map.heights[j * columns + i] - map.low) * map.built) / map.unit], 3 * at);
    points.set([...place, -floor], 3 * (rim.length + at));
  });
  return { points, cells: quads(2, rim.length) };
}

// A disc that lies on the surface, as it rises and falls there.
export function laidOn(map, middle, size, lifted, rings = 6, round = 33) {
  const points = new Float32Array(3 * rings * round);
  for (let ring = 0, at = 0; ring < rings; ++ring)
    for (let k = 0; k < round; ++k, at += 3) {
      const turn = (2 * Math.PI * k) / (round - 1), r = (size * ring) / (rings - 1);
      const x = Math.min(Math.max(middle[0] + r * Math.cos(turn), map.dx / 2), map.width - map.dx / 2);
      const y = Math.min(Math.max(middle[1] + r * Math.sin(turn), map.dy / 2), map.height - map.dy / 2);
      points.set([x, y, (map.at(x * map.unit, y * map.unit) - map.low) * map.scale + lifted], at);
    }
  return { points, cells: quads(rings, round) };
}
