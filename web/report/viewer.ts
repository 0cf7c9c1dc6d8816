// The viewer of every page: play, scrub, orbit, colour, pick, keep a picture or a film.
import type * as Three from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { flat } from "./flat";
import { gl } from "./gl";
import type { Options, Painter } from "./paint";
import { course, values, type Marked, type Picked } from "./picked";
import { Scene, three, unpack, type Explore, type Header, type Hinge, type Mass, type Model, type Point } from "./scene";

export interface Player {
  show(header: Header, payload: string, before?: Scene): Promise<Scene>;
  place(model: number, point: number): number[];
  seen(model: number, name: string): [number, number];
  seek(frame: number): void;
  readonly scene: Scene;
  readonly frames: number;
}
declare global {
  interface Window {
    crumplePlayer: Player;
    /** of pages with sliders: makes one model of all, and tells how to draw again */
    crumpleExplore?: (scene: Scene, explore: Explore) => (redraw: () => void) => void;
  }
}
type Project = (place: Point) => Point;
type Choices = [HTMLSelectElement, HTMLSelectElement, HTMLSelectElement, HTMLSelectElement, HTMLSelectElement];

const CLOSE_UP = 5;  // zoom on a hinge
const PERIOD = 5000;  // of one showing at speed 1 [ms]
const NEAR = 14;  // of a click to a mark [px]

const root = document.getElementById("player") as HTMLElement;
const within = <T extends Element>(selector: string) => root.querySelector(selector) as T;
const part = <T extends HTMLElement = HTMLElement>(name: string) => within<T>(`[data-role=${name}]`);
const canvas = within<HTMLCanvasElement>("canvas"), slider = within<HTMLInputElement>("input[type=range]"), clock = within<HTMLOutputElement>("output");
const [colour, look, speed, scale, facing] = ["colour", "look", "speed", "scale", "facing"].map((name) => part<HTMLSelectElement>(name)) as Choices;
const [play, note, info] = ["play", "note", "info"].map((name) => part(name)) as [HTMLElement, HTMLElement, HTMLElement];
const stored = document.getElementById("scene-header");

let scene: Scene, painter: Painter, camera: Three.OrthographicCamera, controls: OrbitControls, picked: Picked | null = null;
let frame = 0, running = 0, wide = 0, tall = 0, reach: [number, number] = [1, 1];
let right: Three.Vector3, up: Three.Vector3, eye: Three.Vector3, radius: number;

const ticked = (name: string) => !!part<HTMLInputElement | null & HTMLElement>(name)?.checked;
const options = (): Options => ({
  colour: colour.value, ghost: ticked("ghost"), forces: ticked("forces"), surroundings: ticked("surroundings"), before: ticked("before"),
});
const seconds = (t: number) => (scene.times[scene.last] > 2 ? `${t.toFixed(2)} s` : `${(1e3 * t).toFixed(1)} ms`);
const element = (name: string, attributes: Record<string, string>, parent: Element) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
};

function prepare(): void {
  camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -100 * scene.length, 100 * scene.length);
  const towards = new THREE.Vector3(...scene.view.towards);
  right = new THREE.Vector3(...scene.view.right);
  up = new THREE.Vector3(...scene.view.up);
  // a little from the side and above, so that depth is seen
  eye = towards.clone().multiplyScalar(0.86).addScaledVector(right, -0.36).addScaledVector(up, 0.36).normalize();
  camera.up.copy(up);
  controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  radius = 0.011 * scene.length;
}

/** direction of the eye of the chosen view */
function gaze(): Three.Vector3 {
  const axis = "xyz".indexOf(facing.value);
  if (facing.value === "flat") return new THREE.Vector3(...scene.view.towards);
  if (axis < 0) return eye;
  return new THREE.Vector3(axis === 0 ? 1 : 0, axis === 1 ? -1 : 0, axis === 2 ? 1 : 0);
}

/** half-width and half-height of what the view must hold */
function extent(): [number, number] {
  let w = 0, h = 0;
  const way = gaze(), upright = Math.abs(way.dot(up)) > 0.99 ? new THREE.Vector3(...scene.view.right) : up;
  const across = new THREE.Vector3().crossVectors(upright, way).normalize(), above = new THREE.Vector3().crossVectors(way, across);
  for (const model of scene.models) for (const grid of [0, 0.5, 1].map((share) => model.grid[Math.round(share * scene.last)])) {
    for (let i = 0; i < grid.length; i += 3) {
      const p = [0, 1, 2].map((c) => grid[i + c] * scene.step - scene.size[c] / 2);
      w = Math.max(w, Math.abs(p[0] * across.x + p[1] * across.y + p[2] * across.z));
      h = Math.max(h, Math.abs(p[0] * above.x + p[1] * above.y + p[2] * above.z));
    }
  }
  return [1.08 * w || 1, 1.14 * h || 1];
}

