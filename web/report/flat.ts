// Draws a scene on a 2D canvas, where there is no WebGL.
import type * as Three from "three";
import { behind, FORCE, MASS, OBSTACLE, showsHinges, SUPPORT, VEIL, type Options, type Painter } from "./paint";
import type { Point, Scene } from "./scene";

/** walls and obstacles from back to front, shaded by how they face the eye */
export function flat(scene: Scene, canvas: HTMLCanvasElement, camera: Three.OrthographicCamera): Painter {
  const brush = canvas.getContext("2d") as CanvasRenderingContext2D, point = new THREE.Vector3();
  const css = (rgb: number[], alpha = 1) => `rgba(${rgb.map((x) => Math.min(255, 255 * x) | 0)},${alpha})`;
  function projected(positions: ArrayLike<number>, k: number, w: number, h: number): Float32Array {
    const wide = w / scene.models.length, screen = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      point.set(positions[i], positions[i + 1], positions[i + 2]).project(camera);
      screen.set([(k + (point.x + 1) / 2) * wide, (1 - point.y) / 2 * h, point.z], i);
    }
    return screen;
  }
  function polygons(quads: ArrayLike<number>, positions: ArrayLike<number>, screen: Float32Array, colour: (point: number, tone: number) => string): void {
    const order = Array.from({ length: quads.length / 4 }, (_, q) => q), depth = new Float32Array(order.length);
    for (let i = 0; i < quads.length; i++) depth[i >> 2] += screen[3 * quads[i] + 2];
    order.sort((a, b) => depth[b] - depth[a]);
    for (const q of order) {
      const c = [0, 1, 2, 3].map((i) => 3 * quads[4 * q + i]), p = c.map((i) => [0, 1, 2].map((axis) => positions[i + axis]));
      const u = p[2].map((x, i) => x - p[0][i]), v = p[3].map((x, i) => x - p[1][i]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const d = camera.position, facing = Math.abs(n[0] * d.x + n[1] * d.y + n[2] * d.z) / (Math.hypot(...n) * d.length() || 1);
      brush.fillStyle = brush.strokeStyle = colour(c[0], 0.55 + 0.5 * facing);
      brush.beginPath();
      c.forEach((i, at) => (at ? brush.lineTo(screen[i], screen[i + 1]) : brush.moveTo(screen[i], screen[i + 1])));
      brush.closePath();
      brush.fill();
      brush.stroke();
    }
  }
  function dots<T extends { place: Point[] }>(entries: T[], k: number, w: number, h: number, frame: number, size: number, colour: (entry: T) => number[]): void {
    for (const entry of entries) {
      const at = projected(scene.place(entry.place, frame), k, w, h);
      brush.fillStyle = css(colour(entry), 0.9);
      brush.beginPath();
      brush.arc(at[0], at[1], size, 0, 7);
      brush.fill();
    }
  }
  function drawModel(k: number, frame: number, w: number, h: number, options: Options): void {
    const model = scene.models[k];
    if (options.surroundings) for (const o of model.obstacles) {
      const points = scene.obstaclePoints(o, frame);
      const alpha = behind(o, points, camera) ? VEIL : 0.5;
      polygons(o.quads.flat(), points, projected(points, k, w, h), (_, tone) => css(OBSTACLE.map((x) => x * tone), alpha));
    }
    if (options.ghost) {
      const points = scene.ghost(model);
      polygons(model.index, points, projected(points, k, w, h), () => "rgba(140,152,164,0.1)");
    }
    const earlier = options.before && scene.before && scene.before.models[k];
    if (earlier) polygons(earlier.index, earlier.position, projected(earlier.position, k, w, h), () => "rgba(217,95,2,0.12)");
    polygons(model.index, model.position, projected(model.position, k, w, h), (i, tone) => css([0, 1, 2].map((c) => tone * model.paint[i + c])));
    if (options.surroundings) {
      dots(model.supports, k, w, h, frame, 5, () => SUPPORT);
      dots(model.masses, k, w, h, frame, 6, () => MASS);
    }
    if (showsHinges(model, options.colour)) dots(model.hinges, k, w, h, frame, 7, (hinge) => scene.hingeColour(hinge, frame, options.colour));
    if (options.forces) for (const entry of model.forces) {
      const force = scene.vector(entry.force, frame), size = Math.hypot(...force) / (scene.largestForce || 1);
      if (size <= 0.01) continue;
      const to = scene.place(entry.place, frame), long = scene.length * (0.06 + 0.16 * size) / Math.hypot(...force);
      const line = projected([...to.map((x, i) => x - long * force[i]), ...to], k, w, h);
      const a = Math.atan2(line[4] - line[1], line[3] - line[0]), head = (turn: number) => brush.lineTo(line[3] - 9 * Math.cos(a + turn), line[4] - 9 * Math.sin(a + turn));
      brush.strokeStyle = brush.fillStyle = css(FORCE);
      brush.beginPath(); brush.moveTo(line[0], line[1]); brush.lineTo(line[3], line[4]); brush.stroke();
      brush.beginPath(); brush.moveTo(line[3], line[4]); head(0.4); head(-0.4); brush.fill();
    }
  }
  return {
    mode: "2d",
    replace(next) { scene = next; },
    resize(w, h) { canvas.width = w; canvas.height = h; },
    draw(frame, w, h, options) {
      brush.clearRect(0, 0, w, h);
      camera.updateMatrixWorld();
      const wide = w / scene.models.length;
      scene.models.forEach((_, k) => {
        brush.save();
        brush.beginPath();
        brush.rect(k * wide, 0, wide, h);
        brush.clip();
        drawModel(k, frame, w, h, options);
        brush.restore();
      });
    },
  };
}
