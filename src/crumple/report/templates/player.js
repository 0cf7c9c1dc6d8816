// Plays the shapes of two results in step: orbit, zoom, scrub, colour.  WebGL by three.js; a 2D canvas without it.
"use strict";
(() => {
  const CLOSED_TO_REST = [[0.55, 0.60, 0.64], [0.85, 0.37, 0.01], [0.12, 0.37, 0.62]];  // hinge closed, turning, at rest
  const RAMP = [[0.80, 0.85, 0.90], [0.99, 0.91, 0.62], [0.97, 0.64, 0.32], [0.83, 0.24, 0.19], [0.42, 0.05, 0.20]];
  const WALL = [0.62, 0.71, 0.80];
  const CLOSE_UP = 5;  // zoom on a hinge
  const PERIOD = 5000;  // of one showing [ms]

  const root = document.getElementById("player");
  const canvas = root.querySelector("canvas");
  const slider = root.querySelector("input[type=range]");
  const play = root.querySelector("[data-role=play]");
  const clock = root.querySelector("output");
  const colour = root.querySelector("[data-role=colour]");
  const look = root.querySelector("[data-role=look]");
  const note = root.querySelector("[data-role=note]");
  const scene = JSON.parse(document.getElementById("scene-header").textContent);

  async function unpack() {
    const text = atob(document.getElementById("scene-payload").textContent.trim());
    const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  // positions of every frame as 16-bit grid steps, colours as bytes
  function decode(bytes) {
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

  function ramp(x, out, at) {
    const place = Math.min(x, 0.9999) * (RAMP.length - 1), k = Math.floor(place), s = place - k;
    for (let c = 0; c < 3; c++) out[at + c] = RAMP[k][c] * (1 - s) + RAMP[k + 1][c] * s;
  }

  // shape and colours of one model at a frame number with fraction; metres about the middle of everything
  function shape(model, frame) {
    const f = Math.min(Math.floor(frame), scene.times.length - 1), g = Math.min(f + 1, scene.times.length - 1);
    const s = frame - f, a = model.grid[f], b = model.grid[g];
    for (let i = 0; i < a.length; i++) {
      model.position[i] = (a[i] + s * (b[i] - a[i])) * scene.step - scene.size[i % 3] / 2;
    }
    const byStrain = colour.value === "strain" && model.coloured;
    for (let i = 0; i < model.points; i++) {
      if (byStrain) ramp((model.strain[f][i] + s * (model.strain[g][i] - model.strain[f][i])) / 255, model.paint, 3 * i);
      else for (let c = 0; c < 3; c++) model.paint[3 * i + c] = WALL[c];
    }
  }

  function hingeNow(hinge, frame) {
    const f = Math.min(Math.floor(frame), scene.times.length - 1), g = Math.min(f + 1, scene.times.length - 1);
    const s = frame - f;
    const place = hinge.place[f].map((x, i) => x + s * (hinge.place[g][i] - x) - scene.origin[i] - scene.size[i] / 2);
    return { place, colour: CLOSED_TO_REST[hinge.state[Math.round(frame)]] };
  }

  const showsHinges = (model) => colour.value === "hinge" || (colour.value === "strain" && !model.coloured);
  const radius = 0.012 * Math.hypot(...scene.size);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -100, 100);
  const [right, up, towards] = ["right", "up", "towards"].map((name) => new THREE.Vector3(...scene.view[name]));
  // a little from the side and above, so that depth is seen
  const eye = towards.clone().multiplyScalar(0.86).addScaledVector(right, -0.36).addScaledVector(up, 0.36).normalize();
  const size = Math.hypot(...scene.size) || 1;
  camera.up.copy(up);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;

  // half-width and half-height of what the standard view must hold
  function extent() {
    let wide = 0, tall = 0;
    const across = new THREE.Vector3().crossVectors(up, eye).normalize(), above = new THREE.Vector3().crossVectors(eye, across);
    for (const model of scene.models) for (const grid of [model.grid[0], model.grid[model.grid.length - 1]]) {
      for (let i = 0; i < grid.length; i += 3) {
        let x = 0, y = 0;
        for (let c = 0; c < 3; c++) {
          const place = grid[i + c] * scene.step - scene.size[c] / 2;
          x += place * across.getComponent(c);
          y += place * above.getComponent(c);
        }
        wide = Math.max(wide, Math.abs(x));
        tall = Math.max(tall, Math.abs(y));
      }
    }
    return [1.06 * wide || 1, 1.1 * tall || 1];
  }
  let reach = [1, 1], frame = 0;
  // the whole, or one hinge close up: its place in the last model now
  function reset() {
    const hinge = look.value && scene.models[scene.models.length - 1].hinges[Number(look.value)];
    controls.target.set(...(hinge ? hingeNow(hinge, frame).place : [0, 0, 0]));
    camera.position.copy(eye).multiplyScalar(2 * size).add(controls.target);
    camera.zoom = hinge ? CLOSE_UP : 1;
    camera.updateProjectionMatrix();
    controls.update();
  }

  function gl() {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.autoClear = false;
    renderer.outputColorSpace = "srgb-linear";  // colours are meant for the screen as they stand
    const ball = new THREE.SphereGeometry(radius, 20, 14);
    const worlds = scene.models.map((model) => {
      const world = new THREE.Scene();
      const light = new THREE.DirectionalLight(0xffffff, 2.2);
      world.add(new THREE.AmbientLight(0xffffff, 1.25), light, light.target);
      const geometry = new THREE.BufferGeometry();
      const corners = new Uint32Array(6 * model.quads);
      for (let q = 0; q < model.quads; q++) {
        [0, 1, 2, 0, 2, 3].forEach((c, i) => { corners[6 * q + i] = model.index[4 * q + c]; });
      }
      geometry.setIndex(new THREE.BufferAttribute(corners, 1));
      geometry.setAttribute("position", new THREE.BufferAttribute(model.position, 3));
      geometry.setAttribute("color", new THREE.BufferAttribute(model.paint, 3));
      const material = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, flatShading: true });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      world.add(mesh);
      const balls = model.hinges.map(() => new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.85 })));
      balls.forEach((b) => { b.renderOrder = 1; world.add(b); });
      return { world, light, geometry, balls };
    });
    return {
      mode: "webgl",
      resize(w, h) { renderer.setSize(w, h, false); },
      draw(frame, w, h) {
        renderer.setScissorTest(true);
        worlds.forEach((part, k) => {
          const model = scene.models[k];
          part.geometry.attributes.position.needsUpdate = true;
          part.geometry.attributes.color.needsUpdate = true;
          part.light.position.copy(camera.position).addScaledVector(camera.up, size);
          model.hinges.forEach((hinge, i) => {
            const now = hingeNow(hinge, frame);
            part.balls[i].visible = showsHinges(model);
            part.balls[i].position.set(...now.place);
            part.balls[i].scale.setScalar(camera.zoom ** -0.6);
            part.balls[i].material.color.setRGB(...now.colour, "srgb-linear");
          });
          const left = Math.round(k * w / worlds.length), wide = Math.round(w / worlds.length);
          renderer.setViewport(left, 0, wide, h);
          renderer.setScissor(left, 0, wide, h);
          renderer.clear();
          renderer.render(part.world, camera);
        });
      },
    };
  }

  // walls from back to front, shaded by how they face the eye
  function flat() {
    const brush = canvas.getContext("2d"), point = new THREE.Vector3();
    return {
      mode: "2d",
      resize(w, h) { canvas.width = w; canvas.height = h; },
      draw(frame, w, h) {
        brush.clearRect(0, 0, w, h);
        camera.updateMatrixWorld();
        scene.models.forEach((model, k) => {
          const wide = w / scene.models.length, screen = new Float32Array(3 * model.points);
          for (let i = 0; i < model.points; i++) {
            point.fromArray(model.position, 3 * i).project(camera);
            screen[3 * i] = (k + (point.x + 1) / 2) * wide;
            screen[3 * i + 1] = (1 - point.y) / 2 * h;
            screen[3 * i + 2] = point.z;
          }
          brush.save();
          brush.beginPath();
          brush.rect(k * wide, 0, wide, h);
          brush.clip();
          const order = Array.from({ length: model.quads }, (_, q) => q), depth = new Float32Array(model.quads);
          for (let i = 0; i < 4 * model.quads; i++) depth[i >> 2] += screen[3 * model.index[i] + 2];
          order.sort((a, b) => depth[b] - depth[a]);
          for (const q of order) {
            const c = [0, 1, 2, 3].map((i) => 3 * model.index[4 * q + i]);
            const p = c.map((i) => [0, 1, 2].map((axis) => model.position[i + axis]));
            const u = p[2].map((x, i) => x - p[0][i]), v = p[3].map((x, i) => x - p[1][i]);
            const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            const d = camera.position, facing = Math.abs(n[0] * d.x + n[1] * d.y + n[2] * d.z) / (Math.hypot(...n) * d.length() || 1);
            const tone = 0.55 + 0.5 * facing;
            brush.fillStyle = brush.strokeStyle = `rgb(${[0, 1, 2].map((i) => Math.min(255, 255 * tone * model.paint[c[0] + i]) | 0)})`;
            brush.beginPath();
            c.forEach((i, at) => (at ? brush.lineTo(screen[i], screen[i + 1]) : brush.moveTo(screen[i], screen[i + 1])));
            brush.closePath();
            brush.fill();
            brush.stroke();
          }
          if (showsHinges(model)) for (const hinge of model.hinges) {
            const now = hingeNow(hinge, frame);
            point.set(...now.place).project(camera);
            brush.fillStyle = `rgb(${now.colour.map((x) => 255 * x | 0)})`;
            brush.beginPath();
            brush.arc((k + (point.x + 1) / 2) * wide, (1 - point.y) / 2 * h, 7, 0, 7);
            brush.fill();
          }
          brush.restore();
        });
      },
    };
  }

  let painter = null, running = 0, wide = 0, tall = 0;
  function draw() {
    for (const model of scene.models) shape(model, frame);
    painter.draw(frame, wide, tall);
    const f = Math.min(Math.floor(frame), scene.times.length - 1), g = Math.min(f + 1, scene.times.length - 1);
    clock.textContent = `${(1e3 * (scene.times[f] + (frame - f) * (scene.times[g] - scene.times[f]))).toFixed(1)} ms`;
    slider.value = frame;
    root.querySelector("[data-role=strain-key]").hidden = colour.value !== "strain";
    root.querySelector("[data-role=hinge-key]").hidden = colour.value === "plain";
  }
  function fit() {
    const box = canvas.getBoundingClientRect();
    wide = Math.max(2, Math.round(box.width));
    tall = Math.max(2, Math.round(box.height));
    painter.resize(wide, tall);
    const aspect = wide / scene.models.length / tall, half = Math.max(reach[1], reach[0] / aspect);
    camera.left = -half * aspect; camera.right = half * aspect; camera.top = half; camera.bottom = -half;
    camera.updateProjectionMatrix();
    draw();
  }
  function run(start) {
    const from = frame >= scene.times.length - 1 ? 0 : frame, last = scene.times.length - 1;
    const tick = (now) => {
      if (!running) return;
      frame = Math.min(from + (now - start) / PERIOD * last, last);
      draw();
      if (frame >= last) stop(); else running = requestAnimationFrame(tick);
    };
    running = requestAnimationFrame(tick);
  }
  function stop() { cancelAnimationFrame(running); running = 0; play.textContent = "Play"; }

  unpack().then((bytes) => {
    decode(bytes);
    reach = extent();
    frame = scene.times.length - 1;
    reset();
    let webgl = false;
    try { webgl = !!document.createElement("canvas").getContext("webgl2"); } catch { webgl = false; }
    painter = webgl ? gl() : flat();
    slider.max = scene.times.length - 1;
    slider.step = "any";
    controls.addEventListener("change", draw);
    slider.addEventListener("input", () => { stop(); frame = Number(slider.value); draw(); });
    colour.addEventListener("change", draw);
    play.addEventListener("click", () => { if (running) stop(); else { play.textContent = "Pause"; run(performance.now()); } });
    scene.models[scene.models.length - 1].hinges.forEach((hinge, i) => look.add(new Option(hinge.name, i)));
    for (const [element, event] of [[look, "change"], [root.querySelector("[data-role=reset]"), "click"]]) {
      element.addEventListener(event, () => { reset(); fit(); });
    }
    new ResizeObserver(fit).observe(canvas);
    fit();
    root.dataset.ready = painter.mode;
    // for scripts: where a point is drawn now, in metres, and the way to a frame
    const place = (model, point) => [0, 1, 2].map(
      (axis) => scene.models[model].position[3 * point + axis] + scene.origin[axis] + scene.size[axis] / 2);
    window.crumplePlayer = { seek(to) { stop(); frame = to; draw(); }, place, frames: scene.times.length };
  }).catch((error) => { note.textContent = `The animation cannot be shown: ${error.message}`; note.hidden = false; });
})();
