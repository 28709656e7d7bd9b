// SPDX-License-Identifier: BSD-3-Clause
// Surface, tip, lever, shadow and trace, by vtk.js, as nanotouch_app/live/stage.py. The surface is made once, in tiles:
// that the tip moves changes no byte of it. One scene unit is the longer side of the surface.

import "@kitware/vtk.js/Rendering/Profiles/Geometry";
import vtkActor from "@kitware/vtk.js/Rendering/Core/Actor";
import vtkColorTransferFunction from "@kitware/vtk.js/Rendering/Core/ColorTransferFunction";
import vtkDataArray from "@kitware/vtk.js/Common/Core/DataArray";
import vtkLight from "@kitware/vtk.js/Rendering/Core/Light";
import vtkMapper from "@kitware/vtk.js/Rendering/Core/Mapper";
import vtkOpenGLRenderWindow from "@kitware/vtk.js/Rendering/OpenGL/RenderWindow";
import vtkPolyData from "@kitware/vtk.js/Common/DataModel/PolyData";
import vtkRenderWindow from "@kitware/vtk.js/Rendering/Core/RenderWindow";
import vtkRenderer from "@kitware/vtk.js/Rendering/Core/Renderer";
import { DrawnBalls } from "./balls.js";
import { dented, grid, laidOn, lever, stepped, stripOn, tile, tileValues, turned, walls } from "./shapes.js";

const TILE = 128, MOST = 256; // pixels to a side of a tile, and of the whole mesh
const GLASSY = 0.45; // of a tip that dents the sample
const ANGLE = 36; // of the camera, from above to below [degrees]
const unit = (colour) => colour.map((part) => part / 255);
const radians = (degrees) => (degrees * Math.PI) / 180;

export class Stage {
  constructor(place, constants) {
    Object.assign(this, { place, constants, tiles: [], shape: "", visible: true, rebuilt: 0 });
    this.works = Boolean(document.createElement("canvas").getContext("webgl2"));
    this.renderer = vtkRenderer.newInstance();
    this.window = vtkRenderWindow.newInstance();
    this.window.addRenderer(this.renderer);
    this.api = vtkOpenGLRenderWindow.newInstance();
    this.api.setContainer(place);
    this.window.addView(this.api);
    this.renderer.setTwoSidedLighting(true);
    this.#light();
    this.balls = new DrawnBalls(constants, (mesh) => this.#mesh(mesh), (actor) => this.renderer.removeActor(actor));
    this.resize();
  }

  #light() {
    this.renderer.removeAllLights();
    this.renderer.setAutomaticLightCreation(false);
    for (const [place, strength] of this.constants.LIGHTS) {
      const light = vtkLight.newInstance({ positional: false, intensity: strength });
      light.setLightTypeToSceneLight();
      light.setPosition(...place.map((part, axis) => part + [0.5, 0.5, 0][axis]));
      light.setFocalPoint(0.5, 0.5, 0);
      this.renderer.addLight(light);
    }
  }

  resize() {
    const { width, height } = this.place.getBoundingClientRect(), scale = Math.min(window.devicePixelRatio || 1, 2);
    this.pixels = [Math.max(width, 1), Math.max(height, 1)];
    this.api.setSize(Math.floor(Math.max(width, 1) * scale), Math.floor(Math.max(height, 1) * scale));
  }

