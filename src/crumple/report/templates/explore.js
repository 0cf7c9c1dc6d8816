// Made from web/ by make web: change it there.
"use strict";
(() => {
  // report/files.ts
  var SHARP = 4;
  var STYLED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family"];
  function save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
  }
  function standalone(svg) {
    const copy = svg.cloneNode(true);
    const shapes = "line, polyline, polygon, rect, text", copies = copy.querySelectorAll(shapes);
    svg.querySelectorAll(shapes).forEach((shape, i) => {
      if (shape.hasAttribute("style")) return;
      const style = getComputedStyle(shape);
      for (const name of STYLED) {
        const value = style.getPropertyValue(name);
        if (value) copies[i].setAttribute(name, value);
      }
    });
    copy.querySelectorAll(".time-cursor, .cursor").forEach((line) => line.remove());
    return copy;
  }
  function savePicture(svg, name) {
    const copy = standalone(svg), { width, height } = svg.viewBox.baseVal;
    copy.setAttribute("width", String(SHARP * width));
    copy.setAttribute("height", String(SHARP * height));
    const image = new Image();
    image.addEventListener("load", () => {
      const canvas = document.createElement("canvas");
      canvas.width = Math.round(SHARP * width);
      canvas.height = Math.round(SHARP * height);
      const brush = canvas.getContext("2d");
      if (!brush) return;
      brush.fillStyle = "#fff";
      brush.fillRect(0, 0, canvas.width, canvas.height);
      brush.drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => {
        if (blob) save(blob, name);
      }, "image/png");
    });
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  }
  function csv(rows) {
    const cell = (x) => {
      if (typeof x === "number") return String(Number.isInteger(x) ? x : Number(x.toPrecision(6)));
      return x && /[",\n]/.test(x) ? `"${x.replaceAll('"', '""')}"` : x ?? "";
    };
    return rows.map((row) => `${row.map(cell).join(",")}
`).join("");
  }
  function fileButtons(title, figure, data) {
    const tools = document.createElement("div"), name = title.replace(/[^\p{L}\p{N}._-]+/gu, "_");
    tools.className = "tools";
    const add = (label, action) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      button.addEventListener("click", action);
      tools.append(button);
    };
    add("SVG", () => {
      const text = `<?xml version="1.0" encoding="utf-8"?>
${new XMLSerializer().serializeToString(standalone(figure()))}`;
      save(new Blob([text], { type: "image/svg+xml" }), `${name}.svg`);
    });
    add("PNG", () => savePicture(figure(), `${name}.png`));
    if (data) add("CSV", () => save(new Blob([data()], { type: "text/csv" }), `${name}.csv`));
    return tools;
  }

  // report/study_drawing.ts
  function draw(name, attributes, parent, text) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
    if (text !== void 0) made.textContent = String(text);
    parent.append(made);
    return made;
  }

  // report/explore.ts
  var NEAR = 0.04;
  var WIDE = 330;
  var TALL = 190;
  var LEFT = 46;
  var RIGHT = 10;
  var TOP = 26;
  var BOTTOM = 28;
  function mix(values, weights) {
    const first = values[0];
    if (typeof first === "number") return values.reduce((sum, x, i) => sum + weights[i] * x, 0);
    if (Array.isArray(first)) return first.map((_, k) => mix(values.map((v) => v[k]), weights));
    if (first && typeof first === "object") {
      const all = values;
      return Object.fromEntries(Object.keys(first).map((key) => [key, mix(all.map((v) => v[key]), weights)]));
    }
    return first;
  }
  function corners(place, shape) {
    let found = [[0, 1]];
    place.forEach((x, axis) => {
      const low = Math.min(Math.floor(x), shape[axis] - 1), share = x - low;
      found = found.flatMap(([index, weight]) => [
        [index * shape[axis] + low, weight * (1 - share)],
        [index * shape[axis] + Math.min(low + 1, shape[axis] - 1), weight * share]
      ]);
    });
    return found.filter(([, weight]) => weight > 0).sort((a, b) => b[1] - a[1]);
  }
  function blended(model, models, weights, forces) {
    const [first] = models;
    const same = models.every((m) => m.points === first.points && m.quads === first.quads && m.hinges.length === first.hinges.length);
    const [used, w] = same ? [models, weights] : [[first], [1]];
    model.grid = first.grid.map((now, f) => Float32Array.from(now, (_, i) => used.reduce((sum, m, k) => sum + w[k] * m.grid[f][i], 0)));
    model.hinges = first.hinges.map((hinge, i) => ({ ...mix(used.map((m) => m.hinges[i]), w), state: hinge.state }));
    model.masses = mix(used.map((m) => m.masses), w);
    model.supports = mix(used.map((m) => m.supports), w);
    model.obstacles = mix(used.map((m) => m.obstacles), w).map((entry, i) => ({ ...entry, quads: first.obstacles[i].quads }));
    model.forces = forces.map((one) => {
      const all = used.map((m) => m.forces.find((x) => x.name === one.name && x.on === one.on));
      const there = all.filter((x) => x !== void 0);
      return there.length === all.length ? mix(there, w) : { ...one, force: one.force.map(() => [0, 0, 0]) };
    });
    return same;
  }
  function chart(curve, times, parent, middle) {
    const last = times[times.length - 1], panel = document.createElement("div");
    panel.className = "panel";
    parent.append(panel);
    const svg = draw("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, class: "chart", role: "img", "aria-label": curve.name }, panel);
    const all = curve.values.flat(), size = Math.max(...all.map(Math.abs)), tidy = (v) => Math.abs(v) < 1e-4 * size ? 0 : v;
    const low = tidy(Math.min(0, ...all)), high = tidy(Math.max(0, ...all)), span = high - low || 1;
    const x = (t) => LEFT + (WIDE - LEFT - RIGHT) * (t - times[0]) / (last - times[0] || 1);
    const y = (v) => TALL - BOTTOM - (TALL - TOP - BOTTOM) * (v - low) / span;
    const line = (values) => values.map((v, i) => `${x(times[i]).toFixed(1)},${y(v).toFixed(1)}`).join(" ");
    const [factor, unit] = last > 2 ? [1, "s"] : [1e3, "ms"];
    draw("text", { x: 0, y: 13, class: "name" }, svg, `${curve.name}, ${curve.unit}`);
    for (const v of /* @__PURE__ */ new Set([low, 0, high])) {
      draw("line", { x1: LEFT, x2: WIDE - RIGHT, y1: y(v), y2: y(v), class: "axis" }, svg);
      draw("text", { x: LEFT - 5, y: y(v) + 4, "text-anchor": "end" }, svg, String(Number(v.toPrecision(3))));
    }
    draw("text", { x: LEFT, y: TALL - 10 }, svg, "0");
    draw("text", { x: WIDE - RIGHT, y: TALL - 10, "text-anchor": "end" }, svg, `${Number((factor * last).toPrecision(4))} ${unit}`);
    draw("polyline", { points: middle < 0 ? "" : line(curve.values[middle]), class: "middle" }, svg);
    const now = draw("polyline", { points: "", class: "now" }, svg), cursor = draw("line", { y1: TOP, y2: TALL - BOTTOM, class: "cursor" }, svg);
    document.addEventListener("crumple-time", (event) => {
      for (const end of ["x1", "x2"]) cursor.setAttribute(end, String(x(Math.min(event.detail, last))));
    });
    let shown = null;
    const named = `${curve.name}, ${curve.unit}`, grey = middle < 0 ? [] : curve.values[middle];
    const data = () => csv([
      [`time, ${unit}`, named, ...middle < 0 ? [] : [`middle of the grid: ${named}`]],
      ...times.map((t, i) => [factor * t, shown ? shown[i] : null, ...grey.slice(i, i + 1)])
    ]);
    panel.append(fileButtons(curve.name, () => svg, data));
    return (values) => {
      shown = values;
      now.setAttribute("points", values ? line(values) : "");
    };
  }
  function begin(scene, explore) {
    const { axes, models: numbers, reasons, curves, times } = explore, runs = scene.models;
    const shape = axes.map((axis) => axis.values.length), place = shape.map((n) => (n - 1) / 2);
    const root = document.getElementById("explore"), told = root.querySelector("[data-role=told]");
    const middle = numbers[corners(shape.map((n) => Math.floor((n - 1) / 2)), shape)[0][0]];
    const model = { ...runs[Math.max(middle, 0)] };
    const forces = [...new Map(runs.flatMap((run) => run.forces).map((one) => [`${one.on} ${one.name}`, one])).values()];
    scene.models = [model];
    let draw2 = () => {
    }, charts = [];
    function show() {
      const around = corners(place, shape), failed = around.find(([index]) => numbers[index] < 0);
      root.className = `explore ${failed ? "none" : around.length === 1 ? "exact" : "between"}`;
      document.body.classList.toggle("between-points", around.length > 1);
      if (failed) {
        told.textContent = `No result here: ${reasons[failed[0]]}`;
        charts.forEach((put) => put(null));
        return;
      }
      const weights = around.map(([, weight]) => weight), chosen = around.map(([index]) => numbers[index]);
      const same = blended(model, chosen.map((k) => runs[k]), weights, forces);
      told.textContent = around.length === 1 ? "Solved: these values are a point of the grid." : `Interpolated between ${around.length} solved points${same ? "" : "; the shape is that of the nearest"}.`;
      charts.forEach((put, i) => put(mix(chosen.map((k) => curves[i].values[k]), weights)));
      draw2();
    }
    axes.forEach((axis, k) => {
      const label = document.createElement("label"), name = document.createElement("span");
      const input = document.createElement("input"), output = document.createElement("output"), marks = document.createElement("datalist");
      name.textContent = axis.name;
      marks.id = `marks-${k}`;
      axis.values.forEach((_, i) => marks.append(new Option("", String(i))));
      Object.assign(input, { type: "range", min: 0, max: shape[k] - 1, step: "any", value: place[k] });
      input.setAttribute("list", marks.id);
      input.setAttribute("aria-label", axis.name);
      label.append(name, input, output, marks);
      root.querySelector("[data-role=sliders]")?.append(label);
      const put = () => {
        const at = Number(input.value), near = Math.round(at);
        place[k] = Math.abs(at - near) < NEAR ? near : at;
        const low = Math.min(Math.floor(place[k]), shape[k] - 2), share = place[k] - low;
        const value = axis.values[low] + share * (axis.values[low + 1] - axis.values[low]);
        output.textContent = `${Number(value.toPrecision(4))} ${axis.unit}`;
        input.setAttribute("aria-valuetext", output.textContent);
      };
      input.addEventListener("input", () => {
        put();
        show();
      });
      input.addEventListener("keydown", (event) => {
        const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
        if (!way) return;
        event.preventDefault();
        input.value = String(way > 0 ? Math.floor(place[k] + 1) : Math.ceil(place[k] - 1));
        put();
        show();
      });
      put();
    });
    show();
    return (redraw) => {
      draw2 = redraw;
      const parent = document.querySelector("[data-role=curves]");
      charts = curves.map((curve) => chart(curve, times, parent, middle));
      show();
    };
  }
  window.crumpleExplore = begin;
})();
