// Two ways to draw a scene: WebGL by three.js, and a 2D canvas where there is none.
"use strict";
const CrumplePainters = (() => {
  const OBSTACLE = [0.78, 0.74, 0.66], SUPPORT = [0.16, 0.49, 0.38], MASS = [0.20, 0.22, 0.26], FORCE = [0.64, 0.15, 0.18];
  const shows = (model, colour) => colour === "hinge" || colour === "law" || (colour === "strain" && !model.coloured);

  /** an arrow of length 1 along z, flat-shaded: shaft and head */
  function arrowGeometry() {
    const points = [], index = [], sides = 10;
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

  function meshOf(positions, corners, options) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, flatShading: true, ...options });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
  }

  /** everything of one model as objects of three.js */
  function world(scene, model, radius) {
    const stage = new THREE.Scene(), triangles = CrumpleScene.triangles;
    const light = new THREE.DirectionalLight(0xffffff, 2.2);
    stage.add(new THREE.AmbientLight(0xffffff, 1.25), light, light.target);
    const walls = meshOf(model.position, triangles(model.index), { vertexColors: true });
    walls.geometry.setAttribute("color", new THREE.BufferAttribute(model.paint, 3));
    const ghost = meshOf(scene.ghost(model), triangles(model.index), { color: 0x8c98a4, transparent: true, opacity: 0.22, depthWrite: false });
    stage.add(walls, ghost);
    const tint = (rgb) => new THREE.Color().setRGB(...rgb, "srgb-linear");
    const ball = new THREE.SphereGeometry(radius, 20, 14);
    const marker = (rgb, factor, options) => {
      const mesh = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: tint(rgb), depthTest: false, transparent: true, ...options }));
      mesh.renderOrder = 2;
      mesh.factor = factor;
      stage.add(mesh);
      return mesh;
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
    return { stage, light, walls, ghost, hinges, masses, supports, grounds, arrows };
  }

  function update(scene, model, part, frame, camera, options) {
    part.walls.geometry.attributes.position.needsUpdate = true;
    part.walls.geometry.attributes.color.needsUpdate = true;
    part.ghost.visible = options.ghost;
    part.light.position.copy(camera.position).addScaledVector(camera.up, scene.length);
    const small = camera.zoom ** -0.6;
    const put = (objects, entries, visible) => entries.forEach((entry, i) => {
      objects[i].visible = visible;
      objects[i].position.set(...scene.place(entry.place, frame));
      objects[i].scale.setScalar(small * objects[i].factor);
    });
    put(part.hinges, model.hinges, shows(model, options.colour));
    model.hinges.forEach((h, i) => part.hinges[i].material.color.setRGB(...scene.hingeColour(h, frame, options.colour), "srgb-linear"));
    put(part.masses, model.masses, options.surroundings);
    put(part.supports, model.supports, options.surroundings);
    model.obstacles.forEach((obstacle, i) => {
      const { mesh, edges } = part.grounds[i];
      mesh.visible = edges.visible = options.surroundings;
      mesh.geometry.setAttribute("position", new THREE.BufferAttribute(scene.obstaclePoints(obstacle, frame), 3));
      edges.geometry.dispose();
      edges.geometry = new THREE.EdgesGeometry(mesh.geometry, 40);
    });
    model.forces.forEach((entry, i) => {
      const force = scene.vector(entry.force, frame), size = Math.hypot(...force) / (scene.largestForce || 1);
      part.arrows[i].visible = options.forces && size > 0.01;
      if (!part.arrows[i].visible) return;
      const along = force.map((x) => x / Math.hypot(...force)), long = scene.length * (0.06 + 0.16 * size);
      const at = new THREE.Vector3(...scene.place(entry.place, frame)), way = new THREE.Vector3(...along);
      part.arrows[i].position.copy(at).addScaledVector(way, -long);
      part.arrows[i].scale.setScalar(long);
      part.arrows[i].up.set(...(Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
      part.arrows[i].lookAt(at);
    });
  }

  function gl(scene, canvas, camera, radius) {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.autoClear = false;
    renderer.outputColorSpace = "srgb-linear";  // colours are meant for the screen as they stand
    const parts = scene.models.map((model) => world(scene, model, radius));
    return {
      mode: "webgl",
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

  // walls and obstacles from back to front, shaded by how they face the eye
  function flat(scene, canvas, camera) {
    const brush = canvas.getContext("2d"), point = new THREE.Vector3();
    const css = (rgb, alpha = 1) => `rgba(${rgb.map((x) => Math.min(255, 255 * x) | 0)},${alpha})`;
    function projected(positions, k, w, h) {
      const wide = w / scene.models.length, screen = new Float32Array(positions.length);
      for (let i = 0; i < positions.length; i += 3) {
        point.fromArray(positions, i).project(camera);
        screen.set([(k + (point.x + 1) / 2) * wide, (1 - point.y) / 2 * h, point.z], i);
      }
      return screen;
    }
    function polygons(quads, positions, screen, colour) {
      const order = Array.from({ length: quads.length / 4 }, (_, q) => q), depth = new Float32Array(order.length);
      quads.forEach((p, i) => { depth[i >> 2] += screen[3 * p + 2]; });
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
    function dots(entries, k, w, h, frame, size, colour) {
      for (const entry of entries) {
        const at = projected(scene.place(entry.place, frame), k, w, h);
        brush.fillStyle = css(colour(entry), 0.9);
        brush.beginPath();
        brush.arc(at[0], at[1], size, 0, 7);
        brush.fill();
      }
    }
    function model(k, frame, w, h, options) {
      const model = scene.models[k];
      if (options.surroundings) for (const o of model.obstacles) {
        const points = scene.obstaclePoints(o, frame);
        polygons(o.quads.flat(), points, projected(points, k, w, h), (_, tone) => css(OBSTACLE.map((x) => x * tone), 0.5));
      }
      if (options.ghost) {
        const points = scene.ghost(model);
        polygons(model.index, points, projected(points, k, w, h), () => "rgba(140,152,164,0.1)");
      }
      polygons(model.index, model.position, projected(model.position, k, w, h), (i, tone) => css([0, 1, 2].map((c) => tone * model.paint[i + c])));
      if (options.surroundings) {
        dots(model.supports, k, w, h, frame, 5, () => SUPPORT);
        dots(model.masses, k, w, h, frame, 6, () => MASS);
      }
      if (shows(model, options.colour)) dots(model.hinges, k, w, h, frame, 7, (hinge) => scene.hingeColour(hinge, frame, options.colour));
      if (options.forces) for (const entry of model.forces) {
        const force = scene.vector(entry.force, frame), size = Math.hypot(...force) / (scene.largestForce || 1);
        if (size <= 0.01) continue;
        const to = scene.place(entry.place, frame), long = scene.length * (0.06 + 0.16 * size) / Math.hypot(...force);
        const line = projected([...to.map((x, i) => x - long * force[i]), ...to], k, w, h);
        const a = Math.atan2(line[4] - line[1], line[3] - line[0]), head = (turn) => brush.lineTo(line[3] - 9 * Math.cos(a + turn), line[4] - 9 * Math.sin(a + turn));
        brush.strokeStyle = brush.fillStyle = css(FORCE);
        brush.beginPath(); brush.moveTo(line[0], line[1]); brush.lineTo(line[3], line[4]); brush.stroke();
        brush.beginPath(); brush.moveTo(line[3], line[4]); head(0.4); head(-0.4); brush.fill();
      }
    }
    return {
      mode: "2d",
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
          model(k, frame, w, h, options);
          brush.restore();
        });
      },
    };
  }
  return { gl, flat };
})();