  #actor(data, lit = true) {
    const mapper = vtkMapper.newInstance(), actor = vtkActor.newInstance();
    mapper.setInputData(data);
    actor.setMapper(mapper);
    const look = actor.getProperty();
    look.setLighting(lit);
    this.renderer.addActor(actor);
    return actor;
  }

  // --- made once for a surface ---

  lay(surface) {
    for (const actor of [...this.tiles, ...(this.others ?? [])]) this.renderer.removeActor(actor);
    this.balls.forget();
    this.grid = grid(surface, MOST, this.constants);
    this.columns = surface.columns;
    this.colours = vtkColorTransferFunction.newInstance();
    this.maps = { height: this.grid };
    for (const [name, heights] of Object.entries(surface.properties ?? {}))
      this.maps[name] = grid({ ...surface, heights }, MOST, this.constants);
    this.shown = "height";
    Object.assign(this, { tiles: [], places: [] });
    for (let row = 0; row < this.grid.rows - 1; row += TILE - 1)
      for (let column = 0; column < this.grid.columns - 1; column += TILE - 1) {
        this.tiles.push(this.#tile(row, column));
        this.places.push([row, column]);
      }
    this.rebuilt += this.grid.heights.byteLength;
    this.shadowData = [...this.constants.SHADES, ...this.constants.BEAM_SHADES].map(() => vtkPolyData.newInstance());
    this.shadows = this.shadowData.map((data) => {
      const actor = this.#actor(data, false);
      actor.getProperty().setColor(0, 0, 0);
      actor.getProperty().setOpacity(0.12);
      return actor;
    });
    this.#raiseWalls();
    this.traceData = vtkPolyData.newInstance();
    this.trace = this.#actor(this.traceData, false);
    this.trace.getProperty().setLineWidth(3);
    this.shape = "";
    this.others = [...this.shadows, this.trace, this.walls];
    this.camera("0");
    if (this.palette) this.paint(this.palette);
  }

  #raiseWalls() {
    if (this.walls) this.renderer.removeActor(this.walls);
    this.walls = this.#mesh(walls(this.grid, this.constants.FLOOR));
    this.walls.getProperty().setAmbient(0.28);
    this.walls.setVisibility(this.visible);
  }

  // The tip has changed the surface, and can dent it by so much [m]: tiles are made anew where it has.
  reshape(heights, dent) {
    const { grid: map } = this, before = map.heights.slice(), all = dented(map, heights, this.columns, dent, this.constants);
    this.tiles.forEach((actor, i) => {
      if (!all && !this.#differs(before, this.places[i])) return;
      this.#mould(actor.getMapper().getInputData(), ...this.places[i]);
      actor.setScale(1, 1, map.factor / map.built);
      this.rebuilt += 4 * TILE * TILE;
    });
    if (all) this.#raiseWalls();
    this.lastTraced = null;
    this.tip?.getProperty().setOpacity(GLASSY); // what it leaves lies below it
    this.paint(this.palette);
  }

  // Whether a point of a tile, or beside it, is elsewhere.
  #differs(before, [row, column]) {
    const { heights, rows, columns } = this.grid;
    for (let j = Math.max(row - 1, 0); j < Math.min(row + TILE + 1, rows); ++j)
      for (let i = Math.max(column - 1, 0); i < Math.min(column + TILE + 1, columns); ++i)
        if (heights[j * columns + i] !== before[j * columns + i]) return true;
    return false;
  }

  // Points, normals and what is shown by colour of a tile.
  #mould(data, row, column) {
    const made = tile(this.grid, row, column, TILE);
    data.getPoints().setData(made.points, 3);
    data.getPoints().modified();
    data.getPointData().setScalars(vtkDataArray.newInstance({ name: this.shown,
      values: this.shown === "height" ? made.heights : tileValues(this.maps[this.shown], [row, column], TILE) }));
    data.getPointData().setNormals(
      vtkDataArray.newInstance({ name: "normals", values: made.normals, numberOfComponents: 3 }));
    data.modified();
    return made.cells;
  }

  #tile(row, column) {
    const data = vtkPolyData.newInstance();
    data.getPolys().setData(this.#mould(data, row, column));
    const actor = this.#actor(data), mapper = actor.getMapper();
    mapper.setLookupTable(this.colours);
    mapper.setUseLookupTableScalarRange(true);
    mapper.setInterpolateScalarsBeforeMapping(true);
    actor.getProperty().setAmbient(0.28);
    actor.getProperty().setDiffuse(0.8);
    actor.getProperty().setSpecular(0.12);
    return actor;
  }

  paint(palette) {
    this.palette = palette;
    this.renderer.setBackground(...unit(palette.panel), 1);
    if (!this.grid) return;
    const [low, high] = this.ends, { table } = this;
    this.colours.removeAllPoints();
    table.forEach((colour, i) => this.colours.addRGBPoint(low + ((high - low) * i) / (table.length - 1), ...unit(colour)));
    this.colours.setMappingRange(low, high);
    for (const actor of [this.tip, this.lever]) actor?.getProperty().setColor(...unit(palette.tip));
    this.walls.getProperty().setColor(...unit(palette.heights[1]));
  }

  // Of what is shown by colour; its colours from low to high.
  get ends() { return this.maps[this.shown].ends; }
  get table() { return this.constants.PROPERTY_COLOURS[this.shown] ?? this.palette.heights; }

  // Height, then each property there is; what is shown now.
  colourByNext() {
    const names = Object.keys(this.maps);
    this.shown = names[(names.indexOf(this.shown) + 1) % names.length];
    this.tiles.forEach((actor, i) => {
      const data = actor.getMapper().getInputData();
      data.getPointData().setScalars(vtkDataArray.newInstance({ name: this.shown,
        values: tileValues(this.maps[this.shown], this.places[i], TILE) }));
      data.modified();
    });
    this.paint(this.palette);
    return this.shown;
  }

  // One step higher or lower; the tiles are stretched, not made anew.
  raiseHeights(up) {
    const { grid: map } = this;
    map.factor = stepped(map.factor, up, map.relief / map.unit, this.constants);
    map.scale = map.factor / map.unit;
    for (const actor of [...this.tiles, this.walls]) actor.setScale(1, 1, map.factor / map.built);
    this.lastTraced = null;
  }

  lights(on) {
    if (on === this.visible) return;
    this.visible = on;
    for (const actor of [...this.tiles, ...this.shadows, this.walls, this.trace, ...this.balls.actors]) actor.setVisibility(on);
  }

  // --- the instrument: made anew when another tip is mounted ---

  mount({ radius, half_angle: halfAngle, shape }) {
    const key = `${radius} ${halfAngle} ${shape}`;
    if (key === this.shape || !this.grid) return;
    this.shape = key;
    for (const actor of [this.tip, this.lever]) if (actor) this.renderer.removeActor(actor);
    const ball = shape === "sphere" || radius > this.constants.BALL;
    this.tip = this.#mesh(turned(radius / this.grid.unit, halfAngle, ball, this.constants.TIP_HEIGHT));
    this.tip.getProperty().setSpecular(0.35);
    this.tip.getProperty().setSpecularPower(25);
    this.tip.getProperty().setAmbient(0.3);
    this.tip.getProperty().setOpacity(this.grid.dent ? GLASSY : 1);
    this.leverData = vtkPolyData.newInstance();
    this.lever = this.#actor(this.leverData);
    this.lever.getProperty().setSpecular(0.2);
    this.lever.getProperty().setAmbient(0.2);
    this.others = [...this.shadows, this.trace, this.walls, this.tip, this.lever];
    this.paint(this.palette);
  }

  #mesh({ points, normals, cells }) {
    const data = vtkPolyData.newInstance();
    data.getPoints().setData(points, 3);
    data.getPolys().setData(cells);
    if (normals) data.getPointData().setNormals(vtkDataArray.newInstance({ name: "normals", values: normals, numberOfComponents: 3 }));
    return this.#actor(data);
  }

  // --- what moves ---

  // Where the tip is drawn: over the drawn surface, at the gap that is true.
  apex(now) {
    const { grid: map, constants } = this, [x, y, z] = now.tip, ground = map.at(x, y);
    const above = (Number.isFinite(now.gap) && !map.dent ? now.gap : z - ground) * map.scale; // a gap is that of the dent as it was
    const drawn = above > 0 ? constants.FAR * Math.tanh(above / constants.FAR) : above;
    return [x / map.unit, y / map.unit, (ground - map.low) * map.scale + drawn];
  }

  update(now, seen) {
    if (!this.tip) return;
    const at = this.apex(now), { grid: map, constants } = this;
    this.tip.setPosition(...at);
    this.#lookAt(at);
    const bend = seen.load > 0 ? constants.BEND * Math.min(Math.max(seen.force / seen.load, -1.5), 1.5) : 0;
    this.#set(this.leverData, lever(at, bend, constants));
    const above = Math.max(at[2] - (map.at(now.tip[0], now.tip[1]) - map.low) * map.scale, 0), [right, back] = constants.CAST;
    const cast = (height) => [at[0] + right * height, at[1] + back * height];
    constants.SHADES.forEach((share, i) => this.#set(this.shadowData[i],
      laidOn(map, cast(above), constants.SHADOW * share * (1 + 3 * above), constants.LIFTED)));
    const [length, width] = constants.LEVER, [x, y] = cast(above + constants.TIP_HEIGHT);
    constants.BEAM_SHADES.forEach((share, i) => this.#set(this.shadowData[constants.SHADES.length + i],
      stripOn(map, [x, y - constants.NOSE * share], [length, width * share], constants.LIFTED)));
    this.#drawTrace(seen);
  }

  #set(data, { points, cells }) {
    data.getPoints().setData(points, 3);
    if (data.getPolys().getNumberOfValues() !== cells.length) data.getPolys().setData(cells);
    data.getPoints().modified();
    data.modified();
  }

  #drawTrace(seen) {
    const rows = seen.trace, { grid: map, palette } = this;
    if (rows.length < 2 || rows.at(-1) === this.lastTraced) return;
    this.lastTraced = rows.at(-1);
    const points = new Float32Array(3 * rows.length), colours = new Uint8Array(4 * rows.length);
    const cells = Uint32Array.from({ length: rows.length + 1 }, (_, i) => (i ? i - 1 : rows.length));
    const now = rows.at(-1).time;
    rows.forEach((row, i) => {
      points.set([row.x / map.unit, row.y / map.unit,
        (map.at(row.x, row.y) - map.low) * map.scale + this.constants.LIFTED], 3 * i);
      const pushed = Math.min(Math.max((3 * row.force) / seen.load, 0), 1);
      const pulled = Math.min(Math.max(-row.force / Math.max(seen.pullOff, 1e-15), 0), 1), share = Math.max(pushed, pulled);
      const end = pushed > 0 ? palette.repulsion : palette.attraction;
      const fade = 255 * Math.max(1 - (now - row.time) / this.constants.TRACE, 0) * (share > 0.01 ? 1 : 0);
      colours.set([...end.map((part, k) => share * part + (1 - share) * palette.paper[k]), fade], 4 * i);
    });
    this.traceData.getPoints().setData(points, 3);
    this.traceData.getLines().setData(cells);
    this.traceData.getPointData().setScalars(
      vtkDataArray.newInstance({ name: "colours", values: colours, numberOfComponents: 4 }));
    this.traceData.modified();
  }

  // --- the camera ---

  camera(view, at) {
    const [turn, height, distance] = this.constants.VIEWS[view];
    const camera = this.renderer.getActiveCamera(), [a, b] = [radians(turn), radians(height)];
    this.middle = at && view === "4" ? at : [0.5 * this.grid.width, 0.5 * this.grid.height, 0];
    Object.assign(this, { distance, magnification: 1 });
    camera.setViewAngle(ANGLE);
    camera.setFocalPoint(0, 0, 0);
    camera.setPosition(Math.sin(a) * Math.cos(b), -Math.cos(a) * Math.cos(b), Math.sin(b));
    camera.setViewUp(0, view === "2" ? 1 : 0, view === "2" ? 0 : 1);
    this.#lookAt(this.middle);
  }

  // By steps of the wheel, about the tip; how many times as large. A drag leads the tip by so much less.
  magnify(steps) {
    const { ZOOM, CLOSEST } = this.constants;
    this.magnification = Math.min(Math.max(this.magnification * ZOOM ** steps, 1), CLOSEST);
    return this.magnification;
  }

  // The picture grows about the tip, which is seen where it was.
  #lookAt(apex) {
    const camera = this.renderer.getActiveCamera(), share = 1 / this.magnification;
    const from = camera.getFocalPoint(), away = camera.getPosition().map((part, axis) => part - from[axis]);
    const focus = apex.map((part, axis) => part + share * (this.middle[axis] - part) + (axis === 2 ? this.constants.RAISED * share : 0));
    const far = (this.distance * share) / Math.hypot(...away);
    camera.setFocalPoint(...focus);
    camera.setPosition(...focus.map((part, axis) => part + far * away[axis]));
  }

  // Pixels of a length at the depth of what the camera looks at [1/m].
  get perMetre() {
    return this.pixels[1] / (2 * (this.distance / this.magnification) * Math.tan(radians(ANGLE) / 2) * this.grid.unit);
  }

  turn(dx, dy) {
    const camera = this.renderer.getActiveCamera();
    camera.azimuth(-0.4 * dx);
    camera.elevation(0.4 * dy);
    camera.orthogonalizeViewUp();
  }

  // Where a place in scene units is in the panel [CSS pixels, y down].
  pixel(place) {
    const [width, height] = this.pixels, matrix = this.renderer.getActiveCamera()
      .getCompositeProjectionMatrix(width / height, -1, 1);
    const part = (row) => matrix[4 * row] * place[0] + matrix[4 * row + 1] * place[1] + matrix[4 * row + 2] * place[2] +
      matrix[4 * row + 3];
    const w = part(3);
    return [(0.5 + (0.5 * part(0)) / w) * width, (0.5 - (0.5 * part(1)) / w) * height];
  }

  // The way in x and y [m] that a drag by so many pixels means at this place.
  dragged(place, [dx, dy]) {
    const step = 1e-3, here = this.pixel(place);
    const [right, up] = [[step, 0], [0, step]].map(([x, y]) => {
      const there = this.pixel([place[0] + x, place[1] + y, place[2]]);
      return [(there[0] - here[0]) / step, (there[1] - here[1]) / step];
    });
    const area = right[0] * up[1] - right[1] * up[0];
    if (Math.abs(area) < 1e-3 * Math.hypot(...right) * Math.hypot(...up)) return [0, 0];
    return [((dx * up[1] - dy * up[0]) / area) * this.grid.unit, ((right[0] * dy - right[1] * dx) / area) * this.grid.unit];
  }

  render() {
    if (!this.works) return;
    this.renderer.resetCameraClippingRange();
    this.window.render();
  }
}
