// The viewer of every page: play, scrub, orbit, colour, pick, keep a picture or a film.
"use strict";
(() => {
  const CLOSE_UP = 5;  // zoom on a hinge
  const PERIOD = 5000;  // of one showing at speed 1 [ms]
  const NEAR = 14;  // of a click to a mark [px]

  const root = document.getElementById("player");
  const part = (name) => root.querySelector(`[data-role=${name}]`);
  const canvas = root.querySelector("canvas"), slider = root.querySelector("input[type=range]"), clock = root.querySelector("output");
  const [play, colour, look, note, speed, scale, facing, info] = ["play", "colour", "look", "note", "speed", "scale", "facing", "info"].map(part);
  const header = JSON.parse(document.getElementById("scene-header").textContent);

  let scene, painter, camera, controls, frame = 0, running = 0, wide = 0, tall = 0, reach = [1, 1], picked = null;
  let right, up, eye, radius;

  const options = () => ({
    colour: colour.value, ghost: part("ghost").checked, forces: part("forces").checked, surroundings: part("surroundings").checked,
  });
  const seconds = (t) => (scene.times[scene.last] > 2 ? `${t.toFixed(2)} s` : `${(1e3 * t).toFixed(1)} ms`);
  const number = (x, unit) => {
    const [factor, name] = Math.abs(x) >= 1e6 ? [1e-6, "M"] : Math.abs(x) >= 1e3 ? [1e-3, "k"] : [1, ""];
    return `${Number((x * factor).toPrecision(4))} ${name}${unit}`;
  };
  const element = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  };

  function prepare() {
    camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -100 * scene.length, 100 * scene.length);
    let towards;
    [right, up, towards] = ["right", "up", "towards"].map((name) => new THREE.Vector3(...scene.view[name]));
    // a little from the side and above, so that depth is seen
    eye = towards.clone().multiplyScalar(0.86).addScaledVector(right, -0.36).addScaledVector(up, 0.36).normalize();
    camera.up.copy(up);
    controls = new THREE.OrbitControls(camera, canvas);
    controls.enableDamping = false;
    radius = 0.011 * scene.length;
  }

  /** direction of the eye of the chosen view */
  function gaze() {
    const axis = "xyz".indexOf(facing.value);
    if (facing.value === "flat") return new THREE.Vector3(...scene.view.towards);
    if (axis < 0) return eye;
    return new THREE.Vector3(axis === 0 ? 1 : 0, axis === 1 ? -1 : 0, axis === 2 ? 1 : 0);
  }

  /** half-width and half-height of what the view must hold */
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

  /** the whole, or one hinge close up: its place in the last model now */
  function reset() {
    const hinge = look.value && scene.models[scene.models.length - 1].hinges[Number(look.value)];
    controls.target.set(...(hinge ? scene.place(hinge.place, frame) : [0, 0, 0]));
    camera.position.copy(gaze()).multiplyScalar(2 * scene.length).add(controls.target);
    camera.zoom = hinge ? CLOSE_UP : 1;
    camera.updateProjectionMatrix();
    controls.update();
    reach = extent();
  }

  function draw() {
    for (const model of scene.models) scene.shape(model, frame, colour.value);
    painter.draw(frame, wide, tall, options());
    clock.textContent = seconds(scene.time(frame));
    slider.value = frame;
    part("strain-key").hidden = colour.value !== "strain" || !scene.strain;
    part("hinge-key").hidden = colour.value !== "hinge" && !(colour.value === "strain" && scene.models.some((m) => !m.coloured));
    part("law-key").hidden = colour.value !== "law";
    if (picked) tell();
    document.dispatchEvent(new CustomEvent("crumple-time", { detail: scene.time(frame) }));
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
      if (frame >= scene.last) { stop(); if (ended) ended(); } else running = requestAnimationFrame(tick);
    };
    play.textContent = "Pause";
    running = requestAnimationFrame(tick);
  }
  function stop() { cancelAnimationFrame(running); running = 0; play.textContent = "Play"; }

  /** what is drawn at a place of the canvas [px]: the nearest mark, else the nearest wall */
  function pick(x, y) {
    const k = Math.min(Math.floor(x / wide * scene.models.length), scene.models.length - 1), model = scene.models[k];
    const point = new THREE.Vector3(), part = wide / scene.models.length, choice = options();
    const project = (place) => {
      point.set(...place).project(camera);
      return [(k + (point.x + 1) / 2) * part, (1 - point.y) / 2 * tall, point.z];
    };
    camera.updateMatrixWorld();
    let best = null, distance = NEAR;
    const kinds = [["hinge", model.hinges], ...(choice.surroundings ? [["mass", model.masses], ["support", model.supports]] : [])];
    for (const [kind, entries] of kinds) for (const entry of entries) {
      const at = project(scene.place(entry.place, frame)), away = Math.hypot(at[0] - x, at[1] - y);
      if (away < distance) { best = { kind, entry, model }; distance = away; }
    }
    return best || wall(model, project, x, y) || (choice.surroundings ? ground(model, project, x, y) : null);
  }

  function hit(quads, at, x, y) {
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

  function wall(model, project, x, y) {
    const at = Array.from({ length: model.points }, (_, i) => project([0, 1, 2].map((c) => model.position[3 * i + c])));
    const q = hit(model.index, at, x, y);
    return q < 0 ? null : { kind: "member", entry: { name: scene.member(model, model.index[4 * q]) }, point: model.index[4 * q], model };
  }

  function ground(model, project, x, y) {
    for (const entry of model.obstacles) {
      const points = scene.obstaclePoints(entry, frame);
      const at = entry.points.map((_, i) => project([...points.subarray(3 * i, 3 * i + 3)]));
      if (hit(entry.quads.flat(), at, x, y) >= 0) return { kind: "obstacle", entry, model };
    }
    return null;
  }

  /** values of what was picked, at the time that is shown */
  function values({ kind, entry, model, point }) {
    if (kind === "hinge") {
      const share = scene.lawShare(entry, frame), found = [CrumpleScene.STATES[entry.state[Math.round(frame)]]];
      found.push(`${(scene.value(entry.rotation, frame) * 180 / Math.PI).toFixed(2)} deg`);
      if (entry.moment) found.push(number(scene.value(entry.moment, frame), "N m"));
      if (entry.energy) found.push(number(scene.value(entry.energy, frame), "J"));
      if (share !== null) found.push(`${(100 * share).toFixed(0)} % of the energy of its law`);
      return found;
    }
    if (kind === "mass") return [`${Number(entry.mass.toPrecision(4))} kg`];
    if (kind === "support") return [`holds or drives ${entry.held.join(", ")}`, ...force(model, "support", entry.name)];
    if (kind === "obstacle") {
      const shift = Math.hypot(...scene.vector(entry.shift, frame)), turn = entry.angle ? scene.value(entry.angle, frame) : 0;
      return [entry.type, `moved ${(1e3 * shift).toFixed(1)} mm`, ...(entry.angle ? [`turned ${(turn * 180 / Math.PI).toFixed(1)} deg`] : []),
        ...force(model, "obstacle", entry.name)];
    }
    const strain = model.coloured ? scene.value(model.strain.map((row) => row[point]), frame) / 255 * scene.strain : null;
    return strain === null ? [] : [`plastic strain ${strain.toPrecision(2)}`];
  }
  function force(model, on, name) {
    const found = model.forces.find((entry) => entry.on === on && entry.name === name);
    return found ? [`force ${number(Math.hypot(...scene.vector(found.force, frame)), "N")}`] : [];
  }

  /** the picked thing in words and, of a hinge, its rotation over time */
  function tell() {
    info.hidden = false;
    const words = [scene.models.length > 1 ? `${picked.model.name}: ` : "", `${picked.kind} ${picked.entry.name}`, ...values(picked).map((v) => `; ${v}`)];
    info.querySelector("span").textContent = words.join("");
    const picture = info.querySelector("svg") || element("svg", { viewBox: "0 0 160 38", "aria-hidden": "true" }, info);
    picture.replaceChildren();
    picture.style.display = picked.kind === "hinge" ? "" : "none";
    if (picked.kind !== "hinge") return;
    const list = picked.entry.rotation, low = Math.min(0, ...list), high = Math.max(0, ...list), span = high - low || 1;
    const end = scene.times[scene.last] - scene.times[0] || 1;
    const at = (t, y) => `${(2 + 156 * (t - scene.times[0]) / end).toFixed(1)},${(36 - 32 * (y - low) / span).toFixed(1)}`;
    element("polyline", { points: list.map((y, i) => at(scene.times[i], y)).join(" "), class: "curve" }, picture);
    element("polyline", { points: [at(scene.time(frame), low), at(scene.time(frame), high)].join(" "), class: "now" }, picture);
  }

  function save(blob, ending) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${(document.title.split(" · ")[0] || "crumple").replace(/[^\w-]+/g, "_").slice(0, 60)}.${ending}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  function film() {
    const kind = ["video/webm;codecs=vp9", "video/webm"].find((name) => MediaRecorder.isTypeSupported(name));
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: kind, videoBitsPerSecond: 6e6 }), chunks = [];
    recorder.ondataavailable = (event) => chunks.push(event.data);
    recorder.onstop = () => save(new Blob(chunks, { type: "video/webm" }), "webm");
    stop();
    frame = 0;
    recorder.start();
    // a little longer, so that the last picture is in it
    run(performance.now(), () => setTimeout(() => recorder.stop(), 300));
  }

  function connect() {
    controls.addEventListener("change", draw);
    slider.addEventListener("input", () => { stop(); frame = Number(slider.value); draw(); });
    for (const choice of [colour, part("ghost"), part("forces"), part("surroundings")]) choice.addEventListener("change", draw);
    scale.addEventListener("change", () => { scene.scale = Number(scale.value); draw(); });
    play.addEventListener("click", () => { if (running) stop(); else run(performance.now()); });
    for (const [control, event] of [[look, "change"], [facing, "change"], [part("reset"), "click"]]) {
      control.addEventListener(event, () => { reset(); fit(); });
    }
    let down = [0, 0];
    canvas.addEventListener("pointerdown", (event) => { down = [event.offsetX, event.offsetY]; });
    canvas.addEventListener("pointerup", (event) => {
      if (Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 4) return;
      picked = pick(event.offsetX, event.offsetY);
      info.hidden = !picked;
      if (picked) tell();
    });
    part("picture").addEventListener("click", () => { draw(); canvas.toBlob((blob) => save(blob, "png")); });
    if (typeof MediaRecorder === "undefined" || !canvas.captureStream) part("film").hidden = true;
    part("film").addEventListener("click", film);
    scene.models[scene.models.length - 1].hinges.forEach((hinge, i) => look.add(new Option(hinge.name, i)));
    new ResizeObserver(fit).observe(canvas);
  }

  function begin(bytes) {
    scene = new CrumpleScene.Scene(header, bytes);
    prepare();
    let webgl = false;
    try { webgl = !!document.createElement("canvas").getContext("webgl2"); } catch { webgl = false; }
    painter = webgl ? CrumplePainters.gl(scene, canvas, camera, radius) : CrumplePainters.flat(scene, canvas, camera);
    slider.max = scene.last;
    slider.step = "any";
    if (!scene.strain) colour.querySelector("[value=strain]").remove();
    if (!scene.models.some((model) => model.forces.length)) part("forces").parentElement.hidden = true;
    frame = scene.last;
    connect();
    reset();
    fit();
    root.dataset.ready = painter.mode;
    // for scripts: where a point is drawn now, in metres, and the way to a frame
    const world = (p) => p.map((x, axis) => x + scene.origin[axis] + scene.size[axis] / 2);
    const place = (model, point) => world([0, 1, 2].map((axis) => scene.models[model].position[3 * point + axis]));
    const seen = (model, name) => {
      camera.updateMatrixWorld();
      const hinge = scene.models[model].hinges.find((entry) => entry.name === name);
      const at = new THREE.Vector3(...scene.place(hinge.place, frame)).project(camera);
      return [(model + (at.x + 1) / 2) * wide / scene.models.length, (1 - at.y) / 2 * tall];
    };
    window.crumplePlayer = { seek(to) { stop(); frame = to; draw(); }, place, seen, scene, frames: scene.times.length };
  }

  CrumpleScene.unpack(document.getElementById("scene-payload").textContent).then(begin)
    .catch((error) => { note.textContent = `The animation cannot be shown: ${error.message}`; note.hidden = false; });
})();
