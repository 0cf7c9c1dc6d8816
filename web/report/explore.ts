// Sliders over a grid of runs: the scene shows a blend of the runs around the chosen values, and so do the curves.
import type { Curve, Explore, Force, Model, Point, Scene } from "./scene";
import { csv, fileButtons } from "./files";
import { draw as element } from "./study_drawing";
import type {} from "./viewer";

const NEAR = 0.04;  // of a step of the grid: a slider this near to a solved value is put onto it
const WIDE = 330, TALL = 190, LEFT = 46, RIGHT = 10, TOP = 26, BOTTOM = 28;

/** weighted mean of numbers, arrays and objects of one structure; what is no number is that of the first */
function mix<T>(values: T[], weights: number[]): T {
  const first = values[0];
  if (typeof first === "number") return (values as number[]).reduce((sum, x, i) => sum + weights[i] * x, 0) as T;
  if (Array.isArray(first)) return first.map((_, k) => mix((values as unknown[][]).map((v) => v[k]), weights)) as T;
  if (first && typeof first === "object") {
    const all = values as Record<string, unknown>[];
    return Object.fromEntries(Object.keys(first).map((key) => [key, mix(all.map((v) => v[key]), weights)])) as T;
  }
  return first;
}

/** points of the grid around a place and their weights, the nearest first */
function corners(place: number[], shape: number[]): [number, number][] {
  let found: [number, number][] = [[0, 1]];
  place.forEach((x, axis) => {
    const low = Math.min(Math.floor(x), shape[axis] - 1), share = x - low;
    found = found.flatMap(([index, weight]): [number, number][] => [[index * shape[axis] + low, weight * (1 - share)],
      [index * shape[axis] + Math.min(low + 1, shape[axis] - 1), weight * share]]);
  });
  return found.filter(([, weight]) => weight > 0).sort((a, b) => b[1] - a[1]);
}

/** makes a model of several; whether they have one structure */
function blended(model: Model, models: Model[], weights: number[], forces: Force[]): boolean {
  const [first] = models;
  const same = models.every((m) => m.points === first.points && m.quads === first.quads && m.hinges.length === first.hinges.length);
  const [used, w] = same ? [models, weights] : [[first], [1]];
  model.grid = first.grid.map((now, f) => Float32Array.from(now, (_, i) => used.reduce((sum, m, k) => sum + w[k] * m.grid[f][i], 0)));
  model.hinges = first.hinges.map((hinge, i) => ({ ...mix(used.map((m) => m.hinges[i]), w), state: hinge.state }));
  model.masses = mix(used.map((m) => m.masses), w);
  model.supports = mix(used.map((m) => m.supports), w);
  model.obstacles = mix(used.map((m) => m.obstacles), w).map((entry, i) => ({ ...entry, quads: first.obstacles[i].quads }));
  // an arrow of a force that some of the runs do not have would jump: it is not drawn
  model.forces = forces.map((one) => {
    const all = used.map((m) => m.forces.find((x) => x.name === one.name && x.on === one.on));
    const there = all.filter((x) => x !== undefined);
    return there.length === all.length ? mix(there, w) : { ...one, force: one.force.map((): Point => [0, 0, 0]) };
  });
  return same;
}