/** the whole, or one hinge close up: its place in the last model now */
function reset(): void {
  const hinge = look.value && scene.models[scene.models.length - 1].hinges[Number(look.value)];
  controls.target.set(...(hinge ? scene.place(hinge.place, frame) : [0, 0, 0] as Point));
  camera.position.copy(gaze()).multiplyScalar(2 * scene.length).add(controls.target);
  camera.zoom = hinge ? CLOSE_UP : 1;
  camera.updateProjectionMatrix();
  controls.update();
  reach = extent();
}

function draw(): void {
  for (const model of scene.models) scene.shape(model, frame, colour.value);
  if (scene.before) shapeBefore(scene.before);
  painter.draw(frame, wide, tall, options());
  clock.textContent = seconds(scene.time(frame));
  slider.value = String(frame);
  part("strain-key").hidden = colour.value !== "strain" || !scene.strain;
  part("hinge-key").hidden = colour.value !== "hinge" && !(colour.value === "strain" && scene.models.some((m) => !m.coloured));
  part("law-key").hidden = colour.value !== "law";
  if (picked) tell(picked);
  document.dispatchEvent(new CustomEvent("crumple-time", { detail: scene.time(frame) }));
}

/** shape of an earlier scene at the time that is shown, about the middle of the present one */
function shapeBefore(earlier: Scene): void {
  const at = earlier.frameAt(scene.time(frame));
  const shift = [0, 1, 2].map((c) => earlier.origin[c] + earlier.size[c] / 2 - scene.origin[c] - scene.size[c] / 2);
  earlier.scale = scene.scale;
  for (const model of earlier.models) {
    earlier.shape(model, at, "plain");
    model.position.forEach((x, i) => { model.position[i] = x + shift[i % 3]; });
  }
}

