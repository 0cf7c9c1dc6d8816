// Draws a scene by WebGL, with three.js.
import type * as Three from "three";
import { behind, FORCE, MASS, OBSTACLE, showsHinges, SUPPORT, VEIL, type Options, type Painter } from "./paint";
import { three, triangles, type Model, type Point, type Scene } from "./scene";

const LINEAR = "srgb-linear";  // colours are meant for the screen as they stand

/** an arrow of length 1 along z, flat-shaded: shaft and head */
function arrowGeometry(): Three.BufferGeometry {
  const points: number[] = [], index: number[] = [], sides = 10;
  for (const [radius, z] of [[0, 0], [0.022, 0], [0.022, 0.8], [0.06, 0.8], [0, 1]]) {
    for (let k = 0; k < sides; k++) {
      const a = 2 * Math.PI * k / sides;
      points.push(radius * Math.cos(a), radius * Math.sin(a), z);
    }
  }
  for (let r = 0; r < 4; r++) for (let k = 0; k < sides; k++) {
    const a = r * sides + k, b = r * sides + (k + 1) % sides;
    index.push(a, b, b + sides, a, b + sides, a + sides);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  geometry.setIndex(index);
  return geometry;
}

type Lambert = Three.Mesh<Three.BufferGeometry, Three.MeshLambertMaterial>;
type Marker = Three.Mesh<Three.SphereGeometry, Three.MeshBasicMaterial>;

function meshOf(positions: Float32Array<ArrayBufferLike>, corners: Uint32Array, options: Three.MeshLambertMaterialParameters): Lambert {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, flatShading: true, ...options });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

/** everything of one model as objects of three.js */
function world(scene: Scene, model: Model, radius: number) {
  const stage = new THREE.Scene();
  const light = new THREE.DirectionalLight(0xffffff, 2.2);
  stage.add(new THREE.AmbientLight(0xffffff, 1.25), light, light.target);
  const walls = meshOf(model.position, triangles(model.index), { vertexColors: true });
  walls.geometry.setAttribute("color", new THREE.BufferAttribute(model.paint, 3));
  const ghost = meshOf(scene.ghost(model), triangles(model.index), { color: 0x8c98a4, transparent: true, opacity: 0.22, depthWrite: false });
  stage.add(walls, ghost);
  const earlier = scene.before && scene.before.models[scene.models.indexOf(model)];
  const before = earlier && meshOf(earlier.position, triangles(earlier.index), { color: 0xd95f02, transparent: true, opacity: 0.2, depthWrite: false });
  if (before) stage.add(before);
  const tint = (rgb: Point) => new THREE.Color().setRGB(...rgb, LINEAR);
  const ball = new THREE.SphereGeometry(radius, 20, 14);
  const marker = (rgb: Point, factor: number, options: Three.MeshBasicMaterialParameters) => {
    const mesh: Marker = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: tint(rgb), depthTest: false, transparent: true, ...options }));
    mesh.renderOrder = 2;
    stage.add(mesh);
    return { mesh, factor };
  };
  const hinges = model.hinges.map(() => marker([1, 1, 1], 1, { opacity: 0.88 }));
  const heaviest = Math.max(...model.masses.map((m) => m.mass), 1e-9);
  const masses = model.masses.map((m) => marker(MASS, 0.6 + 1.1 * Math.cbrt(m.mass / heaviest), { opacity: 0.6 }));
  const supports = model.supports.map(() => marker(SUPPORT, 0.7, { opacity: 0.8 }));
  const grounds = model.obstacles.map((o) => {
    const quads = Uint32Array.from(o.quads.flat());
    const mesh = meshOf(scene.obstaclePoints(o, 0), triangles(quads), { color: tint(OBSTACLE), transparent: true, opacity: o.type === "plane" ? 0.4 : 0.75, depthWrite: o.type !== "plane" });
    const edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x8a8272 }));
    edges.frustumCulled = false;
    mesh.renderOrder = -1;
    stage.add(mesh, edges);
    return { mesh, edges };
  });
  const arrow = arrowGeometry();
  const arrows = model.forces.map(() => {
    const mesh = new THREE.Mesh(arrow, new THREE.MeshLambertMaterial({ color: tint(FORCE), flatShading: true, side: THREE.DoubleSide, depthTest: false, transparent: true }));
    mesh.renderOrder = 1;
    stage.add(mesh);
    return mesh;
  });
  return { stage, light, walls, ghost, before, hinges, masses, supports, grounds, arrows };
}

