// What the ways to draw a scene share.
import type * as Three from "three";
import type { Colour, Model, Obstacle, Point, Scene } from "./scene";

declare global { const THREE: typeof Three & { OrbitControls: typeof import("three/addons/controls/OrbitControls.js").OrbitControls } }

/** What is shown. */
export interface Options { colour: Colour; ghost: boolean; forces: boolean; surroundings: boolean; before: boolean }
export interface Painter {
  mode: string;
  /** draw another scene from now on */
  replace(next: Scene): void;
  resize(w: number, h: number): void;
  draw(frame: number, w: number, h: number, options: Options): void;
}

/** opacity of a plane seen from its solid side */
export const VEIL = 0.06;
export const OBSTACLE: Point = [0.78, 0.74, 0.66], SUPPORT: Point = [0.16, 0.49, 0.38], MASS: Point = [0.20, 0.22, 0.26], FORCE: Point = [0.64, 0.15, 0.18];
export const showsHinges = (model: Model, colour: Colour): boolean =>
  colour === "hinge" || colour === "law" || (colour === "strain" && !model.coloured);

/** whether the eye is on the solid side of a plane, so that it would hide what it stops: its quad turns about its normal */
export function behind(obstacle: Obstacle, points: Float32Array, camera: Three.Camera): boolean {
  if (obstacle.type !== "plane") return false;
  const [a, b, c] = [0, 1, 2].map((i) => new THREE.Vector3().fromArray(points, 3 * obstacle.quads[0][i])) as [Three.Vector3, Three.Vector3, Three.Vector3];
  return b.sub(a).cross(c.sub(a)).dot(camera.getWorldDirection(new THREE.Vector3())) > 0;
}
