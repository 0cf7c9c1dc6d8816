// What was picked: its values at a time, and its curve.
import { STATES, type Hinge, type Mass, type Model, type Obstacle, type Point, type Scene, type Support } from "./scene";

export type Marked = { kind: "hinge"; entry: Hinge; model: Model } | { kind: "mass"; entry: Mass; model: Model } | { kind: "support"; entry: Support; model: Model };
export type Picked = Marked | { kind: "obstacle"; entry: Obstacle; model: Model } | { kind: "member"; entry: { name: string }; model: Model; point: number };

/** how a curve over time is called, and its values at the frames; none without one */
export interface Course { name: string; list: number[] }

const number = (x: number, unit: string) => {
  const [factor, name] = Math.abs(x) >= 1e6 ? [1e-6, "M"] as const : Math.abs(x) >= 1e3 ? [1e-3, "k"] as const : [1, ""] as const;
  return `${Number((x * factor).toPrecision(4))} ${name}${unit}`;
};

const away = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** displacement of a point of the walls at the frames [m] */
function path(scene: Scene, model: Model, point: number): number[] {
  const place = (grid: ArrayLike<number>): Point => [grid[3 * point], grid[3 * point + 1], grid[3 * point + 2]];
  return model.grid.map((grid) => scene.step * away(place(grid), place(model.grid[0])));
}

/** values of what was picked, at the time that is shown */
export function values(scene: Scene, frame: number, thing: Picked): string[] {
  const { kind, entry, model } = thing;
  if (kind === "hinge") {
    const share = scene.lawShare(entry, frame), found = [STATES[entry.state[Math.round(frame)]]];
    found.push(`${(scene.value(entry.rotation, frame) * 180 / Math.PI).toFixed(2)} deg`);
    if (entry.travel) {
      const travel = scene.value(entry.travel, frame);
      found.push(`${(1e3 * Math.abs(travel)).toFixed(1)} mm ${travel > 0 ? "longer" : "shorter"}`);
    }
    if (entry.moment) found.push(number(scene.value(entry.moment, frame), "N m"));
    if (entry.energy) found.push(number(scene.value(entry.energy, frame), "J"));
    if (share !== null) found.push(`${(100 * share).toFixed(0)} % of the energy of its law`);
    return found;
  }
  if (kind === "mass") {
    return [`${Number(entry.mass.toPrecision(4))} kg`, `moved ${(1e3 * scene.value(entry.place.map((p) => away(p, entry.place[0])), frame)).toFixed(1)} mm`];
  }
  if (kind === "support") return [`holds or drives ${entry.held.join(", ")}`, ...force(scene, frame, model, "support", entry.name)];
  if (kind === "obstacle") {
    const shift = Math.hypot(...scene.vector(entry.shift, frame)), turn = entry.angle ? scene.value(entry.angle, frame) : 0;
    return [entry.type, `moved ${(1e3 * shift).toFixed(1)} mm`, ...(entry.angle ? [`turned ${(turn * 180 / Math.PI).toFixed(1)} deg`] : []),
      ...force(scene, frame, model, "obstacle", entry.name)];
  }
  const strain = model.coloured ? scene.value(model.strain.map((row) => row[thing.point]), frame) / 255 * scene.strain : null;
  const moved = `moved ${(1e3 * scene.value(path(scene, model, thing.point), frame)).toFixed(1)} mm`;
  return strain === null ? [moved] : [moved, `plastic strain ${strain.toPrecision(2)}`];
}
function force(scene: Scene, frame: number, model: Model, on: string, name: string): string[] {
  const found = model.forces.find((entry) => entry.on === on && entry.name === name);
  return found ? [`force ${number(Math.hypot(...scene.vector(found.force, frame)), "N")}`] : [];
}

/** the curve of what was picked that tells most */
export function course(scene: Scene, thing: Picked): Course {
  const { kind, entry, model } = thing, most = (list: number[]) => Math.max(...list.map(Math.abs), 0);
  const force = model.forces.find((one) => one.on === kind && one.name === entry.name);
  const size = force ? force.force.map((row) => Math.hypot(...row)) : [];
  if (kind === "hinge") return entry.travel && most(entry.rotation) < 0.01 ? { name: "change of length", list: entry.travel } : { name: "rotation", list: entry.rotation };
  if (kind === "member") {
    const strain = model.coloured ? model.strain.map((row) => row[thing.point]) : [];
    return most(strain) > 0 ? { name: "plastic strain", list: strain } : { name: "displacement", list: path(scene, model, thing.point) };
  }
  if (most(size) > 0) return { name: "force", list: size };
  if (kind === "support") return { name: "", list: [] };
  const places = kind === "mass" ? entry.place : entry.shift;
  return { name: "displacement", list: places.map((row) => away(row, places[0])) };
}
