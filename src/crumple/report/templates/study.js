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
    const shapes2 = "line, polyline, polygon, rect, text", copies = copy.querySelectorAll(shapes2);
    svg.querySelectorAll(shapes2).forEach((shape2, i) => {
      if (shape2.hasAttribute("style")) return;
      const style = getComputedStyle(shape2);
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
  function csv(rows2) {
    const cell = (x) => {
      if (typeof x === "number") return String(Number.isInteger(x) ? x : Number(x.toPrecision(6)));
      return x && /[",\n]/.test(x) ? `"${x.replaceAll('"', '""')}"` : x ?? "";
    };
    return rows2.map((row) => `${row.map(cell).join(",")}
`).join("");
  }
  function fileButtons(title, figure, data2) {
    const tools = document.createElement("div"), name = title.replace(/[^\p{L}\p{N}._-]+/gu, "_");
    tools.className = "tools";
    const add = (label2, action) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label2;
      button.addEventListener("click", action);
      tools.append(button);
    };
    add("SVG", () => {
      const text = `<?xml version="1.0" encoding="utf-8"?>
${new XMLSerializer().serializeToString(standalone(figure()))}`;
      save(new Blob([text], { type: "image/svg+xml" }), `${name}.svg`);
    });
    add("PNG", () => savePicture(figure(), `${name}.png`));
    if (data2) add("CSV", () => save(new Blob([data2()], { type: "text/csv" }), `${name}.csv`));
    return tools;
  }

  // report/study_drawing.ts
  var find = (selector) => document.querySelector(selector);
  function make(name, parent, text, attributes = {}) {
    const made = document.createElement(name);
    if (text !== void 0) made.textContent = String(text);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  }
  function draw(name, attributes, parent, text) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
    if (text !== void 0) made.textContent = String(text);
    parent.append(made);
    return made;
  }
  function paper(canvas) {
    const box = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(box.width * ratio));
    canvas.height = Math.max(1, Math.round(box.height * ratio));
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.clearRect(0, 0, box.width, box.height);
    context.font = "11px sans-serif";
    return [context, box.width, box.height];
  }
  function extent(values) {
    let low = Infinity, high = -Infinity;
    for (const x of values) if (x !== null) {
      low = Math.min(low, x);
      high = Math.max(high, x);
    }
    if (!(low < high)) return Number.isFinite(low) ? [low - 1, low + 1] : [0, 1];
    return [low, high];
  }
  var tidy = (x) => String(Number(x.toPrecision(3)));

  // report/study_bars.ts
  var pixels = (parent) => Math.max(300, Math.min(864, parent.clientWidth || 760));
  var long = (label2) => label2.getComputedTextLength() || 7 * (label2.textContent?.length ?? 0);
  function shorten(label2, room) {
    const text = label2.textContent ?? "";
    for (let most = text.length - 1; most > 0 && long(label2) > room; most--) label2.textContent = `${text.slice(0, most)}…`;
    if (label2.textContent !== text) draw("title", {}, label2, text);
  }
  function paintTornado(effect, parent) {
    parent.replaceChildren();
    if (!effect) return;
    if (!effect.bars.length) {
      make("p", parent, `${effect.response} is constant, ${tidy(effect.mean)}${effect.unit ? ` ${effect.unit}` : ""} in all rows: no variable has an effect on it.`);
      return;
    }
    const WIDE = pixels(parent), LINE = 42, end = LINE * effect.bars.length + 8;
    const svg = draw("svg", { viewBox: `0 0 ${WIDE} ${end + 38}`, role: "img", "aria-label": `Tornado of ${effect.response}` }, parent);
    const all = effect.bars.flatMap((bar) => [bar.low, bar.high]).concat(effect.mean), low = Math.min(...all), high = Math.max(...all);
    const texts = effect.bars.map((bar) => {
      const [before, after] = bar.low <= bar.high ? [bar.at_low, bar.at_high] : [bar.at_high, bar.at_low];
      return {
        name: draw("text", { x: 0, class: "name" }, svg, bar.variable),
        ends: [draw("text", { "text-anchor": "end" }, svg, before), draw("text", { "text-anchor": "start" }, svg, after)]
      };
    });
    const room = (side) => Math.min(Math.max(...texts.map(({ ends }) => long(ends[side])), 56) + 8, 0.35 * WIDE);
    const left = room(0), x = (v) => left + (WIDE - left - room(1)) * (v - low) / (high - low || 1);
    effect.bars.forEach((bar, i) => {
      const y = 22 + LINE * i, { name, ends: [before, after] } = texts[i], first2 = x(Math.min(bar.low, bar.high, effect.mean)), last = x(Math.max(bar.low, bar.high, effect.mean));
      name.setAttribute("y", String(y - 6));
      shorten(name, WIDE);
      for (const [v, kind] of [[x(bar.low), "low"], [x(bar.high), "high"]]) {
        draw("rect", { x: Math.min(v, x(effect.mean)), width: Math.abs(v - x(effect.mean)), y, height: 20, class: kind }, svg);
      }
      draw("line", { x1: x(effect.mean), x2: x(effect.mean), y1: y - 2, y2: y + 22, class: "mean" }, svg);
      for (const [label2, at2, most] of [[before, first2 - 4, first2 - 4], [after, last + 4, WIDE - last - 4]]) {
        label2.setAttribute("x", String(at2));
        label2.setAttribute("y", String(y + 14));
        shorten(label2, most);
      }
    });
    const unit = effect.unit ? ` ${effect.unit}` : "";
    for (const [v, y, text] of [[effect.mean, end + 14, `mean ${tidy(effect.mean)}`], [low, end + 30, tidy(low)], [high, end + 30, tidy(high)]]) {
      const label2 = draw("text", { y, "text-anchor": "middle" }, svg, text + unit), half = 0.5 * long(label2);
      label2.setAttribute("x", String(Math.max(half, Math.min(x(v), WIDE - half))));
    }
    const named = effect.response + (effect.unit ? `, ${effect.unit}` : ""), heads = ["variable", "at its low end", named, "at its high end", named];
    const data2 = () => csv([heads, ...effect.bars.map((bar) => [bar.variable, bar.at_low, bar.low, bar.at_high, bar.high]), ["mean", "", effect.mean, "", effect.mean]]);
    parent.append(fileButtons(`tornado_${effect.response}`, () => svg, data2));
  }
  function paintCurve(curve, parent) {
    parent.replaceChildren();
    const said = find("#convergence [data-role=told]");
    if (!curve) {
      said.textContent = "Too few rows.";
      return;
    }
    said.textContent = curve.band.length ? "After so many rows, with its 95 % interval." : "After so many rows, among those that keep all constraints.";
    const WIDE = pixels(parent), TALL = 230, LEFT = 76, svg = draw("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, role: "img", "aria-label": curve.name }, parent);
    const known = curve.values.flatMap((v, i) => v === null ? [] : [i]);
    if (!known.length) {
      said.textContent = "No row keeps all constraints.";
      return;
    }
    const settled = known.filter((i) => i >= known.length * 0.1), all = [...(curve.band.length ? settled : known).map((i) => curve.values[i]), ...curve.band.flatMap((end) => settled.map((i) => end[i]))].filter((v) => v !== null);
    const [low, high] = extent(all), last = curve.rows[curve.rows.length - 1];
    const x = (r) => LEFT + (WIDE - LEFT - 20) * r / last, y = (v) => TALL - 34 - (TALL - 60) * (Math.max(low, Math.min(high, v)) - low) / (high - low);
    const path = (values, way) => (way < 0 ? [...known].reverse() : known).map((i) => `${x(curve.rows[i]).toFixed(1)},${y(values[i] ?? low).toFixed(1)}`);
    if (curve.band.length) draw("polygon", { points: [...path(curve.band[0], 1), ...path(curve.band[1], -1)].join(" "), class: "band" }, svg);
    for (const v of [low, (low + high) / 2, high]) {
      draw("line", { x1: LEFT, x2: WIDE - 20, y1: y(v), y2: y(v), class: "axis" }, svg);
      draw("text", { x: LEFT - 6, y: y(v) + 4, "text-anchor": "end" }, svg, Number(v.toPrecision(4)));
    }
    draw("polyline", { points: path(curve.values, 1).join(" "), class: "curve" }, svg);
    shorten(draw("text", { x: 0, y: 14, class: "name" }, svg, curve.name + (curve.unit ? `, ${curve.unit}` : "")), WIDE);
    draw("text", { x: WIDE - 20, y: TALL - 12, "text-anchor": "end" }, svg, `${last} rows`);
    const heads = ["rows", curve.name + (curve.unit ? `, ${curve.unit}` : ""), ...curve.band.map((_, end) => end ? "upper end" : "lower end")];
    const data2 = () => csv([heads, ...curve.rows.map((r, i) => [r, curve.values[i], ...curve.band.map((end) => end[i])])]);
    parent.append(fileButtons(`convergence_${curve.name}`, () => svg, data2));
  }
  function offer(id, entries, name, put) {
    const select = find(`#${id} select`), parent = find(`#${id} > div`);
    entries.forEach((entry, i) => select.add(new Option(name(entry), String(i))));
    let painted = 0;
    const paint2 = () => {
      painted = parent.clientWidth;
      put(entries[Number(select.value)], parent);
    };
    select.addEventListener("change", paint2);
    paint2();
    if (!entries.length) find(`#${id}`).hidden = true;
    new ResizeObserver(() => {
      if (parent.clientWidth && parent.clientWidth !== painted) paint2();
    }).observe(parent);
  }

  // report/study_rows.ts
  var data = JSON.parse(find("#study-data").textContent ?? "");
  var shapes = JSON.parse(find("#study-shapes").textContent ?? "");
  var { columns, rows, status } = data;
  var count = rows.length;
  var axes = [...columns.keys()];
  var KEPT = "#1f5f9e";
  var VIOLATED = "#d08a3c";
  var FRONT = "#2a7d61";
  var CHOSEN = "#c1272d";
  var FAINT = "rgba(120,130,140,0.12)";
  var numbers = columns.map((c) => c.words ? encode(c) : c.values);
  var at = (k, i) => numbers[k][i];
  var complete = rows.map((_, i) => columns.every((c) => c.values[i] !== null));
  var kept = rows.map((_, i) => complete[i] && data.limits.every(({ name, low, high }) => {
    const x = columns.find((c) => c.name === name)?.values[i];
    return (low === null || x >= low) && (high === null || x <= high);
  }));
  var place = new Map(rows.map((row, i) => [row, i]));
  var front = data.front.map((row) => place.get(row)).filter((i) => i !== void 0);
  var onFront = new Set(front);
  var best = data.best === null ? void 0 : place.get(data.best);
  var range = numbers.map(extent);
  function encode(column) {
    const levels = [...new Set(column.values)];
    column.levels = levels;
    return column.values.map((word) => levels.indexOf(word));
  }
  var label = (k) => columns[k].name + (columns[k].unit ? `, ${columns[k].unit}` : "");
  var told = (k, i) => {
    const x = columns[k].values[i];
    return x === null ? "none" : typeof x === "string" ? x : `${Number(x.toPrecision(5))}${columns[k].unit ? ` ${columns[k].unit}` : ""}`;
  };
  var tick = (k, x) => columns[k].words ? columns[k].levels?.[Math.round(x)] ?? "" : tidy(x);
  var colour = (i) => kept[i] ? KEPT : VIOLATED;
  var shape = (i) => shapes[data.alike[rows[i]]];

  // report/svg_brush.ts
  var FONT = { "font-size": 11, "font-family": "sans-serif" };
  var round = (x) => Number(x.toFixed(2));
  var SvgBrush = class {
    constructor(canvas, wide = canvas.clientWidth, tall = canvas.clientHeight) {
      this.wide = wide;
      this.tall = tall;
      this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      this.svg.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
      this.measure.font = `${FONT["font-size"]}px ${FONT["font-family"]}`;
    }
    wide;
    tall;
    svg;
    strokeStyle = "#000";
    fillStyle = "#000";
    lineWidth = 1;
    globalAlpha = 1;
    textAlign = "left";
    path = "";
    measure = document.createElement("canvas").getContext("2d");
    beginPath() {
      this.path = "";
    }
    moveTo(x, y) {
      this.path += `M${round(x)} ${round(y)}`;
    }
    lineTo(x, y) {
      this.path += `L${round(x)} ${round(y)}`;
    }
    /** a full circle, whatever the angles */
    arc(x, y, radius) {
      const r = round(radius);
      this.path += `M${round(x - r)} ${round(y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
    }
    stroke() {
      draw("path", { d: this.path, ...this.outline() }, this.svg);
    }
    fill() {
      draw("path", { d: this.path, ...this.inside() }, this.svg);
    }
    strokeRect(x, y, width, height) {
      draw("rect", { x, y, width, height, ...this.outline() }, this.svg);
    }
    fillRect(x, y, width, height) {
      draw("rect", { x, y, width, height, ...this.inside() }, this.svg);
    }
    fillText(text, x, y, most = Infinity) {
      const anchor = { center: "middle", right: "end" }[this.textAlign] ?? "start";
      const narrow = this.measure.measureText(text).width > most ? { textLength: most, lengthAdjust: "spacingAndGlyphs" } : {};
      draw("text", { x, y, "text-anchor": anchor, ...FONT, ...this.inside(), ...narrow }, this.svg, text);
    }
    outline() {
      return { fill: "none", stroke: String(this.strokeStyle), "stroke-width": this.lineWidth, opacity: this.globalAlpha };
    }
    inside() {
      return { fill: String(this.fillStyle), opacity: this.globalAlpha };
    }
  };

  // report/study.ts
  var NEAR = 12;
  var PAGE_ROWS = 50;
  var MOST_MATRIX = 7;
  var BINS = 16;
  var filters = axes.map(() => [-Infinity, Infinity]);
  var marked = columns.flatMap((c, k) => c.kind === "response" ? [k] : []).concat(columns.flatMap((c, k) => c.kind === "variable" ? [k] : [])).slice(0, 4);
  var visible = [];
  var chosen = -1;
  var onlyKept = false;
  var order = { by: -1, way: 1 };
  var first = 0;
  var pending = 0;
  function inFilters(i) {
    return complete[i] && (!onlyKept || kept[i]) && axes.every((k) => at(k, i) >= filters[k][0] && at(k, i) <= filters[k][1]);
  }
  function filtered() {
    visible = [];
    const none = filters.every(([low, high]) => low === -Infinity && high === Infinity) && !onlyKept;
    const listed = [];
    for (let i = 0; i < count; i++) {
      if (inFilters(i)) visible.push(i);
      if (none || inFilters(i)) listed.push(i);
    }
    tabled = listed;
    first = 0;
    find("#filters [data-role=count]").textContent = `${visible.length} of ${count} rows; ${complete.filter((ok) => !ok).length} have no values.`;
    if (!pending) pending = requestAnimationFrame(() => {
      pending = 0;
      paint();
    });
  }
  var tabled = [];
  var inputs = [];
  function setFilter(k, low, high) {
    filters[k] = [low, high];
    if (inputs[k]) [low, high].forEach((x, end) => {
      inputs[k][end].value = Number.isFinite(x) ? String(Number(x.toPrecision(6))) : "";
    });
    filtered();
  }
  function offerFilters() {
    const parent = find("#filters .filters");
    axes.forEach((k) => {
      const line = make("div", parent);
      make("span", line, label(k));
      if (columns[k].words) {
        const choice = make("select", line, void 0, { class: "wide", "aria-label": `only ${columns[k].name}` });
        ["all", ...columns[k].levels ?? []].forEach((word, i) => choice.add(new Option(word, String(i - 1))));
        choice.addEventListener("change", () => {
          const i = Number(choice.value);
          filters[k] = i < 0 ? [-Infinity, Infinity] : [i, i];
          filtered();
        });
        return;
      }
      inputs[k] = ["least", "most"].map((end, at2) => {
        const input = make("input", line, void 0, { type: "number", step: "any", placeholder: tidy(range[k][at2]), "aria-label": `${end} ${columns[k].name}` });
        input.addEventListener("input", () => {
          filters[k][at2] = input.value === "" ? at2 ? Infinity : -Infinity : Number(input.value);
          filtered();
        });
        return input;
      });
    });
    if (data.limits.length) {
      const line = make("label", make("div", parent), " only rows that keep all constraints"), box = document.createElement("input");
      box.type = "checkbox";
      line.prepend(box);
      line.style.gridColumn = "1 / 4";
      box.addEventListener("change", () => {
        onlyKept = box.checked;
        filtered();
      });
    }
  }
  function offerCanvas(canvas, name, paintOn, shownColumns) {
    const figure = () => {
      const brush = new SvgBrush(canvas);
      paintOn([brush, brush.wide, brush.tall]);
      return brush.svg;
    };
    const table2 = () => csv([["row", ...shownColumns().map(label)], ...visible.map((i) => [rows[i], ...shownColumns().map((k) => columns[k].values[i])])]);
    canvas.after(fileButtons(name, figure, table2));
  }
  function dot(context, i, x, y, size) {
    context.fillStyle = onFront.has(i) || i === best ? FRONT : colour(i);
    context.beginPath();
    context.arc(x, y, onFront.has(i) || i === best ? size + 1 : size, 0, 7);
    context.fill();
  }
  function ring(context, x, y) {
    context.strokeStyle = CHOSEN;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(x, y, 6, 0, 7);
    context.stroke();
  }
  var spots = /* @__PURE__ */ new Map();
  function scatter(context, kx, ky, box, size, found) {
    const [left, top2, wide, tall] = box;
    const x = (v) => left + wide * (v - range[kx][0]) / (range[kx][1] - range[kx][0]), y = (v) => top2 + tall - tall * (v - range[ky][0]) / (range[ky][1] - range[ky][0]);
    context.globalAlpha = visible.length > 1500 ? 0.45 : 0.8;
    for (const i of visible) {
      const spot = [i, x(at(kx, i)), y(at(ky, i))];
      dot(context, i, spot[1], spot[2], size);
      found.push(spot);
    }
    context.globalAlpha = 1;
    context.strokeStyle = "#1c2733";
    context.lineWidth = 1.2;
    for (const i of visible.filter(shape)) {
      context.beginPath();
      context.arc(x(at(kx, i)), y(at(ky, i)), size + 2, 0, 7);
      context.stroke();
    }
    if (chosen >= 0 && complete[chosen]) ring(context, x(at(kx, chosen)), y(at(ky, chosen)));
    return [x, y];
  }
  function nearest(canvas, event) {
    let found = -1, away = 1.5 * NEAR;
    for (const [i, x, y] of spots.get(canvas) || []) {
      const distance = Math.hypot(x - event.offsetX, y - event.offsetY) + (shape(i) ? 0 : NEAR / 2);
      if (distance < away) {
        away = distance;
        found = i;
      }
    }
    return found;
  }
  var pair = find("#pair canvas");
  var acrossChoice = find("#pair [data-role=x]");
  var upChoice = find("#pair [data-role=y]");
  function paintPair([context, wide, tall] = paper(pair)) {
    const kx = Number(acrossChoice.value), ky = Number(upChoice.value), found = [];
    const box = [70, 26, wide - 90, tall - 70];
    const [x, y] = scatter(context, kx, ky, box, 2.6, found);
    spots.set(pair, found);
    context.strokeStyle = "#5a6672";
    context.lineWidth = 1;
    context.strokeRect(...box);
    context.fillStyle = "#5a6672";
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const vx = range[kx][0] + share * (range[kx][1] - range[kx][0]), vy = range[ky][0] + share * (range[ky][1] - range[ky][0]);
      context.textAlign = "center";
      context.fillText(tick(kx, vx), x(vx), tall - 28);
      context.textAlign = "right";
      context.fillText(tick(ky, vy), 64, y(vy) + 4);
    }
    context.fillStyle = "#1c2733";
    context.textAlign = "center";
    context.fillText(label(kx), box[0] + box[2] / 2, tall - 8);
    context.textAlign = "left";
    context.fillText(label(ky), 70, 16);
    const goals = data.goals.map((goal) => columns.findIndex((c) => c.name === goal.name));
    if (goals.length === 2 && goals.includes(kx) && goals.includes(ky)) {
      context.strokeStyle = FRONT;
      context.beginPath();
      front.forEach((i, n) => context[n ? "lineTo" : "moveTo"](x(at(kx, i)), y(at(ky, i))));
      context.stroke();
    }
  }
  var matrix = find("#matrix canvas");
  function paintMatrix(sheet) {
    const n = Math.max(marked.length, 1);
    matrix.style.height = `${Math.min(matrix.getBoundingClientRect().width, 1100)}px`;
    const [context, wide, tall] = sheet ?? paper(matrix), found = [], w = (wide - 10) / n, h = (tall - 10) / n;
    marked.forEach((ky, row) => marked.forEach((kx, column) => {
      const box = [column * w + 9, row * h + 9, w - 8, h - 8];
      context.strokeStyle = "#d3dae0";
      context.lineWidth = 1;
      context.strokeRect(...box);
      const inner = [box[0] + 6, box[1] + 6, box[2] - 12, box[3] - 12];
      if (kx !== ky) {
        scatter(context, kx, ky, inner, 1.7, found);
        return;
      }
      const bins = new Array(BINS).fill(0);
      for (const i of visible) bins[Math.min(BINS - 1, Math.floor(BINS * (at(kx, i) - range[kx][0]) / (range[kx][1] - range[kx][0])))]++;
      const most = Math.max(...bins, 1);
      context.fillStyle = "#d8e4f0";
      bins.forEach((number, b) => context.fillRect(inner[0] + b * inner[2] / BINS, inner[1] + inner[3] * (1 - 0.7 * number / most), inner[2] / BINS - 1, 0.7 * inner[3] * number / most));
      context.fillStyle = "#1c2733";
      context.textAlign = "left";
      context.fillText(label(kx), inner[0], inner[1] + 10, inner[2]);
      context.fillStyle = "#5a6672";
      context.fillText(tick(kx, range[kx][0]), inner[0], inner[1] + inner[3] + 3, inner[2] / 2);
      context.textAlign = "right";
      context.fillText(tick(kx, range[kx][1]), inner[0] + inner[2], inner[1] + inner[3] + 3, inner[2] / 2);
    }));
    spots.set(matrix, found);
  }
  function offerMatrix() {
    const parent = find("#matrix .choice");
    axes.forEach((k) => {
      const line = make("label", parent, ` ${columns[k].name}`), box = document.createElement("input");
      Object.assign(box, { type: "checkbox", checked: marked.includes(k) });
      line.prepend(box);
      box.addEventListener("change", () => {
        if (!box.checked) marked.splice(marked.indexOf(k), 1);
        else if (marked.length < MOST_MATRIX) marked.push(k);
        else box.checked = false;
        paintMatrix();
      });
    });
  }
  var parallel = find("#parallel canvas");
  var lines = [];
  var drag = null;
  var top = 50;
  var bottom = 26;
  var lane = (k, wide) => 60 + k * (wide - 120) / Math.max(axes.length - 1, 1);
  function paintParallel([context, wide, tall] = paper(parallel)) {
    const high = tall - top - bottom;
    const y = (k, i) => top + high * (1 - (at(k, i) - range[k][0]) / (range[k][1] - range[k][0]));
    const trace = (i) => {
      context.beginPath();
      axes.forEach((k) => context[k ? "lineTo" : "moveTo"](lane(k, wide), y(k, i)));
      context.stroke();
    };
    context.lineWidth = 1;
    context.strokeStyle = FAINT;
    const shown = new Set(visible);
    for (let i = 0; i < count; i++) if (complete[i] && !shown.has(i)) trace(i);
    context.globalAlpha = Math.max(0.08, Math.min(0.7, 120 / Math.max(visible.length, 1)));
    for (const i of visible) {
      context.strokeStyle = colour(i);
      trace(i);
    }
    context.globalAlpha = 1;
    lines = visible.map((i) => [i, axes.map((k) => y(k, i))]);
    for (const i of [best, chosen]) {
      if (i === void 0 || i < 0 || !complete[i]) continue;
      context.strokeStyle = i === chosen ? CHOSEN : FRONT;
      context.lineWidth = 2.2;
      trace(i);
    }
    context.textAlign = "center";
    axes.forEach((k) => {
      const x = lane(k, wide), room = (wide - 120) / Math.max(axes.length - 1, 1) - 6;
      context.strokeStyle = "#5a6672";
      context.lineWidth = 1;
      context.beginPath();
      context.moveTo(x, top);
      context.lineTo(x, top + high);
      context.stroke();
      context.fillStyle = "#1c2733";
      context.fillText(label(k), x, k % 2 ? 13 : 28, Math.max(2 * room, 60));
      context.fillStyle = "#5a6672";
      context.fillText(tick(k, range[k][0]), x, tall - 9, Math.max(room, 40));
      context.fillText(tick(k, range[k][1]), x, top - 6, Math.max(room, 40));
      const [low, upper] = filters[k].map((v) => Math.max(range[k][0], Math.min(range[k][1], v)));
      if (filters[k][0] > range[k][0] || filters[k][1] < range[k][1]) {
        const place2 = (v) => top + high * (1 - (v - range[k][0]) / (range[k][1] - range[k][0]));
        context.fillStyle = "rgba(31,95,158,0.25)";
        context.fillRect(x - 6, place2(upper), 12, Math.max(place2(low) - place2(upper), 2));
      }
    });
  }
  function axisAt(event) {
    const wide = parallel.getBoundingClientRect().width;
    return axes.find((k) => Math.abs(lane(k, wide) - event.offsetX) < 9) ?? -1;
  }
  function valueAt(k, offset) {
    const high = parallel.getBoundingClientRect().height - top - bottom;
    return range[k][1] - (offset - top) / high * (range[k][1] - range[k][0]);
  }
  function lineAt(event) {
    const wide = parallel.getBoundingClientRect().width;
    let k = 0;
    while (k < axes.length - 2 && event.offsetX > lane(k + 1, wide)) k++;
    const share = (event.offsetX - lane(k, wide)) / (lane(k + 1, wide) - lane(k, wide) || 1);
    let found = -1, away = NEAR;
    for (const [i, y] of lines) {
      const distance = Math.abs(y[k] + share * ((y[k + 1] ?? y[k]) - y[k]) - event.offsetY);
      if (distance < away) {
        away = distance;
        found = i;
      }
    }
    return found;
  }
  var table = find("#table table");
  function paintTable() {
    const sorted = [...tabled];
    if (order.by >= 0) {
      const key = (i) => numbers[order.by][i] ?? Infinity;
      sorted.sort((a, b) => order.way * (key(a) - key(b)) || a - b);
    }
    first = Math.max(0, Math.min(first, PAGE_ROWS * Math.floor((sorted.length - 1) / PAGE_ROWS)));
    const page = sorted.slice(first, first + PAGE_ROWS);
    table.replaceChildren();
    const head = make("tr", make("thead", table)), body = make("tbody", table);
    make("th", head, "row", { scope: "col" });
    axes.forEach((k) => {
      const cell = make("th", head, void 0, { scope: "col" }), way = order.by === k ? order.way > 0 ? " ↑" : " ↓" : "";
      if (way) cell.setAttribute("aria-sort", order.way > 0 ? "ascending" : "descending");
      make("button", cell, label(k) + way, { type: "button" }).addEventListener("click", () => {
        order = { by: k, way: order.by === k ? -order.way : 1 };
        first = 0;
        paintTable();
      });
    });
    make("th", head, "status", { scope: "col", class: "text" });
    for (const i of page) {
      const line = make("tr", body, void 0, i === chosen ? { class: "now" } : {});
      make("th", line, `${rows[i]}${shape(i) ? " ◉" : ""}`, { scope: "row" });
      for (const k of axes) {
        const value = columns[k].values[i];
        make("td", line, typeof value === "number" ? Number(value.toPrecision(5)) : value ?? "");
      }
      make("td", line, complete[i] ? kept[i] ? onFront.has(i) ? "on the front" : i === best ? "best" : "complete" : "violates a constraint" : status[i], { class: "text" });
      line.addEventListener("click", () => choose(i));
    }
    find(".pages span").textContent = sorted.length ? `${first + 1} to ${first + page.length} of ${sorted.length}` : "none";
  }
  function choose(i) {
    if (i < 0) return;
    chosen = i;
    const list = find("#chosen dl"), stored = shape(i), said = document.getElementById("shape-told");
    find("#chosen [data-role=told]").textContent = `Row ${rows[i]}${complete[i] ? kept[i] ? "" : ", violates a constraint" : `: ${status[i]}`}`;
    list.replaceChildren();
    axes.forEach((k) => {
      const line = make("div", list);
      make("dt", line, columns[k].name);
      make("dd", line, told(k, i));
    });
    if (said) said.textContent = stored ? `Shown: row ${rows[i]}.` : `No shape of row ${rows[i]} is stored; rows with a dark ring, in the table ◉, have one.`;
    if (stored) void window.crumplePlayer.show(structuredClone(stored.header), stored.payload);
    document.body.dataset.shown = stored ? String(rows[i]) : "";
    paint();
  }
  function paint() {
    paintParallel();
    paintPair();
    paintMatrix();
    paintTable();
  }
  function begin() {
    const legend = find("#legend"), entries = [[KEPT, data.limits.length ? "keeps all constraints" : "row"]];
    if (data.limits.length) entries.push([VIOLATED, "violates a constraint"]);
    if (front.length) entries.push([FRONT, "on the Pareto front"]);
    else if (best !== void 0) entries.push([FRONT, "best row"]);
    entries.push([CHOSEN, "chosen"]);
    for (const [paintOf, text] of entries) {
      const entry = make("span", legend);
      make("i", entry).style.background = paintOf;
      entry.append(text);
    }
    legend.hidden = false;
    offerFilters();
    offerMatrix();
    const goals = data.goals.map((goal) => columns.findIndex((c) => c.name === goal.name));
    axes.forEach((k) => {
      acrossChoice.add(new Option(columns[k].name, String(k)));
      upChoice.add(new Option(columns[k].name, String(k)));
    });
    const responses = axes.filter((k) => columns[k].kind === "response");
    acrossChoice.value = String(goals[0] ?? 0);
    upChoice.value = String(goals[1] ?? responses.find((k) => k !== goals[0]) ?? responses[0]);
    find("#pair [data-role=front]").hidden = !front.length;
    for (const select of [acrossChoice, upChoice]) select.addEventListener("change", () => paintPair());
    offer("effects", data.effects, (effect) => effect.response, paintTornado);
    offer("convergence", data.convergence, (curve) => curve.name, paintCurve);
    offerCanvas(parallel, "parallel", paintParallel, () => axes);
    offerCanvas(pair, "two_columns", paintPair, () => [Number(acrossChoice.value), Number(upChoice.value)]);
    offerCanvas(matrix, "matrix", paintMatrix, () => marked);
    for (const canvas of [pair, matrix]) canvas.addEventListener("click", (event) => choose(nearest(canvas, event)));
    parallel.addEventListener("pointerdown", (event) => {
      drag = { axis: axisAt(event), from: event.offsetY, moved: false };
    });
    parallel.addEventListener("pointermove", (event) => {
      if (!drag || drag.axis < 0 || Math.abs(event.offsetY - drag.from) < 3) return;
      drag.moved = true;
      const { axis } = drag, ends = [drag.from, event.offsetY].map((y) => valueAt(axis, y)).sort((a, b) => a - b);
      setFilter(axis, ends[0] <= range[axis][0] ? -Infinity : ends[0], ends[1] >= range[axis][1] ? Infinity : ends[1]);
    });
    window.addEventListener("pointerup", (event) => {
      if (drag && !drag.moved && event.target === parallel) {
        if (drag.axis >= 0) setFilter(drag.axis, -Infinity, Infinity);
        else choose(lineAt(event));
      }
      drag = null;
    });
    for (const [role, way] of [["back", -1], ["next", 1]]) {
      find(`.pages [data-role=${role}]`).addEventListener("click", () => {
        first += way * PAGE_ROWS;
        paintTable();
      });
    }
    window.addEventListener("resize", paint);
    filtered();
    paint();
    document.body.dataset.ready = "yes";
  }
  begin();
})();
