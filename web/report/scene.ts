// Reads a scene (docs/scene.md): shapes at any time, and what they carry.
export type Point = [number, number, number];
export interface Hinge {
  name: string; place: Point[]; state: number[]; rotation: number[];
  moment?: number[]; energy?: number[]; law_energy?: number; travel?: number[];
}
export interface Mass { name: string; mass: number; place: Point[] }
export interface Support { name: string; held: string[]; place: Point[] }
export interface Force { name: string; on: string; place: Point[]; force: Point[] }
export interface Obstacle {
  name: string; type: string; points: Point[]; quads: number[][]; shift: Point[]; about?: Point; axis?: Point; angle?: number[];
}
/** One result; from `index` on it is what the bytes hold, and its shape as it is drawn. */
export interface Model {
  name: string; points: number; quads: number; walls: number; coloured: boolean;
  members: string[]; first: number[]; hinges: Hinge[]; masses: Mass[]; supports: Support[]; forces: Force[]; obstacles: Obstacle[];
  index: Uint32Array; grid: (Uint16Array | Float32Array)[]; strain: Uint8Array[]; position: Float32Array; paint: Float32Array;
}
export interface Curve { name: string; unit: string; values: number[][] }
export interface Explore {
  axes: { name: string; unit: string; values: number[] }[]; models: number[]; reasons: string[]; curves: Curve[]; times: number[];
}
export interface Header {
  format: string; version: number; title: string; times: number[]; origin: Point; size: Point; step: number;
  view: { right: Point; up: Point; towards: Point }; strain: number; models: Model[]; explore?: Explore;
}
export type Colour = string;

/** share of the deformation that is next to all */
const DONE = 0.995;
const RAMP = [[0.80, 0.85, 0.90], [0.99, 0.91, 0.62], [0.97, 0.64, 0.32], [0.83, 0.24, 0.19], [0.42, 0.05, 0.20]];
const WALL: Point = [0.62, 0.71, 0.80];
export const STATES = ["closed", "rotating", "at rest"];
const STATE_COLOURS: Point[] = [[0.55, 0.60, 0.64], [0.85, 0.37, 0.01], [0.12, 0.37, 0.62]];
const READS = 1;  // version of the format

