// Made from web/ by make web: change it there.
"use strict";
(() => {
  // report/paint.ts
  var VEIL = 0.06;
  var OBSTACLE = [0.78, 0.74, 0.66];
  var SUPPORT = [0.16, 0.49, 0.38];
  var MASS = [0.2, 0.22, 0.26];
  var FORCE = [0.64, 0.15, 0.18];
  var showsHinges = (model, colour2) => colour2 === "hinge" || colour2 === "law" || colour2 === "strain" && !model.coloured;
  function behind(obstacle, points, camera2) {
    if (obstacle.type !== "plane") return false;
    const [a, b, c] = [0, 1, 2].map((i) => new THREE.Vector3().fromArray(points, 3 * obstacle.quads[0][i]));
    return b.sub(a).cross(c.sub(a)).dot(camera2.getWorldDirection(new THREE.Vector3())) > 0;
  }

  // report/flat.ts
  function flat(scene2, canvas2, camera2) {
    const brush = canvas2.getContext("2d"), point = new THREE.Vector3();
    const css = (rgb, alpha = 1) => `rgba(${rgb.map((x) => Math.min(255, 255 * x) | 0)},${alpha})`;
    function projected(positions, k, w, h) {
      const wide2 = w / scene2.models.length, screen = new Float32Array(positions.length);
      for (let i = 0; i < positions.length; i += 3) {
        point.set(positions[i], positions[i + 1], positions[i + 2]).project(camera2);
        screen.set([(k + (point.x + 1) / 2) * wide2, (1 - point.y) / 2 * h, point.z], i);
      }
      return screen;
    }
    function polygons(quads, positions, screen, colour2) {
      const order = Array.from({ length: quads.length / 4 }, (_, q) => q), depth = new Float32Array(order.length);
      for (let i = 0; i < quads.length; i++) depth[i >> 2] += screen[3 * quads[i] + 2];
      order.sort((a, b) => depth[b] - depth[a]);
      for (const q of order) {
        const c = [0, 1, 2, 3].map((i) => 3 * quads[4 * q + i]), p = c.map((i) => [0, 1, 2].map((axis) => positions[i + axis]));
        const u = p[2].map((x, i) => x - p[0][i]), v = p[3].map((x, i) => x - p[1][i]);
        const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        const d = camera2.position, facing2 = Math.abs(n[0] * d.x + n[1] * d.y + n[2] * d.z) / (Math.hypot(...n) * d.length() || 1);
        brush.fillStyle = brush.strokeStyle = colour2(c[0], 0.55 + 0.5 * facing2);
        brush.beginPath();
        c.forEach((i, at) => at ? brush.lineTo(screen[i], screen[i + 1]) : brush.moveTo(screen[i], screen[i + 1]));
        brush.closePath();
        brush.fill();
        brush.stroke();
      }
    }
    function dots(entries, k, w, h, frame2, size, colour2) {
      for (const entry of entries) {
        const at = projected(scene2.place(entry.place, frame2), k, w, h);
        brush.fillStyle = css(colour2(entry), 0.9);
        brush.beginPath();
        brush.arc(at[0], at[1], size, 0, 7);
        brush.fill();
      }
    }
    function drawModel(k, frame2, w, h, options2) {
      const model = scene2.models[k];
      if (options2.surroundings) for (const o of model.obstacles) {
        const points = scene2.obstaclePoints(o, frame2);
        const alpha = behind(o, points, camera2) ? VEIL : 0.5;
        polygons(o.quads.flat(), points, projected(points, k, w, h), (_, tone) => css(OBSTACLE.map((x) => x * tone), alpha));
      }
      if (options2.ghost) {
        const points = scene2.ghost(model);
        polygons(model.index, points, projected(points, k, w, h), () => "rgba(140,152,164,0.1)");
      }
      const earlier = options2.before && scene2.before && scene2.before.models[k];
      if (earlier) polygons(earlier.index, earlier.position, projected(earlier.position, k, w, h), () => "rgba(217,95,2,0.12)");
      polygons(model.index, model.position, projected(model.position, k, w, h), (i, tone) => css([0, 1, 2].map((c) => tone * model.paint[i + c])));
      if (options2.surroundings) {
        dots(model.supports, k, w, h, frame2, 5, () => SUPPORT);
        dots(model.masses, k, w, h, frame2, 6, () => MASS);
      }
      if (showsHinges(model, options2.colour)) dots(model.hinges, k, w, h, frame2, 7, (hinge) => scene2.hingeColour(hinge, frame2, options2.colour));
      if (options2.forces) for (const entry of model.forces) {
        const force2 = scene2.vector(entry.force, frame2), size = Math.hypot(...force2) / (scene2.largestForce || 1);
        if (size <= 0.01) continue;
        const to = scene2.place(entry.place, frame2), long = scene2.length * (0.06 + 0.16 * size) / Math.hypot(...force2);
        const line = projected([...to.map((x, i) => x - long * force2[i]), ...to], k, w, h);
        const a = Math.atan2(line[4] - line[1], line[3] - line[0]), head = (turn) => brush.lineTo(line[3] - 9 * Math.cos(a + turn), line[4] - 9 * Math.sin(a + turn));
        brush.strokeStyle = brush.fillStyle = css(FORCE);
        brush.beginPath();
        brush.moveTo(line[0], line[1]);
        brush.lineTo(line[3], line[4]);
        brush.stroke();
        brush.beginPath();
        brush.moveTo(line[3], line[4]);
        head(0.4);
        head(-0.4);
        brush.fill();
      }
    }
    return {
      mode: "2d",
      replace(next) {
        scene2 = next;
      },
      resize(w, h) {
        canvas2.width = w;
        canvas2.height = h;
      },
      draw(frame2, w, h, options2) {
        brush.clearRect(0, 0, w, h);
        camera2.updateMatrixWorld();
        const wide2 = w / scene2.models.length;
        scene2.models.forEach((_, k) => {
          brush.save();
          brush.beginPath();
          brush.rect(k * wide2, 0, wide2, h);
          brush.clip();
          drawModel(k, frame2, w, h, options2);
          brush.restore();
        });
      }
    };
  }

  // report/scene.ts
  var DONE = 0.995;
  var RAMP = [[0.8, 0.85, 0.9], [0.99, 0.91, 0.62], [0.97, 0.64, 0.32], [0.83, 0.24, 0.19], [0.42, 0.05, 0.2]];
  var WALL = [0.62, 0.71, 0.8];
  var STATES = ["closed", "rotating", "at rest"];
  var STATE_COLOURS = [[0.55, 0.6, 0.64], [0.85, 0.37, 0.01], [0.12, 0.37, 0.62]];
  var READS = 1;
  async function unpack(text) {
    const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }
  function ramp(x, out, at) {
    const place2 = Math.min(Math.max(x, 0), 0.9999) * (RAMP.length - 1), k = Math.floor(place2), s = place2 - k;
    for (let c = 0; c < 3; c++) out[at + c] = RAMP[k][c] * (1 - s) + RAMP[k + 1][c] * s;
    return out;
  }
  var three = (of) => [of(0), of(1), of(2)];
  function decode(scene2, bytes) {
    let at = 0;
    const frames = scene2.times.length;
    for (const model of scene2.models) {
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
  var Scene = class {
    /** of displacements, as drawn */
    scale = 1;
    length;
    last;
    largestForce;
    /** an earlier scene, drawn faintly behind */
    before;
    constructor(header, bytes) {
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
    between(frame2) {
      const f = Math.min(Math.floor(frame2), this.last), g = Math.min(f + 1, this.last);
      return [f, g, frame2 - f];
    }
    /** the first frame at which next to all deformation has happened: that at which the viewer opens */
    telling() {
      const [model] = this.models.slice(-1), energies = model.hinges.flatMap((hinge) => hinge.energy ? [hinge.energy] : []);
      const done = this.times.map((_, f) => energies.length ? energies.reduce((sum, list) => sum + list[f], 0) : (model.strain[f] ?? []).reduce((sum, x) => sum + x, 0));
      const all = done[this.last];
      return all > 0 ? done.findIndex((x) => x >= DONE * all) : this.last;
    }
    time(frame2) {
      return this.value(this.times, frame2);
    }
    /** frame number of a time [s] */
    frameAt(time) {
      const next = this.times.findIndex((t) => t >= time);
      if (next < 0) return this.last;
      if (next === 0) return 0;
      return next - 1 + (time - this.times[next - 1]) / (this.times[next] - this.times[next - 1] || 1);
    }
    value(list, frame2) {
      const [f, g, s] = this.between(frame2);
      return list[f] + s * (list[g] - list[f]);
    }
    vector(list, frame2) {
      const [f, g, s] = this.between(frame2);
      return three((axis) => list[f][axis] + s * (list[g][axis] - list[f][axis]));
    }
    /** drawn place, about the middle of everything, of something whose places are known at every frame */
    place(list, frame2) {
      const [f, g, s] = this.between(frame2);
      return three((axis) => {
        const now = list[f][axis] + s * (list[g][axis] - list[f][axis]);
        return list[0][axis] + this.scale * (now - list[0][axis]) - this.origin[axis] - this.size[axis] / 2;
      });
    }
    /** shape and colours of one model; colour: strain, hinge, law or plain */
    shape(model, frame2, colour2) {
      const [f, g, s] = this.between(frame2), start = model.grid[0], a = model.grid[f], b = model.grid[g];
      for (let i = 0; i < a.length; i++) {
        const now = a[i] + s * (b[i] - a[i]);
        model.position[i] = (start[i] + this.scale * (now - start[i])) * this.step - this.size[i % 3] / 2;
      }
      const byStrain = colour2 === "strain" && model.coloured;
      for (let i = 0; i < model.points; i++) {
        if (byStrain) ramp((model.strain[f][i] + s * (model.strain[g][i] - model.strain[f][i])) / 255, model.paint, 3 * i);
        else for (let c = 0; c < 3; c++) model.paint[3 * i + c] = WALL[c];
      }
    }
    /** undeformed points of a model, about the middle */
    ghost(model) {
      return Float32Array.from(model.grid[0], (x, i) => x * this.step - this.size[i % 3] / 2);
    }
    hingeColour(hinge, frame2, colour2) {
      if (colour2 === "law") {
        const share = this.lawShare(hinge, frame2);
        return share === null ? [1, 1, 1] : ramp(share, [0, 0, 0], 0);
      }
      return STATE_COLOURS[hinge.state[Math.round(frame2)]];
    }
    lawShare(hinge, frame2) {
      return hinge.law_energy && hinge.energy ? Math.max(0, this.value(hinge.energy, frame2)) / hinge.law_energy : null;
    }
    /** points of an obstacle, about the middle, turned about its axis after its shift */
    obstaclePoints(obstacle, frame2) {
      const shift = this.vector(obstacle.shift, frame2), angle = obstacle.angle ? this.value(obstacle.angle, frame2) : 0;
      const c = Math.cos(angle), s = Math.sin(angle), n = obstacle.axis || [0, 0, 1], about = obstacle.about || [0, 0, 0];
      const out = new Float32Array(3 * obstacle.points.length);
      obstacle.points.forEach((point, i) => {
        const p = point.map((x, axis) => x + shift[axis] - about[axis]);
        const along = (1 - c) * (p[0] * n[0] + p[1] * n[1] + p[2] * n[2]);
        const cross = [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]];
        for (let axis = 0; axis < 3; axis++) {
          out[3 * i + axis] = c * p[axis] + s * cross[axis] + along * n[axis] + about[axis] - this.origin[axis] - this.size[axis] / 2;
        }
      });
      return out;
    }
    member(model, point) {
      let k = model.first.length - 1;
      while (k > 0 && model.first[k] > point) k--;
      return model.members[k] || "";
    }
  };
  function triangles(quads) {
    const corners = new Uint32Array(6 * quads.length / 4);
    for (let q = 0; 4 * q < quads.length; q++) [0, 1, 2, 0, 2, 3].forEach((c, i) => {
      corners[6 * q + i] = quads[4 * q + c];
    });
    return corners;
  }

  // report/gl.ts
  var LINEAR = "srgb-linear";
  function arrowGeometry() {
    const points = [], index = [], sides = 10;
    for (const [radius2, z] of [[0, 0], [0.022, 0], [0.022, 0.8], [0.06, 0.8], [0, 1]]) {
      for (let k = 0; k < sides; k++) {
        const a = 2 * Math.PI * k / sides;
        points.push(radius2 * Math.cos(a), radius2 * Math.sin(a), z);
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
  function meshOf(positions, corners, options2) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, flatShading: true, ...options2 });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
  }
  function world(scene2, model, radius2) {
    const stage = new THREE.Scene();
    const light = new THREE.DirectionalLight(16777215, 2.2);
    stage.add(new THREE.AmbientLight(16777215, 1.25), light, light.target);
    const walls = meshOf(model.position, triangles(model.index), { vertexColors: true });
    walls.geometry.setAttribute("color", new THREE.BufferAttribute(model.paint, 3));
    const ghost = meshOf(scene2.ghost(model), triangles(model.index), { color: 9214116, transparent: true, opacity: 0.22, depthWrite: false });
    stage.add(walls, ghost);
    const earlier = scene2.before && scene2.before.models[scene2.models.indexOf(model)];
    const before = earlier && meshOf(earlier.position, triangles(earlier.index), { color: 14245634, transparent: true, opacity: 0.2, depthWrite: false });
    if (before) stage.add(before);
    const tint = (rgb) => new THREE.Color().setRGB(...rgb, LINEAR);
    const ball = new THREE.SphereGeometry(radius2, 20, 14);
    const marker = (rgb, factor, options2) => {
      const mesh = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: tint(rgb), depthTest: false, transparent: true, ...options2 }));
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
      const mesh = meshOf(scene2.obstaclePoints(o, 0), triangles(quads), { color: tint(OBSTACLE), transparent: true, opacity: o.type === "plane" ? 0.4 : 0.75, depthWrite: o.type !== "plane" });
      const edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 9077362 }));
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
  function update(scene2, model, part2, frame2, camera2, options2) {
    part2.walls.geometry.attributes.position.needsUpdate = true;
    part2.walls.geometry.attributes.color.needsUpdate = true;
    part2.ghost.visible = options2.ghost;
    if (part2.before) {
      part2.before.visible = options2.before;
      part2.before.geometry.attributes.position.needsUpdate = true;
    }
    part2.light.position.copy(camera2.position).addScaledVector(camera2.up, scene2.length);
    const small = camera2.zoom ** -0.6;
    const put = (objects, entries, visible) => entries.forEach((entry, i) => {
      const { mesh, factor } = objects[i];
      mesh.visible = visible;
      mesh.position.set(...scene2.place(entry.place, frame2));
      mesh.scale.setScalar(small * factor);
    });
    put(part2.hinges, model.hinges, showsHinges(model, options2.colour));
    model.hinges.forEach((h, i) => part2.hinges[i].mesh.material.color.setRGB(...scene2.hingeColour(h, frame2, options2.colour), LINEAR));
    put(part2.masses, model.masses, options2.surroundings);
    put(part2.supports, model.supports, options2.surroundings);
    model.obstacles.forEach((obstacle, i) => {
      const { mesh, edges } = part2.grounds[i];
      mesh.visible = edges.visible = options2.surroundings;
      const points = scene2.obstaclePoints(obstacle, frame2);
      if (obstacle.type === "plane") mesh.material.opacity = behind(obstacle, points, camera2) ? VEIL : 0.4;
      mesh.geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
      edges.geometry.dispose();
      edges.geometry = new THREE.EdgesGeometry(mesh.geometry, 40);
    });
    model.forces.forEach((entry, i) => {
      const force2 = scene2.vector(entry.force, frame2), size = Math.hypot(...force2) / (scene2.largestForce || 1);
      part2.arrows[i].visible = options2.forces && size > 0.01;
      if (!part2.arrows[i].visible) return;
      const along = three((axis) => force2[axis] / Math.hypot(...force2)), long = scene2.length * (0.06 + 0.16 * size);
      const at = new THREE.Vector3(...scene2.place(entry.place, frame2)), way = new THREE.Vector3(...along);
      part2.arrows[i].position.copy(at).addScaledVector(way, -long);
      part2.arrows[i].scale.setScalar(long);
      part2.arrows[i].up.set(...Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]);
      part2.arrows[i].lookAt(at);
    });
  }
  function gl(scene2, canvas2, camera2, radius2) {
    const renderer = new THREE.WebGLRenderer({ canvas: canvas2, antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.autoClear = false;
    renderer.outputColorSpace = LINEAR;
    let parts = scene2.models.map((model) => world(scene2, model, radius2));
    return {
      mode: "webgl",
      replace(next) {
        for (const part2 of parts) part2.stage.traverse((object) => {
          const { geometry, material } = object;
          geometry?.dispose();
          material?.dispose();
        });
        scene2 = next;
        parts = scene2.models.map((model) => world(scene2, model, radius2));
      },
      resize(w, h) {
        renderer.setSize(w, h, false);
      },
      draw(frame2, w, h, options2) {
        renderer.setScissorTest(true);
        parts.forEach((part2, k) => {
          update(scene2, scene2.models[k], part2, frame2, camera2, options2);
          const left = Math.round(k * w / parts.length), wide2 = Math.round(w / parts.length);
          renderer.setViewport(left, 0, wide2, h);
          renderer.setScissor(left, 0, wide2, h);
          renderer.clear();
          renderer.render(part2.stage, camera2);
        });
      }
    };
  }

  // report/picked.ts
  var number = (x, unit) => {
    const [factor, name] = Math.abs(x) >= 1e6 ? [1e-6, "M"] : Math.abs(x) >= 1e3 ? [1e-3, "k"] : [1, ""];
    return `${Number((x * factor).toPrecision(4))} ${name}${unit}`;
  };
  var away = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  function path(scene2, model, point) {
    const place2 = (grid) => [grid[3 * point], grid[3 * point + 1], grid[3 * point + 2]];
    return model.grid.map((grid) => scene2.step * away(place2(grid), place2(model.grid[0])));
  }
  function values(scene2, frame2, thing) {
    const { kind, entry, model } = thing;
    if (kind === "hinge") {
      const share = scene2.lawShare(entry, frame2), found = [STATES[entry.state[Math.round(frame2)]]];
      found.push(`${(scene2.value(entry.rotation, frame2) * 180 / Math.PI).toFixed(2)} deg`);
      if (entry.travel) {
        const travel = scene2.value(entry.travel, frame2);
        found.push(`${(1e3 * Math.abs(travel)).toFixed(1)} mm ${travel > 0 ? "longer" : "shorter"}`);
      }
      if (entry.moment) found.push(number(scene2.value(entry.moment, frame2), "N m"));
      if (entry.energy) found.push(number(scene2.value(entry.energy, frame2), "J"));
      if (share !== null) found.push(`${(100 * share).toFixed(0)} % of the energy of its law`);
      return found;
    }
    if (kind === "mass") {
      return [`${Number(entry.mass.toPrecision(4))} kg`, `moved ${(1e3 * scene2.value(entry.place.map((p) => away(p, entry.place[0])), frame2)).toFixed(1)} mm`];
    }
    if (kind === "support") return [`holds or drives ${entry.held.join(", ")}`, ...force(scene2, frame2, model, "support", entry.name)];
    if (kind === "obstacle") {
      const shift = Math.hypot(...scene2.vector(entry.shift, frame2)), turn = entry.angle ? scene2.value(entry.angle, frame2) : 0;
      return [
        entry.type,
        `moved ${(1e3 * shift).toFixed(1)} mm`,
        ...entry.angle ? [`turned ${(turn * 180 / Math.PI).toFixed(1)} deg`] : [],
        ...force(scene2, frame2, model, "obstacle", entry.name)
      ];
    }
    const strain = model.coloured ? scene2.value(model.strain.map((row) => row[thing.point]), frame2) / 255 * scene2.strain : null;
    const moved = `moved ${(1e3 * scene2.value(path(scene2, model, thing.point), frame2)).toFixed(1)} mm`;
    return strain === null ? [moved] : [moved, `plastic strain ${strain.toPrecision(2)}`];
  }
  function force(scene2, frame2, model, on, name) {
    const found = model.forces.find((entry) => entry.on === on && entry.name === name);
    return found ? [`force ${number(Math.hypot(...scene2.vector(found.force, frame2)), "N")}`] : [];
  }
  function course(scene2, thing) {
    const { kind, entry, model } = thing, most = (list) => Math.max(...list.map(Math.abs), 0);
    const force2 = model.forces.find((one) => one.on === kind && one.name === entry.name);
    const size = force2 ? force2.force.map((row) => Math.hypot(...row)) : [];
    if (kind === "hinge") return entry.travel && most(entry.rotation) < 0.01 ? { name: "change of length", list: entry.travel } : { name: "rotation", list: entry.rotation };
    if (kind === "member") {
      const strain = model.coloured ? model.strain.map((row) => row[thing.point]) : [];
      return most(strain) > 0 ? { name: "plastic strain", list: strain } : { name: "displacement", list: path(scene2, model, thing.point) };
    }
    if (most(size) > 0) return { name: "force", list: size };
    if (kind === "support") return { name: "", list: [] };
    const places = kind === "mass" ? entry.place : entry.shift;
    return { name: "displacement", list: places.map((row) => away(row, places[0])) };
  }

  // report/viewer.ts
  var CLOSE_UP = 5;
  var PERIOD = 5e3;
  var NEAR = 14;
  var root = document.getElementById("player");
  var within = (selector) => root.querySelector(selector);
  var part = (name) => within(`[data-role=${name}]`);
  var canvas = within("canvas");
  var slider = within("input[type=range]");
  var clock = within("output");
  var [colour, look, speed, scale, facing] = ["colour", "look", "speed", "scale", "facing"].map((name) => part(name));
  var [play, note, info] = ["play", "note", "info"].map((name) => part(name));
  var stored = document.getElementById("scene-header");
  var scene;
  var painter;
  var camera;
  var controls;
  var picked = null;
  var frame = 0;
  var running = 0;
  var wide = 0;
  var tall = 0;
  var reach = [1, 1];
  var right;
  var up;
  var eye;
  var radius;
  var ticked = (name) => !!part(name)?.checked;
  var options = () => ({
    colour: colour.value,
    ghost: ticked("ghost"),
    forces: ticked("forces"),
    surroundings: ticked("surroundings"),
    before: ticked("before")
  });
  var seconds = (t) => scene.times[scene.last] > 2 ? `${t.toFixed(2)} s` : `${(1e3 * t).toFixed(1)} ms`;
  var element = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  };
  function prepare() {
    camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -100 * scene.length, 100 * scene.length);
    const towards = new THREE.Vector3(...scene.view.towards);
    right = new THREE.Vector3(...scene.view.right);
    up = new THREE.Vector3(...scene.view.up);
    eye = towards.clone().multiplyScalar(0.86).addScaledVector(right, -0.36).addScaledVector(up, 0.36).normalize();
    camera.up.copy(up);
    controls = new THREE.OrbitControls(camera, canvas);
    controls.enableDamping = false;
    radius = 0.011 * scene.length;
  }
  function gaze() {
    const axis = "xyz".indexOf(facing.value);
    if (facing.value === "flat") return new THREE.Vector3(...scene.view.towards);
    if (axis < 0) return eye;
    return new THREE.Vector3(axis === 0 ? 1 : 0, axis === 1 ? -1 : 0, axis === 2 ? 1 : 0);
  }
  function extent() {
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
  function reset() {
    const hinge = look.value && scene.models[scene.models.length - 1].hinges[Number(look.value)];
    controls.target.set(...hinge ? scene.place(hinge.place, frame) : [0, 0, 0]);
    camera.position.copy(gaze()).multiplyScalar(2 * scene.length).add(controls.target);
    camera.zoom = hinge ? CLOSE_UP : 1;
    camera.updateProjectionMatrix();
    controls.update();
    reach = extent();
  }
  function draw() {
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
  function shapeBefore(earlier) {
    const at = earlier.frameAt(scene.time(frame));
    const shift = [0, 1, 2].map((c) => earlier.origin[c] + earlier.size[c] / 2 - scene.origin[c] - scene.size[c] / 2);
    earlier.scale = scene.scale;
    for (const model of earlier.models) {
      earlier.shape(model, at, "plain");
      model.position.forEach((x, i) => {
        model.position[i] = x + shift[i % 3];
      });
    }
  }
  function fit() {
    const box = canvas.getBoundingClientRect();
    wide = Math.max(2, Math.round(box.width));
    tall = Math.max(2, Math.round(box.height));
    painter.resize(wide, tall);
    const aspect = wide / scene.models.length / tall, half = Math.max(reach[1], reach[0] / aspect);
    Object.assign(camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
    camera.updateProjectionMatrix();
    draw();
  }
  function run(start, ended) {
    const from = frame >= scene.last ? 0 : frame;
    const tick = (now) => {
      if (!running) return;
      frame = Math.min(from + Math.max(0, now - start) / PERIOD * Number(speed.value) * scene.last, scene.last);
      draw();
      if (frame >= scene.last) {
        stop();
        if (ended) ended();
      } else running = requestAnimationFrame(tick);
    };
    play.textContent = "Pause";
    running = requestAnimationFrame(tick);
  }
  function stop() {
    cancelAnimationFrame(running);
    running = 0;
    play.textContent = "Play";
  }
  function pick(x, y) {
    const k = Math.min(Math.floor(x / wide * scene.models.length), scene.models.length - 1), model = scene.models[k];
    const point = new THREE.Vector3(), part2 = wide / scene.models.length, choice = options();
    const project = (place2) => {
      point.set(...place2).project(camera);
      return [(k + (point.x + 1) / 2) * part2, (1 - point.y) / 2 * tall, point.z];
    };
    camera.updateMatrixWorld();
    let best = null, distance = NEAR;
    const surroundings = choice.surroundings ? model : { masses: [], supports: [] };
    const marks = [
      ...model.hinges.map((entry) => ({ kind: "hinge", entry, model })),
      ...surroundings.masses.map((entry) => ({ kind: "mass", entry, model })),
      ...surroundings.supports.map((entry) => ({ kind: "support", entry, model }))
    ];
    for (const mark of marks) {
      const at = project(scene.place(mark.entry.place, frame)), away2 = Math.hypot(at[0] - x, at[1] - y);
      if (away2 < distance) {
        best = mark;
        distance = away2;
      }
    }
    return best || wall(model, project, x, y) || (choice.surroundings ? ground(model, project, x, y) : null);
  }
  function hit(quads, at, x, y) {
    let found = -1, depth = Infinity;
    for (let q = 0; 4 * q < quads.length; q++) {
      const c = [0, 1, 2, 3].map((i) => at[quads[4 * q + i]]);
      let inside = false;
      for (let i = 0, j = 3; i < 4; j = i++) {
        if (c[i][1] > y !== c[j][1] > y && x < (c[j][0] - c[i][0]) * (y - c[i][1]) / (c[j][1] - c[i][1]) + c[i][0]) inside = !inside;
      }
      const near = (c[0][2] + c[1][2] + c[2][2] + c[3][2]) / 4;
      if (inside && near < depth) {
        found = q;
        depth = near;
      }
    }
    return found;
  }
  function wall(model, project, x, y) {
    const at = Array.from({ length: model.points }, (_, i) => project(three((c) => model.position[3 * i + c])));
    const q = hit(model.index, at, x, y);
    return q < 0 ? null : { kind: "member", entry: { name: scene.member(model, model.index[4 * q]) }, point: model.index[4 * q], model };
  }
  function ground(model, project, x, y) {
    for (const entry of model.obstacles) {
      const points = scene.obstaclePoints(entry, frame);
      const at = entry.points.map((_, i) => project(three((c) => points[3 * i + c])));
      if (hit(entry.quads.flat(), at, x, y) >= 0) return { kind: "obstacle", entry, model };
    }
    return null;
  }
  function tell(picked2) {
    info.hidden = false;
    const { list, name } = course(scene, picked2);
    const words = [scene.models.length > 1 ? `${picked2.model.name}: ` : "", `${picked2.kind} ${picked2.entry.name}`];
    words.push(...values(scene, frame, picked2).map((v) => `; ${v}`), list.length ? `; over time: ${name}` : "");
    within("[data-role=info] span").textContent = words.join("");
    const picture = info.querySelector("svg") ?? element("svg", { viewBox: "0 0 160 38", "aria-hidden": "true" }, info);
    picture.replaceChildren();
    picture.style.display = list.length ? "" : "none";
    if (!list.length) return;
    const low = Math.min(0, ...list), high = Math.max(0, ...list), span = high - low || 1, end = scene.times[scene.last] - scene.times[0] || 1;
    const at = (t, y) => `${(2 + 156 * (t - scene.times[0]) / end).toFixed(1)},${(36 - 32 * (y - low) / span).toFixed(1)}`;
    element("polyline", { points: list.map((y, i) => at(scene.times[i], y)).join(" "), class: "curve" }, picture);
    element("polyline", { points: [at(scene.time(frame), low), at(scene.time(frame), high)].join(" "), class: "now" }, picture);
  }
  function save(blob, ending) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${(document.title.split(" · ")[0] || "crumple").replace(/[^\w-]+/g, "_").slice(0, 60)}.${ending}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
  }
  function film() {
    const kind = ["video/webm;codecs=vp9", "video/webm"].find((name) => MediaRecorder.isTypeSupported(name));
    const recorder = new MediaRecorder(canvas.captureStream(30), { ...kind ? { mimeType: kind } : {}, videoBitsPerSecond: 6e6 }), chunks = [];
    recorder.ondataavailable = (event) => chunks.push(event.data);
    recorder.onstop = () => save(new Blob(chunks, { type: "video/webm" }), "webm");
    stop();
    frame = 0;
    recorder.start();
    run(performance.now(), () => setTimeout(() => recorder.stop(), 300));
  }
  function connect() {
    controls.addEventListener("change", draw);
    slider.addEventListener("input", () => {
      stop();
      frame = Number(slider.value);
      draw();
    });
    for (const choice of [colour, ...["ghost", "forces", "surroundings", "before"].map((name) => part(name))]) {
      choice?.addEventListener("change", draw);
    }
    scale.addEventListener("change", () => {
      scene.scale = Number(scale.value);
      draw();
    });
    play.addEventListener("click", () => {
      if (running) stop();
      else run(performance.now());
    });
    for (const [control, event] of [[look, "change"], [facing, "change"], [part("reset"), "click"]]) {
      control.addEventListener(event, () => {
        reset();
        fit();
      });
    }
    let down = [0, 0];
    canvas.addEventListener("pointerdown", (event) => {
      down = [event.offsetX, event.offsetY];
    });
    canvas.addEventListener("pointerup", (event) => {
      if (Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 4) return;
      picked = pick(event.offsetX, event.offsetY);
      info.hidden = !picked;
      if (picked) tell(picked);
    });
    part("picture").addEventListener("click", () => {
      draw();
      canvas.toBlob((blob) => {
        if (blob) save(blob, "png");
      });
    });
    if (typeof MediaRecorder === "undefined" || !("captureStream" in canvas)) part("film").hidden = true;
    part("film").addEventListener("click", film);
    new ResizeObserver(fit).observe(canvas);
  }
  function offer() {
    slider.max = String(scene.last);
    const strain = within("[value=strain]");
    strain.hidden = strain.disabled = !scene.strain;
    if (!scene.strain && colour.value === "strain") colour.value = "hinge";
    part("strain-end").textContent = String(Number(scene.strain.toPrecision(2)));
    part("forces").parentElement.hidden = !scene.models.some((model) => model.forces.length);
    const names = scene.models[scene.models.length - 1].hinges.map((hinge) => hinge.name), chosen = look.selectedOptions[0]?.text;
    while (look.options.length > 1) look.remove(1);
    names.forEach((name, i) => look.add(new Option(name, String(i), false, name === chosen)));
  }
  function begin(header, bytes) {
    scene = new Scene(header, bytes);
    const explored = header.explore && window.crumpleExplore ? window.crumpleExplore(scene, header.explore) : null;
    prepare();
    let webgl = false;
    try {
      webgl = !!document.createElement("canvas").getContext("webgl2");
    } catch {
      webgl = false;
    }
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
  function replace(header, bytes, before) {
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
      const same = lists[kind].find((one) => one.name === entry.name);
      picked = same ? { ...was, entry: same, model } : null;
      info.hidden = !picked;
    }
    const ratio = scene.length / last.length;
    if (last.models.length !== scene.models.length || ratio > 1.5 || ratio < 1 / 1.5) reset();
    fit();
  }
  async function show(header, payload, before) {
    const bytes = await unpack(payload);
    if (scene) replace(header, bytes, before);
    else begin(header, bytes);
    return scene;
  }
  var world2 = (p) => p.map((x, axis) => x + scene.origin[axis] + scene.size[axis] / 2);
  var place = (model, point) => world2(three((axis) => scene.models[model].position[3 * point + axis]));
  var seen = (model, name) => {
    camera.updateMatrixWorld();
    const { hinges, masses } = scene.models[model], mark = [...hinges, ...masses].find((entry) => entry.name === name);
    const at = new THREE.Vector3(...scene.place(mark.place, frame)).project(camera);
    return [(model + (at.x + 1) / 2) * wide / scene.models.length, (1 - at.y) / 2 * tall];
  };
  window.crumplePlayer = {
    show,
    place,
    seen,
    seek(to) {
      stop();
      frame = to;
      draw();
    },
    get scene() {
      return scene;
    },
    get frames() {
      return scene.times.length;
    }
  };
  if (stored) {
    show(JSON.parse(stored.textContent ?? ""), document.getElementById("scene-payload")?.textContent ?? "").catch((error) => {
      note.textContent = `The animation cannot be shown: ${error.message}`;
      note.hidden = false;
    });
  }
})();