function fit(): void {
  const box = canvas.getBoundingClientRect();
  wide = Math.max(2, Math.round(box.width));
  tall = Math.max(2, Math.round(box.height));
  painter.resize(wide, tall);
  const aspect = wide / scene.models.length / tall, half = Math.max(reach[1], reach[0] / aspect);
  Object.assign(camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
  camera.updateProjectionMatrix();
  draw();
}

function run(start: number, ended?: () => void): void {
  const from = frame >= scene.last ? 0 : frame;
  const tick = (now: number) => {
    if (!running) return;
    frame = Math.min(from + Math.max(0, now - start) / PERIOD * Number(speed.value) * scene.last, scene.last);
    draw();
    if (frame >= scene.last) { stop(); if (ended) ended(); } else running = requestAnimationFrame(tick);
  };
  play.textContent = "Pause";
  running = requestAnimationFrame(tick);
}
function stop(): void { cancelAnimationFrame(running); running = 0; play.textContent = "Play"; }

/** what is drawn at a place of the canvas [px]: the nearest mark, else the nearest wall */
function pick(x: number, y: number): Picked | null {
  const k = Math.min(Math.floor(x / wide * scene.models.length), scene.models.length - 1), model = scene.models[k];
  const point = new THREE.Vector3(), part = wide / scene.models.length, choice = options();
  const project: Project = (place) => {
    point.set(...place).project(camera);
    return [(k + (point.x + 1) / 2) * part, (1 - point.y) / 2 * tall, point.z];
  };
  camera.updateMatrixWorld();
  let best: Picked | null = null, distance = NEAR;
  const surroundings = choice.surroundings ? model : { masses: [], supports: [] };
  const marks: Marked[] = [
    ...model.hinges.map((entry) => ({ kind: "hinge" as const, entry, model })),
    ...surroundings.masses.map((entry) => ({ kind: "mass" as const, entry, model })),
    ...surroundings.supports.map((entry) => ({ kind: "support" as const, entry, model })),
  ];
  for (const mark of marks) {
    const at = project(scene.place(mark.entry.place, frame)), away = Math.hypot(at[0] - x, at[1] - y);
    if (away < distance) { best = mark; distance = away; }
  }
  return best || wall(model, project, x, y) || (choice.surroundings ? ground(model, project, x, y) : null);
}

function hit(quads: ArrayLike<number>, at: Point[], x: number, y: number): number {
  let found = -1, depth = Infinity;
  for (let q = 0; 4 * q < quads.length; q++) {
    const c = [0, 1, 2, 3].map((i) => at[quads[4 * q + i]]);
    let inside = false;
    for (let i = 0, j = 3; i < 4; j = i++) {
      if ((c[i][1] > y) !== (c[j][1] > y) && x < (c[j][0] - c[i][0]) * (y - c[i][1]) / (c[j][1] - c[i][1]) + c[i][0]) inside = !inside;
    }
    const near = (c[0][2] + c[1][2] + c[2][2] + c[3][2]) / 4;
    if (inside && near < depth) { found = q; depth = near; }
  }
  return found;
}

function wall(model: Model, project: Project, x: number, y: number): Picked | null {
  const at = Array.from({ length: model.points }, (_, i) => project(three((c) => model.position[3 * i + c])));
  const q = hit(model.index, at, x, y);
  return q < 0 ? null : { kind: "member", entry: { name: scene.member(model, model.index[4 * q]) }, point: model.index[4 * q], model };
}

function ground(model: Model, project: Project, x: number, y: number): Picked | null {
  for (const entry of model.obstacles) {
    const points = scene.obstaclePoints(entry, frame);
    const at = entry.points.map((_, i) => project(three((c) => points[3 * i + c])));
    if (hit(entry.quads.flat(), at, x, y) >= 0) return { kind: "obstacle", entry, model };
  }
  return null;
}

/** the picked thing in words, and what is most told by its curve over time */
function tell(picked: Picked): void {
  info.hidden = false;
  const { list, name } = course(scene, picked);
  const words = [scene.models.length > 1 ? `${picked.model.name}: ` : "", `${picked.kind} ${picked.entry.name}`];
  words.push(...values(scene, frame, picked).map((v) => `; ${v}`), list.length ? `; over time: ${name}` : "");
  within("[data-role=info] span").textContent = words.join("");
  const picture = info.querySelector("svg") ?? element("svg", { viewBox: "0 0 160 38", "aria-hidden": "true" }, info) as SVGSVGElement;
  picture.replaceChildren();
  picture.style.display = list.length ? "" : "none";
  if (!list.length) return;
  const low = Math.min(0, ...list), high = Math.max(0, ...list), span = high - low || 1, end = scene.times[scene.last] - scene.times[0] || 1;
  const at = (t: number, y: number) => `${(2 + 156 * (t - scene.times[0]) / end).toFixed(1)},${(36 - 32 * (y - low) / span).toFixed(1)}`;
  element("polyline", { points: list.map((y, i) => at(scene.times[i], y)).join(" "), class: "curve" }, picture);
  element("polyline", { points: [at(scene.time(frame), low), at(scene.time(frame), high)].join(" "), class: "now" }, picture);
}

function save(blob: Blob, ending: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${(document.title.split(" · ")[0] || "crumple").replace(/[^\w-]+/g, "_").slice(0, 60)}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function film(): void {
  const kind = ["video/webm;codecs=vp9", "video/webm"].find((name) => MediaRecorder.isTypeSupported(name));
  const recorder = new MediaRecorder(canvas.captureStream(30), { ...(kind ? { mimeType: kind } : {}), videoBitsPerSecond: 6e6 }), chunks: Blob[] = [];
  recorder.ondataavailable = (event) => chunks.push(event.data);
  recorder.onstop = () => save(new Blob(chunks, { type: "video/webm" }), "webm");
  stop();
  frame = 0;
  recorder.start();
  // a little longer, so that the last picture is in it
  run(performance.now(), () => setTimeout(() => recorder.stop(), 300));
}

function connect(): void {
  controls.addEventListener("change", draw);
  slider.addEventListener("input", () => { stop(); frame = Number(slider.value); draw(); });
  for (const choice of [colour, ...["ghost", "forces", "surroundings", "before"].map((name) => part<HTMLElement | never>(name))]) {
    (choice as HTMLElement | null)?.addEventListener("change", draw);
  }
  scale.addEventListener("change", () => { scene.scale = Number(scale.value); draw(); });
  play.addEventListener("click", () => { if (running) stop(); else run(performance.now()); });
  for (const [control, event] of [[look, "change"], [facing, "change"], [part("reset"), "click"]] as const) {
    control.addEventListener(event, () => { reset(); fit(); });
  }
  let down = [0, 0];
  canvas.addEventListener("pointerdown", (event) => { down = [event.offsetX, event.offsetY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 4) return;
    picked = pick(event.offsetX, event.offsetY);
    info.hidden = !picked;
    if (picked) tell(picked);
  });
  part("picture").addEventListener("click", () => { draw(); canvas.toBlob((blob) => { if (blob) save(blob, "png"); }); });
  if (typeof MediaRecorder === "undefined" || !("captureStream" in canvas)) part("film").hidden = true;
  part("film").addEventListener("click", film);
  new ResizeObserver(fit).observe(canvas);
}

/** choices that depend on what the scene has */
function offer(): void {
  slider.max = String(scene.last);
  const strain = within<HTMLOptionElement>("[value=strain]");
  strain.hidden = strain.disabled = !scene.strain;
  if (!scene.strain && colour.value === "strain") colour.value = "hinge";
  part("strain-end").textContent = String(Number(scene.strain.toPrecision(2)));
  (part("forces").parentElement as HTMLElement).hidden = !scene.models.some((model) => model.forces.length);
  const names = scene.models[scene.models.length - 1].hinges.map((hinge) => hinge.name), chosen = look.selectedOptions[0]?.text;
  while (look.options.length > 1) look.remove(1);
  names.forEach((name, i) => look.add(new Option(name, String(i), false, name === chosen)));
}

function begin(header: Header, bytes: Uint8Array): void {
  scene = new Scene(header, bytes);
  const explored = header.explore && window.crumpleExplore ? window.crumpleExplore(scene, header.explore) : null;
  prepare();
  let webgl = false;
  try { webgl = !!document.createElement("canvas").getContext("webgl2"); } catch { webgl = false; }
  painter = webgl ? gl(scene, canvas, camera, radius) : flat(scene, canvas, camera);
  slider.step = "any";
  if (scene.strain) colour.value = "strain";
  offer();
  frame = scene.telling();
  connect();
  reset();
  fit();
  if (explored) explored(draw);
  root.dataset.ready = painter.mode;
}

/** another scene in place of the present one: same camera, time and choices; a faint earlier one behind it */
function replace(header: Header, bytes: Uint8Array, before?: Scene): void {
  const last = scene, ended = frame >= last.last, time = last.time(frame);
  scene = new Scene(header, bytes);
  scene.scale = last.scale;
  if (before && before.models.length === scene.models.length) scene.before = before;
  frame = ended ? scene.last : scene.frameAt(time);
  painter.replace(scene);
  offer();
  const moved = new THREE.Vector3(...three((c) => last.origin[c] + last.size[c] / 2 - scene.origin[c] - scene.size[c] / 2));
  controls.target.add(moved);
  camera.position.add(moved);
  if (picked) {
    const { kind, entry } = picked, was = picked, model = scene.models[Math.min(last.models.indexOf(was.model), scene.models.length - 1)];
    const lists = { hinge: model.hinges, mass: model.masses, support: model.supports, obstacle: model.obstacles, member: [] };
    const same = (lists[kind] as { name: string }[]).find((one) => one.name === entry.name);
    picked = same ? { ...was, entry: same, model } as Picked : null;
    info.hidden = !picked;
  }
  const ratio = scene.length / last.length;
  // a scene of another size or number of models is looked at anew
  if (last.models.length !== scene.models.length || ratio > 1.5 || ratio < 1 / 1.5) reset();
  fit();
}

/** shows a scene, with an earlier one faintly behind it; resolves when it is drawn */
async function show(header: Header, payload: string, before?: Scene): Promise<Scene> {
  const bytes = await unpack(payload);
  if (scene) replace(header, bytes, before);
  else begin(header, bytes);
  return scene;
}

// for scripts: where a point is drawn now, in metres, and the way to a frame
const world = (p: Point) => p.map((x, axis) => x + scene.origin[axis] + scene.size[axis] / 2);
const place = (model: number, point: number) => world(three((axis) => scene.models[model].position[3 * point + axis]));
const seen = (model: number, name: string): [number, number] => {
  camera.updateMatrixWorld();
  const { hinges, masses } = scene.models[model], mark = [...hinges, ...masses].find((entry) => entry.name === name) as Hinge | Mass;
  const at = new THREE.Vector3(...scene.place(mark.place, frame)).project(camera);
  return [(model + (at.x + 1) / 2) * wide / scene.models.length, (1 - at.y) / 2 * tall];
};
window.crumplePlayer = {
  show, place, seen, seek(to: number) { stop(); frame = to; draw(); },
  get scene() { return scene; }, get frames() { return scene.times.length; },
};
if (stored) {
  show(JSON.parse(stored.textContent ?? "") as Header, document.getElementById("scene-payload")?.textContent ?? "")
    .catch((error: Error) => { note.textContent = `The animation cannot be shown: ${error.message}`; note.hidden = false; });
}