/** @param text base64 of zlib */
export async function unpack(text: string): Promise<Uint8Array> {
  const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Colour of a share from 0 to 1, put into a list at a place. */
function ramp<T extends Float32Array | number[]>(x: number, out: T, at: number): T {
  const place = Math.min(Math.max(x, 0), 0.9999) * (RAMP.length - 1), k = Math.floor(place), s = place - k;
  for (let c = 0; c < 3; c++) out[at + c] = RAMP[k][c] * (1 - s) + RAMP[k + 1][c] * s;
  return out;
}

/** a value for each axis */
export const three = (of: (axis: number) => number): Point => [of(0), of(1), of(2)];

/** positions of every frame as 16-bit grid steps, colours as bytes */
function decode(scene: Header, bytes: Uint8Array): void {
  let at = 0;
  const frames = scene.times.length;
  for (const model of scene.models) {
    model.index = new Uint32Array(bytes.slice(at, at + 16 * model.quads).buffer);
    at += 16 * model.quads;
    const n = 3 * model.points;
    const low = bytes.subarray(at, at + n * frames), high = bytes.subarray(at + n * frames, at + 2 * n * frames);
    at += 2 * n * frames;
    model.grid = [];
    for (let f = 0; f < frames; f++) {
      const now = new Uint16Array(n), before = f ? model.grid[f - 1] : null;
      for (let i = 0; i < n; i++) now[i] = low[f * n + i] + 256 * high[f * n + i] + (before ? before[i] : 0);
      model.grid.push(now);
    }
    model.strain = [];
    for (let f = 0; model.coloured && f < frames; f++) {
      const now = new Uint8Array(model.points), before = f ? model.strain[f - 1] : null;
      for (let i = 0; i < model.points; i++) now[i] = bytes[at + f * model.points + i] + (before ? before[i] : 0);
      model.strain.push(now);
    }
    if (model.coloured) at += model.points * frames;
    model.position = new Float32Array(n);
    model.paint = new Float32Array(n);
  }
}

/** A scene that answers for any frame number with fraction. */
export class Scene implements Header {
  declare format: string;
  declare version: number;
  declare title: string;
  declare times: number[];
  declare origin: Point;
  declare size: Point;
  declare step: number;
  declare view: Header["view"];
  declare strain: number;
  declare models: Model[];
  declare explore?: Explore;
  /** of displacements, as drawn */
  scale = 1;
  readonly length: number;
  readonly last: number;
  readonly largestForce: number;
  /** an earlier scene, drawn faintly behind */
  before?: Scene;

  constructor(header: Header, bytes: Uint8Array) {
    if (header.format !== "crumple-scene" || header.version > READS) {
      throw new Error(`this page reads crumple-scene up to version ${READS}, not ${header.format} ${header.version}`);
    }
    Object.assign(this, header);
    decode(this, bytes);
    this.length = Math.hypot(...this.size) || 1;
    this.last = this.times.length - 1;
    this.largestForce = Math.max(...this.models.flatMap((m) => m.forces.flatMap((a) => a.force.map((v) => Math.hypot(...v)))), 0);
  }

  /** neighbours of a frame number and the share of the later one */
  between(frame: number): [number, number, number] {
    const f = Math.min(Math.floor(frame), this.last), g = Math.min(f + 1, this.last);
    return [f, g, frame - f];
  }

  /** the first frame at which next to all deformation has happened: that at which the viewer opens */
  telling(): number {
    const [model] = this.models.slice(-1), energies = model.hinges.flatMap((hinge) => (hinge.energy ? [hinge.energy] : []));
    const done = this.times.map((_, f) => (energies.length ? energies.reduce((sum, list) => sum + list[f], 0)
      : (model.strain[f] ?? []).reduce((sum, x) => sum + x, 0)));
    const all = done[this.last];
    return all > 0 ? done.findIndex((x) => x >= DONE * all) : this.last;
  }

  time(frame: number): number { return this.value(this.times, frame); }

  /** frame number of a time [s] */
  frameAt(time: number): number {
    const next = this.times.findIndex((t) => t >= time);
    if (next < 0) return this.last;
    if (next === 0) return 0;
    return next - 1 + (time - this.times[next - 1]) / (this.times[next] - this.times[next - 1] || 1);
  }

  value(list: ArrayLike<number>, frame: number): number {
    const [f, g, s] = this.between(frame);
    return list[f] + s * (list[g] - list[f]);
  }

  vector(list: Point[], frame: number): Point {
    const [f, g, s] = this.between(frame);
    return three((axis) => list[f][axis] + s * (list[g][axis] - list[f][axis]));
  }

  /** drawn place, about the middle of everything, of something whose places are known at every frame */
  place(list: Point[], frame: number): Point {
    const [f, g, s] = this.between(frame);
    return three((axis) => {
      const now = list[f][axis] + s * (list[g][axis] - list[f][axis]);
      return list[0][axis] + this.scale * (now - list[0][axis]) - this.origin[axis] - this.size[axis] / 2;
    });
  }

  /** shape and colours of one model; colour: strain, hinge, law or plain */
  shape(model: Model, frame: number, colour: Colour): void {
    const [f, g, s] = this.between(frame), start = model.grid[0], a = model.grid[f], b = model.grid[g];
    for (let i = 0; i < a.length; i++) {
      const now = a[i] + s * (b[i] - a[i]);
      model.position[i] = (start[i] + this.scale * (now - start[i])) * this.step - this.size[i % 3] / 2;
    }
    const byStrain = colour === "strain" && model.coloured;
    for (let i = 0; i < model.points; i++) {
      if (byStrain) ramp((model.strain[f][i] + s * (model.strain[g][i] - model.strain[f][i])) / 255, model.paint, 3 * i);
      else for (let c = 0; c < 3; c++) model.paint[3 * i + c] = WALL[c];
    }
  }

  /** undeformed points of a model, about the middle */
  ghost(model: Model): Float32Array<ArrayBuffer> { return Float32Array.from(model.grid[0], (x, i) => x * this.step - this.size[i % 3] / 2); }

  hingeColour(hinge: Hinge, frame: number, colour: Colour): Point {
    if (colour === "law") {
      const share = this.lawShare(hinge, frame);
      return share === null ? [1, 1, 1] : ramp<Point>(share, [0, 0, 0], 0);
    }
    return STATE_COLOURS[hinge.state[Math.round(frame)]];
  }

  lawShare(hinge: Hinge, frame: number): number | null {
    return hinge.law_energy && hinge.energy ? Math.max(0, this.value(hinge.energy, frame)) / hinge.law_energy : null;
  }

  /** points of an obstacle, about the middle, turned about its axis after its shift */
  obstaclePoints(obstacle: Obstacle, frame: number): Float32Array<ArrayBuffer> {
    const shift = this.vector(obstacle.shift, frame), angle = obstacle.angle ? this.value(obstacle.angle, frame) : 0;
    const c = Math.cos(angle), s = Math.sin(angle), n = obstacle.axis || [0, 0, 1], about = obstacle.about || [0, 0, 0];
    const out = new Float32Array(3 * obstacle.points.length);
    obstacle.points.forEach((point, i) => {
      const p = point.map((x, axis) => x + shift[axis] - about[axis]);
      const along = (1 - c) * (p[0] * n[0] + p[1] * n[1] + p[2] * n[2]);
      const cross = [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]];
      for (let axis = 0; axis < 3; axis++) {
        out[3 * i + axis] = c * p[axis] + s * cross[axis] + along * n[axis] + about[axis]
          - this.origin[axis] - this.size[axis] / 2;
      }
    });
    return out;
  }

  member(model: Model, point: number): string {
    let k = model.first.length - 1;
    while (k > 0 && model.first[k] > point) k--;
    return model.members[k] || "";
  }
}

export function triangles(quads: ArrayLike<number>): Uint32Array<ArrayBuffer> {
  const corners = new Uint32Array(6 * quads.length / 4);
  for (let q = 0; 4 * q < quads.length; q++) [0, 1, 2, 0, 2, 3].forEach((c, i) => { corners[6 * q + i] = quads[4 * q + c]; });
  return corners;
}