/** one curve on axes that hold the curves of all runs */
function chart(curve: Curve, times: number[], parent: Element, middle: number): (values: number[] | null) => void {
  const last = times[times.length - 1], panel = document.createElement("div");
  panel.className = "panel";
  parent.append(panel);
  const svg = element("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, class: "chart", role: "img", "aria-label": curve.name }, panel);
  const all = curve.values.flat(), size = Math.max(...all.map(Math.abs)), tidy = (v: number) => (Math.abs(v) < 1e-4 * size ? 0 : v);
  const low = tidy(Math.min(0, ...all)), high = tidy(Math.max(0, ...all)), span = high - low || 1;
  const x = (t: number) => LEFT + (WIDE - LEFT - RIGHT) * (t - times[0]) / (last - times[0] || 1);
  const y = (v: number) => TALL - BOTTOM - (TALL - TOP - BOTTOM) * (v - low) / span;
  const line = (values: number[]) => values.map((v, i) => `${x(times[i]).toFixed(1)},${y(v).toFixed(1)}`).join(" ");
  const [factor, unit] = last > 2 ? [1, "s"] as const : [1e3, "ms"] as const;
  element("text", { x: 0, y: 13, class: "name" }, svg, `${curve.name}, ${curve.unit}`);
  for (const v of new Set([low, 0, high])) {
    element("line", { x1: LEFT, x2: WIDE - RIGHT, y1: y(v), y2: y(v), class: "axis" }, svg);
    element("text", { x: LEFT - 5, y: y(v) + 4, "text-anchor": "end" }, svg, String(Number(v.toPrecision(3))));
  }
  element("text", { x: LEFT, y: TALL - 10 }, svg, "0");
  element("text", { x: WIDE - RIGHT, y: TALL - 10, "text-anchor": "end" }, svg, `${Number((factor * last).toPrecision(4))} ${unit}`);
  element("polyline", { points: middle < 0 ? "" : line(curve.values[middle]), class: "middle" }, svg);
  const now = element("polyline", { points: "", class: "now" }, svg), cursor = element("line", { y1: TOP, y2: TALL - BOTTOM, class: "cursor" }, svg);
  document.addEventListener("crumple-time", (event) => {
    for (const end of ["x1", "x2"]) cursor.setAttribute(end, String(x(Math.min((event as CustomEvent<number>).detail, last))));
  });
  let shown: number[] | null = null;
  const named = `${curve.name}, ${curve.unit}`, grey = middle < 0 ? [] : curve.values[middle];
  const data = () => csv([[`time, ${unit}`, named, ...(middle < 0 ? [] : [`middle of the grid: ${named}`])],
    ...times.map((t, i) => [factor * t, shown ? shown[i] : null, ...grey.slice(i, i + 1)])]);
  panel.append(fileButtons(curve.name, () => svg, data));
  return (values) => {
    shown = values;
    now.setAttribute("points", values ? line(values) : "");
  };
}

/** makes one model, the blend, of all runs of a scene */
function begin(scene: Scene, explore: Explore): (redraw: () => void) => void {
  const { axes, models: numbers, reasons, curves, times } = explore, runs = scene.models;
  const shape = axes.map((axis) => axis.values.length), place = shape.map((n) => (n - 1) / 2);
  const root = document.getElementById("explore") as HTMLElement, told = root.querySelector("[data-role=told]") as HTMLElement;
  const middle = numbers[corners(shape.map((n) => Math.floor((n - 1) / 2)), shape)[0][0]];
  const model = { ...runs[Math.max(middle, 0)] };
  const forces = [...new Map(runs.flatMap((run) => run.forces).map((one) => [`${one.on} ${one.name}`, one])).values()];
  scene.models = [model];
  let draw = () => {}, charts: ((values: number[] | null) => void)[] = [];

  function show(): void {
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
    told.textContent = around.length === 1 ? "Solved: these values are a point of the grid."
      : `Interpolated between ${around.length} solved points${same ? "" : "; the shape is that of the nearest"}.`;
    charts.forEach((put, i) => put(mix(chosen.map((k) => curves[i].values[k]), weights)));
    draw();
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
    input.addEventListener("input", () => { put(); show(); });
    // arrow keys go from solved value to solved value
    input.addEventListener("keydown", (event) => {
      const way = ({ ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 } as Record<string, number>)[event.key];
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
    draw = redraw;
    const parent = document.querySelector("[data-role=curves]") as HTMLElement;
    charts = curves.map((curve) => chart(curve, times, parent, middle));
    show();
  };
}

window.crumpleExplore = begin;
