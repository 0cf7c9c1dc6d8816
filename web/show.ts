// What an answer says: mistakes, sentences, curves and figures.
import type { Answer, Bands, Curve, Figure, Problem } from "./messages";

const FULL = 300;  // width of a figure [pt] above which it fills the column
const WIDE = 330, TALL = 170, LEFT = 46, RIGHT = 10, TOP = 24, BOTTOM = 24;

export function made(name: string, text: string, parent: HTMLElement, style = ""): HTMLElement {
  const element = document.createElement(name);
  element.textContent = text;
  if (style) element.className = style;
  parent.append(element);
  return element;
}

function svg(name: string, attributes: Record<string, string | number>, parent: Element, text = ""): Element {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  if (text) element.textContent = text;
  parent.append(element);
  return element;
}

export function say(parent: HTMLElement, answer: Answer): void {
  parent.replaceChildren();
  parent.className = `verdict ${answer.failed ? "bad" : answer.level ?? ""}`;
  made("h2", answer.failed ? "No answer" : answer.headline ?? "", parent);
  for (const sentence of answer.failed ? [answer.failed] : answer.sentences ?? []) made("p", sentence, parent);
  if (answer.cautions?.length) {
    const list = made("ul", "", parent);
    for (const caution of answer.cautions) made("li", caution, list);
    if (answer.more_cautions) made("li", `and ${answer.more_cautions} more`, list);
  }
}

export function list(parent: HTMLElement, problems: Problem[], more: number, go: (line: number) => void): void {
  parent.replaceChildren();
  for (const one of problems) {
    const line = made("button", `${one.line ? `line ${one.line}: ` : ""}${one.where ? `${one.where}: ` : ""}${one.what}`, parent);
    line.setAttribute("type", "button");
    line.addEventListener("click", () => go(one.line));
    const details = [one.came && `given: ${one.came}`, one.allowed && `allowed: ${one.allowed}`, one.todo];
    made("small", details.filter(Boolean).join("; "), line);
  }
  if (more) made("p", `and ${more} more`, parent, "note");
}

/** Curves of the answer over those of the answer before in grey, with their bands. */
export class Curves {
  private now: Curve[] = [];
  private before: Curve[] = [];
  private end = 0;
  private time = Infinity;

  constructor(private parent: HTMLElement, private note: HTMLElement) {
    document.addEventListener("crumple-time", (event) => { this.time = (event as CustomEvent<number>).detail; });
  }

  show(answer: Answer, before: Curve[]): void {
    this.now = answer.curves?.all ?? [];
    this.end = answer.curves?.end ?? 0;
    this.before = before;
    this.band(null);
  }

  /** Draw the curves with the bands that the laws give them, or without. */
  band(bands: Bands | null): void {
    const same = (one: { name: string; unit: string }, curve: Curve) => one.name === curve.name && one.unit === curve.unit;
    this.parent.replaceChildren();
    for (const curve of this.now) {
      this.chart(curve, this.before.find((one) => same(one, curve)), bands?.curves.find((one) => same(one, curve)), this.end);
    }
    const others = bands?.without ? `; the other ${bands.without === 1 ? "one has" : `${bands.without} have`} no known band` : "";
    const failed = bands?.failed ? `; ${bands.failed} of the runs did not reach their end` : "";
    this.note.textContent = bands?.curves.length
      ? `Shaded: range of runs with ${bands.laws} of the hinge laws at the edges of their bands${others}${failed}.` : "";
  }

  get shown(): Curve[] { return this.now; }

  private chart(curve: Curve, before: Curve | undefined, band: Bands["curves"][number] | undefined, end: number): void {
    const picture = svg("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, class: "chart", role: "img", "aria-label": curve.name }, this.parent);
    const values = curve.values[0] ?? [], earlier = before?.values[0] ?? [];
    const reach = [0, ...values, ...earlier, ...(band ? [...band.low, ...band.high] : [])];
    const low = Math.min(...reach), high = Math.max(...reach), span = high - low || 1;
    const x = (i: number) => LEFT + (WIDE - LEFT - RIGHT) * i / Math.max(values.length - 1, 1);
    const y = (v: number) => TALL - BOTTOM - (TALL - TOP - BOTTOM) * (v - low) / span;
    const line = (list: number[]) => list.map((v, i) => `${x(i).toFixed(1)},${y(v).toFixed(1)}`).join(" ");
    svg("text", { x: 0, y: 13, class: "name" }, picture, `${curve.name}, ${curve.unit}`);
    for (const v of new Set([low, 0, high])) {
      svg("line", { x1: LEFT, x2: WIDE - RIGHT, y1: y(v), y2: y(v), class: "axis" }, picture);
      svg("text", { x: LEFT - 5, y: y(v) + 4, "text-anchor": "end" }, picture, String(Number(v.toPrecision(3))));
    }
    const [factor, unit] = end > 2 ? [1, "s"] : [1e3, "ms"];
    svg("text", { x: WIDE - RIGHT, y: TALL - 8, "text-anchor": "end" }, picture, `${Number((factor * end).toPrecision(4))} ${unit}`);
    if (band) {
      const back = band.low.map((v, i) => `${x(i).toFixed(1)},${y(v).toFixed(1)}`).reverse().join(" ");
      svg("polygon", { points: `${line(band.high)} ${back}`, class: "band" }, picture);
    }
    if (earlier.length) svg("polyline", { points: line(earlier), class: "middle" }, picture);
    svg("polyline", { points: line(values), class: "now" }, picture);
    const cursor = svg("line", { y1: TOP, y2: TALL - BOTTOM, class: "cursor" }, picture);
    const put = (time: number) => {
      const at = LEFT + (WIDE - LEFT - RIGHT) * Math.min(time / (end || 1), 1);
      for (const side of ["x1", "x2"]) cursor.setAttribute(side, String(at));
    };
    put(Math.min(this.time, end));
    const follow = (event: Event) => {
      // a chart that was replaced listens no longer
      if (picture.isConnected) put((event as CustomEvent<number>).detail);
      else document.removeEventListener("crumple-time", follow);
    };
    document.addEventListener("crumple-time", follow);
  }
}

/** Pictures made of SVG texts: nothing in them runs. */
export class Pictures {
  private addresses: string[] = [];
  private used: string[] = [];

  begin(): void { this.used = this.addresses; this.addresses = []; }
  end(): void { for (const address of this.used) URL.revokeObjectURL(address); }
  image(svg: string, alt: string): HTMLImageElement {
    const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    this.addresses.push(address);
    const image = Object.assign(document.createElement("img"), { src: address, alt });
    image.dataset.points = /viewBox="0 0 ([\d.]+)/.exec(svg)?.[1] ?? "0";
    return image;
  }
}

/** Figures as pictures: what is in them cannot run, and has its own styles. */
export class Figures {
  private pictures = new Pictures();

  constructor(private parent: HTMLElement) {}

  show(figures: Figure[]): void {
    this.pictures.begin();
    this.parent.replaceChildren();
    for (const figure of figures) {
      const place = made("figure", "", this.parent), panels = made("div", "", place, "panels");
      for (const panel of figure.panels) {
        const picture = this.pictures.image(panel.svg, panel.name.replaceAll("_", " "));
        const holder = made("div", "", panels, Number(picture.dataset.points) > FULL ? "panel full" : "panel");
        const link = document.createElement("a");
        Object.assign(link, { href: picture.src, download: `${panel.name}.svg`, textContent: "SVG", className: "note" });
        holder.append(picture, link);
      }
      made("figcaption", figure.caption, place);
    }
    this.pictures.end();
  }
}
