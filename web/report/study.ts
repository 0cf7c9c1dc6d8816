// Page of a study: filters, figures of its rows on canvases, a table; a chosen row is shown in the viewer.
import type {} from "./viewer";
import { csv, fileButtons } from "./files";
import { offer, paintCurve, paintTornado } from "./study_bars";
import { find, make, paper, type Span, tidy } from "./study_drawing";
import {
  at, axes, best, CHOSEN, colour, columns, complete, count, data, FAINT, FRONT, front, KEPT, kept, label, numbers,
  onFront, range, rows, shape, status, tick, told, VIOLATED,
} from "./study_rows";
import { type Brush, SvgBrush } from "./svg_brush";

type Box = [number, number, number, number];
/** row and its place in pixels of the page */
type Spot = [number, number, number];

const NEAR = 12, PAGE_ROWS = 50, MOST_MATRIX = 7, BINS = 16;
const filters = axes.map((): Span => [-Infinity, Infinity]);
const marked = columns.flatMap((c, k) => (c.kind === "response" ? [k] : [])).concat(columns.flatMap((c, k) => (c.kind === "variable" ? [k] : []))).slice(0, 4);
let visible: number[] = [], chosen = -1, onlyKept = false, order = { by: -1, way: 1 }, first = 0, pending = 0;

// filters

