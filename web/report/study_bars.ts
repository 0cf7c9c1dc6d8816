// Tornado and convergence of a study, as SVG.
import { csv, fileButtons } from "./files";
import { draw, extent, find, make, tidy } from "./study_drawing";

export interface Effect { response: string; unit: string; mean: number; bars: { variable: string; low: number; high: number; at_low: string; at_high: string }[] }
export interface Convergence { name: string; unit: string; rows: number[]; values: (number | null)[]; band: (number | null)[][] }

/** pixels of the page that a figure takes, so that its texts have their size at every width */
const pixels = (parent: Element) => Math.max(300, Math.min(864, parent.clientWidth || 760));
/** length of a text in pixels; an estimate where the page is not laid out */
const long = (label: SVGTextElement) => label.getComputedTextLength() || 7 * (label.textContent?.length ?? 0);
/** a text as far as there is room for it, and whole where the pointer rests on it */
function shorten(label: SVGTextElement, room: number): void {
  const text = label.textContent ?? "";
  for (let most = text.length - 1; most > 0 && long(label) > room; most--) label.textContent = `${text.slice(0, most)}…`;
  if (label.textContent !== text) draw("title", {}, label, text);
}

export function paintTornado(effect: Effect | undefined, parent: Element): void {
  parent.replaceChildren();
  if (!effect) return;
  if (!effect.bars.length) {
    make("p", parent, `${effect.response} is constant, ${tidy(effect.mean)}${effect.unit ? ` ${effect.unit}` : ""} in all rows: no variable has an effect on it.`);
    return;
  }
  const WIDE = pixels(parent), LINE = 42, end = LINE * effect.bars.length + 8;
  const svg = draw("svg", { viewBox: `0 0 ${WIDE} ${end + 38}`, role: "img", "aria-label": `Tornado of ${effect.response}` }, parent);
  const all = effect.bars.flatMap((bar) => [bar.low, bar.high]).concat(effect.mean), low = Math.min(...all), high = Math.max(...all);
  // on the left of a bar is that end of its variable with the smaller mean; the longest text of a side gives its room
  const texts = effect.bars.map((bar) => {
    const [before, after] = bar.low <= bar.high ? [bar.at_low, bar.at_high] : [bar.at_high, bar.at_low];
    return {
      name: draw("text", { x: 0, class: "name" }, svg, bar.variable),
      ends: [draw("text", { "text-anchor": "end" }, svg, before), draw("text", { "text-anchor": "start" }, svg, after)],
    };
  });
  const room = (side: number) => Math.min(Math.max(...texts.map(({ ends }) => long(ends[side])), 56) + 8, 0.35 * WIDE);
  const left = room(0), x = (v: number) => left + (WIDE - left - room(1)) * (v - low) / (high - low || 1);
  effect.bars.forEach((bar, i) => {
    const y = 22 + LINE * i, { name, ends: [before, after] } = texts[i], first = x(Math.min(bar.low, bar.high, effect.mean)), last = x(Math.max(bar.low, bar.high, effect.mean));
    name.setAttribute("y", String(y - 6));
    shorten(name, WIDE);
    for (const [v, kind] of [[x(bar.low), "low"], [x(bar.high), "high"]] as [number, string][]) {
      draw("rect", { x: Math.min(v, x(effect.mean)), width: Math.abs(v - x(effect.mean)), y, height: 20, class: kind }, svg);
    }
    draw("line", { x1: x(effect.mean), x2: x(effect.mean), y1: y - 2, y2: y + 22, class: "mean" }, svg);
    for (const [label, at, most] of [[before, first - 4, first - 4], [after, last + 4, WIDE - last - 4]] as [SVGTextElement, number, number][]) {
      label.setAttribute("x", String(at));
      label.setAttribute("y", String(y + 14));
      shorten(label, most);
    }
  });
  const unit = effect.unit ? ` ${effect.unit}` : "";
  for (const [v, y, text] of [[effect.mean, end + 14, `mean ${tidy(effect.mean)}`], [low, end + 30, tidy(low)], [high, end + 30, tidy(high)]] as [number, number, string][]) {
    const label = draw("text", { y, "text-anchor": "middle" }, svg, text + unit), half = 0.5 * long(label);
    label.setAttribute("x", String(Math.max(half, Math.min(x(v), WIDE - half))));
  }
  const named = effect.response + (effect.unit ? `, ${effect.unit}` : ""), heads = ["variable", "at its low end", named, "at its high end", named];
  const data = () => csv([heads, ...effect.bars.map((bar) => [bar.variable, bar.at_low, bar.low, bar.at_high, bar.high]), ["mean", "", effect.mean, "", effect.mean]]);
  parent.append(fileButtons(`tornado_${effect.response}`, () => svg, data));
}
export function paintCurve(curve: Convergence | undefined, parent: Element): void {
  parent.replaceChildren();
  const said = find("#convergence [data-role=told]");
  if (!curve) { said.textContent = "Too few rows."; return; }
  said.textContent = curve.band.length ? "After so many rows, with its 95 % interval." : "After so many rows, among those that keep all constraints.";
  const WIDE = pixels(parent), TALL = 230, LEFT = 76, svg = draw("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, role: "img", "aria-label": curve.name }, parent);
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
  shorten(draw("text", { x: 0, y: 14, class: "name" }, svg, curve.name + (curve.unit ? `, ${curve.unit}` : "")), WIDE);
  draw("text", { x: WIDE - 20, y: TALL - 12, "text-anchor": "end" }, svg, `${last} rows`);
  const heads = ["rows", curve.name + (curve.unit ? `, ${curve.unit}` : ""), ...curve.band.map((_, end) => (end ? "upper end" : "lower end"))];
  const data = () => csv([heads, ...curve.rows.map((r, i) => [r, curve.values[i], ...curve.band.map((end) => end[i])])]);
  parent.append(fileButtons(`convergence_${curve.name}`, () => svg, data));
}
export function offer<T>(id: string, entries: T[], name: (entry: T) => string, put: (entry: T | undefined, parent: Element) => void): void {
  const select = find<HTMLSelectElement>(`#${id} select`), parent = find(`#${id} > div`);
  entries.forEach((entry, i) => select.add(new Option(name(entry), String(i))));
  let painted = 0;
  const paint = () => { painted = parent.clientWidth; put(entries[Number(select.value)], parent); };
  select.addEventListener("change", paint);
  paint();
  if (!entries.length) find(`#${id}`).hidden = true;
  // not on paper, where the figure is scaled
  new ResizeObserver(() => { if (parent.clientWidth && parent.clientWidth !== painted) paint(); }).observe(parent);
}
