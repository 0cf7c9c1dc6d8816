// Tornado and convergence of a study, as SVG.
import { csv, fileButtons } from "./files";
import { draw, extent, find, make, tidy } from "./study_drawing";

export interface Effect { response: string; unit: string; mean: number; bars: { variable: string; low: number; high: number; at_low: string; at_high: string }[] }
export interface Convergence { name: string; unit: string; rows: number[]; values: (number | null)[]; band: (number | null)[][] }

export function paintTornado(effect: Effect | undefined, parent: Element): void {
  parent.replaceChildren();
  if (!effect) return;
  if (!effect.bars.length) {
    make("p", parent, `${effect.response} is constant, ${tidy(effect.mean)}${effect.unit ? ` ${effect.unit}` : ""} in all rows: no variable has an effect on it.`);
    return;
  }
  // room for the name of a variable, and beside each end of its bar for the value there
  const WIDE = 480, LINE = 30, NAMES = 120, ENDS = 96, svg = draw("svg", { viewBox: `0 0 ${WIDE} ${LINE * effect.bars.length + 46}`, role: "img", "aria-label": `Tornado of ${effect.response}` }, parent);
  const all = effect.bars.flatMap((bar) => [bar.low, bar.high]).concat(effect.mean), low = Math.min(...all), high = Math.max(...all);
  const x = (v: number) => NAMES + ENDS + (WIDE - NAMES - 2 * ENDS) * (v - low) / (high - low || 1), end = LINE * effect.bars.length + 8;
  effect.bars.forEach((bar, i) => {
    const y = 8 + LINE * i, [a, b] = [bar.low, bar.high];
    draw("text", { x: NAMES, y: y + 15, "text-anchor": "end", class: "name" }, svg, bar.variable);
    draw("rect", { x: Math.min(x(a), x(effect.mean)), width: Math.abs(x(a) - x(effect.mean)), y, height: LINE - 10, class: "low" }, svg);
    draw("rect", { x: Math.min(x(b), x(effect.mean)), width: Math.abs(x(b) - x(effect.mean)), y, height: LINE - 10, class: "high" }, svg);
    const left = a <= b;
    draw("text", { x: x(a) + (left ? -4 : 4), y: y + 14, "text-anchor": left ? "end" : "start" }, svg, bar.at_low);
    draw("text", { x: x(b) + (left ? 4 : -4), y: y + 14, "text-anchor": left ? "start" : "end" }, svg, bar.at_high);
  });
  draw("line", { x1: x(effect.mean), x2: x(effect.mean), y1: 2, y2: end, class: "mean" }, svg);
  const unit = effect.unit ? ` ${effect.unit}` : "";
  draw("text", { x: x(effect.mean), y: end + 14, "text-anchor": "middle" }, svg, `mean ${tidy(effect.mean)}${unit}`);
  draw("text", { x: x(low), y: end + 30, "text-anchor": "middle" }, svg, tidy(low) + unit);
  draw("text", { x: x(high), y: end + 30, "text-anchor": "middle" }, svg, tidy(high) + unit);
  const named = effect.response + (effect.unit ? `, ${effect.unit}` : ""), heads = ["variable", "at its low end", named, "at its high end", named];
  const data = () => csv([heads, ...effect.bars.map((bar) => [bar.variable, bar.at_low, bar.low, bar.at_high, bar.high]), ["mean", "", effect.mean, "", effect.mean]]);
  parent.append(fileButtons(`tornado_${effect.response}`, () => svg, data));
}
export function paintCurve(curve: Convergence | undefined, parent: Element): void {
  parent.replaceChildren();
  const said = find("#convergence [data-role=told]");
  if (!curve) { said.textContent = "Too few rows."; return; }
  said.textContent = curve.band.length ? "After so many rows, with its 95 % interval." : "After so many rows, among those that keep all constraints.";
  const WIDE = 500, TALL = 200, LEFT = 76, svg = draw("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, role: "img", "aria-label": curve.name }, parent);
  const known = curve.values.flatMap((v, i) => (v === null ? [] : [i]));
  if (!known.length) { said.textContent = "No row keeps all constraints."; return; }
  const settled = known.filter((i) => i >= known.length * 0.1), all = [...(curve.band.length ? settled : known).map((i) => curve.values[i]), ...curve.band.flatMap((end) => settled.map((i) => end[i]))].filter((v) => v !== null);
  const [low, high] = extent(all), last = curve.rows[curve.rows.length - 1];
  const x = (r: number) => LEFT + (WIDE - LEFT - 20) * r / last, y = (v: number) => TALL - 34 - (TALL - 60) * (Math.max(low, Math.min(high, v)) - low) / (high - low);
  const path = (values: (number | null)[], way: number) => (way < 0 ? [...known].reverse() : known).map((i) => `${x(curve.rows[i]).toFixed(1)},${y(values[i] ?? low).toFixed(1)}`);
  if (curve.band.length) draw("polygon", { points: [...path(curve.band[0], 1), ...path(curve.band[1], -1)].join(" "), class: "band" }, svg);
  for (const v of [low, (low + high) / 2, high]) {
    draw("line", { x1: LEFT, x2: WIDE - 20, y1: y(v), y2: y(v), class: "axis" }, svg);
    draw("text", { x: LEFT - 6, y: y(v) + 4, "text-anchor": "end" }, svg, Number(v.toPrecision(4)));
  }
  draw("polyline", { points: path(curve.values, 1).join(" "), class: "curve" }, svg);
  draw("text", { x: LEFT, y: 14, class: "name" }, svg, curve.name + (curve.unit ? `, ${curve.unit}` : ""));
  draw("text", { x: WIDE - 20, y: TALL - 12, "text-anchor": "end" }, svg, `${last} rows`);
  const heads = ["rows", curve.name + (curve.unit ? `, ${curve.unit}` : ""), ...curve.band.map((_, end) => (end ? "upper end" : "lower end"))];
  const data = () => csv([heads, ...curve.rows.map((r, i) => [r, curve.values[i], ...curve.band.map((end) => end[i])])]);
  parent.append(fileButtons(`convergence_${curve.name}`, () => svg, data));
}
export function offer<T>(id: string, entries: T[], name: (entry: T) => string, put: (entry: T | undefined, parent: Element) => void): void {
  const select = find<HTMLSelectElement>(`#${id} select`), parent = find(`#${id} > div`);
  entries.forEach((entry, i) => select.add(new Option(name(entry), String(i))));
  select.addEventListener("change", () => put(entries[Number(select.value)], parent));
  put(entries[0], parent);
  if (!entries.length) find(`#${id}`).hidden = true;
}