function inFilters(i: number): boolean {
  return complete[i] && (!onlyKept || kept[i]) && axes.every((k) => at(k, i) >= filters[k][0] && at(k, i) <= filters[k][1]);
}
function filtered(): void {
  visible = [];
  const none = filters.every(([low, high]) => low === -Infinity && high === Infinity) && !onlyKept;
  const listed: number[] = [];
  for (let i = 0; i < count; i++) {
    if (inFilters(i)) visible.push(i);
    // a failed row is in the table as long as nothing is filtered
    if (none || inFilters(i)) listed.push(i);
  }
  tabled = listed;
  first = 0;
  find("#filters [data-role=count]").textContent = `${visible.length} of ${count} rows; ${complete.filter((ok) => !ok).length} have no values.`;
  if (!pending) pending = requestAnimationFrame(() => { pending = 0; paint(); });
}
let tabled: number[] = [];
const inputs: HTMLInputElement[][] = [];
function setFilter(k: number, low: number, high: number): void {
  filters[k] = [low, high];
  if (inputs[k]) [low, high].forEach((x, end) => { inputs[k][end].value = Number.isFinite(x) ? String(Number(x.toPrecision(6))) : ""; });
  filtered();
}
function offerFilters(): void {
  const parent = find("#filters .filters");
  axes.forEach((k) => {
    const line = make("div", parent);
    make("span", line, label(k));
    if (columns[k].words) {
      const choice = make("select", line, undefined, { class: "wide", "aria-label": `only ${columns[k].name}` });
      ["all", ...columns[k].levels ?? []].forEach((word, i) => choice.add(new Option(word, String(i - 1))));
      choice.addEventListener("change", () => {
        const i = Number(choice.value);
        filters[k] = i < 0 ? [-Infinity, Infinity] : [i, i];
        filtered();
      });
      return;
    }
    inputs[k] = ["least", "most"].map((end, at) => {
      const input = make("input", line, undefined, { type: "number", step: "any", placeholder: tidy(range[k][at]), "aria-label": `${end} ${columns[k].name}` });
      input.addEventListener("input", () => {
        filters[k][at] = input.value === "" ? (at ? Infinity : -Infinity) : Number(input.value);
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
    box.addEventListener("change", () => { onlyKept = box.checked; filtered(); });
  }
}

// figures

type Sheet = [Brush, number, number];

/** files of a figure on a canvas: the columns are those that it shows */
function offerCanvas(canvas: HTMLCanvasElement, name: string, paintOn: (sheet: Sheet) => void, shownColumns: () => number[]): void {
  const figure = () => {
    const brush = new SvgBrush(canvas);
    paintOn([brush, brush.wide, brush.tall]);
    return brush.svg;
  };
  const table = () => csv([["row", ...shownColumns().map(label)], ...visible.map((i) => [rows[i], ...shownColumns().map((k) => columns[k].values[i])])]);
  canvas.after(fileButtons(name, figure, table));
}
function dot(context: Brush, i: number, x: number, y: number, size: number): void {
  context.fillStyle = onFront.has(i) || i === best ? FRONT : colour(i);
  context.beginPath();
  context.arc(x, y, onFront.has(i) || i === best ? size + 1 : size, 0, 7);
  context.fill();
}
function ring(context: Brush, x: number, y: number): void {
  context.strokeStyle = CHOSEN;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, y, 6, 0, 7);
  context.stroke();
}
const spots = new Map<HTMLCanvasElement, Spot[]>();  // of a canvas: what is drawn where, [row, x, y] in pixels of the page
/** a scatter of two columns in a box; low-alpha points if there are many */
function scatter(context: Brush, kx: number, ky: number, box: Box, size: number, found: Spot[]): [(v: number) => number, (v: number) => number] {
  const [left, top, wide, tall] = box;
  const x = (v: number) => left + wide * (v - range[kx][0]) / (range[kx][1] - range[kx][0]), y = (v: number) => top + tall - tall * (v - range[ky][0]) / (range[ky][1] - range[ky][0]);
  context.globalAlpha = visible.length > 1500 ? 0.45 : 0.8;
  for (const i of visible) {
    const spot: Spot = [i, x(at(kx, i)), y(at(ky, i))];
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
function nearest(canvas: HTMLCanvasElement, event: MouseEvent): number {
  let found = -1, away = 1.5 * NEAR;
  for (const [i, x, y] of spots.get(canvas) || []) {
    // among points that lie close together one with a shape is meant
    const distance = Math.hypot(x - event.offsetX, y - event.offsetY) + (shape(i) ? 0 : NEAR / 2);
    if (distance < away) { away = distance; found = i; }
  }
  return found;
}

const pair = find<HTMLCanvasElement>("#pair canvas"), acrossChoice = find<HTMLSelectElement>("#pair [data-role=x]"), upChoice = find<HTMLSelectElement>("#pair [data-role=y]");
function paintPair([context, wide, tall]: Sheet = paper(pair)): void {
  const kx = Number(acrossChoice.value), ky = Number(upChoice.value), found: Spot[] = [];
  const box: Box = [70, 26, wide - 90, tall - 70];
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

const matrix = find<HTMLCanvasElement>("#matrix canvas");
function paintMatrix(sheet?: Sheet): void {
  const n = Math.max(marked.length, 1);
  matrix.style.height = `${Math.min(matrix.getBoundingClientRect().width, 1100)}px`;
  const [context, wide, tall] = sheet ?? paper(matrix), found: Spot[] = [], w = (wide - 10) / n, h = (tall - 10) / n;
  marked.forEach((ky, row) => marked.forEach((kx, column) => {
    const box: Box = [column * w + 9, row * h + 9, w - 8, h - 8];
    context.strokeStyle = "#d3dae0";
    context.lineWidth = 1;
    context.strokeRect(...box);
    const inner: Box = [box[0] + 6, box[1] + 6, box[2] - 12, box[3] - 12];
    if (kx !== ky) { scatter(context, kx, ky, inner, 1.7, found); return; }
    const bins = new Array<number>(BINS).fill(0);
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
function offerMatrix(): void {
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

const parallel = find<HTMLCanvasElement>("#parallel canvas");
let lines: [number, number[]][] = [], drag: { axis: number; from: number; moved: boolean } | null = null;
const top = 50, bottom = 26;
const lane = (k: number, wide: number) => 60 + k * (wide - 120) / Math.max(axes.length - 1, 1);
function paintParallel([context, wide, tall]: Sheet = paper(parallel)): void {
  const high = tall - top - bottom;
  const y = (k: number, i: number) => top + high * (1 - (at(k, i) - range[k][0]) / (range[k][1] - range[k][0]));
  const trace = (i: number) => {
    context.beginPath();
    axes.forEach((k) => context[k ? "lineTo" : "moveTo"](lane(k, wide), y(k, i)));
    context.stroke();
  };
  context.lineWidth = 1;
  context.strokeStyle = FAINT;
  const shown = new Set(visible);
  for (let i = 0; i < count; i++) if (complete[i] && !shown.has(i)) trace(i);
  context.globalAlpha = Math.max(0.08, Math.min(0.7, 120 / Math.max(visible.length, 1)));
  for (const i of visible) { context.strokeStyle = colour(i); trace(i); }
  context.globalAlpha = 1;
  lines = visible.map((i) => [i, axes.map((k) => y(k, i))]);
  for (const i of [best, chosen]) {
    if (i === undefined || i < 0 || !complete[i]) continue;
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
      const place = (v: number) => top + high * (1 - (v - range[k][0]) / (range[k][1] - range[k][0]));
      context.fillStyle = "rgba(31,95,158,0.25)";
      context.fillRect(x - 6, place(upper), 12, Math.max(place(low) - place(upper), 2));
    }
  });
}
function axisAt(event: MouseEvent): number {
  const wide = parallel.getBoundingClientRect().width;
  return axes.find((k) => Math.abs(lane(k, wide) - event.offsetX) < 9) ?? -1;
}
function valueAt(k: number, offset: number): number {
  const high = parallel.getBoundingClientRect().height - top - bottom;
  return range[k][1] - (offset - top) / high * (range[k][1] - range[k][0]);
}
function lineAt(event: MouseEvent): number {
  const wide = parallel.getBoundingClientRect().width;
  let k = 0;
  while (k < axes.length - 2 && event.offsetX > lane(k + 1, wide)) k++;
  const share = (event.offsetX - lane(k, wide)) / (lane(k + 1, wide) - lane(k, wide) || 1);
  let found = -1, away = NEAR;
  for (const [i, y] of lines) {
    const distance = Math.abs(y[k] + share * ((y[k + 1] ?? y[k]) - y[k]) - event.offsetY);
    if (distance < away) { away = distance; found = i; }
  }
  return found;
}

// table

const table = find("#table table");
function paintTable(): void {
  const sorted = [...tabled];
  if (order.by >= 0) {
    const key = (i: number) => numbers[order.by][i] ?? Infinity;
    sorted.sort((a, b) => order.way * (key(a) - key(b)) || a - b);
  }
  first = Math.max(0, Math.min(first, PAGE_ROWS * Math.floor((sorted.length - 1) / PAGE_ROWS)));
  const page = sorted.slice(first, first + PAGE_ROWS);
  table.replaceChildren();
  const head = make("tr", make("thead", table)), body = make("tbody", table);
  make("th", head, "row", { scope: "col" });
  axes.forEach((k) => {
    const cell = make("th", head, undefined, { scope: "col" }), way = order.by === k ? (order.way > 0 ? " ↑" : " ↓") : "";
    if (way) cell.setAttribute("aria-sort", order.way > 0 ? "ascending" : "descending");
    make("button", cell, label(k) + way, { type: "button" }).addEventListener("click", () => {
      order = { by: k, way: order.by === k ? -order.way : 1 };
      first = 0;
      paintTable();
    });
  });
  make("th", head, "status", { scope: "col", class: "text" });
  for (const i of page) {
    const line = make("tr", body, undefined, i === chosen ? { class: "now" } : {});
    make("th", line, `${rows[i]}${shape(i) ? " ◉" : ""}`, { scope: "row" });
    for (const k of axes) {
      const value = columns[k].values[i];
      make("td", line, typeof value === "number" ? Number(value.toPrecision(5)) : value ?? "");
    }
    make("td", line, complete[i] ? (kept[i] ? (onFront.has(i) ? "on the front" : i === best ? "best" : "complete") : "violates a constraint") : status[i], { class: "text" });
    line.addEventListener("click", () => choose(i));
  }
  find(".pages span").textContent = sorted.length ? `${first + 1} to ${first + page.length} of ${sorted.length}` : "none";
}

function choose(i: number): void {
  if (i < 0) return;
  chosen = i;
  const list = find("#chosen dl"), stored = shape(i), said = document.getElementById("shape-told");
  find("#chosen [data-role=told]").textContent = `Row ${rows[i]}${complete[i] ? (kept[i] ? "" : ", violates a constraint") : `: ${status[i]}`}`;
  list.replaceChildren();
  axes.forEach((k) => { const line = make("div", list); make("dt", line, columns[k].name); make("dd", line, told(k, i)); });
  if (said) said.textContent = stored ? `Shown: row ${rows[i]}.` : `No shape of row ${rows[i]} is stored; rows with a dark ring, in the table ◉, have one.`;
  if (stored) void window.crumplePlayer.show(structuredClone(stored.header), stored.payload);
  document.body.dataset.shown = stored ? String(rows[i]) : "";
  paint();
}

function paint(): void { paintParallel(); paintPair(); paintMatrix(); paintTable(); }

function begin(): void {
  const legend = find("#legend"), entries = [[KEPT, data.limits.length ? "keeps all constraints" : "row"]];
  if (data.limits.length) entries.push([VIOLATED, "violates a constraint"]);
  if (front.length) entries.push([FRONT, "on the Pareto front"]);
  else if (best !== undefined) entries.push([FRONT, "best row"]);
  entries.push([CHOSEN, "chosen"]);
  for (const [paintOf, text] of entries) { const entry = make("span", legend); make("i", entry).style.background = paintOf; entry.append(text); }
  legend.hidden = false;
  offerFilters();
  offerMatrix();
  const goals = data.goals.map((goal) => columns.findIndex((c) => c.name === goal.name));
  axes.forEach((k) => { acrossChoice.add(new Option(columns[k].name, String(k))); upChoice.add(new Option(columns[k].name, String(k))); });
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
  parallel.addEventListener("pointerdown", (event) => { drag = { axis: axisAt(event), from: event.offsetY, moved: false }; });
  parallel.addEventListener("pointermove", (event) => {
    if (!drag || drag.axis < 0 || Math.abs(event.offsetY - drag.from) < 3) return;
    drag.moved = true;
    const { axis } = drag, ends = [drag.from, event.offsetY].map((y) => valueAt(axis, y)).sort((a, b) => a - b);
    setFilter(axis, ends[0] <= range[axis][0] ? -Infinity : ends[0], ends[1] >= range[axis][1] ? Infinity : ends[1]);
  });
  window.addEventListener("pointerup", (event) => {
    if (drag && !drag.moved && event.target === parallel) { if (drag.axis >= 0) setFilter(drag.axis, -Infinity, Infinity); else choose(lineAt(event)); }
    drag = null;
  });
  for (const [role, way] of [["back", -1], ["next", 1]] as const) {
    find(`.pages [data-role=${role}]`).addEventListener("click", () => { first += way * PAGE_ROWS; paintTable(); });
  }
  window.addEventListener("resize", paint);
  filtered();
  paint();
  document.body.dataset.ready = "yes";
}
begin();