function update(scene: Scene, model: Model, part: ReturnType<typeof world>, frame: number, camera: Three.OrthographicCamera, options: Options): void {
  part.walls.geometry.attributes.position.needsUpdate = true;
  part.walls.geometry.attributes.color.needsUpdate = true;
  part.ghost.visible = options.ghost;
  if (part.before) {
    part.before.visible = options.before;
    part.before.geometry.attributes.position.needsUpdate = true;
  }
  part.light.position.copy(camera.position).addScaledVector(camera.up, scene.length);
  const small = camera.zoom ** -0.6;
  const put = (objects: { mesh: Marker; factor: number }[], entries: { place: Point[] }[], visible: boolean) => entries.forEach((entry, i) => {
    const { mesh, factor } = objects[i];
    mesh.visible = visible;
    mesh.position.set(...scene.place(entry.place, frame));
    mesh.scale.setScalar(small * factor);
  });
  put(part.hinges, model.hinges, showsHinges(model, options.colour));
  model.hinges.forEach((h, i) => part.hinges[i].mesh.material.color.setRGB(...scene.hingeColour(h, frame, options.colour), LINEAR));
  put(part.masses, model.masses, options.surroundings);
  put(part.supports, model.supports, options.surroundings);
  model.obstacles.forEach((obstacle, i) => {
    const { mesh, edges } = part.grounds[i];
    mesh.visible = edges.visible = options.surroundings;
    const points = scene.obstaclePoints(obstacle, frame);
    if (obstacle.type === "plane") mesh.material.opacity = behind(obstacle, points, camera) ? VEIL : 0.4;
    mesh.geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    edges.geometry.dispose();
    edges.geometry = new THREE.EdgesGeometry(mesh.geometry, 40);
  });
  model.forces.forEach((entry, i) => {
    const force = scene.vector(entry.force, frame), size = Math.hypot(...force) / (scene.largestForce || 1);
    part.arrows[i].visible = options.forces && size > 0.01;
    if (!part.arrows[i].visible) return;
    const along = three((axis) => force[axis] / Math.hypot(...force)), long = scene.length * (0.06 + 0.16 * size);
    const at = new THREE.Vector3(...scene.place(entry.place, frame)), way = new THREE.Vector3(...along);
    part.arrows[i].position.copy(at).addScaledVector(way, -long);
    part.arrows[i].scale.setScalar(long);
    part.arrows[i].up.set(...(Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]) as Point);
    part.arrows[i].lookAt(at);
  });
}

/** by three.js */
export function gl(scene: Scene, canvas: HTMLCanvasElement, camera: Three.OrthographicCamera, radius: number): Painter {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
  renderer.autoClear = false;
  renderer.outputColorSpace = LINEAR;
  let parts = scene.models.map((model) => world(scene, model, radius));
  return {
    mode: "webgl",
    replace(next) {
      for (const part of parts) part.stage.traverse((object) => { const { geometry, material } = object as Partial<Lambert>; geometry?.dispose(); material?.dispose(); });
      scene = next;
      parts = scene.models.map((model) => world(scene, model, radius));
    },
    resize(w, h) { renderer.setSize(w, h, false); },
    draw(frame, w, h, options) {
      renderer.setScissorTest(true);
      parts.forEach((part, k) => {
        update(scene, scene.models[k], part, frame, camera, options);
        const left = Math.round(k * w / parts.length), wide = Math.round(w / parts.length);
        renderer.setViewport(left, 0, wide, h);
        renderer.setScissor(left, 0, wide, h);
        renderer.clear();
        renderer.render(part.stage, camera);
      });
    },
  };
}
